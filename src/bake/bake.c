/* bake.c - cube maps of an environment for a lobe: which levels, and what makes them. */
#include "bake/bake.h"

#include <assert.h>

#include "base/clock.h"
#include "base/memory.h"
#include "base/result.h"
#include "ibl/environment.h"
#include "ibl/equirect.h"

enum { DEFAULT_SIZE = 256, LAMBERT_SIZE = 64, MIN_LEVEL_SIZE = 16, MAX_SIZE = 8192 };

static const facet_bake_desc default_desc;

float bake_roughness(facet_roughness_mapping mapping, uint32_t level, uint32_t level_count)
{
    float x = level_count > 1 ? (float)level / (float)(level_count - 1) : 0.0f;
    return mapping == FACET_MAPPING_FILAMENT ? 1.0f - sqrtf(1.0f - x) : x;
}

/* desc with its defaults filled in. */
static facet_result complete(facet_bake_desc *desc, facet_error *error)
{
    bool is_lambert = desc->lobe == FACET_LOBE_LAMBERT;
    desc->size = desc->size ? desc->size : is_lambert ? LAMBERT_SIZE : DEFAULT_SIZE;
    if (desc->size > MAX_SIZE || (desc->size & (desc->size - 1)))
        return fail(error, FACET_ERROR_ARGUMENT,
                    "bake: size %u: a power of two from 1 to %d texels was expected", desc->size, MAX_SIZE);
    uint32_t most = 32u - (uint32_t)__builtin_clz(desc->size);
    if (desc->level_count > most)
        return fail(error, FACET_ERROR_ARGUMENT, "bake: %u levels: a cube map of %u texels has at most %u",
                    desc->level_count, desc->size, most);
    if (desc->level_count == 0)
        desc->level_count = is_lambert || desc->size < MIN_LEVEL_SIZE ? 1 : most - 4;
    desc->samples = desc->samples ? desc->samples : 1024;
    return FACET_OK;
}

static void fill_mirror(const facet_environment *environment, double rotation, cube *out)
{
    double c = cos(rotation);
    double s = sin(rotation);
    for (uint32_t face = 0; face < 6; face++)
        for (uint32_t y = 0; y < out->size; y++)
            for (uint32_t x = 0; x < out->size; x++) {
                double d[3];
                cube_direction(face, (2.0 * x + 1.0) / out->size - 1.0, (2.0 * y + 1.0) / out->size - 1.0, d);
                double r = 1.0 / sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
                const float e[3] = {(float)((d[0] * c - d[2] * s) * r), (float)(d[1] * r),
                                    (float)((d[0] * s + d[2] * c) * r)};
                *cube_texel(out, face, (int)x, (int)y) =
                    equirect_fetch(&environment->picture, equirect_locate(e));
            }
    cube_fill_borders(out);
}

static facet_result fill_levels(const facet_environment *environment, const facet_bake_desc *desc,
                                facet_cube *c, facet_error *error)
{
    harmonics h = {0};
    facet_result result = harmonics_create(&environment->picture, PREFILTER_DEGREE, &desc->allocator,
                                           desc->thread_count, &h, error);
    for (uint32_t level = 0; result == FACET_OK && level < c->level_count; level++) {
        uint32_t size = desc->size >> level;
        float roughness = c->roughness[level];
        if (roughness == 0.0f && desc->lobe != FACET_LOBE_CHARLIE) {
            result = cube_create(size, &desc->allocator, &c->levels[level], error);
            if (result == FACET_OK)
                fill_mirror(environment, (double)desc->rotation_rad, &c->levels[level]);
            continue;
        }
        float kernel[PREFILTER_DEGREE + 1];
        prefilter_lobe lobe = desc->lobe == FACET_LOBE_CHARLIE ? PREFILTER_CHARLIE : PREFILTER_GGX;
        float least = lobe == PREFILTER_CHARLIE ? 0.1f : 0.05f;
        prefilter_kernel(lobe, roughness > least ? roughness : least, PREFILTER_DEGREE, kernel);
        prefilter_taper(PREFILTER_DEGREE, kernel);
        result = harmonics_filter(&h,
                                  &(harmonics_filter_desc){.kernel = kernel,
                                                           .degree = PREFILTER_DEGREE,
                                                           .rotation_rad = (double)desc->rotation_rad,
                                                           .scale = exp2f(desc->ev),
                                                           .size = size,
                                                           .allocator = &desc->allocator,
                                                           .thread_count = desc->thread_count},
                                  &c->levels[level], error);
    }
    harmonics_destroy(&h);
    return result;
}

facet_result facet_cube_bake(facet_environment *environment, const facet_bake_desc *given, facet_cube **out,
                             facet_error *error)
{
    assert(environment && out);
    *out = NULL;
    facet_bake_desc desc = given ? *given : default_desc;
    double start_s = clock_seconds();
    facet_result result = complete(&desc, error);
    if (result != FACET_OK)
        return result;
    facet_cube *c = mem_zalloc(&desc.allocator, 1, sizeof *c);
    if (!c)
        return fail_memory(error, "cube map", sizeof *c);
    c->allocator = desc.allocator;
    c->lobe = desc.lobe;
    c->level_count = desc.level_count;
    for (uint32_t level = 0; level < desc.level_count; level++)
        c->roughness[level] = desc.lobe == FACET_LOBE_LAMBERT ? 1.0f
                              : desc.lobe == FACET_LOBE_NONE
                                  ? 0.0f
                                  : bake_roughness(desc.mapping, level, desc.level_count);
    result = fill_levels(environment, &desc, c, error);
    c->stats.total_s = clock_seconds() - start_s;
    if (result != FACET_OK) {
        facet_cube_destroy(c);
        return result;
    }
    *out = c;
    return FACET_OK;
}

void facet_cube_destroy(facet_cube *c)
{
    if (!c)
        return;
    for (uint32_t level = 0; level < c->level_count; level++)
        cube_destroy(&c->levels[level]);
    mem_free(c);
}

uint32_t facet_cube_get_level_count(const facet_cube *c)
{
    return c->level_count;
}

uint32_t facet_cube_get_size(const facet_cube *c, uint32_t level)
{
    return c->levels[level].size;
}

float facet_cube_get_roughness(const facet_cube *c, uint32_t level)
{
    return c->roughness[level];
}

facet_image_view facet_cube_get_face(const facet_cube *c, uint32_t level, uint32_t face)
{
    uint32_t size = c->levels[level].size;
    return (facet_image_view){.name = "",
                              .width = size,
                              .height = size,
                              .channel_count = 4,
                              .pixels = (const float *)cube_texel(&c->levels[level], face, 0, 0),
                              .row_stride_bytes = ((size_t)size + 2) * sizeof(rgbx)};
}

facet_bake_stats facet_cube_get_stats(const facet_cube *c)
{
    return c->stats;
}
