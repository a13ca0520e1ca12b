/* gl_target.h - what is drawn into: radiance in floats, several samples a pixel; and what is made of it. */
#ifndef GL_GL_TARGET_H
#define GL_GL_TARGET_H

#include "gl/core/gl_context.h"

enum { GL_TARGET_LAYERS = 3 }; /* that AOVs are written to: surface.frag */

typedef enum gl_target_kind {
    GL_TARGET_FILM,   /* RGBA32F, or what comes nearest */
    GL_TARGET_WINDOW, /* RGBA16F: half the memory to go through; what is brighter than 65504 is infinite */
    GL_TARGET_LAYERED /* as a film, GL_TARGET_LAYERS of them; one sample */
} gl_target_kind;

typedef struct gl_target {
    gl_target_kind kind;
    uint32_t width, height, samples;       /* samples 1: color is what is drawn into */
    uint32_t format;                       /* GL_RGBA16F, GL_RGBA32F */
    uint32_t framebuffer;                  /* to draw into: color and depth */
    uint32_t resolved_framebuffer;         /* one sample */
    uint32_t color;                        /* texture of the resolved picture; of the first layer */
    uint32_t layers[GL_TARGET_LAYERS - 1]; /* textures of the others */
    uint32_t renderbuffers[2];             /* color and depth of several samples */
    uint32_t depth;                        /* texture, of one sample */
} gl_target;

/* Makes it, or makes it anew where kind, size or samples differ. samples: as many or the next fewer that OpenGL has. Fails
 * with FACET_ERROR_MEMORY, FACET_ERROR_LIMIT (larger than OpenGL's textures), FACET_ERROR_SYSTEM. */
facet_result gl_target_update(gl_target *target, gl_context *context, gl_target_kind kind, uint32_t width,
                              uint32_t height, uint32_t samples, facet_error *error);
void gl_target_destroy(gl_target *target); /* {0} is allowed */
/* Several samples to one. */
void gl_target_resolve(const gl_target *target);
/* RGBA of the resolved picture or a layer, rows as OpenGL has them, width x height of them from x, y. */
void gl_target_read(const gl_target *target, uint32_t layer, uint32_t x, uint32_t y, uint32_t width,
                    uint32_t height, float *pixels);

#endif
