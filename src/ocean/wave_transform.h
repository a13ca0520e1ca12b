/* wave_transform.h - from waves to fields: eight real ones by four complex transforms per tile. */
#ifndef OCEAN_WAVE_TRANSFORM_H
#define OCEAN_WAVE_TRANSFORM_H

#include "ocean/waves.h"

typedef struct wave_transform wave_transform;

/* Memory for all tiles of w, which have their amplitudes; size: samples along an edge of each. FACET_ERROR_MEMORY; _UNSUPPORTED:
 * facet was built without kissfft. */
facet_result wave_transform_create(const waves *w, wave_transform **out, facet_error *error);
void wave_transform_destroy(wave_transform *t); /* NULL is allowed */

/* Fills level 0 of all tiles from what their amplitudes are now. */
void wave_transform_run(wave_transform *t, waves *w);

/* Two real fields of one tile by one transform. */
typedef struct wave_pair {
    uint32_t tile;
    float (
        *coefficients)[2][2]; /* of each mode of the tile, at k: the first field's, the second's; complex */
    float (*rows)[2];         /* to work in: (2 reach + 1) size */
    float *fields[2];         /* out: size^2 each, rows along z */
} wave_pair;
void wave_transform_pair(const wave_transform *t, const waves *w, const wave_pair *p);

#endif
