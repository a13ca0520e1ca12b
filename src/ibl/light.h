/* light.h - the contents of a prepared light, for renderers that copy it to a GPU and look up as light.c
 * does. ibl.h is enough for lookups. */
#ifndef IBL_LIGHT_H
#define IBL_LIGHT_H

#include "ibl/cube.h"
#include "ibl/ibl.h"
#include "ibl/narrow.h"
#include "ibl/prefilter.h"
#include "image/image.h"

/* Levels of a lobe that were prepared; last < first: none. */
typedef struct ibl_level_range {
    uint32_t first, last;
} ibl_level_range;

/* The parts of a light, owned by the environment, of which the light holds a reference. Parts never change or
 * move while the environment lives, so equal pointers mean equal parts. */
struct ibl_light {
    facet_environment *environment;
    cube irradiance_over_pi; /* not owned; {0}: not needed */
    ibl_level_range ranges[PREFILTER_LOBE_COUNT];
    cube levels[PREFILTER_LOBE_COUNT][PREFILTER_LEVEL_COUNT]; /* not owned; [][0] is not used */
    image sharp, background;                                  /* not owned; {0}: not needed */
    const narrow *narrow; /* of the environment; NULL if nothing lies between roughness 0 and level 1 */
};

#endif
