/* bake.c - cube maps of an environment filtered with a lobe: the method of each level, and the objects of
 * facet.h. */
#include "bake/bake.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "bake/bake_area.h"
#include "bake/bake_reference.h"
#include "bake/bake_sampling.h"
#include "base/clock.h"
#include "base/memory.h"
#include "base/result.h"
#include "ibl/environment.h"
#include "ibl/prefilter.h"
#include "ibl/sh.h"

enum {
    DEFAULT_SIZE = 256,
    LAMBERT_SIZE = 64,
    MIN_LEVELS = 5, /* if the size allows: fewer steps of roughness are too coarse */
    MAX_SIZE = 8192,
    DEFAULT_SAMPLES = 1024,
    MAX_SAMPLES = 1 << 20,
    MAX_PYRAMID = 1024, /* 134 MB; larger only for larger results */
    MIN_DEGREE = 256    /* of the analysis of a fine panorama */
};

static const facet_bake_desc default_desc;

static float bake_roughness(facet_roughness_mapping mapping, uint32_t level, uint32_t level_count)
{
    float x = level_count > 1 ? (float)level / (float)(level_count - 1) : 0.0f;
    return mapping == FACET_ROUGHNESS_MAPPING_FILAMENT ? 1.0f - sqrtf(1.0f - x) : x;
}

facet_result bake_complete(facet_bake_desc *desc, facet_error *error)
{
    bool is_lambert = desc->lobe == FACET_LOBE_LAMBERT;
    if ((uint32_t)desc->lobe > FACET_LOBE_NONE ||
        (uint32_t)desc->mapping > FACET_ROUGHNESS_MAPPING_FILAMENT ||
        (uint32_t)desc->method > FACET_BAKE_METHOD_REFERENCE)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "bake: lobe %u, mapping %u, method %u: one of facet.h's was expected",
                    (uint32_t)desc->lobe, (uint32_t)desc->mapping, (uint32_t)desc->method);
    if (!isfinite(desc->rotation_rad) || !isfinite(desc->ev) || !isfinite(desc->clamp) || desc->clamp < 0.0f)
        return fail(
            error, FACET_ERROR_ARGUMENT,
            "bake: rotation %g, ev %g, clamp %g: finite numbers, and 0 or more to clamp at, were expected",
            (double)desc->rotation_rad, (double)desc->ev, (double)desc->clamp);
    desc->size = desc->size ? desc->size : is_lambert ? LAMBERT_SIZE : DEFAULT_SIZE;
    if (desc->size > MAX_SIZE || (desc->size & (desc->size - 1)))
        return fail(error, FACET_ERROR_ARGUMENT,
                    "bake: size %u: a power of two from 1 to %d texels was expected", desc->size, MAX_SIZE);
    uint32_t most = 32u - (uint32_t)__builtin_clz(desc->size);
    if (desc->level_count > most)
        return fail(error, FACET_ERROR_ARGUMENT, "bake: %u levels: a cube map of %u texels has at most %u",
                    desc->level_count, desc->size, most);
    if (desc->level_count == 0)
        desc->level_count = is_lambert              ? 1
                            : most > MIN_LEVELS + 4 ? most - 4
                            : most < MIN_LEVELS     ? most
                                                    : MIN_LEVELS;
    desc->samples = desc->samples ? desc->samples : DEFAULT_SAMPLES;
    if (desc->samples > MAX_SAMPLES)
        return fail(error, FACET_ERROR_ARGUMENT, "bake: %u samples per texel: at most %d were expected",
                    desc->samples, MAX_SAMPLES);
    return FACET_OK;
}

bool bake_level_is_sharp(const facet_cube *c, uint32_t level)
{
    return c->lobe == FACET_LOBE_NONE || (c->lobe == FACET_LOBE_GGX && c->roughness[level] == 0.0f);
}

/* ---- plans ---- */

typedef enum level_kind { LEVEL_SHARP, LEVEL_HARMONICS, LEVEL_SAMPLED, LEVEL_REFERENCE } level_kind;

typedef struct level_plan {
    level_kind kind;
    uint32_t degree;
    float *kernel; /* of plans.kernels */
    bake_lobe lobe;
    double work; /* estimate in ns */
} level_plan;

typedef struct bake_plans {
    level_plan levels[FACET_CUBE_MAX_LEVELS];
    float *kernels;
    uint32_t degree;       /* of the harmonic analysis; 0: none */
    uint32_t pyramid_size; /* 0: none */
    bool needs_reference;
    double analysis_work, pyramid_work;
} bake_plans;

/* Chooses the method of a level with a lobe. */
static void plan_lobe(const facet_bake_desc *desc, const bake_source *source, float roughness,
                      bake_plans *plans, level_plan *plan)
{
    plan->lobe = bake_lobe_create(desc->lobe, roughness);
    plan->kind = desc->method == FACET_BAKE_METHOD_REFERENCE ? LEVEL_REFERENCE : LEVEL_SAMPLED;
    if (desc->method == FACET_BAKE_METHOD_AUTO &&
        bake_lobe_kernel(&plan->lobe, plan->kernel, &plan->degree)) {
        plan->kind = LEVEL_HARMONICS;
        plans->degree = plan->degree > plans->degree ? plan->degree : plans->degree;
    }
    if (plan->kind == LEVEL_SAMPLED) {
        uint32_t most = desc->size > MAX_PYRAMID ? desc->size : MAX_PYRAMID;
        uint32_t size = bake_pyramid_size(&plan->lobe, desc->samples, source->panorama.height, most);
        plans->pyramid_size = size > plans->pyramid_size ? size : plans->pyramid_size;
    }
    plans->needs_reference |= plan->kind == LEVEL_REFERENCE;
}

/* kernels: (HARMONICS_MAX_DEGREE + 1) floats for each level. */
static double make_plans(const facet_bake_desc *desc, const facet_cube *c, const bake_source *source,
                         bake_plans *plans)
{
    double texels = (double)source->panorama.width * source->panorama.height;
    double total = 0.0;
    for (uint32_t i = 0; i < c->level_count; i++) {
        level_plan *plan = &plans->levels[i];
        plan->kernel = plans->kernels + (size_t)i * (HARMONICS_MAX_DEGREE + 1);
        if (!bake_level_is_sharp(c, i))
            plan_lobe(desc, source, c->roughness[i], plans, plan);
        double size = desc->size >> i;
        double degree = plan->degree;
        plan->work = plan->kind == LEVEL_SHARP       ? 300.0 * size * size
                     : plan->kind == LEVEL_HARMONICS ? 0.3 * degree * degree * degree + 150.0 * size * size
                     : plan->kind == LEVEL_SAMPLED   ? 6.0 * size * size * desc->samples
                                                     : 6.0 * size * size * texels;
        total += plan->work;
    }
    /* analyses of low degrees would average texels of fine panoramas */
    while (plans->degree > 0 && plans->degree < MIN_DEGREE &&
           (16 * plans->degree < source->panorama.width || 8 * plans->degree < source->panorama.height))
        plans->degree += 32;
    plans->analysis_work = 0.15 * plans->degree * plans->degree * source->panorama.height;
    plans->pyramid_work = 400.0 * plans->pyramid_size * plans->pyramid_size;
    return total + plans->analysis_work + plans->pyramid_work;
}

/* ---- levels ---- */

/* Inputs of the levels, as far as they are needed. */
typedef struct bake_materials {
    bake_source source;
    bake_plans plans;
    harmonics harmonics;
    bake_pyramid pyramid;
    bake_reference reference;
    bake_watch watch;
} bake_materials;

static facet_result create_materials(const facet_environment *environment, const facet_bake_desc *desc,
                                     const facet_cube *c, bake_materials *m, facet_error *error)
{
    size_t count = (size_t)c->level_count * (HARMONICS_MAX_DEGREE + 1);
    m->plans.kernels = mem_alloc(&desc->allocator, count, sizeof(float));
    facet_result result = m->plans.kernels ? FACET_OK : fail_memory(error, "cube map", count * sizeof(float));
    if (result == FACET_OK)
        result = bake_source_create(environment, desc, &m->source, error);
    if (result != FACET_OK)
        return result;
    bake_watch_init(&m->watch, &desc->progress, "bake", make_plans(desc, c, &m->source, &m->plans));
    bake_watch_add(&m->watch, 0.0);
    if (m->plans.degree > 0) {
        result = harmonics_create(&m->source.panorama, m->plans.degree, &desc->allocator, desc->thread_count,
                                  &m->harmonics, error);
        bake_watch_add(&m->watch, m->plans.analysis_work);
    }
    if (result == FACET_OK && m->plans.pyramid_size > 0) {
        result = bake_pyramid_create(&m->source, m->plans.pyramid_size, &desc->allocator, desc->thread_count,
                                     &m->pyramid, error);
        bake_watch_add(&m->watch, m->plans.pyramid_work);
    }
    if (result == FACET_OK && m->plans.needs_reference)
        result = bake_reference_create(&m->source, &desc->allocator, &m->reference, error);
    return result;
}

static void destroy_materials(bake_materials *m)
{
    harmonics_destroy(&m->harmonics);
    bake_pyramid_destroy(&m->pyramid);
    bake_reference_destroy(&m->reference);
    bake_source_destroy(&m->source);
    mem_free(m->plans.kernels);
}

static facet_result fill_sharp(const facet_bake_desc *desc, bake_materials *m, facet_cube *c, uint32_t level,
                               facet_error *error)
{
    TRY(cube_create(desc->size >> level, &desc->allocator, &c->levels[level], error));
    if (level == 0)
        return bake_sharp(&m->source, m->source.scale, &desc->allocator, desc->thread_count, &c->levels[0],
                          error);
    bake_halve(&c->levels[level - 1], desc->thread_count, &c->levels[level]);
    return FACET_OK;
}

static facet_result fill_level(const facet_bake_desc *desc, bake_materials *m, facet_cube *c, uint32_t level,
                               facet_error *error)
{
    level_plan *plan = &m->plans.levels[level];
    cube *out = &c->levels[level];
    uint32_t size = desc->size >> level;
    facet_result result = FACET_OK;
    if (plan->kind == LEVEL_SHARP) {
        result = fill_sharp(desc, m, c, level, error);
        bake_watch_add(&m->watch, plan->work);
        return result;
    }
    if (plan->kind == LEVEL_HARMONICS) {
        result = harmonics_filter(&m->harmonics,
                                  &(harmonics_filter_desc){.kernel = plan->kernel,
                                                           .degree = plan->degree,
                                                           .rotation_rad = m->source.rotation_rad,
                                                           .scale = m->source.scale,
                                                           .size = size,
                                                           .allocator = &desc->allocator,
                                                           .thread_count = desc->thread_count},
                                  out, error);
        bake_watch_add(&m->watch, plan->work);
        return result;
    }
    TRY(cube_create(size, &desc->allocator, out, error));
    double texels = 6.0 * size * size;
    if (plan->kind == LEVEL_REFERENCE) {
        bake_reference_fill(&m->reference, &plan->lobe, desc->thread_count, &m->watch, out);
        c->stats.samples += (uint64_t)(texels * m->source.panorama.width * m->source.panorama.height);
        return FACET_OK;
    }
    c->stats.samples += (uint64_t)(texels * desc->samples);
    return bake_sample(&m->pyramid, &plan->lobe, desc->samples, &desc->allocator, desc->thread_count,
                       &m->watch, out, error);
}

static facet_result fill_levels(const facet_environment *environment, const facet_bake_desc *desc,
                                facet_cube *c, facet_error *error)
{
    bake_materials m = {.plans = {.degree = 0}};
    facet_result result = create_materials(environment, desc, c, &m, error);
    for (uint32_t level = 0; result == FACET_OK && level < c->level_count; level++) {
        if (bake_watch_is_cancelled(&m.watch))
            break;
        result = fill_level(desc, &m, c, level, error);
    }
    c->stats.clamped_share = m.source.cut_share;
    if (result == FACET_OK)
        result = bake_watch_explain(&m.watch, error);
    destroy_materials(&m);
    return result;
}

facet_result facet_cube_bake(facet_environment *environment, const facet_bake_desc *given, facet_cube **out,
                             facet_error *error)
{
    assert(environment && out);
    *out = NULL;
    facet_bake_desc desc = given ? *given : default_desc;
    double start_s = clock_seconds();
    TRY(bake_complete(&desc, error));
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
    facet_result result = fill_levels(environment, &desc, c, error);
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

/* ---- mirrored cube maps ---- */

static const facet_allocator default_allocator;

/* Mirrors x: direction (1, -t, -s) of +X becomes (-1, -t, -s), which is (-s, t) on -X; on the other faces s
 * changes sign. */
static void mirror_level(const cube *from, cube *to)
{
    static const uint32_t others[6] = {1, 0, 2, 3, 4, 5};
    const int n = (int)from->size;
    for (uint32_t face = 0; face < 6; face++)
        for (int y = -1; y <= n; y++) /* including the borders */
            for (int x = -1; x <= n; x++)
                *cube_texel(to, others[face], n - 1 - x, y) = *cube_texel(from, face, x, y);
}

facet_result facet_cube_create_mirrored(const facet_cube *c, const facet_allocator *allocator,
                                        facet_cube **out, facet_error *error)
{
    allocator = allocator ? allocator : &default_allocator;
    *out = NULL;
    facet_cube *mirrored = mem_alloc(allocator, 1, sizeof *mirrored);
    if (!mirrored)
        return fail_memory(error, "cube map", sizeof *mirrored);
    *mirrored = *c;
    mirrored->allocator = *allocator;
    memset(mirrored->levels, 0, sizeof mirrored->levels);
    for (uint32_t level = 0; level < c->level_count; level++) {
        facet_result result = cube_create(c->levels[level].size, allocator, &mirrored->levels[level], error);
        if (result != FACET_OK) {
            facet_cube_destroy(mirrored);
            return result;
        }
        mirror_level(&c->levels[level], &mirrored->levels[level]);
    }
    *out = mirrored;
    return FACET_OK;
}

/* ---- harmonics ---- */

static const facet_sh_desc default_sh_desc;

facet_result facet_environment_project_sh(const facet_environment *environment, const facet_sh_desc *desc,
                                          float coefficients[9][3], facet_error *error)
{
    assert(environment && coefficients);
    desc = desc ? desc : &default_sh_desc;
    if ((uint32_t)desc->form > FACET_SH_FORM_FOLDED)
        return fail(error, FACET_ERROR_ARGUMENT, "harmonics: form %u: 0 to %d were expected",
                    (uint32_t)desc->form, FACET_SH_FORM_FOLDED);
    if (!isfinite(desc->rotation_rad) || !isfinite(desc->ev) || !isfinite(desc->clamp) || desc->clamp < 0.0f)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "harmonics: rotation %g, ev %g, clamp %g: finite numbers, and 0 or more to clamp at, "
                    "were expected",
                    (double)desc->rotation_rad, (double)desc->ev, (double)desc->clamp);
    double radiance[SH_COUNT][3];
    TRY(sh_project_limited(&environment->panorama, desc->clamp > 0.0f ? desc->clamp : INFINITY,
                           &desc->allocator, desc->thread_count, radiance, error));
    sh_rotate(radiance, (double)desc->rotation_rad);
    double scale = exp2((double)desc->ev);
    for (int k = 0; k < SH_COUNT; k++)
        for (int i = 0; i < 3; i++)
            radiance[k][i] *= scale;
    if (desc->is_windowed)
        sh_dering(radiance);
    double irradiance[SH_COUNT][3];
    sh_irradiance((const double(*)[3])radiance, irradiance);
    if (desc->form == FACET_SH_FORM_FOLDED) {
        sh_fold_over_pi((const double(*)[3])irradiance, coefficients);
        return FACET_OK;
    }
    for (int k = 0; k < SH_COUNT; k++)
        for (int i = 0; i < 3; i++)
            coefficients[k][i] =
                (float)(desc->form == FACET_SH_FORM_IRRADIANCE ? irradiance[k][i] : radiance[k][i]);
    return FACET_OK;
}
