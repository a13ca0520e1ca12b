/* bvh_tree.h - a binary bounding volume hierarchy over boxes, by the surface area heuristic (SAH) in bins (Wald 2007,
 * "On fast Construction of SAH-based Bounding Volume Hierarchies"). What the boxes enclose is the caller's. */
#ifndef CPU_BVH_TREE_H
#define CPU_BVH_TREE_H

#include <stdbool.h>

#include "base/memory.h"

enum {
    BVH_LEAF_ITEMS = 4,       /* at most, in a leaf */
    BVH_MAX_DEPTH = 32,       /* inner nodes on the way to a leaf: the stack of a traversal */
    BVH_MAX_ITEMS = 1u << 28, /* what the reference to a leaf has bits for */
    BVH_EMPTY = INT32_MIN     /* child of the root of an empty tree */
};

/* The box of an item, and its number of two parts, by which hits at equal distances are ordered. */
typedef struct bvh_item {
    float lo[3];
    uint32_t geometry;
    float hi[3];
    uint32_t primitive;
} bvh_item;

/* A child and its box, 32 bytes: two texels of four 32-bit words. */
typedef struct bvh_child {
    float lo[3];
    int32_t child; /* index of a node, or a leaf: bvh_leaf() */
    float hi[3];
    uint32_t unused;
} bvh_child;

/* An inner node. It has the boxes of its children (Aila and Laine 2009), so that a traversal reads 64 bytes at a time. */
typedef struct bvh_node {
    bvh_child children[2];
} bvh_node;

typedef struct bvh_tree {
    bvh_child root;
    uint32_t node_count; /* a node is before its children */
    bvh_node *nodes;
} bvh_tree;

/* Items first to first + count - 1, in the order of the tree. */
static inline int32_t bvh_leaf(uint32_t first, uint32_t count)
{
    return ~(int32_t)(first << 3 | (count - 1));
}
static inline bool bvh_is_leaf(int32_t child)
{
    return child < 0;
}
static inline uint32_t bvh_leaf_first(int32_t leaf)
{
    return (uint32_t)~leaf >> 3;
}
static inline uint32_t bvh_leaf_count(int32_t leaf)
{
    return ((uint32_t)~leaf & 7) + 1;
}

/* Whether an item can be in a tree: coordinates are finite and below 1.8e18, so that areas are finite. */
bool bvh_item_is_valid(const bvh_item *item);

/* Builds the tree of valid items, and reorders these: each leaf has consecutive ones. The result depends on the items and
 * their order alone, not on thread_count. Fails with FACET_ERROR_MEMORY, FACET_ERROR_LIMIT beyond BVH_MAX_ITEMS; *out is {0}
 * then. */
facet_result bvh_tree_build(bvh_item *items, size_t count, uint32_t thread_count,
                            const facet_allocator *allocator, bvh_tree *out, facet_error *error);
void bvh_tree_destroy(bvh_tree *tree); /* {0} is allowed */

#endif
