/* water_exposure.h - the exposure that a photographer's incident light meter would choose: one place for the rule. */
#ifndef WATER_WATER_EXPOSURE_H
#define WATER_WATER_EXPOSURE_H

#include "facet/facet.h"

/* EV at ISO 100 for the light of desc's sky (or environment and sun), by a meter with a dome that lies on the water:
 *   EV100 = log2(100 E / C),  C = 340 lx s
 * ISO 2720; E in lx on a horizontal plane. Light below 1 lx counts as 1: night stays dark.
 * FACET_ERROR_MEMORY, _ARGUMENT. */
facet_result water_exposure_ev100(const facet_sea_render_desc *desc, double *ev100, facet_error *error);

/* facet_render_desc.exposure_ev for an EV100: log2 of 1 / (1.2 2^EV100), which brings what saturates a camera's sensor to 1.
 * ISO 12232; Lagarde and de Rousiers 2014, section 5.1. */
double water_exposure_ev(double ev100);

#endif
