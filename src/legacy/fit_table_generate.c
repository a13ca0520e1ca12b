/* fit_table_generate.c - computes the LUT of fit_metric.h when facet is built. usage: fit_table_generate OUTPUT PACKED
 * OUTPUT is the initializer of a fit_table, PACKED that of its packed bytes.
 *
 * Logarithms of the integrals, and for each shininess the roughness and strength of the GGX lobe that,
 * with a Lambert term, approximates Blinn's best. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "legacy/fit_metric.h"
#include "legacy/fit_minimize.h"
#include "legacy/fit_table.h"

typedef struct shapes {
    const fit_metric *metric;
    float S[FIT_MAX_NODES], P[FIT_MAX_NODES];
    double g;
} shapes;

/* Integral of a b w^power. */
static double product(const fit_metric *m, const float *a, const float *b, int power)
{
    double sum = 0.0;
    for (size_t i = 0; i < m->node_begin[FIT_VIEWS]; i++) {
        double term = (double)m->weight[i] * (double)a[i] * (double)b[i];
        for (int k = 0; k < power; k++)
            term *= (double)m->fresnel[i];
        sum += term;
    }
    return sum;
}

/* The residual of P with the optimal factors of n and S; that of S in g. */
static double distance(void *context, const double *log_r)
{
    shapes *s = context;
    const fit_metric *m = s->metric;
    fit_specular_lobe(m, (float)exp(*log_r), s->S);
    double nn = product(m, m->NdotL, m->NdotL, 0);
    double nS = product(m, m->NdotL, s->S, 0);
    double SS = product(m, s->S, s->S, 0);
    double nP = product(m, m->NdotL, s->P, 0);
    double SP = product(m, s->S, s->P, 0);
    double det = nn * SS - nS * nS;
    double u = (nP * SS - SP * nS) / det;
    s->g = (SP * nn - nP * nS) / det;
    return -(u * nP + s->g * SP) / product(m, s->P, s->P, 0);
}

/* Rounds a value as the compiler reads its text. */
static void add_value(FILE *file, double value, float *out)
{
    char text[24];
    snprintf(text, sizeof text, "%.8e", value);
    fprintf(file, "%sf,", text);
    *out = strtof(text, NULL);
}

static void add_values(FILE *file, const char *name, int count, const double *values, float *out)
{
    fprintf(file, "%s = {", name);
    for (int i = 0; i < count; i++) {
        fputc(i % 6 ? ' ' : '\n', file);
        add_value(file, values[i], out + i);
    }
    fprintf(file, "},\n");
}

int main(int argc, char **argv)
{
    static shapes s;
    static double SP[2][GRAM_R * GRAM_S];
    double nn[3];
    double of_r[6][GRAM_R]; /* nS, SS by power */
    double of_s[5][GRAM_S]; /* nP by power, PP; nearest roughness, its factor */
    fit_metric *m = NULL;
    FILE *file = argc == 3 ? fopen(argv[1], "w") : NULL;
    FILE *packed = argc == 3 ? fopen(argv[2], "w") : NULL;
    if (!file || !packed || fit_metric_create(NULL, PBR_CORRELATED, &m, NULL) != FACET_OK) {
        fprintf(stderr, "usage: fit_table_generate OUTPUT PACKED\n");
        return 1;
    }
    s.metric = m;
    for (int k = 0; k < 3; k++)
        nn[k] = product(m, m->NdotL, m->NdotL, k);
    for (int j = 0; j < GRAM_S; j++) {
        double log_r;
        fit_highlight(m, (float)expm1(j * GRAM_STEP_S), s.P);
        fit_minimize_1(distance, &s, GRAM_LOG_R, 0.0, 47, 1e-5, &log_r);
        for (int k = 0; k < 2; k++)
            of_s[k][j] = log(product(m, m->NdotL, s.P, k));
        of_s[2][j] = log(product(m, s.P, s.P, 0));
        of_s[3][j] = j ? log_r : 0.0; /* constant radiance: the largest roughness (0.999) */
        of_s[4][j] = log(s.g);
    }
    for (int i = 0; i < GRAM_R; i++) {
        fit_specular_lobe(m, (float)exp(GRAM_LOG_R + i * GRAM_STEP_R), s.S);
        for (int k = 0; k < 3; k++) {
            of_r[k][i] = log(product(m, m->NdotL, s.S, k));
            of_r[3 + k][i] = log(product(m, s.S, s.S, k));
        }
        for (int j = 0; j < GRAM_S; j++) {
            fit_highlight(m, (float)expm1(j * GRAM_STEP_S), s.P);
            for (int k = 0; k < 2; k++)
                SP[k][i * GRAM_S + j] = log(product(m, s.S, s.P, k));
        }
    }
    static const char *const names_r[6] = {".nS[0]", ".nS[1]", ".nS[2]", ".SS[0]", ".SS[1]", ".SS[2]"};
    static const char *const names_s[5] = {".nP[0]", ".nP[1]", ".PP", ".nearest_r", ".nearest_g"};
    static fit_table t;
    float *const to_s[5] = {t.nP[0], t.nP[1], t.PP, t.nearest_r, t.nearest_g};
    fprintf(file, "/* By fit_table_generate.c. */\n");
    add_values(file, ".nn", 3, nn, t.nn);
    for (int i = 0; i < 6; i++)
        add_values(file, names_r[i], GRAM_R, of_r[i], i < 3 ? t.nS[i] : t.SS[i - 3]);
    for (int i = 0; i < 5; i++)
        add_values(file, names_s[i], GRAM_S, of_s[i], to_s[i]);
    add_values(file, ".SP[0]", GRAM_R * GRAM_S, SP[0], t.SP[0]);
    add_values(file, ".SP[1]", GRAM_R * GRAM_S, SP[1], t.SP[1]);
    fit_table_write(packed, &t);
    fit_metric_destroy(m);
    return fclose(file) == 0 && fclose(packed) == 0 ? 0 : 1;
}
