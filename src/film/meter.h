/* meter.h - what a light meter reads of a film before it is developed: one place for the rule. */
#ifndef FILM_METER_H
#define FILM_METER_H

#include "film/film.h"

/* The log-average that a metered image has: middle grey and a third of a stop more, by which water and sky, and models on white, are
 * brighter. Reinhard et al. 2002, equation 1, whose key of 0.18 is between their 0.09 and 0.36 for dark and bright scenes. */
#define METER_KEY 0.22

/* exp of the mean of ln of luminance, each pixel by its opacity, no luminance below floor. 0: nothing is covered. */
double film_log_average(const film *f, double floor);
/* The mean of luminance, each pixel by its opacity; 0: nothing is covered. */
double film_average(const film *f);
/* The log-average of a model: what is darker than 1/1024 of the mean counts as that, so that black parts do not outweigh the
 * others. 0: nothing is covered, or all is black. */
double film_meter(const film *f);

bool film_is_covered(const film *f);
/* Whether the median luminance of the covered pixels is above most. */
bool film_is_beyond(const film *f, float most);

/* EV at ISO 100 that brings a log-average, cd/m^2, to METER_KEY, and facet_render_desc.exposure_ev for an EV100: log2 of
 * 1 / (1.2 2^EV100), which brings what saturates a camera's sensor to 1. ISO 12232; Lagarde and de Rousiers 2014, section 5.1. */
double meter_ev100(double log_average);
double meter_exposure_ev(double ev100);

#endif
