/* gl_ground.h - the shadow on the ground, an unseen plane under the model's lowest point: what the model hides of a uniform sky
 * as a map, made when the scene changes.
 *
 * Heights of what stands on the plane, the lowest from below and the highest from above, are drawn into a square of
 * 2 GL_GROUND_EDGE texels around the model; from them ground_map.frag finds the share of the sky that is hidden, for
 * GL_GROUND_EDGE texels along an edge. */
#ifndef GL_GL_GROUND_H
#define GL_GL_GROUND_H

#include "gl/scene/gl_shadow.h"
#include "gl/scene/gl_light_block.h"

enum { GL_GROUND_EDGE = 256 };

/* {.context} is ready. */
typedef struct gl_ground {
    gl_context *context;
    bool is_wanted;
    float place[4];  /* x, z of the middle, half of the edge, height of the plane; m, world */
    float height[2]; /* above the plane, m: lowest and highest that depth can hold */
    uint32_t heights, heights_framebuffer, map, map_framebuffer, empty_array; /* OpenGL's names */
    uint64_t drawn_revision; /* of the scene that the map is of; 0: none */
} gl_ground;

/* Where the ground is; is_wanted: whether the picture has one. */
void gl_ground_plan(gl_ground *ground, const facet_render_desc *desc, const float bounds_min[3],
                    const float bounds_max[3]);
void gl_ground_describe(const gl_ground *ground, gl_light_block *block);
/* Makes the map where the scene is another one than before. The framebuffer, the viewport and the frame's block are others
 * afterwards; the block of light is bound. Fails as gl_programs_get(), with FACET_ERROR_MEMORY. */
facet_result gl_ground_draw(gl_ground *ground, gl_casters *casters, facet_error *error);
void gl_ground_destroy(gl_ground *ground); /* {0} is allowed; leaves {.context} */

#endif
