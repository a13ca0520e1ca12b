/* plot_brdf.c - BRDFs: polar slices and curves in the plane of incidence, false-color discs and surfaces
 * over the hemisphere. */
#include <math.h>

#include "plot/plot_build.h"

/* ---- the plane of incidence ---- */

/* One subject at one view angle. */
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
    return plot_text(p, "%smirror direction at %s%s\u00b0, view at %s\u00b0%s%s", plot_fit_note(p),
                     view > 0.0 ? "\u2212" : "", degrees, degrees, p->has_channels ? "" : "; luminance",
                     is_forced ? "; times N.L, which OpenGL 1's highlight lacks" : "");
}

/* A ray from the center to the border. */
static void add_ray(plot *p, plot_panel *panel, double angle, double from, double to, int dash)
{
    double *x = plot_values(p, 2);
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
        plot_add_panel(p, CHART_POLAR, plot_text(p, "View at %s\u00b0", plot_degrees(p, view)), "",
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
    panel->panel.note = plot_text(p, "%s (dotted line)", note_of(p, view));
}

static void add_curves(plot *p, double view)
{
    size_t count;
    const double *angles = plot_light_angles(p, view, &count);
    double *degrees = plot_values(p, count);
    for (size_t i = 0; degrees && i < count; i++)
        degrees[i] = angles[i] / PLOT_DEGREE;
    plot_panel *panel = plot_add_panel(p, CHART_XY, plot_text(p, "View at %s\u00b0", plot_degrees(p, view)),
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
    panel->panel.y.has_zero = !p->desc->is_logarithmic;
    if (p->desc->is_logarithmic) { /* values that fall to 0 at the horizon would use up all decades */
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

/* ---- the hemisphere ---- */

enum { DISC = 161, LOBE = 121 };

static const char *title_of(plot *p, const plot_subject *subject, double view)
{
    return plot_text(p, "%s, view at %s\u00b0", subject->material.label, plot_degrees(p, view));
}

/* Luminance of the BRDF for all L; below the horizon NAN. */
static bool evaluate(plot *p, const material *m, double view, size_t count, const float (*L)[3], double *out)
{
    float V[3];
    double(*f)[3] = plot_alloc(p, count, sizeof *f);
    if (!f)
        return false;
    plot_direction(view, 0.0, V);
    material_brdf_cos(m, V, count, L, f);
    for (size_t i = 0; i < count; i++) {
        double y = material_luminance(f[i]);
        if (!p->has_cosine)
            y /= (double)L[i][2];
        out[i] = L[i][2] > 0.0f ? y : (double)NAN;
    }
    return true;
}

/* Seen from above: coordinates on the disc are L.x and L.y, with the eye at the right. */
static void add_disc(plot *p, const plot_subject *subject, double view)
{
    plot_panel *panel = plot_add_panel(p, CHART_DISC, title_of(p, subject, view), "", "");
    double *values;
    chart_field *field = plot_add_field(p, panel, DISC, DISC, plot_scale(p), quantity(p), &values);
    float(*L)[3] = plot_alloc(p, (size_t)DISC * DISC, sizeof *L);
    if (!field || !L)
        return;
    for (int row = 0; row < DISC; row++)
        for (int column = 0; column < DISC; column++) {
            double x = (2.0 * column + 1.0) / DISC - 1.0;
            double y = 1.0 - (2.0 * row + 1.0) / DISC;
            double z2 = 1.0 - x * x - y * y;
            float *d = L[row * DISC + column];
            d[0] = (float)x;
            d[1] = (float)y;
            d[2] = z2 > 0.0 ? (float)sqrt(z2) : -1.0f;
        }
    if (!evaluate(p, &subject->material, view, (size_t)DISC * DISC, (const float(*)[3])L, values))
        return;
    if (p->desc->is_logarithmic) { /* at most five decades, since values fall to 0 */
        double highest = 0.0;
        for (int i = 0; i < DISC * DISC; i++)
            highest = values[i] > highest ? values[i] : highest;
        double lowest = highest;
        for (int i = 0; i < DISC * DISC; i++)
            lowest = values[i] > highest * 1e-5 && values[i] < lowest ? values[i] : lowest;
        for (int i = 0; i < DISC * DISC; i++)
            values[i] = values[i] < lowest ? lowest : values[i];
    }
}

/* count positions in [first, last]: half of them even, half distributed as a Lorentzian of that width
 * around peak, by inverting its distribution function with bisection. */
static void places(size_t count, double first, double last, double peak, double width, double *out)
{
    double low_tail = atan((first - peak) / width);
    double whole = atan((last - peak) / width) - low_tail;
    for (size_t i = 0; i < count; i++) {
        double wanted = (double)i / (double)(count - 1);
        double a = first, b = last;
        for (int step = 0; step < 50; step++) {
            double x = 0.5 * (a + b);
            double share =
                0.5 * (x - first) / (last - first) + 0.5 * (atan((x - peak) / width) - low_tail) / whole;
            if (share < wanted)
                a = x;
            else
                b = x;
        }
        out[i] = 0.5 * (a + b);
    }
}

/* Radius of a value: its square root over that of the peak, which shows a diffuse base beside a highlight;
 * or its decades above 1e-5 of the peak. */
static double radius_of(const plot *p, double value, double peak)
{
    double share = value > 0.0 && peak > 0.0 ? value / peak : 0.0;
    if (!p->desc->is_logarithmic)
        return sqrt(share);
    return share > 1e-5 ? 1.0 + log10(share) / 5.0 : 0.0;
}

static void add_lobe(plot *p, const plot_subject *subject, double view)
{
    const size_t count = (size_t)LOBE * LOBE;
    plot_panel *panel = plot_add_panel(p, CHART_SURFACE, title_of(p, subject, view), "", "");
    chart_surface *surface = plot_alloc(p, 1, sizeof *surface);
    double *x = plot_values(p, count), *y = plot_values(p, count), *z = plot_values(p, count);
    double *values = plot_values(p, count);
    double *polar = plot_values(p, LOBE), *azimuth = plot_values(p, LOBE);
    float(*L)[3] = plot_alloc(p, count, sizeof *L);
    if (p->has_failed || !panel)
        return;
    double width = fmax(2.0 * material_width(&subject->material), 0.02);
    places(LOBE, 0.0, 89.9 * PLOT_DEGREE, view, width, polar);
    places(LOBE, 0.0, 2.0 * PLOT_PI, PLOT_PI, width / fmax(sin(view), 0.05), azimuth);
    for (size_t i = 0; i < count; i++)
        plot_direction(polar[i / LOBE], azimuth[i % LOBE], L[i]);
    if (!evaluate(p, &subject->material, view, count, (const float(*)[3])L, values))
        return;
    double peak = 0.0;
    for (size_t i = 0; i < count; i++)
        peak = values[i] > peak ? values[i] : peak;
    for (size_t i = 0; i < count; i++) {
        double r = radius_of(p, values[i], peak);
        x[i] = r * (double)L[i][0];
        y[i] = r * (double)L[i][1];
        z[i] = r * (double)L[i][2];
        if (p->desc->is_logarithmic)
            values[i] = log10(fmax(values[i], peak * 1e-5));
    }
    *surface = (chart_surface){.width = LOBE,
                               .height = LOBE,
                               .x = x,
                               .y = y,
                               .z = z,
                               .values = values,
                               .label = p->desc->is_logarithmic ? plot_text(p, "log10 of %s", quantity(p))
                                                                : quantity(p),
                               .azimuth_rad = -60.0 * PLOT_DEGREE,
                               .elevation_rad = 20.0 * PLOT_DEGREE};
    panel->panel.surface = surface;
    panel->panel.note =
        plot_text(p, "peak %.3g; radius: %s", peak,
                  p->desc->is_logarithmic ? "five decades" : "square root of the share of the peak");
}

facet_result plot_make_hemisphere(plot *p)
{
    bool is_disc = p->desc->kind == FACET_PLOT_KIND_HEMISPHERE;
    for (uint32_t k = 0; k < p->subject_count; k++)
        for (uint32_t a = 0; a < p->angle_count; a++)
            if (is_disc)
                add_disc(p, &p->subjects[k], (double)p->angles[a]);
            else
                add_lobe(p, &p->subjects[k], (double)p->angles[a]);
    uint32_t count = p->subject_count * p->angle_count;
    uint32_t columns = p->angle_count > 1 ? p->angle_count
                       : p->desc->has_fit ? (count < 7 ? 2 : 4) /* each fit beside its material */
                       : count < 4        ? count
                       : count == 4       ? 2
                       : count < 13       ? 3
                                          : 4;
    uint32_t rows = (count + columns - 1) / columns;
    return plot_finish(p,
                       is_disc ? "Reflectance over all directions of the light, seen from above"
                               : "Lobes over all directions of the light",
                       columns, 420 * columns > 640 ? 420 * columns : 640, 400 * rows + 60);
}
