/* gl_shadow_plan.h - the tiles of a shadow map: from lights and the bounds of a scene to frusta. No OpenGL. */
#ifndef GL_GL_SHADOW_PLAN_H
#define GL_GL_SHADOW_PLAN_H

#include "gl/scene/gl_shadow.h"

struct Light; /* shade/light.h */

/* What is to be in shadow. */
typedef struct shadow_bounds {
    float min[3], max[3];
} shadow_bounds;

/* Tiles that a light takes; 0: its light does not reach the bounds. */
uint32_t shadow_tile_count(const struct Light *light, const shadow_bounds *bounds);
/* Illuminance of what is nearest of the bounds, lx of luminance, whether in the cone of a spot or not. */
float shadow_brightness(const struct Light *light, const shadow_bounds *bounds);
/* With tiles of that edge, texels. */
gl_shadow_record shadow_record_make(const struct Light *light, const shadow_bounds *bounds,
                                    uint32_t first_tile, uint32_t tile);
/* Columns of the matrix to clip space (z from -1 to 1) of a tile; of points relative to eye. face: of a cube. */
void shadow_matrix(const gl_shadow_record *record, uint32_t face, const float eye[3], float out[16]);

#endif
