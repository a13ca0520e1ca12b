/* meter.h - exposure metering of a film before tone mapping. */
#ifndef FILM_METER_H
#define FILM_METER_H

#include "film/film.h"

/* Log-average luminance of a metered image: middle grey plus a third of a stop, since water with sky and
 * models on white should be brighter. Reinhard et al. 2002, equation 1, whose key of 0.18 lies between their
 * 0.09 and 0.36 for dark and bright scenes. */
#define METER_KEY 0.22

/* Log-average: exp of the mean of ln(luminance), weighted by opacity, with luminance clamped to floor. 0: no
 * pixel is covered. */
double film_log_average(const film *f, double floor);
/* Mean luminance, weighted by opacity. 0: no pixel is covered. */
double film_average(const film *f);
/* Log-average of a model: luminance is clamped to 1/1024 of the mean, so that black parts do not outweigh the
 * others. 0: no pixel is covered, or all are black. */
double film_meter(const film *f);

bool film_is_covered(const film *f);
/* Whether the median luminance of the covered pixels exceeds most. */
bool film_is_brighter_than(const film *f, float most);

/* EV100 that maps a log-average (cd/m^2) to METER_KEY, and facet_render_desc.exposure_ev for an EV100: log2
 * of 1 / (1.2 2^EV100), which maps the saturation of a camera's sensor to 1. ISO 12232; Lagarde and de
 * Rousiers 2014, section 5.1. */
double meter_ev100(double log_average);
double meter_exposure_ev(double ev100);

#endif
