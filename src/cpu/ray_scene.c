/* ray_scene.c - see ray_scene.h. */
#include "cpu/ray_scene.h"

facet_result ray_tracer_choose(facet_bvh kind, const ray_tracer **out, facet_error *error)
{
    *out = &bvh_tracer;
    if (kind == FACET_BVH_OWN)
        return FACET_OK;
    const facet_result result = embree_find_tracer(out, error);
    if (kind == FACET_BVH_EMBREE || result != FACET_ERROR_SYSTEM)
        return result;
    *out = &bvh_tracer;
    return FACET_OK;
}
