/* gl_ground.h - the shadow on the ground, an invisible plane under the model's lowest point: its ambient
 * occlusion by the model under a uniform sky, as a map that is made when the scene changes.
 *
 * The lowest and highest heights above the plane, seen from below and from above, are drawn into squares of 2
 * GL_GROUND_EDGE texels around the model. From them ground_map.frag computes the hidden share of the sky for
 * GL_GROUND_EDGE texels along an edge. */
#ifndef GL_GL_GROUND_H
#define GL_GL_GROUND_H

#include "gl/scene/gl_shadow.h"
#include "gl/scene/gl_light_block.h"

enum { GL_GROUND_EDGE = 256 };

/* Initialize with {.context}. */
typedef struct gl_ground {
    gl_context *context;
    bool is_wanted;
    float place[4];  /* x, z of the center, half the edge, height of the plane; m, world */
    float height[2]; /* above the plane, m: lowest and highest that the depth buffer represents */
    uint32_t heights, heights_framebuffer, map, map_framebuffer, empty_array; /* OpenGL names */
    uint64_t drawn_revision; /* scene revision of the map; 0: none */
} gl_ground;

/* Places the ground and sets is_wanted. */
void gl_ground_plan(gl_ground *ground, const facet_render_desc *desc, const float bounds_min[3],
                    const float bounds_max[3]);
void gl_ground_describe(const gl_ground *ground, gl_light_block *block);
/* Makes the map where the scene has changed. Changes the framebuffer, the viewport and the frame block;
 * the light block is bound. Fails as gl_programs_get(), with FACET_ERROR_MEMORY. */
facet_result gl_ground_draw(gl_ground *ground, gl_casters *casters, facet_error *error);
void gl_ground_destroy(gl_ground *ground); /* {0} is allowed; leaves {.context} */

#endif
