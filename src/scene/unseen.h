/* unseen.h - geometry that no camera can see: opacity 0 everywhere, triangles without area. It is excluded
 * from the bounds of a pose and from framing. */
#ifndef SCENE_UNSEEN_H
#define SCENE_UNSEEN_H

#include "scene/scene.h"

/* Whether a primitive is transparent everywhere, by the material's opacity and vertex colors. Textures are
 * not decoded for that. */
bool unseen_is_transparent(const scene_primitive *primitive, const scene_material *material);

/* Whether a triangle is degenerate: its height is at most 1e-7 of its longest edge, which covers the
 * rounding of coordinates. */
bool unseen_is_flat(const float *positions, const uint32_t corners[3]);

/* After reading: bounds of primitives become those of the triangles with an area. Skips primitives with
 * morph targets or a skin, which may unfold triangles. */
void unseen_tighten_bounds(facet_scene *scene);

#endif
