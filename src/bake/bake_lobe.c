/* bake_lobe.c - see bake_lobe.h. */
#include "bake/bake_lobe.h"

#include <math.h>

#include "bake/bake.h"
#include "ibl/gauss.h"

static const double pi = 3.14159265358979323846;

bake_lobe bake_lobe_create(facet_lobe kind, float perceptual_roughness)
{
    float r = perceptual_roughness;
    if (kind == FACET_LOBE_CHARLIE && r < BAKE_CHARLIE_LEAST)
        r = BAKE_CHARLIE_LEAST;
    bake_lobe lobe = {.kind = kind, .alpha = kind == FACET_LOBE_LAMBERT ? 1.0 : (double)r * (double)r};
    lobe.width = 2.0 * lobe.alpha;
    return lobe;
}

double bake_lobe_weight(const bake_lobe *lobe, double s2)
{
    double x = 1.0 - 2.0 * s2;
    if (lobe->kind == FACET_LOBE_CHARLIE)
        return s2 > 0.0 ? x * pow(2.0 * s2, 0.5 / lobe->alpha) : 0.0;
    double a2 = lobe->alpha * lobe->alpha;
    double d = a2 + (1.0 - a2) * s2;
    return x / (d * d);
}

/* ---- sampling ---- */

enum { PANELS = 2048 };

/* Where panel i begins: s^2 in [0, 1/2], narrow where the lobe is. */
static double panel_start(const bake_lobe *lobe, uint32_t i)
{
    double u = (double)i / PANELS;
    if (lobe->kind == FACET_LOBE_CHARLIE)
        return 0.5 * (1.0 - pow(1.0 - u, 3.0)); /* towards the horizon */
    /* as the weight without its cosine is distributed: that of 1 / (a^2 + (1 - a^2) s^2)^2 */
    double a2 = lobe->alpha * lobe->alpha;
    if (a2 > 0.5)
        return 0.5 * u;
    double most = 0.5 / (a2 + (1.0 - a2) * 0.5);
    double share = u * most; /* of s^2 / (a^2 + (1 - a^2) s^2) */
    return a2 * share / (1.0 - (1.0 - a2) * share);
}

/* Integral of the weight over s^2; solid angle is 4 pi ds^2. */
static double panel_weight(const bake_lobe *lobe, double from, double to)
{
    double sum = 0.0;
    for (int i = 0; i < 8; i++) {
        double w;
        double s2 = gauss_8(i, from, to, &w);
        sum += w * bake_lobe_weight(lobe, s2);
    }
    return sum;
}

void bake_lobe_sample(const bake_lobe *lobe, uint32_t count, float *s2, float *pdf)
{
    double whole = 0.0;
    for (uint32_t i = 0; i < PANELS; i++)
        whole += panel_weight(lobe, panel_start(lobe, i), panel_start(lobe, i + 1));
    uint32_t panel = 0;
    double before = 0.0; /* weight of the panels before */
    double own = panel_weight(lobe, 0.0, panel_start(lobe, 1));
    for (uint32_t i = 0; i < count; i++) {
        double goal = (i + 0.5) / count * whole;
        while (before + own < goal && panel + 1 < PANELS) {
            before += own;
            panel++;
            own = panel_weight(lobe, panel_start(lobe, panel), panel_start(lobe, panel + 1));
        }
        double low = panel_start(lobe, panel);
        double high = panel_start(lobe, panel + 1);
        double from = low;
        for (int step = 0; step < 30; step++) { /* bisection: the weight may be 0 at either end */
            double middle = 0.5 * (low + high);
            if (before + panel_weight(lobe, from, middle) < goal)
                low = middle;
            else
                high = middle;
        }
        double at = 0.5 * (low + high);
        s2[i] = (float)at;
        pdf[i] = (float)(bake_lobe_weight(lobe, at) / (4.0 * pi * whole));
    }
}
