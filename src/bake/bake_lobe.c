/* bake_lobe.c - see bake_lobe.h. */
#include "bake/bake_lobe.h"

#include <math.h>

#include "ibl/gauss.h"
#include "ibl/prefilter.h"

static const double pi = 3.14159265358979323846;

bake_lobe bake_lobe_create(facet_lobe kind, float perceptual_roughness)
{
    float r = perceptual_roughness;
    if (kind == FACET_LOBE_CHARLIE && r < BAKE_CHARLIE_MIN)
        r = BAKE_CHARLIE_MIN;
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

/* Share of a lobe's root mean square that truncated harmonics may lose; twice as much is still more accurate
 * than sampling. It is the error of a sun alone in the dark. The edge of a ring needs twice the degrees for a
 * third of the error. */
static const double aimed_cut = 2e-3;
static const double aimed_cut_of_ring = 6e-3;

bool bake_lobe_kernel(const bake_lobe *lobe, float *kernel, uint32_t *degree)
{
    double cut;
    bool is_ring = lobe->kind == FACET_LOBE_CHARLIE;
    double aim = is_ring ? aimed_cut_of_ring : aimed_cut;
    *degree = prefilter_choose_degree(is_ring ? PREFILTER_CHARLIE : PREFILTER_GGX, (float)sqrt(lobe->alpha),
                                      aim, kernel, &cut);
    if (cut > 2.0 * aim)
        return false;
    prefilter_taper(*degree, kernel);
    return true;
}

/* ---- shares ---- */

/* Start of panel i: s^2 in [0, 1/2], panels narrow where the lobe is concentrated. */
static double panel_start(const bake_lobe *lobe, uint32_t i)
{
    double u = (double)i / BAKE_LOBE_PANELS;
    double a2 = lobe->alpha * lobe->alpha;
    if (lobe->kind == FACET_LOBE_CHARLIE)
        return 0.5 * (1.0 - pow(1.0 - u, 3.0)); /* concentrated towards the horizon */
    if (a2 > 0.5)
        return 0.5 * u;
    /* equal shares of the weight without its cosine: s^2 / (a^2 + (1 - a^2) s^2) */
    double share = u * 0.5 / (a2 + (1.0 - a2) * 0.5);
    return a2 * share / (1.0 - (1.0 - a2) * share);
}

/* Integral of the weight over s^2; solid angle is 4 pi ds^2. */
static double integrate(const bake_lobe *lobe, double from, double to)
{
    double sum = 0.0;
    for (int i = 0; i < 8; i++) {
        double w;
        double s2 = gauss_8(i, from, to, &w);
        sum += w * bake_lobe_weight(lobe, s2);
    }
    return sum;
}

void bake_lobe_share_init(const bake_lobe *lobe, bake_lobe_shares *out)
{
    out->lobe = *lobe;
    out->edges[0] = out->before[0] = 0.0;
    for (uint32_t i = 0; i < BAKE_LOBE_PANELS; i++) {
        out->edges[i + 1] = panel_start(lobe, i + 1);
        out->before[i + 1] = out->before[i] + integrate(lobe, out->edges[i], out->edges[i + 1]);
    }
}

double bake_lobe_find(const bake_lobe_shares *shares, double share)
{
    double goal = share * shares->before[BAKE_LOBE_PANELS];
    uint32_t panel = 0;
    for (uint32_t step = BAKE_LOBE_PANELS / 2; step > 0; step /= 2)
        if (shares->before[panel + step] <= goal)
            panel += step;
    double low = shares->edges[panel];
    double high = shares->edges[panel + 1];
    for (int step = 0; step < 26; step++) { /* bisection: the weight may be 0 at either end */
        double middle = 0.5 * (low + high);
        if (shares->before[panel] + integrate(&shares->lobe, shares->edges[panel], middle) < goal)
            low = middle;
        else
            high = middle;
    }
    return 0.5 * (low + high);
}

double bake_lobe_pdf(const bake_lobe_shares *shares, double s2)
{
    return bake_lobe_weight(&shares->lobe, s2) / (4.0 * pi * shares->before[BAKE_LOBE_PANELS]);
}
