/* deform.h - vertices of a pose that differ from the file's: moved by morph targets and skins. */
#ifndef SCENE_DEFORM_H
#define SCENE_DEFORM_H

#include "scene/box.h"
#include "scene/skinning.h"

/* A primitive deformed by one set of weights and one skin, shared by nodes that have both in common. */
typedef struct deformed {
    const scene_primitive *primitive;
    const float *weights; /* of the targets */
    uint32_t weight_count;
    const skin_pose *skin; /* NULL: none */
    vertex_arrays arrays;  /* NULL members: as in the primitive */
    box bounds;            /* of positions in use */
    bool is_moved;         /* false: not deformed, all of the above is the primitive's */
    bool is_unbounded;     /* a vertex is beyond SCENE_FARTHEST or not finite: not drawn */
} deformed;

typedef struct deform_set {
    size_t count;
    deformed *items;
    /* per shown node of the hierarchy: its mesh's first primitive in items, SCENE_NONE: not deformed;
     * NULL: no node is deformed */
    uint32_t *first;
    float *block;     /* memory of the arrays */
    skin_pose *skins; /* per skin of the scene, those in use */
    uint32_t skin_count;
} deform_set;

/* Deforms the meshes of shown nodes. Fails with FACET_ERROR_LIMIT above 2^27 vertices, FACET_ERROR_MEMORY. */
facet_result deform_create(const facet_scene *scene, const scene_state *state, hierarchy *h,
                           const facet_allocator *allocator, uint32_t thread_count, deform_set *set,
                           facet_error *error);
void deform_destroy(deform_set *set); /* {0} is allowed */

/* Primitive `index` of the mesh of shown node `shown`; NULL: not deformed. */
static inline const deformed *deform_get(const deform_set *set, uint32_t shown, uint32_t index)
{
    if (!set->first || set->first[shown] == SCENE_NONE)
        return NULL;
    const deformed *item = &set->items[set->first[shown] + index];
    return item->is_moved ? item : NULL;
}

#endif
