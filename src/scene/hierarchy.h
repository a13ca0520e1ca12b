/* hierarchy.h - where the nodes of one of the file's scenes stand in the world. */
#ifndef SCENE_HIERARCHY_H
#define SCENE_HIERARCHY_H

#include "scene/animation.h"

typedef struct hierarchy {
    const scene_node *nodes; /* the state's */
    uint32_t count;          /* of nodes that are shown, parents before children */
    uint32_t *shown;
    mat4 *worlds;             /* per node of the file; of those that are not shown once they were asked for */
    unsigned char *has_world; /* the same */
} hierarchy;

/* Visits what scene number index shows: not what is hidden or below something hidden. False: no memory. */
bool hierarchy_create(const facet_scene *scene, const scene_state *state, uint32_t index,
                      const facet_allocator *allocator, hierarchy *out);
void hierarchy_destroy(hierarchy *h); /* {0} is allowed */

/* World matrix of any node, for joints: they move vertices where they are hidden and outside of the scene, too. */
const mat4 *hierarchy_world(hierarchy *h, uint32_t node);

#endif
