/* view_trace.h - path tracing of what a window shows, on a thread of its own: the image is delivered
 * repeatedly, with less noise each time. */
#ifndef VIEW_VIEW_TRACE_H
#define VIEW_VIEW_TRACE_H

#include "gl/gl_entry.h"

/* ---- images ---- */

/* An image as in files for displays: sRGB, 8 bits, straight alpha, rows from the top. */
typedef struct view_image {
    uint32_t width, height;
    unsigned char *pixels; /* RGBA; a block of mem_alloc() */
} view_image;

/* From a tone-mapped image: linear, premultiplied. FACET_ERROR_MEMORY. */
facet_result view_image_create(const facet_image_view *linear, const facet_allocator *allocator,
                               view_image *out, facet_error *error);
void view_image_destroy(view_image *p); /* {0} is allowed */
/* The inverse, a block of mem_alloc(): linear, premultiplied RGBA, from which facet_image_save() writes
 * the same values again. NULL: out of memory. */
float *view_image_to_linear(const view_image *p, const facet_allocator *allocator);

/* ---- the tracer ---- */

typedef struct view_tracer view_tracer;

/* wake is called from another thread when there is a new image. FACET_ERROR_MEMORY. */
facet_result view_trace_create(const gl_host *host, const facet_allocator *allocator,
                               void (*wake)(void *user), void *user, view_tracer **out, facet_error *error);
void view_trace_destroy(view_tracer *t); /* NULL is allowed */

/* Restarts, unless desc is already being traced. scene, environment must live until view_trace_stop();
 * camera and animations are copied. True: it restarted, and images taken before show something else. */
bool view_trace_start(view_tracer *t, const facet_scene *scene, const facet_render_desc *desc);
/* Whether that is being traced, so that view_trace_start() would not restart. */
bool view_trace_is_of(view_tracer *t, const facet_scene *scene, const facet_render_desc *desc);
/* Cancels tracing, and returns when it has ended; references to the scene are released. */
void view_trace_stop(view_tracer *t);

/* The newest image and its samples per pixel; false: no image that was not already taken. */
bool view_trace_take(view_tracer *t, view_image *out, uint32_t *samples);
/* Samples per pixel of the newest image, taken or not, and the goal; done: no further image follows. */
typedef struct view_trace_state {
    uint32_t samples, wanted;
    bool is_done;
    facet_error error; /* result FACET_OK: none */
} view_trace_state;
view_trace_state view_trace_get(view_tracer *t);

#endif
