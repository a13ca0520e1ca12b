/* bvh4.h - a bvh_tree with four children per node and, in its leaves, items of which four are tested at once. */
#ifndef CPU_BVH4_H
#define CPU_BVH4_H

#include "cpu/bvh_tree.h"
#include "cpu/float4.h"

/* Bounds of four children: x, y and z, of each the low and the high ones. Those that are missing are empty boxes. */
typedef struct bvh4_node {
    float4 planes[6];
    int32_t children[4]; /* index of a node, or a leaf: ~ its index */
    uint32_t unused[4];  /* fills two cache lines */
} bvh4_node;

/* Up to four triangles. Corners of lanes that are not used are NaN, which no ray hits. */
typedef struct bvh4_triangles {
    float4 corners[3][3]; /* [corner][axis] */
    uint32_t geometry[4], primitive[4];
} bvh4_triangles;

/* Items of the other kinds, by number. */
typedef struct bvh4_others {
    uint32_t count;
    uint32_t geometry[4], primitive[4];
} bvh4_others;

/* The leaves are the caller's: leaf i has the items that bvh4_create() wrote into leaves[i]. */
typedef struct bvh4 {
    bvh_child root; /* child: as in a node; BVH_EMPTY */
    uint32_t node_count, leaf_count;
    bvh4_node *nodes;
} bvh4;

/* Converts a tree; leaves: gets the leaves of the tree (bvh_leaf()) in their new order, a block for the caller to release.
 * FACET_ERROR_MEMORY: *out is empty, *leaves is NULL. */
facet_result bvh4_create(const bvh_tree *tree, const facet_allocator *allocator, bvh4 *out, int32_t **leaves,
                         facet_error *error);
void bvh4_destroy(bvh4 *tree); /* {0} is allowed */

#endif
