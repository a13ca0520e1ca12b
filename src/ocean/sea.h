/* sea.h - what a facet_sea holds. */
#ifndef OCEAN_SEA_H
#define OCEAN_SEA_H

#include "ocean/sea_kept.h"
#include "ocean/water_optics.h"
#include "ocean/waves.h"

struct facet_sea {
    facet_sea_desc desc;
    waves waves;
    slope_filter slopes;
    foam_rule foam;
    water_optics optics;
    void *_Atomic
        gl; /* what OpenGL draws it with, kept from picture to picture; ocean_api.c's. NULL: nothing, or in use */
    sea_kept_place light, foam_history; /* water_light.c's, foam_history.c's */
};

/* See facet_sea_create(); and its end. */
facet_result sea_create(const facet_sea_desc *desc, facet_sea **sea, facet_error *error);
void sea_destroy(facet_sea *sea); /* NULL is allowed */

#endif
