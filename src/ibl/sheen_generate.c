/* sheen_generate.c - computes the table of sheen's directional albedo; runs when facet is built.
 * usage: sheen_generate OUTPUT
 *
 *   E = integral of D / (4 N.V (1 + Lambda(N.V) + Lambda(N.L))) dL,  as V_Charlie = 1 / (4 N.L N.V (1 + Lambda + Lambda))
 *
 * over the hemisphere of L, by Gauss and Legendre's rule: panels of N.L that triple in width from 1e-5, because Lambda
 * rises like a small power of it; 24 points of longitude. Not clamped. */
#include <math.h>
#include <stdio.h>

#include "ibl/dfg.h"

#include "shade/shade.h"

static const double pi = 3.14159265358979323846;

/* Gauss and Legendre's nodes in (0, 1) of 8 points, mirrored at 0, and their weights. */
static const double node[4] = {0.1834346424956498, 0.5255324099163290, 0.7966664774136267,
                               0.9602898564975363};
static const double node_weight[4] = {0.3626837833783620, 0.3137066458778873, 0.2223810344533745,
                                      0.1012285362903763};
enum { POINTS = 8, LONGITUDE_PANELS = 3 };

static double point(int i, double from, double to, double *weight)
{
    double x = i < 4 ? -node[3 - i] : node[i - 4];
    *weight = 0.5 * (to - from) * node_weight[i < 4 ? 3 - i : i - 4];
    return 0.5 * (from + to) + 0.5 * (to - from) * x;
}

/* The integral of D over longitude. */
static double ring(double NdotV, double NdotL, float alpha)
{
    double sines = (sqrt)((1.0 - NdotV * NdotV) * (1.0 - NdotL * NdotL));
    double sum = 0.0;
    for (int panel = 0; panel < LONGITUDE_PANELS; panel++)
        for (int i = 0; i < POINTS; i++) {
            double w;
            double p = point(i, panel * pi / LONGITUDE_PANELS, (panel + 1) * pi / LONGITUDE_PANELS, &w);
            double VdotL = NdotV * NdotL + sines * (cos)(p);
            double NdotH = (NdotV + NdotL) / (sqrt)(2.0 + 2.0 * VdotL);
            sum += 2.0 * w * (double)D_Charlie((float)fmin(NdotH, 1.0), alpha); /* 2: p and -p */
        }
    return sum;
}

static double integrate(float sheen_roughness, double NdotV)
{
    if (sheen_roughness == 0.0f) /* a rim without width; that of the least alpha would sparkle */
        return 0.0;
    float alpha = sheen_alpha(sheen_roughness);
    double Lambda_V = (double)Lambda_Charlie((float)NdotV, alpha);
    double sum = 0.0;
    double to = 1e-5;
    for (double from = 0.0; from < 1.0; from = to, to = fmin(3.0 * to, 1.0))
        for (int i = 0; i < POINTS; i++) {
            double w;
            double NdotL = point(i, from, to, &w);
            double Lambda_L = (double)Lambda_Charlie((float)NdotL, alpha);
            sum += w * ring(NdotV, NdotL, alpha) / (4.0 * NdotV * (1.0 + Lambda_V + Lambda_L));
        }
    return sum;
}

int main(int argc, char **argv)
{
    FILE *file = argc == 2 ? fopen(argv[1], "w") : NULL;
    if (!file) {
        fprintf(stderr, "usage: sheen_generate OUTPUT\n");
        return 1;
    }
    for (int y = 0; y < SHEEN_SIZE; y++) {
        fprintf(file, "{\n");
        for (int x = 0; x < SHEEN_SIZE; x++) {
            double root = (double)x / (SHEEN_SIZE - 1);
            double E = integrate((float)y / (SHEEN_SIZE - 1), fmax(root * root, (double)NDOTV_MIN));
            fprintf(file, "%.6ef,\n", E > 1e-30 ? E : 0.0); /* below that, no float of full precision */
        }
        fprintf(file, "},\n");
    }
    return fclose(file) == 0 ? 0 : 1;
}
