/* bed_shadow.h - the shadow of a model on the bed: what share of the light there it lets pass, of the sun's beam and of all other light
 * apart. Where layers of caustics are, these have the beam's shadow, as waves bend it; this is what holds beyond them. */
#ifndef WATER_BED_SHADOW_H
#define WATER_BED_SHADOW_H

#include "water/water_frame.h"

struct water_setup;

enum { BED_SHADOW_EDGE = SEA_TOUCH_EDGE };

/* Shares, [0, 1]. */
typedef struct bed_shadow_texel {
    float sun;  /* of the beam that was not scattered */
    float rest; /* of the sky's light, of the sun's that was scattered, of what went up from the bed before */
} bed_shadow_texel;

typedef struct bed_shadow {
    bool is_there;            /* else nothing is in the light's way */
    double low[2], high[2];   /* rectangle in X, Z, m */
    bed_shadow_texel *texels; /* BED_SHADOW_EDGE^2; rows along Z, texel middles at their places */
} bed_shadow;

/* Of the model of a picture; none where there is no model, no bed, or no light that comes back from it. FACET_ERROR_MEMORY. */
facet_result bed_shadow_of_picture(const struct water_setup *s, bed_shadow *out, facet_error *error);
void bed_shadow_destroy(bed_shadow *b); /* {0} is allowed */

/* Rectangle in X, Z (m) in which the beam's shadow lies on a bed `depth` m below; on the water it is no longer than eight times its model. */
void bed_shadow_of_beam(const struct water_setup *s, float depth, double low[2], double high[2]);

/* At (X, Z), between texels; 1 beyond the rectangle. */
bed_shadow_texel bed_shadow_at(const bed_shadow *b, double X, double Z);

#endif
