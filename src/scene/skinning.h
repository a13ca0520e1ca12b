/* skinning.h - vertices moved by morph targets and by the joints of a skin. */
#ifndef SCENE_SKINNING_H
#define SCENE_SKINNING_H

#include "scene/hierarchy.h"

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

#endif
