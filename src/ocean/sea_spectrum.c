/* sea_spectrum.c - how the variance of height is spread over frequencies, and with directions over wave vectors. */
#include "ocean/sea_state.h"

#include <math.h>

/* S = alpha g^2 omega^-5 exp(-1.25 (omega_p / omega)^4) gamma^r, r = exp(-(omega - omega_p)^2 / (2 sigma^2 omega_p^2)).
 * Hasselmann et al. 1973; with gamma 1 that of Pierson and Moskowitz 1964. */
static double jonswap(const wave_system *w, double omega)
{
    double x = w->peak_omega / omega;
    double sigma = x >= 1.0 ? 0.07 : 0.09;
    double off = (1.0 / x - 1.0) / sigma;
    double peak = pow(w->gamma, exp(-0.5 * off * off));
    return w->alpha * GRAVITY * GRAVITY * pow(omega, -5.0) * exp(-1.25 * x * x * x * x) * peak;
}

/* What depth leaves of a spectrum: tanh^2(kH) / (1 + 2kH / sinh 2kH), k from omega^2 = g k tanh kH. Kitaigorodskii et al. 1975;
 * Bouws et al. 1985. Surface tension is left out of k here as there: it acts where the factor is 1. */
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

/* A swell has left its short waves behind: exp(-(omega / 3 omega_p)^4) takes them off. */
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
