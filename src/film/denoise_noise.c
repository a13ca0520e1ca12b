/* denoise_noise.c - outliers, and the variance of what is left; see denoise_noise.h. */
#include "film/denoise_noise.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/parallel.h"

/* A loop over the rows of a plane, whose margins are made afterwards. */
typedef struct noise_pass {
    denoise_planes *planes;
    uint32_t thread_count;
    const float *from;
    float *to;
    int radius;
    ptrdiff_t step; /* floats between neighbours */
} noise_pass;

enum { ROW_GRAIN = 16 };

static void run_pass(noise_pass *s, void (*body)(void *, size_t, size_t), const float *from, float *to)
{
    s->from = from;
    s->to = to;
    parallel_for(s->thread_count, s->planes->height, ROW_GRAIN, body, s);
    denoise_repeat_border(s->planes, to);
}

/* ---- outliers ---- */

/* The share of a pixel that is left of it. An outlier owes what it has to few of its samples, and is above what is
 * around it: such a pixel is taken down to the brightest of its eight neighbours. Light gets lost by that; it would else be a
 * bright spot, or be smeared over a window. */
static float share_kept(const denoise_planes *p, ptrdiff_t x, ptrdiff_t y)
{
    const float few = 0.4f; /* standard error over mean; 16 samples of which 5 have all the light have 0.38 */
    size_t o = denoise_index(p, x, y);
    float light = 0.0f, error = 0.0f, brightest = 0.0f;
    for (int c = 0; c < 3; c++) {
        light += p->light[c][o];
        error += sqrtf(p->noise[c][o]);
    }
    if (error <= few * light)
        return 1.0f;
    for (ptrdiff_t j = y - 1; j <= y + 1; j++)
        for (ptrdiff_t i = x - 1; i <= x + 1; i++) {
            if ((i == x && j == y) || i < 0 || j < 0 || i >= (ptrdiff_t)p->width || j >= (ptrdiff_t)p->height)
                continue;
            size_t n = denoise_index(p, i, j);
            float near = p->light[0][n] + p->light[1][n] + p->light[2][n];
            brightest = near > brightest ? near : brightest;
        }
    return light > brightest ? brightest / light : 1.0f;
}

static void find_outliers(void *context, size_t begin, size_t end)
{
    const noise_pass *s = context;
    for (size_t y = begin; y < end; y++)
        for (uint32_t x = 0; x < s->planes->width; x++)
            s->to[denoise_index(s->planes, (ptrdiff_t)x, (ptrdiff_t)y)] =
                share_kept(s->planes, (ptrdiff_t)x, (ptrdiff_t)y);
}

static void take_outliers_down(noise_pass *s, float *kept)
{
    denoise_planes *p = s->planes;
    run_pass(s, find_outliers, NULL, kept);
    for (size_t o = 0; o < p->pitch * ((size_t)p->height + 2 * DENOISE_MARGIN); o++)
        if (kept[o] != 1.0f)
            for (int c = 0; c < 3; c++) {
                p->light[c][o] *= kept[o];
                p->noise[c][o] *= kept[o] * kept[o];
            }
}

/* ---- variance ---- */

/* Weighted mean over 2 radius + 1 pixels along one axis, triangular weights. */
static void smooth(void *context, size_t begin, size_t end)
{
    const noise_pass *s = context;
    int radius = s->radius;
    for (size_t y = begin; y < end; y++) {
        const float *from = s->from + denoise_index(s->planes, 0, (ptrdiff_t)y);
        float *to = s->to + denoise_index(s->planes, 0, (ptrdiff_t)y);
        memset(to, 0, s->planes->width * sizeof *to);
        for (int k = -radius; k <= radius; k++) {
            float weight = (float)(radius + 1 - abs(k)) / (float)((radius + 1) * (radius + 1));
            const float *shifted = from + k * s->step;
            for (size_t x = 0; x < s->planes->width; x++)
                to[x] += weight * shifted[x];
        }
    }
}

/* In place, in both directions; by way of other. */
static void smooth_plane(noise_pass *s, float *plane, float *other, int radius)
{
    s->radius = radius;
    s->step = 1;
    run_pass(s, smooth, plane, other);
    s->step = (ptrdiff_t)s->planes->pitch;
    run_pass(s, smooth, other, plane);
}

/* Variance of the noise of `from` as each pixel alone tells it: the square of a second difference in both directions,
 * which no slope answers, over the sum of its squared coefficients. Immerkaer 1996, "Fast noise variance estimation". */
static void measure_detail(void *context, size_t begin, size_t end)
{
    const noise_pass *s = context;
    size_t pitch = s->planes->pitch;
    for (size_t y = begin; y < end; y++) {
        size_t row = denoise_index(s->planes, 0, (ptrdiff_t)y);
        const float *above = s->from + row - pitch, *here = s->from + row, *below = s->from + row + pitch;
        for (ptrdiff_t x = 0; x < (ptrdiff_t)s->planes->width; x++) {
            float outer =
                above[x - 1] - 2.0f * above[x] + above[x + 1] + below[x - 1] - 2.0f * below[x] + below[x + 1];
            float difference = outer - 2.0f * (here[x - 1] - 2.0f * here[x] + here[x + 1]);
            s->to[row + (size_t)x] = difference * difference * (1.0f / 36.0f);
        }
    }
}

static void take_smaller(void *context, size_t begin, size_t end)
{
    const noise_pass *s = context;
    for (size_t y = begin; y < end; y++) {
        const float *from = s->from + denoise_index(s->planes, 0, (ptrdiff_t)y);
        float *to = s->to + denoise_index(s->planes, 0, (ptrdiff_t)y);
        for (size_t x = 0; x < s->planes->width; x++)
            to[x] = from[x] < to[x] ? from[x] : to[x];
    }
}

/* The variance that samples have in a pixel is itself noisy, and too large where samples are stratified (all that
 * varies smoothly within a pixel, a sky for one, is integrated far better than by independent ones). So it is averaged
 * over neighbours, and then bounded by what differs between pixels: noise does not hide there, only more than noise. */
static void estimate_noise(noise_pass *s, float *detail, float *other)
{
    for (int c = 0; c < 3; c++) {
        smooth_plane(s, s->planes->noise[c], other, 2);
        run_pass(s, measure_detail, s->planes->light[c], detail);
        smooth_plane(s, detail, other, 2);
        run_pass(s, take_smaller, detail, s->planes->noise[c]);
    }
}

void denoise_find_noise(denoise_planes *p, float *const scratch[2], uint32_t thread_count)
{
    noise_pass s = {.planes = p, .thread_count = thread_count};
    take_outliers_down(&s, scratch[0]);
    estimate_noise(&s, scratch[0], scratch[1]);
}
