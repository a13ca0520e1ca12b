/* plot_build.h - what the files of the kinds of plots share: the plot that is being made, its materials, panels and
 * curves. */
#ifndef PLOT_PLOT_BUILD_H
#define PLOT_PLOT_BUILD_H

#include "base/memory.h"
#include "legacy/fit.h"
#include "plot/chart.h"
#include "plot/material.h"

#define PLOT_PI 3.14159265358979323846
#define PLOT_DEGREE (PLOT_PI / 180.0)

/* A material as one kind of curves, or the fit of one beside it. */
typedef struct plot_subject {
    material material;
    uint32_t number; /* of the material in the desc */
    bool is_fit;
} plot_subject;

/* A panel that curves are added to. */
typedef struct plot_panel {
    chart_panel panel;
    chart_curve *curves;
    size_t capacity;
} plot_panel;

/* A plot in the making. Memory that is not there sets has_failed: adding then gives NULL or nothing, and the kind's
 * function returns plot_finish(), which says so. */
typedef struct plot {
    const facet_plot_desc *desc;
    arena *memory;
    chart *out;
    facet_error *error;
    uint32_t angle_count; /* of the view, rad */
    const float *angles;
    uint32_t material_count;
    uint32_t subject_count; /* materials and, where asked for, their fits behind each */
    const plot_subject *subjects;
    bool has_default_materials, has_default_angles;
    /* asked for, or an OpenGL 1 material is there: its highlight has no cosine to divide out */
    bool has_cosine;
    bool has_channels; /* one material, so that there may be a curve per channel; else luminance */
    uint32_t panel_count;
    plot_panel *panels; /* has room for PLOT_MAX_PANELS */
    fit_metric *metric; /* of plot_metric() */
    bool has_failed;
    double highest; /* of a scale that all lobes share; 0: each has its own */
} plot;

enum { PLOT_MAX_PANELS = FACET_PLOT_MAX_MATERIALS * 2 * (FACET_PLOT_MAX_ANGLES + 1) };

/* ---- memory and text ---- */

void *plot_alloc(plot *p, size_t count, size_t size); /* NULL: has_failed */
double *plot_numbers(plot *p, size_t count);
/* Formatted text; never NULL ("" and has_failed where there is no memory). */
const char *plot_text(plot *p, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* ---- panels ---- */

/* A panel, empty; NULL: has_failed. label_x and label_y name axes with their units. */
plot_panel *plot_add_panel(plot *p, chart_panel_kind kind, const char *title, const char *label_x,
                           const char *label_y);
void plot_set_range(chart_axis *axis, double minimum, double maximum);
/* Adds a curve over x (kept, not copied) and returns its y to be filled; NULL: has_failed. */
double *plot_add_curve(plot *p, plot_panel *panel, const char *name, chart_style style, size_t count,
                       const double *x);
/* The same with y given; panel NULL is allowed after a failure. */
void plot_add_line(plot *p, plot_panel *panel, const char *name, chart_style style, size_t count,
                   const double *x, const double *y);
/* Gives a panel a field over [-1, 1] in both axes, its range that of the data; *values are to be filled. NULL:
 * has_failed. */
chart_field *plot_add_field(plot *p, plot_panel *panel, uint32_t width, uint32_t height, chart_scale scale,
                            const char *label, double **values);

/* Fills out: title (unless the desc has one), columns, size (unless the desc has one), panels. FACET_ERROR_MEMORY where
 * something failed. */
facet_result plot_finish(plot *p, const char *title, uint32_t columns, uint32_t width, uint32_t height);

/* ---- styles ---- */

chart_style plot_color(uint32_t number, int dash); /* of the palette */
chart_style plot_channel(int channel, int dash);   /* red, green, blue; 3: gray */
/* The name of a curve of a subject with what is to be said of the subject (""); channel -1: of all. Where there is one material, its fit is "fit", and what it is stands in
 * the note, which has room for it: plot_fit_note() is that, to be put before the rest; "" where there are several. */
const char *plot_curve_name(plot *p, const plot_subject *subject, const char *remark, int channel);
const char *plot_fit_note(plot *p);
/* Of a material, or its fit, which is dashed and has a color of its own; channel as above, -1: of all. */
chart_style plot_subject_style(const plot *p, const plot_subject *subject, int channel);
chart_style plot_faint(int dash);      /* a thin gray line: directions, limits */
chart_scale plot_scale(const plot *p); /* of values: as desc->is_logarithmic says */

/* ---- numbers ---- */

/* count values from first to last in even steps. */
double *plot_steps(plot *p, size_t count, double first, double last);
/* Unit direction at an angle from +Z, the plane turned by azimuth from +X. */
void plot_direction(double angle_rad, double azimuth_rad, float out[3]);
/* Angles of the light in the plane of incidence, rad, positive towards the eye: even steps and, for each subject, more
 * where its highlight for that view is. *count of them; the ends are 0.1 degrees above the horizon. */
double *plot_light_angles(plot *p, double view_rad, size_t *count);
/* BRDF (times the cosine where asked for) of a material for one view and the lights of angles in the plane of incidence:
 * count values per channel. NULL: has_failed. */
double (*plot_slice(plot *p, const material *m, double view_rad, size_t count, const double *angles,
                    bool has_cosine))[3];
/* The view's angle as degrees in words: "30". */
const char *plot_degrees(plot *p, double rad);

/* ---- fits ---- */

/* The directions that errors are found with; one per plot. NULL: has_failed. */
const fit_metric *plot_metric(plot *p);

/* A material in the other model. */
typedef struct plot_conversion {
    material material; /* its label says what it is */
    const char *what;  /* its description alone */
    bool has_error;    /* false: of a measured BRDF, with layers, .. */
    fit_error error;
    double rms; /* measured: of material_fit() */
} plot_conversion;
/* PBR to OpenGL 1, OpenGL 1 to PBR (specular and ior), measured to model `to`. By search (is_fit) or closed form.
 * Fails with FACET_ERROR_MEMORY. */
facet_result plot_convert(plot *p, const material *source, facet_plot_model to, bool is_fit,
                          plot_conversion *out);

/* Fills the desc's fit of material number, if it is wanted; source is the material. */
void plot_report_fit(const plot *p, uint32_t number, const material *source, const plot_conversion *fit);

/* ---- kinds: a file each ---- */

facet_result plot_make_legacy(plot *p);
facet_result plot_make_slices(plot *p);     /* BRDF, SLICE */
facet_result plot_make_hemisphere(plot *p); /* HEMISPHERE, LOBE */
facet_result plot_make_terms(plot *p);
facet_result plot_make_albedo(plot *p);
facet_result plot_make_furnace(plot *p);
facet_result plot_make_dfg(plot *p);
facet_result plot_make_tone(plot *p);
facet_result plot_make_fresnel(plot *p);
facet_result plot_make_error(plot *p);

#endif
