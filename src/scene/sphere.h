/* sphere.h - a sphere that shows a material. */
#ifndef SCENE_SPHERE_H
#define SCENE_SPHERE_H

#include "scene/scene.h"

/* Radius 1 around the origin, with normals and TEXCOORD_0: u goes around from -Z, v from the top to the
 * bottom. No triangle is degenerate. Its arrays are of the arena, its material is SCENE_NONE. False: no
 * memory. At least 3 segments and 2 rings, at most 2^15 each. */
bool scene_make_sphere(arena *memory, uint32_t segments, uint32_t rings, scene_primitive *out);

#endif
