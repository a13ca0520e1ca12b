/* compare_errors.h - what is found by looking at one pixel after the other: what the pictures are, and how far apart. */
#ifndef COMPARE_COMPARE_ERRORS_H
#define COMPARE_COMPARE_ERRORS_H

#include "compare/compare_source.h"

/* What has to be known before errors can be measured. */
typedef struct compare_survey {
    bool is_equal;    /* all bits of the pixels that count */
    bool has_opacity; /* some pixel that counts is not opaque */
    uint64_t pixel_count, nonfinite_a, nonfinite_b, invalid_count;
    float largest; /* channel of a, linear, at least 0 */
} compare_survey;

/* luminance (NULL: not wanted; width * height): of a, linear and not below 0, -1 where a pixel does not count. */
facet_result compare_survey_make(const compare_source *s, const facet_compare_desc *desc, float *luminance,
                                 compare_survey *out, facet_error *error);

/* Fills mse to differing_share of out, except percentiles, from pixel_count and channel_count, which are there. errors (width
 * * height): the largest |b - a| of each pixel's channels; infinity where it is invalid, -1 where it does not count. */
facet_result compare_errors_make(const compare_source *s, const facet_compare_desc *desc, float *errors,
                                 facet_comparison *out, facet_error *error);

#endif
