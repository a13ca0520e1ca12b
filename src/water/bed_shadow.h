/* bed_shadow.h - a model's shadow on the bed: the transmitted shares of the sun's beam and of all other
 * light. Inside of caustic layers the beam's shadow is part of the caustics, as waves refract it; this map
 * holds beyond them. */
#ifndef WATER_BED_SHADOW_H
#define WATER_BED_SHADOW_H

#include "water/water_frame.h"

struct water_setup;

enum { BED_SHADOW_EDGE = SEA_CONTACT_EDGE };

/* Shares, [0, 1]. */
typedef struct bed_shadow_texel {
    float sun; /* of the unscattered beam */
    /* of skylight, scattered sunlight, and light that the bed and the surface have interreflected */
    float rest;
} bed_shadow_texel;

typedef struct bed_shadow {
    bool is_there;            /* false: nothing occludes the light */
    double low[2], high[2];   /* rectangle in X, Z, m */
    bed_shadow_texel *texels; /* BED_SHADOW_EDGE^2; rows along Z, sampled at texel centers */
} bed_shadow;

/* Computes the shadow of the image's model; empty without a model, without a bed, or where no light returns
 * from the bed. FACET_ERROR_MEMORY. */
facet_result bed_shadow_of_image(const struct water_setup *s, bed_shadow *out, facet_error *error);
void bed_shadow_destroy(bed_shadow *b); /* {0} is allowed */

/* Rectangle in X, Z (m) of the beam's shadow on a bed `depth` m below the surface; on the surface it is at
 * most eight times as long as the model. */
void bed_shadow_of_beam(const struct water_setup *s, float depth, double low[2], double high[2]);

/* Interpolated at (X, Z); 1 outside of the rectangle. */
bed_shadow_texel bed_shadow_at(const bed_shadow *b, double X, double Z);

#endif
