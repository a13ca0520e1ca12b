/* render_gl.h - the renderer of OpenGL: a module that is opened when it is first used, so that processes
 * that render on the CPU load no driver. */
#ifndef RENDER_RENDER_GL_H
#define RENDER_RENDER_GL_H

#include "gl/gl_entry.h"
#include "render/renderer_set.h"

/* The module's functions; it stays open until the process ends. Safe from several threads.
 * FACET_ERROR_SYSTEM: the module is not there, or belongs to another build. */
facet_result gl_library_open(const gl_entry **entry, facet_error *error);

/* State of the row in renderer.c. */
typedef struct render_gl {
    renderer_set *set;
    gl_renderer *scenes; /* NULL: not used yet */
    gl_sea *seas;        /* with a context of its own; NULL: not used yet */
} render_gl;

facet_result render_gl_create(renderer_set *set, void **state, facet_error *error);
facet_result render_gl_draw(void *state, const facet_render_desc *desc, film *target,
                            facet_render_stats *stats, facet_error *error);
void render_gl_destroy(void *state);

#endif
