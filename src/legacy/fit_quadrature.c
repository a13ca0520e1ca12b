/* fit_quadrature.c - the directions that errors are integrated over: views at 0, 30 and 60 degrees, light from the upper
 * hemisphere, weighted with its cosine.
 *
 * Lobes are narrow, so the nodes are half vectors, dL = 4 (V.H) dH (Walter et al. 2007, equation 14). With V at angle v
 * from N and H at t, N.L = 2 (V.H) (N.H) - N.V is positive all around for 2 t < pi / 2 - v, nowhere for 2 t > pi / 2 + v,
 * and for cos p > -cot v cot 2 t between. Panels of t grow by a factor from 1e-5 on: lobes of every width see as many
 * nodes. Where the range of p opens and closes, t is substituted by a square, which takes away the root there. */
#include <math.h>
#include <string.h>

#include "legacy/fit_metric.h"

static const double pi = 3.14159265358979323846;
static const double view_rad[FIT_VIEWS] = {0.0, 0.52359877559829887308, 1.04719755119659774615};

enum { POINTS = 8, MAX_POINTS = 16, GROWING_PANELS = 12 };

/* Gauss and Legendre's nodes in (0, 1) and their weights: roots of P_n by Newton's method. */
static void gauss_legendre(int n, double *x, double *w)
{
    for (int i = 0; i < n; i++) {
        double z = cos(pi * (i + 0.75) / (n + 0.5));
        double slope = 1.0;
        for (int step = 0; step < 8; step++) {
            double p = 1.0;
            double before = 0.0;
            for (int j = 0; j < n; j++) {
                double next = ((2.0 * j + 1.0) * z * p - j * before) / (j + 1.0);
                before = p;
                p = next;
            }
            slope = n * (z * p - before) / (z * z - 1.0);
            z -= p / slope;
        }
        x[i] = 0.5 * (1.0 - z);
        w[i] = 1.0 / ((1.0 - z * z) * slope * slope);
    }
}

typedef struct builder {
    fit_metric *metric;
    int view;
    size_t ring, node;
    double x[POINTS], w[POINTS];               /* along t */
    double arc[MAX_POINTS], arc_w[MAX_POINTS]; /* along p, where it does not go all around */
} builder;

static void add_node(builder *b, double t, double p, double weight)
{
    double v = view_rad[b->view];
    double VdotH = sin(v) * sin(t) * cos(p) + cos(v) * cos(t);
    double NdotL = 2.0 * VdotH * cos(t) - cos(v);
    if (NdotL <= 0.0 || VdotH <= 0.0)
        return; /* by rounding */
    size_t i = b->node++;
    b->metric->ring[i] = (uint16_t)b->ring;
    b->metric->NdotL[i] = (float)NdotL;
    b->metric->VdotH[i] = (float)VdotH;
    b->metric->weight[i] = (float)(weight * sin(t) * 4.0 * VdotH * NdotL);
}

/* All p at one t; p and -p are the same. */
static void add_ring(builder *b, double t, double weight)
{
    double v = view_rad[b->view];
    fit_metric *m = b->metric;
    m->cos_h[b->ring] = (float)cos(t);
    m->sin_h[b->ring] = (float)sin(t);
    m->log_cos_h[b->ring] = (float)(0.5 * log1p(-sin(t) * sin(t)));
    if (v == 0.0) {
        add_node(b, t, 0.0, weight * 2.0 * pi);
    } else if (2.0 * t <= 0.5 * pi - v) { /* the midpoint rule: best for a whole period */
        int n = t < 0.01 ? 4 : t < 0.1 ? 8 : MAX_POINTS;
        for (int i = 0; i < n; i++)
            add_node(b, t, pi * (i + 0.5) / n, weight * 2.0 * pi / n);
    } else {
        double end = acos(fmin(fmax(-cos(v) * cos(2.0 * t) / (sin(v) * sin(2.0 * t)), -1.0), 1.0));
        for (int i = 0; i < MAX_POINTS; i++)
            add_node(b, t, end * b->arc[i], weight * 2.0 * end * b->arc_w[i]);
    }
    b->ring++;
}

/* t from from to to; end -1: a root at from, 1: at to. */
static void add_panel(builder *b, double from, double to, int end)
{
    double width = to - from;
    for (int i = 0; i < POINTS; i++) {
        double x = b->x[i];
        double w = b->w[i] * width;
        if (end < 0)
            add_ring(b, from + width * x * x, w * 2.0 * x);
        else if (end > 0)
            add_ring(b, to - width * x * x, w * 2.0 * x);
        else
            add_ring(b, from + width * x, w);
    }
}

static void add_view(builder *b)
{
    double v = view_rad[b->view];
    double closing = 0.5 * (0.5 * pi - v);
    double end = 0.5 * (0.5 * pi + v);
    double factor = pow(closing / 1e-5, 1.0 / GROWING_PANELS);
    double from = 0.0;
    double to = 1e-5;
    for (int i = 0; i <= GROWING_PANELS; i++) {
        add_panel(b, from, to, 0);
        from = to;
        to = i + 1 < GROWING_PANELS ? to * factor : closing;
    }
    if (end > closing) {
        double quarter = 0.25 * (end - closing);
        add_panel(b, closing, closing + quarter, -1);
        add_panel(b, closing + quarter, closing + 2.0 * quarter, 0);
        add_panel(b, closing + 2.0 * quarter, end - quarter, 0);
        add_panel(b, end - quarter, end, 1);
    }
}

void fit_quadrature(fit_metric *metric)
{
    builder b = {.metric = metric};
    gauss_legendre(POINTS, b.x, b.w);
    gauss_legendre(MAX_POINTS, b.arc, b.arc_w);
    for (b.view = 0; b.view < FIT_VIEWS; b.view++) {
        metric->ring_begin[b.view] = b.ring;
        metric->node_begin[b.view] = b.node;
        metric->NdotV[b.view] = (float)cos(view_rad[b.view]);
        add_view(&b);
        for (size_t last = b.node - 1; b.node % FIT_LANES != 0; b.node++) {
            metric->ring[b.node] = metric->ring[last];
            metric->NdotL[b.node] = metric->NdotL[last];
            metric->VdotH[b.node] = metric->VdotH[last];
            metric->weight[b.node] = 0.0f;
        }
    }
    metric->ring_begin[FIT_VIEWS] = b.ring;
    metric->node_begin[FIT_VIEWS] = b.node;
}
