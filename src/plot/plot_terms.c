/* plot_terms.c - the factors of microfacet reflection over their cosines: D, G, V, F of shade/brdf.h,
 * sheen.h, fresnel.h. */
#include <math.h>

#include "plot/plot_build.h"

#include "shade/shade.h"

enum { POINTS = 401, MAX_ROUGHNESS = 16 };

typedef struct roughness_list {
    size_t count;
    float values[MAX_ROUGHNESS];
} roughness_list;

/* The distinct roughnesses of the materials. */
static roughness_list roughness_of(const plot *p)
{
    static const float defaults[] = {0.1f, 0.3f, 0.5f, 0.75f, 1.0f};
    roughness_list list = {0};
    for (size_t i = 0; p->has_default_materials && i < sizeof defaults / sizeof *defaults; i++)
        list.values[list.count++] = defaults[i];
    for (uint32_t k = 0; !p->has_default_materials && k < p->subject_count; k++) {
        const plot_subject *subject = &p->subjects[k];
        float r = subject->material.parameters.perceptual_roughness;
        bool is_new = !subject->is_fit;
        for (size_t i = 0; i < list.count; i++)
            is_new = is_new && (list.values[i] < r || list.values[i] > r);
        if (is_new)
            list.values[list.count++] = r;
    }
    return list;
}

static const char *label_of(plot *p, float roughness)
{
    return plot_text(p, "roughness %.3g", (double)roughness);
}

/* Cosines of angles from 0 on, as dense as the highlights are narrow. */
static double *cosines(plot *p)
{
    double *x = plot_values(p, POINTS);
    for (int i = 0; x && i < POINTS; i++) {
        double u = (double)i / (POINTS - 1);
        x[i] =
            /* cubic spacing: alpha of 0.01 has its peak within 0.6 degrees */
            cos(0.5 * PLOT_PI * u * u * u);
    }
    return x;
}

/* From near 0, where visibility is unbounded, denser there. */
static double *cosines_from_horizon(plot *p)
{
    double *x = plot_values(p, POINTS);
    for (int i = 0; x && i < POINTS; i++) {
        double u = (i + 1.0) / POINTS;
        x[i] = u * u;
    }
    return x;
}

static plot_panel *panel_over(plot *p, const char *title, const char *over, const char *label,
                              const char *note)
{
    plot_panel *panel = plot_add_panel(p, CHART_XY, title, over, label);
    if (panel) {
        plot_set_range(&panel->panel.x, 0.0, 1.0);
        panel->panel.note = note;
    }
    return panel;
}

static void add_distributions(plot *p, const roughness_list *list, const double *x)
{
    plot_panel *ggx =
        panel_over(p, "D: normals of microfacets, GGX", "N.H", "D, 1/sr", "Walter et al. 2007, equation 33");
    plot_panel *charlie =
        panel_over(p, "D: fibres of sheen, Charlie", "N.H", "D, 1/sr", "Estevez and Kulla 2017, equation 2");
    for (uint32_t k = 0; k < list->count; k++) {
        float alpha = max(alpha_from_roughness(list->values[k]), ALPHA_DELTA);
        double *a = plot_add_curve(p, ggx, label_of(p, list->values[k]), plot_color(k, 0), POINTS, x);
        double *b = plot_add_curve(p, charlie, label_of(p, list->values[k]), plot_color(k, 0), POINTS, x);
        for (int i = 0; a && b && i < POINTS; i++) {
            a[i] = (double)D_GGX((float)x[i], alpha);
            b[i] = (double)D_Charlie((float)x[i], sheen_alpha(list->values[k]));
        }
    }
    if (ggx)
        ggx->panel.y.scale = CHART_LOG10;
    if (charlie)
        charlie->panel.has_legend = false;
}

typedef enum visibility_kind { CORRELATED, SEPARABLE, SCHLICK_DIRECT, CHARLIE } visibility_kind;
static float visibility(visibility_kind kind, float NdotL, float NdotV, float roughness)
{
    float alpha = max(alpha_from_roughness(roughness), ALPHA_DELTA);
    switch (kind) {
    case CORRELATED:
        return V_SmithGGX(NdotL, NdotV, alpha);
    case SEPARABLE:
        return V_SmithGGX_separable(NdotL, NdotV, alpha);
    case SCHLICK_DIRECT:
        return V_SchlickGGX(NdotL, NdotV, k_direct(roughness));
    case CHARLIE:
        break;
    }
    return V_Charlie(NdotL, NdotV, sheen_alpha(roughness));
}

/* G = 4 (N.L) (N.V) V, the share of microfacets visible from both light and eye; or V itself. */
static void add_visibility(plot *p, const roughness_list *list, const double *x, visibility_kind last,
                           bool is_G)
{
    static const char *const forms[] = {"", ", separable", ", Schlick-GGX"};
    float NdotV = (float)cos((double)p->angles[0]);
    const char *eye = plot_degrees(p, (double)p->angles[0]);
    plot_panel *panel = panel_over(
        p,
        last == CHARLIE ? "V: visibility of sheen"
        : is_G          ? "G: masking and shadowing, Smith"
                        : "V = G / (4 N.L N.V), Smith",
        "N.L", is_G ? "G" : "V",
        last == CHARLIE
            ? plot_text(p, "view at %s\u00b0; KHR_materials_sheen", eye)
            : plot_text(p,
                        "view at %s\u00b0; solid: height-correlated (Heitz 2014), dashed: separable, "
                        "dotted: Schlick's (Karis 2013)",
                        eye));
    for (uint32_t k = 0; k < list->count; k++)
        for (int form = 0; form <= (last == CHARLIE ? 0 : (int)last); form++) {
            const char *name = plot_text(p, "%s%s", label_of(p, list->values[k]), forms[form]);
            double *y = plot_add_curve(p, panel, name, plot_color(k, form), POINTS, x);
            for (int i = 0; y && i < POINTS; i++) {
                float NdotL = (float)x[i];
                float v = visibility(last == CHARLIE ? CHARLIE : (visibility_kind)form, NdotL, NdotV,
                                     list->values[k]);
                y[i] = (double)(is_G ? 4.0f * NdotL * NdotV * v : v);
            }
        }
    if (!panel)
        return;
    panel->panel.has_legend = false;
    if (is_G)
        plot_set_range(&panel->panel.y, 0.0, 1.0);
    else
        panel->panel.y.scale = CHART_LOG10;
}

static void add_fresnel(plot *p, const double *x)
{
    static const struct {
        const char *name;
        float F0;
    } defaults[] = {{"F0 0.02, water", 0.02f},
                    {"F0 0.04, ior 1.5", 0.04f},
                    {"F0 0.17, diamond", 0.17f},
                    {"F0 0.5", 0.5f},
                    {"F0 0.95, silver", 0.95f}};
    plot_panel *panel =
        panel_over(p, "F: Schlick's approximation", "V.H", "F", "Schlick 1994, equation 15; F90 = 1");
    for (uint32_t k = 0; k < sizeof defaults / sizeof *defaults; k++) {
        double *y = plot_add_curve(p, panel, defaults[k].name, plot_color(k, 0), POINTS, x);
        for (int i = 0; y && i < POINTS; i++)
            y[i] = (double)F_Schlick1(defaults[k].F0, 1.0f, (float)x[i]);
    }
    if (panel)
        plot_set_range(&panel->panel.y, 0.0, 1.0);
}

facet_result plot_make_terms(plot *p)
{
    roughness_list list = roughness_of(p);
    const double *x = cosines(p);
    const double *from_horizon = cosines_from_horizon(p);
    if (x) {
        add_distributions(p, &list, x);
        add_fresnel(p, x);
    }
    if (from_horizon) {
        add_visibility(p, &list, from_horizon, SCHLICK_DIRECT, true);
        add_visibility(p, &list, from_horizon, SCHLICK_DIRECT, false);
        add_visibility(p, &list, from_horizon, CHARLIE, false);
    }
    return plot_finish(p, "The factors of microfacet reflection", 3, 1440, 900);
}
