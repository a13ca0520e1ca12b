/* gl_sort.h - what is blended from back to front, across all batches, triangle by triangle.
 *
 * Triangles and sprites are ordered by the depth of their middles. Whatever of one instance follows each other is drawn by
 * one call, a run. Instances that do not lie over each other in the picture, or of which one is behind the other as
 * a whole, need not be interleaved: only what may cover each other is ordered together. Where that still makes more
 * calls than is good, instances take turns by slices of depth; within a slice each has its own order. */
#ifndef GL_GL_SORT_H
#define GL_GL_SORT_H

#include "gl/scene/gl_mesh.h"

/* One instance of a batch. */
typedef struct gl_sort_unit {
    uint32_t batch, instance; /* of GL_PASS_BLENDED; of all */
    uint32_t first, count;    /* of its triangles or sprites among all */
    float box[2][3];          /* world, m */
} gl_sort_unit;

typedef struct gl_sort_run {
    uint32_t unit, first, count; /* triangles or sprites, in the order of their unit */
} gl_sort_run;

typedef struct gl_sort {
    facet_allocator allocator;
    uint64_t revision; /* of the scene; 0: of none */
    float view_projection[16], eye[4];
    uint32_t unit_count, count, run_count;
    gl_sort_unit *units;
    float *middles;    /* 3 per triangle or sprite, world, m */
    uint32_t *unit_of; /* the same */
    uint32_t *order;   /* per unit, from its first on: numbers within it, the farthest first */
    gl_sort_run *runs; /* the farthest first */
    uint32_t *scratch; /* 5 per triangle or sprite */
    size_t run_capacity;
} gl_sort;

/* Orders for a picture. *is_new: it is not as it was. Fails with FACET_ERROR_MEMORY. */
facet_result gl_sort_update(gl_sort *sort, const gl_mesh_set *meshes, const gl_scene *scene,
                            const gl_frame_block *frame, uint32_t thread_count, bool *is_new,
                            facet_error *error);
void gl_sort_destroy(gl_sort *sort); /* leaves {0} but for the allocator */

#endif
