/* light.h - what a prepared light holds, for those who copy it: to a GPU, which then looks up as light.c does. Who only
 * looks up needs ibl.h. */
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

/* What a light looks up in, shared with the environment, which it keeps. Parts never change, and stay where they are as
 * long as the environment lives: the same pointer is the same part. */
struct ibl_light {
    facet_environment *environment;
    cube irradiance_over_pi; /* not owned; {0}: not asked for */
    ibl_level_range ranges[PREFILTER_LOBE_COUNT];
    cube levels[PREFILTER_LOBE_COUNT][PREFILTER_LEVEL_COUNT]; /* not owned; [][0] is not used */
    image sharp, background;                                  /* not owned; {0}: not asked for */
    const narrow *narrow; /* of the environment; NULL where nothing is between a mirror and level 1 */
};

#endif
