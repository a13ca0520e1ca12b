/* compare.c - a comparison from beginning to end. See compare.h. */
#include "compare/compare.h"

#include <math.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "compare/compare_math.h"
#include "compare/compare_metrics.h"
#include "compare/compare_source.h"

enum { BLOCK = 256, GRAIN = 16 };

/* ---- colors ---- */

/* Every 16th of magma's 256 colors, and the last one. */
static const float magma[17][3] = {
    {0.001f, 0.000f, 0.014f}, {0.040f, 0.031f, 0.134f}, {0.113f, 0.065f, 0.277f}, {0.212f, 0.062f, 0.419f},
    {0.317f, 0.072f, 0.485f}, {0.415f, 0.110f, 0.505f}, {0.513f, 0.148f, 0.508f}, {0.614f, 0.182f, 0.499f},
    {0.716f, 0.215f, 0.475f}, {0.817f, 0.256f, 0.436f}, {0.904f, 0.320f, 0.388f}, {0.961f, 0.418f, 0.360f},
    {0.987f, 0.536f, 0.382f}, {0.996f, 0.654f, 0.446f}, {0.997f, 0.770f, 0.535f}, {0.992f, 0.884f, 0.640f},
    {0.987f, 0.991f, 0.750f}};

void compare_magma(float error, float color[3])
{
    const float at =
        compare_clamp(error, 0.0f, 1.0f) * 255.0f / 16.0f; /* the last color is that of 255, not of 256 */
    const int i = at < 15.0f ? (int)at : 15;
    const float t = i < 15 ? at - (float)i : (at - 15.0f) * (16.0f / 15.0f);
    for (int k = 0; k < 3; k++)
        color[k] = magma[i][k] + (magma[i + 1][k] - magma[i][k]) * compare_clamp(t, 0.0f, 1.0f);
}

/* ---- images ---- */

typedef struct map_job {
    const compare_source *source;
    const facet_compare_desc *desc;
    uint32_t channel_count;
    const float *errors;
    float gain, error_gain;
    image *out;
} map_job;

static void put(float *pixel, float r, float g, float b)
{
    pixel[0] = r;
    pixel[1] = g;
    pixel[2] = b;
    pixel[3] = 1.0f;
}

/* The value that stands for a difference; in display space the file is to hold the number itself. */
static float shown(const map_job *job, float difference)
{
    const float x = difference < 0.0f ? -difference * job->gain : difference * job->gain;
    return job->source->is_display ? compare_srgb_decode(compare_clamp(x, 0.0f, 1.0f)) : x;
}

static void put_difference(const map_job *job, const compare_row *row, uint32_t i, float *pixel)
{
    float opacity = 0.0f, d[3];
    if (job->channel_count == 4)
        opacity = row->b[3][i] < row->a[3][i] ? row->a[3][i] - row->b[3][i] : row->b[3][i] - row->a[3][i];
    for (int k = 0; k < 3; k++) {
        const float e = row->b[k][i] - row->a[k][i];
        d[k] = shown(job, (e < 0.0f ? -e : e) + opacity);
    }
    if (row->flags[i] & COMPARE_INVALID) /* the brightest value */
        put(pixel, 1.0f, 1.0f, 1.0f);
    else
        put(pixel, d[0], d[1], d[2]);
}

static void put_heat(float error, float *pixel)
{
    float color[3];
    compare_magma(error, color);
    put(pixel, compare_srgb_decode(color[0]), compare_srgb_decode(color[1]), compare_srgb_decode(color[2]));
}

static void map_rows(void *context, size_t begin, size_t end)
{
    const map_job *job = context;
    const compare_source *s = job->source;
    float planes[8][BLOCK];
    unsigned char flags[BLOCK];
    compare_row row = {.flags = flags};
    for (int k = 0; k < 4; k++) {
        row.a[k] = planes[k];
        row.b[k] = planes[4 + k];
    }
    const uint32_t place = job->desc->is_sheet ? 2 * s->width : 0; /* first column of the difference */
    for (size_t y = begin; y < end; y++) {
        float *line = (float *)job->out->pixels + 4 * (size_t)job->out->width * y;
        for (uint32_t x = 0; x < s->width; x += BLOCK) {
            const uint32_t count = s->width - x < BLOCK ? s->width - x : BLOCK;
            compare_source_load(s, COMPARE_CODES, NULL, x, (int64_t)y, count, &row);
            for (uint32_t i = 0; i < count; i++)
                if (job->errors)
                    put_heat(job->errors[y * s->width + x + i] * job->error_gain, line + 4 * (place + x + i));
                else
                    put_difference(job, &row, i, line + 4 * (place + x + i));
            if (!job->desc->is_sheet)
                continue;
            compare_source_load(s, COMPARE_LIGHT, NULL, x, (int64_t)y, count, &row);
            for (uint32_t i = 0; i < count; i++) {
                put(line + 4 * (x + i), row.a[0][i], row.a[1][i], row.a[2][i]);
                put(line + 4 * (s->width + x + i), row.b[0][i], row.b[1][i], row.b[2][i]);
            }
        }
    }
}

static facet_result compare_map_make(const compare_source *s, const facet_compare_desc *desc,
                                     uint32_t channel_count, const float *errors, float error_gain,
                                     image *out, facet_error *error)
{
    const uint32_t columns = desc->is_sheet ? 3 : 1;
    if (s->width > UINT32_MAX / columns)
        return fail(error, FACET_ERROR_LIMIT,
                    "compare: a sheet of three images of %u pixels side by side is too wide", s->width);
    image made;
    TRY(image_create(&desc->allocator, s->width * columns, s->height, 4, IMAGE_F32, &made, error));
    map_job job = {.source = s,
                   .desc = desc,
                   .channel_count = channel_count,
                   .errors = errors,
                   .gain = desc->gain > 0.0f ? desc->gain : 1.0f,
                   .error_gain = error_gain,
                   .out = &made};
    parallel_for(desc->thread_count, s->height, GRAIN, map_rows, &job);
    *out = made;
    return FACET_OK;
}

static facet_result check_desc(const facet_compare_desc *desc, facet_error *error)
{
    if ((int)desc->space < 0 || desc->space > FACET_COMPARE_SPACE_DISPLAY || (int)desc->alpha < 0 ||
        desc->alpha > FACET_COMPARE_ALPHA_BACKGROUND || (int)desc->difference < 0 ||
        desc->difference > FACET_DIFFERENCE_HEAT_MAP || (int)desc->tonemap < 0 ||
        desc->tonemap > FACET_TONEMAP_HABLE)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "compare: space, alpha, difference or tonemap is not a value of its enumeration");
    if (desc->pixels_per_degree != 0.0f &&
        !(desc->pixels_per_degree >= 1.0f && desc->pixels_per_degree <= 1000.0f))
        return fail(error, FACET_ERROR_ARGUMENT, "compare: %g pixels per degree: 1 to 1000 were expected",
                    (double)desc->pixels_per_degree);
    if (desc->percentile != 0.0 && !(desc->percentile > 0.0 && desc->percentile <= 100.0))
        return fail(error, FACET_ERROR_ARGUMENT,
                    "compare: percentile %g: above 0 and at most 100 was expected", desc->percentile);
    if (!(desc->threshold >= 0.0f) || !(desc->gain >= 0.0f && desc->gain < INFINITY) ||
        !(desc->relative_epsilon >= 0.0f) || !(desc->peak >= 0.0f && desc->peak < INFINITY) ||
        !(fabsf(desc->exposure_ev) <= 100.0f))
        return fail(error, FACET_ERROR_ARGUMENT,
                    "compare: threshold, gain, relative_epsilon or peak is negative or not finite, or "
                    "exposure_ev beyond "
                    "100 stops");
    if (desc->space == FACET_COMPARE_SPACE_LINEAR && desc->tonemap != FACET_TONEMAP_NONE)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "compare: tone mapping is for the display, not for linear space");
    return FACET_OK;
}

static facet_result percentiles(const float *errors, size_t count, const facet_compare_desc *desc,
                                facet_comparison *out, facet_error *error)
{
    const double shares[5] = {50.0, 95.0, 99.0, 99.9, desc->percentile};
    double values[5];
    const uint32_t wanted = desc->percentile > 0.0 ? 5 : 4;
    TRY(compare_select(errors, count, shares, wanted, &desc->allocator, values, error));
    out->percentile_50 = values[0];
    out->percentile_95 = values[1];
    out->percentile_99 = values[2];
    out->percentile_999 = values[3];
    if (wanted == 5)
        out->percentile = values[4];
    return FACET_OK;
}

static void begin(const compare_source *s, const compare_survey *survey, const facet_compare_desc *desc,
                  facet_comparison *out)
{
    *out =
        (facet_comparison){.width = s->width,
                           .height = s->height,
                           .space = s->is_display ? FACET_COMPARE_SPACE_DISPLAY : FACET_COMPARE_SPACE_LINEAR,
                           .channel_count = s->has_opacity && survey->has_opacity ? 4 : 3,
                           .pixel_count = survey->pixel_count,
                           .is_equal = survey->is_equal,
                           .nonfinite_a = survey->nonfinite_a,
                           .nonfinite_b = survey->nonfinite_b,
                           .invalid_count = survey->invalid_count,
                           .percentile = (double)NAN,
                           .ssim = (double)NAN,
                           .ssim_channels = (double)NAN,
                           .flip = (double)NAN,
                           .flip_max = (double)NAN};
    const double largest =
        survey->largest > 0.0f ? (double)survey->largest : 1.0; /* a black image: any peak will do */
    out->peak = desc->peak > 0.0f ? (double)desc->peak : s->is_display ? 1.0 : largest;
}

/* Computes all metrics. map, a float per pixel, is scratch memory that holds the errors of a heat map in the
 * end. */
static facet_result measure(compare_source *s, const facet_compare_desc *desc, float *map, bool is_flip_shown,
                            facet_comparison *out, facet_error *error)
{
    const size_t count = (size_t)s->width * s->height;
    const bool has_flip = !(desc->skipped_metrics & FACET_METRIC_FLIP);
    float *luminance = NULL;
    compare_survey survey;
    facet_result result = FACET_OK;
    if (has_flip && !s->is_display) {
        luminance = mem_alloc(&desc->allocator, count, sizeof *luminance);
        result = luminance ? FACET_OK : fail_memory(error, "luminances", count * sizeof *luminance);
    }
    if (result == FACET_OK)
        result = compare_survey_make(s, desc, luminance, &survey, error);
    if (result == FACET_OK && survey.pixel_count == 0)
        result = fail(error, FACET_ERROR_ARGUMENT, "compare: the mask leaves no pixel to compare");
    if (result == FACET_OK) {
        begin(s, &survey, desc, out);
        s->has_opacity = out->channel_count == 4;
        result = compare_errors_make(s, desc, map, out, error);
    }
    if (result == FACET_OK) {
        out->psnr = out->mse > 0.0 ? 10.0 * log10(out->peak * out->peak / out->mse)
                                   : (out->mse == 0.0 ? (double)INFINITY : (double)NAN);
        result = percentiles(map, count, desc, out, error);
    }
    if (result == FACET_OK && !(desc->skipped_metrics & FACET_METRIC_SSIM))
        result = compare_ssim_make(s, desc, out, error);
    if (result == FACET_OK && has_flip)
        result = compare_flip_make(s, desc, luminance, is_flip_shown ? map : NULL, out, error);
    mem_free(luminance);
    return result;
}

facet_result compare_images(const compare_image *a, const compare_image *b, const compare_image *mask,
                            const facet_compare_desc *desc, facet_comparison *out, image *difference,
                            facet_error *error)
{
    const facet_compare_desc defaults = {0};
    facet_compare_desc d = desc ? *desc : defaults;
    d.thread_count = d.thread_count ? d.thread_count : facet_thread_count();
    *out = (facet_comparison){0};
    if (difference)
        *difference = (image){0};
    compare_source s;
    TRY(check_desc(&d, error));
    TRY(compare_source_open(a, b, mask, &d, &s, error));
    const size_t count = (size_t)s.width * s.height;
    float *map = mem_alloc(&d.allocator, count, sizeof *map);
    const bool is_heat = difference && d.difference == FACET_DIFFERENCE_HEAT_MAP;
    const bool is_flip_shown = is_heat && !(d.skipped_metrics & FACET_METRIC_FLIP);
    facet_result result = map ? measure(&s, &d, map, is_flip_shown, out, error)
                              : fail_memory(error, "errors of pixels", count * sizeof *map);
    if (result == FACET_OK && difference)
        result = compare_map_make(&s, &d, out->channel_count, is_heat ? map : NULL,
                                  !is_flip_shown && d.gain > 0.0f ? d.gain : 1.0f, difference, error);
    mem_free(map);
    compare_source_close(&s);
    if (result != FACET_OK)
        *out = (facet_comparison){0};
    return result;
}
