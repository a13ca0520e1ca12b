/* prefilter.c - see prefilter.h. Wide lobes scale spherical harmonics, which is exact. Narrow lobes would need too many
 * of them and are sampled: importance samples of the lobe, each read from the mip whose texels are as large as what
 * the sample stands for (Krivanek and Colbert 2008, "Real-time Shading with Filtered Importance Sampling"). */
#include "ibl/prefilter.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"

#include "shade/shade.h"

/* How a level is made. Sizes give the half width of a lobe three texels and more, so that bilinear lookup keeps its
 * shape; degrees are such that what is cut off is below 1e-5 of the lobe. */
static const struct {
    uint16_t size, degree;
} levels[PREFILTER_LEVEL_COUNT] = {{256, 0}, {128, 0}, {64, 128}, {32, 64}, {32, 64},
                                   {16, 64}, {16, 64}, {16, 64},  {16, 64}};

enum {
    MAX_MIPS = 12,
    SAMPLE_COUNT = 64 /* bench/ibl.c prints the error that this leaves */
};

float prefilter_roughness(uint32_t level)
{
    return (float)level / (float)(PREFILTER_LEVEL_COUNT - 1);
}

void prefilter_kernel(float perceptual_roughness, uint32_t degree, float *kernel)
{
    /* nodes and weights of 8 points on [-1, 1] */
    static const double node[4] = {0.1834346424956498, 0.5255324099163290, 0.7966664774136267,
                                   0.9602898564975363};
    static const double node_weight[4] = {0.3626837833783620, 0.3137066458778873, 0.2223810344533745,
                                          0.1012285362903763};
    double sum[HARMONICS_DEGREE + 1] = {0.0};
    float alpha = alpha_from_roughness(perceptual_roughness);
    /* The half angle t runs to pi / 4, where l reaches the horizon, in panels that double in width from alpha / 8. */
    double from = 0.0;
    double width = 0.125 * (double)alpha;
    const double end = 0.7853981633974483;
    while (from < end) {
        /* P_128(cos 2 t) swings once in 0.025 */
        double to = fmin(from + fmin(width, 0.03), end);
        for (int i = 0; i < 8; i++) {
            double x = i < 4 ? -node[i] : node[i - 4];
            double t = 0.5 * (from + to) + 0.5 * (to - from) * x;
            double w = 0.5 * (to - from) * node_weight[i & 3];
            double NdotL = (cos)(2.0 * t);
            /* dl = 2 pi sin(2 t) d(2 t) */
            float D = D_GGX_stable((float)(cos)(t), vec3((float)(sin)(t), 0.0f, 0.0f), alpha);
            w *= (double)D * NdotL * (sin)(2.0 * t);
            double p = 1.0;
            double before = 0.0;
            for (uint32_t l = 0; l <= degree; l++) {
                sum[l] += w * p;
                double next = ((2.0 * l + 1.0) * NdotL * p - l * before) / (l + 1.0);
                before = p;
                p = next;
            }
        }
        from = to;
        width *= 2.0;
    }
    for (uint32_t l = 0; l <= degree; l++)
        kernel[l] = (float)(sum[l] / sum[0]);
}

facet_result prefilter_harmonics(const harmonics *h, uint32_t level, const facet_allocator *allocator,
                                 uint32_t thread_count, cube *out, facet_error *error)
{
    float kernel[HARMONICS_DEGREE + 1];
    prefilter_kernel(prefilter_roughness(level), levels[level].degree, kernel);
    return harmonics_filter(h, kernel, levels[level].degree, levels[level].size, allocator, thread_count, out,
                            error);
}

/* ---- narrow lobes ---- */

/* A sample of the lobe around z, the same for every texel. */
typedef struct lobe_sample {
    float x, y, z, weight;
    uint32_t mip;
} lobe_sample;

typedef struct lobe {
    cube mips[MAX_MIPS]; /* [0] is not owned */
    lobe_sample samples[SAMPLE_COUNT];
    cube *out;
} lobe;

/* Samples with weights that add up to 1. */
static void lobe_init(lobe *job, float alpha, uint32_t mip_count)
{
    float texel_solid_angle = 4.0f * PI / (6.0f * (float)job->mips[0].size * (float)job->mips[0].size);
    double whole = 0.0;
    for (uint32_t i = 0; i < SAMPLE_COUNT; i++) {
        PrefilterSample p = prefilter_sample(i, SAMPLE_COUNT, alpha, vec3(0.0f, 0.0f, 1.0f));
        float lod = prefilter_lod(p.pdf, SAMPLE_COUNT, texel_solid_angle);
        uint32_t mip = (uint32_t)lod;
        job->samples[i] =
            (lobe_sample){p.L[0], p.L[1], p.L[2], p.weight, mip < mip_count ? mip : mip_count - 1};
        whole += (double)p.weight;
    }
    for (uint32_t i = 0; i < SAMPLE_COUNT; i++)
        job->samples[i].weight = (float)((double)job->samples[i].weight / whole);
}

IBL_DISPATCH static void sample_rows(void *context, size_t begin, size_t end)
{
    const lobe *job = context;
    uint32_t size = job->out->size;
    for (size_t i = begin; i < end; i++) {
        uint32_t face = (uint32_t)(i / size);
        uint32_t y = (uint32_t)(i % size);
        for (uint32_t x = 0; x < size; x++) {
            double d[3];
            cube_direction(face, (2.0 * x + 1.0) / size - 1.0, (2.0 * y + 1.0) / size - 1.0, d);
            mat3 basis = basis_from_normal(normalize(vec3((float)d[0], (float)d[1], (float)d[2])));
            rgbx sum = {0};
            for (uint32_t k = 0; k < SAMPLE_COUNT; k++) {
                const lobe_sample *s = &job->samples[k];
                vec3 L = COL(basis, 0) * s->x + COL(basis, 1) * s->y + COL(basis, 2) * s->z;
                sum += cube_fetch(&job->mips[s->mip], cube_locate(L[0], L[1], L[2])) * s->weight;
            }
            *cube_texel(job->out, face, (int)x, (int)y) = sum;
        }
    }
}

facet_result prefilter_sampled(const cube *sharp, uint32_t level, const facet_allocator *allocator,
                               uint32_t thread_count, cube *out, facet_error *error)
{
    lobe job = {.mips = {*sharp}, .out = out};
    uint32_t mip_count = 1;
    facet_result result = cube_create(levels[level].size, allocator, out, error);
    for (; result == FACET_OK && mip_count < MAX_MIPS && job.mips[mip_count - 1].size > 2; mip_count++)
        result = cube_half(&job.mips[mip_count - 1], allocator, thread_count, &job.mips[mip_count], error);
    if (result == FACET_OK) {
        lobe_init(&job, alpha_from_roughness(prefilter_roughness(level)), mip_count);
        parallel_for(thread_count, 6 * (size_t)out->size, 8, sample_rows, &job);
        cube_fill_borders(out);
    } else {
        cube_destroy(out);
    }
    for (uint32_t i = 1; i < MAX_MIPS; i++)
        cube_destroy(&job.mips[i]);
    return result;
}
