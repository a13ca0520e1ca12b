/* plot_tone.c - tone mapping: what a display shows of a gray of scene light. All operators of shade/tonemap.h. */
#include <math.h>

#include "plot/plot_build.h"

#include "shade/shade.h"

enum { POINTS = 481 };

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
        double *y = plot_add_curve(p, panel, operators[k].name, plot_color(k, k == 0 ? 1 : 0), POINTS, x);
        for (int i = 0; y && i < POINTS; i++) {
            float shown = tonemap(operators[k].op, vec3((float)light[i]))[1];
            y[i] = (double)(is_encoded ? srgb_from_linear1(shown) : shown);
        }
    }
}

facet_result plot_make_tone(plot *p)
{
    plot_panel *stops = plot_add_panel(p, CHART_XY, "over stops", "scene light, stops over middle gray 0.18",
                                       "display, sRGB-encoded");
    const double *x = plot_steps(p, POINTS, -STOPS, STOPS);
    double *light = plot_numbers(p, POINTS);
    for (int i = 0; light && x && i < POINTS; i++)
        light[i] = MIDDLE_GRAY * (exp2)(x[i]);
    add_operators(p, stops, x, light, true);
    plot_panel *linear =
        plot_add_panel(p, CHART_XY, "over scene light", "scene light, linear, 1: white", "display, linear");
    const double *even = plot_steps(p, POINTS, 0.0, 4.0);
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
