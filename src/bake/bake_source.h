/* bake_source.h - what is baked: an environment's image, cut off where that was asked for, and how it is turned; and how far
 * baking is, reported to the caller from any thread.
 *
 * A texel of the image is of one radiance all over its solid angle; see bake.h. */
#ifndef BAKE_BAKE_SOURCE_H
#define BAKE_BAKE_SOURCE_H

#include <stdatomic.h>

#include "facet/facet.h"
#include "ibl/cube.h"
#include "image/image.h"

typedef struct bake_source {
    image panorama;      /* equirectangular, F32 RGB */
    image cut;           /* what image is where something was cut off; else {0} */
    const cube *faces;   /* what the image was made from, not cut off; NULL: no cube map */
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

/* Direction d of the result, turned back: where its light is in the image. */
void bake_source_turn(const bake_source *s, const double d[3], double out[3]);

/* ---- progress ---- */

typedef struct bake_watch {
    facet_progress progress;
    const char *stage;
    double total; /* nanoseconds that all of it is expected to take, or any other measure of work */
    _Atomic uint64_t done;
    atomic_bool is_cancelled;
    atomic_flag is_reporting;
    double reported; /* guarded by is_reporting */
} bake_watch;

void bake_watch_init(bake_watch *w, const facet_progress *progress, const char *stage, double total);
/* So much more is done. False: cancelled. */
bool bake_watch_add(bake_watch *w, double done);
static inline bool bake_watch_is_cancelled(const bake_watch *w)
{
    return atomic_load_explicit(&w->is_cancelled, memory_order_relaxed);
}
/* FACET_OK or FACET_ERROR_CANCELLED. */
facet_result bake_watch_explain(const bake_watch *w, facet_error *error);

#endif
