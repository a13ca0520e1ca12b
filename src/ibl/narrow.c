/* narrow.c - the blurred pictures of narrow.h; their weights: narrow_fit.c.
 *
 * A Gaussian on the sphere is blurred along rows, where its variance is 1 / sin(theta)^2 times as large in columns, and
 * then along columns. Columns exchange radiance through the edges between their texels, in proportion to the length of
 * the edge: what leaves a texel arrives in the next, and nothing passes a pole, around which rows are uniform anyway. */
#include "ibl/narrow.h"

#include <math.h>
#include <string.h>

#include "base/parallel.h"
#include "base/simd.h"
#include "ibl/equirect.h"

static const double pi = 3.14159265358979323846;
const double narrow_variances[NARROW_COUNT][NARROW_PASSES] = {{0.5}, {0.3}, {0.5, 0.3}};

enum {
    MAX_HEIGHT = 512,
    MAX_WIDTH = 1024,
    MIN_SIZE = 16,
    ROW_FLOATS = 3 * MAX_WIDTH,
    GRAIN = 32 /* rows a thread takes at a time; it filters two more */
};

/* Wider than that, rad, a Gaussian is none that a lobe of NARROW_END holds. */
static const double max_sigma = 0.05;

/* ---- along rows ---- */

/* Adds variance to a row, in squared texels. Three taps further and further apart, each pass as wide as it stays smooth
 * ("a trous", Holschneider et al. 1989). scratch is as long as the row; returns the one that has the result. */
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

/* Pairs of texels of a row, with a share of their neighbours: 1 3 3 1, which keeps the place of what is between texels. */
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

/* ---- pictures ---- */

typedef struct blurring {
    const image *from;
    image *out;
    bool is_halved;
    double variance; /* along columns, squared texels */
} blurring;

/* Share of what a texel of row y exchanges with its neighbour through the edge, whose latitude is y / height. */
static double edge_share(double variance, uint32_t height, uint32_t y, uint32_t edge)
{
    return 0.5 * variance * sin(pi * edge / height) / sin(pi * (y + 0.5) / height);
}

/* Variance in columns that row y lacks: sin(theta)^-2 times that of the columns, those of bilinear lookup (a sixth of a
 * texel squared, less that of the mirrored picture) included, less what halving and lookup bring themselves. */
static double row_variance(const blurring *job, uint32_t y)
{
    double s = sin(pi * (y + 0.5) / job->out->height);
    double aspect = (double)job->out->width / (2.0 * job->out->height); /* columns per row on the equator */
    double goal = aspect * aspect / (s * s);
    if (!job->is_halved)
        return job->variance * goal;
    return (0.1875 + job->variance + 0.125) * goal - 0.1875 - 0.125;
}

/* Row y of the size of out: two rows of from, with a share of their neighbours as in halve_row(). */
static inline void read_row(const blurring *job, uint32_t y, float *row)
{
    const float *pixels = job->from->pixels;
    size_t count = 3 * (size_t)job->from->width;
    if (!job->is_halved) {
        memcpy(row, pixels + y * count, count * sizeof *row);
        return;
    }
    uint32_t height = job->from->height;
    double north = sin(pi * (2.0 * y + 0.5) / height); /* in proportion to solid angles */
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
    facet_result result =
        image_create(allocator, from->width >> shift, from->height >> shift, 3, IMAGE_F32, out, error);
    if (result != FACET_OK)
        return result;
    blurring job = {.from = from, .out = out, .is_halved = is_halved, .variance = variance};
    parallel_for(thread_count, out->height, GRAIN, blur_rows, &job);
    return FACET_OK;
}

/* How many pictures a lobe of NARROW_END can hold, if the first is as large as base. */
static uint32_t count_pictures(uint32_t width, uint32_t height)
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

facet_result narrow_create(const image *mirror, const facet_allocator *allocator, uint32_t thread_count,
                           narrow *out, facet_error *error)
{
    *out = (narrow){0};
    narrow n = {0};
    image base = {0}; /* where the mirror's size is not one that can be halved twice */
    uint32_t width = (mirror->width < MAX_WIDTH ? mirror->width : MAX_WIDTH) & ~3u;
    uint32_t height = (mirror->height < MAX_HEIGHT ? mirror->height : MAX_HEIGHT) & ~3u;
    facet_result result = FACET_OK;
    n.count = count_pictures(width, height);
    if (n.count && (width != mirror->width || height != mirror->height))
        result = equirect_resize(mirror, width, height, allocator, thread_count, &base, error);
    const image *from = base.pixels ? &base : mirror;
    for (uint32_t i = 0; i < n.count && result == FACET_OK; i++) {
        image *to = &n.pictures[i];
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
    narrow_fit(n.count, pi / (n.count ? height : mirror->height), n.weights);
    *out = n;
    return FACET_OK;
}

void narrow_destroy(narrow *n)
{
    for (int i = 0; i < NARROW_COUNT; i++)
        image_destroy(&n->pictures[i]);
    *n = (narrow){0};
}
