/* gl_context.h - an OpenGL context and its capabilities. The feature level is OpenGL 3.3 core or OpenGL ES
 * 3.0. */
#ifndef GL_GL_CONTEXT_H
#define GL_GL_CONTEXT_H

#include "facet/facet.h"

/* any: core, or ES where there is no core */
typedef enum gl_api { GL_API_ANY, GL_API_CORE, GL_API_ES } gl_api;

typedef struct gl_context {
    void *display, *context, *surface; /* EGL's; NULL: the context of a window (gl_context_adopt()) */
    /* what was current before: display, draw and read surfaces, context; NULL: nothing */
    void *previous[4];
    bool is_es;
    int version;              /* 33, 46; 30, 32 with is_es */
    const char *glsl_version; /* "330" or "300 es", for facet_shader_text() */
    int max_texture_size;     /* texels along an edge */
    int max_array_layers;
    int max_texture_units; /* in fragment shaders */
    int max_samples;
    float max_anisotropy; /* 1: none */
    bool has_parallel_compile, has_timer_query, has_float_linear, has_debug_output;
    bool has_float_target, has_half_target; /* RGBA32F, RGBA16F can be render targets */
    bool has_texture_storage;               /* glTexStorage2D() */
    bool has_clip_control;                  /* reversed depth is possible: gl_camera.h */
    /* A page's: its canvas takes premultiplied values, and rows run from the bottom, so that samples can be resolved
     * into it. */
    bool is_canvas;
    /* GL_NO_ERROR, or the reason for the loss of the context; NULL: unsupported */
    unsigned (*reset_status)(void);
    bool is_lost;   /* only gl_context_destroy() is allowed */
    char name[160]; /* renderer and version, for messages */
} gl_context;

/* Creates an off-screen context and makes it current: on a GPU of its own, else on Mesa's surfaceless
 * platform, else with a pbuffer. Fails with FACET_ERROR_SYSTEM; the message names what is missing. */
facet_result gl_context_create(gl_context *context, facet_error *error);
facet_result gl_context_create_api(gl_context *context, gl_api wanted, facet_error *error);
/* Adopts the current context of a window, which remains the window's. FACET_ERROR_SYSTEM: older than
 * OpenGL 3.3 or ES 3.0. */
facet_result gl_context_adopt(gl_context *context, facet_error *error);
/* Makes the context current for the calling thread. No effect on a window's context, which its owner manages.
 * FACET_ERROR_SYSTEM. */
facet_result gl_context_make_current(gl_context *context, facet_error *error);
/* The same for deleting the context's objects. Where it is lost and cannot be current, an empty context takes its
 * place, in which the objects' names have no meaning: *spare, {0} if unused, to be destroyed after them. False: no
 * context is current. */
bool gl_context_make_current_to_delete(gl_context *context, gl_context *spare);
/* Releases the context, so that another thread can make it current, and restores what was current before,
 * if that was EGL's. */
void gl_context_release(gl_context *context);
void gl_context_destroy(gl_context *context); /* {0} is allowed; leaves {0} */

/* Whether the rows of a target run from the top. */
static inline bool gl_context_is_top_down(const gl_context *context)
{
    return context->has_clip_control && !context->is_canvas;
}

/* What gl_context_adopt() asks of the platform. FACET_ERROR_SYSTEM: OpenGL's library is missing. */
facet_result gl_context_find_library(facet_error *error);
void gl_context_find_platform(gl_context *context); /* sets reset_status and is_canvas */

/* Reports errors of OpenGL since the last call: FACET_ERROR_MEMORY, FACET_ERROR_SYSTEM (a lost context, or
 * a bug in facet, with OpenGL's error code). while_doing: such as "textures". */
facet_result gl_context_check(gl_context *context, const char *while_doing, facet_error *error);
/* The same after a framebuffer was made, which is bound. FACET_ERROR_SYSTEM with the text `unsupported`: the driver cannot
 * draw into it. */
facet_result gl_context_check_framebuffer(gl_context *context, const char *while_doing,
                                          const char *unsupported, facet_error *error);

#endif
