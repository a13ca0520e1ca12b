/* fit_gram.c - lookup in the table that fit_table_generate.c computes when facet is built. */
#include <math.h>

#include "legacy/fit_gram.h"

#include "legacy_fit_table.h"

/* x in nodes from the first: the four nodes around it and Lagrange's weights for them. */
static gram_place find(double x, int count)
{
    gram_place p;
    double node = fmin(fmax(x, 0.0), count - 1.0);
    int first = (int)node - 1;
    p.first = first < 0 ? 0 : first > count - 4 ? count - 4 : first;
    double t = node - p.first;
    p.weight[0] = (t - 1.0) * (t - 2.0) * (t - 3.0) / -6.0;
    p.weight[1] = t * (t - 2.0) * (t - 3.0) / 2.0;
    p.weight[2] = t * (t - 1.0) * (t - 3.0) / -2.0;
    p.weight[3] = t * (t - 1.0) * (t - 2.0) / 6.0;
    return p;
}

static double mean_log(const float *logs, const double *weight)
{
    return (double)logs[0] * weight[0] + (double)logs[1] * weight[1] + (double)logs[2] * weight[2] +
           (double)logs[3] * weight[3];
}

static double value(const float *logs, const gram_place *p)
{
    return exp(mean_log(logs + p->first, p->weight));
}

gram_place fit_gram_roughness(fit_gram *gram, double perceptual_roughness)
{
    gram_place p = find((log(fmax(perceptual_roughness, 1e-9)) - GRAM_LOG_R) / GRAM_STEP_R, GRAM_R);
    static const float *const nS[3] = {log_nS0, log_nS1, log_nS2};
    static const float *const SS[3] = {log_SS0, log_SS1, log_SS2};
    for (int k = 0; k < 3; k++) {
        gram->nS[k] = value(nS[k], &p);
        gram->SS[k] = value(SS[k], &p);
        gram->nn[k] = (double)table_nn[k];
    }
    return p;
}

gram_place fit_gram_shininess(fit_gram *gram, double shininess)
{
    gram_place p = find(log1p(fmax(shininess, 0.0)) / GRAM_STEP_S, GRAM_S);
    gram->nP[0] = value(log_nP0, &p);
    gram->nP[1] = value(log_nP1, &p);
    gram->PP = value(log_PP, &p);
    return p;
}

void fit_gram_both(fit_gram *gram, const gram_place *roughness, const gram_place *shininess)
{
    double sum[2] = {0.0, 0.0};
    for (int i = 0; i < 4; i++) {
        int at = (roughness->first + i) * GRAM_S + shininess->first;
        sum[0] += roughness->weight[i] * mean_log(log_SP0 + at, shininess->weight);
        sum[1] += roughness->weight[i] * mean_log(log_SP1 + at, shininess->weight);
    }
    gram->SP[0] = exp(sum[0]);
    gram->SP[1] = exp(sum[1]);
}

/* ---- the lobe nearest to Blinn's ---- */

/* Linear between nodes, so that what falls in the table falls everywhere; beyond the last with the last's slope. */
static double along(const float *logs, double x)
{
    double node = fmax(x, 0.0);
    int first = node < GRAM_S - 2.0 ? (int)node : GRAM_S - 2;
    double t = node - first;
    return (double)logs[first] * (1.0 - t) + (double)logs[first + 1] * t;
}

fit_nearest fit_gram_nearest(double shininess)
{
    double x = log1p(fmax(shininess, 0.0)) / GRAM_STEP_S;
    return (fit_nearest){exp(along(log_nearest_r, x)), exp(along(log_nearest_g, x))};
}

double fit_gram_nearest_shininess(double perceptual_roughness)
{
    static const double most = 1e5;
    double wanted = log(fmax(perceptual_roughness, 1e-9));
    if (wanted >= 0.0)
        return 0.0;
    int first = 0;
    int end = GRAM_S - 1;
    while (end - first > 1) { /* falls from node to node */
        int middle = (first + end) / 2;
        if ((double)log_nearest_r[middle] > wanted)
            first = middle;
        else
            end = middle;
    }
    double a = (double)log_nearest_r[first];
    double b = (double)log_nearest_r[first + 1];
    return fmin(expm1((first + (a - wanted) / (a - b)) * GRAM_STEP_S), most);
}
