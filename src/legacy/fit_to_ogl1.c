/* fit_to_ogl1.c - PBR to OpenGL 1 by fitting. For a given exponent OpenGL 1 is linear in Cd and Cs; the
 * search is along the exponent. */
#include <math.h>
#include <string.h>

#include "legacy/fit_linear.h"
#include "legacy/fit_minimize.h"

#include "shade/shade.h"

static const double unlimited_shininess = 1e9; /* above that of the smoothest GGX lobe of the renderer */

/* The smallest exponent for display values. A broader highlight would imitate the brighter shadow side of
 * linear light, but programs that do not gate highlights by N.L show it on unlit sides, and others as
 * white. */
static const double least_drawn_shininess = 2.0;

typedef struct search {
    fit_problem problem;
    fit_bounds bounds[3];
    double factor[3][2]; /* Cd, Cs */
} search;

/* x is log(1 + s): steps scale the width of the highlight. */
static double error_at(void *context, const double *x)
{
    search *s = context;
    fit_highlight(s->problem.metric, (float)expm1(*x), s->problem.shape[1]);
    return fit_factors(&s->problem, s->bounds, s->factor);
}

uint32_t fit_remarks_to_ogl1(const pbr_surface *in, const ogl1_surface *out)
{
    uint32_t remarks = 0;
    for (int k = 0; k < 3; k++) {
        remarks |= out->specular[k] >= 1.0f ? (uint32_t)FIT_SPECULAR_CLAMPED : 0u;
        remarks |= out->diffuse[k] > 0.02f && in->metallic > 0.5f ? (uint32_t)FIT_METAL_WITH_DIFFUSE : 0u;
        remarks |= out->specular[k] > 0.02f && out->shininess < 4.0f ? (uint32_t)FIT_LOW_EXPONENT : 0u;
    }
    /* the search ends a little before the bound */
    return remarks | (out->shininess > 0.998f * OGL1_MAX_SHININESS ? (uint32_t)FIT_SHININESS_CLAMPED : 0u);
}

static void begin(search *s, const fit_metric *metric, const pbr_surface *in, facet_legacy_target target,
                  double highest)
{
    fit_problem_from_pbr(&s->problem, metric, target, in);
    memcpy(s->problem.shape[0], metric->NdotL, sizeof metric->NdotL);
    memset(s->problem.rest, 0, sizeof s->problem.rest);
    for (int k = 0; k < 3; k++)
        s->bounds[k] = (fit_bounds){{0.0, 0.0}, {highest, highest}};
}

/* Stores the colors; returns whether there is a highlight. */
static bool read_colors(const search *s, facet_legacy_target target, ogl1_surface *out)
{
    bool has_highlight = false;
    bool is_drawn = target == FACET_LEGACY_TARGET_DRAWN;
    for (int k = 0; k < 3; k++) {
        float Cd = (float)s->factor[k][0];
        float Cs = (float)s->factor[k][1];
        out->diffuse[k] = is_drawn ? fit_display_light(Cd) : Cd;
        out->specular[k] = is_drawn ? fit_display_light(Cs) : Cs;
        has_highlight = has_highlight || out->specular[k] > 0.0f;
    }
    return has_highlight;
}

uint32_t pbr_to_ogl1_fit(const fit_metric *metric, const pbr_surface *in, facet_legacy_target target,
                         fit_range range, ogl1_surface *out)
{
    search s;
    double x;
    double most = range == FIT_DISPLAYABLE ? (double)OGL1_MAX_SHININESS : unlimited_shininess;
    double least = target == FACET_LEGACY_TARGET_DRAWN ? log1p(least_drawn_shininess) : 0.0;
    begin(&s, metric, in, target, range == FIT_DISPLAYABLE ? 1.0 : 1e12);
    fit_minimize_1(error_at, &s, least, log1p(most), range == FIT_DISPLAYABLE ? 25 : 65, 1e-3, &x);
    out->shininess = read_colors(&s, target, out) ? (float)fmin(expm1(x), most) : 0.0f;
    return range == FIT_DISPLAYABLE ? fit_remarks_to_ogl1(in, out) : 0u;
}

void pbr_to_ogl1_fit_at(const fit_metric *metric, const pbr_surface *in, facet_legacy_target target,
                        float shininess, ogl1_surface *out)
{
    search s;
    begin(&s, metric, in, target, 1.0);
    error_at(&s, (const double[1]){log1p((double)shininess)});
    read_colors(&s, target, out);
    out->shininess = shininess;
}
