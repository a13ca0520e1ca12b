/* tables_generate.c - computes the look-up tables of dfg.h; runs when facet is built.
 * usage: tables_generate dfg|sheen|glass OUTPUT */
#include <stdio.h>
#include <string.h>

#include "ibl/dfg.h"
#include "ibl/dfg_integrate.h"

#include "shade/shade.h"

static void write_dfg(FILE *file)
{
    for (int y = 0; y < DFG_SIZE; y++) {
        fprintf(file, "{\n");
        for (int x = 0; x < DFG_SIZE; x++) {
            double root = (double)x / (DFG_SIZE - 1);
            dfg_terms t = dfg_integrate(DFG_SMITH_CORRELATED, (float)y / (DFG_SIZE - 1), root * root);
            fprintf(file, "{%.6ef, %.6ef},\n", t.scale, t.bias);
        }
        fprintf(file, "},\n");
    }
}

static void write_sheen(FILE *file)
{
    for (int y = 0; y < SHEEN_SIZE; y++) {
        sheen_nodes nodes;
        sheen_prepare((float)y / (SHEEN_SIZE - 1), &nodes);
        fprintf(file, "{\n");
        for (int x = 0; x < SHEEN_SIZE; x++) {
            double root = (double)x / (SHEEN_SIZE - 1);
            double E = sheen_integrate(&nodes, root * root).charlie;
            fprintf(file, "%.6ef,\n",
                    E > 1e-30 ? E : 0.0); /* smaller values have no float of full precision */
        }
        fprintf(file, "},\n");
    }
}

/* integrate_glass() of shade/glass.h: means over visible normals, first seen from the rarer side, then
 * from the denser one. The integrands jump at the horizon and at the critical angle, so points of low
 * discrepancy do as well as a quadrature rule. */
static void write_glass(FILE *file)
{
    enum { TERMS = 4096 };
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
}

int main(int argc, char **argv)
{
    static const struct {
        const char *name;
        void (*write)(FILE *file);
    } tables[] = {{"dfg", write_dfg}, {"sheen", write_sheen}, {"glass", write_glass}};
    for (size_t i = 0; i < sizeof tables / sizeof *tables; i++) {
        if (argc != 3 || strcmp(argv[1], tables[i].name) != 0)
            continue;
        FILE *file = fopen(argv[2], "w");
        if (!file) {
            perror(argv[2]);
            return 1;
        }
        tables[i].write(file);
        return fclose(file) == 0 ? 0 : 1;
    }
    fprintf(stderr, "usage: tables_generate dfg|sheen|glass OUTPUT\n");
    return 1;
}
