/* obj_read.c - see obj.h. */
#include "io/obj.h"

#include "base/result.h"

bool obj_detect(const void *bytes, size_t size)
{
    (void)bytes;
    (void)size;
    return false;
}
facet_result obj_load(const char *path, const facet_scene_desc *desc, facet_scene **scene, facet_error *error)
{
    (void)desc;
    (void)scene;
    return fail(error, FACET_ERROR_UNSUPPORTED, "%s: not built yet", path);
}
facet_result obj_load_memory(const void *bytes, size_t size, const char *name, const facet_scene_desc *desc,
                             facet_scene **scene, facet_error *error)
{
    (void)bytes;
    (void)size;
    (void)desc;
    (void)scene;
    return fail(error, FACET_ERROR_UNSUPPORTED, "%s: not built yet", name);
}
