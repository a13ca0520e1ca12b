/* sea_spectrum.c - variance density of elevation over frequency, over direction, and over wave vectors;
 * dispersion. */
#define _DEFAULT_SOURCE
#include "ocean/sea_state.h"

#include <math.h>

/* S = alpha g^2 omega^-5 exp(-1.25 (omega_p / omega)^4) gamma^r, r = exp(-(omega - omega_p)^2 / (2 sigma^2
 * omega_p^2)). Hasselmann et al. 1973; with gamma 1 that of Pierson and Moskowitz 1964. */
static double jonswap(const wave_system *w, double omega)
{
    double x = w->peak_omega / omega;
    double sigma = x >= 1.0 ? 0.07 : 0.09;
    double off = (1.0 / x - 1.0) / sigma;
    double peak = pow(w->gamma, exp(-0.5 * off * off));
    return w->alpha * GRAVITY * GRAVITY * pow(omega, -5.0) * exp(-1.25 * x * x * x * x) * peak;
}

/* Depth attenuation of a spectrum: tanh^2(kH) / (1 + 2kH / sinh 2kH), k from omega^2 = g k tanh kH.
 * Kitaigorodskii et al. 1975; Bouws et al. 1985. As there, k ignores surface tension, which matters only
 * where the factor is 1. */
static double kitaigorodskii(double omega, double depth_m)
{
    double omega_h = omega * sqrt(depth_m / GRAVITY);
    if (omega_h > 4.0) /* 1 - 2e-12 */
        return 1.0;
    double y = omega_h * omega_h; /* kH tanh kH */
    double kH = fmax(y, omega_h);
    for (int i = 0; i < 30; i++) {
        double t = tanh(kH);
        double step = (kH * t - y) / (t + kH * (1.0 - t * t));
        kH -= step;
        if (fabs(step) <= 1e-15 * kH)
            break;
    }
    double t = tanh(kH);
    return t * t / (1.0 + 2.0 * kH / sinh(2.0 * kH));
}

/* S(k) = (B_l + B_h) / k^3, in m^3. Elfouhaily et al. 1997, equations 30 to 41. */
static double elfouhaily(const wave_system *w, double k)
{
    const double k_m = 370.0, c_m = 0.23;
    double U = w->wind_mps, Omega = w->inverse_age;
    double k_p = GRAVITY * Omega * Omega / (U * U);
    double c = sqrt(GRAVITY / k * (1.0 + k * k / (k_m * k_m)));
    double c_p = sqrt(GRAVITY / k_p * (1.0 + k_p * k_p / (k_m * k_m)));
    double z_0 = 3.7e-5 * U * U / GRAVITY * pow(U / c_p, 0.9);
    double friction = 0.41 * U / log(10.0 / z_0); /* u* */
    double root = sqrt(k / k_p);
    double L_PM = exp(-1.25 * (k_p / k) * (k_p / k));
    double gamma = Omega <= 1.0 ? 1.7 : 1.7 + 6.0 * log10(Omega);
    double sigma = 0.08 * (1.0 + 4.0 / (Omega * Omega * Omega));
    double J_p = pow(gamma, exp(-(root - 1.0) * (root - 1.0) / (2.0 * sigma * sigma)));
    double F_p = L_PM * J_p * exp(-Omega / sqrt(10.0) * (root - 1.0));
    double B_l = 0.5 * 0.006 * pow(Omega, 0.55) * c_p / c * F_p;
    double ratio = log(friction / c_m);
    double alpha_m = 0.01 * (1.0 + (ratio < 0.0 ? 1.0 : 3.0) * ratio);
    double F_m = L_PM * exp(-0.25 * (k / k_m - 1.0) * (k / k_m - 1.0));
    double B_h = fmax(0.0, 0.5 * alpha_m * c_m / c * F_m);
    return (B_l + B_h) / (k * k * k);
}

/* A swell has lost its short waves: exp(-(omega / 3 omega_p)^4). */
static double swell_cut(const wave_system *w, double omega)
{
    double x = omega / (3.0 * w->peak_omega);
    return exp(-x * x * x * x);
}

double wave_spectrum(const wave_system *w, double omega, double depth_m)
{
    if (!(w->peak_omega > 0.0) || !(omega > 0.15 * w->peak_omega)) /* exp(-1.25 / 0.15^4) is 0 */
        return 0.0;
    double density;
    if (w->spectrum == FACET_SEA_SPECTRUM_ELFOUHAILY) {
        double k = wave_k(omega, ENDLESS);
        density = elfouhaily(w, k) / wave_domega_dk(k, ENDLESS);
    } else {
        density = jonswap(w, omega);
    }
    if (!(w->wind_mps > 0.0))
        density *= swell_cut(w, omega);
    return w->scale * density * kitaigorodskii(omega, depth_m);
}

sea_ring sea_ring_at(const sea_state *s, double k)
{
    sea_ring ring = {{0.0}, {{0}}, {0.0}};
    double omega = wave_omega(k, s->depth_m);
    double jacobian = wave_domega_dk(k, s->depth_m) / k;
    for (int i = 0; i < SEA_SYSTEMS; i++) {
        const wave_system *w = &s->systems[i];
        if (!(w->peak_omega > 0.0))
            continue;
        ring.density[i] = wave_spectrum(w, omega, s->depth_m) * jacobian;
        if (w->wind_mps > 0.0 && k > s->taper_k)
            ring.density[i] *= s->taper;
        ring.direction[i] = w->direction;
        ring.directions[i] = wave_directions_at(w, omega);
    }
    return ring;
}

double sea_ring_density(const sea_ring *r, double theta)
{
    double sum = 0.0;
    for (int i = 0; i < SEA_SYSTEMS; i++)
        if (r->density[i] > 0.0)
            sum += r->density[i] * wave_directions_density(&r->directions[i], theta - r->direction[i]);
    return sum;
}

double sea_density(const sea_state *s, double kx, double kz)
{
    sea_ring ring = sea_ring_at(s, hypot(kx, kz));
    return sea_ring_density(&ring, atan2(kz, kx));
}

/* ---- directions ---- */

static const double PI_D = 3.14159265358979323846;

/* D = Q(s) |cos(theta / 2)|^2s, Q = Gamma(s + 1) / (2 sqrt(pi) Gamma(s + 1/2)). Hasselmann et al. 1980,
 * with the elongation that Horvath 2015 adds: 16 tanh(omega_p / omega) xi^2, which makes the long waves
 * long-crested. */
static wave_directions hasselmann(const wave_system *w, double omega)
{
    double x = omega / w->peak_omega;
    double s = x <= 1.0 ? 6.97 * pow(x, 4.06) : 9.77 * pow(x, -2.33 - 1.45 * (w->inverse_age - 1.17));
    s += 16.0 * tanh(1.0 / x) * w->elongation * w->elongation;
    int sign; /* lgamma() would write the sign to a global */
    double norm = exp(lgamma_r(s + 1.0, &sign) - lgamma_r(s + 0.5, &sign)) / (2.0 * sqrt(PI_D));
    return (wave_directions){FACET_SEA_SPREADING_HASSELMANN, norm, s};
}

/* D = beta sech^2(beta theta) / (2 tanh(beta pi)). Donelan, Hamilton and Hui 1985; beyond 1.6 omega_p
 * Banner 1990. */
static wave_directions donelan_banner(const wave_system *w, double omega)
{
    double x = fmax(omega / w->peak_omega, 0.56);
    double beta = x < 0.95  ? 2.61 * pow(x, 1.3)
                  : x < 1.6 ? 2.28 * pow(x, -1.3)
                            : pow(10.0, -0.4 + 0.8393 * exp(-0.567 * log(x * x)));
    return (wave_directions){FACET_SEA_SPREADING_DONELAN_BANNER, beta / (2.0 * tanh(beta * PI_D)), beta};
}

wave_directions wave_directions_at(const wave_system *w, double omega)
{
    switch (w->spreading) {
    case FACET_SEA_SPREADING_DONELAN_BANNER:
        return donelan_banner(w, omega);
    case FACET_SEA_SPREADING_COSINE:
        return (wave_directions){FACET_SEA_SPREADING_COSINE, 2.0 / PI_D, 0.0};
    case FACET_SEA_SPREADING_HASSELMANN:
        break;
    }
    return hasselmann(w, omega);
}

double wave_directions_density(const wave_directions *d, double theta)
{
    theta = remainder(theta, 2.0 * PI_D);
    switch (d->spreading) {
    case FACET_SEA_SPREADING_DONELAN_BANNER: {
        double sech = 1.0 / cosh(d->power * theta);
        return d->norm * sech * sech;
    }
    case FACET_SEA_SPREADING_COSINE: {
        double c = cos(theta);
        return c > 0.0 ? d->norm * c * c : 0.0;
    }
    case FACET_SEA_SPREADING_HASSELMANN:
        break;
    }
    double c = cos(0.5 * theta);
    return d->norm * pow(c * c, d->power);
}

double wave_spreading(const wave_system *w, double omega, double theta)
{
    wave_directions d = wave_directions_at(w, omega);
    return wave_directions_density(&d, theta);
}

/* ---- dispersion ---- */

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

/* omega(k) is concave, then convex, so a step of Newton's method may not go below half of k. */
double wave_k(double omega, double depth_m)
{
    if (!(omega > 0.0))
        return 0.0;
    double deep = omega * omega / GRAVITY;
    double shallow = omega / sqrt(GRAVITY * depth_m); /* 0 in deep water */
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
