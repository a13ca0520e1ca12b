/* plot_slices.c - BRDFs in the plane of incidence: as polar lobes, and as curves over the angle of the light. */
#include <math.h>

#include "plot/plot_build.h"

/* One subject for one view. */
typedef struct slice {
    size_t count;
    const double *angles;
    double (*f)[3];
    double peak; /* of all channels, or of luminance */
    bool is_colored;
} slice;

static slice make_slice(plot *p, const plot_subject *subject, double view, size_t count, const double *angles)
{
    slice s = {.count = count, .angles = angles};
    s.f = plot_slice(p, &subject->material, view, count, angles, p->has_cosine);
    for (size_t i = 0; s.f && i < count; i++) {
        const double *f = s.f[i];
        double spread = fmax(f[0], fmax(f[1], f[2])) - fmin(f[0], fmin(f[1], f[2]));
        s.is_colored = s.is_colored || (p->has_channels && spread > 1e-4 * f[1]);
    }
    for (size_t i = 0; s.f && i < count; i++) {
        const double *f = s.f[i];
        double largest = s.is_colored ? fmax(f[0], fmax(f[1], f[2])) : material_luminance(f);
        s.peak = largest > s.peak ? largest : s.peak; /* NAN is not larger */
    }
    return s;
}

/* Adds a curve, or three, of values times scale over x. */
static void add_slice(plot *p, plot_panel *panel, const plot_subject *subject, const slice *s,
                      const double *x, double scale, bool has_peak)
{
    const char *peak = has_peak ? plot_text(p, " (peak %.3g)", s->peak) : "";
    for (int c = 0; c < (s->is_colored ? 3 : 1); c++) {
        chart_style style = plot_subject_style(p, subject, s->is_colored ? c : -1);
        const char *label = plot_curve_name(p, subject, peak, s->is_colored ? c : -1);
        double *y = plot_add_curve(p, panel, label, style, s->count, x);
        for (size_t i = 0; y && i < s->count; i++)
            y[i] = scale * (s->is_colored ? s->f[i][c] : material_luminance(s->f[i]));
    }
}

static const char *quantity(const plot *p)
{
    return p->has_cosine ? "BRDF times N.L, 1/sr" : "BRDF, 1/sr";
}

static const char *note_of(plot *p, double view)
{
    const char *degrees = plot_degrees(p, view);
    bool is_forced = p->has_cosine && !p->desc->has_cosine;
    return plot_text(p, "%smirror direction at %s%s, the eye at %s degrees%s%s", plot_fit_note(p),
                     view > 0.0 ? "-" : "", degrees, degrees, p->has_channels ? "" : "; luminance",
                     is_forced ? "; times N.L, which OpenGL 1's highlight lacks" : "");
}

/* A ray from the middle to the border. */
static void add_ray(plot *p, plot_panel *panel, double angle, double from, double to, int dash)
{
    double *x = plot_numbers(p, 2);
    double *y = plot_add_curve(p, panel, "", plot_faint(dash), 2, x);
    if (!y)
        return;
    x[0] = x[1] = angle;
    y[0] = from;
    y[1] = to;
}

/* The highest value of all lobes. */
static double find_highest(plot *p)
{
    double highest = 0.0;
    for (uint32_t a = 0; a < p->angle_count; a++) {
        size_t count;
        double view = (double)p->angles[a];
        const double *angles = plot_light_angles(p, view, &count);
        for (uint32_t k = 0; k < p->subject_count && !p->has_failed; k++)
            highest = fmax(highest, make_slice(p, &p->subjects[k], view, count, angles).peak);
    }
    return highest;
}

/* The next of 1, 1.5, 2, 2.5 .. 10 times a power of ten. */
static double round_up(double x)
{
    double decade = pow(10.0, floor(log10(fmax(x, 1e-12))));
    return 0.5 * ceil(2.0 * x / decade) * decade;
}

static void add_polar(plot *p, double view)
{
    size_t count;
    const double *angles = plot_light_angles(p, view, &count);
    bool is_log = p->desc->is_logarithmic, is_absolute = is_log || p->highest > 0.0;
    plot_panel *panel =
        plot_add_panel(p, CHART_POLAR, plot_text(p, "eye at %s degrees", plot_degrees(p, view)), "",
                       is_absolute ? quantity(p) : plot_text(p, "%s, over its peak", quantity(p)));
    double highest = 0.0;
    for (uint32_t k = 0; k < p->subject_count && !p->has_failed; k++) {
        const plot_subject *subject = &p->subjects[k];
        slice s = make_slice(p, subject, view, count, angles);
        add_slice(p, panel, subject, &s, angles, is_absolute || !(s.peak > 0.0) ? 1.0 : 1.0 / s.peak,
                  !is_log);
        highest = fmax(highest, s.peak);
    }
    if (p->has_failed)
        return;
    double decade = pow(10.0, ceil(log10(fmax(fmax(highest, p->highest), 1e-12))));
    double low = is_log ? decade * 1e-5 : 0.0;
    double high = is_log ? decade : is_absolute ? round_up(p->highest) : 1.0;
    panel->panel.y.scale = plot_scale(p);
    plot_set_range(&panel->panel.y, low, high);
    add_ray(p, panel, view, low, high, 2);
    add_ray(p, panel, -view, low, high, 1);
    panel->panel.note = plot_text(p, "%s (dotted: the eye)", note_of(p, view));
}

static void add_curves(plot *p, double view)
{
    size_t count;
    const double *angles = plot_light_angles(p, view, &count);
    double *degrees = plot_numbers(p, count);
    for (size_t i = 0; degrees && i < count; i++)
        degrees[i] = angles[i] / PLOT_DEGREE;
    plot_panel *panel = plot_add_panel(p, CHART_XY, plot_text(p, "eye at %s degrees", plot_degrees(p, view)),
                                       "angle of the light, degrees", quantity(p));
    double highest = 0.0;
    for (uint32_t k = 0; k < p->subject_count && !p->has_failed; k++) {
        const plot_subject *subject = &p->subjects[k];
        slice s = make_slice(p, subject, view, count, angles);
        add_slice(p, panel, subject, &s, degrees, 1.0, false);
        highest = fmax(highest, s.peak);
    }
    if (p->has_failed)
        return;
    panel->panel.y.scale = plot_scale(p);
    if (p->desc->is_logarithmic) { /* what falls to 0 at the horizon would take all decades */
        double decade = pow(10.0, ceil(log10(fmax(highest, 1e-12))));
        plot_set_range(&panel->panel.y, decade * 1e-6, decade);
    }
    plot_set_range(&panel->panel.x, -90.0, 90.0);
    panel->panel.x.is_degrees = true;
    panel->panel.note = note_of(p, view);
}

facet_result plot_make_slices(plot *p)
{
    bool is_polar = p->desc->kind == FACET_PLOT_KIND_BRDF;
    if (is_polar && p->desc->has_shared_scale)
        p->highest = find_highest(p);
    for (uint32_t a = 0; a < p->angle_count; a++) {
        double view = (double)p->angles[a];
        if (is_polar)
            add_polar(p, view);
        else
            add_curves(p, view);
        if (p->panels && a > 0) /* the same curves in all panels */
            p->panels[p->panel_count - 1].panel.has_legend = is_polar && !p->desc->is_logarithmic;
    }
    uint32_t columns = p->angle_count > 4   ? 4
                       : p->angle_count < 3 ? p->angle_count
                                            : (p->angle_count + 1) / 2;
    if (p->angle_count == 3)
        columns = 3;
    uint32_t rows = (p->angle_count + columns - 1) / columns;
    return plot_finish(
        p, is_polar ? "Reflectance in the plane of incidence" : "Reflectance over the angle of the light",
        columns, columns == 1 ? 960 : 600 * columns, rows * (columns == 1 ? 640 : 520));
}
