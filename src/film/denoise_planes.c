/* denoise_planes.c - see denoise.h: planes from the layers of a film, and the estimate of their noise. */
#include "film/denoise.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"

/* Extends the border of a plane into its margins. */
static void repeat_border(const denoise_planes *p, float *plane)
{
    for (ptrdiff_t y = 0; y < (ptrdiff_t)p->height; y++) {
        float *row = plane + denoise_index(p, -DENOISE_MARGIN, y);
        for (size_t x = 0; x < DENOISE_MARGIN; x++)
            row[x] = row[DENOISE_MARGIN];
        for (size_t x = DENOISE_MARGIN + p->width; x < p->pitch; x++)
            row[x] = row[DENOISE_MARGIN + p->width - 1];
    }
    const float *first = plane + denoise_index(p, -DENOISE_MARGIN, 0);
    const float *last = plane + denoise_index(p, -DENOISE_MARGIN, (ptrdiff_t)p->height - 1);
    for (ptrdiff_t k = 1; k <= DENOISE_MARGIN; k++) {
        memcpy(plane + denoise_index(p, -DENOISE_MARGIN, -k), first, p->pitch * sizeof *plane);
        memcpy(plane + denoise_index(p, -DENOISE_MARGIN, (ptrdiff_t)p->height - 1 + k), last,
               p->pitch * sizeof *plane);
    }
}

/* ---- noise ---- */

/* A pass over the rows of a plane; its margins are filled afterwards. */
typedef struct noise_pass {
    denoise_planes *planes;
    uint32_t thread_count;
    const float *from;
    const float *light; /* whose variance is `from` */
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
    repeat_border(s->planes, to);
}

/* ---- outliers ---- */

/* Factor that reduces an outlier. An outlier owes its value to few of its samples and is brighter than its
 * surroundings; it is reduced to the brightest of its eight neighbours, or to the second brightest if all of its light
 * is that of one sample and the brightest is an outlier too. That loses energy, but the alternative is a bright spot or its smear over a window. */
static float kept_fraction(const denoise_planes *p, ptrdiff_t x, ptrdiff_t y)
{
    const float few = 0.4f; /* standard error over mean; 16 samples of which 5 have all the light have 0.38 */
    size_t o = denoise_index(p, x, y);
    const float one_sample = 0.85f; /* of one sample it is 1, of two equal ones 0.7 */
    float light = 0.0f, error = 0.0f, brightest = 0.0f, second = 0.0f;
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
            second = near > brightest ? brightest : near > second ? near : second;
            brightest = near > brightest ? near : brightest;
        }
    if (error > one_sample * light && brightest > 4.0f * second)
        brightest = second;
    return light > brightest ? brightest / light : 1.0f;
}

static void find_outliers(void *context, size_t begin, size_t end)
{
    const noise_pass *s = context;
    for (size_t y = begin; y < end; y++)
        for (uint32_t x = 0; x < s->planes->width; x++)
            s->to[denoise_index(s->planes, (ptrdiff_t)x, (ptrdiff_t)y)] =
                kept_fraction(s->planes, (ptrdiff_t)x, (ptrdiff_t)y);
}

static void damp_outliers(noise_pass *s, float *kept)
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

enum { AROUND = 2 }; /* px to each side over which variance is averaged */

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

/* Noise variance of `from` estimated per pixel: the square of a second difference in both directions, to
 * which slopes do not contribute, over the sum of its squared coefficients. Immerkaer 1996, "Fast noise
 * variance estimation". */
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

static void keep_smaller(void *context, size_t begin, size_t end)
{
    const noise_pass *s = context;
    for (size_t y = begin; y < end; y++) {
        const float *from = s->from + denoise_index(s->planes, 0, (ptrdiff_t)y);
        float *to = s->to + denoise_index(s->planes, 0, (ptrdiff_t)y);
        for (size_t x = 0; x < s->planes->width; x++)
            to[x] = from[x] < to[x] ? from[x] : to[x];
    }
}

/* Mean over the 5 x 5 pixels around one, without the five largest. */
static float mean_of_most(const float *from, ptrdiff_t pitch)
{
    enum { COUNT = (2 * AROUND + 1) * (2 * AROUND + 1), LARGEST = 5 };
    float largest[LARGEST] = {0}; /* in descending order */
    float sum = 0.0f;
    for (ptrdiff_t v = -AROUND; v <= AROUND; v++)
        for (ptrdiff_t u = -AROUND; u <= AROUND; u++) {
            float rest = fabsf(from[v * pitch + u]);
            for (int k = 0; k < LARGEST; k++) {
                float larger = rest > largest[k] ? rest : largest[k];
                rest = rest > largest[k] ? largest[k] : rest;
                largest[k] = larger;
            }
            sum += rest;
        }
    return sum * (1.0f / (float)(COUNT - LARGEST));
}

/* An upper bound of a pixel's variance: the larger one of its own and of the mean over the 5 x 5 pixels around it. In
 * that mean none counts for more than twice the square of the light of most of these pixels: a highlight has a large
 * variance that says nothing of what is beside it, where pixels of such a bound would take its light. Relative MSE of
 * 16 samples, 160 x 120, mean of two seeds, with limits of 1/2, 1, 2 times the square: ToyCar .0089, .0092, .0093
 * (without a limit .0098); GlassVaseFlowers .0140, .0157, .0161 (.0191); 10 000 lights .0108, .0115, .0119; but a room lit
 * by two panels .0070, .0067, .0065, where light is scarce and few samples have it. */
static float variance_around(const float *variance, const float *light, ptrdiff_t pitch)
{
    const float limit = 2.0f;
    float level = mean_of_most(light, pitch);
    float most = limit * level * level;
    float sum = 0.0f;
    for (ptrdiff_t v = -AROUND; v <= AROUND; v++)
        for (ptrdiff_t u = -AROUND; u <= AROUND; u++) {
            float here = variance[v * pitch + u];
            sum += here < most ? here : most;
        }
    float around = sum * (1.0f / (float)((2 * AROUND + 1) * (2 * AROUND + 1)));
    return *variance > around ? *variance : around;
}

static void bound_variance(void *context, size_t begin, size_t end)
{
    const noise_pass *s = context;
    for (size_t y = begin; y < end; y++)
        for (ptrdiff_t x = 0; x < (ptrdiff_t)s->planes->width; x++) {
            size_t o = denoise_index(s->planes, x, (ptrdiff_t)y);
            s->to[o] = variance_around(s->from + o, s->light + o, (ptrdiff_t)s->planes->pitch);
        }
}

/* The sample variance of a pixel is itself noisy, and too large where samples are stratified: whatever varies
 * smoothly within a pixel, such as a sky, is integrated far better than by independent samples. So it is
 * averaged over neighbours, within bounds, and then bounded by the differences between pixels, which noise cannot
 * exceed by much. */
static void estimate_noise(noise_pass *s, float *bound, float *other)
{
    for (int c = 0; c < 3; c++) {
        s->light = s->planes->light[c];
        run_pass(s, bound_variance, s->planes->noise[c], bound);
        smooth_plane(s, s->planes->noise[c], other, 2);
        run_pass(s, keep_smaller, bound, s->planes->noise[c]);
        run_pass(s, measure_detail, s->light, bound);
        smooth_plane(s, bound, other, 2);
        run_pass(s, keep_smaller, bound, s->planes->noise[c]);
    }
}

static void find_noise(denoise_planes *p, float *const scratch[2], uint32_t thread_count)
{
    noise_pass s = {.planes = p, .thread_count = thread_count};
    damp_outliers(&s, scratch[0]);
    estimate_noise(&s, scratch[0], scratch[1]);
}

typedef struct preparation {
    denoise_planes *planes;
    const float *radiance, *albedo, *normal, *variance; /* layers of the film */
} preparation;

/* ---- the layers, as they are read ---- */

/* x clamped to [least, most]; NaN becomes 0. */
static float bounded(float x, float least, float most)
{
    return x >= most ? most : x > least ? x : x <= least ? least : 0.0f;
}

static bool is_known(const float rgba[4])
{
    return isfinite(rgba[0]) && isfinite(rgba[1]) && isfinite(rgba[2]) && isfinite(rgba[3]);
}

/* Mean of the finite pixels around (x, y); 0 if there are none. */
static void mean_around(const preparation *s, uint32_t x, uint32_t y, float out[4])
{
    float count = 0.0f;
    memset(out, 0, 4 * sizeof *out);
    for (uint32_t j = y > 0 ? y - 1 : 0; j <= y + 1 && j < s->planes->height; j++)
        for (uint32_t i = x > 0 ? x - 1 : 0; i <= x + 1 && i < s->planes->width; i++) {
            const float *pixel = s->radiance + 4 * ((size_t)j * s->planes->width + i);
            if (!is_known(pixel))
                continue;
            count += 1.0f;
            for (int c = 0; c < 4; c++)
                out[c] += (pixel[c] - out[c]) / count; /* keeps sums from overflowing */
        }
}

/* Demodulates radiance by albedo and scale, and its variance accordingly. */
static void read_pixel(const preparation *s, uint32_t x, uint32_t y)
{
    const float most = 1e12f; /* times the mean: more than the pixels of any image, with a finite square */
    denoise_planes *p = s->planes;
    size_t i = (size_t)y * p->width + x;
    size_t o = denoise_index(p, (ptrdiff_t)x, (ptrdiff_t)y);
    float mended[4];
    const float *rgba = s->radiance + 4 * i;
    if (!is_known(rgba)) {
        mean_around(s, x, y, mended);
        rgba = mended;
    }
    for (size_t c = 0; c < 3; c++) {
        float albedo = bounded(s->albedo[3 * i + c], 0.0f, 1.0f);
        float to_light = 1.0f / denoise_divisor(albedo);
        float variance = s->variance[3 * i + c] / p->scale / p->scale * to_light * to_light;
        p->albedo[c][o] = albedo;
        p->normal[c][o] = bounded(s->normal[3 * i + c], -1.0f, 1.0f);
        p->light[c][o] = bounded(rgba[c] / p->scale * to_light, -most, most);
        p->noise[c][o] = bounded(variance, 0.0f, most);
    }
    p->opacity[o] = bounded(rgba[3], 0.0f, 1.0f);
}

static void read_rows(void *context, size_t begin, size_t end)
{
    const preparation *s = context;
    for (size_t y = begin; y < end; y++)
        for (uint32_t x = 0; x < s->planes->width; x++)
            read_pixel(s, x, (uint32_t)y);
}

/* The power of two next to the mean of the finite pixels: it removes the unit of the image from all that
 * follows. */
static float image_scale(const film *f)
{
    double sum = 0.0;
    size_t count = (size_t)f->width * f->height;
    for (size_t i = 0; i < 4 * count; i++)
        if (i % 4 < 3 && isfinite(f->layers[0].pixels[i]))
            sum += fabs((double)f->layers[0].pixels[i]);
    int exponent = 0;
    frexp(sum / (3.0 * (double)count), &exponent);
    return ldexpf(1.0f, exponent < -60 ? -60 : exponent > 120 ? 120 : exponent);
}

/* ---- planes ---- */

facet_result denoise_planes_create(const film *f, const facet_allocator *allocator, uint32_t thread_count,
                                   denoise_planes *out, facet_error *error)
{
    enum { KEPT = 13, PASSING = 2, EXTRA = 8 };
    denoise_planes p = {.width = f->width, .height = f->height, .scale = image_scale(f)};
    p.pitch = ((size_t)f->width + 2 * DENOISE_MARGIN + EXTRA) / EXTRA * EXTRA;
    size_t plane_size = p.pitch * ((size_t)f->height + 2 * DENOISE_MARGIN);
    p.block = mem_alloc(allocator, plane_size, (KEPT + PASSING) * sizeof(float));
    if (!p.block)
        return fail_memory(error, "planes of the denoiser", plane_size * (KEPT + PASSING) * sizeof(float));
    for (size_t c = 0; c < 3; c++) {
        p.light[c] = p.block + c * plane_size;
        p.noise[c] = p.block + (3 + c) * plane_size;
        p.albedo[c] = p.block + (6 + c) * plane_size;
        p.normal[c] = p.block + (9 + c) * plane_size;
    }
    p.opacity = p.block + 12 * plane_size;
    film *layers = (film *)f; /* film_find() does not write */
    preparation s = {.planes = &p,
                     .radiance = f->layers[0].pixels,
                     .albedo = film_find(layers, "albedo")->pixels,
                     .normal = film_find(layers, "normal")->pixels,
                     .variance = film_find(layers, "variance")->pixels};
    parallel_for(thread_count, f->height, ROW_GRAIN, read_rows, &s);
    for (size_t k = 0; k < KEPT; k++)
        repeat_border(&p, p.block + k * plane_size);
    find_noise(&p, (float *[2]){p.block + KEPT * plane_size, p.block + (KEPT + 1) * plane_size},
               thread_count);
    *out = p;
    return FACET_OK;
}

void denoise_planes_destroy(denoise_planes *p)
{
    mem_free(p->block);
    *p = (denoise_planes){0};
}
