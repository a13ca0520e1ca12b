/* fit_to_ogl1.c - PBR to OpenGL 1 by search. With the exponent given, the old model is linear in Cd and Cs; so the search
 * is along the exponent alone. */
#include <math.h>
#include <string.h>

#include "legacy/fit_linear.h"
#include "legacy/fit_minimize.h"

#include "shade/shade.h"

static const double unlimited_shininess = 1e9; /* beyond that of the smoothest GGX lobe that is drawn */

typedef struct search {
    fit_problem problem;
    fit_bounds bounds[3];
    double factor[3][2]; /* Cd, Cs */
} search;

/* x is log(1 + s): each step changes the highlight's width by the same factor. */
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
    return remarks | (out->shininess > 0.998f * OGL1_MOST_SHININESS ? (uint32_t)FIT_SHININESS_CLAMPED : 0u);
}

uint32_t pbr_to_ogl1_fit(const fit_metric *metric, const pbr_surface *in, facet_legacy_target target,
                         fit_range range, ogl1_surface *out)
{
    search s;
    fit_problem_from_pbr(&s.problem, metric, target, in);
    memcpy(s.problem.shape[0], metric->NdotL, sizeof metric->NdotL);
    memset(s.problem.rest, 0, sizeof s.problem.rest);
    double most = range == FIT_DISPLAYABLE ? (double)OGL1_MOST_SHININESS : unlimited_shininess;
    double highest = range == FIT_DISPLAYABLE ? 1.0 : 1e12;
    for (int k = 0; k < 3; k++)
        s.bounds[k] = (fit_bounds){{0.0, 0.0}, {highest, highest}};
    double x;
    int count = range == FIT_DISPLAYABLE ? 25 : 65;
    fit_minimize_1(error_at, &s, 0.0, log1p(most), count, 1e-3, &x);
    bool has_highlight = false;
    for (int k = 0; k < 3; k++) {
        out->diffuse[k] = (float)s.factor[k][0];
        out->specular[k] = (float)s.factor[k][1];
        has_highlight = has_highlight || out->specular[k] > 0.0f;
    }
    out->shininess = has_highlight ? (float)fmin(expm1(x), most) : 0.0f;
    return range == FIT_DISPLAYABLE ? fit_remarks_to_ogl1(in, out) : 0u;
}
