/* gl_timers.h - what the passes of a picture take on the GPU. */
#ifndef GL_GL_TIMERS_H
#define GL_GL_TIMERS_H

#include "gl/core/gl_context.h"

typedef enum gl_timer {
    GL_TIMER_SHADOWS,
    GL_TIMER_OPAQUE,
    GL_TIMER_BACKGROUND,
    GL_TIMER_TRANSMISSION, /* with the copy of what is opaque */
    GL_TIMER_BLENDED,
    GL_TIMER_BLOOM,
    GL_TIMER_RESOLVE, /* several samples to one */
    GL_TIMER_LAYERS,  /* AOVs */
    GL_TIMER_PRESENT,
    GL_TIMER_COUNT
} gl_timer;

/* Milliseconds of the passes; 0: it did not run. */
typedef struct gl_times {
    double ms[GL_TIMER_COUNT];
    bool is_known; /* false: the driver has no timers, or none has answered yet */
} gl_times;

const char *gl_timer_name(gl_timer timer); /* "opaque" */

enum { GL_TIMERS_PENDING = 256 };

/* {.context} is ready. Passes follow each other; none lies in another one. */
typedef struct gl_timers {
    const gl_context *context;
    struct {
        uint32_t query; /* made when it is first needed */
        gl_timer timer;
        bool ends_image;
    } ring[GL_TIMERS_PENDING];
    uint32_t first, count; /* that have not answered */
    bool is_running;
    gl_times sum, last; /* of the picture whose answers are coming, and of the one before */
} gl_timers;

void gl_timers_begin(gl_timers *timers, gl_timer timer);
void gl_timers_end(gl_timers *timers);
/* The picture is done: its times are added up when they have all come. waits: until they have, else those of an earlier
 * picture are told. */
gl_times gl_timers_finish(gl_timers *timers, bool waits);
void gl_timers_destroy(gl_timers *timers); /* {0} is allowed; the context is current */

#endif
