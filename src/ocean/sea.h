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
    uint64_t serial; /* unique in the process, from 1: caches recognize the sea by it */
};

/* Legacy styles, and the first steps from there: what they shade is for a display as it is, whatever the exposure. */
static inline bool sea_shading_is_legacy(const facet_sea_shading *s)
{
    return s->style != FACET_SEA_STYLE_PHYSICAL || s->stage == 1 || s->stage == 2;
}
/* All steps: with foam, glints and caustics. */
static inline bool sea_shading_is_complete(const facet_sea_shading *s)
{
    return s->style == FACET_SEA_STYLE_PHYSICAL && (s->stage == 0 || s->stage == 5);
}

/* See facet_sea_create() and facet_sea_destroy(). */
facet_result sea_create(const facet_sea_desc *desc, facet_sea **sea, facet_error *error);
void sea_destroy(facet_sea *sea); /* NULL is allowed */
/* See facet_sea_camera(). */
facet_camera sea_camera(const facet_sea *sea, float height_m, float azimuth_rad);

#endif
