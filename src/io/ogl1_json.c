/* ogl1_json.c - see ogl1_json.h. */
#include "io/ogl1_json.h"

#include "base/result.h"

bool ogl1_json_detect(const void *bytes, size_t size)
{
    (void)bytes;
    (void)size;
    return false;
}
facet_result ogl1_json_load(const char *path, const facet_scene_desc *desc, facet_scene **scene,
                            facet_error *error)
{
    (void)desc;
    (void)scene;
    return fail(error, FACET_ERROR_UNSUPPORTED, "%s: not built yet", path);
}
facet_result ogl1_json_load_memory(const void *bytes, size_t size, const char *name,
                                   const facet_scene_desc *desc, facet_scene **scene, facet_error *error)
{
    (void)bytes;
    (void)size;
    (void)desc;
    (void)scene;
    return fail(error, FACET_ERROR_UNSUPPORTED, "%s: not built yet", name);
}
facet_result ogl1_json_overlay(facet_scene *scene, const char *path, const facet_scene_desc *desc,
                               facet_error *error)
{
    (void)scene;
    (void)desc;
    return fail(error, FACET_ERROR_UNSUPPORTED, "%s: not built yet", path);
}
facet_result ogl1_json_save(const facet_scene *scene, const char *path, const char *generator,
                            const facet_scene_save_desc *desc, facet_error *error)
{
    (void)scene;
    (void)generator;
    (void)desc;
    return fail(error, FACET_ERROR_UNSUPPORTED, "%s: not built yet", path);
}
