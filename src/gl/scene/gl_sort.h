/* gl_sort.h - the order of blended triangles from back to front, across all batches.
 *
 * Triangles and sprites are sorted by the depth of their centers. Consecutive ones of one instance are
 * drawn by one call, a run. Instances that do not overlap in the image, or that are entirely in front of
 * each other, are not interleaved: only a cluster of overlapping ones is sorted together. Where that still
 * takes too many calls, instances alternate by slices of depth, and each is sorted within a slice. */
#ifndef GL_GL_SORT_H
#define GL_GL_SORT_H

#include "gl/scene/gl_mesh.h"

/* One instance of a batch. */
typedef struct gl_sort_unit {
    uint32_t batch, instance; /* of GL_PASS_BLENDED; among all instances */
    uint32_t first, count;    /* range of its triangles or sprites among all */
    float box[2][3];          /* world, m */
} gl_sort_unit;

typedef struct gl_sort_run {
    uint32_t unit, first, count; /* triangles or sprites, in the order of their unit */
} gl_sort_run;

typedef struct gl_sort {
    facet_allocator allocator;
    uint64_t revision; /* of the scene; 0: none */
    float view_projection[16], eye[4];
    uint32_t unit_count, count, run_count;
    gl_sort_unit *units;
    float *middles;    /* centers: 3 per triangle or sprite, world, m */
    uint32_t *unit_of; /* per triangle or sprite */
    uint32_t *order;   /* per unit, from its first: indices within the unit, the farthest first */
    gl_sort_run *runs; /* the farthest first */
    uint32_t *scratch; /* 5 per triangle or sprite */
    size_t run_capacity;
} gl_sort;

/* Sorts for an image. *is_new: the order has changed. Fails with FACET_ERROR_MEMORY. */
facet_result gl_sort_update(gl_sort *sort, const gl_mesh_set *meshes, const gl_scene *scene,
                            const gl_frame_block *frame, uint32_t thread_count, bool *is_new,
                            facet_error *error);
void gl_sort_destroy(gl_sort *sort); /* leaves {0}, except for the allocator */

#endif
