/* gl_pyramid.h - an image and its mip levels in half floats, drawn by filters. Two passes use it: the
 * opaque surfaces that are seen through transmissive ones (transmission.glsl), and bloom.
 *
 * The opaque image has no background, because glass shows another part of it: a ray that leaves the scene
 * sees the environment in its own direction, as on the CPU. The bloom filter is a sum of smooth ones, each
 * twice as wide as the last with SPREAD of its weight: density falls with the distance to the power
 * log2(SPREAD) - 2 = -2.5, between the -2 and -3 of the glare of eyes and lenses (Vos 1984, "Disability
 * glare"). Down and up the levels after Jimenez 2014. */
#ifndef GL_GL_PYRAMID_H
#define GL_GL_PYRAMID_H

#include "gl/core/gl_program.h"
#include "gl/core/gl_target.h"

typedef struct gl_pyramid {
    /* of level 0; each level is half the size of the previous one, rounded down, at least 1 */
    uint32_t width, height, level_count;
    uint32_t texture;     /* RGBA16F, trilinear, clamped */
    uint32_t framebuffer; /* with one of the levels attached */
} gl_pyramid;

/* What its passes draw with. */
typedef struct gl_pyramid_brush {
    gl_programs *programs;
    uint32_t empty_array; /* vertex array of full-screen passes */
} gl_pyramid_brush;

/* Resolves the target and copies the opaque surfaces drawn so far, premultiplied, without a background.
 * The target is bound again afterwards. Fails with FACET_ERROR_MEMORY, FACET_ERROR_SYSTEM. */
facet_result gl_pyramid_take_opaque(gl_pyramid *pyramid, gl_context *context, const gl_pyramid_brush *brush,
                                    const gl_target *target, facet_error *error);
void gl_pyramid_bind_opaque(const gl_pyramid *pyramid); /* to GL_UNIT_OPAQUE */

/* Spreads a share, in (0, 1], of the light and coverage of a resolved image. Over an even background the
 * result is the same as if the background had been there. Energy is kept, except at the border of the
 * image, which reflects none. Fails with FACET_ERROR_MEMORY, FACET_ERROR_SYSTEM. */
facet_result gl_pyramid_bloom(gl_pyramid *pyramid, gl_context *context, const gl_pyramid_brush *brush,
                              const gl_target *target, float share, facet_error *error);

void gl_pyramid_destroy(gl_pyramid *pyramid); /* {0} is allowed; leaves {0} */

#endif
