/* sea_dispersion.c - how fast waves of a length run: gravity and surface tension over a bed. */
#include "ocean/sea_state.h"

#include <math.h>

/* tanh(20) is 1 to the last bit of a double. */
static const double DEEP = 20.0;

static double tanh_of_depth(double k, double depth_m)
{
    double kH = k * depth_m;
    return kH < DEEP ? tanh(kH) : 1.0;
}

double wave_omega(double k, double depth_m)
{
    return sqrt((GRAVITY + SURFACE_TENSION_OVER_DENSITY * k * k) * k * tanh_of_depth(k, depth_m));
}

double wave_domega_dk(double k, double depth_m)
{
    double kH = k * depth_m;
    double omega = wave_omega(k, depth_m);
    double d = (GRAVITY + 3.0 * SURFACE_TENSION_OVER_DENSITY * k * k) * tanh_of_depth(k, depth_m);
    if (kH < DEEP) {
        double sech = 1.0 / cosh(kH);
        d += (GRAVITY + SURFACE_TENSION_OVER_DENSITY * k * k) * k * depth_m * sech * sech;
    }
    return d / (2.0 * omega);
}

/* omega(k) falls behind its tangent and runs ahead of it by turns, so a step may not go below half of k. */
double wave_k(double omega, double depth_m)
{
    if (!(omega > 0.0))
        return 0.0;
    double deep = omega * omega / GRAVITY;
    double shallow = omega / sqrt(GRAVITY * depth_m); /* 0 without a bed */
    double k = fmax(deep, shallow);
    double capillary = cbrt(omega * omega / SURFACE_TENSION_OVER_DENSITY);
    if (capillary < k)
        k = capillary;
    for (int i = 0; i < 60; i++) {
        double step = (wave_omega(k, depth_m) - omega) / wave_domega_dk(k, depth_m);
        double next = fmax(k - step, 0.5 * k);
        if (fabs(next - k) <= 1e-15 * k)
            return next;
        k = next;
    }
    return k;
}

double wave_stretch(double k, double depth_m)
{
    return 1.0 / tanh_of_depth(k, depth_m);
}
