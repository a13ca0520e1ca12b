/* sea_spreading.c - how waves of one frequency are spread over directions. Each density has an integral of 1. */
#define _DEFAULT_SOURCE
#include "ocean/sea_state.h"

#include <math.h>

static const double PI_D = 3.14159265358979323846;

/* D = Q(s) |cos(theta / 2)|^2s, Q = Gamma(s + 1) / (2 sqrt(pi) Gamma(s + 1/2)). Hasselmann et al. 1980, with the elongation
 * that Horvath 2015 adds: 16 tanh(omega_p / omega) xi^2, which makes the long waves long-crested. */
static wave_directions hasselmann(const wave_system *w, double omega)
{
    double x = omega / w->peak_omega;
    double s = x <= 1.0 ? 6.97 * pow(x, 4.06) : 9.77 * pow(x, -2.33 - 1.45 * (w->inverse_age - 1.17));
    s += 16.0 * tanh(1.0 / x) * w->elongation * w->elongation;
    int sign; /* lgamma() would put it where all threads see it */
    double norm = exp(lgamma_r(s + 1.0, &sign) - lgamma_r(s + 0.5, &sign)) / (2.0 * sqrt(PI_D));
    return (wave_directions){FACET_SEA_SPREADING_HASSELMANN, norm, s};
}

/* D = beta sech^2(beta theta) / (2 tanh(beta pi)). Donelan, Hamilton and Hui 1985; beyond 1.6 omega_p Banner 1990. */
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
