/* plot_error.c - how far the two models are apart after each method of conversion (legacy/fit.h), over roughness or
 * shininess. */
#include <math.h>

#include "base/parallel.h"
#include "plot/plot_build.h"

enum { METHODS = 5 };

static const char *const names_to_ogl1[METHODS] = {"naive", "closed", "fit, displayable", "fit, unlimited",
                                                   "display fit, E_display"};
static const char *const names_to_pbr[METHODS] = {"naive", "closed, core glTF", "fit, core glTF",
                                                  "closed, specular and ior", "fit, specular and ior"};

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

plot_panel *plot_add_errors(plot *p, const facet_plot_material *m, const char *title, uint32_t point_count)
{
    bool is_pbr = m->model == FACET_PLOT_MODEL_PBR;
    double *x = plot_numbers(p, point_count);
    error_work work = {.metric = plot_metric(p),
                       .material = m,
                       .x = x,
                       .errors = plot_numbers(p, (size_t)METHODS * point_count),
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
            plot_add_errors(p, &m, defaults[count].title,
                            m.model == FACET_PLOT_MODEL_PBR ? POINTS_PBR : POINTS_OGL1);
        }
    }
    for (uint32_t k = 0; !p->has_default_materials && k < p->subject_count; k++, count++) {
        const material *m = &p->subjects[k].material;
        plot_add_errors(p, &m->parameters, m->label,
                        m->parameters.model == FACET_PLOT_MODEL_PBR ? POINTS_PBR : POINTS_OGL1);
    }
    uint32_t columns = count < 2 ? 1 : count < 5 ? 2 : 3;
    uint32_t rows = count ? (count + columns - 1) / columns : 1;
    return plot_finish(p, "Error of conversions between OpenGL 1 and PBR", columns,
                       columns == 1 ? 960 : 580 * columns, columns == 1 ? 640 : 430 * rows + 60);
}
