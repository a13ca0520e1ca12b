/* plot_functions.c - plots that need no material: tone mapping curves (shade/tonemap.h), Fresnel
 * reflectance of water and other media (shade/fresnel.h), split-sum LUTs (ibl/dfg.h). */
#include <math.h>

#include "base/result.h"
#include "ibl/ibl.h"
#include "plot/plot_build.h"

#include "shade/shade.h"

/* ---- tone mapping ---- */

enum { TONE_POINTS = 481 };

#define MIDDLE_GRAY 0.18
#define STOPS 8.0

static const struct {
    int op;
    const char *name;
} operators[] = {{TONEMAP_NONE, "none (clamped)"},
                 {TONEMAP_NEUTRAL, "Khronos PBR Neutral"},
                 {TONEMAP_ACES, "ACES (Hill)"},
                 {TONEMAP_ACES_NARKOWICZ, "ACES (Narkowicz 2015)"},
                 {TONEMAP_AGX, "AgX"},
                 {TONEMAP_REINHARD, "Reinhard 2002"},
                 {TONEMAP_REINHARD_EXTENDED, "Reinhard 2002, white 4"},
                 {TONEMAP_HABLE, "Hable 2010"}};
_Static_assert((int)FACET_TONEMAP_HABLE == TONEMAP_HABLE &&
                   sizeof operators / sizeof *operators == TONEMAP_HABLE + 1,
               "every operator of the interface");

static void add_operators(plot *p, plot_panel *panel, const double *x, const double *light, bool is_encoded)
{
    for (uint32_t k = 0; light && k < sizeof operators / sizeof *operators; k++) {
        double *y =
            plot_add_curve(p, panel, operators[k].name, plot_color(k, k == 0 ? 1 : 0), TONE_POINTS, x);
        for (int i = 0; y && i < TONE_POINTS; i++) {
            float shown = tonemap(operators[k].op, vec3((float)light[i]))[1];
            y[i] = (double)(is_encoded ? srgb_from_linear1(shown) : shown);
        }
    }
}

facet_result plot_make_tone(plot *p)
{
    plot_panel *stops = plot_add_panel(p, CHART_XY, "Over stops", "scene light, stops over middle gray 0.18",
                                       "display, sRGB-encoded");
    const double *x = plot_steps(p, TONE_POINTS, -STOPS, STOPS);
    double *light = plot_values(p, TONE_POINTS);
    for (int i = 0; light && x && i < TONE_POINTS; i++)
        light[i] = MIDDLE_GRAY * exp2(x[i]);
    add_operators(p, stops, x, light, true);
    plot_panel *linear =
        plot_add_panel(p, CHART_XY, "Over scene light", "scene light, linear, 1: white", "display, linear");
    const double *even = plot_steps(p, TONE_POINTS, 0.0, 4.0);
    add_operators(p, linear, even, even, false);
    if (p->has_failed)
        return plot_finish(p, "", 2, 0, 0);
    plot_set_range(&stops->panel.x, -STOPS, STOPS);
    plot_set_range(&linear->panel.x, 0.0, 4.0);
    stops->panel.note = "grays; what facet writes into 8-bit files";
    linear->panel.note = "the same curves without the display's encoding";
    linear->panel.has_legend = false;
    if (p->desc->is_logarithmic) {
        stops->panel.y.scale = linear->panel.y.scale = CHART_LOG10;
        plot_set_range(&stops->panel.y, 1e-3, 1.0);
        plot_set_range(&linear->panel.y, 1e-3, 1.0);
    } else {
        plot_set_range(&stops->panel.y, 0.0, 1.0);
        plot_set_range(&linear->panel.y, 0.0, 1.0);
    }
    return plot_finish(p, "Tone mapping", 2, 1200, 560);
}

/* ---- Fresnel reflectance ---- */

enum { FRESNEL_POINTS = 361 };

typedef struct dielectric {
    const char *name;
    float ior;
} dielectric;

/* Complex indices at a wavelength for red, green and blue each. Gold and copper: Johnson and Christy 1972,
 * "Optical Constants of the Noble Metals", at 617, 549 and 451 nm; aluminium: Rakic 1995, at 620, 564 and
 * 443 nm. */
typedef struct conductor {
    const char *name, *source;
    float eta[3], k[3];
} conductor;
static const conductor conductors[] = {
    {"gold", "Johnson and Christy 1972: 617, 549, 451 nm", {0.21f, 0.43f, 1.38f}, {3.272f, 2.455f, 1.914f}},
    {"copper", "Johnson and Christy 1972: 617, 549, 451 nm", {0.30f, 1.02f, 1.24f}, {3.205f, 2.577f, 2.397f}},
    {"aluminium", "Rakic 1995: 620, 564, 443 nm", {1.3660f, 1.0728f, 0.60790f}, {7.4052f, 6.7839f, 5.3676f}},
};

/* An interface of relative index eta: exact, and by Schlick as the renderer has it from either side. */
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
        is_inside ? panel_over_angle(p, "From below: total reflection", "reflectance",
                                     "solid: Fresnel; dashed: Schlick with the cosine of the rarer side")
                  : panel_over_angle(p, "From above", "reflectance", "solid: Fresnel; dashed: Schlick 1994");
    for (uint32_t k = 0; k < count; k++) {
        float eta = is_inside ? 1.0f / media[k].ior : media[k].ior;
        const char *name = plot_text(p, "%s, n = %.4g", media[k].name, (double)media[k].ior);
        double *y = plot_add_curve(p, panel, name, plot_color(k, 0), FRESNEL_POINTS, x);
        double *approximate = plot_add_curve(p, panel, plot_text(p, "%s, Schlick", media[k].name),
                                             plot_color(k, 1), FRESNEL_POINTS, x);
        for (int i = 0; y && approximate && i < FRESNEL_POINTS; i++) {
            float cosine = (float)cos(x[i] * PLOT_DEGREE);
            y[i] = exact(cosine, eta);
            approximate[i] = schlick(cosine, eta);
        }
    }
    set_reflectance(p, panel);
    if (panel && is_inside) /* explained in the first panel */
        panel->panel.has_legend = false;
}

static void add_differences(plot *p, const dielectric *media, uint32_t count, const double *x)
{
    plot_panel *panel =
        panel_over_angle(p, "Error of Schlick's approximation", "Schlick less Fresnel", "from above");
    for (uint32_t k = 0; k < count; k++) {
        double *y = plot_add_curve(p, panel, media[k].name, plot_color(k, 0), FRESNEL_POINTS, x);
        for (int i = 0; y && i < FRESNEL_POINTS; i++) {
            float cosine = (float)cos(x[i] * PLOT_DEGREE);
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
        double *y = plot_add_curve(p, panel, channels[channel], plot_channel(channel, 0), FRESNEL_POINTS, x);
        double *approximate = plot_add_curve(p, panel, plot_text(p, "%s, Schlick", channels[channel]),
                                             plot_channel(channel, 1), FRESNEL_POINTS, x);
        for (int i = 0; y && approximate && i < FRESNEL_POINTS; i++) {
            float cosine = (float)cos(x[i] * PLOT_DEGREE);
            y[i] = (double)F_conductor(cosine, eta, k)[channel];
            approximate[i] = (double)F_Schlick(F0, vec3(1.0f), cosine)[channel];
        }
    }
    set_reflectance(p, panel);
    if (panel)
        panel->panel.has_legend = c == &conductors[sizeof conductors / sizeof *conductors - 1];
}

/* The roughnesses of the materials. */
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
    const double *x = plot_steps(p, FRESNEL_POINTS, 0.0, 90.0);
    if (x) {
        add_dielectrics(p, media, count, x, false);
        add_dielectrics(p, media, count, x, true);
        add_differences(p, media, count, x);
        for (size_t i = 0; p->has_default_materials && i < sizeof conductors / sizeof *conductors; i++)
            add_conductor(p, &conductors[i], x);
    }
    return plot_finish(p, "Reflection at a boundary", 3, 1500, p->has_default_materials ? 940 : 520);
}

/* ---- DFG LUTs ---- */

enum { DFG_SIZE = 192 };

typedef enum dfg_quantity { DFG_SCALE, DFG_BIAS, DFG_LOST, DFG_SHEEN } dfg_quantity;

static double value_of(dfg_quantity what, float NdotV, float roughness)
{
    float terms[2];
    if (what == DFG_SHEEN)
        return (double)ibl_sheen_albedo(NdotV, roughness);
    ibl_dfg(NdotV, roughness, terms);
    return what == DFG_SCALE  ? (double)terms[0]
           : what == DFG_BIAS ? (double)terms[1]
                              : 1.0 - (double)(terms[0] + terms[1]);
}

static void add_table(plot *p, dfg_quantity what, const char *title, const char *label, const char *note,
                      double maximum)
{
    plot_panel *panel = plot_add_panel(p, CHART_FIELD, title, "N.V", "perceptual roughness");
    double *values;
    chart_field *field = plot_add_field(p, panel, DFG_SIZE, DFG_SIZE, CHART_LINEAR, label, &values);
    if (!field)
        return;
    /* rows from the top, at cell centers */
    for (int row = 0; row < DFG_SIZE; row++)
        for (int column = 0; column < DFG_SIZE; column++)
            values[row * DFG_SIZE + column] =
                value_of(what, ((float)column + 0.5f) / DFG_SIZE, 1.0f - ((float)row + 0.5f) / DFG_SIZE);
    field->x0 = field->y0 = field->minimum = 0.0;
    field->maximum = maximum;
    panel->panel.note = note;
    plot_set_range(&panel->panel.x, 0.0, 1.0);
    plot_set_range(&panel->panel.y, 0.0, 1.0);
}

facet_result plot_make_dfg(plot *p)
{
    add_table(p, DFG_SCALE, "Scale A", "A", "reflectance = F0 A + F90 B (Karis 2013), height-correlated GGX",
              1.0);
    add_table(p, DFG_BIAS, "Bias B", "B", "the share of F90: what grazing views add", 0.0);
    add_table(p, DFG_LOST, "Light that scatters more than once", "1 - (A + B)",
              "returned by the compensation of Fdez-Aguera 2019", 0.0);
    add_table(p, DFG_SHEEN, "Albedo of sheen", "E",
              "Charlie, Estevez and Kulla 2017; more than 1 at smooth grazing rims is shown as 1", 1.0);
    return plot_finish(p, "Tables of split-sum light", 2, 1060, 960);
}
