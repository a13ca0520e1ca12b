/* skinning.h - vertices moved by morph targets and by the joints of a skin. */
#ifndef SCENE_SKINNING_H
#define SCENE_SKINNING_H

#include "scene/hierarchy.h"

/* Which attributes some target with a weight other than 0 moves. */
typedef struct morph_use {
    bool positions, normals, tangents;
} morph_use;
morph_use morph_get_use(const scene_primitive *primitive, const float *weights, uint32_t weight_count);

/* Arrays of a whole primitive, laid out as its own; NULL: not wanted. */
typedef struct vertex_arrays {
    float *positions, *normals, *tangents;
} vertex_arrays;

/* The same to read from. */
typedef struct vertex_source {
    const float *positions, *normals, *tangents;
} vertex_source;

/* Writes vertices [begin, end): the primitive's plus weights times the targets' changes. Directions are not unit then;
 * w of tangents stays. weights: at least target_count, or weight_count and those beyond are 0. */
void morph_vertices(const scene_primitive *primitive, const float *weights, uint32_t weight_count,
                    size_t begin, size_t end, const vertex_arrays *out);

/* A skin at one time. */
typedef struct skin_pose {
    uint32_t joint_count;
    mat4 *matrices; /* from the mesh to the world (of is_mirrored) per joint, and the identity; mem_alloc() */
    bool is_mirrored; /* most joints mirror: what the matrices give has x of the other sign than the world */
} skin_pose;

/* World matrix of each joint times its inverse bind matrix. False: no memory. */
bool skin_pose_create(const scene_skin *skin, hierarchy *h, const facet_allocator *allocator, skin_pose *out);
void skin_pose_destroy(skin_pose *pose); /* {0} is allowed */

/* Moves vertices [begin, end) of in (the primitive's, or morphed) to out; an array that is NULL in out is left out,
 * out may be in. Normals and tangents are unit; one that has no direction left is the primitive's. False: some position
 * is farther out than SCENE_FARTHEST, or not finite. A number of a joint that the skin does not have moves nothing. */
bool skin_vertices(const skin_pose *pose, const scene_primitive *primitive, const vertex_source *in,
                   size_t begin, size_t end, const vertex_arrays *out);

#endif
