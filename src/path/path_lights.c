/* path_lights.c - see path_lights.h. */
#include "path/path_lights.h"

#include "base/memory.h"
#include "base/result.h"

struct path_lights {
    const render_setup *setup;
};

facet_result path_lights_create(const render_setup *setup, path_lights **out, facet_error *error)
{
    *out = mem_zalloc(&setup->desc->allocator, 1, sizeof **out);
    if (!*out)
        return fail_memory(error, "lights", sizeof **out);
    (*out)->setup = setup;
    return FACET_OK;
}

void path_lights_destroy(path_lights *lights)
{
    mem_free(lights);
}

bool path_lights_has_any(const path_lights *lights)
{
    return lights->setup->desc->environment != NULL;
}

bool path_lights_sample(const path_lights *lights, vec3 P, vec3 N, float u_light, vec2 u,
                        path_light_sample *out)
{
    (void)P;
    (void)N;
    (void)u_light;
    float z = 1.0f - 2.0f * u[0];
    float r = sqrt(max(1.0f - z * z, 0.0f));
    out->L = vec3(r * cos(2.0f * PI * u[1]), r * sin(2.0f * PI * u[1]), z);
    out->distance_m = INFINITY;
    out->radiance = path_lights_surroundings(lights, out->L);
    out->pdf = 0.25f * INV_PI;
    out->is_point = false;
    out->is_surroundings = true;
    out->geometry = out->primitive = VISIBILITY_NONE;
    return true;
}

vec3 path_lights_surroundings(const path_lights *lights, vec3 d)
{
    (void)d;
    return vec3(lights->setup->desc->environment ? 1.0f : 0.0f);
}

float path_lights_surroundings_pdf(const path_lights *lights, vec3 P, vec3 N, vec3 d)
{
    (void)lights;
    (void)P;
    (void)N;
    (void)d;
    return 0.25f * INV_PI;
}

float path_lights_emitter_pdf(const path_lights *lights, vec3 P, vec3 N, const visibility_hit *hit, vec3 d,
                              float distance_m)
{
    (void)lights;
    (void)P;
    (void)N;
    (void)hit;
    (void)d;
    (void)distance_m;
    return 0.0f;
}
