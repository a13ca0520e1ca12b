/* chart_space.h - surfaces in space: the orthographic view, the shading, and a z-buffer with several
 * samples per pixel. */
#ifndef PLOT_CHART_SPACE_H
#define PLOT_CHART_SPACE_H

#include "base/memory.h"
#include "plot/chart.h"
#include "plot/chart_trace.h"

/* ---- the view ---- */

/* Transform from object space to the canvas. */
typedef struct space_view {
    double right[3], up[3], toward[3]; /* unit vectors */
    double base_radius;                /* of the disc, rounded */
    double low[2], high[2];            /* extent of everything drawn, along right and up */
    double top;                        /* the largest z */
    double x, y, scale;                /* px of the origin; px per unit */
    chart_box box;                     /* of the image, px */
    double fine;                       /* pixels of the image per px */
} space_view;

double space_dot(const double a[3], const double b[3]);
/* Point i of the grid; false: it is not finite. */
bool space_point(const chart_surface *s, size_t i, double p[3]);

/* Directions and extents, without pixels. */
space_view space_look_at(const chart_surface *s);
/* Scales and centers the view in plot. */
void space_place(space_view *w, const chart_box *plot);
void space_project(const space_view *w, const double p[3], double *x, double *y);

/* Adds normals of the points, not normalized, to zeros. */
void space_add_normals(const chart_surface *s, double (*normals)[3]);
/* Shading of a normal, [0, 1]: two-sided light from above the left shoulder of the viewer. */
double space_shade(const space_view *w, const double normal[3]);

/* ---- the z-buffer ---- */

/* A projected point of the grid. */
typedef struct solid_vertex {
    float x, y;  /* pixels of the image, y down; NaN: a hole in the surface */
    float depth; /* towards the viewer */
    float value; /* position in the colors, [0, 1] */
    float shade; /* shading, [0, 1] */
} solid_vertex;

typedef struct solid {
    uint32_t width, height;
    uint32_t *pixels; /* premultiplied 0xAARRGGBB; mem_alloc() */
    float *depth;     /* of the nearest point in each pixel; -infinity: none; mem_alloc() */
} solid;

/* Renders rows * columns vertices into an image of that size; colors: 256 of 0xffRRGGBB. FACET_ERROR_MEMORY. */
facet_result solid_create(const facet_allocator *allocator, uint32_t width, uint32_t height,
                          const solid_vertex *vertices, uint32_t columns, uint32_t rows,
                          const uint32_t colors[256], solid *out, facet_error *error);
void solid_destroy(solid *s); /* {0} is allowed; leaves {0} */

/* Depth at pixel coordinates; -infinity outside and where nothing is drawn. */
float solid_depth_at(const solid *s, double x, double y);

#endif
