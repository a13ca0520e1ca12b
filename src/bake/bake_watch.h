/* bake_watch.h - how far a cube map is, told to the caller from any thread, and whether the caller cancelled it. */
#ifndef BAKE_BAKE_WATCH_H
#define BAKE_BAKE_WATCH_H

#include <stdatomic.h>

#include "facet/facet.h"

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
