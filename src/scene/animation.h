/* animation.h - a scene's nodes, materials, lights and cameras at one time. */
#ifndef SCENE_ANIMATION_H
#define SCENE_ANIMATION_H

#include "scene/scene.h"

/* The scene's arrays, or copies of those of which an animation moves something. */
typedef struct scene_state {
    const scene_node *nodes;
    const scene_material *materials;
    const scene_light *lights;
    const scene_camera *cameras;

    scene_node *node_copies; /* blocks of mem_alloc(), NULL: the scene's are used */
    scene_material *material_copies;
    scene_light *light_copies;
    scene_camera *camera_copies;
    float *weights; /* those of the node copies that animations move */
} scene_state;

/* What desc's animations (NULL: none) make of the scene at desc->time_s: values as the keys have them, then brought
 * into the ranges that the reader keeps to; what is not finite leaves what was there. Fails with FACET_ERROR_ARGUMENT for
 * an animation that is not there or a time that is not finite, FACET_ERROR_MEMORY. */
facet_result scene_state_create(const facet_scene *scene, const facet_pose_desc *desc,
                                const facet_allocator *allocator, scene_state *state, facet_error *error);
void scene_state_destroy(scene_state *state); /* {0} is allowed */

/* Morph weights of a node that has a mesh, as many as that has: its own or the mesh's. */
const float *scene_state_weights(const facet_scene *scene, const scene_state *state, uint32_t node);

#endif
