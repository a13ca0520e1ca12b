/* fit_minimize.c - see fit_minimize.h. */
#include <math.h>
#include <string.h>

#include "legacy/fit_minimize.h"

double fit_minimize_1(fit_function f, void *context, double low, double high, int count, double tolerance,
                      double *x)
{
    static const double golden = 0.61803398874989484820;
    double step = (high - low) / (count - 1);
    double best = (double)INFINITY;
    double best_x = low;
    for (int i = 0; i < count; i++) {
        double at = i == count - 1 ? high : low + step * i;
        double value = f(context, &at);
        if (value < best) {
            best = value;
            best_x = at;
        }
    }
    double a = fmax(low, best_x - step);
    double b = fmin(high, best_x + step);
    double c = b - golden * (b - a);
    double d = a + golden * (b - a);
    double f_c = f(context, &c);
    double f_d = f(context, &d);
    while (b - a > tolerance) {
        if (f_c < f_d) {
            b = d;
            d = c;
            f_d = f_c;
            c = b - golden * (b - a);
            f_c = f(context, &c);
        } else {
            a = c;
            c = d;
            f_c = f_d;
            d = a + golden * (b - a);
            f_d = f(context, &d);
        }
    }
    if (fmin(f_c, f_d) < best)
        best_x = f_c < f_d ? c : d;
    *x = best_x;
    return f(context, x);
}

typedef struct vertex {
    double x[FIT_MAX_VARIABLES], value;
} vertex;

/* The value at center + factor (worst - center). */
static vertex try_at(fit_function f, void *context, int n, const double *center, const vertex *worst,
                     double factor)
{
    vertex v;
    for (int i = 0; i < n; i++)
        v.x[i] = fmin(fmax(center[i] + factor * (worst->x[i] - center[i]), 0.0), 1.0);
    v.value = f(context, v.x);
    return v;
}

static void sort_vertices(vertex *s, int count)
{
    for (int i = 1; i < count; i++) {
        vertex v = s[i];
        int j = i;
        for (; j > 0 && s[j - 1].value > v.value; j--)
            s[j] = s[j - 1];
        s[j] = v;
    }
}

double fit_minimize_n(fit_function f, void *context, int n, double *x, const double *step, double tolerance,
                      int limit)
{
    vertex s[FIT_MAX_VARIABLES + 1];
    int calls = n + 1;
    for (int i = 0; i <= n; i++) {
        memcpy(s[i].x, x, (size_t)n * sizeof *x);
        if (i < n) /* away from a bound */
            s[i].x[i] += x[i] + step[i] <= 1.0 ? step[i] : -step[i];
        s[i].value = f(context, s[i].x);
    }
    for (;;) {
        sort_vertices(s, n + 1);
        if (calls >= limit || s[n].value - s[0].value <= tolerance * s[0].value)
            break;
        double center[FIT_MAX_VARIABLES] = {0.0};
        for (int i = 0; i < n; i++)
            for (int j = 0; j < n; j++)
                center[i] += s[j].x[i] / n;
        vertex v = try_at(f, context, n, center, &s[n], -1.0);
        calls++;
        if (v.value < s[0].value) {
            vertex further = try_at(f, context, n, center, &s[n], -2.0);
            calls++;
            s[n] = further.value < v.value ? further : v;
        } else if (v.value < s[n - 1].value) {
            s[n] = v;
        } else {
            vertex nearer = try_at(f, context, n, center, &s[n], v.value < s[n].value ? -0.5 : 0.5);
            calls++;
            if (nearer.value < fmin(v.value, s[n].value)) {
                s[n] = nearer;
                continue;
            }
            for (int j = 1; j <= n; j++)
                s[j] = try_at(f, context, n, s[0].x, &s[j], 0.5);
            calls += n;
        }
    }
    memcpy(x, s[0].x, (size_t)n * sizeof *x);
    return f(context, x);
}
