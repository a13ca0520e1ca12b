/* fit_closed_ogl1.c - PBR to OpenGL 1 without a quadrature: linear least squares with integrals from a table (fit_gram.h), and a
 * search along the exponent where it is open. */
#include <math.h>

#include "legacy/fit_gram.h"
#include "legacy/fit_linear.h"
#include "legacy/fit_minimize.h"

#include "shade/shade.h"

typedef struct search {
    fit_gram gram;
    gram_place roughness;
    fit_lobes lobes;
    double factor[3][2]; /* Cd, Cs */
} search;

/* Square of the difference, less what the source alone has; x: log(1 + s). */
static double square_at(void *context, const double *x)
{
    static const fit_bounds displayable = {{0.0, 0.0}, {1.0, 1.0}};
    search *s = context;
    fit_gram *g = &s->gram;
    gram_place shininess = fit_gram_shininess(g, expm1(*x));
    fit_gram_both(g, &s->roughness, &shininess);
    double sum = 0.0;
    for (int k = 0; k < 3; k++) {
        double d0 = (double)s->lobes.diffuse[k] * (1.0 - (double)s->lobes.shade[0]);
        double d1 = (double)s->lobes.diffuse[k] * (double)(s->lobes.shade[0] - s->lobes.shade[1]);
        double F0 = (double)s->lobes.F0[k];
        double F1 = (double)s->lobes.F90[k] - F0;
        fit_moments m = {{g->nn[0], g->nP[0], g->PP},
                         {d0 * g->nn[0] + d1 * g->nn[1] + F0 * g->nS[0] + F1 * g->nS[1],
                          d0 * g->nP[0] + d1 * g->nP[1] + F0 * g->SP[0] + F1 * g->SP[1]},
                         0.0};
        sum += fit_box(&m, &displayable, s->factor[k]);
    }
    return sum;
}

static void start(search *s, const pbr_surface *in)
{
    s->lobes = fit_lobes_of(in);
    s->roughness = fit_gram_roughness(&s->gram, (double)in->perceptual_roughness);
}

static uint32_t finish(const search *s, const pbr_surface *in, double shininess, ogl1_surface *out)
{
    bool has_highlight = false;
    for (int k = 0; k < 3; k++) {
        out->diffuse[k] = (float)s->factor[k][0];
        out->specular[k] = (float)s->factor[k][1];
        has_highlight = has_highlight || out->specular[k] > 0.0f;
    }
    out->shininess = has_highlight ? (float)shininess : 0.0f;
    return fit_remarks_to_ogl1(in, out);
}

uint32_t pbr_to_ogl1_closed(const pbr_surface *in, ogl1_surface *out)
{
    search s;
    double x;
    start(&s, in);
    fit_minimize_1(square_at, &s, 0.0, log1p((double)OGL1_MOST_SHININESS), 15, 0.01, &x);
    return finish(&s, in, fmin(expm1(x), (double)OGL1_MOST_SHININESS), out);
}

uint32_t pbr_to_ogl1_closed_at(const pbr_surface *in, float shininess, ogl1_surface *out)
{
    search s;
    start(&s, in);
    square_at(&s, (const double[1]){log1p((double)shininess)});
    uint32_t remarks = finish(&s, in, (double)shininess, out);
    out->shininess = shininess;
    return remarks;
}
