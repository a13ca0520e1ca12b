/* gl_timers.h - GPU time of the passes of an image. */
#ifndef GL_GL_TIMERS_H
#define GL_GL_TIMERS_H

#include "gl/core/gl_context.h"

typedef enum gl_timer {
    GL_TIMER_SHADOWS,
    GL_TIMER_OPAQUE,
    GL_TIMER_BACKGROUND,
    GL_TIMER_TRANSMISSION, /* including the copy of opaque surfaces */
    GL_TIMER_BLENDED,
    GL_TIMER_BLOOM,
    GL_TIMER_RESOLVE, /* multisample resolve */
    GL_TIMER_LAYERS,  /* AOVs */
    GL_TIMER_PRESENT,
    GL_TIMER_COUNT
} gl_timer;

/* Milliseconds per pass; 0: the pass did not run. */
typedef struct gl_times {
    double ms[GL_TIMER_COUNT];
    bool is_known; /* false: the driver has no timers, or no result has arrived yet */
} gl_times;

const char *gl_timer_name(gl_timer timer); /* "opaque" */

enum { GL_TIMERS_PENDING = 256 };

/* Initialize with {.context}. Passes do not nest. */
typedef struct gl_timers {
    const gl_context *context;
    struct {
        uint32_t query; /* created on first use */
        gl_timer timer;
        bool ends_image;
    } ring[GL_TIMERS_PENDING];
    uint32_t first, count; /* pending queries */
    bool is_running;
    gl_times sum, last; /* of the image whose results are arriving, and of the last complete one */
} gl_timers;

void gl_timers_begin(gl_timers *timers, gl_timer timer);
void gl_timers_end(gl_timers *timers);
/* Ends an image: its times are complete when all results have arrived. waits: wait for them; otherwise
 * returns the times of an earlier image. */
gl_times gl_timers_finish(gl_timers *timers, bool waits);
void gl_timers_destroy(gl_timers *timers); /* {0} is allowed; the context is current */

#endif
