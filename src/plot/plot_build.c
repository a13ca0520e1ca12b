/* plot_build.c - panels, curves, text, light directions and conversions of a plot under construction. See
 * plot_build.h. */
#include "plot/plot_build.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/result.h"

/* ---- memory and text ---- */

void *plot_alloc(plot *p, size_t count, size_t size)
{
    void *block = p->has_failed ? NULL : arena_zalloc(p->memory, count, size);
    p->has_failed |= !block;
    return block;
}

double *plot_values(plot *p, size_t count)
{
    return plot_alloc(p, count, sizeof(double));
}

const char *plot_text(plot *p, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    int length = vsnprintf(NULL, 0, format, list);
    va_end(list);
    char *text = length < 0 ? NULL : plot_alloc(p, (size_t)length + 1, 1);
    if (!text)
        return "";
    va_start(list, format);
    vsnprintf(text, (size_t)length + 1, format, list);
    va_end(list);
    return text;
}

/* ---- panels ---- */

plot_panel *plot_add_panel(plot *p, chart_panel_kind kind, const char *title, const char *label_x,
                           const char *label_y)
{
    if (!p->panels)
        p->panels = plot_alloc(p, PLOT_MAX_PANELS, sizeof *p->panels);
    if (p->has_failed || p->panel_count == PLOT_MAX_PANELS)
        return NULL;
    plot_panel *panel = &p->panels[p->panel_count++];
    panel->panel = (chart_panel){
        .kind = kind, .title = title, .x.label = label_x, .y.label = label_y, .has_legend = true, .note = ""};
    return panel;
}

void plot_set_range(chart_axis *axis, double minimum, double maximum)
{
    axis->has_range = true;
    axis->minimum = minimum;
    axis->maximum = maximum;
}

static bool make_room(plot *p, plot_panel *panel)
{
    if (panel->panel.curve_count < panel->capacity)
        return true;
    size_t capacity = panel->capacity ? 2 * panel->capacity : 8;
    chart_curve *curves = plot_alloc(p, capacity, sizeof *curves);
    if (!curves)
        return false;
    for (size_t i = 0; i < panel->panel.curve_count; i++)
        curves[i] = panel->curves[i];
    panel->curves = curves;
    panel->capacity = capacity;
    return true;
}

void plot_add_line(plot *p, plot_panel *panel, const char *name, chart_style style, size_t count,
                   const double *x, const double *y)
{
    if (panel && x && y && make_room(p, panel))
        panel->curves[panel->panel.curve_count++] =
            (chart_curve){.name = name, .count = count, .x = x, .y = y, .style = style};
}

double *plot_add_curve(plot *p, plot_panel *panel, const char *name, chart_style style, size_t count,
                       const double *x)
{
    double *y = plot_values(p, count);
    plot_add_line(p, panel, name, style, count, x, y);
    return p->has_failed ? NULL : y;
}

chart_field *plot_add_field(plot *p, plot_panel *panel, uint32_t width, uint32_t height, chart_scale scale,
                            const char *label, double **values)
{
    chart_field *field = plot_alloc(p, 1, sizeof *field);
    *values = plot_values(p, (size_t)width * height);
    if (!field || !*values || !panel)
        return NULL;
    *field = (chart_field){.width = width,
                           .height = height,
                           .values = *values,
                           .x0 = -1.0,
                           .x1 = 1.0,
                           .y0 = -1.0,
                           .y1 = 1.0,
                           .label = label,
                           .scale = scale};
    panel->panel.field = field;
    return field;
}

facet_result plot_finish(plot *p, const char *title, uint32_t columns, uint32_t width, uint32_t height)
{
    chart_panel *panels = plot_alloc(p, p->panel_count, sizeof *panels);
    if (p->has_failed)
        return fail_memory(p->error, "plot", 0);
    for (uint32_t i = 0; i < p->panel_count; i++) {
        panels[i] = p->panels[i].panel;
        panels[i].curves = p->panels[i].curves;
    }
    const facet_plot_desc *desc = p->desc;
    *p->out = (chart){.memory = p->memory,
                      .title = desc->title ? arena_strdup(p->memory, desc->title) : title,
                      .width = desc->width ? desc->width : width,
                      .height = desc->height ? desc->height : height,
                      .is_dark = desc->is_dark,
                      .columns = columns,
                      .panel_count = p->panel_count,
                      .panels = panels};
    return p->out->title ? FACET_OK : fail_memory(p->error, "plot", 0);
}

/* ---- styles ---- */

chart_style plot_color(uint32_t number, int dash)
{
    /* the palette repeats after eight colors, with other dashes */
    return (chart_style){.color = (int)number, .dash = dash + (int)(number / 8u)};
}

chart_style plot_channel(int channel, int dash)
{
    static const float rgb[4][3] = {
        {0.84f, 0.15f, 0.16f}, {0.10f, 0.60f, 0.18f}, {0.12f, 0.35f, 0.85f}, {0.5f, 0.5f, 0.5f}};
    chart_style style = {.color = -1, .dash = dash};
    for (int c = 0; c < 3; c++)
        style.rgb[c] = rgb[channel][c];
    return style;
}

chart_style plot_subject_style(const plot *p, const plot_subject *subject, int channel)
{
    static const float fit_rgb[3][3] = {
        {0.93f, 0.50f, 0.05f}, {0.47f, 0.67f, 0.05f}, {0.10f, 0.63f, 0.80f}}; /* fits of channels */
    if (channel < 0) /* fits follow all materials in the palette, which avoids equal colors */
        return plot_color(subject->is_fit ? p->material_count + subject->number : subject->number,
                          subject->is_fit ? 1 : 0);
    chart_style style = plot_channel(channel, subject->is_fit ? 1 : 0);
    for (int c = 0; subject->is_fit && c < 3; c++)
        style.rgb[c] = fit_rgb[channel][c];
    return style;
}

const char *plot_curve_name(plot *p, const plot_subject *subject, const char *remark, int channel)
{
    static const char *const channels[3] = {"red", "green", "blue"};
    const char *name = subject->is_fit && p->material_count == 1 ? "fit" : subject->material.label;
    return channel < 0 ? plot_text(p, "%s%s", name, remark)
                       : plot_text(p, "%s%s, %s", name, remark, channels[channel]);
}

const char *plot_fit_note(plot *p)
{
    bool has_fit = p->material_count == 1 && p->subject_count == 2;
    return has_fit ? plot_text(p, "%s; ", p->subjects[1].material.label) : "";
}

chart_style plot_faint(int dash)
{
    chart_style style = plot_channel(3, dash);
    style.width = 1.0f;
    return style;
}

chart_scale plot_scale(const plot *p)
{
    return p->desc->is_logarithmic ? CHART_LOG10 : CHART_LINEAR;
}

/* ---- numbers ---- */

double *plot_steps(plot *p, size_t count, double first, double last)
{
    double *x = plot_values(p, count);
    for (size_t i = 0; x && i < count; i++)
        x[i] = first + (last - first) * (double)i / (double)(count - 1);
    return x;
}

const char *plot_degrees(plot *p, double rad)
{
    return plot_text(p, "%.4g", round(rad / PLOT_DEGREE * 1e4) / 1e4);
}

/* ---- light directions ---- */

void plot_direction(double angle_rad, double azimuth_rad, float out[3])
{
    double s = sin(angle_rad);
    out[0] = (float)(s * cos(azimuth_rad));
    out[1] = (float)(s * sin(azimuth_rad));
    out[2] = (float)cos(angle_rad);
}

static int compare(const void *a, const void *b)
{
    double x = *(const double *)a;
    double y = *(const double *)b;
    return (x > y) - (x < y);
}

enum {
    EVEN = 357,    /* half a degree apart, nearly */
    NEAR_PEAK = 81 /* per width */
};

/* Distinct lobe widths of all subjects. */
static size_t widths_of(const plot *p, double *widths)
{
    size_t count = 0;
    for (uint32_t i = 0; i < p->subject_count; i++) {
        double width = material_width(&p->subjects[i].material);
        bool is_new = width < 0.5;
        for (size_t k = 0; k < count; k++)
            is_new = is_new && fabs(widths[k] / width - 1.0) > 0.1;
        if (is_new)
            widths[count++] = width;
    }
    return count;
}

/* The half vector rotates by half the angle of the light, and D falls to a quarter at tan theta_h = alpha:
 * angles that are even in atan(tan theta_h / alpha) resolve D from its peak to its tail. */
double *plot_light_angles(plot *p, double view_rad, size_t *count)
{
    const double limit = 89.9 * PLOT_DEGREE;
    double widths[2 * FACET_PLOT_MAX_MATERIALS];
    size_t width_count = widths_of(p, widths);
    double *x = plot_values(p, EVEN + width_count * NEAR_PEAK);
    *count = 0;
    if (!x)
        return NULL;
    size_t n = 0;
    for (int i = 0; i < EVEN; i++)
        x[n++] = limit * (2.0 * i / (EVEN - 1) - 1.0);
    for (size_t k = 0; k < width_count; k++)
        for (int i = 0; i < NEAR_PEAK; i++) {
            double u = 88.0 * PLOT_DEGREE * (2.0 * i / (NEAR_PEAK - 1) - 1.0);
            double angle = -view_rad + 2.0 * atan(widths[k] * tan(u));
            if (fabs(angle) < limit)
                x[n++] = angle;
        }
    qsort(x, n, sizeof *x, compare);
    for (size_t i = 0; i < n; i++) /* angles closer than float directions resolve count as equal */
        if (*count == 0 || x[i] - x[*count - 1] > 1e-7)
            x[(*count)++] = x[i];
    return x;
}

double (*plot_slice(plot *p, const material *m, double view_rad, size_t count, const double *angles,
                    bool has_cosine))[3]
{
    float V[3];
    float(*L)[3] = plot_alloc(p, count, sizeof *L);
    double(*f)[3] = plot_alloc(p, count, sizeof *f);
    if (!L || !f || !angles)
        return NULL;
    plot_direction(view_rad, 0.0, V);
    for (size_t i = 0; i < count; i++)
        plot_direction(angles[i], 0.0, L[i]);
    material_brdf_cos(m, V, count, (const float(*)[3])L, f);
    for (size_t i = 0; i < count && !has_cosine; i++)
        for (int c = 0; c < 3; c++)
            f[i][c] /= (double)L[i][2];
    return f;
}

/* ---- conversions to the other model ---- */

const fit_metric *plot_metric(plot *p)
{
    if (!p->metric && !p->has_failed) {
        pbr_masking masking = p->desc->has_separable_smith ? PBR_SEPARABLE : PBR_CORRELATED;
        /* the material of the vignette uses its formula */
        if (p->desc->kind == FACET_PLOT_KIND_LEGACY && p->has_default_materials)
            masking = PBR_SEPARABLE;
        if (fit_metric_create(&p->desc->allocator, masking, &p->metric, NULL) != FACET_OK)
            p->has_failed = true;
    }
    return p->metric;
}

facet_energy plot_energy(const facet_plot_desc *desc)
{
    return desc->has_fit || desc->kind == FACET_PLOT_KIND_LEGACY ? FACET_ENERGY_GLTF : desc->energy;
}

static void convert_pbr(const fit_metric *metric, const material *source, bool is_fit, plot_conversion *out)
{
    pbr_surface pbr = material_pbr_surface(&source->parameters);
    ogl1_surface ogl1;
    if (is_fit)
        pbr_to_ogl1_fit(metric, &pbr, FACET_LEGACY_TARGET_LINEAR, FIT_DISPLAYABLE, &ogl1);
    else
        pbr_to_ogl1_closed(&pbr, &ogl1);
    out->material.parameters = material_from_ogl1(&ogl1);
    out->has_error = true;
    out->error = fit_compare(metric, &ogl1, &pbr, FIT_FROM_PBR);
}

static void convert_ogl1(const fit_metric *metric, const material *source, bool is_fit, plot_conversion *out)
{
    ogl1_surface ogl1 = material_ogl1_surface(&source->parameters);
    pbr_surface pbr;
    if (is_fit)
        ogl1_to_pbr_fit(metric, &ogl1, FACET_LEGACY_TARGET_LINEAR, &pbr);
    else
        ogl1_to_pbr_closed(&ogl1, &pbr);
    out->material.parameters = material_from_pbr(&pbr);
    out->has_error = true;
    out->error = fit_compare(metric, &ogl1, &pbr, FIT_FROM_OGL1);
}

facet_result plot_convert(plot *p, const material *source, facet_plot_model to, bool is_fit,
                          plot_conversion *out)
{
    *out = (plot_conversion){.material = *source};
    out->material.measured = NULL;
    if (source->measured) {
        TRY(material_fit(source, to, &p->desc->allocator, &out->material.parameters, &out->rms, p->error));
    } else {
        const fit_metric *metric = plot_metric(p);
        if (!metric)
            return fail_memory(p->error, "directions of a fit", 0);
        if (source->parameters.model == FACET_PLOT_MODEL_PBR)
            convert_pbr(metric, source, is_fit, out);
        else
            convert_ogl1(metric, source, is_fit, out);
    }
    const char *what = material_describe(&out->material.parameters, &p->desc->allocator, p->memory);
    if (!what)
        return fail_memory(p->error, "plot", 0);
    out->what = what;
    double error = out->has_error ? out->error.E : out->rms;
    out->material.label = plot_text(p, "%s (%s %.3f): %s", is_fit || source->measured ? "fit" : "converted",
                                    out->has_error ? "E" : "RMS of logarithms", error, what);
    return FACET_OK;
}

void plot_report_fit(const plot *p, uint32_t number, const material *source, const plot_conversion *fit)
{
    facet_plot_fit *out = p->desc->fits ? &p->desc->fits[number] : NULL;
    if (!out)
        return;
    *out = (facet_plot_fit){.is_found = true,
                            .fitted = fit->material.parameters,
                            .is_of_measured = !fit->has_error,
                            .E = (float)fit->error.E,
                            .E_display = (float)fit->error.E_display,
                            .E_drawn = (float)fit->error.E_drawn,
                            .log_rms = (float)fit->rms};
    out->fitted.label = NULL;
    snprintf(out->name, sizeof out->name, "%s", source->label);
    snprintf(out->description, sizeof out->description, "%s", fit->what);
}
