/* prefilter.c - see prefilter.h. */
#include "ibl/prefilter.h"

#include <math.h>
#include <string.h>

#include "ibl/gauss.h"
#include "ibl/ibl.h"
#include "ibl/narrow.h"

#include "shade/shade.h"

/* Recipe of a level. Sizes give at least four texels to the half width of a lobe, so that bilinear lookup
 * preserves its shape; degrees truncate less than 0.3 % of the peak for GGX. 160 degrees round off the edge of
 * sheen at the horizon over 0.02 rad. */
typedef struct level_recipe {
    float roughness;
    uint16_t size, degree;
} level_recipe;

static const level_recipe ggx_levels[] = {{0.0f, 0, 0},    {NARROW_END, 128, 160}, {0.22f, 80, 160},
                                          {0.3f, 64, 128}, {0.4f, 48, 64},         {0.52f, 40, 64},
                                          {0.68f, 32, 64}, {0.84f, 32, 64},        {1.0f, 32, 64}};
/* Rims at the horizon: denser than GGX's spots where they are thin, since two of them approximate the one between
 * less well. */
static const level_recipe sheen_levels[] = {{0.0f, 0, 0},      {0.1f, 96, 160},  {0.125f, 80, 160},
                                            {0.155f, 64, 160}, {0.19f, 64, 128}, {0.235f, 48, 128},
                                            {0.3f, 48, 96},    {0.38f, 40, 96},  {0.5f, 32, 64},
                                            {0.7f, 32, 64},    {1.0f, 32, 64}};

static const struct {
    const level_recipe *levels;
    uint32_t level_count, first;
} lobes[PREFILTER_LOBE_COUNT] = {{ggx_levels, sizeof ggx_levels / sizeof *ggx_levels, 0},
                                 {sheen_levels, sizeof sheen_levels / sizeof *sheen_levels, 1}};

uint32_t prefilter_level_count(prefilter_lobe lobe)
{
    return lobes[lobe].level_count;
}

float prefilter_roughness(prefilter_lobe lobe, uint32_t level)
{
    return lobes[lobe].levels[level].roughness;
}

uint32_t prefilter_size(prefilter_lobe lobe, uint32_t level)
{
    return lobes[lobe].levels[level].size;
}

uint64_t prefilter_recipe(prefilter_lobe lobe, uint32_t level)
{
    uint32_t roughness = floatBitsToUint(lobes[lobe].levels[level].roughness);
    return (uint64_t)roughness << 32 | (uint64_t)lobes[lobe].levels[level].size << 16 | (uint64_t)lobe << 12 |
           lobes[lobe].levels[level].degree;
}

float prefilter_lod_of(prefilter_lobe lobe, float perceptual_roughness)
{
    const level_recipe *levels = lobes[lobe].levels;
    uint32_t level = lobes[lobe].first;
    while (level + 2 < lobes[lobe].level_count && perceptual_roughness > levels[level + 1].roughness)
        level++;
    float low = levels[level].roughness;
    float high = levels[level + 1].roughness;
    float fraction = (perceptual_roughness - low) / (high - low);
    return (float)level + (fraction > 0.0f ? fraction : 0.0f);
}

/* D (of sheen: E) at half angle t, up to a constant. */
static double distribution(prefilter_lobe lobe, double t, float alpha)
{
    if (lobe == PREFILTER_SHEEN)
        return (double)ibl_sheen_albedo((float)cos(2.0 * t), sqrt(alpha));
    if (lobe == PREFILTER_GGX)
        return (double)D_GGX_stable((float)cos(t), vec3((float)sin(t), 0.0f, 0.0f), alpha);
    /* D_Charlie relative to the horizon, t = pi / 4: both underflow a float at low roughness */
    return exp(0.5 / (double)alpha * log(2.0 * sin(t) * sin(t)));
}

enum { NODES = 8 };

/* Gauss-Legendre nodes in panels of the half angle t in [0, pi / 4], at whose end l is on the horizon: panels
 * double in width from alpha / 8 on, where the lobe is concentrated, up to one and a half periods of
 * P_degree(cos 2 t) in 8 points. */
static void add_panel(prefilter_lobe lobe, float alpha, double from, double to, uint32_t degree, double *sum)
{
    const double end = 0.7853981633974483;
    double x[NODES], now[NODES], before[NODES];
    for (int i = 0; i < NODES; i++) {
        double weight;
        double s = gauss_8(i, from, to, &weight);
        double t = lobe == PREFILTER_GGX ? s : end - s;
        x[i] = cos(2.0 * t);
        /* dl = 2 pi sin(2 t) d(2 t) */
        now[i] = weight * distribution(lobe, t, alpha) * x[i] * sin(2.0 * t);
        before[i] = 0.0;
    }
    for (uint32_t l = 0; l <= degree; l++) {
        double a = (2.0 * l + 1.0) / (l + 1.0);
        double b = l / (l + 1.0);
        double total = 0.0;
        for (int i = 0; i < NODES; i++) {
            total += now[i];
            double next = a * x[i] * now[i] - b * before[i];
            before[i] = now[i];
            now[i] = next;
        }
        sum[l] += total;
    }
}

void prefilter_kernel(prefilter_lobe lobe, float perceptual_roughness, uint32_t degree, float *kernel)
{
    double sum[HARMONICS_MAX_DEGREE + 1] = {0.0};
    float alpha = alpha_from_roughness(perceptual_roughness);
    const double end = 0.7853981633974483;
    double widest = fmin(0.03, 4.8 / degree);
    double width = 0.125 * (double)alpha;
    for (double from = 0.0; from < end; width *= 2.0) {
        double to = fmin(from + fmin(width, widest), end);
        add_panel(lobe, alpha, from, to, degree, sum);
        from = to;
    }
    for (uint32_t l = 0; l <= degree; l++)
        kernel[l] = (float)(sum[l] / sum[0]);
}

/* Energy of a kernel in degrees first to last, by Parseval's theorem. */
static double square(const float *kernel, uint32_t first, uint32_t last)
{
    double sum = 0.0;
    for (uint32_t l = first; l <= last; l++)
        sum += (2.0 * l + 1.0) * (double)kernel[l] * (double)kernel[l];
    return sum;
}

uint32_t prefilter_choose_degree(prefilter_lobe lobe, float perceptual_roughness, double tolerance,
                                 float *kernel, double *cut)
{
    uint32_t known = 96;
    for (;; known = known < HARMONICS_MAX_DEGREE / 2 ? 2 * known : HARMONICS_MAX_DEGREE) {
        prefilter_kernel(lobe, perceptual_roughness, known, kernel);
        double whole = square(kernel, 0, known);
        /* A ring's energy falls off with the third power of the degree: the rest is twice that of the last
         * eighth. */
        double beyond = 2.0 * square(kernel, known - known / 8 + 1, known);
        double allowed = tolerance * tolerance * (whole + beyond);
        uint32_t degree = 32;
        while (degree < known && square(kernel, degree + 1, known) + beyond > allowed)
            degree += 32;
        *cut = sqrt((square(kernel, degree + 1, known) + beyond) / (whole + beyond));
        if (degree < known || known == HARMONICS_MAX_DEGREE)
            return degree;
    }
}

void prefilter_taper(uint32_t degree, float *kernel)
{
    uint32_t first = degree - degree / 4;
    for (uint32_t l = first; l <= degree; l++)
        kernel[l] *= 0.5f + 0.5f * cos(PI * (float)(l - first) / (float)(degree + 1 - first));
}

facet_result prefilter_level(harmonics *h, prefilter_lobe lobe, uint32_t level,
                             const facet_allocator *allocator, uint32_t thread_count, cube *out,
                             facet_error *error)
{
    float kernel[PREFILTER_DEGREE + 1];
    const level_recipe *recipe = &lobes[lobe].levels[level];
    prefilter_kernel(lobe, recipe->roughness, recipe->degree, kernel);
    prefilter_taper(recipe->degree, kernel);
    return harmonics_filter(h,
                            &(harmonics_filter_desc){.kernel = kernel,
                                                     .degree = recipe->degree,
                                                     .scale = 1.0f,
                                                     .size = recipe->size,
                                                     .allocator = allocator,
                                                     .thread_count = thread_count},
                            out, error);
}
