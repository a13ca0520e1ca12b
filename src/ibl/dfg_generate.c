/* dfg_generate.c - computes the split-sum table; runs when facet is built.
 * usage: dfg_generate OUTPUT */
#include <stdio.h>
#include <stdlib.h>

#include "ibl/dfg.h"

#include "shade/shade.h"

enum { SAMPLE_COUNT = 8192 }; /* deviates from quadrature by less than 1e-4, dfg_test.c */

static vec2 terms(float perceptual_roughness, float NdotV)
{
    if (perceptual_roughness > 0.0f)
        return integrate_dfg(perceptual_roughness, NdotV, SAMPLE_COUNT);
    float Fc = schlick_weight(NdotV); /* a mirror: H = N, and all of V reflected */
    return vec2(1.0f - Fc, Fc);
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
            float root = (float)x / (DFG_SIZE - 1);
            vec2 dfg = terms((float)y / (DFG_SIZE - 1), root * root);
            fprintf(file, "{%.8ef, %.8ef},\n", (double)dfg[0], (double)dfg[1]);
        }
        fprintf(file, "},\n");
    }
    return fclose(file) == 0 ? 0 : 1;
}
