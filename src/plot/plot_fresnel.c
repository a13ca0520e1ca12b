/* plot_fresnel.c - what boundaries reflect over the angle: Fresnel's equations beside Schlick's approximation, water first.
 * All of shade/fresnel.h; unpolarised light. */
#include <math.h>

#include "base/result.h"
#include "plot/plot_build.h"

#include "shade/shade.h"

enum { POINTS = 361 };

typedef struct dielectric {
    const char *name;
    float ior;
} dielectric;

/* Complex indices at a wavelength for red, green and blue each. Gold and copper: Johnson and Christy 1972, "Optical
 * Constants of the Noble Metals", at 617, 549 and 451 nm; aluminium: Rakic 1995, at 620, 564 and 443 nm. */
typedef struct conductor {
    const char *name, *source;
    float eta[3], k[3];
} conductor;
static const conductor conductors[] = {
    {"gold", "Johnson and Christy 1972: 617, 549, 451 nm", {0.21f, 0.43f, 1.38f}, {3.272f, 2.455f, 1.914f}},
    {"copper", "Johnson and Christy 1972: 617, 549, 451 nm", {0.30f, 1.02f, 1.24f}, {3.205f, 2.577f, 2.397f}},
    {"aluminium", "Rakic 1995: 620, 564, 443 nm", {1.3660f, 1.0728f, 0.60790f}, {7.4052f, 6.7839f, 5.3676f}},
};

/* The boundary of index eta (far over near): exact, and Schlick's as the renderer has it from either side. */
static double exact(float cosine, float eta)
{
    return (double)F_dielectric(cosine, eta);
}
static double schlick(float cosine, float eta)
{
    return (double)F_Schlick_boundary(vec3(F0_from_ior(eta)), vec3(1.0f), cosine, eta)[0];
}

static plot_panel *panel_over_angle(plot *p, const char *title, const char *label, const char *note)
{
    plot_panel *panel = plot_add_panel(p, CHART_XY, title, "angle from the normal", label);
    if (panel) {
        plot_set_range(&panel->panel.x, 0.0, 90.0);
        panel->panel.x.is_degrees = true;
        panel->panel.note = note;
    }
    return panel;
}

static void set_reflectance(const plot *p, plot_panel *panel)
{
    if (!panel)
        return;
    panel->panel.y.scale = plot_scale(p);
    plot_set_range(&panel->panel.y, p->desc->is_logarithmic ? 1e-3 : 0.0, 1.0);
}

static void add_dielectrics(plot *p, const dielectric *media, uint32_t count, const double *x, bool is_inside)
{
    plot_panel *panel =
        is_inside ? panel_over_angle(p, "from below: total reflection", "reflectance",
                                     "solid: Fresnel; dashed: Schlick with the cosine of the rarer side")
                  : panel_over_angle(p, "from above", "reflectance", "solid: Fresnel; dashed: Schlick 1994");
    for (uint32_t k = 0; k < count; k++) {
        float eta = is_inside ? 1.0f / media[k].ior : media[k].ior;
        const char *name = plot_text(p, "%s, n = %.4g", media[k].name, (double)media[k].ior);
        double *y = plot_add_curve(p, panel, name, plot_color(k, 0), POINTS, x);
        double *approximate =
            plot_add_curve(p, panel, plot_text(p, "%s, Schlick", media[k].name), plot_color(k, 1), POINTS, x);
        for (int i = 0; y && approximate && i < POINTS; i++) {
            float cosine = (float)(cos)(x[i] * PLOT_DEGREE);
            y[i] = exact(cosine, eta);
            approximate[i] = schlick(cosine, eta);
        }
    }
    set_reflectance(p, panel);
    if (panel && is_inside) /* that of the panel before */
        panel->panel.has_legend = false;
}

static void add_differences(plot *p, const dielectric *media, uint32_t count, const double *x)
{
    plot_panel *panel =
        panel_over_angle(p, "error of Schlick's approximation", "Schlick less Fresnel", "from above");
    for (uint32_t k = 0; k < count; k++) {
        double *y = plot_add_curve(p, panel, media[k].name, plot_color(k, 0), POINTS, x);
        for (int i = 0; y && i < POINTS; i++) {
            float cosine = (float)(cos)(x[i] * PLOT_DEGREE);
            y[i] = schlick(cosine, media[k].ior) - exact(cosine, media[k].ior);
        }
    }
}

static void add_conductor(plot *p, const conductor *c, const double *x)
{
    static const char *const channels[3] = {"red", "green", "blue"};
    plot_panel *panel = panel_over_angle(p, c->name, "reflectance", plot_text(p, "n, k: %s", c->source));
    vec3 eta = vec3(c->eta[0], c->eta[1], c->eta[2]);
    vec3 k = vec3(c->k[0], c->k[1], c->k[2]);
    vec3 F0 = F_conductor(1.0f, eta, k);
    for (int channel = 0; channel < 3; channel++) {
        double *y = plot_add_curve(p, panel, channels[channel], plot_channel(channel, 0), POINTS, x);
        double *approximate = plot_add_curve(p, panel, plot_text(p, "%s, Schlick", channels[channel]),
                                             plot_channel(channel, 1), POINTS, x);
        for (int i = 0; y && approximate && i < POINTS; i++) {
            float cosine = (float)(cos)(x[i] * PLOT_DEGREE);
            y[i] = (double)F_conductor(cosine, eta, k)[channel];
            approximate[i] = (double)F_Schlick(F0, vec3(1.0f), cosine)[channel];
        }
    }
    set_reflectance(p, panel);
    if (panel) /* the last one has the most room */
        panel->panel.has_legend = c == &conductors[sizeof conductors / sizeof *conductors - 1];
}

/* Those of the materials. */
static facet_result media_of(plot *p, dielectric *media, uint32_t *count)
{
    for (uint32_t k = 0; k < p->subject_count; k++) {
        const material *m = &p->subjects[k].material;
        const facet_plot_material *q = &m->parameters;
        if (q->model != FACET_PLOT_MODEL_PBR || !(q->ior >= 1.0f) || q->metallic >= 1.0f)
            return fail(
                p->error, FACET_ERROR_ARGUMENT,
                "plot: material %u (%s) has no index of refraction; dielectrics of ior 1 or more expected",
                k + 1, m->label);
        media[(*count)++] = (dielectric){.name = m->label, .ior = q->ior};
    }
    return FACET_OK;
}

facet_result plot_make_fresnel(plot *p)
{
    dielectric media[2 * FACET_PLOT_MAX_MATERIALS] = {
        {"water", 1.333f}, {"glass", 1.5f}, {"diamond", 2.417f}};
    uint32_t count = p->has_default_materials ? 3 : 0;
    if (!p->has_default_materials && media_of(p, media, &count) != FACET_OK)
        return FACET_ERROR_ARGUMENT;
    const double *x = plot_steps(p, POINTS, 0.0, 90.0);
    if (x) {
        add_dielectrics(p, media, count, x, false);
        add_dielectrics(p, media, count, x, true);
        add_differences(p, media, count, x);
        for (size_t i = 0; p->has_default_materials && i < sizeof conductors / sizeof *conductors; i++)
            add_conductor(p, &conductors[i], x);
    }
    return plot_finish(p, "Reflection at a boundary", 3, 1500, p->has_default_materials ? 940 : 520);
}
