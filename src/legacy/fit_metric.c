/* fit_metric.c - the difference between two models: the directions over which errors are integrated,
 * radiance there, and its error.
 *
 * The formulas are shade/'s; here they are arranged as loops over arrays, which the compiler vectorises.
 * Sums have FIT_LANES partial sums, so their order does not depend on the width of the instructions. */
#include "legacy/fit_metric.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/result.h"
#include "base/simd.h"
#include "legacy/fit.h"

#include "shade/shade.h"

/* ---- the quadrature: views at 0, 30 and 60 degrees, light from the upper hemisphere, cosine-weighted ----
 *
 * Lobes are narrow, so the nodes are half vectors, dL = 4 (V.H) dH (Walter et al. 2007, equation 14). With V at angle v
 * from N and H at t, N.L = 2 (V.H) (N.H) - N.V is positive all around for 2 t < pi / 2 - v, nowhere for 2 t > pi / 2 + v,
 * and for cos p > -cot v cot 2 t between. Panels of t grow by a factor from 1e-5 on: lobes of every width get as many
 * nodes. Where the range of p opens and closes, t is substituted by a square, which removes the square root there. */

static const double pi = 3.14159265358979323846;
static const double view_rad[FIT_VIEWS] = {0.0, 0.52359877559829887308, 1.04719755119659774615};

enum { POINTS = 8, MAX_POINTS = 16, GROWING_PANELS = 12 };

/* Gauss-Legendre nodes in (0, 1) and their weights: roots of P_n by Newton's method. */
static void gauss_legendre(int n, double *x, double *w)
{
    for (int i = 0; i < n; i++) {
        double z = cos(pi * (i + 0.75) / (n + 0.5));
        double slope = 1.0;
        for (int step = 0; step < 8; step++) {
            double p = 1.0;
            double before = 0.0;
            for (int j = 0; j < n; j++) {
                double next = ((2.0 * j + 1.0) * z * p - j * before) / (j + 1.0);
                before = p;
                p = next;
            }
            slope = n * (z * p - before) / (z * z - 1.0);
            z -= p / slope;
        }
        x[i] = 0.5 * (1.0 - z);
        w[i] = 1.0 / ((1.0 - z * z) * slope * slope);
    }
}

typedef struct builder {
    fit_metric *metric;
    int view;
    size_t ring, node;
    double x[POINTS], w[POINTS];               /* along t */
    double arc[MAX_POINTS], arc_w[MAX_POINTS]; /* along p, where it is not a full circle */
} builder;

static void add_node(builder *b, double t, double p, double weight)
{
    double v = view_rad[b->view];
    double VdotH = sin(v) * sin(t) * cos(p) + cos(v) * cos(t);
    double NdotL = 2.0 * VdotH * cos(t) - cos(v);
    if (NdotL <= 0.0 || VdotH <= 0.0)
        return; /* rounding */
    size_t i = b->node++;
    b->metric->ring[i] = (uint16_t)b->ring;
    b->metric->NdotL[i] = (float)NdotL;
    b->metric->VdotH[i] = (float)VdotH;
    b->metric->weight[i] = (float)(weight * sin(t) * 4.0 * VdotH * NdotL);
}

/* All p at one t; p and -p are symmetric. */
static void add_ring(builder *b, double t, double weight)
{
    double v = view_rad[b->view];
    fit_metric *m = b->metric;
    m->cos_h[b->ring] = (float)cos(t);
    m->sin_h[b->ring] = (float)sin(t);
    m->log_cos_h[b->ring] = (float)(0.5 * log1p(-sin(t) * sin(t)));
    if (v == 0.0) {
        add_node(b, t, 0.0, weight * 2.0 * pi);
    } else if (2.0 * t <= 0.5 * pi - v) { /* the midpoint rule, optimal for a full period */
        int n = t < 0.01 ? 4 : t < 0.1 ? 8 : MAX_POINTS;
        for (int i = 0; i < n; i++)
            add_node(b, t, pi * (i + 0.5) / n, weight * 2.0 * pi / n);
    } else {
        double end = acos(fmin(fmax(-cos(v) * cos(2.0 * t) / (sin(v) * sin(2.0 * t)), -1.0), 1.0));
        for (int i = 0; i < MAX_POINTS; i++)
            add_node(b, t, end * b->arc[i], weight * 2.0 * end * b->arc_w[i]);
    }
    b->ring++;
}

/* A panel of t; end -1: a square root at from, 1: at to. */
static void add_panel(builder *b, double from, double to, int end)
{
    double width = to - from;
    for (int i = 0; i < POINTS; i++) {
        double x = b->x[i];
        double w = b->w[i] * width;
        if (end < 0)
            add_ring(b, from + width * x * x, w * 2.0 * x);
        else if (end > 0)
            add_ring(b, to - width * x * x, w * 2.0 * x);
        else
            add_ring(b, from + width * x, w);
    }
}

static void add_view(builder *b)
{
    double v = view_rad[b->view];
    double closing = 0.5 * (0.5 * pi - v);
    double end = 0.5 * (0.5 * pi + v);
    double factor = pow(closing / 1e-5, 1.0 / GROWING_PANELS);
    double from = 0.0;
    double to = 1e-5;
    for (int i = 0; i <= GROWING_PANELS; i++) {
        add_panel(b, from, to, 0);
        from = to;
        to = i + 1 < GROWING_PANELS ? to * factor : closing;
    }
    if (end > closing) {
        double quarter = 0.25 * (end - closing);
        add_panel(b, closing, closing + quarter, -1);
        add_panel(b, closing + quarter, closing + 2.0 * quarter, 0);
        add_panel(b, closing + 2.0 * quarter, end - quarter, 0);
        add_panel(b, end - quarter, end, 1);
    }
}

/* Fills the nodes: everything except masking, fresnel and display. */
static void fit_quadrature(fit_metric *metric)
{
    builder b = {.metric = metric};
    gauss_legendre(POINTS, b.x, b.w);
    gauss_legendre(MAX_POINTS, b.arc, b.arc_w);
    for (b.view = 0; b.view < FIT_VIEWS; b.view++) {
        metric->ring_begin[b.view] = b.ring;
        metric->node_begin[b.view] = b.node;
        metric->NdotV[b.view] = (float)cos(view_rad[b.view]);
        add_view(&b);
        for (size_t last = b.node - 1; b.node % FIT_LANES != 0; b.node++) {
            metric->ring[b.node] = metric->ring[last];
            metric->NdotL[b.node] = metric->NdotL[last];
            metric->VdotH[b.node] = metric->VdotH[last];
            metric->weight[b.node] = 0.0f;
        }
    }
    metric->ring_begin[FIT_VIEWS] = b.ring;
    metric->node_begin[FIT_VIEWS] = b.node;
}

facet_result fit_metric_create(const facet_allocator *allocator, pbr_masking masking, fit_metric **out,
                               facet_error *error)
{
    *out = NULL;
    fit_metric *metric = mem_zalloc(allocator, 1, sizeof *metric);
    if (!metric)
        return fail_memory(error, "nodes of the error of materials", sizeof *metric);
    metric->masking = masking;
    fit_quadrature(metric);
    for (size_t i = 0; i < metric->node_begin[FIT_VIEWS]; i++)
        metric->fresnel[i] = schlick_weight(metric->VdotH[i]);
    for (int i = 0; i < DISPLAY_STEPS + 2; i++)
        metric->display[i] = linear_from_srgb1(min((float)i / (float)DISPLAY_STEPS, 1.0f));
    *out = metric;
    return FACET_OK;
}

void fit_metric_destroy(fit_metric *metric)
{
    mem_free(metric);
}

/* ---- the shapes of lobes ---- */

DISPATCH_AVX2 static void smith_correlated(size_t count, const float *NdotL, float NdotV, float alpha,
                                           float *out)
{
    for (size_t i = 0; i < count; i++)
        out[i] *= PI * V_SmithGGX(NdotL[i], NdotV, alpha) * NdotL[i];
}

DISPATCH_AVX2 static void smith_separable(size_t count, const float *NdotL, float NdotV, float alpha,
                                          float *out)
{
    for (size_t i = 0; i < count; i++)
        out[i] *= PI * V_SmithGGX_separable(NdotL[i], NdotV, alpha) * NdotL[i];
}

void fit_specular_lobe(const fit_metric *metric, float perceptual_roughness, float *out)
{
    float alpha = max(alpha_from_roughness(clamp(perceptual_roughness, 0.0f, 1.0f)), ALPHA_DELTA);
    float D[FIT_MAX_RINGS];
    for (size_t i = 0; i < metric->ring_begin[FIT_VIEWS]; i++)
        D[i] = D_GGX_stable(metric->cos_h[i], vec3(metric->sin_h[i], 0.0f, 0.0f), alpha);
    for (size_t i = 0; i < metric->node_begin[FIT_VIEWS]; i++)
        out[i] = D[metric->ring[i]];
    for (int v = 0; v < FIT_VIEWS; v++) {
        size_t begin = metric->node_begin[v];
        size_t count = metric->node_begin[v + 1] - begin;
        if (metric->masking == PBR_CORRELATED)
            smith_correlated(count, metric->NdotL + begin, metric->NdotV[v], alpha, out + begin);
        else
            smith_separable(count, metric->NdotL + begin, metric->NdotV[v], alpha, out + begin);
    }
}

/* (N.H)^s as exp(s log N.H) with log N.H from double: powf() of a rounded cosine would be off by 6 % at s
 * = 10^6. */
void fit_highlight(const fit_metric *metric, float shininess, float *out)
{
    float power[FIT_MAX_RINGS];
    for (size_t i = 0; i < metric->ring_begin[FIT_VIEWS]; i++)
        power[i] = expf(shininess * metric->log_cos_h[i]);
    for (size_t i = 0; i < metric->node_begin[FIT_VIEWS]; i++)
        out[i] = power[metric->ring[i]];
}

/* ---- radiance ---- */

fit_lobes fit_lobes_of(const pbr_surface *p)
{
    Surface s = surface_from_gltf(
        vec3(0.0f, 0.0f, 1.0f), vec3(p->base_color[0], p->base_color[1], p->base_color[2]), p->metallic,
        p->perceptual_roughness, p->ior, p->specular,
        vec3(p->specular_color[0], p->specular_color[1], p->specular_color[2]), 1.0f, vec3(0.0f));
    fit_lobes lobes = {.shade = {max3(s.F0), s.F90}};
    for (int k = 0; k < 3; k++) {
        lobes.diffuse[k] = s.base_color[k] * (1.0f - s.metallic);
        lobes.F0[k] = mix(s.F0[k], s.base_color[k], s.metallic);
        lobes.F90[k] = mix(s.F90, 1.0f, s.metallic);
    }
    return lobes;
}

/* With clang, clones must be static. */
DISPATCH_AVX2 static void add_lambert_and_highlight(size_t count, const float *NdotL, const float *highlight,
                                                    float Cd, float Cs, float *out)
{
    for (size_t i = 0; i < count; i++)
        out[i] = NdotL[i] * Cd + highlight[i] * Cs;
}

DISPATCH_AVX2 static void add_lobes(const fit_metric *metric, const fit_lobes *lobes, const float *lobe,
                                    int k, float *out)
{
    float diffuse = lobes->diffuse[k];
    float shade0 = lobes->shade[0];
    float shade90 = lobes->shade[1];
    float F0 = lobes->F0[k];
    float F90 = lobes->F90[k];
    size_t count = metric->node_begin[FIT_VIEWS];
    for (size_t i = 0; i < count; i++) {
        float w = metric->fresnel[i];
        out[i] = metric->NdotL[i] * (diffuse * (1.0f - mix(shade0, shade90, w))) + lobe[i] * mix(F0, F90, w);
    }
}

void fit_radiance_ogl1(const fit_metric *metric, const ogl1_surface *surface, const float *highlight, int k,
                       float *out)
{
    add_lambert_and_highlight(metric->node_begin[FIT_VIEWS], metric->NdotL, highlight, surface->diffuse[k],
                              surface->specular[k], out);
}

void fit_radiance_pbr(const fit_metric *metric, const fit_lobes *lobes, const float *lobe, int k, float *out)
{
    add_lobes(metric, lobes, lobe, k, out);
}

/* ---- OpenGL 1 as its programs display it ---- */

float fit_display_light(float number)
{
    return linear_from_srgb1(number);
}

void fit_radiance_drawn(const fit_metric *metric, const ogl1_surface *surface, const float *highlight, int k,
                        float *out)
{
    const float *table = metric->display;
    float Cd = srgb_from_linear1(surface->diffuse[k]);
    float Cs = srgb_from_linear1(surface->specular[k]);
    for (size_t i = 0; i < metric->node_begin[FIT_VIEWS]; i++) {
        float place = min(metric->NdotL[i] * Cd + highlight[i] * Cs, 1.0f) * (float)DISPLAY_STEPS;
        int step_at = (int)place;
        out[i] = table[step_at] + (place - (float)step_at) * (table[step_at + 1] - table[step_at]);
    }
}

/* ---- errors ---- */

/* Weighted sums of squares over nodes: of the difference and of the source, unclamped and clamped. */
typedef struct squares {
    double difference, source, difference_display, source_display;
} squares;

/* FIT_LANES partial sums in double. */
static inline double sum_of(size_t count, const float *values)
{
    double lane[FIT_LANES] = {0.0};
    double sum = 0.0;
    for (size_t i = 0; i < count; i += FIT_LANES)
        for (size_t j = 0; j < FIT_LANES; j++)
            lane[j] += (double)values[i + j];
    for (size_t j = 0; j < FIT_LANES; j++)
        sum += lane[j];
    return sum;
}

/* Products in float, sums in double: products are not differences, so each keeps its relative rounding of
 * 6e-8. By blocks, since a loop that does both does not vectorize well. */
DISPATCH_AVX2 static void add_squares(size_t count, const float *weight, const float *source,
                                      const float *model, squares *sum)
{
    enum { BLOCK = 128 };
    float difference[BLOCK], wanted[BLOCK], difference_shown[BLOCK], wanted_shown[BLOCK];
    for (size_t begin = 0; begin < count; begin += BLOCK) {
        size_t n = count - begin < BLOCK ? count - begin : BLOCK;
        for (size_t i = 0; i < n; i++) {
            float w = weight[begin + i];
            float T = source[begin + i];
            float M = model[begin + i];
            float T_shown = min(T, 1.0f); /* never negative */
            float d = M - T;
            float d_shown = min(M, 1.0f) - T_shown;
            difference[i] = w * d * d;
            wanted[i] = w * T * T;
            difference_shown[i] = w * d_shown * d_shown;
            wanted_shown[i] = w * T_shown * T_shown;
        }
        sum->difference += sum_of(n, difference);
        sum->source += sum_of(n, wanted);
        sum->difference_display += sum_of(n, difference_shown);
        sum->source_display += sum_of(n, wanted_shown);
    }
}

/* The same for two clamped radiances. */
DISPATCH_AVX2 static void add_squares_shown(size_t count, const float *weight, const float *source,
                                            const float *model, double *difference_sum, double *source_sum)
{
    double lane[2][FIT_LANES] = {{0.0}};
    for (size_t i = 0; i < count; i += FIT_LANES)
        for (size_t j = 0; j < FIT_LANES; j++) {
            float w = weight[i + j];
            float T = source[i + j];
            float d = model[i + j] - T;
            lane[0][j] += (double)(w * d * d);
            lane[1][j] += (double)(w * T * T);
        }
    for (size_t j = 0; j < FIT_LANES; j++) {
        *difference_sum += lane[0][j];
        *source_sum += lane[1][j];
    }
}

/* A view of white integrates to 3 pi / 2 over three channels. */
static double relative(double difference, double source, double view_count)
{
    double least = FIT_DARKEST * FIT_DARKEST * 1.5 * (double)PI * view_count;
    return sqrt(difference / fmax(source, least));
}

fit_error fit_compare(const fit_metric *metric, const ogl1_surface *ogl1, const pbr_surface *pbr,
                      fit_source source)
{
    float highlight[FIT_MAX_NODES];
    float lobe[FIT_MAX_NODES];
    float old[FIT_MAX_NODES];
    float new[FIT_MAX_NODES];
    float drawn[FIT_MAX_NODES];
    double drawn_difference = 0.0, drawn_source = 0.0;
    size_t count = metric->node_begin[FIT_VIEWS];
    fit_lobes lobes = fit_lobes_of(pbr);
    squares view[FIT_VIEWS];
    memset(view, 0, sizeof view);
    fit_highlight(metric, ogl1->shininess, highlight);
    fit_specular_lobe(metric, pbr->perceptual_roughness, lobe);
    for (int k = 0; k < 3; k++) {
        fit_radiance_ogl1(metric, ogl1, highlight, k, old);
        fit_radiance_pbr(metric, &lobes, lobe, k, new);
        const float *T = source == FIT_FROM_OGL1 ? old : new;
        const float *M = source == FIT_FROM_OGL1 ? new : old;
        for (int v = 0; v < FIT_VIEWS; v++) {
            size_t begin = metric->node_begin[v];
            add_squares(metric->node_begin[v + 1] - begin, metric->weight + begin, T + begin, M + begin,
                        &view[v]);
        }
        fit_radiance_drawn(metric, ogl1, highlight, k, drawn);
        for (size_t i = 0; i < count; i++)
            new[i] = min(new[i], 1.0f);
        add_squares_shown(count, metric->weight, source == FIT_FROM_OGL1 ? drawn : new,
                          source == FIT_FROM_OGL1 ? new : drawn, &drawn_difference, &drawn_source);
    }
    fit_error error;
    squares all = {0.0, 0.0, 0.0, 0.0};
    for (int v = 0; v < FIT_VIEWS; v++) {
        error.views[v] = relative(view[v].difference, view[v].source, 1.0);
        all.difference += view[v].difference;
        all.source += view[v].source;
        all.difference_display += view[v].difference_display;
        all.source_display += view[v].source_display;
    }
    error.E = relative(all.difference, all.source, FIT_VIEWS);
    error.E_display = relative(all.difference_display, all.source_display, FIT_VIEWS);
    error.E_drawn = relative(drawn_difference, drawn_source, FIT_VIEWS);
    return error;
}

/* ---- both models for one pair of directions ---- */

void ogl1_radiance(const ogl1_surface *s, const float V[3], const float L[3], float out[3])
{
    vec3 radiance = phong_reflection(vec3(0.0f, 0.0f, 1.0f), vec3(V[0], V[1], V[2]), vec3(L[0], L[1], L[2]),
                                     vec3(s->diffuse[0], s->diffuse[1], s->diffuse[2]),
                                     vec3(s->specular[0], s->specular[1], s->specular[2]), s->shininess);
    for (int k = 0; k < 3; k++)
        out[k] = radiance[k];
}

/* The function of the renderer; separable masking by the ratio of the two visibilities. */
void pbr_radiance(const pbr_surface *p, pbr_masking masking, const float V[3], const float L[3], float out[3])
{
    vec3 v = vec3(V[0], V[1], V[2]);
    vec3 l = vec3(L[0], L[1], L[2]);
    Surface s = surface_from_gltf(
        vec3(0.0f, 0.0f, 1.0f), vec3(p->base_color[0], p->base_color[1], p->base_color[2]), p->metallic,
        p->perceptual_roughness, p->ior, p->specular,
        vec3(p->specular_color[0], p->specular_color[1], p->specular_color[2]), 1.0f, vec3(0.0f));
    SurfaceLobes lobes = surface_lobes_cos(s, v, l, ENERGY_GLTF, vec2(0.0f));
    if (masking == PBR_SEPARABLE && L[2] > 0.0f) {
        float alpha = max(s.alpha, ALPHA_DELTA);
        float NdotL = min(L[2], 1.0f);
        float NdotV = surface_NdotV(s, v);
        lobes.specular *= V_SmithGGX_separable(NdotL, NdotV, alpha) / V_SmithGGX(NdotL, NdotV, alpha);
    }
    vec3 radiance = (lobes.specular + lobes.diffuse) * PI;
    for (int k = 0; k < 3; k++)
        out[k] = radiance[k];
}
