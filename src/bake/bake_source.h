/* bake_source.h - what is baked: an environment's picture, cut off where that was asked for, and how it is turned.
 *
 * A texel of the picture is of one radiance all over its solid angle; see bake.h. */
#ifndef BAKE_BAKE_SOURCE_H
#define BAKE_BAKE_SOURCE_H

#include "facet/facet.h"
#include "ibl/cube.h"
#include "image/image.h"

typedef struct bake_source {
    image picture;       /* equirectangular, F32 RGB */
    image cut;           /* what picture is where something was cut off; else {0} */
    const cube *faces;   /* what the picture was made from, not cut off; NULL: no cube map */
    float limit;         /* where radiance is cut off; infinity: nowhere */
    double mean[3];      /* radiance over the sphere, cut off */
    double cut_share;    /* of the mean over the channels, what was cut off */
    double rotation_rad; /* around +Y, from +Z towards +X */
    float scale;         /* of the result */
} bake_source;

/* FACET_ERROR_MEMORY. The environment is not to be destroyed before. */
facet_result bake_source_create(const facet_environment *environment, const facet_bake_desc *desc,
                                bake_source *out, facet_error *error);
void bake_source_destroy(bake_source *s); /* {0} is allowed; leaves {0} */

/* Direction d of the result, turned back: where its light is in the picture. */
void bake_source_turn(const bake_source *s, const double d[3], double out[3]);

#endif
