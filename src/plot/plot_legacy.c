/* plot_legacy.c - PBR and OpenGL 1 over the light angle: Murdoch's vignette "Shininess in OpenGL 1 versus
 * glTF PBR" extended by the factor pi, the fit and the difference; the same for any material and its
 * conversion; and the errors of all methods (legacy/fit.h) over roughness or shininess. Radiance under
 * light of OpenGL 1 intensity 1: PBR times pi. */
#include <math.h>

#include "base/parallel.h"
#include "base/result.h"
#include "plot/plot_build.h"
#include "plot/plot_vignette.h"

/* ---- errors over roughness or shininess ---- */

enum { METHODS = 5 };

static const char *const names_to_ogl1[METHODS] = {
    "usual formula", "closed form", "fit", "fit, colors above 1", "fit for displays, error on a display"};
static const char *const names_to_pbr[METHODS] = {"usual formula", "closed form, core glTF", "fit, core glTF",
                                                  "closed form, specular and ior", "fit, specular and ior"};

typedef struct error_work {
    const fit_metric *metric;
    const facet_plot_material *material;
    const double *x;
    double *errors; /* per method, point_count */
    uint32_t point_count;
} error_work;

static void to_ogl1(const error_work *work, uint32_t point)
{
    pbr_surface pbr = material_pbr_surface(work->material);
    pbr.perceptual_roughness = (float)work->x[point];
    for (uint32_t k = 0; k < METHODS; k++) {
        ogl1_surface s;
        if (k == 0)
            pbr_to_ogl1_naive(&pbr, &s);
        else if (k == 1)
            pbr_to_ogl1_closed(&pbr, &s);
        else
            pbr_to_ogl1_fit(work->metric, &pbr,
                            k == 4 ? FACET_LEGACY_TARGET_DISPLAY : FACET_LEGACY_TARGET_LINEAR,
                            k == 3 ? FIT_UNLIMITED : FIT_DISPLAYABLE, &s);
        fit_error e = fit_compare(work->metric, &s, &pbr, FIT_FROM_PBR);
        work->errors[k * work->point_count + point] = k == 4 ? e.E_display : e.E;
    }
}

static void to_pbr(const error_work *work, uint32_t point)
{
    ogl1_surface ogl1 = material_ogl1_surface(work->material);
    ogl1.shininess = (float)work->x[point];
    for (uint32_t k = 0; k < METHODS; k++) {
        pbr_surface s;
        if (k == 0)
            ogl1_to_pbr_naive(&ogl1, &s);
        else if (k == 1)
            ogl1_to_pbr_core_closed(&ogl1, &s);
        else if (k == 2)
            ogl1_to_pbr_core_fit(work->metric, &ogl1, FACET_LEGACY_TARGET_LINEAR, &s);
        else if (k == 3)
            ogl1_to_pbr_closed(&ogl1, &s);
        else
            ogl1_to_pbr_fit(work->metric, &ogl1, FACET_LEGACY_TARGET_LINEAR, &s);
        work->errors[k * work->point_count + point] = fit_compare(work->metric, &ogl1, &s, FIT_FROM_OGL1).E;
    }
}

static void convert_points(void *context, size_t begin, size_t end)
{
    const error_work *work = context;
    for (size_t i = begin; i < end; i++)
        if (work->material->model == FACET_PLOT_MODEL_PBR)
            to_ogl1(work, (uint32_t)i);
        else
            to_pbr(work, (uint32_t)i);
}

/* Adds the panel of errors of all methods over roughness (PBR) or shininess (OpenGL 1) of a material whose
 * other parameters stay; point_count points. */
static plot_panel *add_errors(plot *p, const facet_plot_material *m, const char *title, uint32_t point_count)
{
    bool is_pbr = m->model == FACET_PLOT_MODEL_PBR;
    double *x = plot_values(p, point_count);
    error_work work = {.metric = plot_metric(p),
                       .material = m,
                       .x = x,
                       .errors = plot_values(p, (size_t)METHODS * point_count),
                       .point_count = point_count};
    plot_panel *panel =
        plot_add_panel(p, CHART_XY, title, is_pbr ? "perceptual roughness" : "shininess", "relative error E");
    if (p->has_failed || !panel)
        return NULL;
    for (uint32_t i = 0; i < point_count; i++) {
        double share = (double)i / (point_count - 1);
        x[i] = is_pbr ? 0.1 + 0.9 * share : pow(10.0, 3.0 * share); /* 1 to 1000 */
    }
    parallel_for(p->desc->thread_count, point_count, 1, convert_points, &work);
    for (uint32_t k = 0; k < METHODS; k++) {
        chart_style style = plot_color(k, (int)(k % 4));
        style.has_markers = true;
        plot_add_line(p, panel, is_pbr ? names_to_ogl1[k] : names_to_pbr[k], style, point_count, x,
                      work.errors + (size_t)k * point_count);
    }
    panel->panel.x.scale = is_pbr ? CHART_LINEAR : CHART_LOG10;
    panel->panel.y.scale = plot_scale(p);
    panel->panel.note = is_pbr ? "PBR to OpenGL 1" : "OpenGL 1 to PBR";
    return panel;
}

facet_result plot_make_error(plot *p)
{
    enum { POINTS_PBR = 19, POINTS_OGL1 = 16 };
    uint32_t count = 0;
    if (p->has_default_materials) {
        static const struct {
            facet_plot_model model;
            const char *title;
            float metallic, diffuse, specular; /* PBR: diffuse is the base color */
        } defaults[4] = {{FACET_PLOT_MODEL_PBR, "gray dielectric", 0.0f, 0.5f, 0.0f},
                         {FACET_PLOT_MODEL_PBR, "white metal", 1.0f, 1.0f, 0.0f},
                         {FACET_PLOT_MODEL_OGL1, "OpenGL 1: diffuse 0.5, specular 0.5", 0.0f, 0.5f, 0.5f},
                         {FACET_PLOT_MODEL_OGL1, "OpenGL 1: diffuse 0.5, specular 1", 0.0f, 0.5f, 1.0f}};
        for (count = 0; count < 4; count++) {
            facet_plot_material m = material_default();
            m.model = defaults[count].model;
            m.metallic = defaults[count].metallic;
            for (int c = 0; c < 3; c++) {
                m.base_color[c] = m.diffuse[c] = defaults[count].diffuse;
                m.ogl1_specular[c] = defaults[count].specular;
            }
            add_errors(p, &m, defaults[count].title,
                       m.model == FACET_PLOT_MODEL_PBR ? POINTS_PBR : POINTS_OGL1);
        }
    }
    for (uint32_t k = 0; !p->has_default_materials && k < p->subject_count; k++, count++) {
        const material *m = &p->subjects[k].material;
        add_errors(p, &m->parameters, m->label,
                   m->parameters.model == FACET_PLOT_MODEL_PBR ? POINTS_PBR : POINTS_OGL1);
    }
    uint32_t columns = count < 2 ? 1 : count < 5 ? 2 : 3;
    uint32_t rows = count ? (count + columns - 1) / columns : 1;
    return plot_finish(p, "Error of conversions between OpenGL 1 and PBR", columns,
                       columns == 1 ? 960 : 580 * columns, columns == 1 ? 640 : 430 * rows + 60);
}

/* ---- the vignette and its extension ---- */

static const char *const channels[3] = {"red", "green", "blue"};

/* ---- the vignette ---- */

/* The vignette's parameters: roughness 1, metallic 1, all white; rgl's defaults. */
#define ROUGHNESS 1.0
#define METALLIC 1.0
#define SHININESS 50.0

typedef struct experiment {
    double theta;
    double phi[VIGNETTE_POINTS], pbr[VIGNETTE_POINTS], pbr_pi[VIGNETTE_POINTS], ogl1[VIGNETTE_POINTS];
    double fit[VIGNETTE_POINTS], difference[VIGNETTE_POINTS];
    vignette_parameters fitted;
} experiment;

static const experiment *run_experiment(plot *p)
{
    experiment *e = plot_alloc(p, 1, sizeof *e);
    if (!e)
        return NULL;
    e->theta = p->has_default_angles ? 30.0 * PLOT_DEGREE : (double)p->angles[0];
    for (int i = 0; i < VIGNETTE_POINTS; i++) {
        e->phi[i] = vignette_phi(i);
        e->pbr[i] = vignette_pbr(e->theta, e->phi[i], ROUGHNESS, METALLIC, 1.0, p->desc->has_heaviside_ramp);
        e->pbr_pi[i] = PLOT_PI * e->pbr[i];
        e->ogl1[i] = vignette_ogl1(e->theta, e->phi[i], SHININESS, 1.0, 1.0);
    }
    e->fitted = vignette_fit(e->theta, e->pbr_pi);
    for (int i = 0; i < VIGNETTE_POINTS; i++) {
        e->fit[i] =
            vignette_ogl1(e->theta, e->phi[i], e->fitted.shininess, e->fitted.diffuse, e->fitted.specular);
        e->difference[i] = e->fit[i] - e->pbr_pi[i];
    }
    return e;
}

/* An axis in R's style: the range of the data widened by 4 % at both ends. */
static void set_range_as_R(chart_axis *axis, const double *values)
{
    double low = values[0], high = values[0];
    for (int i = 1; i < VIGNETTE_POINTS; i++) {
        low = fmin(low, values[i]);
        high = fmax(high, values[i]);
    }
    plot_set_range(axis, low - 0.04 * (high - low), high + 0.04 * (high - low));
}

/* Three coincident curves, blue on top, as in the vignette. */
static void add_vignette_panel(plot *p, const experiment *e, const double *y, const char *title,
                               const char *label, const char *note)
{
    plot_panel *panel = plot_add_panel(p, CHART_XY, title, "phi", label);
    for (int c = 0; c < 3; c++)
        plot_add_line(p, panel, channels[c], plot_channel(c, 0), VIGNETTE_POINTS, e->phi, y);
    if (!panel)
        return;
    set_range_as_R(&panel->panel.x, e->phi);
    set_range_as_R(&panel->panel.y, y);
    panel->panel.note = note;
}

static void add_vignette_fit(plot *p, const experiment *e)
{
    plot_panel *panel =
        plot_add_panel(p, CHART_XY, "OpenGL 1 fitted to the 33 points", "phi", "radiance, light of 1");
    chart_style points = plot_color(1, 1);
    points.has_markers = true;
    plot_add_line(p, panel, "PBR times pi", plot_color(0, 0), VIGNETTE_POINTS, e->phi, e->pbr_pi);
    plot_add_line(p, panel, "OpenGL 1, fitted", points, VIGNETTE_POINTS, e->phi, e->fit);
    if (panel)
        panel->panel.note =
            plot_text(p, "relative RMS %.3f: shininess %.2f, diffuse %.3f, specular %.3f", e->fitted.error,
                      e->fitted.shininess, e->fitted.diffuse, e->fitted.specular);
}

/* ---- sources and their conversions ---- */

/* A material and its conversion at one view angle. */
typedef struct pair {
    size_t count;
    const double *phi;
    double (*source)[3], (*converted)[3];
    bool is_colored;
} pair;

static pair make_pair(plot *p, const material *source, const material *converted, double view)
{
    pair r = {0};
    r.phi = plot_light_angles(p, view, &r.count);
    r.source = plot_slice(p, source, view, r.count, r.phi, true);
    r.converted = plot_slice(p, converted, view, r.count, r.phi, true);
    for (size_t i = 0; r.source && r.converted && i < r.count; i++) {
        const double *f = r.source[i];
        r.is_colored = r.is_colored || fabs(f[1] - f[0]) + fabs(f[2] - f[0]) > 1e-5;
        for (int c = 0; c < 3; c++) {
            r.source[i][c] *= PLOT_PI;
            r.converted[i][c] *= PLOT_PI;
        }
    }
    return r;
}

/* One curve, or one per channel where they differ, of the source, the conversion, or their difference. */
static void add_pair_curves(plot *p, plot_panel *panel, const pair *r, int what, const char *name,
                            uint32_t color, int dash)
{
    for (int c = 0; r->source && r->converted && c < (r->is_colored ? 3 : 1); c++) {
        double *y =
            plot_add_curve(p, panel, r->is_colored ? plot_text(p, "%s, %s", name, channels[c]) : name,
                           r->is_colored ? plot_channel(c, dash) : plot_color(color, dash), r->count, r->phi);
        for (size_t i = 0; y && i < r->count; i++) {
            double source = r->source[i][c], converted = r->converted[i][c];
            y[i] = what == 0 ? source : what == 1 ? converted : converted - source;
        }
    }
}

static const char *describe_error(plot *p, const material *source, const plot_conversion *conversion,
                                  bool has_dashes)
{
    if (!conversion->has_error)
        return plot_text(p, "RMS of log(1 + f cos) %.3f of the measured", conversion->rms);
    bool has_layers =
        source->parameters.model == FACET_PLOT_MODEL_PBR && material_has_layers(&source->parameters);
    return plot_text(
        p, "relative error E %.3f, on a display %.3f%s%s", conversion->error.E, conversion->error.E_display,
        has_dashes ? "; views in order: solid, dashed, dotted" : "",
        has_layers ? "; of the base: clearcoat, sheen, thin film and anisotropy have no counterpart" : "");
}

static const char *scaled(const material *m)
{
    return m->parameters.model == FACET_PLOT_MODEL_PBR ? "PBR times pi"
           : m->measured                               ? "measured times pi"
                                                       : "OpenGL 1";
}

static void add_pair(plot *p, const material *source, const plot_conversion *conversion, double view,
                     const char *title)
{
    pair r = make_pair(p, source, &conversion->material, view);
    plot_panel *panel = plot_add_panel(p, CHART_XY, title, "phi, rad", "radiance, light of 1");
    add_pair_curves(p, panel, &r, 0, scaled(source), 0, 0);
    add_pair_curves(p, panel, &r, 1, scaled(&conversion->material), 1, 1);
    if (!panel)
        return;
    panel->panel.y.scale = plot_scale(p);
    panel->panel.has_legend = !r.is_colored; /* color and dash already say it */
    panel->panel.note = conversion->material.label;
    for (int i = 0; conversion->has_error && i < 3; i++) /* the views of the metric */
        if (fabs(view - 30.0 * i * PLOT_DEGREE) < 1e-4)
            panel->panel.note = plot_text(p, "E %.3f here; dashed, %s", conversion->error.views[i],
                                          conversion->material.label);
}

/* Conversion minus source for all views in one panel. */
static plot_panel *add_differences(plot *p, const material *source, const plot_conversion *conversion,
                                   const char *title)
{
    plot_panel *panel = plot_add_panel(p, CHART_XY, title, "phi, rad", "conversion less source");
    bool is_colored = false;
    for (uint32_t a = 0; a < p->angle_count; a++) {
        double view = (double)p->angles[a];
        pair r = make_pair(p, source, &conversion->material, view);
        add_pair_curves(p, panel, &r, 2, plot_text(p, "view at %s\u00b0", plot_degrees(p, view)), a,
                        (int)(a % 4));
        is_colored = is_colored || r.is_colored;
    }
    if (panel) {
        panel->panel.has_legend = !is_colored;
        panel->panel.note = describe_error(p, source, conversion, is_colored);
    }
    return panel;
}

/* ---- the two layouts ---- */

static void add_polar(plot *p, const experiment *e, const material *source, const plot_conversion *conversion)
{
    pair r = make_pair(p, source, &conversion->material, e->theta);
    plot_panel *panel =
        plot_add_panel(p, CHART_POLAR, plot_text(p, "View at %s\u00b0, polar", plot_degrees(p, e->theta)), "",
                       "radiance, light of 1");
    add_pair_curves(p, panel, &r, 0, "PBR times pi", 0, 0);
    add_pair_curves(p, panel, &r, 1, "OpenGL 1, fitted", 1, 1);
    double *ray = plot_values(p, 2), *radius = plot_values(p, 2);
    if (!ray || !radius || !r.source)
        return;
    double highest = 0.0;
    for (size_t i = 0; i < r.count; i++)
        highest = fmax(highest, fmax(r.source[i][0], r.converted[i][0]));
    ray[0] = ray[1] = e->theta;
    radius[1] = ceil(highest * 20.0) / 20.0;
    plot_set_range(&panel->panel.y, 0.0, radius[1]);
    plot_add_line(p, panel, "", plot_faint(2), 2, ray, radius);
    panel->panel.note = "angle: of the light; dotted: the view";
}

static facet_result make_vignette(plot *p)
{
    const experiment *e = run_experiment(p);
    if (!e)
        return plot_finish(p, "", 1, 0, 0);
    facet_plot_material white = material_default();
    white.metallic = (float)METALLIC;
    white.perceptual_roughness = (float)ROUGHNESS;
    material source = {.parameters = white,
                       .label = "the vignette's PBR",
                       .energy = plot_energy(p->desc),
                       .has_separable_smith = true};
    plot_conversion conversion;
    TRY(plot_convert(p, &source, FACET_PLOT_MODEL_OGL1, true, &conversion));

    const char *eye = plot_degrees(p, e->theta);
    add_vignette_panel(p, e, e->pbr, "the vignette's PBR", "PBR",
                       plot_text(p, "theta %s degrees, roughness 1, metalness 1, white%s", eye,
                                 p->desc->has_heaviside_ramp ? "; chi(x) = max(x, 0)" : ""));
    add_vignette_panel(p, e, e->ogl1, "the vignette's OpenGL 1", "OGL1[, 1]",
                       plot_text(p, "shininess 50, white; %.1f times the PBR's RMS away from it",
                                 vignette_error(e->theta, e->pbr, SHININESS, 1.0, 1.0)));
    add_vignette_fit(p, e);
    for (uint32_t a = 0; a < p->angle_count; a++)
        add_pair(p, &source, &conversion, (double)p->angles[a],
                 plot_text(p, "Fit over the hemisphere, view at %s\u00b0%s",
                           plot_degrees(p, (double)p->angles[a]),
                           p->desc->has_heaviside_ramp ? ", with the step" : ""));
    plot_panel *differences = add_differences(p, &source, &conversion, "Difference");
    plot_add_line(p, differences, "the 33 points' fit", plot_faint(1), VIGNETTE_POINTS, e->phi,
                  e->difference);
    add_polar(p, e, &source, &conversion);
    plot_panel *errors = add_errors(p, &source.parameters, "white metals of other roughness", 10);
    if (errors)
        errors->panel.y.scale = CHART_LOG10;
    uint32_t rows = (p->panel_count + 2) / 3;
    return plot_finish(p, "Shininess in OpenGL 1 versus glTF PBR", 3, 1500, 400 * rows + 60);
}

static facet_result make_conversions(plot *p)
{
    for (uint32_t k = 0; k < p->subject_count; k++) {
        const material *source = &p->subjects[k].material;
        facet_plot_model to =
            source->parameters.model == FACET_PLOT_MODEL_OGL1 ? FACET_PLOT_MODEL_PBR : FACET_PLOT_MODEL_OGL1;
        plot_conversion conversion;
        TRY(plot_convert(p, source, to, p->desc->has_fit, &conversion));
        if (p->desc->has_fit)
            plot_report_fit(p, k, source, &conversion);
        for (uint32_t a = 0; a < p->angle_count; a++)
            add_pair(
                p, source, &conversion, (double)p->angles[a],
                plot_text(p, "%s, view at %s\u00b0", source->label, plot_degrees(p, (double)p->angles[a])));
        add_differences(p, source, &conversion, "Difference");
    }
    uint32_t columns = p->angle_count + 1;
    return plot_finish(p, "Materials and their conversions", columns, 440 * columns,
                       380 * p->subject_count + 60);
}

facet_result plot_make_legacy(plot *p)
{
    return p->has_default_materials ? make_vignette(p) : make_conversions(p);
}
