/* plot_hemisphere.c - BRDFs over all directions of the light: discs in false color, and lobes as surfaces in space. */
#include <math.h>

#include "plot/plot_build.h"

enum { DISC = 161, LOBE = 121 };

static const char *quantity(const plot *p)
{
    return p->has_cosine ? "BRDF times N.L, 1/sr" : "BRDF, 1/sr";
}

static const char *title_of(plot *p, const plot_subject *subject, double view)
{
    return plot_text(p, "%s, eye at %s\u00b0", subject->material.label, plot_degrees(p, view));
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

/* As seen from above: places on the disc are L.x and L.y, the eye to the right. */
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
    if (p->desc->is_logarithmic) { /* five decades at most: what falls to 0 has no logarithm */
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

/* count places in [first, last], half of them even, half as close to peak as a Lorentzian of that width has them: the
 * inverse of its distribution, by bisection. */
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

/* Radius of a value: its square root over that of the peak, so that a diffuse base is seen beside a highlight; or the
 * decades that it is above a hundred-thousandth of the peak. */
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
    double *x = plot_numbers(p, count), *y = plot_numbers(p, count), *z = plot_numbers(p, count);
    double *values = plot_numbers(p, count);
    double *polar = plot_numbers(p, LOBE), *azimuth = plot_numbers(p, LOBE);
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
                       : p->desc->has_fit ? (count < 7 ? 2 : 4) /* fits beside what they fit */
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
