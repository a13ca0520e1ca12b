/* settle.h - values that an animation wrote, brought into the ranges that the reader keeps to: splines overshoot. */
#ifndef SCENE_SETTLE_H
#define SCENE_SETTLE_H

#include "scene/scene.h"

/* What bytes [offset, offset + size) of the material hold: parameters keep to what the specification allows, texture
 * refs get their transform. */
void scene_settle_material(scene_material *material, size_t offset, size_t size);
/* Nothing is negative, cones are at most right angles, the inner one is inside. */
void scene_settle_light(scene_light *light);
/* A lens that cannot be is the one that the camera rests with. */
void scene_settle_camera(scene_camera *camera, const scene_camera *rest);

#endif
