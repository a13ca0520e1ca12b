/* glass_generate.c - computes the table of the terms of a rough dielectric boundary; runs when facet is built.
 * usage: glass_generate OUTPUT
 *
 * integrate_glass() of shade/glass.h: means over visible normals, seen from the rarer side first, then from the denser
 * one. The integrands jump at the horizon and at the critical angle, so points of low discrepancy do as well as a rule. */
#include <math.h>
#include <stdio.h>

#include "ibl/dfg.h"

#include "shade/shade.h"

enum { TERMS = 4096 };

int main(int argc, char **argv)
{
    FILE *file = argc == 2 ? fopen(argv[1], "w") : NULL;
    if (!file) {
        fprintf(stderr, "usage: glass_generate OUTPUT\n");
        return 1;
    }
    for (int node = 0; node < 2 * GLASS_IORS; node++) {
        float z = (float)(node % GLASS_IORS) / (GLASS_IORS - 1);
        float root = GLASS_ROOT_MAX * z * z;
        float ior = (1.0f + root) / (1.0f - root);
        float eta = node < GLASS_IORS ? ior : 1.0f / ior;
        for (int y = 0; y < GLASS_SIZE; y++)
            for (int x = 0; x < GLASS_SIZE; x++) {
                float cosine = (float)x / (GLASS_SIZE - 1);
                vec3 g = integrate_glass((float)y / (GLASS_SIZE - 1), cosine * cosine, eta, TERMS);
                for (int i = 0; i < 3; i++)
                    fprintf(file, "%.0f,", (double)min(g[i] * GLASS_UNIT, GLASS_UNIT));
                fprintf(file, "\n");
            }
    }
    return fclose(file) == 0 ? 0 : 1;
}
