/* water_around.c - see water_around.h. */
#include "base/parallel.h"
#include "base/result.h"
#include "ibl/environment.h"
#include "ibl/equirect.h"

#include "water/water_around.h"
#include "water/water_shade.h"

enum { HEIGHT = 128 };

static bool has_foam(const water_setup *s)
{
    return s->foam.share.level_count > 0;
}

/* Mean coverage by foam. Where there is foam, its amount is a quarter: of a coverage of 0.105 at 20 m/s, the
 * mean square is 0.025. */
static float foam_on_average(const water_setup *s)
{
    return water_foam_cover(s->sea->foam.coverage, 0.25f);
}

/* Radiance from a direction: of the sky, or the mean over the whole sea; over a bed, with the depth at the
 * origin. */
static vec3 surroundings(const water_setup *s, vec3 d)
{
    if (d[1] >= 0.0f)
        return water_sky_reflected(&s->sky, d, 0.0f);
    float means[4], mu = max(-d[1], 1e-3f);
    WaterPoint point;
    point.N = vec3(0.0f, 1.0f, 0.0f);
    point.covariance = water_slopes_of(&s->sea->slopes.total);
    point.foam = 0.0f;
    water_table_at(&s->table, mu, water_sigma_of(point.covariance), means);
    WaterMirror m = water_mirror(s->water, point, -d, means[0], means[1], means[2], means[3]);
    vec3 sky = water_sky_reflected(&s->sky, m.R, m.perceptual_roughness);
    vec3 below = water_from_still(s, s->sea->desc.bed.depth_m, water_refracted(s->water, d, point.N));
    vec3 L = mix(below * (1.0f / (s->water.ior * s->water.ior)), sky, m.fresnel);
    return has_foam(s) ? mix(L, water_foam(s->water, s->light, point.N), foam_on_average(s)) : L;
}

typedef struct surroundings_drawing {
    const water_setup *setup;
    const image *picture;
} surroundings_drawing;

static void draw_surroundings(void *context, size_t begin, size_t end)
{
    const surroundings_drawing *drawing = context;
    const water_setup *s = drawing->setup;
    const image *picture = drawing->picture;
    for (size_t y = begin; y < end; y++) {
        float *texel = (float *)picture->pixels + y * picture->width * 3;
        for (uint32_t x = 0; x < picture->width; x++, texel += 3) {
            float d[3];
            equirect_direction(picture->width, picture->height, (double)x, (double)y, d);
            vec3 L = surroundings(s, vec3(d[0], d[1], d[2]));
            for (int i = 0; i < 3; i++)
                texel[i] = L[i];
        }
    }
}

facet_result water_around_prepare(water_setup *s, facet_error *error)
{
    const facet_render_desc *r = s->desc;
    const facet_environment_desc desc = {.allocator = s->cache->allocator};
    facet_environment *around;
    if (s->cache->light->around && s->cache->light->around_has_foam == has_foam(s))
        return FACET_OK;
    facet_result result = environment_create(&desc, &around, error);
    if (result == FACET_OK)
        result = image_create(&desc.allocator, 2 * HEIGHT, HEIGHT, 3, IMAGE_F32, &around->panorama, error);
    if (result != FACET_OK) {
        if (around)
            environment_release(around);
        return result;
    }
    surroundings_drawing drawing = {s, &around->panorama};
    parallel_for(r->thread_count, HEIGHT, 8, draw_surroundings, &drawing);
    environment_limit(around, r->thread_count);
    if (s->cache->light->around)
        environment_release(s->cache->light->around);
    s->cache->light->around = around;
    s->cache->light->around_has_foam = has_foam(s);
    return FACET_OK;
}
