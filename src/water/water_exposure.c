/* water_exposure.c - see water_exposure.h. */
#include "water/water_exposure.h"

#include <math.h>

#include "water/water_sky.h"

static const double DOME_CONSTANT = 340.0; /* lx s */

facet_result water_exposure_ev100(const facet_sea_render_desc *desc, double *ev100, facet_error *error)
{
    water_sky sky;
    *ev100 = 0.0;
    facet_result result = water_sky_create_light(desc, &sky, error);
    if (result == FACET_OK) {
        vec3 E = sky.sun_irradiance * max(sky.L[1], 0.0f) + sky.sky_irradiance;
        double lux = 0.2126 * (double)E[0] + 0.7152 * (double)E[1] + 0.0722 * (double)E[2];
        *ev100 = (log2)(100.0 / DOME_CONSTANT * (lux > 1.0 ? lux : 1.0));
    }
    water_sky_destroy(&sky);
    return result;
}

double water_exposure_ev(double ev100)
{
    return -ev100 - (log2)(1.2);
}
