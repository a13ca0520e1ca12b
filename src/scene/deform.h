/* deform.h - vertices of a pose that differ from the file's: moved by morph targets and skins. */
#ifndef SCENE_DEFORM_H
#define SCENE_DEFORM_H

#include "scene/box.h"
#include "scene/hierarchy.h"

/* ---- vertices of one primitive (skinning.c) ---- */

/* Attributes that targets with a nonzero weight displace. */
typedef struct morph_use {
    bool positions, normals, tangents;
} morph_use;
morph_use morph_get_use(const scene_primitive *primitive, const float *weights, uint32_t weight_count);

/* Arrays of a whole primitive in its layout; NULL: not wanted. */
typedef struct vertex_arrays {
    float *positions, *normals, *tangents;
} vertex_arrays;

/* The same as input. */
typedef struct vertex_source {
    const float *positions, *normals, *tangents;
} vertex_source;

/* Writes vertices [begin, end): the primitive's plus weights times displacements. Directions are not unit
 * afterwards; w of tangents stays. weights: at least target_count, or weight_count, beyond which they are
 * 0. */
void morph_vertices(const scene_primitive *primitive, const float *weights, uint32_t weight_count,
                    size_t begin, size_t end, const vertex_arrays *out);

/* A skin at a point in time. */
typedef struct skin_pose {
    uint32_t joint_count;
    mat4 *matrices;   /* per joint, from mesh to world (see is_mirrored), then the identity */
    bool is_mirrored; /* most joints reflect: the matrices yield x with the opposite sign of the world's */
} skin_pose;

/* World matrix of each joint times its inverse bind matrix. False: no memory. */
bool skin_pose_create(const scene_skin *skin, hierarchy *h, const facet_allocator *allocator, skin_pose *out);
void skin_pose_destroy(skin_pose *pose); /* {0} is allowed */

/* Moves vertices [begin, end) of in (the primitive's, or morphed) to out; NULL arrays of out are skipped,
 * out may be in. Normals and tangents are unit; one that loses its direction is the primitive's. False:
 * some position is beyond SCENE_FARTHEST or not finite. A joint index beyond the skin has no effect. */
bool skin_vertices(const skin_pose *pose, const scene_primitive *primitive, const vertex_source *in,
                   size_t begin, size_t end, const vertex_arrays *out);

/* ---- all primitives of a pose ---- */

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
