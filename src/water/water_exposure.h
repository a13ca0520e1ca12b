/* water_exposure.h - the exposure that a camera would choose: one place for the rule. */
#ifndef WATER_WATER_EXPOSURE_H
#define WATER_WATER_EXPOSURE_H

#include "ocean/sea.h"

/* EV at ISO 100 for what desc's camera sees of the sea as it is, by a meter for reflected light:
 *   EV100 = log2(L / (1.2 key)),  L = exp(mean of ln(L_i))  over the pixels of a small picture, in cd/m^2
 * so that water_exposure_ev() brings the log-average to the key, 0.22: middle grey, and the third of a stop by which water and sky are
 * brighter. Reinhard et al. 2002, equation 1, whose key of 0.18 is between their 0.09 and 0.36 for dark and bright scenes. Averages below
 * 1e-3 cd/m^2 count as that: a night without a moon stays dark, which desc's log is told. Of desc, samples, crop and exposure do
 * not matter, and looks count as physical without glints. Members are resolved already. Fails as water_render(). */
facet_result water_exposure_ev100(const facet_sea *sea, const facet_sea_render_desc *desc, double *ev100,
                                  facet_error *error);

/* facet_render_desc.exposure_ev for an EV100: log2 of 1 / (1.2 2^EV100), which brings what saturates a camera's sensor to 1.
 * ISO 12232; Lagarde and de Rousiers 2014, section 5.1. */
double water_exposure_ev(double ev100);

#endif
