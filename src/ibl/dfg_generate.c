/* dfg_generate.c - computes the split-sum table; runs when facet is built.
 * usage: dfg_generate OUTPUT
 *
 *   A = integral of (1 - Fc) D Vis N.L 4 V.H dH,  B = integral of Fc D Vis N.L 4 V.H dH,  Fc = (1 - V.H)^5
 *
 * over half vectors H = (sin t cos p, sin t sin p, cos t) with the light above the horizon. With V at angle v from N,
 * N.L = 2 V.H N.H - N.V is positive for all p where 2 t < pi / 2 - v, for none where 2 t > pi / 2 + v, and between for
 * cos p > -cot v cot 2 t. Both intervals of t are split into panels that grow with t / alpha, a lobe's own scale, and
 * integrated by Gauss and Legendre's rule; where the range of p opens or closes, t is substituted by a square, which
 * takes away the root there. Sampling (integrate_dfg) would need 10^6 samples for what 3000 nodes give. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "ibl/dfg.h"

#include "shade/shade.h"

static const double half_pi = 1.57079632679489661923;

/* Gauss and Legendre's nodes in (0, 1) of 16 points, mirrored at 0, and their weights. */
static const double node[8] = {0.0950125098376374, 0.2816035507792589, 0.4580167776572274,
                               0.6178762444026438, 0.7554044083550030, 0.8656312023878318,
                               0.9445750230732326, 0.9894009349916499};
static const double node_weight[8] = {0.1894506104550685, 0.1826034150449236, 0.1691565193950025,
                                      0.1495959888165767, 0.1246289712555339, 0.0951585116824928,
                                      0.0622535239386479, 0.0271524594117541};
enum { POINTS = 16 };

static double point(int i, double from, double to, double *weight)
{
    double x = i < 8 ? -node[7 - i] : node[i - 8];
    *weight = 0.5 * (to - from) * node_weight[i < 8 ? 7 - i : i - 8];
    return 0.5 * (from + to) + 0.5 * (to - from) * x;
}

typedef struct terms {
    double A, B;
} terms;

typedef struct lobe {
    double cos_v, sin_v, v;
    float alpha;
} lobe;

/* The integral over p at one t, times weight, added to sum. */
static void add_ring(const lobe *o, double t, double weight, terms *sum)
{
    double cos_t = (cos)(t);
    double sin_t = (sin)(t);
    double opening = 2.0 * half_pi;
    if (2.0 * t > half_pi - o->v) {
        double c = -o->cos_v * (cos)(2.0 * t) / (o->sin_v * (sin)(2.0 * t));
        opening = (acos)(fmin(fmax(c, -1.0), 1.0));
    }
    float D = D_GGX_stable((float)cos_t, vec3((float)sin_t, 0.0f, 0.0f), o->alpha);
    for (int i = 0; i < POINTS; i++) {
        double w;
        double p = point(i, 0.0, opening, &w);
        double VdotH = o->sin_v * sin_t * (cos)(p) + o->cos_v * cos_t;
        double NdotL = 2.0 * VdotH * cos_t - o->cos_v;
        if (NdotL <= 0.0 || VdotH <= 0.0)
            continue; /* by rounding */
        double Vis = (double)V_SmithGGX((float)NdotL, (float)o->cos_v, o->alpha);
        double Fc = (double)schlick_weight((float)VdotH);
        w *= weight * 2.0 * sin_t * (double)D * Vis * NdotL * 4.0 * VdotH; /* 2: p and -p */
        sum->A += w * (1.0 - Fc);
        sum->B += w * Fc;
    }
}

/* t from a to b; t = a + (b - a) x^2 at the start, mirrored at the end. */
static void add_panel(const lobe *o, double a, double b, bool has_root_at_a, bool has_root_at_b, terms *sum)
{
    for (int i = 0; i < POINTS; i++) {
        double w;
        double x = point(i, 0.0, 1.0, &w);
        if (has_root_at_a)
            add_ring(o, a + (b - a) * x * x, w * (b - a) * 2.0 * x, sum);
        else if (has_root_at_b)
            add_ring(o, b - (b - a) * x * x, w * (b - a) * 2.0 * x, sum);
        else
            add_ring(o, a + (b - a) * x, w * (b - a), sum);
    }
}

/* Panels between a and b, each as wide as its distance from 0 or alpha / 4, whichever is more, and half as wide as
 * what is left, so that the last ones close in on b. */
static void add_interval(const lobe *o, double a, double b, bool has_roots, terms *sum)
{
    double from = a;
    double middle = 0.5 * (a + b);
    double least = 1e-3 * (b - a);
    while (from < b) {
        double width = fmax(fmax(0.7 * from, 0.25 * (double)o->alpha), least);
        if (has_roots) /* as the opening does, Vis changes fastest at the ends */
            width = fmin(width, fmax(0.6 * fmin(from - a, b - from), 0.02 * (b - a)));
        double to = b - from < 1.2 * width ? b : from + width;
        if (has_roots && from < middle && to > middle)
            to = middle;
        add_panel(o, from, to, has_roots && from == a, has_roots && to == b, sum);
        from = to;
    }
}

static terms integrate(float perceptual_roughness, double NdotV)
{
    if (perceptual_roughness == 0.0f) { /* a mirror: H = N, and all of V reflected */
        double Fc = (double)schlick_weight((float)NdotV);
        return (terms){1.0 - Fc, Fc};
    }
    double mu = fmax(NdotV, (double)NDOTV_MIN);
    lobe o = {.cos_v = mu, .sin_v = (sqrt)((1.0 - mu) * (1.0 + mu)), .v = (acos)(mu)};
    o.alpha = alpha_from_roughness(perceptual_roughness);
    terms sum = {0.0, 0.0};
    add_interval(&o, 0.0, 0.5 * (half_pi - o.v), false, &sum);
    if (o.v > 0.0)
        add_interval(&o, 0.5 * (half_pi - o.v), 0.5 * (half_pi + o.v), true, &sum);
    return sum;
}

int main(int argc, char **argv)
{
    FILE *file = argc == 2 ? fopen(argv[1], "w") : NULL;
    if (!file) {
        fprintf(stderr, "usage: dfg_generate OUTPUT\n");
        return 1;
    }
    for (int y = 0; y < DFG_SIZE; y++) {
        fprintf(file, "{\n");
        for (int x = 0; x < DFG_SIZE; x++) {
            double root = (double)x / (DFG_SIZE - 1);
            terms t = integrate((float)y / (DFG_SIZE - 1), root * root);
            fprintf(file, "{%.6ef, %.6ef},\n", t.A, t.B);
        }
        fprintf(file, "},\n");
    }
    return fclose(file) == 0 ? 0 : 1;
}
