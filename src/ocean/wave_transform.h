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

#endif
