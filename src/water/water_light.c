/* water_light.c - see water_light.h. */
#include <string.h>

#include "base/memory.h"
#include "base/result.h"
#include "ibl/environment.h"

#include "water/water_light.h"

static void destroy(sea_kept *kept)
{
    water_light *l = (water_light *)kept;
    water_sky_destroy(&l->sky);
    if (l->around)
        environment_release(l->around);
    if (l->desc.render.environment)
        environment_release(l->desc.render.environment);
    mem_free(l->pictures);
    mem_free(l->lobes);
    mem_free(l);
}

static facet_result create(const facet_sea *sea, const facet_sea_render_desc *desc, float eye_height_m,
                           float rows_per_rad, water_light **out, facet_error *error)
{
    const facet_allocator *allocator = &sea->desc.allocator;
    water_light *l = mem_zalloc(allocator, 1, sizeof *l);
    *out = NULL;
    if (!l)
        return fail_memory(error, "the light of a sea", sizeof *l);
    *l = (water_light){
        .kept.destroy = destroy, .desc = *desc, .eye_height_m = eye_height_m, .rows_per_rad = rows_per_rad};
    l->desc.render.allocator = *allocator;
    if (desc->render.environment)
        environment_retain(desc->render.environment);
    facet_result result = water_sky_create(&l->desc, eye_height_m, rows_per_rad, &l->sky, error);
    if (result != FACET_OK) {
        destroy(&l->kept);
        return result;
    }
    water_table_create(desc->shading.normals == FACET_SEA_NORMALS_GGX ? WATER_GGX : WATER_BECKMANN,
                       (int)desc->shading.masking, sea->optics.ior, desc->render.thread_count, &l->table);
    *out = l;
    return FACET_OK;
}

static bool is_same_sky(const facet_sky_desc *a, const facet_sky_desc *b)
{
    return a->model == b->model && a->sun_elevation_rad == b->sun_elevation_rad &&
           a->sun_azimuth_rad == b->sun_azimuth_rad && a->turbidity == b->turbidity &&
           memcmp(a->ground_albedo, b->ground_albedo, sizeof a->ground_albedo) == 0 &&
           a->omits_disc == b->omits_disc && a->illuminance_lux == b->illuminance_lux;
}

static bool is_same_sun(const facet_sun *a, const facet_sun *b)
{
    return a->azimuth_rad == b->azimuth_rad && a->elevation_rad == b->elevation_rad &&
           a->diameter_rad == b->diameter_rad &&
           memcmp(a->illuminance_lux, b->illuminance_lux, sizeof a->illuminance_lux) == 0;
}

/* Of all that water_sky_create() and water_table_create() read. */
static bool is_made_for(const water_light *l, const facet_sea_render_desc *desc, float eye_height_m,
                        float rows_per_rad)
{
    const facet_render_desc *a = &l->desc.render, *b = &desc->render;
    return l->eye_height_m == eye_height_m && (l->sky.has_views || l->rows_per_rad == rows_per_rad) &&
           l->desc.shading.normals == desc->shading.normals &&
           l->desc.shading.masking == desc->shading.masking && is_same_sky(&l->desc.sky, &desc->sky) &&
           is_same_sun(&a->sun, &b->sun) && a->environment == b->environment &&
           a->environment_rotation_rad == b->environment_rotation_rad &&
           a->environment_ev == b->environment_ev;
}

/* Nothing of a sea but what it keeps changes. */
static sea_kept_place *place_of(const facet_sea *sea)
{
    return &((facet_sea *)(uintptr_t)sea)->light;
}

facet_result water_light_take(const facet_sea *sea, const facet_sea_render_desc *desc, float eye_height_m,
                              float rows_per_rad, water_light **out, facet_error *error)
{
    water_light *kept = (water_light *)sea_kept_take(place_of(sea));
    if (kept && is_made_for(kept, desc, eye_height_m, rows_per_rad)) {
        *out = kept;
        return FACET_OK;
    }
    if (kept)
        destroy(&kept->kept);
    return create(sea, desc, eye_height_m, rows_per_rad, out, error);
}

void water_light_give_back(const facet_sea *sea, water_light *light)
{
    if (light)
        sea_kept_put(place_of(sea), &light->kept);
}
