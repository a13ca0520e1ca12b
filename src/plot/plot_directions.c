/* plot_directions.c - where light comes from in a plot, close enough together that no peak is cut. See plot_build.h. */
#include <math.h>
#include <stdlib.h>

#include "plot/plot_build.h"

void plot_direction(double angle_rad, double azimuth_rad, float out[3])
{
    double s = sin(angle_rad);
    out[0] = (float)(s * cos(azimuth_rad));
    out[1] = (float)(s * sin(azimuth_rad));
    out[2] = (float)cos(angle_rad);
}

static int compare(const void *a, const void *b)
{
    double x = *(const double *)a;
    double y = *(const double *)b;
    return (x > y) - (x < y);
}

enum {
    EVEN = 357,    /* half a degree apart, nearly */
    NEAR_PEAK = 81 /* per width */
};

/* Widths of all subjects, each once. */
static size_t widths_of(const plot *p, double *widths)
{
    size_t count = 0;
    for (uint32_t i = 0; i < p->subject_count; i++) {
        double width = material_width(&p->subjects[i].material);
        bool is_new = width < 0.5;
        for (size_t k = 0; k < count; k++)
            is_new = is_new && fabs(widths[k] / width - 1.0) > 0.1;
        if (is_new)
            widths[count++] = width;
    }
    return count;
}

/* The half vector turns by half the light's angle, and D falls to a quarter at tan theta_h = alpha: places even in
 * atan(tan theta_h / alpha) follow D from its peak to its tail. */
double *plot_light_angles(plot *p, double view_rad, size_t *count)
{
    const double limit = 89.9 * PLOT_DEGREE;
    double widths[2 * FACET_PLOT_MAX_MATERIALS];
    size_t width_count = widths_of(p, widths);
    double *x = plot_numbers(p, EVEN + width_count * NEAR_PEAK);
    *count = 0;
    if (!x)
        return NULL;
    size_t n = 0;
    for (int i = 0; i < EVEN; i++)
        x[n++] = limit * (2.0 * i / (EVEN - 1) - 1.0);
    for (size_t k = 0; k < width_count; k++)
        for (int i = 0; i < NEAR_PEAK; i++) {
            double u = 88.0 * PLOT_DEGREE * (2.0 * i / (NEAR_PEAK - 1) - 1.0);
            double angle = -view_rad + 2.0 * atan(widths[k] * tan(u));
            if (fabs(angle) < limit)
                x[n++] = angle;
        }
    qsort(x, n, sizeof *x, compare);
    for (size_t i = 0; i < n; i++) /* each once: closer than floats of directions differ is the same */
        if (*count == 0 || x[i] - x[*count - 1] > 1e-7)
            x[(*count)++] = x[i];
    return x;
}

double (*plot_slice(plot *p, const material *m, double view_rad, size_t count, const double *angles,
                    bool has_cosine))[3]
{
    float V[3];
    float(*L)[3] = plot_alloc(p, count, sizeof *L);
    double(*f)[3] = plot_alloc(p, count, sizeof *f);
    if (!L || !f || !angles)
        return NULL;
    plot_direction(view_rad, 0.0, V);
    for (size_t i = 0; i < count; i++)
        plot_direction(angles[i], 0.0, L[i]);
    material_brdf_cos(m, V, count, (const float(*)[3])L, f);
    for (size_t i = 0; i < count && !has_cosine; i++)
        for (int c = 0; c < 3; c++)
            f[i][c] /= (double)L[i][2];
    return f;
}
