/* gl_camera.h - a camera as a matrix, for a part of a picture.
 *
 * Depth is reversed where OpenGL can (glClipControl()): 1 at the near plane, 0 infinitely far away, in floats, which are
 * densest where depths of far things lie (Reed 2015, "Depth precision visualized"). So near may be as near as no one
 * looks, and nothing flickers far away. Where it cannot, depth runs from -1 to 1 between planes that follow the scene.
 *
 * The same function lets rows of a target run from the top, as those of a film do: a pixel's samples then lie where the
 * preview's do (D3D's pattern, the rotated grid of sample_pattern.h). Where it is not there they run from the bottom. */
#ifndef GL_GL_CAMERA_H
#define GL_GL_CAMERA_H

#include "draw/camera_rays.h"
#include "gl/core/gl_blocks.h"
#include "gl/core/gl_context.h"

/* What is drawn at once: a rectangle of the picture's pixels, or of a grid that is finer. */
typedef struct gl_view {
    uint32_t scale; /* drawn pixels, in a row, for one of the picture; 1: the picture's */
    uint32_t x, y;  /* of the upper left corner, in drawn pixels from the picture's */
    uint32_t width, height;
    float jitter[2]; /* of what is seen, in drawn pixels: positive sees what is to the right, below */
} gl_view;

/* Fills in what block says of camera, size, depth. bounds: of the scene, m. width, height: of the picture. */
void gl_camera_set(const gl_context *context, const camera_rays *camera, const float bounds_min[3],
                   const float bounds_max[3], uint32_t width, uint32_t height, const gl_view *view,
                   gl_frame_block *block);

/* Whether rows of a target run from the top. */
static inline bool gl_camera_is_top_down(const gl_context *context)
{
    return context->has_clip_control;
}

/* OpenGL's state for that depth and those rows: what is nearer or as near wins, and what clears. */
void gl_camera_begin_depth(const gl_context *context);
/* The state that OpenGL begins with. */
void gl_camera_end_depth(const gl_context *context);

/* ---- samples ---- */

/* scale^2 * samples * passes of a pixel, at least as many as were asked for. */
typedef struct gl_sampling {
    uint32_t scale; /* pixels that are drawn, in a row, for one of the picture; surfaces are shaded in each */
    uint32_t samples; /* of visibility in each: OpenGL's multisampling */
    uint32_t passes;  /* that the picture is the mean of */
} gl_sampling;

/* For samples per pixel; FACET_QUALITY_FINAL shades the quarters of a pixel, as the preview does. max_samples: OpenGL's. */
gl_sampling gl_sampling_plan(uint32_t samples, facet_quality quality, uint32_t max_samples);
/* What each pass sees further right and further down, in drawn pixels, x and y interleaved, passes of them: passes fill the
 * gaps of each other's samples. */
void gl_sampling_jitter(const gl_sampling *sampling, float *jitter);

#endif
