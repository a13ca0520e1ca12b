/* chart_space.h - surfaces in space: the orthographic view, the shading, and a z-buffer with several samples per pixel. */
#ifndef PLOT_CHART_SPACE_H
#define PLOT_CHART_SPACE_H

#include "base/memory.h"
#include "plot/chart.h"
#include "plot/chart_trace.h"

/* ---- the view ---- */

/* From the surface's space to the canvas. */
typedef struct space_view {
    double right[3], up[3], toward[3]; /* unit vectors */
    double base_radius;                /* of the disc, a round number */
    double low[2], high[2];            /* of all that is drawn, along right and up */
    double top;                        /* the largest z */
    double x, y, scale;                /* px of the origin; px per unit */
    chart_box box;                     /* of the picture, px */
    double fine;                       /* pixels of the picture per px */
} space_view;

double space_dot(const double a[3], const double b[3]);
/* Point i of the grid; false: it is none. */
bool space_point(const chart_surface *s, size_t i, double p[3]);

/* Directions and extents, nothing in px. */
space_view space_look_at(const chart_surface *s);
/* As large as fits in the middle of plot. */
void space_place(space_view *w, const chart_box *plot);
void space_project(const space_view *w, const double p[3], double *x, double *y);

/* The normals of the grid's points, of any length, into zeros. */
void space_add_normals(const chart_surface *s, double (*normals)[3]);
/* The light on a surface with that normal, [0, 1]: from above the viewer's left shoulder; both sides are lit. */
double space_shade(const space_view *w, const double normal[3]);

/* ---- the z-buffer ---- */

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
