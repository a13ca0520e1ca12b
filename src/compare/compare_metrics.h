/* compare_metrics.h - the metrics of a comparison: survey of both images, errors per pixel and their
 * percentiles, SSIM, FLIP. */
#ifndef COMPARE_COMPARE_METRICS_H
#define COMPARE_COMPARE_METRICS_H

#include "compare/compare_source.h"

/* Facts about both images that the metrics depend on. */
typedef struct compare_survey {
    bool is_equal;    /* all bits of the pixels that count are equal */
    bool has_opacity; /* some pixel that counts is not opaque */
    uint64_t pixel_count, nonfinite_a, nonfinite_b, invalid_count;
    float largest; /* largest linear channel of a, at least 0 */
} compare_survey;

/* luminance (width * height; may be NULL) receives the linear luminance of a, at least 0, or -1 where a pixel
 * does not count. */
facet_result compare_survey_make(const compare_source *s, const facet_compare_desc *desc, float *luminance,
                                 compare_survey *out, facet_error *error);

/* Fills mse to differing_share of out, except the percentiles; pixel_count and channel_count are set before.
 * errors (width * height) receives the largest |b - a| over the channels: infinity for invalid pixels, -1 for
 * those that do not count. */
facet_result compare_errors_make(const compare_source *s, const facet_compare_desc *desc, float *errors,
                                 facet_comparison *out, facet_error *error);

/* Fills ssim and ssim_channels of out by its channel_count and peak: the mean over all windows of 11 x 11
 * pixels, weighted by a Gaussian of 1.5 pixels, that lie in the image and whose middle counts, of
 *   ((2 ma mb + C1) (2 sab + C2)) / ((ma^2 + mb^2 + C1) (sa^2 + sb^2 + C2)),  C1 = (0.01 peak)^2, C2 = (0.03 peak)^2
 * Wang, Bovik, Sheikh, Simoncelli 2004, equation 13; without the reduction of large images that came
 * later. NAN where there is no such window. Fails with FACET_ERROR_MEMORY. */
facet_result compare_ssim_make(const compare_source *s, const facet_compare_desc *desc, facet_comparison *out,
                               facet_error *error);

/* Fills flip to flip_exposure_count of out. In display space FLIP of Andersson et al. 2020, in linear
 * space the largest over exposures of Andersson et al. 2021, with the curve of Narkowicz, from the
 * exposure at which the brightest pixel of a to that at which the median one reaches 0.85. Where opacity
 * is compared, the larger of those over black and over white.
 *
 * luminance  of a, as compare_survey_make() makes it; read in linear space only
 * map        (width * height) gets the error of each pixel: [0, 1], 1 where it is invalid, 0 where it does not count;
 *            NULL: not wanted; may be luminance */
facet_result compare_flip_make(const compare_source *s, const facet_compare_desc *desc,
                               const float *luminance, float *map, facet_comparison *out, facet_error *error);

enum { COMPARE_SELECT_MAX = 8 };

/* Nearest-rank percentiles: for each of count shares (0 to 100) the smallest value that at least that share
 * of the values does not exceed. Negative values and NaN are skipped, infinity counts. 0 if there are no
 * values. FACET_ERROR_MEMORY. */
facet_result compare_select(const float *values, size_t value_count, const double *shares, uint32_t count,
                            const facet_allocator *allocator, double *out, facet_error *error);

#endif
