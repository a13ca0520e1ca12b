/* sheen_generate.c - computes the table of sheen's directional albedo (dfg_integrate.h); runs when facet is built.
 * usage: sheen_generate OUTPUT */
#include <stdio.h>

#include "ibl/dfg.h"
#include "ibl/dfg_integrate.h"

int main(int argc, char **argv)
{
    FILE *file = argc == 2 ? fopen(argv[1], "w") : NULL;
    if (!file) {
        fprintf(stderr, "usage: sheen_generate OUTPUT\n");
        return 1;
    }
    for (int y = 0; y < SHEEN_SIZE; y++) {
        sheen_nodes nodes;
        sheen_prepare((float)y / (SHEEN_SIZE - 1), &nodes);
        fprintf(file, "{\n");
        for (int x = 0; x < SHEEN_SIZE; x++) {
            double root = (double)x / (SHEEN_SIZE - 1);
            double E = sheen_integrate(&nodes, root * root).charlie;
            fprintf(file, "%.6ef,\n", E > 1e-30 ? E : 0.0); /* below that, no float of full precision */
        }
        fprintf(file, "},\n");
    }
    return fclose(file) == 0 ? 0 : 1;
}
