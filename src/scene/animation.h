/* animation.h - a scene's nodes, materials, lights and cameras at a point in time. */
#ifndef SCENE_ANIMATION_H
#define SCENE_ANIMATION_H

#include "scene/scene.h"

/* The scene's arrays, or copies of those that an animation changes. */
typedef struct scene_state {
    const scene_node *nodes;
    const scene_material *materials;
    const scene_light *lights;
    const scene_camera *cameras;

    scene_node *node_copies; /* blocks of mem_alloc(), NULL: the scene's arrays are used */
    scene_material *material_copies;
    scene_light *light_copies;
    scene_camera *camera_copies;
    float *weights; /* those of animated node copies */
} scene_state;

/* Evaluates desc's animations (NULL: none) at desc->time_s and clamps the values to the ranges of the
 * reader; values that are not finite are not applied. Fails with FACET_ERROR_ARGUMENT for an unknown
 * animation or a time that is not finite, FACET_ERROR_MEMORY. */
facet_result scene_state_create(const facet_scene *scene, const facet_pose_desc *desc,
                                const facet_allocator *allocator, scene_state *state, facet_error *error);
void scene_state_destroy(scene_state *state); /* {0} is allowed */

/* Morph weights of a node with a mesh, as many as the mesh has: its own or the mesh's. */
const float *scene_state_weights(const facet_scene *scene, const scene_state *state, uint32_t node);

#endif
