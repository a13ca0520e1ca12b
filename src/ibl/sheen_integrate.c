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

void sheen_prepare(float sheen_roughness, sheen_nodes *out)
{
    out->alpha = sheen_roughness > 0.0f ? sheen_alpha(sheen_roughness) : 0.0f;
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

/* |V + L|^2 = 2 + 2 V.L, where V.L = level + swing cos p. */
static float half_cosine(float sum, float level, float swing, float cos_p)
{
    return min(sum * inversesqrt(2.0f + 2.0f * (level + swing * cos_p)), 1.0f);
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
        float level = mu * NdotL;
        float swing = sin_v * sqrt((1.0f - NdotL) * (1.0f + NdotL));
        if (D_Charlie(half_cosine(mu + NdotL, level, swing, 1.0f), alpha) < 1e-20f)
            break; /* that is the most of this ring, and the next ones have less */
        float D = 0.0f;
        for (int k = 0; k < LONGITUDES; k++)
            D += weights[k] * D_Charlie(half_cosine(mu + NdotL, level, swing, cosines[k]), alpha);
        double w = 2.0 * (double)(nodes->weight[i] * D); /* 2: p and -p */
        sum.charlie += w / (double)(4.0f * mu * (1.0f + Lambda_V + nodes->Lambda[i]));
        sum.neubelt += w * (double)(NdotL * V_Neubelt(NdotL, mu));
    }
    return sum;
}
