/* fit_linear.c - see fit_linear.h. */
#include <math.h>
#include <string.h>

#include "base/simd.h"
#include "legacy/fit_linear.h"

#include "shade/shade.h"

/* ---- least squares of two unknowns in a box ---- */

static double square_at(const fit_moments *m, double a, double b)
{
    return m->square - 2.0 * (a * m->wanted[0] + b * m->wanted[1]) + a * a * m->shapes[0] +
           2.0 * a * b * m->shapes[1] + b * b * m->shapes[2];
}

/* The optimum in [low, high] of q x^2 - 2 w x. */
static double best_alone(double q, double w, double low, double high)
{
    return q > 0.0 ? fmin(fmax(w / q, low), high) : low;
}

/* The square is convex: the unconstrained minimum, or one on an edge of the box. */
double fit_box(const fit_moments *m, const fit_bounds *bounds, double factor[2])
{
    const double *low = bounds->low;
    const double *high = bounds->high;
    double det = m->shapes[0] * m->shapes[2] - m->shapes[1] * m->shapes[1];
    if (det > 1e-10 * m->shapes[0] * m->shapes[2]) {
        double a = (m->wanted[0] * m->shapes[2] - m->wanted[1] * m->shapes[1]) / det;
        double b = (m->wanted[1] * m->shapes[0] - m->wanted[0] * m->shapes[1]) / det;
        if (a >= low[0] && a <= high[0] && b >= low[1] && b <= high[1]) {
            factor[0] = a;
            factor[1] = b;
            return square_at(m, a, b);
        }
    }
    double best = (double)INFINITY;
    for (int edge = 0; edge < 4; edge++) {
        double at[2];
        int held = edge / 2;
        int other = 1 - held;
        at[held] = edge % 2 ? high[held] : low[held];
        at[other] = best_alone(m->shapes[2 * other], m->wanted[other] - at[held] * m->shapes[1], low[other],
                               high[other]);
        double square = square_at(m, at[0], at[1]);
        if (square < best) {
            best = square;
            factor[0] = at[0];
            factor[1] = at[1];
        }
    }
    return best;
}

/* ---- sums ---- */

/* Adds an equation w (u a + v b - t)^2 to lane j of the six sums; inlined, so that the loops over j
 * vectorise. */
static inline __attribute__((always_inline)) void add_moments(double lane[][FIT_LANES], size_t j, double w,
                                                              double a, double b, double t)
{
    double w_a = w * a;
    double w_b = w * b;
    lane[0][j] += w_a * a;
    lane[1][j] += w_a * b;
    lane[2][j] += w_b * b;
    lane[3][j] += w_a * t;
    lane[4][j] += w_b * t;
    lane[5][j] += w * t * t;
}

/* Sums the lanes of the moments, and of one more number: *square (NULL: there is none). */
static inline __attribute__((always_inline)) void sum_lanes(double lane[][FIT_LANES], fit_moments *out,
                                                            double *square)
{
    double sum[7] = {0.0};
    for (int i = 0; i < (square ? 7 : 6); i++)
        for (int j = 0; j < FIT_LANES; j++)
            sum[i] += lane[i][j];
    *out = (fit_moments){{sum[0], sum[1], sum[2]}, {sum[3], sum[4]}, sum[5]};
    if (square)
        *square = sum[6];
}

DISPATCH_AVX2 static void moments_of(const fit_problem *p, int k, fit_moments *out)
{
    double lane[6][FIT_LANES] = {{0.0}};
    const float *T = p->source[k];
    size_t count = p->metric->node_begin[FIT_VIEWS];
    for (size_t i = 0; i < count; i += FIT_LANES) {
        for (size_t j = 0; j < FIT_LANES; j++) {
            double a = (double)p->shape[0][i + j];
            double b = (double)p->shape[1][i + j];
            double t = (double)T[i + j] - (double)p->rest[i + j];
            double w = (double)p->metric->weight[i + j];
            add_moments(lane, j, w, a, b, t);
        }
    }
    sum_lanes(lane, out, NULL);
}

/* The same for clamped radiance, linearized at factor: nodes where both the model and the source exceed
 * white contribute nothing. Without is_strict a model that is too bright counts with its excess, which
 * keeps the square convex. *square is that of clamped radiance. */
DISPATCH_AVX2 static void display_moments_of(const fit_problem *p, int k, const double factor[2],
                                             bool is_strict, fit_moments *out, double *square)
{
    double lane[7][FIT_LANES] = {{0.0}};
    const float *T = p->source[k];
    float u = (float)factor[0];
    float v = (float)factor[1];
    /* from this source value on, a model above white contributes nothing */
    float end = is_strict ? 0.0f : 1.0f;
    size_t count = p->metric->node_begin[FIT_VIEWS];
    for (size_t i = 0; i < count; i += FIT_LANES) {
        for (size_t j = 0; j < FIT_LANES; j++) {
            float x = p->shape[0][i + j];
            float y = p->shape[1][i + j];
            float M = u * x + v * y + p->rest[i + j];
            float shown = clamp(M, 0.0f, 1.0f) - T[i + j];
            float is_free = M >= 1.0f && T[i + j] >= end ? 0.0f : 1.0f;
            double a = (double)x;
            double b = (double)y;
            double t = (double)T[i + j] - (double)p->rest[i + j];
            double full = (double)p->metric->weight[i + j];
            double w = full * (double)is_free;
            add_moments(lane, j, w, a, b, t);
            lane[6][j] += full * (double)shown * (double)shown;
        }
    }
    sum_lanes(lane, out, square);
}

/* ---- sums of display values ---- */

/* The same with the model as a program displays it: a sum of display values whose light is linearized at
 * factor (Gauss-Newton). Nodes where both model and source exceed white contribute nothing. *square is
 * that of light. */
DISPATCH_AVX2 static void drawn_moments_of(const fit_problem *p, int k, const double factor[2],
                                           fit_moments *out, double *square)
{
    double lane[7][FIT_LANES] = {{0.0}};
    const float *T = p->source[k];
    const float *display = p->metric->display;
    float u = (float)factor[0];
    float v = (float)factor[1];
    size_t count = p->metric->node_begin[FIT_VIEWS];
    for (size_t i = 0; i < count; i += FIT_LANES) {
        for (size_t j = 0; j < FIT_LANES; j++) {
            float x = p->shape[0][i + j];
            float y = p->shape[1][i + j];
            float M = u * x + v * y;
            float place = min(M, 1.0f) * (float)DISPLAY_STEPS;
            int first = (int)min(place, (float)(DISPLAY_STEPS - 1));
            float height = display[first + 1] - display[first];
            float light = display[first] + (place - (float)first) * height;
            float slope = height * (float)DISPLAY_STEPS;
            float is_free = M >= 1.0f && T[i + j] >= 1.0f ? 0.0f : 1.0f;
            double full = (double)p->metric->weight[i + j];
            double a = (double)(slope * x);
            double b = (double)(slope * y);
            double d = (double)(T[i + j] - light);
            double t = (double)(slope * min(M, 1.0f)) + d; /* slope times the exact display value */
            double w = full * (double)is_free;
            add_moments(lane, j, w, a, b, t);
            lane[6][j] += full * d * d;
        }
    }
    sum_lanes(lane, out, square);
}

/* The start: least squares of gamma 2 display values, an approximation of the displayed light. */
DISPATCH_AVX2 static void start_of(const fit_problem *p, int k, fit_moments *out)
{
    double lane[5][FIT_LANES] = {{0.0}};
    size_t count = p->metric->node_begin[FIT_VIEWS];
    for (size_t i = 0; i < count; i += FIT_LANES) {
        for (size_t j = 0; j < FIT_LANES; j++) {
            double w = (double)p->metric->weight[i + j];
            double a = (double)p->shape[0][i + j];
            double b = (double)p->shape[1][i + j];
            double t = (double)sqrt(p->source[k][i + j]);
            lane[0][j] += w * a * a;
            lane[1][j] += w * a * b;
            lane[2][j] += w * b * b;
            lane[3][j] += w * a * t;
            lane[4][j] += w * b * t;
        }
    }
    double sum[5] = {0.0};
    for (int i = 0; i < 5; i++)
        for (int j = 0; j < FIT_LANES; j++)
            sum[i] += lane[i][j];
    *out = (fit_moments){{sum[0], sum[1], sum[2]}, {sum[3], sum[4]}, 0.0};
}

/* ---- factors ---- */

static void keep_best(double square, const double now[2], double *best, double factor[2])
{
    if (square < *best) {
        *best = square;
        memcpy(factor, now, 2 * sizeof *factor);
    }
}

/* Newton's method on the convex square, then on the strict one with step halving. */
static double display_factors(const fit_problem *p, int k, const fit_bounds *bounds, double factor[2])
{
    double best = (double)INFINITY;
    double now[2] = {factor[0], factor[1]};
    fit_moments m;
    double square;
    for (int step = 0; step < 12; step++) {
        double next[2];
        display_moments_of(p, k, now, false, &m, &square);
        keep_best(square, now, &best, factor);
        fit_box(&m, bounds, next);
        float moved = max(abs((float)(next[0] - now[0])), abs((float)(next[1] - now[1])));
        memcpy(now, next, sizeof now);
        if (moved < 1e-5f)
            break;
    }
    for (int step = 0; step < 4; step++) {
        double before = best;
        double from[2] = {factor[0], factor[1]};
        double to[2];
        display_moments_of(p, k, from, true, &m, &square);
        fit_box(&m, bounds, to);
        for (double share = 1.0; share > 0.1 && best == before; share *= 0.5) {
            for (int i = 0; i < 2; i++)
                now[i] = from[i] + share * (to[i] - from[i]);
            display_moments_of(p, k, now, true, &m, &square);
            keep_best(square, now, &best, factor);
        }
        if (best > before * (1.0 - 1e-6))
            break;
    }
    return best;
}

/* From gamma 2 display values on, with step halving until the square of light decreases. */
static double drawn_factors(const fit_problem *p, int k, const fit_bounds *bounds, double factor[2])
{
    fit_moments m;
    double best = (double)INFINITY;
    double square;
    double now[2];
    start_of(p, k, &m);
    fit_box(&m, bounds, now);
    drawn_moments_of(p, k, now, &m, &square);
    keep_best(square, now, &best, factor);
    for (int newton = 0; newton < 8; newton++) {
        fit_moments next_m = m;
        double before = best;
        double from[2] = {factor[0], factor[1]};
        double to[2];
        fit_box(&m, bounds, to);
        for (double share = 1.0; share > 0.1 && best == before; share *= 0.5) {
            for (int i = 0; i < 2; i++)
                now[i] = from[i] + share * (to[i] - from[i]);
            drawn_moments_of(p, k, now, &next_m, &square);
            keep_best(square, now, &best, factor);
        }
        if (best > before * (1.0 - 1e-5))
            break;
        m = next_m;
    }
    return best;
}

double fit_factors(const fit_problem *p, const fit_bounds bounds[3], double factor[3][2])
{
    double sum = 0.0;
    double square = 0.0;
    for (int k = 0; k < 3; k++) {
        if (p->is_same[k] && memcmp(&bounds[k], &bounds[k - 1], sizeof bounds[k]) == 0) {
            memcpy(factor[k], factor[k - 1], sizeof factor[k]);
        } else if (p->target == FACET_LEGACY_TARGET_DRAWN) {
            square = drawn_factors(p, k, &bounds[k], factor[k]);
        } else {
            fit_moments m;
            moments_of(p, k, &m);
            square = fit_box(&m, &bounds[k], factor[k]);
            if (p->target == FACET_LEGACY_TARGET_DISPLAY)
                square = display_factors(p, k, &bounds[k], factor[k]);
        }
        sum += square;
    }
    return fmax(sum, 0.0) / p->source_square; /* rounding may make it negative */
}

/* ---- sources ---- */

DISPATCH_AVX2 static double clamp_and_square(const fit_metric *metric, float highest, float *radiance)
{
    double lane[FIT_LANES] = {0.0};
    double sum = 0.0;
    for (size_t i = 0; i < metric->node_begin[FIT_VIEWS]; i += FIT_LANES)
        for (size_t j = 0; j < FIT_LANES; j++) {
            float T = min(radiance[i + j], highest);
            radiance[i + j] = T;
            lane[j] += (double)metric->weight[i + j] * (double)T * (double)T;
        }
    for (size_t j = 0; j < FIT_LANES; j++)
        sum += lane[j];
    return sum;
}

static void finish_source(fit_problem *p)
{
    size_t size = p->metric->node_begin[FIT_VIEWS] * sizeof(float);
    float highest = p->target == FACET_LEGACY_TARGET_LINEAR ? INFINITY : 1.0f;
    p->source_square = FIT_DARKEST * FIT_DARKEST * 1.5 * (double)PI * FIT_VIEWS;
    double sum = 0.0;
    for (int k = 0; k < 3; k++) {
        sum += clamp_and_square(p->metric, highest, p->source[k]);
        p->is_same[k] = k > 0 && memcmp(p->source[k], p->source[k - 1], size) == 0;
    }
    p->source_square = fmax(p->source_square, sum);
}

void fit_problem_from_ogl1(fit_problem *p, const fit_metric *metric, facet_legacy_target target,
                           const ogl1_surface *source)
{
    p->metric = metric;
    p->target = target;
    fit_highlight(metric, source->shininess, p->lobe);
    for (int k = 0; k < 3; k++)
        if (target == FACET_LEGACY_TARGET_DRAWN)
            fit_radiance_drawn(metric, source, p->lobe, k, p->source[k]);
        else
            fit_radiance_ogl1(metric, source, p->lobe, k, p->source[k]);
    finish_source(p);
    if (target == FACET_LEGACY_TARGET_DRAWN)
        p->target = FACET_LEGACY_TARGET_DISPLAY;
}

void fit_problem_from_pbr(fit_problem *p, const fit_metric *metric, facet_legacy_target target,
                          const pbr_surface *source)
{
    p->metric = metric;
    p->target = target;
    fit_lobes lobes = fit_lobes_of(source);
    fit_specular_lobe(metric, source->perceptual_roughness, p->lobe);
    for (int k = 0; k < 3; k++) {
        bool is_same = k > 0 && lobes.diffuse[k] == lobes.diffuse[k - 1] && lobes.F0[k] == lobes.F0[k - 1] &&
                       lobes.F90[k] == lobes.F90[k - 1];
        if (is_same)
            memcpy(p->source[k], p->source[k - 1], metric->node_begin[FIT_VIEWS] * sizeof(float));
        else
            fit_radiance_pbr(metric, &lobes, p->lobe, k, p->source[k]);
    }
    finish_source(p);
}
