/* tables_generate.c - computes the look-up tables of dfg.h; runs when facet is built.
 * usage: tables_generate dfg|sheen|glass OUTPUT PACKED HALVES
 * All are initializers: OUTPUT of an array of the values, PACKED of the bytes of packed_table.h, HALVES of those of the values as
 * half floats, whose bits are taken as integers. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/packed_table.h"
#include "ibl/dfg.h"
#include "ibl/dfg_integrate.h"
#include "image/half.h"

#include "shade/shade.h"

static char texts[GLASS_VALUES][16]; /* of the largest table */

static void set_float(size_t i, double value)
{
    snprintf(texts[i], sizeof texts[i], "%.6e", value);
}

static void make_dfg(void)
{
    for (int y = 0; y < DFG_SIZE; y++)
        for (int x = 0; x < DFG_SIZE; x++) {
            double root = (double)x / (DFG_SIZE - 1);
            dfg_terms t = dfg_integrate(DFG_SMITH_CORRELATED, (float)y / (DFG_SIZE - 1), root * root);
            set_float(2 * (size_t)(y * DFG_SIZE + x), t.scale);
            set_float(2 * (size_t)(y * DFG_SIZE + x) + 1, t.bias);
        }
}

static void make_sheen(void)
{
    for (int y = 0; y < SHEEN_SIZE; y++) {
        sheen_nodes nodes;
        sheen_prepare((float)y / (SHEEN_SIZE - 1), &nodes);
        for (int x = 0; x < SHEEN_SIZE; x++) {
            double root = (double)x / (SHEEN_SIZE - 1);
            double E = sheen_integrate(&nodes, root * root).charlie;
            /* smaller values have no float of full precision */
            set_float((size_t)(y * SHEEN_SIZE + x), E > 1e-30 ? E : 0.0);
        }
    }
}

/* integrate_glass() of shade/glass.h: means over visible normals, first seen from the rarer side, then
 * from the denser one. The integrands jump at the horizon and at the critical angle, so points of low
 * discrepancy do as well as a quadrature rule. */
static void make_glass(void)
{
    enum { TERMS = 4096 };
    size_t count = 0;
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
                    snprintf(texts[count++], sizeof *texts, "%.0f",
                             (double)min(g[i] * GLASS_UNIT, GLASS_UNIT));
            }
    }
}

/* Ends the program with an error unless the file is there. */
static FILE *open_output(const char *path)
{
    FILE *file = fopen(path, "w");
    if (!file) {
        perror(path);
        exit(1);
    }
    return file;
}

static bool write_values(const char *path, packed_shape shape)
{
    FILE *file = open_output(path);
    for (size_t i = 0; i < (size_t)shape.channels * shape.width * shape.height * shape.depth; i++)
        fprintf(file, "%s%s,\n", texts[i], strchr(texts[i], 'e') ? "f" : "");
    return fclose(file) == 0;
}

/* As the compiler and dfg_halves.c round them. */
static void round_texts(size_t count)
{
    for (size_t i = 0; i < count; i++) {
        bool is_float = strchr(texts[i], 'e');
        float value = strtof(texts[i], NULL);
        snprintf(texts[i], sizeof texts[i], "%u",
                 half_from_float(is_float ? value : value * (1.0f / GLASS_UNIT)));
    }
}

static bool write_packed(const char *path, packed_shape shape)
{
    FILE *file = open_output(path);
    bool is_exact = packed_table_write(file, shape, texts);
    if (!is_exact)
        fprintf(stderr, "tables_generate: %s: a value cannot be packed\n", path);
    return fclose(file) == 0 && is_exact;
}

int main(int argc, char **argv)
{
    static const struct {
        const char *name;
        packed_shape shape;
        void (*make)(void);
    } tables[] = {
        {"dfg", DFG_SHAPE, make_dfg}, {"sheen", SHEEN_SHAPE, make_sheen}, {"glass", GLASS_SHAPE, make_glass}};
    for (size_t i = 0; i < sizeof tables / sizeof *tables; i++) {
        if (argc != 5 || strcmp(argv[1], tables[i].name) != 0)
            continue;
        tables[i].make();
        const packed_shape shape = tables[i].shape;
        bool is_written = write_values(argv[2], shape) && write_packed(argv[3], shape);
        round_texts((size_t)shape.channels * shape.width * shape.height * shape.depth);
        return is_written && write_packed(argv[4], shape) ? 0 : 1;
    }
    fprintf(stderr, "usage: tables_generate dfg|sheen|glass OUTPUT PACKED HALVES\n");
    return 1;
}
