/* chart_solid.h - a surface in space as a picture: triangles in a z-buffer, several samples to a pixel. */
#ifndef PLOT_CHART_SOLID_H
#define PLOT_CHART_SOLID_H

#include "base/memory.h"
#include "facet/facet.h"

/* A corner of the grid as it is seen. */
typedef struct solid_vertex {
    float x, y;  /* pixels of the picture, y down; NaN: the surface has a hole here */
    float depth; /* towards the viewer */
    float value; /* of the color, [0, 1] */
    float shade; /* how much light falls on it, [0, 1] */
} solid_vertex;

typedef struct solid {
    uint32_t width, height;
    uint32_t *pixels; /* premultiplied 0xAARRGGBB; mem_alloc() */
    float *depth;     /* of the nearest point in each pixel; -infinity: none; mem_alloc() */
} solid;

/* A picture of that size of rows * columns vertices; colors: 256 of 0xffRRGGBB. FACET_ERROR_MEMORY. */
facet_result solid_create(const facet_allocator *allocator, uint32_t width, uint32_t height,
                          const solid_vertex *vertices, uint32_t columns, uint32_t rows,
                          const uint32_t colors[256], solid *out, facet_error *error);
void solid_destroy(solid *s); /* {0} is allowed; leaves {0} */

/* Depth at a place in pixels; -infinity outside and where nothing is. */
float solid_depth_at(const solid *s, double x, double y);

#endif
