/* embree_none.c - stands for the other embree_*.c in a build without Embree. */
#include "base/result.h"
#include "cpu/embree_version.h"
#include "cpu/ray_scene.h"

facet_result embree_find_tracer(const ray_tracer **out, facet_error *error)
{
    *out = NULL;
    return fail(error, FACET_ERROR_SYSTEM, "Embree: this facet was built without it");
}

const char *embree_scene_version(void)
{
    return "";
}

void embree_find_version(char *version, size_t size)
{
    if (size)
        *version = 0;
}
