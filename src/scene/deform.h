/* deform.h - the vertices of one pose that are not those of the file: moved by morph targets and skins. */
#ifndef SCENE_DEFORM_H
#define SCENE_DEFORM_H

#include "scene/box.h"
#include "scene/skinning.h"

/* A primitive as one set of weights and one skin move it. Nodes that agree in both share it. */
typedef struct deformed {
    const scene_primitive *primitive;
    const float *weights; /* of the targets */
    uint32_t weight_count;
    const skin_pose *skin; /* NULL: none */
    vertex_arrays arrays;  /* NULL: as the primitive's */
    box bounds;            /* of positions that indices use */
    bool is_moved;         /* false: nothing moves it, all of the above is the primitive's */
    bool is_unbounded;     /* a vertex is farther out than SCENE_FARTHEST, or not finite: not to be drawn */
} deformed;

typedef struct deform_set {
    size_t count;
    deformed *items;
    /* per shown node of the hierarchy: its mesh's first primitive in items, SCENE_NONE: nothing moves it; NULL:
     * nothing moves any */
    uint32_t *first;
    float *block;     /* what arrays point into */
    skin_pose *skins; /* per skin of the scene, those that are used */
    uint32_t skin_count;
} deform_set;

/* Deforms what the shown nodes need. Fails with FACET_ERROR_LIMIT above 2^27 vertices, FACET_ERROR_MEMORY. */
facet_result deform_create(const facet_scene *scene, const scene_state *state, hierarchy *h,
                           const facet_allocator *allocator, uint32_t thread_count, deform_set *set,
                           facet_error *error);
void deform_destroy(deform_set *set); /* {0} is allowed */

/* Primitive number index of the mesh of the shown node number shown; NULL: it is as the file has it. */
static inline const deformed *deform_get(const deform_set *set, uint32_t shown, uint32_t index)
{
    if (!set->first || set->first[shown] == SCENE_NONE)
        return NULL;
    const deformed *item = &set->items[set->first[shown] + index];
    return item->is_moved ? item : NULL;
}

#endif
