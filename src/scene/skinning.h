/* skinning.h - vertices moved by the joints of a skin: linear blend skinning. */
#ifndef SCENE_SKINNING_H
#define SCENE_SKINNING_H

#include "scene/hierarchy.h"
#include "scene/morph.h"

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
