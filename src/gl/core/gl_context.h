/* gl_context.h - an OpenGL context and what it can do. The feature level is OpenGL 3.3 core or OpenGL ES 3.0. */
#ifndef GL_GL_CONTEXT_H
#define GL_GL_CONTEXT_H

#include "facet/facet.h"

typedef enum gl_api { GL_API_ANY, GL_API_CORE, GL_API_ES } gl_api; /* any: core, else ES */

typedef struct gl_context {
    void *display, *context, *surface; /* EGL's; NULL: the context is a window's (gl_context_adopt()) */
    /* what was current: display, surfaces for drawing and reading, context; NULL: nothing */
    void *previous[4];
    bool is_es;
    int version;              /* 33, 46; 30, 32 with is_es */
    const char *glsl_version; /* "330", "300 es": for facet_shader_text() */
    int max_texture_size;     /* texels along an edge */
    int max_array_layers;
    int max_texture_units; /* in fragment shaders */
    int max_samples;
    float max_anisotropy; /* 1: none */
    bool has_parallel_compile, has_timer_query, has_float_linear, has_debug_output;
    bool has_float_target, has_half_target; /* RGBA32F, RGBA16F can be drawn into */
    bool has_clip_control;                  /* depth may run from 1 at the eye to 0 far away: gl_renderer.c */
    unsigned (*reset_status)(void); /* GL_NO_ERROR, or why the context was lost; NULL: nobody can tell */
    bool is_lost;                   /* nothing but gl_context_destroy() is left to do */
    char name[160];                 /* of driver and version, for people */
} gl_context;

/* A context without a window, current afterwards: on a device of its own, else Mesa's surfaceless platform, else a pbuffer.
 * Fails with FACET_ERROR_SYSTEM: one sentence that says what is missing. */
facet_result gl_context_create(gl_context *context, facet_error *error);
facet_result gl_context_create_api(gl_context *context, gl_api wanted, facet_error *error);
/* That of a window, which is current and stays the window's. FACET_ERROR_SYSTEM: it is older than 3.3 (ES: 3.0). */
facet_result gl_context_adopt(gl_context *context, facet_error *error);
/* Current for the calling thread. A window's context is its owner's business: nothing happens. FACET_ERROR_SYSTEM. */
facet_result gl_context_make_current(gl_context *context, facet_error *error);
/* Not current for any thread: another one may take it. What was current before is again, where it was EGL's. */
void gl_context_release(gl_context *context);
void gl_context_destroy(gl_context *context); /* {0} is allowed; leaves {0} */

/* FACET_OK, or what OpenGL says went wrong since the last call: FACET_ERROR_MEMORY, FACET_ERROR_SYSTEM (the context
 * was lost; or a fault of facet's own, with OpenGL's name for it). while_doing: "textures". */
facet_result gl_context_check(gl_context *context, const char *while_doing, facet_error *error);

#endif
