/* compare_flip.h - FLIP: the difference that an eye sees when it looks from one picture to the other and back. */
#ifndef COMPARE_COMPARE_FLIP_H
#define COMPARE_COMPARE_FLIP_H

#include "compare/compare_source.h"

/* Fills flip to flip_exposure_count of out. In display space FLIP of Andersson et al. 2020, in linear space the largest over
 * exposures of Andersson et al. 2021, with the curve of Narkowicz, from the exposure at which the brightest pixel of a to
 * that at which the median one reaches 0.85. Where opacity is compared, the larger of those over black and over white.
 *
 * luminance  of a, as compare_survey_make() makes it; read in linear space only
 * map        (width * height) gets the error of each pixel: [0, 1], 1 where it is invalid, 0 where it does not count;
 *            NULL: not wanted; may be luminance */
facet_result compare_flip_make(const compare_source *s, const facet_compare_desc *desc,
                               const float *luminance, float *map, facet_comparison *out, facet_error *error);

#endif
