/* unseen.h - what no camera can see: opacity 0 throughout, triangles without area. It counts neither for the bounds of a
 * pose nor for its framing. */
#ifndef SCENE_UNSEEN_H
#define SCENE_UNSEEN_H

#include "scene/scene.h"

/* Whether a primitive with this material is transparent everywhere, by the material's opacity and the colors at its vertices.
 * Textures are not decoded for that. */
bool unseen_is_transparent(const scene_primitive *primitive, const scene_material *material);

/* Whether a triangle is a line or a point: its height is at most 1e-7 of its longest edge, which covers the rounding of
 * coordinates. */
bool unseen_is_flat(const float *positions, const uint32_t corners[3]);

/* After reading: bounds of primitives become those of the triangles that have an area. Leaves what morph targets or a skin
 * move, which may unfold it. */
void unseen_tighten_bounds(facet_scene *scene);

#endif
