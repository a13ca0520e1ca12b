/* hierarchy.h - where the nodes of one of the file's scenes stand in the world. */
#ifndef SCENE_HIERARCHY_H
#define SCENE_HIERARCHY_H

#include "scene/animation.h"

typedef struct hierarchy {
    const scene_node *nodes; /* the state's */
    uint32_t count;          /* of nodes that are shown, parents before children */
    uint32_t *shown;
    /* Per node of the file; of those that are not shown once they were asked for. Composed in float, or (scene->is_far)
     * in double and relative to the file's origin; the other is NULL. */
    mat4 *worlds;
    dmat4 *far_worlds;
    const double *origin;     /* the scene's */
    unsigned char *has_world; /* per node */
} hierarchy;

/* Visits what scene number index shows: not what is hidden or below something hidden. False: no memory. */
bool hierarchy_create(const facet_scene *scene, const scene_state *state, uint32_t index,
                      const facet_allocator *allocator, hierarchy *out);
void hierarchy_destroy(hierarchy *h); /* {0} is allowed */

/* World matrix of a node that is shown, relative to the scene's origin. */
dmat4 hierarchy_shown_world(const hierarchy *h, uint32_t node);
/* The same of any node, for joints: they move vertices where they are hidden and outside of the scene, too. */
dmat4 hierarchy_world(hierarchy *h, uint32_t node);

/* Where EXT_mesh_gpu_instancing puts copy number i in the node's space. */
typedef struct copy_place {
    const float *translation, *rotation, *scale;
} copy_place;
copy_place hierarchy_copy(const scene_instancing *instancing, uint32_t i);
dmat4 copy_place_matrix(const copy_place *place);

#endif
