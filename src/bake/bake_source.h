/* bake_source.h - the input of baking: an environment's panorama, clamped and rotated; and progress, reported
 * to the caller from any thread.
 *
 * A texel of the panorama has one radiance over its solid angle; see bake.h. */
#ifndef BAKE_BAKE_SOURCE_H
#define BAKE_BAKE_SOURCE_H

#include <stdatomic.h>

#include "facet/facet.h"
#include "ibl/cube.h"
#include "image/image.h"

typedef struct bake_source {
    image panorama;      /* equirectangular, F32 RGB */
    image cut;           /* the memory of panorama where radiance was clamped; else {0} */
    const cube *faces;   /* the cube map that the panorama was made from, not clamped; NULL: none */
    float limit;         /* radiance is clamped to this; infinity: not clamped */
    double mean[3];      /* mean radiance over the sphere, clamped */
    double cut_share;    /* share of the mean over the channels that clamping removed */
    double rotation_rad; /* around +Y, from +Z towards +X */
    float scale;         /* of the result */
} bake_source;

/* FACET_ERROR_MEMORY. The environment must outlive it. */
facet_result bake_source_create(const facet_environment *environment, const facet_bake_desc *desc,
                                bake_source *out, facet_error *error);
void bake_source_destroy(bake_source *s); /* {0} is allowed; leaves {0} */

/* Direction in the panorama of direction d of the result. */
void bake_source_turn(const bake_source *s, const double d[3], double out[3]);

/* ---- progress ---- */

typedef struct bake_watch {
    facet_progress progress;
    const char *stage;
    double total; /* total work, in ns or any other unit */
    _Atomic uint64_t done;
    atomic_bool is_cancelled;
    atomic_flag is_reporting;
    double reported; /* guarded by is_reporting */
} bake_watch;

void bake_watch_init(bake_watch *w, const facet_progress *progress, const char *stage, double total);
/* Adds completed work. False: cancelled. */
bool bake_watch_add(bake_watch *w, double done);
static inline bool bake_watch_is_cancelled(const bake_watch *w)
{
    return atomic_load_explicit(&w->is_cancelled, memory_order_relaxed);
}
/* FACET_OK or FACET_ERROR_CANCELLED. */
facet_result bake_watch_explain(const bake_watch *w, facet_error *error);

#endif
