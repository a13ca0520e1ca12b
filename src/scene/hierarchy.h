/* hierarchy.h - world transforms of the nodes of one of the file's scenes. */
#ifndef SCENE_HIERARCHY_H
#define SCENE_HIERARCHY_H

#include "scene/animation.h"

typedef struct hierarchy {
    const scene_node *nodes; /* the state's */
    uint32_t count;          /* shown nodes, parents before children */
    uint32_t *shown;
    /* Per node of the file; for nodes that are not shown, computed on request. Composed in float, or
     * (scene->is_far) in double and relative to the file's origin; the other pointer is NULL. */
    mat4 *worlds;
    dmat4 *far_worlds;
    const double *origin;     /* the scene's */
    unsigned char *has_world; /* per node */
} hierarchy;

/* Visits the shown nodes of a scene: neither hidden nor below a hidden node. False: no memory. */
bool hierarchy_create(const facet_scene *scene, const scene_state *state, uint32_t index,
                      const facet_allocator *allocator, hierarchy *out);
void hierarchy_destroy(hierarchy *h); /* {0} is allowed */

/* World matrix of a shown node, relative to the scene's origin. */
dmat4 hierarchy_shown_world(const hierarchy *h, uint32_t node);
/* The same of any node, for joints: they move vertices even if they are hidden or outside of the scene. */
dmat4 hierarchy_world(hierarchy *h, uint32_t node);

/* The transform of copy i by EXT_mesh_gpu_instancing in the node's space. */
typedef struct copy_place {
    const float *translation, *rotation, *scale;
} copy_place;
copy_place hierarchy_copy(const scene_instancing *instancing, uint32_t i);
dmat4 copy_place_matrix(const copy_place *place);

#endif
