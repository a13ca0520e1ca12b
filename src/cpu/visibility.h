/* visibility.h - which surfaces the rays of a picture meet. */
#ifndef CPU_VISIBILITY_H
#define CPU_VISIBILITY_H

#include "cpu/embree_scene.h"

/* Side of the squares of pixels whose rays are traced together, aligned to multiples of itself in the whole
 * picture: a crop traces the same packets. */
enum { VISIBILITY_BLOCK = 4, VISIBILITY_BLOCK_PIXELS = VISIBILITY_BLOCK * VISIBILITY_BLOCK };

#define VISIBILITY_NONE RTC_INVALID_GEOMETRY_ID

/* The nearest hit of one ray. */
typedef struct visibility_hit {
    float t;           /* of the ray */
    float u, v;        /* weights of the triangle's second and third vertex; along a line: u */
    uint32_t geometry; /* VISIBILITY_NONE: nothing was hit */
    uint32_t primitive;
    float normal[3]; /* geometric, of any length, outward for counter-clockwise triangles */
} visibility_hit;

/* Where the rays of a block go through the picture. */
typedef struct visibility_pattern {
    uint32_t sample_count;
    const float *points; /* 2 per sample, in pixels from the pixel's top left */
} visibility_pattern;

/* Traces the rays of the block whose top left pixel is (x, y) of the whole picture: hits is
 * hits[pixel * sample_count + sample], pixels of the block in rows. */
void visibility_trace_block(const embree_scene *scene, const camera_rays *camera, uint32_t x, uint32_t y,
                            const visibility_pattern *pattern, visibility_hit *hits);

#endif
