/* water_light.c - see water_light.h, and for the cache water_render.h. */
#include <string.h>

#include "base/memory.h"
#include "base/result.h"
#include "ocean/foam_history.h"
#include "ibl/environment.h"

#include "water/water_light.h"

static void destroy_light(water_light *l)
{
    if (!l)
        return;
    water_sky_destroy(&l->sky);
    if (l->around)
        environment_release(l->around);
    if (l->desc.environment)
        environment_release(l->desc.environment);
    mem_free(l->images);
    mem_free(l->lobes);
    mem_free(l);
}

void water_cache_clear(water_cache *cache)
{
    destroy_light(cache->light);
    foam_history_destroy(cache->foam);
    *cache = (water_cache){.allocator = cache->allocator};
}

void water_cache_begin(water_cache *cache, const facet_render_desc *desc)
{
    if (cache->sea_serial != desc->sea->serial)
        water_cache_clear(cache);
    cache->sea_serial = desc->sea->serial;
}

static facet_result create_light(const facet_allocator *allocator, const facet_render_desc *desc,
                                 float eye_height_m, float rows_per_rad, water_light **out,
                                 facet_error *error)
{
    water_light *l = mem_zalloc(allocator, 1, sizeof *l);
    *out = NULL;
    if (!l)
        return fail_memory(error, "the light of a sea", sizeof *l);
    *l = (water_light){.desc = *desc, .eye_height_m = eye_height_m, .rows_per_rad = rows_per_rad};
    l->desc.allocator = *allocator;
    if (desc->environment)
        environment_retain(desc->environment);
    facet_result result = water_sky_create(&l->desc, eye_height_m, rows_per_rad, &l->sky, error);
    if (result != FACET_OK) {
        destroy_light(l);
        return result;
    }
    water_table_create(desc->sea_shading.normals == FACET_SEA_NORMALS_GGX ? WATER_GGX : WATER_BECKMANN,
                       (int)desc->sea_shading.masking, desc->sea->optics.ior, desc->thread_count, &l->table);
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

/* Compares everything that water_sky_create() and water_table_create() read. */
static bool is_made_for(const water_light *l, const facet_render_desc *desc, float eye_height_m,
                        float rows_per_rad)
{
    const facet_render_desc *a = &l->desc, *b = desc;
    return l->eye_height_m == eye_height_m && (l->sky.has_views || l->rows_per_rad == rows_per_rad) &&
           l->desc.sea_shading.normals == desc->sea_shading.normals &&
           l->desc.sea_shading.masking == desc->sea_shading.masking &&
           is_same_sky(&l->desc.sky, &desc->sky) && is_same_sun(&a->sun, &b->sun) &&
           a->environment == b->environment && a->environment_rotation_rad == b->environment_rotation_rad &&
           a->environment_ev == b->environment_ev;
}

facet_result water_light_update(water_cache *cache, const facet_render_desc *desc, float eye_height_m,
                                float rows_per_rad, facet_error *error)
{
    if (cache->light && is_made_for(cache->light, desc, eye_height_m, rows_per_rad))
        return FACET_OK;
    destroy_light(cache->light);
    return create_light(&cache->allocator, desc, eye_height_m, rows_per_rad, &cache->light, error);
}
