/* water_exposure.h - the exposure that a camera would choose: of the sea. */
#ifndef WATER_WATER_EXPOSURE_H
#define WATER_WATER_EXPOSURE_H

#include "ocean/sea.h"

/* EV at ISO 100 for what desc's camera sees of the sea as it is, by a meter for reflected light:
 *   EV100 = log2(L / (1.2 key)),  L = exp(mean of ln(L_i))  over the pixels of a small image, in cd/m^2
 * (film/meter.h). Averages below 1e-3 cd/m^2 count as that: a night without a moon stays dark, which desc's log is told. Of desc,
 * samples, crop and exposure do not matter, and looks count as physical without glints. Members are resolved already. Fails as
 * water_render(). */
facet_result water_exposure_ev100(const facet_sea *sea, const facet_sea_render_desc *desc, double *ev100,
                                  facet_error *error);

#endif
