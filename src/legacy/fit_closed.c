/* fit_closed.c - conversions without quadrature: the roughness whose lobe is nearest to Blinn's, and
 * linear least squares with integrals from the LUT of fit_table_generate.c; and the usual formulas, which
 * the others are measured against. */
#include <math.h>
#include <string.h>

#include "legacy/fit.h"
#include "legacy/fit_linear.h"
#include "legacy/fit_minimize.h"
#include "legacy/fit_table.h"

#include "shade/shade.h"

/* ---- integrals of the shapes, by a LUT ---- */

/* Products of the shapes that both models are made of: n = N.L, S = pi D V N.L of a roughness, P =
 * (N.H)^s. The index is the power of w, Schlick's weight. Integrals over all views and lights of
 * fit_metric, with height-correlated masking. */
typedef struct fit_gram {
    double nn[3];
    double nS[3], SS[3];
    double nP[2], PP;
    double SP[2];
} fit_gram;

typedef struct gram_place {
    int first;        /* first of four nodes */
    double weight[4]; /* weights of the logarithms */
} gram_place;

/* The four nodes around x (in nodes from the first) and their Lagrange weights. */
static gram_place gram_find(double x, int count)
{
    gram_place p;
    double node = fmin(fmax(x, 0.0), count - 1.0);
    int first = (int)node - 1;
    p.first = first < 0 ? 0 : first > count - 4 ? count - 4 : first;
    double t = node - p.first;
    p.weight[0] = (t - 1.0) * (t - 2.0) * (t - 3.0) / -6.0;
    p.weight[1] = t * (t - 2.0) * (t - 3.0) / 2.0;
    p.weight[2] = t * (t - 1.0) * (t - 3.0) / -2.0;
    p.weight[3] = t * (t - 1.0) * (t - 2.0) / 6.0;
    return p;
}

static double gram_mean_log(const float *logs, const double *weight)
{
    return (double)logs[0] * weight[0] + (double)logs[1] * weight[1] + (double)logs[2] * weight[2] +
           (double)logs[3] * weight[3];
}

static double gram_value(const float *logs, const gram_place *p)
{
    return exp(gram_mean_log(logs + p->first, p->weight));
}

/* Each fills the products that depend on its argument, in any order, but _both last. Roughness in [0, 1],
 * s >= 0. */
static gram_place gram_roughness(fit_gram *gram, double perceptual_roughness)
{
    gram_place p = gram_find((log(fmax(perceptual_roughness, 1e-9)) - GRAM_LOG_R) / GRAM_STEP_R, GRAM_R);
    const fit_table *table = fit_table_get();
    for (int k = 0; k < 3; k++) {
        gram->nS[k] = gram_value(table->nS[k], &p);
        gram->SS[k] = gram_value(table->SS[k], &p);
        gram->nn[k] = (double)table->nn[k];
    }
    return p;
}

static gram_place gram_shininess(fit_gram *gram, double shininess)
{
    gram_place p = gram_find(log1p(fmax(shininess, 0.0)) / GRAM_STEP_S, GRAM_S);
    const fit_table *table = fit_table_get();
    gram->nP[0] = gram_value(table->nP[0], &p);
    gram->nP[1] = gram_value(table->nP[1], &p);
    gram->PP = gram_value(table->PP, &p);
    return p;
}

static void gram_both(fit_gram *gram, const gram_place *roughness, const gram_place *shininess)
{
    const fit_table *table = fit_table_get();
    double sum[2] = {0.0, 0.0};
    for (int i = 0; i < 4; i++) {
        int at = (roughness->first + i) * GRAM_S + shininess->first;
        sum[0] += roughness->weight[i] * gram_mean_log(table->SP[0] + at, shininess->weight);
        sum[1] += roughness->weight[i] * gram_mean_log(table->SP[1] + at, shininess->weight);
    }
    gram->SP[0] = exp(sum[0]);
    gram->SP[1] = exp(sum[1]);
}

/* ---- the lobe nearest to Blinn's ---- */

/* Roughness and factors of n and S that approximate P: P = u n + g S. */
typedef struct fit_nearest {
    double perceptual_roughness, g;
} fit_nearest;

/* Linear interpolation, which keeps monotonicity; extrapolated with the last slope. */
static double gram_along(const float *logs, double x)
{
    double node = fmax(x, 0.0);
    int first = node < GRAM_S - 2.0 ? (int)node : GRAM_S - 2;
    double t = node - first;
    return (double)logs[first] * (1.0 - t) + (double)logs[first + 1] * t;
}

static fit_nearest gram_nearest(double shininess)
{
    double x = log1p(fmax(shininess, 0.0)) / GRAM_STEP_S;
    const fit_table *table = fit_table_get();
    return (fit_nearest){exp(gram_along(table->nearest_r, x)), exp(gram_along(table->nearest_g, x))};
}

/* The inverse; at most 1e5. */
static double gram_nearest_shininess(double perceptual_roughness)
{
    static const double most = 1e5;
    double wanted = log(fmax(perceptual_roughness, 1e-9));
    if (wanted >= 0.0)
        return 0.0;
    const float *nearest_r = fit_table_get()->nearest_r;
    int first = 0;
    int end = GRAM_S - 1;
    while (end - first > 1) { /* decreasing */
        int middle = (first + end) / 2;
        if ((double)nearest_r[middle] > wanted)
            first = middle;
        else
            end = middle;
    }
    double a = (double)nearest_r[first];
    double b = (double)nearest_r[first + 1];
    return fmin(expm1((first + (a - wanted) / (a - b)) * GRAM_STEP_S), most);
}

/* ---- OpenGL 1 to PBR ---- */

/* The optimal roughness for exponents from 0 to 10^8 is near alpha = 1.5 / sqrt(s), the optimal strength
 * near 8.5 / (s + 2); neither depends on the colors unless these are clamped. */
float perceptual_roughness_from_shininess(float shininess)
{
    return (float)gram_nearest((double)shininess).perceptual_roughness;
}

float shininess_from_perceptual_roughness(float perceptual_roughness)
{
    return (float)gram_nearest_shininess((double)perceptual_roughness);
}

float reflectance_share_from_shininess(float shininess)
{
    return (float)gram_nearest((double)shininess).g;
}

uint32_t fit_remarks_to_pbr(const ogl1_surface *in, const pbr_surface *out)
{
    uint32_t remarks = 0;
    for (int k = 0; k < 3; k++) {
        bool has_highlight = in->specular[k] > 0.02f;
        bool is_clamped = in->diffuse[k] > 1.0f || (out->base_color[k] >= 1.0f && has_highlight);
        remarks |= is_clamped ? (uint32_t)FIT_BASE_CLAMPED : 0u;
        remarks |= has_highlight && in->shininess < 4.0f ? (uint32_t)FIT_LOW_EXPONENT : 0u;
        remarks |= in->diffuse[k] + in->specular[k] > 1.0f ? (uint32_t)FIT_ENERGY_GAIN : 0u;
    }
    return remarks;
}

static fit_gram gram_of(double perceptual_roughness, double shininess)
{
    fit_gram gram;
    gram_place r = gram_roughness(&gram, perceptual_roughness);
    gram_place s = gram_shininess(&gram, shininess);
    gram_both(&gram, &r, &s);
    return gram;
}

/* ---- with extensions ---- */

/* Products of channel k of the source with n and S. */
static void wanted_of(const fit_gram *g, const ogl1_surface *in, int k, double wanted[2])
{
    double Cd = (double)in->diffuse[k];
    double Cs = (double)in->specular[k];
    wanted[0] = Cd * g->nn[0] + Cs * g->nP[0];
    wanted[1] = Cd * g->nS[0] + Cs * g->SP[0];
}

/* The strength of the lobe: F = F90 at all angles, share[k] F90 for channel k, beside A n with the optimal
 * A in [0, 1 - F90], where base is 1. The square is convex in F90: the root of its derivative is found by
 * bisection. */
static double flat_reflectance(const fit_gram *g, const ogl1_surface *in, const double share[3])
{
    double low = 0.0;
    double high = 1.0;
    for (int step = 0; step < 24; step++) {
        double F90 = 0.5 * (low + high);
        double slope = 0.0;
        for (int k = 0; k < 3; k++) {
            double wanted[2];
            double B = share[k] * F90;
            wanted_of(g, in, k, wanted);
            double A = fmax((wanted[0] - B * g->nS[0]) / g->nn[0], 0.0);
            bool is_clamped = A > 1.0 - F90;
            A = is_clamped ? 1.0 - F90 : A;
            slope += share[k] * (B * g->SS[0] + A * g->nS[0] - wanted[1]);
            slope -= is_clamped ? B * g->nS[0] + A * g->nn[0] - wanted[0] : 0.0;
        }
        if (slope < 0.0)
            low = F90;
        else
            high = F90;
    }
    return 0.5 * (low + high);
}

uint32_t ogl1_to_pbr_closed(const ogl1_surface *in, pbr_surface *out)
{
    double r = (double)perceptual_roughness_from_shininess(in->shininess);
    fit_gram g = gram_of(r, (double)in->shininess);
    float brightest = max(in->specular[0], max(in->specular[1], in->specular[2]));
    double factor[3][2];
    double share[3];
    static const fit_bounds unbounded = {{0.0, 0.0}, {1e12, 1e12}};
    for (int k = 0; k < 3; k++) {
        fit_moments m = {.shapes = {g.nn[0], g.nS[0], g.SS[0]}};
        wanted_of(&g, in, k, m.wanted);
        fit_box(&m, &unbounded, factor[k]);
    }
    double most = fmax(factor[0][1], fmax(factor[1][1], factor[2][1]));
    for (int k = 0; k < 3; k++)
        share[k] = most > 0.0 ? factor[k][1] / most : 0.0;
    double F90 = brightest > 0.0f ? flat_reflectance(&g, in, share) : 0.0;
    double a = 1.0 - F90;
    *out = pbr_surface_default();
    out->perceptual_roughness = (float)r;
    out->ior = 0.0f;
    out->specular = (float)F90;
    for (int k = 0; k < 3; k++) { /* again, with the Fresnel term of a color */
        double Cd = (double)in->diffuse[k];
        double Cs = (double)in->specular[k];
        fit_bounds bounds = {{0.0, in->specular[k] == brightest ? F90 : 0.0}, {1.0, F90}};
        fit_moments m = {{a * a * g.nn[0], a * (g.nS[0] - g.nS[1]), g.SS[0] - 2.0 * g.SS[1] + g.SS[2]},
                         {a * (Cd * g.nn[0] + Cs * g.nP[0] - F90 * g.nS[1]),
                          Cd * (g.nS[0] - g.nS[1]) + Cs * (g.SP[0] - g.SP[1]) - F90 * (g.SS[1] - g.SS[2])},
                         0.0};
        fit_box(&m, &bounds, factor[k]);
        out->base_color[k] = (float)factor[k][0];
        out->specular_color[k] = F90 > 0.0 ? clamp((float)(factor[k][1] / F90), 0.0f, 1.0f) : 1.0f;
    }
    return fit_remarks_to_pbr(in, out);
}

/* ---- without ---- */

typedef struct core_search {
    const ogl1_surface *in;
    fit_gram gram;
    gram_place shininess;
    double roughness;
    double base[3];
} core_search;

/* Square of the difference minus the constant of the source; x: roughness, metallic. The Fresnel term of
 * the lobe is mix(F0 + (1 - F0) w, base (1 - w) + w, metallic). */
static double core_square(void *context, const double *x)
{
    core_search *s = context;
    fit_gram *g = &s->gram;
    double F0 = (double)dielectric_F0(1.5f, 1.0f, vec3(1.0f))[0];
    double m = x[1];
    if (x[0] != s->roughness) {
        gram_place r = gram_roughness(g, x[0]);
        gram_both(g, &r, &s->shininess);
        s->roughness = x[0];
    }
    double a = (1.0 - m) * (1.0 - F0); /* base: a n (1 - w) + m S (1 - w) */
    double f0 = (1.0 - m) * F0;        /* rest: S (f0 + f1 w) */
    double f1 = 1.0 - f0;
    double nn = g->nn[0] - 2.0 * g->nn[1] + g->nn[2];
    double nS = g->nS[0] - 2.0 * g->nS[1] + g->nS[2];
    double SS = g->SS[0] - 2.0 * g->SS[1] + g->SS[2];
    double square = a * a * nn + 2.0 * a * m * nS + m * m * SS;
    double with_rest = a * (f0 * g->nS[0] + (f1 - f0) * g->nS[1] - f1 * g->nS[2]) +
                       m * (f0 * g->SS[0] + (f1 - f0) * g->SS[1] - f1 * g->SS[2]);
    double rest = f0 * f0 * g->SS[0] + 2.0 * f0 * f1 * g->SS[1] + f1 * f1 * g->SS[2];
    double sum = 0.0;
    for (int k = 0; k < 3; k++) {
        double Cd = (double)s->in->diffuse[k];
        double Cs = (double)s->in->specular[k];
        double source = a * (Cd * (g->nn[0] - g->nn[1]) + Cs * (g->nP[0] - g->nP[1])) +
                        m * (Cd * (g->nS[0] - g->nS[1]) + Cs * (g->SP[0] - g->SP[1]));
        double source_rest = Cd * (f0 * g->nS[0] + f1 * g->nS[1]) + Cs * (f0 * g->SP[0] + f1 * g->SP[1]);
        double base = fmin(fmax((source - with_rest) / square, 0.0), 1.0);
        s->base[k] = base;
        sum += base * (base * square - 2.0 * (source - with_rest)) + rest - 2.0 * source_rest;
    }
    return sum;
}

uint32_t ogl1_to_pbr_core_closed(const ogl1_surface *in, pbr_surface *out)
{
    core_search s = {.in = in, .roughness = -1.0};
    s.shininess = gram_shininess(&s.gram, (double)in->shininess);
    double x[2] = {(double)perceptual_roughness_from_shininess(in->shininess), 0.1};
    fit_minimize_n(core_square, &s, 2, x, (const double[2]){0.1, 0.2}, 1e-4, 60);
    *out = pbr_surface_default();
    out->perceptual_roughness = (float)x[0];
    out->metallic = (float)x[1];
    for (int k = 0; k < 3; k++)
        out->base_color[k] = (float)s.base[k];
    return fit_remarks_to_pbr(in, out);
}

/* ---- PBR to OpenGL 1: a search along the exponent where it is open ---- */

typedef struct ogl1_search {
    fit_gram gram;
    gram_place roughness;
    fit_lobes lobes;
    double factor[3][2]; /* Cd, Cs */
} ogl1_search;

/* Square of the difference minus the constant of the source; x: log(1 + s). */
static double square_at(void *context, const double *x)
{
    static const fit_bounds displayable = {{0.0, 0.0}, {1.0, 1.0}};
    ogl1_search *s = context;
    fit_gram *g = &s->gram;
    gram_place shininess = gram_shininess(g, expm1(*x));
    gram_both(g, &s->roughness, &shininess);
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

static void start(ogl1_search *s, const pbr_surface *in)
{
    s->lobes = fit_lobes_of(in);
    s->roughness = gram_roughness(&s->gram, (double)in->perceptual_roughness);
}

static uint32_t finish(const ogl1_search *s, const pbr_surface *in, double shininess, ogl1_surface *out)
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
    ogl1_search s;
    double x;
    start(&s, in);
    fit_minimize_1(square_at, &s, 0.0, log1p((double)OGL1_MAX_SHININESS), 15, 0.01, &x);
    return finish(&s, in, fmin(expm1(x), (double)OGL1_MAX_SHININESS), out);
}

uint32_t pbr_to_ogl1_closed_at(const pbr_surface *in, float shininess, ogl1_surface *out)
{
    ogl1_search s;
    start(&s, in);
    square_at(&s, (const double[1]){log1p((double)shininess)});
    uint32_t remarks = finish(&s, in, (double)shininess, out);
    out->shininess = shininess;
    return remarks;
}

/* ---- the usual formulas: equal slope variance, colors as they are ---- */

pbr_surface pbr_surface_default(void)
{
    return (pbr_surface){.base_color = {1.0f, 1.0f, 1.0f},
                         .perceptual_roughness = 1.0f,
                         .ior = 1.5f,
                         .specular = 1.0f,
                         .specular_color = {1.0f, 1.0f, 1.0f}};
}

/* Diffuse as base color, shininess to roughness, and the usual 4 % of dielectrics for specular. */
uint32_t ogl1_to_pbr_naive(const ogl1_surface *in, pbr_surface *out)
{
    uint32_t remarks = 0;
    *out = pbr_surface_default();
    for (int k = 0; k < 3; k++) {
        out->base_color[k] = clamp(in->diffuse[k], 0.0f, 1.0f);
        remarks |= in->diffuse[k] > 1.0f ? (uint32_t)FIT_BASE_CLAMPED : 0u;
    }
    out->perceptual_roughness = sqrt(alpha_from_shininess(in->shininess));
    return remarks;
}

uint32_t pbr_to_ogl1_naive(const pbr_surface *in, ogl1_surface *out)
{
    vec3 color = vec3(in->specular_color[0], in->specular_color[1], in->specular_color[2]);
    vec3 F0 = dielectric_F0(in->ior, in->specular, color);
    float alpha = max(alpha_from_roughness(in->perceptual_roughness), ALPHA_DELTA);
    float shininess = shininess_from_alpha(alpha);
    for (int k = 0; k < 3; k++) {
        out->diffuse[k] = in->base_color[k] * (1.0f - in->metallic);
        out->specular[k] = mix(F0[k], in->base_color[k], in->metallic);
    }
    out->shininess = clamp(shininess, 0.0f, 128.0f);
    return shininess > 128.0f ? (uint32_t)FIT_SHININESS_CLAMPED : 0u;
}
