/* compare_map.h - pictures of differences. */
#ifndef COMPARE_COMPARE_MAP_H
#define COMPARE_COMPARE_MAP_H

#include "compare/compare_source.h"

/* The colors of errors from 0 to 1, sRGB-encoded: magma (Smith and van der Walt 2015), from black over purple, red and
 * orange to light yellow, evenly perceived. What lies outside is clamped. */
void compare_magma(float error, float color[3]);

/* The picture that desc asks for; errors (of the crop): those of a heat map, NULL: of none. */
facet_result compare_map_make(const compare_source *s, const facet_compare_desc *desc, uint32_t channel_count,
                              const float *errors, float error_gain, compare_difference *out,
                              facet_error *error);

#endif
