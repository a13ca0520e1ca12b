/* preview_none.c - stands for src/cpu/preview.c, which needs Embree: gl.mjs excludes the tests that call it. */
#include "base/result.h"
#include "cpu/preview.h"

facet_result preview_render(const facet_scene *scene, const facet_render_desc *desc, film *out,
                            facet_render_stats *stats, facet_error *error)
{
    (void)scene, (void)desc, (void)out, (void)stats;
    return fail(error, FACET_ERROR_UNSUPPORTED,
                "the preview needs Embree, which does not exist for browsers");
}
