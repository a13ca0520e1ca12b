/* water_scene.c - see water_scene.h. */
#include "water/water_scene.h"

#include <math.h>

#include "base/clock.h"
#include "base/memory.h"
#include "base/result.h"

#include "water/water_mesh.h"
#include "water/water_path.h"

struct water_scene {
    water_setup setup;
    facet_scene *scene;
    facet_render_desc desc;
    water_path water;
    path_surface surface; /* of water */
};

/* The preview's lighting: the sky without its lower half and its sun, and a directional sun. */
static facet_render_desc desc_of(const water_setup *s, double deadline_s)
{
    facet_render_desc r = *s->desc;
    vec3 L = s->sky.L, E = s->sky.sun_irradiance;
    r.sea = NULL; /* it is part of the scene */
    r.environment = s->sky.mirrored;
    r.environment_ev = log2(max(s->sky.scale, 1e-30f));
    r.background = FACET_BACKGROUND_ENVIRONMENT;
    r.sun.azimuth_rad = atan(L[0], L[2]);
    r.sun.elevation_rad = asin(clamp(L[1], -1.0f, 1.0f));
    r.sun.illuminance_lux[0] = E[0];
    r.sun.illuminance_lux[1] = E[1];
    r.sun.illuminance_lux[2] = E[2];
    if (deadline_s > 0.0)
        r.time_limit_s = fmax(deadline_s - clock_seconds(), 1e-6);
    return r;
}

facet_result water_scene_create(water_cache *cache, const facet_scene *scene, const facet_render_desc *desc,
                                double deadline_s, water_scene **out, facet_render_stats *stats,
                                facet_error *error)
{
    *out = NULL;
    water_scene *w = mem_zalloc(&desc->allocator, 1, sizeof *w);
    if (!w)
        return fail_memory(error, "the scene of a sea", sizeof *w);
    facet_result result = water_setup_create(cache, scene, desc, 0, &w->setup, stats, error);
    if (result == FACET_OK)
        result = water_mesh_scene(&w->setup, scene, deadline_s, &w->scene, error);
    if (result != FACET_OK) {
        water_scene_destroy(w);
        return result;
    }
    w->water = water_path_make(&w->setup);
    w->surface = water_path_surface(&w->water);
    w->desc = desc_of(&w->setup, deadline_s);
    *out = w;
    return FACET_OK;
}

void water_scene_destroy(water_scene *w)
{
    if (!w)
        return;
    scene_destroy(w->scene);
    water_setup_destroy(&w->setup);
    mem_free(w);
}

const facet_scene *water_scene_get_scene(const water_scene *w)
{
    return w->scene;
}

const facet_render_desc *water_scene_get_desc(const water_scene *w)
{
    return &w->desc;
}

const path_surface *water_scene_get_surface(const water_scene *w)
{
    return &w->surface;
}
