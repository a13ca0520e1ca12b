/* dfg_generate.c - computes the split-sum table (dfg_integrate.h); runs when facet is built.
 * usage: dfg_generate OUTPUT */
#include <stdio.h>

#include "ibl/dfg.h"
#include "ibl/dfg_integrate.h"

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
            dfg_terms t = dfg_integrate(DFG_SMITH_CORRELATED, (float)y / (DFG_SIZE - 1), root * root);
            fprintf(file, "{%.6ef, %.6ef},\n", t.scale, t.bias);
        }
        fprintf(file, "},\n");
    }
    return fclose(file) == 0 ? 0 : 1;
}
