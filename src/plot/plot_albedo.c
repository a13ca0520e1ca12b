/* plot_albedo.c - directional albedo over the angle of the view: the light that a surface returns of light from
 * everywhere. */
#include <math.h>

#include "base/parallel.h"
#include "plot/plot_build.h"

enum { POINTS = 46 };

typedef struct albedo_work {
    const plot *plot;
    const double *degrees;
    double (*albedo)[3]; /* POINTS per subject */
} albedo_work;

static void integrate(void *context, size_t begin, size_t end)
{
    const albedo_work *work = context;
    for (size_t i = begin; i < end; i++) {
        float V[3];
        plot_direction(work->degrees[i % POINTS] * PLOT_DEGREE, 0.0, V);
        material_albedo(&work->plot->subjects[i / POINTS].material, V, work->albedo[i]);
    }
}

/* 0 to 89.5 degrees, closer together towards grazing views. */
static double *view_angles(plot *p)
{
    double *x = plot_numbers(p, POINTS);
    for (int i = 0; x && i < POINTS; i++) {
        double u = 1.0 - (double)i / (POINTS - 1);
        x[i] = 89.5 * (1.0 - u * sqrt(u));
    }
    return x;
}

static void add_subject(plot *p, plot_panel *panel, const plot_subject *subject, const double *x,
                        const double (*albedo)[3])
{
    bool is_colored = false;
    for (int i = 0; i < POINTS && p->has_channels; i++)
        is_colored =
            is_colored || fabs(albedo[i][0] - albedo[i][1]) + fabs(albedo[i][1] - albedo[i][2]) > 2e-3;
    for (int c = 0; c < (is_colored ? 3 : 1); c++) {
        double *y = plot_add_curve(p, panel, plot_curve_name(p, subject, "", is_colored ? c : -1),
                                   plot_subject_style(p, subject, is_colored ? c : -1), POINTS, x);
        for (int i = 0; y && i < POINTS; i++)
            y[i] = is_colored ? albedo[i][c] : material_luminance(albedo[i]);
    }
}

facet_result plot_make_albedo(plot *p)
{
    size_t count = (size_t)POINTS * p->subject_count;
    const double *x = view_angles(p);
    albedo_work work = {.plot = p, .degrees = x, .albedo = plot_alloc(p, count, sizeof *work.albedo)};
    plot_panel *panel = plot_add_panel(p, CHART_XY, "", "angle of the view, degrees", "directional albedo");
    if (p->has_failed || !panel)
        return plot_finish(p, "", 1, 0, 0);
    parallel_for(p->desc->thread_count, count, 1, integrate, &work);
    for (uint32_t k = 0; k < p->subject_count; k++)
        add_subject(p, panel, &p->subjects[k], x, (const double(*)[3])work.albedo + (size_t)k * POINTS);
    double highest = 0.0;
    for (size_t c = 0; c < panel->panel.curve_count; c++)
        for (int i = 0; i < POINTS; i++)
            highest = fmax(highest, panel->curves[c].y[i]);
    plot_set_range(&panel->panel.x, 0.0, 90.0);
    panel->panel.x.is_degrees = true;
    panel->panel.y.scale = plot_scale(p);
    if (!p->desc->is_logarithmic)
        plot_set_range(&panel->panel.y, 0.0, highest > 1.005 ? ceil(highest * 5.0) / 5.0 : 1.0);
    panel->panel.note =
        plot_text(p, "%sintegral of BRDF times N.L over the light, within 0.001%s; %s", plot_fit_note(p),
                  p->has_channels ? "" : "; luminance",
                  p->desc->energy == FACET_ENERGY_CONSERVING
                      ? "energy-conserving"
                      : "the formulas of glTF, which lose what scatters twice and gain at grazing views");
    return plot_finish(p, "Directional albedo", 1, 960, 640);
}
