/* plot_build.h - a plot under construction: its materials, panels and curves, and the functions that the
 * kinds share. */
#ifndef PLOT_PLOT_BUILD_H
#define PLOT_PLOT_BUILD_H

#include "base/memory.h"
#include "legacy/fit.h"
#include "plot/chart.h"
#include "plot/material.h"

#define PLOT_PI 3.14159265358979323846
#define PLOT_DEGREE (PLOT_PI / 180.0)

/* A material that is plotted, or the fit of one. */
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

/* A plot under construction. Out of memory sets has_failed: then functions that add return NULL or do
 * nothing, and plot_finish(), whose result the function of a kind returns, reports it. */
typedef struct plot {
    const facet_plot_desc *desc;
    arena *memory;
    chart *out;
    facet_error *error;
    uint32_t angle_count; /* view angles, rad */
    const float *angles;
    uint32_t material_count;
    uint32_t subject_count; /* materials, each followed by its fit if requested */
    const plot_subject *subjects;
    bool has_default_materials, has_default_angles;
    /* requested, or there is an OpenGL 1 material, whose highlight has no cosine to divide by */
    bool has_cosine;
    bool has_channels; /* one material: a curve per channel; else luminance */
    uint32_t panel_count;
    plot_panel *panels; /* has room for PLOT_MAX_PANELS */
    fit_metric *metric; /* of plot_metric() */
    bool has_failed;
    double highest; /* end of a shared scale of all lobes; 0: each has its own */
} plot;

enum { PLOT_MAX_PANELS = FACET_PLOT_MAX_MATERIALS * 2 * (FACET_PLOT_MAX_ANGLES + 1) };

/* ---- memory and text ---- */

void *plot_alloc(plot *p, size_t count, size_t size); /* NULL: has_failed */
double *plot_values(plot *p, size_t count);
/* Formatted text; never NULL (out of memory: "" and has_failed). */
const char *plot_text(plot *p, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* ---- panels ---- */

/* Adds an empty panel; NULL: has_failed. label_x and label_y name the axes with their units. */
plot_panel *plot_add_panel(plot *p, chart_panel_kind kind, const char *title, const char *label_x,
                           const char *label_y);
void plot_set_range(chart_axis *axis, double minimum, double maximum);
/* Adds a curve over x (referenced, not copied) and returns its y to be filled; NULL: has_failed. */
double *plot_add_curve(plot *p, plot_panel *panel, const char *name, chart_style style, size_t count,
                       const double *x);
/* The same with y given; panel NULL is allowed after a failure. */
void plot_add_line(plot *p, plot_panel *panel, const char *name, chart_style style, size_t count,
                   const double *x, const double *y);
/* Adds a field over [-1, 1] in both axes to a panel, its range that of the data; *values are to be filled.
 * NULL: has_failed. */
chart_field *plot_add_field(plot *p, plot_panel *panel, uint32_t width, uint32_t height, chart_scale scale,
                            const char *label, double **values);

/* Fills out: title (unless the desc has one), columns, size (unless the desc has one), panels.
 * FACET_ERROR_MEMORY where something failed. */
facet_result plot_finish(plot *p, const char *title, uint32_t columns, uint32_t width, uint32_t height);

/* ---- styles ---- */

chart_style plot_color(uint32_t number, int dash); /* of the palette */
chart_style plot_channel(int channel, int dash);   /* red, green, blue; 3: gray */
/* The name of a curve of a subject with a remark ("": none); channel -1: all. With a single material its
 * fit is named "fit", and the note describes it, since it has more room: plot_fit_note() is the beginning
 * of the note, "" with several materials. */
const char *plot_curve_name(plot *p, const plot_subject *subject, const char *remark, int channel);
const char *plot_fit_note(plot *p);
/* The style of a material or of its fit, which is dashed and has a color of its own; channel as above. */
chart_style plot_subject_style(const plot *p, const plot_subject *subject, int channel);
chart_style plot_faint(int dash);      /* a thin gray line, for directions and limits */
chart_scale plot_scale(const plot *p); /* of the values, by desc->is_logarithmic */

/* ---- numbers ---- */

/* count values from first to last in even steps. */
double *plot_steps(plot *p, size_t count, double first, double last);
/* Unit direction at an angle from +Z in the plane rotated by azimuth from +X. */
void plot_direction(double angle_rad, double azimuth_rad, float out[3]);
/* Light angles in the plane of incidence, rad, positive towards the eye: even steps, and more around the
 * highlight of each subject for that view. The ends are 0.1 degrees above the horizon. */
double *plot_light_angles(plot *p, double view_rad, size_t *count);
/* BRDF (times the cosine if has_cosine) of a material for one view and the light angles in the plane of
 * incidence: count values per channel. NULL: has_failed. */
double (*plot_slice(plot *p, const material *m, double view_rad, size_t count, const double *angles,
                    bool has_cosine))[3];
/* A view angle as text in degrees: "30". */
const char *plot_degrees(plot *p, double rad);

/* ---- fits ---- */

/* The metric of errors, made once per plot. NULL: has_failed. */
const fit_metric *plot_metric(plot *p);
/* The mode of PBR materials: conversions are fitted to glTF's own BRDF, which plots with them show. */
facet_energy plot_energy(const facet_plot_desc *desc);

/* A material converted to the other model. */
typedef struct plot_conversion {
    material material; /* with a label */
    const char *what;  /* its description */
    bool has_error;    /* false: measured BRDFs, layers, .. */
    fit_error error;
    double rms; /* measured BRDFs: of material_fit() */
} plot_conversion;
/* PBR to OpenGL 1, OpenGL 1 to PBR (specular and ior), measured to model `to`; by fitting (is_fit) or in
 * closed form. Fails with FACET_ERROR_MEMORY. */
facet_result plot_convert(plot *p, const material *source, facet_plot_model to, bool is_fit,
                          plot_conversion *out);

/* Fills desc->fits[number], if there are fits. */
void plot_report_fit(const plot *p, uint32_t number, const material *source, const plot_conversion *fit);

/* ---- kinds ---- */

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
