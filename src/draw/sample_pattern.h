/* sample_pattern.h - where in a pixel visibility is sampled. */
#ifndef DRAW_SAMPLE_PATTERN_H
#define DRAW_SAMPLE_PATTERN_H

#include <stdint.h>

/* Writes count points in (0, 1)^2, x and y interleaved; the same in every pixel. Each of count columns and each of
 * count rows holds one point, so that edges near the axes show count + 1 shades; 1: the middle. */
void sample_pattern(uint32_t count, float *points);

#endif
