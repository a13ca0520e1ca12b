/* visibility.h - camera visibility: the surfaces that the rays of an image hit. */
#ifndef CPU_VISIBILITY_H
#define CPU_VISIBILITY_H

#include "cpu/ray_scene.h"

/* Side of the squares of pixels whose rays are traced together, aligned to multiples of itself in the whole
 * image: a crop traces the same packets. */
enum { VISIBILITY_BLOCK = 4, VISIBILITY_BLOCK_PIXELS = VISIBILITY_BLOCK * VISIBILITY_BLOCK };

/* Sample positions of a block. */
typedef struct visibility_pattern {
    uint32_t sample_count;
    float *points;              /* 2 per sample, in pixels from the pixel's top left; block of mem_alloc() */
    float middle[2];            /* mean of points */
    float *offset_x, *offset_y; /* per ray of a block, in pixels from the block's top left */
} visibility_pattern;

/* The pattern of sample_pattern(). False: no memory. */
bool visibility_pattern_create(const facet_allocator *allocator, uint32_t sample_count,
                               visibility_pattern *out);
void visibility_pattern_destroy(visibility_pattern *pattern); /* {0} is allowed */

/* Traces the rays of the block whose top left pixel is (x, y) of the whole image, VISIBILITY_BLOCK_PIXELS *
 * sample_count hits. The other members of a hit of VISIBILITY_NONE are undefined. */
void visibility_trace_block(const ray_scene *scene, const camera_rays *camera, uint32_t x, uint32_t y,
                            const visibility_pattern *pattern, visibility_hit *hits);
/* Index of the first of the sample_count hits of a pixel of the block, pixels counted in rows. They are
 * traced in squares of 2 x 2: bits 1 and 2 of the index are swapped. */
static inline size_t visibility_first_hit(const visibility_pattern *pattern, uint32_t pixel)
{
    return (size_t)((pixel & 9) | (pixel & 2) << 1 | (pixel & 4) >> 1) * pattern->sample_count;
}

#endif
