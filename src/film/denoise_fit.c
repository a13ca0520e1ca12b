/* denoise_fit.c - see denoise.h: a weighted least squares fit of radiance in a window of pixels.
 *
 * Weights are those of non-local means with the noise's own contribution to a distance removed (Rousselle,
 * Knaus, Zwicker 2012, "Adaptive Rendering with Non-Local Means Filtering", section 4.1). With them radiance
 * is fitted as a linear function of albedo, normal, opacity and position (Bitterli et al. 2016, "Nonlinearly
 * Weighted First-order Regression for Denoising Monte Carlo Renderings"). The bandwidth of the weights is
 * chosen per window by Stein's unbiased risk estimate (Li, Wu, Chuang 2012, "SURE-based Optimization for
 * Adaptive Sampling and Reconstruction"). */
#include "film/denoise.h"

#include <math.h>
#include <string.h>

#include "base/simd.h"

enum {
    TERMS = 10,     /* 1, normal, albedo, position, opacity */
    CANDIDATES = 2, /* candidate bandwidths of the weights */
    JUDGED = 4      /* radius of the part of the window in which a candidate's error is estimated */
};

typedef struct fit_work {
    float distance[DENOISE_WINDOW]; /* to the center, at a bandwidth of 1 */
    float weight[DENOISE_WINDOW];
    float term[TERMS][DENOISE_WINDOW], weighted[DENOISE_WINDOW];
    float radiance[3][DENOISE_WINDOW], noise[3][DENOISE_WINDOW];
    float value[3][DENOISE_WINDOW];
    float level, light_level, noise_level; /* means over the window */
    float lower[TERMS][TERMS];             /* Cholesky factor of the normal equations */
    float coefficient[3][TERMS];
} fit_work;

#define INLINE static inline __attribute__((always_inline))
static const float far_away = 1e30f;

/* ---- distances ---- */

/* Adds to the patch distances of a row of pixels from the center: one offset in the patch, one channel. */
INLINE void add_row_distance(const float *light, const float *noise, float light_c, float noise_c,
                             float sum[DENOISE_ROW])
{
    const float least = 2.5e-5f; /* (0.5 %)^2: smaller differences are invisible */
    for (int i = 0; i < DENOISE_ROW; i++) {
        float difference = light[i] - light_c;
        float both = noise[i] + noise_c;
        float expected = noise_c + (noise[i] < noise_c ? noise[i] : noise_c);
        sum[i] += (difference * difference - expected) /
                  (both + least * (light[i] * light[i] + light_c * light_c) + 1e-20f);
    }
}

INLINE void measure_distances(const denoise_planes *p, ptrdiff_t x, ptrdiff_t y, fit_work *work)
{
    const float guide_weight = 3.0f;
    const int side = 2 * DENOISE_PATCH + 1;
    size_t center = denoise_index(p, x, y);
    for (int j = 0; j < DENOISE_SIDE; j++) {
        size_t row = denoise_index(p, x - DENOISE_RADIUS, y - DENOISE_RADIUS + j);
        float sum[DENOISE_ROW] = {0}, guide[DENOISE_ROW] = {0};
        for (int c = 0; c < 3; c++) {
            for (ptrdiff_t v = -DENOISE_PATCH; v <= DENOISE_PATCH; v++)
                for (ptrdiff_t u = -DENOISE_PATCH; u <= DENOISE_PATCH; u++) {
                    ptrdiff_t offset = v * (ptrdiff_t)p->pitch + u;
                    size_t to = (size_t)((ptrdiff_t)center + offset);
                    size_t from = (size_t)((ptrdiff_t)row + offset);
                    add_row_distance(p->light[c] + from, p->noise[c] + from, p->light[c][to], p->noise[c][to],
                                     sum);
                }
            for (int i = 0; i < DENOISE_ROW; i++) {
                float albedo = p->albedo[c][row + (size_t)i] - p->albedo[c][center];
                float normal = p->normal[c][row + (size_t)i] - p->normal[c][center];
                guide[i] += albedo * albedo + normal * normal;
            }
        }
        bool is_row = y - DENOISE_RADIUS + j >= 0 && y - DENOISE_RADIUS + j < (ptrdiff_t)p->height;
        for (int i = 0; i < DENOISE_ROW; i++) {
            ptrdiff_t column = x - DENOISE_RADIUS + i;
            bool is_pixel = is_row && i < DENOISE_SIDE && column >= 0 && column < (ptrdiff_t)p->width;
            float mean = sum[i] * (1.0f / (float)(3 * side * side));
            float distance = (mean > 0.0f ? mean : 0.0f) + guide_weight * guide[i];
            work->distance[j * DENOISE_ROW + i] = is_pixel ? distance : far_away;
        }
    }
}

/* exp(-x) for x >= 0, to 1 %: smooth and monotonic, which is all that weights need. */
INLINE float falloff(float x)
{
    float e = 1.0f + x * (1.0f / 8.0f) + x * x * (1.0f / 128.0f);
    e = e * e;
    e = e * e;
    return 1.0f / (e * e);
}

/* ---- the window's pixels ---- */

INLINE void read_window(const denoise_planes *p, ptrdiff_t x, ptrdiff_t y, fit_work *work)
{
    size_t center = denoise_index(p, x, y);
    for (int j = 0; j < DENOISE_SIDE; j++) {
        size_t row = denoise_index(p, x - DENOISE_RADIUS, y - DENOISE_RADIUS + j);
        int first = j * DENOISE_ROW;
        for (int c = 0; c < 3; c++)
            for (int i = 0; i < DENOISE_ROW; i++) {
                float albedo = p->albedo[c][row + (size_t)i];
                float divisor = denoise_divisor(albedo);
                work->radiance[c][first + i] = p->light[c][row + (size_t)i] * divisor;
                work->noise[c][first + i] = p->noise[c][row + (size_t)i] * divisor * divisor;
                work->term[1 + c][first + i] = p->normal[c][row + (size_t)i] - p->normal[c][center];
                work->term[4 + c][first + i] = albedo - p->albedo[c][center];
            }
        for (int i = 0; i < DENOISE_ROW; i++) {
            work->term[9][first + i] = p->opacity[row + (size_t)i] - p->opacity[center];
            work->term[0][first + i] = 1.0f;
            work->term[7][first + i] = (float)(i - DENOISE_RADIUS) / (float)DENOISE_RADIUS;
            work->term[8][first + i] = (float)(j - DENOISE_RADIUS) / (float)DENOISE_RADIUS;
        }
    }
}

/* Dot product, always summed in the same order. */
INLINE float product(const float a[DENOISE_WINDOW], const float b[DENOISE_WINDOW])
{
    float part[16] = {0};
    for (int i = 0; i < DENOISE_WINDOW; i += 16)
        for (int k = 0; k < 16; k++)
            part[k] += a[i + k] * b[i + k];
    for (int width = 8; width > 0; width /= 2)
        for (int k = 0; k < width; k++)
            part[k] += part[k + width];
    return part[0];
}

INLINE float sum_of(const float a[DENOISE_WINDOW])
{
    float part[16] = {0};
    for (int i = 0; i < DENOISE_WINDOW; i += 16)
        for (int k = 0; k < 16; k++)
            part[k] += a[i + k];
    for (int width = 8; width > 0; width /= 2)
        for (int k = 0; k < width; k++)
            part[k] += part[k + width];
    return part[0];
}

/* ---- the fit ---- */

/* Prior scale of a coefficient: a normal turns the light off over its unit, albedo is the light, position
 * doubles the light over two windows, opacity is the light again. Their variance gives the ridge, which is
 * the noise over it. */
INLINE float prior(const fit_work *work, int term)
{
    const float trust = 3.0f;
    float size = term < 4 || term > 8 ? work->level : term < 7 ? work->light_level : 0.5f * work->level;
    return trust * trust * size * size + 1e-20f;
}

/* Solves the normal equations of weight, for all channels. */
INLINE void solve(fit_work *work)
{
    float right[3][TERMS];
    for (int k = 0; k < TERMS; k++) {
        for (int i = 0; i < DENOISE_WINDOW; i++)
            work->weighted[i] = work->weight[i] * work->term[k][i];
        for (int l = k; l < TERMS; l++)
            work->lower[l][k] = product(work->weighted, work->term[l]);
        for (int c = 0; c < 3; c++)
            right[c][k] = product(work->weighted, work->radiance[c]);
    }
    float total = work->lower[0][0];
    for (int k = 0; k < TERMS; k++) {
        float ridge = k > 0 ? work->noise_level / prior(work, k) : 0.0f;
        work->lower[k][k] += ridge + 1e-6f * work->lower[k][k] + 1e-9f * total;
        for (int l = 0; l <= k; l++) {
            float rest = work->lower[k][l];
            for (int m = 0; m < l; m++)
                rest -= work->lower[k][m] * work->lower[l][m];
            if (l < k)
                work->lower[k][l] = rest / work->lower[l][l];
            else
                work->lower[k][k] = sqrtf(rest > 1e-12f * total ? rest : 1e-12f * total);
        }
    }
    for (int c = 0; c < 3; c++) {
        float *x = work->coefficient[c];
        for (int k = 0; k < TERMS; k++) {
            float rest = right[c][k];
            for (int m = 0; m < k; m++)
                rest -= work->lower[k][m] * x[m];
            x[k] = rest / work->lower[k][k];
        }
        for (int k = TERMS - 1; k >= 0; k--) {
            float rest = x[k];
            for (int m = k + 1; m < TERMS; m++)
                rest -= work->lower[m][k] * x[m];
            x[k] = rest / work->lower[k][k];
        }
    }
}

INLINE void predict(fit_work *work)
{
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < DENOISE_WINDOW; i++) {
            float sum = work->coefficient[c][0];
            for (int k = 1; k < TERMS; k++)
                sum += work->coefficient[c][k] * work->term[k][i];
            work->value[c][i] = sum;
        }
}

/* Stein's estimate of the squared error, in units of the noise: the residual minus the noise plus twice the
 * noise times the weight of a pixel in its own value, weight |L^-1 term|^2. */
INLINE float estimate_error(const fit_work *work)
{
    const float most = 10.0f; /* limits the influence of a single outlier */
    float error[DENOISE_ROW] = {0}, count[DENOISE_ROW] = {0};
    for (int j = DENOISE_RADIUS - JUDGED; j <= DENOISE_RADIUS + JUDGED; j++) {
        int first = j * DENOISE_ROW;
        float z[TERMS][DENOISE_ROW], share[DENOISE_ROW] = {0};
        for (int k = 0; k < TERMS; k++) {
            memcpy(z[k], &work->term[k][first], sizeof z[k]);
            for (int m = 0; m < k; m++)
                for (int i = 0; i < DENOISE_ROW; i++)
                    z[k][i] -= work->lower[k][m] * z[m][i];
            float scale = 1.0f / work->lower[k][k];
            for (int i = 0; i < DENOISE_ROW; i++) {
                z[k][i] *= scale;
                share[i] += z[k][i] * z[k][i];
            }
        }
        float least = 1e-4f * work->level * work->level;
        for (int c = 0; c < 3; c++)
            for (int i = 0; i < DENOISE_ROW; i++) {
                float residual = work->value[c][first + i] - work->radiance[c][first + i];
                float noise = work->noise[c][first + i];
                float own = 2.0f * noise * work->weight[first + i] * share[i];
                float one = (residual * residual - noise + own) / (noise + least + 1e-20f);
                float near = 1.0f / (1.0f + work->distance[first + i]);
                error[i] += near * (one < most ? one : most);
                count[i] += near;
            }
    }
    float sum = 0.0f, total = 1e-20f;
    for (int i = DENOISE_RADIUS - JUDGED; i <= DENOISE_RADIUS + JUDGED; i++) {
        sum += error[i];
        total += count[i];
    }
    return sum / total;
}

INLINE void measure_levels(fit_work *work)
{
    float light = 0.0f, noise = 0.0f, albedo = 0.0f;
    float total = sum_of(work->weight);
    for (int c = 0; c < 3; c++) {
        for (int i = 0; i < DENOISE_WINDOW; i++)
            work->weighted[i] = fabsf(work->radiance[c][i]);
        light += product(work->weight, work->weighted);
        noise += product(work->weight, work->noise[c]);
        albedo += product(work->weight, work->term[4 + c]);
    }
    work->level = light / (3.0f * total);
    work->noise_level = noise / (3.0f * total);
    work->light_level = albedo / (3.0f * total);
}

DISPATCH_AVX2 static void denoise_fit_dispatched(const denoise_planes *p, ptrdiff_t x, ptrdiff_t y,
                                                 denoise_fit *out)
{
    static const float bandwidths[CANDIDATES] = {1.0f, 0.6f};
    fit_work work;
    size_t center = denoise_index(p, x, y);
    float albedo = (p->albedo[0][center] + p->albedo[1][center] + p->albedo[2][center]) * (1.0f / 3.0f);
    float best = 0.0f;
    measure_distances(p, x, y, &work);
    read_window(p, x, y, &work);
    for (int n = 0; n < CANDIDATES; n++) {
        float narrow = 1.0f / (bandwidths[n] * bandwidths[n]);
        for (int i = 0; i < DENOISE_WINDOW; i++) {
            float scaled = work.distance[i] * narrow;
            work.weight[i] = work.distance[i] < far_away ? falloff(scaled < 60.0f ? scaled : 60.0f) : 0.0f;
        }
        measure_levels(&work);
        float mean_albedo = albedo + work.light_level;
        work.light_level = work.level / (mean_albedo > 0.05f ? mean_albedo : 0.05f);
        solve(&work);
        predict(&work);
        float error = estimate_error(&work);
        if (n > 0 && error >= best)
            continue;
        best = error;
        memcpy(out->weight, work.weight, sizeof work.weight);
        memcpy(out->value, work.value, sizeof work.value);
    }
}

/* Dispatched functions stay in their file: clang gives them another name. */
void denoise_fit_window(const denoise_planes *p, ptrdiff_t x, ptrdiff_t y, denoise_fit *out)
{
    denoise_fit_dispatched(p, x, y, out);
}
