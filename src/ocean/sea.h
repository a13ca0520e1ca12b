/* sea.h - what a facet_sea holds. */
#ifndef OCEAN_SEA_H
#define OCEAN_SEA_H

#include "ocean/water_optics.h"
#include "ocean/waves.h"

struct facet_sea {
    facet_sea_desc desc;
    waves waves;
    slope_filter slopes;
    foam_rule foam;
    water_optics optics;
    uint64_t
        serial; /* another one for each sea of the process, from 1: what was made for it is recognized by it */
};

/* See facet_sea_create(); and its end. */
facet_result sea_create(const facet_sea_desc *desc, facet_sea **sea, facet_error *error);
void sea_destroy(facet_sea *sea); /* NULL is allowed */
/* See facet_sea_camera(). */
facet_camera sea_camera(const facet_sea *sea, float height_m, float azimuth_rad);

#endif
