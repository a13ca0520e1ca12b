/* ocean_path.c - see ocean_path.h: what water_setup.h prepares, as triangles, with their water as a surface of the path tracer. */
#include <math.h>

#include "api/api.h"
#include "api/ocean_path.h"

#include "base/clock.h"

#include "water/water_mesh.h"
#include "water/water_path.h"

/* The light that the preview has: the sky without its lower half and without the sun, which is a disc beside it. deadline_s: of the time limit,
 * of which some has gone. */
static facet_render_desc desc_of(const water_setup *s, double deadline_s)
{
    facet_render_desc r = s->desc->render;
    vec3 L = s->sky.L, E = s->sky.sun_irradiance;
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

facet_result ocean_path_render(const facet_sea *sea, const facet_scene *scene,
                               const facet_sea_render_desc *desc, facet_image **out, facet_error *error)
{
    water_setup setup;
    facet_render_stats stats = {0};
    facet_scene *all = NULL;
    double limit_s = desc->render.time_limit_s, deadline_s = limit_s > 0.0 ? clock_seconds() + limit_s : 0.0;
    facet_result result = water_setup_create(sea, scene, desc, &setup, &stats, error);
    if (result == FACET_OK)
        result = water_mesh_scene(&setup, scene, deadline_s, &all, error);
    if (result == FACET_OK) {
        const water_path water = water_path_make(&setup);
        const path_surface surface = water_path_surface(&water);
        const facet_render_desc r = desc_of(&setup, deadline_s);
        all->surface = &surface;
        result = facet_render(all, &r, out, error);
    }
    facet_scene_destroy(all);
    water_setup_destroy(&setup);
    return result;
}
