/* gl_sampling.h - how a picture gets as many samples a pixel as were asked for, by the few that OpenGL has. */
#ifndef GL_GL_SAMPLING_H
#define GL_GL_SAMPLING_H

#include "facet/facet.h"

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
