/* compare_ssim.h - structural similarity. */
#ifndef COMPARE_COMPARE_SSIM_H
#define COMPARE_COMPARE_SSIM_H

#include "compare/compare_source.h"

/* Fills ssim and ssim_channels of out by its channel_count and peak: the mean over all windows of 11 x 11 pixels, weighted
 * by a Gaussian of 1.5 pixels, that lie in the picture and whose middle counts, of
 *   ((2 ma mb + C1) (2 sab + C2)) / ((ma^2 + mb^2 + C1) (sa^2 + sb^2 + C2)),  C1 = (0.01 peak)^2, C2 = (0.03 peak)^2
 * Wang, Bovik, Sheikh, Simoncelli 2004, equation 13; without the reduction of large pictures that came later. NAN where
 * there is no such window. Fails with FACET_ERROR_MEMORY. */
facet_result compare_ssim_make(const compare_source *s, const facet_compare_desc *desc, facet_comparison *out,
                               facet_error *error);

#endif
