/* curves.c - see curves.h. */
#include "report/curves.h"

#include <math.h>

#include "base/result.h"
#include "legacy/fit.h"
#include "plot/chart.h"

enum { VIEWS = 3, STEPS = 361 }; /* half a degree: a lobe of shininess 1000 is 8 wide */
static const double PI = 3.14159265358979323846;
static const double VIEW_ANGLES[VIEWS] = {0.0, 30.0, 60.0};
static const char *const VIEW_TITLES[VIEWS] = {"seen at 0\xc2\xb0", "seen at 30\xc2\xb0",
                                               "seen at 60\xc2\xb0"};

static double luminance(const float rgb[3])
{
    return 0.2126 * (double)rgb[0] + 0.7152 * (double)rgb[1] + 0.0722 * (double)rgb[2];
}

typedef struct pair {
    ogl1_surface ogl1;
    pbr_surface pbr;
    bool is_from_ogl1;
} pair;

/* x, and y of the source and of what was made of it. */
static void sample(const pair *p, double view_degrees, double *x, double *source, double *made)
{
    double view = view_degrees * PI / 180.0;
    const float V[3] = {(float)sin(view), 0.0f, (float)cos(view)};
    for (int i = 0; i < STEPS; i++) {
        x[i] = -90.0 + 180.0 * i / (STEPS - 1);
        double angle = x[i] * PI / 180.0;
        const float L[3] = {(float)sin(angle), 0.0f, (float)fmax(cos(angle), 0.0)};
        float old[3];
        float new[3];
        ogl1_radiance(&p->ogl1, V, L, old);
        pbr_radiance(&p->pbr, PBR_CORRELATED, V, L, new);
        source[i] = luminance(p->is_from_ogl1 ? old : new);
        made[i] = luminance(p->is_from_ogl1 ? new : old);
    }
}

static bool make_panel(const pair *p, int view, arena *memory, chart_panel *panel)
{
    double *x = arena_alloc(memory, STEPS, sizeof *x);
    double *source = arena_alloc(memory, STEPS, sizeof *source);
    double *made = arena_alloc(memory, STEPS, sizeof *made);
    chart_curve *curves = arena_zalloc(memory, 2, sizeof *curves);
    if (!x || !source || !made || !curves)
        return false;
    sample(p, VIEW_ANGLES[view], x, source, made);
    curves[0] =
        (chart_curve){.name = p->is_from_ogl1 ? "OpenGL 1" : "PBR", .count = STEPS, .x = x, .y = source};
    curves[1] = (chart_curve){.name = p->is_from_ogl1 ? "PBR" : "OpenGL 1",
                              .count = STEPS,
                              .x = x,
                              .y = made,
                              .style = {.color = 1, .dash = 1}};
    *panel = (chart_panel){.kind = CHART_XY,
                           .title = VIEW_TITLES[view],
                           .note = "",
                           .x = {.label = "light, degrees", .has_range = true, .minimum = -90, .maximum = 90},
                           .y = {.label = view == 0 ? "luminance" : ""},
                           .curve_count = 2,
                           .curves = curves,
                           .has_legend = view == 0};
    return true;
}

facet_result curves_draw(const facet_scene *scene, uint32_t material, unsigned char **bytes, size_t *size,
                         facet_error *error)
{
    const material_conversion *m = &scene->conversion->materials[material];
    pair p = {.is_from_ogl1 = scene->conversion->to != FACET_MATERIAL_MODEL_OGL1};
    p.ogl1 = m->ogl1_surface;
    p.pbr = m->pbr_surface;
    *bytes = NULL;
    *size = 0;
    arena *memory = arena_create(&scene->allocator);
    chart_panel *panels = memory ? arena_zalloc(memory, VIEWS, sizeof *panels) : NULL;
    bool is_made = panels != NULL;
    for (int i = 0; i < VIEWS && is_made; i++)
        is_made = make_panel(&p, i, memory, &panels[i]);
    const chart c = {.memory = memory,
                     .title = "",
                     .width = CURVES_WIDTH,
                     .height = CURVES_HEIGHT,
                     .columns = VIEWS,
                     .panel_count = VIEWS,
                     .panels = panels};
    facet_result result = is_made
                              ? chart_draw(&c, FACET_PLOT_FORMAT_SVG, &scene->allocator, bytes, size, error)
                              : fail_memory(error, "report", 0);
    arena_destroy(memory);
    return result;
}
