/* compare.c - a comparison from beginning to end. See compare.h. */
#include "compare/compare.h"

#include <math.h>

#include "base/memory.h"
#include "base/result.h"
#include "compare/compare_errors.h"
#include "compare/compare_flip.h"
#include "compare/compare_map.h"
#include "compare/compare_select.h"
#include "compare/compare_source.h"
#include "compare/compare_ssim.h"

static facet_result check_desc(const facet_compare_desc *desc, facet_error *error)
{
    if ((int)desc->space < 0 || desc->space > FACET_COMPARE_SPACE_DISPLAY || (int)desc->alpha < 0 ||
        desc->alpha > FACET_COMPARE_ALPHA_BACKGROUND || (int)desc->difference < 0 ||
        desc->difference > FACET_DIFFERENCE_HEAT_MAP || (int)desc->tonemap < 0 ||
        desc->tonemap > FACET_TONEMAP_HABLE)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "compare: space, alpha, difference or tonemap is none there is");
    if (desc->pixels_per_degree != 0.0f &&
        !(desc->pixels_per_degree >= 1.0f && desc->pixels_per_degree <= 1000.0f))
        return fail(error, FACET_ERROR_ARGUMENT, "compare: %g pixels per degree are not 1 to 1000",
                    (double)desc->pixels_per_degree);
    if (desc->percentile != 0.0 && !(desc->percentile > 0.0 && desc->percentile <= 100.0))
        return fail(error, FACET_ERROR_ARGUMENT, "compare: the percentile %g is not above 0 and at most 100",
                    desc->percentile);
    if (!(desc->threshold >= 0.0f) || !(desc->gain >= 0.0f && desc->gain < INFINITY) ||
        !(desc->relative_epsilon >= 0.0f) || !(desc->peak >= 0.0f && desc->peak < INFINITY) ||
        !(fabsf(desc->exposure_ev) <= 100.0f))
        return fail(error, FACET_ERROR_ARGUMENT,
                    "compare: threshold, gain, relative_epsilon or peak is below 0 or no number, or "
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
    facet_result result = compare_select(errors, count, shares, wanted, &desc->allocator, values, error);
    if (result != FACET_OK)
        return result;
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
        survey->largest > 0.0f ? (double)survey->largest : 1.0; /* of black: anything serves */
    out->peak = desc->peak > 0.0f ? (double)desc->peak : s->is_display ? 1.0 : largest;
}

/* The numbers of out; map (a float per pixel) holds one thing after the other, in the end the errors of a heat map. */
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

facet_result compare_pictures(const compare_picture *a, const compare_picture *b, const compare_picture *mask,
                              const facet_compare_desc *desc, facet_comparison *out,
                              compare_difference *difference, facet_error *error)
{
    const facet_compare_desc defaults = {0};
    facet_compare_desc d = desc ? *desc : defaults;
    d.thread_count = d.thread_count ? d.thread_count : facet_thread_count();
    *out = (facet_comparison){0};
    if (difference)
        *difference = (compare_difference){0};
    compare_source s;
    facet_result result = check_desc(&d, error);
    if (result == FACET_OK)
        result = compare_source_open(a, b, mask, &d, &s, error);
    if (result != FACET_OK)
        return result;
    const size_t count = (size_t)s.width * s.height;
    float *map = mem_alloc(&d.allocator, count, sizeof *map);
    if (!map)
        return fail_memory(error, "errors of pixels", count * sizeof *map);
    const bool is_heat = difference && d.difference == FACET_DIFFERENCE_HEAT_MAP;
    const bool is_flip_shown = is_heat && !(d.skipped_metrics & FACET_METRIC_FLIP);
    result = measure(&s, &d, map, is_flip_shown, out, error);
    if (result == FACET_OK && difference)
        result = compare_map_make(&s, &d, out->channel_count, is_heat ? map : NULL,
                                  !is_flip_shown && d.gain > 0.0f ? d.gain : 1.0f, difference, error);
    mem_free(map);
    if (result != FACET_OK)
        *out = (facet_comparison){0};
    return result;
}
