/* narrow.c - see narrow.h: the blurred images and the fit of their weights.
 *
 * A Gaussian on the sphere is separable: rows are blurred with its variance times 1 / sin(theta)^2 in
 * columns, then columns. Columns exchange radiance across the edges of texels in proportion to the edge's
 * length, so energy is conserved and nothing crosses a pole, around which rows are uniform anyway. */
#include "ibl/narrow.h"

#include <math.h>
#include <string.h>

#include "base/parallel.h"
#include "base/result.h"
#include "base/simd.h"
#include "ibl/equirect.h"

/* ---- the fit ---- */

static const double pi = 3.14159265358979323846;

enum { DEGREES = 64 };

/* Least weight of an image, as a share of the mixture's mass around its variance. */
static const double least_share = 0.5;

/* Transfer functions, and the weight of each degree. */
typedef struct spectrum {
    uint32_t blurred_count;
    double variance[NARROW_COUNT]; /* variances of the images, rad^2 */
    double degree[DEGREES], importance[DEGREES];
    double part[NARROW_PARTS][DEGREES];
    double product[NARROW_PARTS][NARROW_PARTS];
} spectrum;

/* x K_1(x), error below 1e-7. Abramowitz and Stegun 1964, equations 9.8.3, 9.8.7 and 9.8.8. */
static double x_bessel_k1(double x)
{
    static const double i1[7] = {0.5, 0.87890594, 0.51498869, 0.15084934, 0.02658733, 0.00301532, 0.00032411};
    static const double near[7] = {1.0,         0.15443144,  -0.67278579, -0.18156897,
                                   -0.01919402, -0.00110404, -0.00004686};
    static const double far[7] = {1.25331414,  0.23498619, -0.03655620, 0.01504268,
                                  -0.00780353, 0.00325614, -0.00068245};
    double sum = 0.0;
    if (x <= 0.0)
        return 1.0;
    if (x > 2.0) {
        for (int i = 6; i >= 0; i--)
            sum = sum * (2.0 / x) + far[i];
        return sqrt(x) * exp(-x) * sum;
    }
    double t = x * x / 14.0625; /* (x / 3.75)^2 */
    double bessel_i1 = 0.0;
    for (int i = 6; i >= 0; i--) {
        sum = sum * (0.25 * x * x) + near[i];
        bessel_i1 = bessel_i1 * t + i1[i];
    }
    return x * log(0.5 * x) * (x * bessel_i1) + sum;
}

/* Transfer function of a reflected GGX lobe: twice as wide as the lobe of half vectors, whose transform in
 * the plane is alpha l K_1(alpha l). */
static double lobe_transfer(double perceptual_roughness, double degree)
{
    return x_bessel_k1(2.0 * perceptual_roughness * perceptual_roughness * degree);
}

/* Transfer function of bilinear interpolation; x: radians per sample. */
static double tent(double x)
{
    double s = x > 0.0 ? sin(0.5 * x) / (0.5 * x) : 1.0;
    return s * s;
}

/* Transfer function of blurred image index relative to the sharp image, for waves of x radians per column and y
 * per row. */
static double blur_transfer(uint32_t index, double x, double y)
{
    double result = 1.0 / (tent(x) * tent(y));
    for (uint32_t i = 0;; i++, x *= 2.0, y *= 2.0) {
        for (int pass = 0; pass < NARROW_PASSES; pass++)
            result *= (1.0 - narrow_variances[i][pass] * (1.0 - cos(x))) *
                      (1.0 - narrow_variances[i][pass] * (1.0 - cos(y)));
        if (i == index)
            return result * tent(x) * tent(y);
        result *= 0.25 * (3.0 * cos(0.5 * x) + cos(1.5 * x)) * 0.25 * (3.0 * cos(0.5 * y) + cos(1.5 * y));
    }
}

static void spectrum_init(spectrum *s, uint32_t blurred_count, double row_rad)
{
    double row2 = row_rad * row_rad;
    double variance = 0.0; /* total variance; bilinear lookup adds a sixth of a squared texel */
    s->blurred_count = blurred_count;
    for (uint32_t k = 0; k < NARROW_COUNT; k++, row2 *= 4.0) {
        variance += k ? 0.1875 * row2 : 0.0;
        for (int pass = 0; pass < NARROW_PASSES; pass++)
            variance += narrow_variances[k][pass] * row2;
        s->variance[k] = variance + (row2 - row_rad * row_rad) / 6.0;
    }
    double lowest = 4.0;
    double highest = 1.3 * pi / row_rad;
    for (int i = 0; i < DEGREES; i++) {
        double l = lowest * pow(highest / lowest, i / (DEGREES - 1.0));
        double x = l * row_rad * cos(pi / 8.0); /* neither along the grid nor diagonal */
        double y = l * row_rad * sin(pi / 8.0);
        /* Natural images have equal energy per octave, 1 / l^2 per degree; suns have equal energy per degree. */
        double interpolated = tent(x) * tent(y);
        s->degree[i] = l;
        s->importance[i] = (1.0 + l * l / (120.0 * 120.0)) * interpolated * interpolated;
        s->part[NARROW_SHARP][i] = 1.0;
        s->part[NARROW_LOBE][i] = lobe_transfer((double)NARROW_END, l);
        for (uint32_t k = 0; k < NARROW_COUNT; k++)
            s->part[1 + k][i] = k < blurred_count ? blur_transfer(k, x, y) : 0.0;
    }
    for (int a = 0; a < NARROW_PARTS; a++)
        for (int b = 0; b < NARROW_PARTS; b++) {
            s->product[a][b] = 0.0;
            for (int i = 0; i < DEGREES; i++)
                s->product[a][b] += s->importance[i] * s->part[a][i] * s->part[b][i];
        }
}

/* Solves a x = b in place by Gaussian elimination for symmetric, positive definite a; false: it is not. */
static bool solve(uint32_t n, double a[NARROW_PARTS][NARROW_PARTS], double b[NARROW_PARTS])
{
    for (uint32_t i = 0; i < n; i++) {
        if (!(a[i][i] > 1e-12))
            return false;
        for (uint32_t j = i + 1; j < n; j++) {
            double factor = a[j][i] / a[i][i];
            for (uint32_t k = i; k < n; k++)
                a[j][k] -= factor * a[i][k];
            b[j] -= factor * b[i];
        }
    }
    for (uint32_t i = n; i-- > 0;) {
        for (uint32_t k = i + 1; k < n; k++)
            b[i] -= a[i][k] * b[k];
        b[i] /= a[i][i];
    }
    return true;
}

/* Least-squares weights of the parts in set, which add up to total, for the products b; false: one of them
 * would be negative. */
static bool fit_set(const spectrum *s, uint32_t set, const double b[NARROW_PARTS], double total,
                    double weights[NARROW_PARTS])
{
    uint32_t parts[NARROW_PARTS], count = 0;
    double a[NARROW_PARTS][NARROW_PARTS], x[NARROW_PARTS];
    memset(weights, 0, NARROW_PARTS * sizeof *weights);
    for (uint32_t k = 0; k < NARROW_PARTS; k++)
        if (set >> k & 1)
            parts[count++] = k;
    /* the first one is the total minus the others */
    const double *first = s->product[parts[0]];
    for (uint32_t i = 1; i < count; i++) {
        for (uint32_t j = 1; j < count; j++)
            a[i - 1][j - 1] =
                s->product[parts[i]][parts[j]] - first[parts[i]] - first[parts[j]] + first[parts[0]];
        x[i - 1] = b[parts[i]] - b[parts[0]] - total * (first[parts[i]] - first[parts[0]]);
    }
    if (!solve(count - 1, a, x))
        return false;
    double remaining = total;
    for (uint32_t i = 1; i < count; i++) {
        if (x[i - 1] < 0.0)
            return false;
        weights[parts[i]] = x[i - 1];
        remaining -= x[i - 1];
    }
    weights[parts[0]] = remaining;
    return remaining >= 0.0;
}

/* Half the squared error of weights, up to a constant. */
static double error_of(const spectrum *s, const double b[NARROW_PARTS], const double weights[NARROW_PARTS])
{
    double sum = 0.0;
    for (int i = 0; i < NARROW_PARTS; i++) {
        double row = -b[i];
        for (int k = 0; k < NARROW_PARTS; k++)
            row += 0.5 * s->product[i][k] * weights[k];
        sum += weights[i] * row;
    }
    return sum;
}

/* Lower bounds of the weights: for the lobe of NARROW_END, the weight that gives its tail; for the wider
 * images, a share of the mixture's mass around their variance. The squared error of a sun's peak hides the
 * halo around it, and without bounds the fit would leave gaps there. */
static void find_lower_bounds(const spectrum *s, double perceptual_roughness, double bounds[NARROW_PARTS])
{
    double end = pow((double)NARROW_END, 4.0);
    double alpha2 = pow(perceptual_roughness, 4.0);
    double before = 0.0;
    memset(bounds, 0, NARROW_PARTS * sizeof *bounds);
    bounds[NARROW_LOBE] = alpha2 / end;
    for (uint32_t k = s->blurred_count; k > 1; k--) {
        double limit =
            sqrt(s->variance[k - 1] * s->variance[k - 2]); /* between an image and the next narrower one */
        double mass = (1.0 - exp(-2.0 * alpha2 / limit)) - alpha2 / end * (1.0 - exp(-2.0 * end / limit));
        bounds[k] = least_share * (mass - before);
        before = mass;
    }
}

/* Tries all sets of parts. The error is convex, so the best set without negative weights is the optimum. */
static void fit_lobe(const spectrum *s, double perceptual_roughness, float weights[NARROW_PARTS])
{
    uint32_t available = 1u << NARROW_SHARP | 1u << NARROW_LOBE | ((1u << s->blurred_count) - 1) << 1;
    double bounds[NARROW_PARTS];
    double b[NARROW_PARTS] = {0.0};
    double remaining = 1.0;
    find_lower_bounds(s, perceptual_roughness, bounds);
    for (int k = 0; k < NARROW_PARTS; k++)
        remaining -= bounds[k];
    for (int i = 0; i < DEGREES; i++) {
        double target = lobe_transfer(perceptual_roughness, s->degree[i]);
        for (int k = 0; k < NARROW_PARTS; k++)
            target -= bounds[k] * s->part[k][i];
        for (int k = 0; k < NARROW_PARTS; k++)
            b[k] += s->importance[i] * s->part[k][i] * target;
    }
    double best[NARROW_PARTS] = {remaining};
    double lowest = error_of(s, b, best);
    for (uint32_t set = 1; set < 1u << NARROW_PARTS; set++) {
        double w[NARROW_PARTS];
        if ((set & ~available) || !fit_set(s, set, b, remaining, w))
            continue;
        double error = error_of(s, b, w);
        if (error < lowest) {
            lowest = error;
            memcpy(best, w, sizeof best);
        }
    }
    for (int k = 0; k < NARROW_PARTS; k++)
        weights[k] = (float)(best[k] + bounds[k]);
}

void narrow_fit(uint32_t count, double row_rad, float weights[NARROW_STEPS + 1][NARROW_PARTS])
{
    spectrum s;
    spectrum_init(&s, count, row_rad);
    memset(weights, 0, (NARROW_STEPS + 1) * sizeof *weights);
    weights[0][NARROW_SHARP] = 1.0f;
    weights[NARROW_STEPS][NARROW_LOBE] = 1.0f;
    for (int i = 1; i < NARROW_STEPS; i++)
        fit_lobe(&s, (double)NARROW_END * i / NARROW_STEPS, weights[i]);
}

const double narrow_variances[NARROW_COUNT][NARROW_PASSES] = {{0.5}, {0.3}, {0.5, 0.3}};

enum {
    MAX_HEIGHT = 512,
    MAX_WIDTH = 1024,
    MIN_SIZE = 16,
    ROW_FLOATS = 3 * MAX_WIDTH,
    GRAIN = 32 /* rows per work item, which filters two more */
};

/* rad: wider Gaussians are not part of a lobe of NARROW_END */
static const double max_sigma = 0.05;

/* ---- along rows ---- */

/* Adds variance, in squared texels, to a row: passes of three taps at growing distances, each as wide as it
 * stays smooth ("a trous", Holschneider et al. 1989). scratch is as long as the row; returns the buffer with
 * the result. */
static inline float *blur_row(float *row, float *scratch, uint32_t width, double variance)
{
    for (uint32_t stride = 1; variance > 0.0 && 2 * stride <= width; stride *= 2) {
        double reach = (double)stride * stride;
        double pass = fmin(variance, 0.5 * reach);
        float w = (float)(0.5 * pass / reach);
        size_t n = 3 * (size_t)stride;
        size_t count = 3 * (size_t)width;
        for (size_t i = 0; i < n; i++)
            scratch[i] = row[i] + (row[i + count - n] + row[i + n] - 2.0f * row[i]) * w;
        for (size_t i = n; i < count - n; i++)
            scratch[i] = row[i] + (row[i - n] + row[i + n] - 2.0f * row[i]) * w;
        for (size_t i = count - n; i < count; i++)
            scratch[i] = row[i] + (row[i - n] + row[i + n - count] - 2.0f * row[i]) * w;
        float *blurred = scratch;
        scratch = row;
        row = blurred;
        variance -= pass;
    }
    return row;
}

/* Halves a row with weights 1 3 3 1, which keeps positions between texels. */
static inline void halve_row(const float *row, uint32_t width, float *out)
{
    size_t last = width / 2 - 1;
    for (size_t x = 0; x <= last; x++) {
        const float *p = row + 6 * x;
        const float *left = x ? p - 3 : row + 3 * (size_t)(width - 1);
        const float *right = x < last ? p + 6 : row;
        for (int k = 0; k < 3; k++)
            out[3 * x + (size_t)k] = (3.0f * (p[k] + p[k + 3]) + (left[k] + right[k])) * 0.125f;
    }
}

/* ---- images ---- */

typedef struct blurring {
    const image *from;
    image *out;
    bool is_halved;
    double variance; /* along columns, squared texels */
} blurring;

/* Share that a texel of row y exchanges with its neighbour across the edge at latitude y / height. */
static double edge_share(double variance, uint32_t height, uint32_t y, uint32_t edge)
{
    return 0.5 * variance * sin(pi * edge / height) / sin(pi * (y + 0.5) / height);
}

/* Variance in columns that row y lacks: sin(theta)^-2 times that of the columns, including bilinear lookup (a
 * sixth of a squared texel), minus those of halving and lookup. */
static double row_variance(const blurring *job, uint32_t y)
{
    double s = sin(pi * (y + 0.5) / job->out->height);
    double aspect = (double)job->out->width / (2.0 * job->out->height); /* columns per row on the equator */
    double goal = aspect * aspect / (s * s);
    if (!job->is_halved)
        return job->variance * goal;
    return (0.1875 + job->variance + 0.125) * goal - 0.1875 - 0.125;
}

/* Row y of out from two rows of from and their neighbours, weighted as in halve_row(). */
static inline void read_row(const blurring *job, uint32_t y, float *row)
{
    const float *pixels = job->from->pixels;
    size_t count = 3 * (size_t)job->from->width;
    if (!job->is_halved) {
        memcpy(row, pixels + y * count, count * sizeof *row);
        return;
    }
    uint32_t height = job->from->height;
    double north = sin(pi * (2.0 * y + 0.5) / height); /* weighted by solid angle */
    double south = sin(pi * (2.0 * y + 1.5) / height);
    float own = (float)(north / (north + south));
    float up = own * (float)edge_share(0.5, height, 2 * y, 2 * y);
    float down = (1.0f - own) * (float)edge_share(0.5, height, 2 * y + 1, 2 * y + 2);
    const float *a = pixels + 2 * (size_t)y * count;
    const float *b = a + count;
    const float *above = y ? a - count : a;
    const float *below = 2 * y + 2 < height ? b + count : b;
    float sum[ROW_FLOATS];
    for (size_t i = 0; i < count; i++)
        sum[i] = b[i] + (a[i] - b[i]) * own + (above[i] - a[i]) * up + (below[i] - b[i]) * down;
    halve_row(sum, job->from->width, row);
}

/* Reads and blurs row y into *row; *spare is as long. */
static inline void load_row(const blurring *job, uint32_t y, float **row, float **spare)
{
    read_row(job, y, *row);
    float *blurred = blur_row(*row, *spare, job->out->width, row_variance(job, y));
    *spare = blurred == *row ? *spare : *row;
    *row = blurred;
}

DISPATCH_AVX2 static void blur_rows(void *context, size_t begin, size_t end)
{
    const blurring *job = context;
    float memory[4][ROW_FLOATS];
    float *above = memory[0];
    float *middle = memory[1];
    float *below = memory[2];
    float *spare = memory[3];
    uint32_t height = job->out->height;
    size_t count = 3 * (size_t)job->out->width;
    uint32_t first = (uint32_t)begin;
    load_row(job, first ? first - 1 : 0, &above, &spare);
    load_row(job, first, &middle, &spare);
    for (uint32_t y = first; y < end; y++) {
        load_row(job, y + 1 < height ? y + 1 : y, &below, &spare);
        float up = (float)edge_share(job->variance, height, y, y); /* 0 at the poles */
        float down = (float)edge_share(job->variance, height, y, y + 1);
        float *out = (float *)job->out->pixels + count * y;
        for (size_t i = 0; i < count; i++)
            out[i] = middle[i] + (above[i] - middle[i]) * up + (below[i] - middle[i]) * down;
        float *free_row = above;
        above = middle;
        middle = below;
        below = free_row;
    }
}

static facet_result blur(const image *from, bool is_halved, double variance, const facet_allocator *allocator,
                         uint32_t thread_count, image *out, facet_error *error)
{
    uint32_t shift = is_halved ? 1 : 0;
    TRY(image_create(allocator, from->width >> shift, from->height >> shift, 3, IMAGE_F32, out, error));
    blurring job = {.from = from, .out = out, .is_halved = is_halved, .variance = variance};
    parallel_for(thread_count, out->height, GRAIN, blur_rows, &job);
    return FACET_OK;
}

/* Number of blurred images within a lobe of NARROW_END if the first one has the size of base. */
static uint32_t count_blurred(uint32_t width, uint32_t height)
{
    uint32_t count = 0;
    double row = pi / height;
    double variance = 0.0; /* rad^2 */
    while (count < NARROW_COUNT && width >= MIN_SIZE && height >= MIN_SIZE) {
        for (int pass = 0; pass < NARROW_PASSES; pass++)
            variance += narrow_variances[count][pass] * row * row;
        variance += count ? 0.1875 * row * row : 0.0;
        if (variance > max_sigma * max_sigma)
            break;
        count++;
        width /= 2;
        height /= 2;
        row *= 2.0;
    }
    return count;
}

facet_result narrow_create(const image *sharp, const facet_allocator *allocator, uint32_t thread_count,
                           narrow *out, facet_error *error)
{
    *out = (narrow){0};
    narrow n = {0};
    image base = {0}; /* if the size of the sharp image cannot be halved twice */
    uint32_t width = (sharp->width < MAX_WIDTH ? sharp->width : MAX_WIDTH) & ~3u;
    uint32_t height = (sharp->height < MAX_HEIGHT ? sharp->height : MAX_HEIGHT) & ~3u;
    facet_result result = FACET_OK;
    n.count = count_blurred(width, height);
    if (n.count && (width != sharp->width || height != sharp->height))
        result = equirect_resize(sharp, width, height, allocator, thread_count, &base, error);
    const image *from = base.pixels ? &base : sharp;
    for (uint32_t i = 0; i < n.count && result == FACET_OK; i++) {
        image *to = &n.blurred[i];
        result = blur(from, i > 0, narrow_variances[i][0], allocator, thread_count, to, error);
        for (int pass = 1; pass < NARROW_PASSES && narrow_variances[i][pass] > 0.0 && result == FACET_OK;
             pass++) {
            image once = *to;
            result = blur(&once, false, narrow_variances[i][pass], allocator, thread_count, to, error);
            image_destroy(&once);
        }
        from = to;
    }
    image_destroy(&base);
    if (result != FACET_OK) {
        narrow_destroy(&n);
        return result;
    }
    narrow_fit(n.count, pi / (n.count ? height : sharp->height), n.weights);
    *out = n;
    return FACET_OK;
}

void narrow_destroy(narrow *n)
{
    for (int i = 0; i < NARROW_COUNT; i++)
        image_destroy(&n->blurred[i]);
    *n = (narrow){0};
}
