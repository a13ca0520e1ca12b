/* path_shadow.c - see path_shadow.h. */
#include "cpu/ray_trace.h"
#include "cpu/volume_rays.h"

#include "path/path_shadow.h"

/* How far a ray goes towards the light. It ends before an emissive triangle, by what rounding does to both ends. */
static float reach(vec3 P, const path_light_sample *light)
{
    if (light->is_surroundings || !(light->distance_m < INFINITY))
        return INFINITY;
    vec3 end = P + light->L * light->distance_m;
    return light->distance_m * (1.0f - 4e-6f) - 4.0f * volume_rays_tolerance_of(max3(max(abs(P), abs(end))));
}

vec3 path_shadow(path *p, vec3 P, const path_light_sample *light)
{
    shading_ray ray = {.far_t = reach(P, light)};
    store3(P, ray.origin);
    store3(light->L, ray.direction);
    p->out->rays++;
    return ray.far_t > 0.0f ? vec3(ray_trace_opening(p->shading, &ray)) : vec3(1.0f);
}
