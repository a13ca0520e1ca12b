/* obj_write.c - see obj.h. */
#include "io/obj.h"

#include "base/result.h"

facet_result obj_save(const facet_scene *scene, const char *path, const char *generator,
                      const facet_scene_save_desc *desc, facet_error *error)
{
    (void)scene;
    (void)generator;
    (void)desc;
    return fail(error, FACET_ERROR_UNSUPPORTED, "%s: not built yet", path);
}
