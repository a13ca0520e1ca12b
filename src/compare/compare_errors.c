/* compare_errors.c - see compare_metrics.h. Each row has its own sums, which are added from top to bottom, so
 * that the result does not depend on the number of threads. */
#include "compare/compare_metrics.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "base/simd.h"
#include "image/half.h"

enum { BLOCK = 256 /* pixels of a row at a time, on the stack */, GRAIN = 16 /* rows */ };

/* Planes for a block. */
typedef struct block {
    float a[4][BLOCK], b[4][BLOCK];
    unsigned char flags[BLOCK];
    compare_row row;
} block;

static void block_init(block *k)
{
    for (int c = 0; c < 4; c++) {
        k->row.a[c] = k->a[c];
        k->row.b[c] = k->b[c];
    }
    k->row.flags = k->flags;
}

static uint32_t block_size(uint32_t x, uint32_t width)
{
    return width - x < BLOCK ? width - x : BLOCK;
}

/* ---- the survey ---- */

typedef struct survey_job {
    const compare_source *source;
    float *luminance;
    compare_survey *rows;
} survey_job;

static bool is_finite_pixel(const float *p)
{
    unsigned count = 0;
    for (int k = 0; k < 4; k++)
        count += (float_bits(p[k]) & 0x7f800000u) != 0x7f800000u;
    return count == 4;
}

/* Properties of the source texels, before tone mapping and compositing. */
static void survey_raw(const compare_source *s, uint32_t y, compare_survey *row)
{
    compare_texels t;
    for (uint32_t x = 0; x < s->width; x++) {
        const uint32_t i = x % COMPARE_TEXELS;
        if (i == 0)
            compare_source_read(s, x, y, s->width - x < COMPARE_TEXELS ? s->width - x : COMPARE_TEXELS, &t);
        const float *a = t.a + 4 * i, *b = t.b + 4 * i;
        if (!t.counts[i])
            continue;
        row->is_equal = row->is_equal && memcmp(a, b, 4 * sizeof *a) == 0;
        row->has_opacity = row->has_opacity || a[3] < 1.0f || b[3] < 1.0f;
        row->nonfinite_a += !is_finite_pixel(a);
        row->nonfinite_b += !is_finite_pixel(b);
    }
}

static void survey_rows(void *context, size_t begin, size_t end)
{
    const survey_job *job = context;
    const compare_source *s = job->source;
    block k;
    block_init(&k);
    for (size_t y = begin; y < end; y++) {
        compare_survey *row = &job->rows[y];
        *row = (compare_survey){.is_equal = true};
        survey_raw(s, (uint32_t)y, row);
        for (uint32_t x = 0; x < s->width; x += BLOCK) {
            const uint32_t count = block_size(x, s->width);
            compare_source_load(s, COMPARE_LIGHT, NULL, x, (int64_t)y, count, &k.row);
            float *luminance = job->luminance ? job->luminance + y * s->width + x : NULL;
            for (uint32_t i = 0; i < count; i++) {
                const bool counts = k.flags[i] & COMPARE_COUNTS, is_invalid = k.flags[i] & COMPARE_INVALID;
                const float r = k.a[0][i], g = k.a[1][i], b = k.a[2][i];
                const float largest = r > g ? (r > b ? r : b) : (g > b ? g : b);
                const float light = 0.2126f * r + 0.7152f * g + 0.0722f * b;
                row->pixel_count += counts;
                row->invalid_count += is_invalid;
                if (counts && !is_invalid && largest > row->largest)
                    row->largest = largest;
                if (luminance)
                    luminance[i] = !counts || is_invalid ? -1.0f : light > 0.0f ? light : 0.0f;
            }
        }
    }
}

facet_result compare_survey_make(const compare_source *s, const facet_compare_desc *desc, float *luminance,
                                 compare_survey *out, facet_error *error)
{
    survey_job job = {.source = s, .luminance = luminance};
    job.rows = mem_alloc(&desc->allocator, s->height, sizeof *job.rows);
    if (!job.rows)
        return fail_memory(error, "sums of rows", s->height * sizeof *job.rows);
    parallel_for(desc->thread_count, s->height, GRAIN, survey_rows, &job);
    *out = (compare_survey){.is_equal = true};
    for (uint32_t y = 0; y < s->height; y++) {
        const compare_survey *row = &job.rows[y];
        out->is_equal = out->is_equal && row->is_equal;
        out->has_opacity = out->has_opacity || row->has_opacity;
        out->pixel_count += row->pixel_count;
        out->nonfinite_a += row->nonfinite_a;
        out->nonfinite_b += row->nonfinite_b;
        out->invalid_count += row->invalid_count;
        out->largest = row->largest > out->largest ? row->largest : out->largest;
    }
    mem_free(job.rows);
    return FACET_OK;
}

/* ---- errors ---- */

typedef struct error_sums {
    double squares, relative, absolute, difference, reference; /* over channels */
    uint64_t finite, differing;                                /* pixels */
    float largest;
    uint32_t largest_x;
} error_sums;

typedef struct errors_job {
    const compare_source *source;
    uint32_t channel_count;
    float epsilon, threshold;
    float *errors;
    error_sums *rows;
} errors_job;

/* The largest error of each pixel. */
DISPATCH_AVX2 static void compare_largest_errors(const block *k, uint32_t count, uint32_t channel_count,
                                                 float *errors)
{
    for (uint32_t i = 0; i < count; i++)
        errors[i] = 0.0f;
    for (uint32_t c = 0; c < channel_count; c++)
        for (uint32_t i = 0; i < count; i++) {
            float e = k->b[c][i] - k->a[c][i];
            e = e < 0.0f ? -e : e;
            errors[i] = e > errors[i] ? e : errors[i];
        }
}

/* Sums of a channel, in double, in eight lanes so that the loop vectorises; the lane of a pixel depends on
 * its position only. Pixels that do not count are equal in both images and have weight 0 in the reference
 * sums. */
DISPATCH_AVX2 static void compare_add_channel(const float *a, const float *b, const float *weight,
                                              uint32_t count, double epsilon, error_sums *sums)
{
    enum { LANES = 8 };
    double squares[LANES] = {0}, relative[LANES] = {0}, absolute[LANES] = {0}, difference[LANES] = {0},
           reference[LANES] = {0};
    for (uint32_t i = 0; i < count; i += LANES)
        for (uint32_t l = 0; l < LANES; l++) {
            const double w = (double)weight[i + l], value = (double)a[i + l];
            const double d = ((double)b[i + l] - value) * w;
            squares[l] += d * d;
            relative[l] += d * d / (value * value + epsilon);
            absolute[l] += d < 0.0 ? -d : d;
            difference[l] += d;
            reference[l] += value * value * w;
        }
    for (uint32_t l = 0; l < LANES; l++) {
        sums->squares += squares[l];
        sums->relative += relative[l];
        sums->absolute += absolute[l];
        sums->difference += difference[l];
        sums->reference += reference[l];
    }
}

static void errors_of_block(const errors_job *job, block *k, uint32_t x, uint32_t count, float *errors,
                            error_sums *row)
{
    float weight[BLOCK];
    compare_largest_errors(k, count, job->channel_count, errors);
    for (uint32_t i = 0; i < count; i++) {
        const bool counts = k->flags[i] & COMPARE_COUNTS, is_invalid = k->flags[i] & COMPARE_INVALID;
        errors[i] = !counts ? -1.0f : is_invalid ? INFINITY : errors[i];
        weight[i] = counts && !is_invalid ? 1.0f : 0.0f;
        row->finite += counts && !is_invalid;
        row->differing += errors[i] > job->threshold;
        if (errors[i] > row->largest) {
            row->largest = errors[i];
            row->largest_x = x + i;
        }
    }
    for (uint32_t c = 0; c < 4; c++)
        for (uint32_t i = count; i % 8 != 0; i++)
            k->a[c][i] = k->b[c][i] = weight[i] = 0.0f;
    for (uint32_t c = 0; c < job->channel_count; c++)
        compare_add_channel(k->a[c], k->b[c], weight, count, (double)job->epsilon, row);
}

static void error_rows(void *context, size_t begin, size_t end)
{
    const errors_job *job = context;
    const compare_source *s = job->source;
    block k;
    block_init(&k);
    for (size_t y = begin; y < end; y++) {
        job->rows[y] = (error_sums){.largest = -1.0f};
        for (uint32_t x = 0; x < s->width; x += BLOCK) {
            const uint32_t count = block_size(x, s->width);
            compare_source_load(s, COMPARE_CODES, NULL, x, (int64_t)y, count, &k.row);
            errors_of_block(job, &k, x, count, job->errors + y * s->width + x, &job->rows[y]);
        }
    }
}

/* Means and roots from the sums. */
static void conclude(const error_sums *sums, uint32_t channel_count, facet_comparison *out)
{
    const double count = (double)sums->finite * channel_count; /* 0 makes all means NAN */
    out->mse = sums->squares / count;
    out->rmse = sqrt(out->mse);
    out->mse_relative = sums->relative / count;
    out->rmse_relative = sqrt(out->mse_relative);
    out->nrmse = sums->squares > 0.0 ? sqrt(sums->squares / sums->reference) : out->rmse;
    out->mae = sums->absolute / count;
    out->bias = sums->difference / count;
    out->max_error = (double)sums->largest;
    out->differing_count = sums->differing;
    out->differing_share = (double)sums->differing / (double)out->pixel_count;
}

facet_result compare_errors_make(const compare_source *s, const facet_compare_desc *desc, float *errors,
                                 facet_comparison *out, facet_error *error)
{
    errors_job job = {.source = s,
                      .channel_count = out->channel_count,
                      .epsilon = desc->relative_epsilon > 0.0f ? desc->relative_epsilon : 0.01f,
                      .threshold = desc->threshold,
                      .errors = errors};
    job.rows = mem_alloc(&desc->allocator, s->height, sizeof *job.rows);
    if (!job.rows)
        return fail_memory(error, "sums of rows", s->height * sizeof *job.rows);
    parallel_for(desc->thread_count, s->height, GRAIN, error_rows, &job);
    error_sums sums = {.largest = -1.0f};
    for (uint32_t y = 0; y < s->height; y++) {
        const error_sums *row = &job.rows[y];
        sums.squares += row->squares;
        sums.relative += row->relative;
        sums.absolute += row->absolute;
        sums.difference += row->difference;
        sums.reference += row->reference;
        sums.finite += row->finite;
        sums.differing += row->differing;
        if (row->largest > sums.largest) {
            sums.largest = row->largest;
            out->max_x = s->x + row->largest_x;
            out->max_y = s->y + y;
        }
    }
    conclude(&sums, out->channel_count, out);
    mem_free(job.rows);
    return FACET_OK;
}

/* ---- percentiles ---- */

enum { BINS = 1 << 16 };

/* The bin that holds the value of a rank (from 1); *rank becomes the rank within that bin. */
static uint32_t find_bin(const uint64_t *bins, uint64_t *rank)
{
    uint32_t bin = 0;
    while (bin < BINS - 1 && *rank > bins[bin])
        *rank -= bins[bin++];
    return bin;
}

static bool is_value(float x)
{
    return x >= 0.0f;
}

facet_result compare_select(const float *values, size_t value_count, const double *shares, uint32_t count,
                            const facet_allocator *allocator, double *out, facet_error *error)
{
    uint64_t *bins = mem_zalloc(allocator, (size_t)(1 + COMPARE_SELECT_MAX) * BINS, sizeof *bins);
    if (!bins)
        return fail_memory(error, "histogram", sizeof *bins * BINS);
    uint64_t total = 0;
    for (size_t i = 0; i < value_count; i++)
        if (is_value(values[i])) {
            bins[float_bits(values[i] + 0.0f) >> 16]++; /* + 0 turns -0 into 0 */
            total++;
        }
    uint64_t ranks[COMPARE_SELECT_MAX];
    uint32_t upper[COMPARE_SELECT_MAX];
    for (uint32_t k = 0; k < count; k++) {
        const double rank =
            ceil(shares[k] / 100.0 * (double)total - 1e-9); /* 95 % of 100 is 95 although 0.95 is not exact */
        ranks[k] = rank < 1.0 ? 1 : rank > (double)total ? total : (uint64_t)rank;
        upper[k] = find_bin(bins, &ranks[k]);
    }
    for (size_t i = 0; i < value_count; i++) {
        if (!is_value(values[i]))
            continue;
        const uint32_t bits = float_bits(values[i] + 0.0f);
        for (uint32_t k = 0; k < count; k++)
            if (bits >> 16 == upper[k])
                bins[(size_t)(1 + k) * BINS + (bits & 0xffff)]++;
    }
    for (uint32_t k = 0; k < count; k++) {
        const uint32_t lower = find_bin(bins + (size_t)(1 + k) * BINS, &ranks[k]);
        out[k] = total ? (double)float_from_bits(upper[k] << 16 | lower) : 0.0;
    }
    mem_free(bins);
    return FACET_OK;
}
