/* light.c - see ibl.h: selects the parts of an environment that a light needs, prepares them once, looks them
 * up. */
#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "base/result.h"
#include "ibl/cache.h"
#include "ibl/environment.h"
#include "ibl/equirect.h"
#include "ibl/light.h"
#include "ibl/studio_draw.h"

/* Version of the preparation; entries of other versions in a cache are ignored. */
static const uint64_t recipe_version = 4;

/* Rows of the sharp image: at 0.35 degrees each, finer than most reflections can show. */
static const double sharp_rows = 512.0;

/* ---- preparing; the environment's mutex is held ---- */

/* Reads a level from the cache; false: not cached, or out of memory. */
static bool read_level(const facet_environment *e, const char *part, uint64_t recipe, uint32_t size,
                       cube *out)
{
    if (!e->cache_folder || cube_create(size, &e->allocator, out, NULL) != FACET_OK)
        return false;
    if (cache_read(e, part, recipe, out->texels, mem_size(out->texels)))
        return true;
    cube_destroy(out);
    return false;
}

static facet_result prepare_harmonics(facet_environment *e, uint32_t thread_count, facet_error *error)
{
    harmonics *out = &e->parts.harmonics;
    if (e->is_studio)
        return studio_harmonics(&e->panorama, &e->allocator, thread_count, out, error);
    return harmonics_create(&e->panorama, PREFILTER_DEGREE, &e->allocator, thread_count, out, error);
}

_Static_assert((int)STUDIO_DEGREE == (int)PREFILTER_DEGREE,
               "the studio's harmonics have the degree of all others");

static facet_result prepare_level(facet_environment *e, prefilter_lobe lobe, uint32_t level,
                                  uint32_t thread_count, facet_error *error)
{
    static const char *const names[PREFILTER_LOBE_COUNT] = {"level", "sheen"};
    light_parts *parts = &e->parts;
    cube *out = &parts->levels[lobe][level];
    if (out->texels)
        return FACET_OK;
    char part[16];
    snprintf(part, sizeof part, "%s%u", names[lobe], level);
    uint64_t recipe = prefilter_recipe(lobe, level) ^ recipe_version;
    if (read_level(e, part, recipe, prefilter_size(lobe, level), out))
        return FACET_OK;
    if (!parts->harmonics.coefficients)
        TRY(prepare_harmonics(e, thread_count, error));
    TRY(prefilter_level(&parts->harmonics, lobe, level, &e->allocator, thread_count, out, error));
    cache_write(e, part, recipe, out->texels, mem_size(out->texels));
    return FACET_OK;
}

/* The panorama, halved as long as at least rows rows remain (0: not halved). */
static facet_result prepare_image(facet_environment *e, double rows, uint32_t thread_count, image *panorama,
                                  facet_error *error)
{
    uint32_t index = 0;
    while (rows > 0.0 && index + 1 < REDUCED_COUNT && (e->panorama.height >> (index + 1)) >= rows)
        index++;
    image *part = index ? &e->parts.reduced[index] : &e->panorama;
    if (!part->pixels) {
        uint32_t width = e->panorama.width >> index;
        TRY(equirect_resize(&e->panorama, width ? width : 1, e->panorama.height >> index, &e->allocator,
                            thread_count, part, error));
    }
    *panorama = *part;
    return FACET_OK;
}

/* Blurred images are not cached: making them is faster than reading them. */
static facet_result prepare_narrow(facet_environment *e, uint32_t thread_count, ibl_light *light,
                                   facet_error *error)
{
    light_parts *parts = &e->parts;
    facet_result result = FACET_OK;
    if (!parts->has_narrow)
        result = narrow_create(&light->sharp, &e->allocator, thread_count, &parts->narrow, error);
    parts->has_narrow = result == FACET_OK;
    light->narrow = &parts->narrow;
    return result;
}

static facet_result prepare_irradiance(facet_environment *e, uint32_t thread_count, ibl_light *light,
                                       facet_error *error)
{
    /* At roughness 1, D is constant and the lobe is the cosine: this is the radiance of a white Lambertian
     * surface, without the dark far side of a sun that nine harmonics have. */
    const uint32_t lambert = prefilter_level_count(PREFILTER_GGX) - 1;
    light->irradiance_over_pi = e->irradiance_over_pi;
    if (e->irradiance_over_pi.texels)
        return FACET_OK;
    TRY(prepare_level(e, PREFILTER_GGX, lambert, thread_count, error));
    light->irradiance_over_pi = e->parts.levels[PREFILTER_GGX][lambert];
    return FACET_OK;
}

/* The levels of a lobe from 1 on. */
static facet_result prepare_levels(facet_environment *e, prefilter_lobe lobe, uint32_t thread_count,
                                   ibl_light *light, facet_error *error)
{
    ibl_level_range range = light->ranges[lobe];
    for (uint32_t level = range.first ? range.first : 1; level <= range.last; level++) {
        TRY(prepare_level(e, lobe, level, thread_count, error));
        light->levels[lobe][level] = e->parts.levels[lobe][level];
    }
    return FACET_OK;
}

/* Fills light with the parts that desc needs. */
static facet_result prepare_parts(facet_environment *e, const ibl_light_desc *desc, ibl_light *light,
                                  facet_error *error)
{
    if (desc->needs_irradiance)
        TRY(prepare_irradiance(e, desc->thread_count, light, error));
    if (desc->needs_specular && light->ranges[PREFILTER_GGX].first == 0) {
        TRY(prepare_image(e, sharp_rows, desc->thread_count, &light->sharp, error));
        if (light->ranges[PREFILTER_GGX].last > 0)
            TRY(prepare_narrow(e, desc->thread_count, light, error));
    }
    for (int lobe = 0; lobe < PREFILTER_LOBE_COUNT; lobe++)
        TRY(prepare_levels(e, (prefilter_lobe)lobe, desc->thread_count, light, error));
    harmonics_trim(&e->parts.harmonics);
    if (desc->needs_background) /* until texels are smaller than pixels */
        TRY(prepare_image(e, 3.14159265358979 * desc->background_size, desc->thread_count, &light->background,
                          error));
    return FACET_OK;
}

static float clamp01(float x)
{
    return x > 0.0f ? (x < 1.0f ? x : 1.0f) : 0.0f; /* NaN becomes 0 */
}

/* Levels that cover roughness from a to b. */
static ibl_level_range find_range(prefilter_lobe lobe, float a, float b)
{
    float low = prefilter_lod_of(lobe, clamp01(a));
    float high = prefilter_lod_of(lobe, clamp01(b));
    return (ibl_level_range){(uint32_t)(low < high ? low : high), (uint32_t)ceilf(low < high ? high : low)};
}

facet_result ibl_light_prepare(facet_environment *environment, const ibl_light_desc *desc,
                               const ibl_light **light, facet_error *error)
{
    assert(environment && desc && light);
    *light = NULL;
    ibl_light *l = mem_zalloc(&environment->allocator, 1, sizeof *l);
    if (!l)
        return fail_memory(error, "light", sizeof *l);
    l->environment = environment;
    const ibl_level_range none = {1, 0};
    l->ranges[PREFILTER_GGX] =
        desc->needs_specular ? find_range(PREFILTER_GGX, desc->min_roughness, desc->max_roughness) : none;
    l->ranges[PREFILTER_SHEEN] =
        desc->needs_sheen ? find_range(PREFILTER_SHEEN, desc->min_sheen_roughness, desc->max_sheen_roughness)
                          : none;
    pthread_mutex_lock(&environment->mutex);
    facet_result result = prepare_parts(environment, desc, l, error);
    environment->reference_count += result == FACET_OK;
    pthread_mutex_unlock(&environment->mutex);
    if (result != FACET_OK) {
        mem_free(l);
        return result;
    }
    *light = l;
    return FACET_OK;
}

facet_result facet_environment_prepare(facet_environment *environment, uint32_t thread_count,
                                       facet_error *error)
{
    assert(environment);
    const ibl_light_desc all = {.thread_count = thread_count,
                                .needs_irradiance = true,
                                .needs_specular = true,
                                .max_roughness = 1.0f,
                                .needs_sheen = true,
                                .max_sheen_roughness = 1.0f};
    const ibl_light *light = NULL;
    facet_result result = ibl_light_prepare(environment, &all, &light, error);
    ibl_light_release(light);
    return result;
}

void ibl_light_release(const ibl_light *light)
{
    if (!light)
        return;
    facet_environment *environment = light->environment;
    ibl_light *own = (ibl_light *)(uintptr_t)light; /* only readers see it as const */
    mem_free(own);
    environment_release(environment);
}

/* ---- looking up ---- */

void ibl_irradiance_over_pi(const ibl_light *light, const float N[3], float out[3])
{
    assert(light->irradiance_over_pi.texels);
    rgbx c = cube_fetch(&light->irradiance_over_pi, cube_locate(N[0], N[1], N[2]));
    for (int i = 0; i < 3; i++)
        out[i] = c[i];
}

/* The lod, clamped to the prepared levels. */
static float find_lod(const ibl_light *light, prefilter_lobe lobe, float perceptual_roughness)
{
    assert(light->ranges[lobe].first <= light->ranges[lobe].last);
    float lod = prefilter_lod_of(lobe, clamp01(perceptual_roughness));
    float first = (float)light->ranges[lobe].first;
    float last = (float)light->ranges[lobe].last;
    return lod < first ? first : lod > last ? last : lod;
}

/* Lookup between roughness 0 and level 1 of GGX. */
static rgbx fetch_narrow(const ibl_light *light, const float R[3], float perceptual_roughness)
{
    equirect_point p = equirect_locate(R);
    if (perceptual_roughness == 0.0f)
        return equirect_fetch(&light->sharp, p);
    float weights[NARROW_PARTS];
    narrow_weights(light->narrow, perceptual_roughness, weights);
    rgbx c =
        cube_fetch(&light->levels[PREFILTER_GGX][1], cube_locate(R[0], R[1], R[2])) * weights[NARROW_LOBE];
    if (weights[NARROW_SHARP] > 0.0f)
        c += equirect_fetch(&light->sharp, p) * weights[NARROW_SHARP];
    for (uint32_t i = 0; i < light->narrow->count; i++)
        if (weights[1 + i] > 0.0f)
            c += equirect_fetch(&light->narrow->blurred[i], p) * weights[1 + i];
    return c;
}

void ibl_specular(const ibl_light *light, const float R[3], float perceptual_roughness, float out[3])
{
    const cube *levels = light->levels[PREFILTER_GGX];
    float lod = find_lod(light, PREFILTER_GGX, perceptual_roughness);
    uint32_t level = (uint32_t)lod;
    float fraction = lod - (float)level;
    rgbx c;
    if (level == 0) {
        c = fetch_narrow(light, R, fraction * NARROW_END);
    } else {
        cube_point p = cube_locate(R[0], R[1], R[2]);
        c = cube_fetch(&levels[level], p);
        if (fraction > 0.0f)
            c += (cube_fetch(&levels[level + 1], p) - c) * fraction;
    }
    for (int i = 0; i < 3; i++)
        out[i] = c[i];
}

void ibl_sheen(const ibl_light *light, const float N[3], float sheen_roughness, float out[3])
{
    const cube *levels = light->levels[PREFILTER_SHEEN];
    float lod = find_lod(light, PREFILTER_SHEEN, sheen_roughness);
    uint32_t level = (uint32_t)lod;
    float fraction = lod - (float)level;
    cube_point p = cube_locate(N[0], N[1], N[2]);
    rgbx c = cube_fetch(&levels[level], p);
    if (fraction > 0.0f)
        c += (cube_fetch(&levels[level + 1], p) - c) * fraction;
    for (int i = 0; i < 3; i++)
        out[i] = c[i];
}

void ibl_background(const ibl_light *light, const float d[3], float footprint_rad, float out[3])
{
    assert(light->background.pixels);
    (void)footprint_rad;
    equirect_lookup(&light->background, d, out);
}
