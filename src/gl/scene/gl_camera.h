/* gl_camera.h - the matrix of a camera for part of an image, and its samples.
 *
 * Depth is reversed where glClipControl() exists: 1 at the near plane, 0 at infinity, in floats, whose
 * density then matches that of distant depths (Reed 2015, "Depth precision visualized"). The near plane
 * can be so close that it never clips, without z-fighting far away. Elsewhere depth runs from -1 to 1
 * between planes that are fitted to the scene.
 *
 * With glClipControl() the rows of a target also run from the top, as those of a film do, so that a
 * pixel's samples lie where the preview's do (D3D's pattern, the rotated grid of sample_pattern()).
 * Elsewhere they run from the bottom. */
#ifndef GL_GL_CAMERA_H
#define GL_GL_CAMERA_H

#include "draw/camera_rays.h"
#include "gl/core/gl_blocks.h"
#include "gl/core/gl_context.h"

/* A rectangle that is drawn at once, in pixels of the image or of a finer grid. */
typedef struct gl_view {
    uint32_t scale; /* drawn pixels per image pixel along an axis */
    uint32_t x, y;  /* upper left corner, in drawn pixels from that of the image */
    uint32_t width, height;
    float jitter[2]; /* offset of the samples in drawn pixels, to the right and down */
} gl_view;

/* Fills in the camera, size and depth members of the block. bounds: of the scene, m. width, height: of the
 * image. */
void gl_camera_set(const gl_context *context, const camera_rays *camera, const float bounds_min[3],
                   const float bounds_max[3], uint32_t width, uint32_t height, const gl_view *view,
                   gl_frame_block *block);

/* Sets the depth test (nearer or equal passes), the clear value and the row order. */
void gl_camera_begin_depth(const gl_context *context);
/* Restores OpenGL's initial state. */
void gl_camera_end_depth(const gl_context *context);

/* ---- samples ---- */

/* A pixel gets scale^2 * samples * passes samples, at least as many as requested. */
typedef struct gl_sampling {
    uint32_t scale;   /* drawn pixels per image pixel along an axis; each is shaded */
    uint32_t samples; /* visibility samples of each: multisampling */
    uint32_t passes;  /* the image is their mean */
} gl_sampling;

/* Plans samples per pixel; FACET_QUALITY_FINAL shades the quarters of a pixel, as the preview does.
 * max_samples: OpenGL's limit. */
gl_sampling gl_sampling_plan(uint32_t samples, facet_quality quality, uint32_t max_samples);
/* Offset of each pass to the right and down, in drawn pixels, as interleaved x and y: passes fill the gaps
 * between each other's samples. */
void gl_sampling_jitter(const gl_sampling *sampling, float *jitter);

#endif
