/* dfg_integrate.c - see dfg_integrate.h. The split sum of GGX:
 *
 *   A = integral of (1 - Fc) D Vis N.L 4 V.H dH,  B = integral of Fc D Vis N.L 4 V.H dH,  Fc = (1 - V.H)^5
 *
 * over half vectors H = (sin t cos p, sin t sin p, cos t) with the light above the horizon. With V at
 * angle v from N, N.L = cos v cos 2t + sin v sin 2t cos p is positive for all p where 2 t < pi / 2 - v,
 * for none where 2 t > pi / 2 + v, and between for cos p > -cot v cot 2t.
 *
 * The variable is s = ln(tan t / alpha): D cos t sin t dt is e^2s / (1 + e^2s)^2 ds times a constant, the
 * same bell for every alpha, whose nearest poles are pi / 2 from the axis. Panels of s no longer than
 * PANEL, where that is one and a half times half a panel's length, lose nothing to Gauss and Legendre's
 * rule of 8 points. Where the range of p opens or closes, s is substituted by a square, which takes away
 * the root there. 16 points of p are done at a time. Sampling (integrate_dfg() of shade/ibl.h) would need
 * 10^6 samples for what 1000 points give. */
#include "ibl/dfg_integrate.h"

#include <math.h>
#include <stdbool.h>

#include "base/simd.h"
#include "ibl/gauss.h"

#include "shade/shade.h"

static const double half_pi = 1.57079632679489661923;

enum { RING = 16 }; /* points of p */

typedef struct lobe {
    dfg_masking masking;
    double cos_v, sin_v, v;
    float alpha, k;
    float nodes[RING], weights[RING]; /* of [0, 1] */
    float A[RING], B[RING];           /* sums */
} lobe;

/* Constants of a ring of half vectors. */
typedef struct ring {
    float cos_t, sin_t;
    float level, swing; /* N.L = level + swing cos p */
    float half_angle;
    float weight;
} ring;

/* cos x for x in [0, pi], within 2e-7: 1 - 2 sin^2(x / 2), the sine by its Taylor series. Without calls, so
 * that loops vectorise. */
static inline float ring_cosine(float x)
{
    float h = 0.5f * x;
    float q = h * h;
    float s =
        h * (1.0f +
             q * (-1.66666667e-1f +
                  q * (8.33333333e-3f + q * (-1.98412698e-4f + q * (2.75573192e-6f + q * -2.50521084e-8f)))));
    return 1.0f - 2.0f * s * s;
}

/* Vis of each masking function; each has a loop of its own below, without branches. */
#define ADD_RING(VISIBILITY)                                                                                 \
    for (int i = 0; i < RING; i++) {                                                                         \
        float cos_p = ring_cosine(r.half_angle * o->nodes[i]);                                               \
        float NdotL = max(r.level + r.swing * cos_p, 0.0f);                                                  \
        float VdotH = max(cos_v * r.cos_t + sin_v * r.sin_t * cos_p, 0.0f);                                  \
        float w = r.weight * o->weights[i] * (VISIBILITY)*NdotL * VdotH;                                     \
        float Fc = schlick_weight(VdotH);                                                                    \
        o->A[i] += w * (1.0f - Fc);                                                                          \
        o->B[i] += w * Fc;                                                                                   \
    }

DISPATCH_AVX2 static void dfg_add_ring(lobe *o, ring r)
{
    float cos_v = (float)o->cos_v;
    float sin_v = (float)o->sin_v;
    float alpha = o->alpha;
    float k = o->k;
    switch (o->masking) {
    case DFG_SMITH_CORRELATED:
        ADD_RING(V_SmithGGX(NdotL, cos_v, alpha))
        break;
    case DFG_SMITH_SEPARABLE:
        ADD_RING(V_SmithGGX_separable(NdotL, cos_v, alpha))
        break;
    default:
        ADD_RING(V_SchlickGGX(NdotL, cos_v, k))
    }
}

/* Adds the integral over p at one s, times weight, to the sums. */
static void add_node(lobe *o, double s, double weight)
{
    double tangent = (double)o->alpha * exp(s);
    double cos_t = 1.0 / sqrt(1.0 + tangent * tangent);
    double sin_t = tangent * cos_t;
    double cos_2t = (cos_t - sin_t) * (cos_t + sin_t);
    double sin_2t = 2.0 * sin_t * cos_t;
    ring r = {.cos_t = (float)cos_t,
              .sin_t = (float)sin_t,
              .level = (float)(o->cos_v * cos_2t),
              .swing = (float)(o->sin_v * sin_2t)};
    double edge = o->cos_v * cos_2t + o->sin_v * sin_2t * -1.0; /* N.L at p = pi */
    double half_angle = 2.0 * half_pi;
    if (edge < 0.0)
        half_angle = acos(fmin(fmax(-o->cos_v * cos_2t / (o->sin_v * sin_2t), -1.0), 1.0));
    r.half_angle = (float)half_angle;
    /* dH = sin t dt dp and dt = sin t cos t ds; 2: p and -p */
    float D = D_GGX_stable(r.cos_t, vec3(r.sin_t, 0.0f, 0.0f), o->alpha);
    r.weight = (float)(weight * 2.0 * half_angle * 4.0 * (double)D * sin_t * sin_t * cos_t);
    dfg_add_ring(o, r);
}

/* s from a to b; s = a + (b - a) x^2 at the start, mirrored at the end. */
static void add_panel(lobe *o, double a, double b, bool has_root_at_a, bool has_root_at_b)
{
    for (int i = 0; i < 8; i++) {
        double w;
        double x = gauss_8(i, 0.0, 1.0, &w);
        if (has_root_at_a)
            add_node(o, a + (b - a) * x * x, w * (b - a) * 2.0 * x);
        else if (has_root_at_b)
            add_node(o, b - (b - a) * x * x, w * (b - a) * 2.0 * x);
        else
            add_node(o, a + (b - a) * x, w * (b - a));
    }
}

/* Limits of s: below -8 the bell has e^2s of its mass; above, times the factor min(1, alpha / N.V) e^-s of
 * grazing views, less than 1e-6 is cut off. */
static const double LOWEST = -8.0;
static double highest(const lobe *o)
{
    return fmax(8.0, 15.0 + log((double)o->alpha / fmax((double)o->alpha, o->cos_v)));
}

static const double PANEL = 1.5;

/* The last panel is always refined towards its end, where N.L approaches 0 and Vis changes fastest. */
static void add_interval(lobe *o, double a, double b, bool has_root_at_a)
{
    int count = (int)ceil((b - a) / PANEL);
    if (has_root_at_a && count < 2)
        count = 2;
    for (int i = 0; i < count; i++)
        add_panel(o, a + (b - a) * i / count, a + (b - a) * (i + 1) / count, has_root_at_a && i == 0,
                  i == count - 1);
}

dfg_terms dfg_integrate(dfg_masking masking, float perceptual_roughness, double NdotV)
{
    if (perceptual_roughness == 0.0f) { /* a mirror: H = N, everything is reflected */
        double Fc = (double)schlick_weight((float)NdotV);
        return (dfg_terms){1.0 - Fc, Fc};
    }
    double mu = fmax(NdotV, (double)NDOTV_MIN);
    lobe o = {.masking = masking,
              .cos_v = mu,
              .sin_v = sqrt((1.0 - mu) * (1.0 + mu)),
              .v = acos(mu),
              .alpha = alpha_from_roughness(perceptual_roughness)};
    o.k = masking == DFG_SCHLICK_DIRECT ? k_direct(perceptual_roughness) : k_ibl(o.alpha);
    for (int i = 0; i < RING; i++) {
        double w;
        o.nodes[i] = (float)gauss_16(i, 0.0, 1.0, &w);
        o.weights[i] = (float)w;
    }
    double open = log(tan(0.5 * (half_pi - o.v)) / (double)o.alpha);  /* the whole ring is lit up to here */
    double close = log(tan(0.5 * (half_pi + o.v)) / (double)o.alpha); /* none of it is lit from here on */
    close = fmin(close, highest(&o));
    if (open > LOWEST)
        add_interval(&o, LOWEST, fmin(open, close), false);
    if (open < close && o.v > 0.0)
        add_interval(&o, fmax(open, LOWEST), close, true);
    dfg_terms sum = {0.0, 0.0};
    for (int i = 0; i < RING; i++) {
        sum.scale += (double)o.A[i];
        sum.bias += (double)o.B[i];
    }
    return sum;
}

double dfg_integrate_average(dfg_masking masking, float perceptual_roughness)
{
    /* E changes where N.V approaches alpha: panels halve towards 0 */
    double sum = 0.0;
    double to = 1.0;
    for (int panel = 0; panel < 6; panel++) {
        double from = panel == 5 ? 0.0 : 0.4 * to;
        for (int i = 0; i < 8; i++) {
            double w;
            double mu = gauss_8(i, from, to, &w);
            dfg_terms t = dfg_integrate(masking, perceptual_roughness, mu);
            sum += 2.0 * w * mu * (t.scale + t.bias);
        }
        to = from;
    }
    return sum;
}

/* ---- sheen ---- */

static const double pi = 3.14159265358979323846;

enum { PANELS = SHEEN_NODES / 8, LONGITUDES = 16 };

/* Of y; the last one ends at the root of 1/2. */
static const double panel_ends[PANELS] = {0.0, 0.06, 0.12, 0.18, 0.23, 0.28, 0.35, 0.5, 0.79370052598409974};

/* D is proportional to sin(N, H)^(1 / alpha), which is 1e-10 at exp(-23 alpha). A step is at most 1/178 of
 * the distance over which it falls by e, so linear interpolation is off by at most 4e-6. A table over (N.H)^2
 * would have a root at 1. */
static void make_table(sheen_nodes *out)
{
    out->least_sine = exp(-23.0f * out->alpha);
    out->D_scale = (float)SHEEN_TABLE / (1.0f - out->least_sine);
    for (int i = 0; i <= SHEEN_TABLE; i++) {
        float sine = min(out->least_sine + (float)i / out->D_scale, 1.0f);
        out->D[i] = D_Charlie(sqrt((1.0f - sine) * (1.0f + sine)), out->alpha);
    }
    out->D[SHEEN_TABLE + 1] = out->D[SHEEN_TABLE];
}

static inline float read_table(const sheen_nodes *nodes, float place)
{
    int i = (int)place;
    return nodes->D[i] + (nodes->D[i + 1] - nodes->D[i]) * (place - (float)i);
}

void sheen_prepare(float sheen_roughness, sheen_nodes *out)
{
    out->alpha = sheen_roughness > 0.0f ? sheen_alpha(sheen_roughness) : 0.0f;
    if (out->alpha > 0.0f)
        make_table(out);
    for (int i = 0; i < SHEEN_NODES; i++) {
        int panel = i / 8;
        double w;
        if (panel < PANELS - 1) {
            double y = gauss_8(i % 8, panel_ends[panel], panel_ends[panel + 1], &w);
            out->NdotL[i] = (float)(y * y * y);
            out->weight[i] = (float)(w * 3.0 * y * y);
        } else {
            double z = gauss_8(7 - i % 8, 0.0, 1.0, &w);
            out->NdotL[i] = (float)(1.0 - 0.5 * z * z);
            out->weight[i] = (float)(w * z);
        }
        out->Lambda[i] = out->alpha > 0.0f ? Lambda_Charlie(out->NdotL[i], out->alpha) : 0.0f;
    }
}

sheen_albedos sheen_integrate(const sheen_nodes *nodes, double NdotV)
{
    sheen_albedos sum = {0.0, 0.0};
    if (nodes->alpha == 0.0f)
        return sum;
    float alpha = nodes->alpha;
    float mu = max((float)NdotV, NDOTV_MIN);
    float sin_v = sqrt((1.0f - mu) * (1.0f + mu));
    float Lambda_V = Lambda_Charlie(mu, alpha);
    float cosines[LONGITUDES], weights[LONGITUDES];
    for (int k = 0; k < LONGITUDES; k++) {
        double w;
        cosines[k] = (float)cos(gauss_16(k, 0.0, pi, &w));
        weights[k] = (float)w;
    }
    for (int i = 0; i < SHEEN_NODES; i++) {
        float NdotL = nodes->NdotL[i];
        /* (N.H)^2 = (N.V + N.L)^2 / |V + L|^2, and that is 2 + 2 V.L = level + swing cos p */
        float level = 2.0f + 2.0f * mu * NdotL;
        float swing = 2.0f * sin_v * sqrt((1.0f - NdotL) * (1.0f + NdotL));
        float square = (mu + NdotL) * (mu + NdotL);
        if (square / (level + swing) >= (1.0f - nodes->least_sine) * (1.0f + nodes->least_sine))
            break; /* 0 here, where the ring is strongest, hence on the following ones */
        float places[LONGITUDES];
        for (int k = 0; k < LONGITUDES; k++) {
            float sine = sqrt(max(1.0f - square / (level + swing * cosines[k]), 0.0f));
            places[k] = max((sine - nodes->least_sine) * nodes->D_scale, 0.0f);
        }
        float D = 0.0f;
        for (int k = 0; k < LONGITUDES; k++)
            D += weights[k] * read_table(nodes, places[k]);
        double w = 2.0 * (double)(nodes->weight[i] * D); /* 2: p and -p */
        sum.charlie += w / (double)(4.0f * mu * (1.0f + Lambda_V + nodes->Lambda[i]));
        sum.neubelt += w * (double)(NdotL * V_Neubelt(NdotL, mu));
    }
    return sum;
}
