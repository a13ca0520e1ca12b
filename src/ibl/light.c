/* light.c - lights: which parts of an environment one needs, preparing them once, looking up in them. */
#include <assert.h>
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/result.h"
#include "ibl/environment.h"
#include "ibl/ibl.h"

/* What a light looks up in, shared with the environment, which it keeps. */
struct ibl_light {
    facet_environment *environment;
    bool has_irradiance;
    float irradiance_over_pi[SH_COUNT][3];
    uint32_t first_level, last_level;   /* prepared; last_level < first_level: none */
    cube levels[PREFILTER_LEVEL_COUNT]; /* not owned */
    equirect background;                /* not owned */
};

/* ---- preparing; the environment's mutex is held ---- */

static facet_result prepare_irradiance(facet_environment *e, uint32_t thread_count, facet_error *error)
{
    light_parts *parts = &e->parts;
    if (parts->has_irradiance)
        return FACET_OK;
    double radiance[SH_COUNT][3];
    facet_result result = sh_project(&e->picture, &e->allocator, thread_count, radiance, error);
    if (result != FACET_OK)
        return result;
    sh_irradiance_over_pi((const double(*)[3])radiance, parts->irradiance_over_pi);
    parts->has_irradiance = true;
    return FACET_OK;
}

/* Texels along an edge of the sharp cube: half the picture's height is as fine as the picture at the horizon. */
static uint32_t sharp_size(const image *picture)
{
    uint32_t size = 16;
    while (size < PREFILTER_MAX_SIZE && 2 * size < picture->height)
        size *= 2;
    return size;
}

static facet_result prepare_sharp(facet_environment *e, uint32_t thread_count, facet_error *error)
{
    cube *out = &e->parts.levels[0];
    if (out->texels)
        return FACET_OK;
    uint32_t size = sharp_size(&e->picture);
    uint32_t width = e->picture.width < 4 * size ? e->picture.width : 4 * size;
    uint32_t height = e->picture.height < 2 * size ? e->picture.height : 2 * size;
    equirect source;
    facet_result result =
        equirect_create(&e->picture, width, height, true, &e->allocator, thread_count, &source, error);
    if (result != FACET_OK)
        return result;
    result = cube_from_equirect(&source, size, &e->allocator, thread_count, out, error);
    equirect_destroy(&source);
    return result;
}

static facet_result prepare_level(facet_environment *e, uint32_t level, uint32_t thread_count,
                                  facet_error *error)
{
    light_parts *parts = &e->parts;
    if (parts->levels[level].texels)
        return FACET_OK;
    if (level < PREFILTER_SAMPLED_COUNT) {
        facet_result result = prepare_sharp(e, thread_count, error);
        if (result == FACET_OK && level > 0)
            result = prefilter_sampled(&parts->levels[0], level, &e->allocator, thread_count,
                                       &parts->levels[level], error);
        return result;
    }
    if (!parts->harmonics.coefficients) {
        facet_result result =
            harmonics_create(&e->picture, &e->allocator, thread_count, &parts->harmonics, error);
        if (result != FACET_OK)
            return result;
    }
    return prefilter_harmonics(&parts->harmonics, level, &e->allocator, thread_count, &parts->levels[level],
                               error);
}

/* How often the background is halved: its texels stay smaller than pixels of 1 / background_size rad. */
static uint32_t background_index(const image *picture, uint32_t background_size)
{
    uint32_t index = 0;
    double needed = 3.14159265358979 * background_size; /* rows */
    while (background_size && index + 1 < BACKGROUND_COUNT && (picture->height >> (index + 1)) >= needed)
        index++;
    return index;
}

static facet_result prepare_background(facet_environment *e, uint32_t index, uint32_t thread_count,
                                       facet_error *error)
{
    equirect *out = &e->parts.backgrounds[index];
    if (out->texels)
        return FACET_OK;
    uint32_t width = e->picture.width >> index;
    uint32_t height = e->picture.height >> index;
    return equirect_create(&e->picture, width ? width : 1, height ? height : 1, false, &e->allocator,
                           thread_count, out, error);
}

/* Fills light with the parts that desc asks for. */
static facet_result prepare_parts(facet_environment *e, const ibl_light_desc *desc, ibl_light *light,
                                  facet_error *error)
{
    facet_result result = FACET_OK;
    if (desc->needs_irradiance) {
        result = prepare_irradiance(e, desc->thread_count, error);
        if (result != FACET_OK)
            return result;
        light->has_irradiance = true;
        memcpy(light->irradiance_over_pi, e->parts.irradiance_over_pi, sizeof light->irradiance_over_pi);
    }
    for (uint32_t level = light->first_level; level <= light->last_level; level++) {
        result = prepare_level(e, level, desc->thread_count, error);
        if (result != FACET_OK)
            return result;
        light->levels[level] = e->parts.levels[level];
    }
    if (desc->needs_background) {
        uint32_t index = background_index(&e->picture, desc->background_size);
        result = prepare_background(e, index, desc->thread_count, error);
        light->background = e->parts.backgrounds[index];
    }
    return result;
}

static float clamp01(float x)
{
    return x > 0.0f ? (x < 1.0f ? x : 1.0f) : 0.0f; /* NaN is 0 */
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
    l->first_level = 1;
    if (desc->needs_specular) {
        float low = clamp01(desc->min_roughness) * (PREFILTER_LEVEL_COUNT - 1);
        float high = clamp01(desc->max_roughness) * (PREFILTER_LEVEL_COUNT - 1);
        l->first_level = (uint32_t)(low < high ? low : high);
        l->last_level = (uint32_t)ceilf(low < high ? high : low);
    }
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

void ibl_light_release(const ibl_light *light)
{
    if (!light)
        return;
    facet_environment *environment = light->environment;
    ibl_light *own = (ibl_light *)(uintptr_t)light; /* const is for the readers */
    mem_free(own);
    environment_release(environment);
}

/* ---- looking up ---- */

void ibl_irradiance_over_pi(const ibl_light *light, const float N[3], float out[3])
{
    assert(light->has_irradiance);
    sh_evaluate((const float(*)[3])light->irradiance_over_pi, N, out);
}

void ibl_specular(const ibl_light *light, const float R[3], float perceptual_roughness, float out[3])
{
    assert(light->first_level <= light->last_level);
    float lod = clamp01(perceptual_roughness) * (PREFILTER_LEVEL_COUNT - 1);
    float first = (float)light->first_level;
    float last = (float)light->last_level;
    lod = lod < first ? first : lod > last ? last : lod;
    uint32_t level = (uint32_t)lod;
    float fraction = lod - (float)level;
    cube_point p = cube_locate(R[0], R[1], R[2]);
    rgbx c = cube_fetch(&light->levels[level], p);
    if (fraction > 0.0f)
        c += (cube_fetch(&light->levels[level + 1], p) - c) * fraction;
    for (int i = 0; i < 3; i++)
        out[i] = c[i];
}

void ibl_background(const ibl_light *light, const float d[3], float footprint_rad, float out[3])
{
    assert(light->background.texels);
    (void)footprint_rad;
    rgbx c = equirect_lookup(&light->background, d);
    for (int i = 0; i < 3; i++)
        out[i] = c[i];
}
