/* foam_rule.c - where crests break: thresholds of the convergence q = -(D_xx + D_zz), which is Gaussian as the waves are,
 * calibrated such that foam covers what Monahan and O'Muircheartaigh saw.
 *
 * Coverage is an area seen from above, and where water converges there is less of it: the tail is weighted with the Jacobian,
 * whose mean at a given q is 1 - q + (q^2 - sigma^2) / 4 for waves from all sides:
 *     W(z) = Q(z) - sigma phi(z) (1 - sigma z / 4),  q = z sigma. */
#include "ocean/waves.h"

#include <math.h>

static const double ACTIVE_SHARE = 0.1; /* crests that break now, of all foam */

static double upper_tail(double z)
{
    return 0.5 * erfc(z * 0.70710678118654752440);
}

static double normal_density(double z)
{
    return 0.39894228040143267794 * exp(-0.5 * z * z);
}

static double area_beyond(double z, double sigma)
{
    return upper_tail(z) - sigma * normal_density(z) * (1.0 - 0.25 * sigma * z);
}

/* Beyond z = 2 / sigma - 1 the mean Jacobian is below 0, and the area would grow again. */
static double threshold_of(double coverage, double sigma)
{
    if (!(coverage > 0.0) || !(sigma > 0.0))
        return ENDLESS;
    double low = -6.0, high = fmin(8.0, 2.0 / sigma - 1.0);
    for (int i = 0; i < 60; i++) {
        double z = 0.5 * (low + high);
        if (area_beyond(z, sigma) > coverage)
            low = z;
        else
            high = z;
    }
    return 0.5 * (low + high) * sigma;
}

foam_rule foam_rule_create(const waves *w)
{
    const sea_state *s = &w->state;
    double coverage = whitecap_coverage(s->wind_mps), variance = 0.0;
    if (w->tile_count)
        variance = sea_state_moments(s, 0.0, s->bands.k_to[s->bands.count - 1]).convergence;
    double sigma = w->choppiness * sqrt(variance);
    return (foam_rule){.threshold = (float)threshold_of(coverage, sigma),
                       .active_threshold = (float)threshold_of(ACTIVE_SHARE * coverage, sigma),
                       .sigma = (float)sigma,
                       .coverage = (float)coverage};
}
