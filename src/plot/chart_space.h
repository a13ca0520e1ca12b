/* chart_space.h - a surface in space as it is seen, without perspective, and how light falls on it. */
#ifndef PLOT_CHART_SPACE_H
#define PLOT_CHART_SPACE_H

#include "plot/chart.h"
#include "plot/chart_trace.h"

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

#endif
