/* render_watch.h - progress of an image, reported to the caller from any thread, and what ends it early: the
 * caller, the time limit, memory. */
#ifndef DRAW_RENDER_WATCH_H
#define DRAW_RENDER_WATCH_H

#include <stdatomic.h>

#include "facet/facet.h"

/* Shared by the threads that draw. */
typedef struct render_watch {
    facet_progress progress;
    const char *stage;  /* as reported to the caller */
    double deadline_s;  /* of clock_seconds(); 0: none */
    double total;       /* of done */
    _Atomic int result; /* the first facet_result that was not FACET_OK */
    _Atomic uint64_t done;
    atomic_flag is_reporting;
    double reported;
    _Atomic double reported_s;
} render_watch;

void render_watch_init(render_watch *w, const facet_progress *progress, const char *stage, double deadline_s,
                       double total);
/* The first result that ends the image is kept. */
void render_watch_stop(render_watch *w, facet_result result);
static inline bool render_watch_is_stopped(render_watch *w)
{
    return atomic_load_explicit(&w->result, memory_order_relaxed) != FACET_OK;
}
/* Adds finished work: reports progress after each 1 %, or after some time. */
void render_watch_add(render_watch *w, uint64_t done);
/* To be called occasionally in long steps: checks the clock. */
void render_watch_look(render_watch *w);
/* The finished share, [0, 1]. */
double render_watch_share(render_watch *w);
/* The result, with a message. */
facet_result render_watch_explain(render_watch *w, facet_error *error);

/* Between stages of one thread: FACET_ERROR_CANCELLED where the caller's progress says so,
 * FACET_ERROR_LIMIT past the deadline (of clock_seconds(), 0: none). */
facet_result render_check_limits(const facet_render_desc *desc, const char *stage, double fraction,
                                 double deadline_s, facet_error *error);

#endif
