/* wave_transform.h - from wave amplitudes to fields: eight real fields by four complex transforms per tile. */
#ifndef OCEAN_WAVE_TRANSFORM_H
#define OCEAN_WAVE_TRANSFORM_H

#include "ocean/waves.h"

typedef struct wave_transform wave_transform;

/* For all tiles of w, which have their amplitudes; size: samples per edge. FACET_ERROR_MEMORY; _UNSUPPORTED:
 * facet was built without kissfft. */
facet_result wave_transform_create(const waves *w, wave_transform **out, facet_error *error);
void wave_transform_destroy(wave_transform *t); /* NULL is allowed */

/* Fills level 0 of all tiles from the current amplitudes. */
void wave_transform_run(wave_transform *t, waves *w);

/* Two real fields of one tile by one transform. */
typedef struct wave_pair {
    uint32_t tile;
    /* per mode of the tile, at k: of the first and of the second field; complex */
    float (*coefficients)[2][2];
    float (*rows)[2]; /* scratch memory: (2 reach + 1) size */
    float *fields[2]; /* out: size^2 each, rows along z */
} wave_pair;
void wave_transform_pair(const wave_transform *t, const waves *w, const wave_pair *p);

#endif
