/* chart.h - charts as data: curves and fields that plots make, to be drawn, or written as CSV or JSON.
 * Independent of shading.
 *
 * A chart is a grid of panels. All memory is in an arena; strings are UTF-8. */
#ifndef PLOT_CHART_H
#define PLOT_CHART_H

#include "base/memory.h"
#include "facet/facet.h"

typedef enum chart_scale { CHART_LINEAR, CHART_LOG10 } chart_scale;

typedef struct chart_axis {
    const char *label; /* with its unit: "angle of the light, degrees"; "": none */
    chart_scale scale;
    bool has_range; /* false: that of the data, widened to round numbers */
    double minimum, maximum;
    bool has_zero;   /* the range of the data is widened to 0 */
    bool is_degrees; /* ticks at 15, 30, 45 .. with a degree sign */
} chart_axis;

/* Safe for color blindness, distinguished by dashes as well; or a custom color. */
typedef struct chart_style {
    int color;        /* index into the palette (Okabe and Ito 2008), modulo its length; -1: rgb */
    float rgb[3];     /* sRGB, [0, 1] */
    int dash;         /* 0 solid, 1 dashed, 2 dotted, 3 dash-dotted */
    float width;      /* px; 0: 1.75 */
    bool has_markers; /* a dot at each point */
} chart_style;

typedef struct chart_curve {
    const char *name; /* in the legend and the header of CSV columns; "": in neither */
    size_t count;
    const double *x, *y; /* polar: angle in rad, 0 up, positive to the right; radius. NaN breaks the line */
    chart_style style;
} chart_curve;

/* Values on a regular grid, in false color (viridis) with a color bar. */
typedef struct chart_field {
    uint32_t width, height;
    const double *values;  /* at cell centers, rows from the top; NaN: outside, not drawn */
    double x0, x1, y0, y1; /* the extent of the cells in axis units, x0 < x1; y0 at the bottom, y0 < y1 */
    const char *label;     /* of the bar */
    chart_scale scale;
    double minimum, maximum; /* of the color bar; equal: those of the data */
    bool is_equidistant;     /* CHART_DISC: the radius is the angle from the normal; false: its sine */
} chart_field;

/* A surface in space over a grid of points, seen from an azimuth and elevation, with hidden surfaces removed,
 * colored by value. */
typedef struct chart_surface {
    uint32_t width, height;  /* points */
    const double *x, *y, *z; /* right-handed, z up */
    const double *values;    /* color */
    const char *label;
    double azimuth_rad, elevation_rad;
} chart_surface;

typedef enum chart_panel_kind {
    CHART_XY,
    CHART_POLAR, /* a half disc: angles -90 to 90 degrees */
    CHART_FIELD, /* of field, with axes */
    /* of field, seen from above the hemisphere: rings at 30, 60, 90 degrees, no axes. x and y are those of
     * the direction, so that the horizon is at radius 1; azimuth 0 is at the right */
    CHART_DISC,
    CHART_SURFACE
} chart_panel_kind;

typedef struct chart_panel {
    chart_panel_kind kind;
    const char *title; /* "" none */
    chart_axis x, y;   /* polar: y is the radius */
    size_t curve_count;
    const chart_curve *curves;
    const chart_field *field;
    const chart_surface *surface;
    bool has_legend;
    const char *note; /* small text below the title; "": none */
} chart_panel;

typedef struct chart {
    arena *memory;
    const char *title;
    uint32_t width, height; /* px */
    bool is_dark;
    uint32_t columns;
    uint32_t panel_count;
    const chart_panel *panels; /* row by row */
} chart;

/* Draws a chart as SVG, PDF or PNG; builds without cairo draw SVG. Fails with FACET_ERROR_SYSTEM if cairo is missing. Equal
 * charts give equal bytes. */
facet_result chart_draw(const chart *c, facet_plot_format format, const facet_allocator *allocator,
                        unsigned char **bytes, size_t *size, facet_error *error);
/* Writes the numbers of a chart: a block per panel after a comment line, with a header line and one row
 * per x; curves of a panel share the column of x if it is the same. */
facet_result chart_write_csv(const chart *c, const facet_allocator *allocator, unsigned char **bytes,
                             size_t *size, facet_error *error);
/* Writes the numbers of a chart as JSON, and where its panels are in the drawing (left out where cairo is missing):
 * {"title", "width", "height", "panels": [{"kind": "xy", "title", "note", "plot": [x, y, width, height] in px,
 * "x": {"label", "scale", "degrees", "range": [minimum, maximum]}, "y", "curves": [{"name", "color", "dash", "x": [],
 * "y": []}]}]}; a half disc has "center" and "radius", fields and surfaces have "field" and "surface". NaN is null. */
facet_result chart_write_json(const chart *c, const facet_allocator *allocator, unsigned char **bytes,
                              size_t *size, facet_error *error);

#endif
