/* sheen_integrate.c - the albedos of sheen in dfg_integrate.h:
 *
 *   E = integral of D V N.L dL over the hemisphere of L,  with V_Charlie = 1 / (4 N.L N.V (1 + Lambda + Lambda))
 *
 * by Gauss and Legendre's rule over longitude and over y, where N.L is y^3, because Lambda rises like a fifth root of it.
 * Panels of y are narrow where smooth lobes end, and one ends at N.L = 1/2, where Lambda has its kink. Behind that N.L is
 * 1 - z^2 / 2, because sines of it have a root at 1. */
#include <math.h>

#include "ibl/dfg_integrate.h"
#include "ibl/gauss.h"

#include "shade/shade.h"

static const double pi = 3.14159265358979323846;

enum { PANELS = SHEEN_NODES / 8, LONGITUDES = 16 };

/* Of y; the last one ends at the root of 1/2. */
static const double panel_ends[PANELS] = {0.0, 0.06, 0.12, 0.18, 0.23, 0.28, 0.35, 0.5, 0.79370052598409974};

/* D is as sin(N, H)^(1 / alpha), which has fallen to 1e-10 at exp(-23 alpha). A step is a 178th of what it falls by e over, or
 * less, and what is read linearly between two entries is 4e-6 off at most. Over (N.H)^2 it would have a root at 1. */
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
        cosines[k] = (float)(cos)(gauss_16(k, 0.0, pi, &w));
        weights[k] = (float)w;
    }
    for (int i = 0; i < SHEEN_NODES; i++) {
        float NdotL = nodes->NdotL[i];
        /* (N.H)^2 = (N.V + N.L)^2 / |V + L|^2, and that is 2 + 2 V.L = level + swing cos p */
        float level = 2.0f + 2.0f * mu * NdotL;
        float swing = 2.0f * sin_v * sqrt((1.0f - NdotL) * (1.0f + NdotL));
        float square = (mu + NdotL) * (mu + NdotL);
        if (square / (level + swing) >= (1.0f - nodes->least_sine) * (1.0f + nodes->least_sine))
            break; /* nothing here, where the ring has most, nor on the next ones */
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
