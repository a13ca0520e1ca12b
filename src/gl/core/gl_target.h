/* gl_target.h - multisampled render targets and their resolved images. */
#ifndef GL_GL_TARGET_H
#define GL_GL_TARGET_H

#include "gl/core/gl_context.h"

enum { GL_TARGET_LAYERS = 3 }; /* outputs of AOVs: surface_io.glsl */

typedef enum gl_target_kind {
    GL_TARGET_FILM,    /* RGBA32F, or RGBA16F */
    GL_TARGET_WINDOW,  /* RGBA16F: half the bandwidth; values above 65504 become infinite */
    GL_TARGET_DISPLAY, /* RGBA8: what a window shows, resolved into its framebuffer only */
    GL_TARGET_LAYERED  /* GL_TARGET_LAYERS images of a film's format, one sample */
} gl_target_kind;

typedef struct gl_target {
    gl_target_kind kind;
    uint32_t width, height, samples;       /* with 1 sample, color is drawn into directly */
    uint32_t format;                       /* GL_RGBA8, GL_RGBA16F, GL_RGBA32F */
    uint32_t framebuffer;                  /* color and depth to draw into */
    uint32_t resolved_framebuffer;         /* one sample */
    uint32_t color;                        /* texture of the resolved image, or of the first layer */
    uint32_t layers[GL_TARGET_LAYERS - 1]; /* textures of the others */
    uint32_t renderbuffers[2];             /* color and depth of multisampled targets */
    uint32_t depth;                        /* texture, single-sampled targets only */
} gl_target;

/* Creates the target, or replaces it where kind, size or samples differ. samples: rounded down to what
 * OpenGL has. Fails with FACET_ERROR_MEMORY, FACET_ERROR_LIMIT (larger than OpenGL's textures),
 * FACET_ERROR_SYSTEM. */
facet_result gl_target_update(gl_target *target, gl_context *context, gl_target_kind kind, uint32_t width,
                              uint32_t height, uint32_t samples, facet_error *error);
void gl_target_destroy(gl_target *target); /* {0} is allowed */
/* Resolves the samples. */
void gl_target_resolve(const gl_target *target);
/* The same of {left, bottom, width, height}, pixels; the rest keeps its former values. */
void gl_target_resolve_area(const gl_target *target, const int area[4]);
/* The same into a framebuffer of the same size and format. */
void gl_target_resolve_into(const gl_target *target, uint32_t framebuffer, const int area[4]);
/* Reads RGBA of the resolved image or of a layer: width x height pixels from (x, y), rows in OpenGL's order. */
void gl_target_read(const gl_target *target, uint32_t layer, uint32_t x, uint32_t y, uint32_t width,
                    uint32_t height, float *pixels);

#endif
