/* view_trace.h - path tracing of what a window shows, by a thread of its own: the picture comes again and again, calmer
 * each time. */
#ifndef VIEW_VIEW_TRACE_H
#define VIEW_VIEW_TRACE_H

#include "gl/gl_entry.h"
#include "view/view_image.h"

typedef struct view_tracer view_tracer;

/* wake is called when there is a new picture, from another thread. FACET_ERROR_MEMORY. */
facet_result view_trace_create(const gl_host *host, const facet_allocator *allocator,
                               void (*wake)(void *user), void *user, view_tracer **out, facet_error *error);
void view_trace_destroy(view_tracer *t); /* NULL is allowed */

/* Begins anew, if desc is not what is traced already. scene, environment stay until view_trace_stop(); camera and
 * animations are copied. True: it begins anew, and pictures that were taken are of something else. */
bool view_trace_start(view_tracer *t, const facet_scene *scene, const facet_render_desc *desc);
/* Whether that is what is traced, so that view_trace_start() would go on with it. */
bool view_trace_is_of(view_tracer *t, const facet_scene *scene, const facet_render_desc *desc);
/* Gives up what is traced, and returns when it has; what was kept of the scene is released. */
void view_trace_stop(view_tracer *t);

/* The newest picture and how many samples a pixel has; false: none that was not taken yet. */
bool view_trace_take(view_tracer *t, view_image *out, uint32_t *samples);
/* Samples a pixel of the last picture taken or not, and of what is wanted; done: there comes no other. */
typedef struct view_trace_state {
    uint32_t samples, wanted;
    bool is_done;
    facet_error error; /* result FACET_OK: none */
} view_trace_state;
view_trace_state view_trace_get(view_tracer *t);

#endif
