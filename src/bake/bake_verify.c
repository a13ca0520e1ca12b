/* bake_verify.c - errors of a cube map against the reference (bake_reference.h): all texels of small levels,
 * a fixed selection of large ones. */
#include <assert.h>
#include <math.h>

#include "bake/bake.h"

#include "bake/bake_reference.h"
#include "bake/bake_area.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"

enum {
    MAX_TEXELS = 6 * 16 * 16, /* all of a level of 16 texels */
    MIN_TEXELS = 96
};

/* Texels of the panorama to weight per level: 0.5 to 1 s of one core. */
static const double image_texels = 8e8;

static const facet_bake_desc default_desc;

/* Errors of one texel over its channels. */
typedef struct texel_error {
    double square, reference_square, max;
} texel_error;

typedef struct verifying {
    const bake_reference *reference;
    const cube *level;
    bake_reference_lobe lobe;
    bool is_sharp, is_interpolated;
    uint32_t count;
    texel_error *errors;
    bake_watch *watch;
} verifying;

/* Index of selected texel i. */
static uint32_t choose_texel(const verifying *job, uint32_t i)
{
    uint32_t texels = 6 * job->level->size * job->level->size;
    if (job->count == texels)
        return i;
    /* one in each of count equal parts, at a position given by a multiplicative hash (Knuth 1973) */
    uint64_t first = (uint64_t)texels * i / job->count;
    uint64_t next = (uint64_t)texels * (i + 1) / job->count;
    return (uint32_t)(first + (uint64_t)(i * 2654435761u) * (next - first) / 0x100000000ull);
}

static void verify_texels(void *context, size_t begin, size_t end)
{
    const verifying *job = context;
    uint32_t size = job->level->size;
    const image *panorama = &job->reference->source->panorama;
    for (size_t i = begin; i < end; i++) {
        if (!bake_watch_add(job->watch, (double)panorama->width * panorama->height))
            return;
        uint32_t texel = choose_texel(job, (uint32_t)i);
        uint32_t face = texel / size / size;
        uint32_t y = texel / size % size;
        uint32_t x = texel % size;
        double expected[3], d[3];
        cube_direction(face, (2.0 * x + 1.0) / size - 1.0, (2.0 * y + 1.0) / size - 1.0, d);
        if (job->is_sharp)
            bake_reference_average(job->reference, job->is_interpolated, size, face, x, y, expected);
        else
            bake_reference_gather(job->reference, &job->lobe, d, expected);
        texel_error *e = &job->errors[i];
        *e = (texel_error){0.0, 0.0, 0.0};
        for (int k = 0; k < 3; k++) {
            double error = fabs((double)(*cube_texel(job->level, face, (int)x, (int)y))[k] - expected[k]);
            e->square += error * error;
            e->reference_square += expected[k] * expected[k];
            e->max = fmax(e->max, error);
        }
    }
}

static facet_cube_error sum_up(const verifying *job)
{
    texel_error sum = {0.0, 0.0, 0.0};
    for (uint32_t i = 0; i < job->count; i++) {
        sum.square += job->errors[i].square;
        sum.reference_square += job->errors[i].reference_square;
        sum.max = fmax(sum.max, job->errors[i].max);
    }
    const bake_source *source = job->reference->source;
    double mean[3];
    cube_mean(job->level, mean);
    double whole = (source->mean[0] + source->mean[1] + source->mean[2]) * (double)source->scale;
    double n = 3.0 * job->count;
    double root = sqrt(sum.reference_square / n);
    return (facet_cube_error){.rms = root > 0.0 ? sqrt(sum.square / n) / root : sqrt(sum.square / n),
                              .max = root > 0.0 ? sum.max / root : sum.max,
                              .energy = whole > 0.0 ? (mean[0] + mean[1] + mean[2]) / whole : 1.0,
                              .texels = job->count};
}

static uint32_t count_texels(const facet_cube *c, uint32_t level, const image *panorama)
{
    double texels = 6.0 * c->levels[level].size * c->levels[level].size;
    double affordable = image_texels / ((double)panorama->width * panorama->height);
    double count = fmin(fmax(affordable, MIN_TEXELS), MAX_TEXELS);
    return (uint32_t)fmin(count, texels);
}

facet_result facet_cube_verify(const facet_cube *c, facet_environment *environment,
                               const facet_bake_desc *given, facet_cube_error *errors, facet_error *error)
{
    assert(c && environment && errors);
    facet_bake_desc desc = given ? *given : default_desc;
    facet_result result = bake_complete(&desc, error);
    if (result == FACET_OK &&
        (desc.lobe != c->lobe || desc.level_count != c->level_count || desc.size != c->levels[0].size))
        result = fail(error, FACET_ERROR_ARGUMENT,
                      "verify: %u levels of %u texels for lobe %u were expected: those of the cube map",
                      c->level_count, c->levels[0].size, (uint32_t)c->lobe);
    if (result != FACET_OK)
        return result;
    bake_source source = {0};
    bake_reference reference = {0};
    texel_error *texels = NULL;
    bake_watch watch;
    double total = 0.0;
    result = bake_source_create(environment, &desc, &source, error);
    if (result == FACET_OK)
        result = bake_reference_create(&source, &desc.allocator, &reference, error);
    if (result != FACET_OK)
        goto done;
    texels = mem_alloc(&desc.allocator, MAX_TEXELS, sizeof *texels);
    if (!texels) {
        result = fail_memory(error, "reference", MAX_TEXELS * sizeof *texels);
        goto done;
    }
    for (uint32_t level = 0; level < c->level_count; level++)
        total +=
            (double)count_texels(c, level, &source.panorama) * source.panorama.width * source.panorama.height;
    bake_watch_init(&watch, &desc.progress, "verify", total);
    for (uint32_t level = 0; result == FACET_OK && level < c->level_count; level++) {
        verifying job = {.reference = &reference,
                         .level = &c->levels[level],
                         .is_sharp = bake_level_is_sharp(c, level),
                         .is_interpolated = bake_sharp_is_interpolated(&source, c->levels[0].size),
                         .count = count_texels(c, level, &source.panorama),
                         .errors = texels,
                         .watch = &watch};
        if (!job.is_sharp) {
            bake_lobe lobe = bake_lobe_create(c->lobe, c->roughness[level]);
            bake_reference_set_lobe(&lobe, &job.lobe);
        }
        parallel_for(desc.thread_count, job.count, 4, verify_texels, &job);
        result = bake_watch_explain(&watch, error);
        if (result == FACET_OK)
            errors[level] = sum_up(&job);
    }
done:
    mem_free(texels);
    bake_reference_destroy(&reference);
    bake_source_destroy(&source);
    return result;
}
