/* gl_pyramid.h - a picture and its halves: half floats, each level a filtered half of the one before. */
#ifndef GL_GL_PYRAMID_H
#define GL_GL_PYRAMID_H

#include "gl/core/gl_program.h"

typedef struct gl_pyramid {
    uint32_t width, height,
        level_count;      /* of level 0; each next one is half as large, rounded down, at least 1 */
    uint32_t texture;     /* RGBA16F, trilinear, without repetition */
    uint32_t framebuffer; /* to draw into one of its levels */
} gl_pyramid;

/* What its passes draw with. */
typedef struct gl_pyramid_brush {
    gl_programs *programs;
    uint32_t empty_array; /* vertices of what covers the picture */
} gl_pyramid_brush;

/* Makes it, or makes it anew where the size or the number of levels differ. level_count 0: down to 1 x 1. Fails with
 * FACET_ERROR_MEMORY, FACET_ERROR_SYSTEM. */
facet_result gl_pyramid_update(gl_pyramid *pyramid, gl_context *context, uint32_t width, uint32_t height,
                               uint32_t level_count, facet_error *error);
void gl_pyramid_destroy(gl_pyramid *pyramid); /* {0} is allowed; leaves {0} */

/* Fills its levels from a texture of its size; level 0 is the picture as far as half floats reach. Leaves its framebuffer
 * bound, without tests and blending. FACET_ERROR_SYSTEM. */
facet_result gl_pyramid_fill(const gl_pyramid *pyramid, const gl_pyramid_brush *brush, uint32_t picture,
                             facet_error *error);

/* Begins to draw into a level, reading another one: level from -1 reads nothing of the pyramid. */
void gl_pyramid_begin_level(const gl_pyramid *pyramid, uint32_t level, int from);
/* Every level can be read again. */
void gl_pyramid_end_levels(const gl_pyramid *pyramid);

/* Covers a framebuffer of that level's size with a main whose u_pixel is the size of one of its pixels. */
facet_result gl_pyramid_draw(const gl_pyramid *pyramid, const gl_pyramid_brush *brush, gl_program_key key,
                             uint32_t level, facet_error *error);

#endif
