/* gl_shadow_plan.h - frusta and tiles of shadow maps from lights and the bounds of a scene. No OpenGL. */
#ifndef GL_GL_SHADOW_PLAN_H
#define GL_GL_SHADOW_PLAN_H

#include "gl/scene/gl_shadow.h"

struct Light; /* shade/light.h */

/* The region that receives shadows. */
typedef struct shadow_bounds {
    float min[3], max[3];
} shadow_bounds;

/* Number of tiles of a light; 0: it does not reach the bounds. */
uint32_t shadow_tile_count(const struct Light *light, const shadow_bounds *bounds);
/* Illuminance at the nearest point of the bounds, lx, ignoring the cone of a spot. */
float shadow_brightness(const struct Light *light, const shadow_bounds *bounds);
/* tile: edge of a tile in texels. */
gl_shadow_record shadow_record_make(const struct Light *light, const shadow_bounds *bounds,
                                    uint32_t first_tile, uint32_t tile);
/* Column-major matrix to clip space (z from -1 to 1) of a tile, for points relative to eye. face: of a cube. */
void shadow_matrix(const gl_shadow_record *record, uint32_t face, const float eye[3], float out[16]);

#endif
