/* gl_shadow.h - shadow maps of punctual lights and the sun: tiles of one square depth texture.
 *
 * Spot and directional lights have one tile, others six, the faces of a cube (cube.h). The frustum of a
 * tile is extended by GL_SHADOW_GUARD texels on each side, so that filters do not read across edges. */
#ifndef GL_GL_SHADOW_H
#define GL_GL_SHADOW_H

#include "draw/light_setup.h"
#include "gl/scene/gl_ground.h"

enum {
    GL_SHADOW_GUARD = 4,      /* texels */
    GL_SHADOW_TILE_MIN = 256, /* texels along an edge */
    GL_SHADOW_TILE_MAX = 2048,
    GL_SHADOW_MAP_MAX = 4096 /* of the whole texture */
};

/* Lookup data of a light's tiles, for shadow.glsl. d: from origin to a point. */
typedef struct gl_shadow_record {
    float origin[3], kind; /* m, world; GL_SHADOW_* */
    float right[3],
        texel;         /* dot(d, right) (over depth) is x in [-1, 1]; edge of a texel in m (at depth 1 m) */
    float up[3], tile; /* index of the first tile */
    float forward[3], scale; /* unit (parallel: 1 over the range of depth); cube faces: scale of s and t */
    float depth_a, depth_b, reserved[2]; /* the compared depth is a + b / depth */
} gl_shadow_record;

enum { GL_SHADOW_PARALLEL, GL_SHADOW_SPOT, GL_SHADOW_CUBE };

typedef struct gl_shadow gl_shadow;

facet_result gl_shadow_create(gl_context *context, const facet_allocator *allocator, gl_shadow **out,
                              facet_error *error);
void gl_shadow_destroy(gl_shadow *shadow); /* NULL is allowed */

/* Decides which lights cast shadows within the bounds of a scene (m): the brightest, as many as fit, with a
 * warning for the rest; none where desc has no shadows. FACET_ERROR_MEMORY. */
facet_result gl_shadow_plan(gl_shadow *shadow, const facet_render_desc *desc, const light_setup *setup,
                            const float bounds_min[3], const float bounds_max[3], facet_error *error);
/* The result of the plan. */
const gl_shadow_record *gl_shadow_records(const gl_shadow *shadow, uint32_t *count);
uint32_t gl_shadow_of_light(const gl_shadow *shadow,
                            uint32_t light); /* index of its record, from 1; 0: none */
void gl_shadow_describe(const gl_shadow *shadow, gl_light_block *block);

/* Draws the tiles where the scene or the lights have changed. Changes the framebuffer, the viewport and
 * the frame block. Fails as gl_programs_get(), with FACET_ERROR_MEMORY. */
facet_result gl_shadow_draw(gl_shadow *shadow, gl_casters *casters, facet_error *error);
uint32_t gl_shadow_texture(const gl_shadow *shadow); /* OpenGL name; 0: none */

#endif
