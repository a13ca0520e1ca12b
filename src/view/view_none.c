/* view_none.c - facet_view() where facet was built without GLFW. */
#include "base/result.h"
#include "gl/gl_entry.h"

facet_result view_run(const gl_host *host, const facet_view_desc *desc, facet_error *error)
{
    (void)host;
    (void)desc;
    return fail(error, FACET_ERROR_SYSTEM, "window: this facet was built without GLFW, which opens windows");
}
