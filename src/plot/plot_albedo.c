/* plot_albedo.c - directional albedo over the view angle, and the white furnace test over roughness in
 * both energy modes, under punctual lights and under an environment (docs/shading-model.md, "The two
 * energy modes"). */
#include <math.h>

#include "base/parallel.h"
#include "plot/plot_build.h"

/* ---- directional albedo ---- */

enum { ALBEDO_POINTS = 46 };

typedef struct albedo_work {
    const plot *plot;
    const double *degrees;
    double (*albedo)[3]; /* ALBEDO_POINTS per subject */
} albedo_work;

static void integrate_albedo(void *context, size_t begin, size_t end)
{
    const albedo_work *work = context;
    for (size_t i = begin; i < end; i++) {
        float V[3];
        plot_direction(work->degrees[i % ALBEDO_POINTS] * PLOT_DEGREE, 0.0, V);
        material_albedo(&work->plot->subjects[i / ALBEDO_POINTS].material, V, work->albedo[i]);
    }
}

/* 0 to 89.5 degrees, denser towards grazing angles. */
static double *view_angles(plot *p)
{
    double *x = plot_values(p, ALBEDO_POINTS);
    for (int i = 0; x && i < ALBEDO_POINTS; i++) {
        double u = 1.0 - (double)i / (ALBEDO_POINTS - 1);
        x[i] = 89.5 * (1.0 - u * sqrt(u));
    }
    return x;
}

static void add_subject(plot *p, plot_panel *panel, const plot_subject *subject, const double *x,
                        const double (*albedo)[3])
{
    bool is_colored = false;
    for (int i = 0; i < ALBEDO_POINTS && p->has_channels; i++)
        is_colored =
            is_colored || fabs(albedo[i][0] - albedo[i][1]) + fabs(albedo[i][1] - albedo[i][2]) > 2e-3;
    for (int c = 0; c < (is_colored ? 3 : 1); c++) {
        double *y = plot_add_curve(p, panel, plot_curve_name(p, subject, "", is_colored ? c : -1),
                                   plot_subject_style(p, subject, is_colored ? c : -1), ALBEDO_POINTS, x);
        for (int i = 0; y && i < ALBEDO_POINTS; i++)
            y[i] = is_colored ? albedo[i][c] : material_luminance(albedo[i]);
    }
}

facet_result plot_make_albedo(plot *p)
{
    size_t count = (size_t)ALBEDO_POINTS * p->subject_count;
    const double *x = view_angles(p);
    albedo_work work = {.plot = p, .degrees = x, .albedo = plot_alloc(p, count, sizeof *work.albedo)};
    plot_panel *panel = plot_add_panel(p, CHART_XY, "", "angle of the view, degrees", "directional albedo");
    if (p->has_failed || !panel)
        return plot_finish(p, "", 1, 0, 0);
    parallel_for(p->desc->thread_count, count, 1, integrate_albedo, &work);
    for (uint32_t k = 0; k < p->subject_count; k++)
        add_subject(p, panel, &p->subjects[k], x,
                    (const double(*)[3])work.albedo + (size_t)k * ALBEDO_POINTS);
    double highest = 0.0;
    for (size_t c = 0; c < panel->panel.curve_count; c++)
        for (int i = 0; i < ALBEDO_POINTS; i++)
            highest = fmax(highest, panel->curves[c].y[i]);
    plot_set_range(&panel->panel.x, 0.0, 90.0);
    panel->panel.x.is_degrees = true;
    panel->panel.y.scale = plot_scale(p);
    if (!p->desc->is_logarithmic)
        plot_set_range(&panel->panel.y, 0.0, highest > 1.005 ? ceil(highest * 5.0) / 5.0 : 1.0);
    panel->panel.note = plot_text(p, "%sintegral of BRDF times N.L over the light, within 0.001%s; %s",
                                  plot_fit_note(p), p->has_channels ? "" : "; luminance",
                                  plot_energy(p->desc) == FACET_ENERGY_CONSERVING
                                      ? "energy-conserving"
                                      : "formulas of glTF, without multiple scattering");
    return plot_finish(p, "Directional albedo", 1, 960, 640);
}

/* ---- white furnace ---- */

enum { FURNACE_POINTS = 26, MODES = 2, WAYS = 2 /* punctual lights, image-based lighting */ };

static float roughness_at(int i)
{
    return 0.05f + 0.95f * (float)i / (FURNACE_POINTS - 1);
}

/* The material with that roughness in all of its layers; for OpenGL 1 the corresponding shininess. */
static facet_plot_material with_roughness(const facet_plot_material *from, float roughness)
{
    facet_plot_material m = *from;
    m.perceptual_roughness = roughness;
    if (m.sheen_color[0] > 0.0f || m.sheen_color[1] > 0.0f || m.sheen_color[2] > 0.0f)
        m.sheen_roughness = roughness;
    if (m.clearcoat > 0.0f)
        m.clearcoat_roughness = roughness;
    m.shininess = shininess_from_perceptual_roughness(roughness);
    return m;
}

typedef struct furnace_subject {
    facet_plot_material parameters;
    const char *title;
} furnace_subject;

typedef struct furnace_work {
    const plot *plot;
    const furnace_subject *subjects;
    double *albedo; /* per subject, angle, mode, way: FURNACE_POINTS */
} furnace_work;

static void integrate_furnace(void *context, size_t begin, size_t end)
{
    const furnace_work *work = context;
    for (size_t i = begin; i < end; i++) {
        size_t series = i / FURNACE_POINTS;
        bool is_image_based = series % WAYS;
        facet_energy energy = series / WAYS % MODES ? FACET_ENERGY_CONSERVING : FACET_ENERGY_GLTF;
        size_t angle = series / (WAYS * MODES) % work->plot->angle_count;
        const furnace_subject *subject = &work->subjects[series / (WAYS * MODES) / work->plot->angle_count];
        material m = {.parameters =
                          with_roughness(&subject->parameters, roughness_at((int)(i % FURNACE_POINTS))),
                      .label = "",
                      .energy = energy,
                      .has_separable_smith = work->plot->desc->has_separable_smith};
        float V[3];
        double albedo[3];
        plot_direction((double)work->plot->angles[angle], 0.0, V);
        if (m.parameters.model != FACET_PLOT_MODEL_PBR && series % (WAYS * MODES) > 0)
            continue; /* OpenGL 1 has one way and one mode */
        if (is_image_based)
            material_albedo_image_based(&m, V, albedo);
        else
            material_albedo(&m, V, albedo);
        work->albedo[i] = material_luminance(albedo);
    }
}

static const furnace_subject *subjects_of(plot *p, uint32_t *count)
{
    furnace_subject *subjects = plot_alloc(p, FACET_PLOT_MAX_MATERIALS, sizeof *subjects);
    *count = 0;
    if (!subjects)
        return NULL;
    if (p->has_default_materials) {
        static const char *const titles[4] = {"white metal", "white dielectric",
                                              "white dielectric under a coat",
                                              "white dielectric under white sheen"};
        for (*count = 0; *count < 4; ++*count) {
            facet_plot_material m = material_default();
            m.metallic = *count == 0;
            m.clearcoat = *count == 2;
            for (int c = 0; c < 3; c++)
                m.sheen_color[c] = *count == 3;
            subjects[*count] = (furnace_subject){.parameters = m, .title = titles[*count]};
        }
        return subjects;
    }
    for (uint32_t k = 0; k < p->subject_count; k++)
        if (!p->subjects[k].is_fit)
            subjects[(*count)++] = (furnace_subject){.parameters = p->subjects[k].material.parameters,
                                                     .title = p->subjects[k].material.label};
    return subjects;
}

static void add_panel(plot *p, const furnace_subject *subject, const double *x, const double *albedo)
{
    static const char *const names[MODES][WAYS] = {{"glTF, punctual", "glTF, environment"},
                                                   {"conserving, punctual", "conserving, environment"}};
    bool is_pbr = subject->parameters.model == FACET_PLOT_MODEL_PBR;
    plot_panel *panel = plot_add_panel(
        p, CHART_XY, subject->title, is_pbr ? "perceptual roughness" : "perceptual roughness of equal width",
        "returned fraction of the light");
    if (!panel)
        return;
    for (uint32_t a = 0; a < p->angle_count; a++)
        for (uint32_t series = 0; series < (is_pbr ? MODES * WAYS : 1); series++) {
            const char *name = is_pbr ? names[series / WAYS][series % WAYS] : "OpenGL 1";
            if (p->angle_count > 1)
                name = plot_text(p, "%s, %s\u00b0", name, plot_degrees(p, (double)p->angles[a]));
            plot_add_line(p, panel, name, plot_color(series, (int)(a % 4)), FURNACE_POINTS, x,
                          albedo + ((size_t)a * MODES * WAYS + series) * FURNACE_POINTS);
        }
    plot_set_range(&panel->panel.x, 0.0, 1.0);
    panel->panel.note = is_pbr ? "1: nothing lost, nothing gained"
                               : "radiance over pi; OpenGL 1 may return more than it receives";
}

facet_result plot_make_furnace(plot *p)
{
    uint32_t subject_count;
    const furnace_subject *subjects = subjects_of(p, &subject_count);
    size_t per_subject = (size_t)p->angle_count * MODES * WAYS * FURNACE_POINTS;
    furnace_work work = {
        .plot = p, .subjects = subjects, .albedo = plot_values(p, per_subject * subject_count)};
    double *x = plot_values(p, FURNACE_POINTS);
    if (p->has_failed)
        return plot_finish(p, "", 1, 0, 0);
    for (int i = 0; i < FURNACE_POINTS; i++)
        x[i] = (double)roughness_at(i);
    parallel_for(p->desc->thread_count, per_subject * subject_count, 1, integrate_furnace, &work);
    for (uint32_t k = 0; k < subject_count; k++)
        add_panel(p, &subjects[k], x, work.albedo + k * per_subject);
    double highest = 1.0;
    for (size_t i = 0; i < per_subject * subject_count; i++)
        highest = fmax(highest, work.albedo[i]);
    for (uint32_t k = 0; k < p->panel_count; k++) {
        plot_set_range(&p->panels[k].panel.y, 0.0, ceil(highest * 5.0 + 0.25) / 5.0);
        p->panels[k].panel.has_legend =
            k == 0 || subjects[k].parameters.model != subjects[0].parameters.model;
    }
    uint32_t columns = subject_count < 2 ? 1 : subject_count < 5 ? 2 : subject_count < 10 ? 3 : 4;
    uint32_t rows = (subject_count + columns - 1) / columns;
    return plot_finish(p, "White furnace: returned fraction of light from everywhere", columns,
                       columns == 1 ? 960 : 560 * columns, columns == 1 ? 640 : 430 * rows + 60);
}
