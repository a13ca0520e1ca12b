/* vertex_tree.h - a bounding volume hierarchy of a primitive's vertices, to find the extreme ones by
 * branch and bound: many instances of one primitive cost a few vertices each instead of all of them. */
#ifndef SCENE_VERTEX_TREE_H
#define SCENE_VERTEX_TREE_H

#include "scene/box.h"

typedef struct vertex_node {
    box bounds;
    uint32_t begin, end; /* of a leaf: its blocks */
    uint32_t right;      /* the second child, the first one is the next node; 0: a leaf */
} vertex_node;

/* Vertices of a leaf, transposed in groups of four for vectorized loops; the last block repeats its last
 * vertex. */
enum { VERTEX_LANES = 4 };
typedef struct vertex_block {
    float xyz[3][VERTEX_LANES];
} vertex_block;

/* {0}: none. */
typedef struct vertex_tree {
    vertex_node *nodes;
    vertex_block *blocks;
} vertex_tree;

/* The positions that the indices of p use, without degenerate triangles. False: no memory, or no vertices. */
bool vertex_tree_create(const scene_primitive *p, const facet_allocator *allocator, vertex_tree *out);
void vertex_tree_destroy(vertex_tree *tree); /* {0} is allowed; leaves {0} */

/* A search. gain(): an upper bound of what the vertices in a box (of the primitive, before world) can add
 * to the result; <= 0: nothing. */
typedef struct vertex_visitor {
    void *context;
    double (*gain)(void *context, const box *bounds);
    void (*visit)(void *context, const vertex_block *blocks, uint32_t count);
} vertex_visitor;
void vertex_tree_visit(const vertex_tree *tree, const vertex_visitor *visitor);

/* Trees of the primitives of a pose, built once enough instances of a primitive were examined in full for
 * it to pay. {0}: none yet. */
typedef struct vertex_trees {
    const facet_scene *scene;
    const facet_allocator *allocator;
    uint32_t *first; /* per mesh: its first primitive in items */
    struct vertex_trees_item {
        uint32_t use_count;
        bool has_failed;
        vertex_tree tree;
    } * items;
    uint32_t item_count;
} vertex_trees;

void vertex_trees_destroy(vertex_trees *trees);
/* The tree for an instance; NULL: examine all vertices. Call it once per examined instance. */
const vertex_tree *vertex_trees_get(vertex_trees *trees, const scene_instance *instance);

#endif
