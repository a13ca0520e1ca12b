/* light_tree_nodes.h - memory layout of a light tree. For light_tree.c and light_tree_build.c. */
#ifndef PATH_LIGHT_TREE_NODES_H
#define PATH_LIGHT_TREE_NODES_H

#include "path/light_tree.h"

enum {
    WIDTH = LIGHT_TREE_WIDTH,
    MAX_DEPTH = 96 /* nodes from root to leaf; light_tree_build.c keeps below it */
};
#define LEAF 0x80000000u

/* The share of the bound in the weight of a child. Variances of the estimated irradiance with 1, .25, .1:
 * 2 cm below a ball of 100 000 triangles 15.8, 1.8, 1.2; a floor under 2000 bulbs 1.7, .42, .61; among 30
 * 000 random triangles 1.7, 1.5, 2.4; an office's ceiling of 36 panels .99, .82, .88. */
#define BOUND_SHARE 0.25f

/* Bounds of eight children, member by member; missing children have intensity 0. */
typedef struct light_tree_node {
    float x[WIDTH], y[WIDTH], z[WIDTH], radius[WIDTH], per_radius2[WIDTH];
    float axis_x[WIDTH], axis_y[WIDTH], axis_z[WIDTH];
    float cos_spread[WIDTH], sin_spread[WIDTH];
    float mean_normal[WIDTH]; /* length of the mean of all normals: 1: there is one */
    float back[WIDTH];        /* -1: emits against the axis as well; 1 */
    float dark[WIDTH], per_ramp[WIDTH];
    float bound_share[WIDTH]; /* share of the bound in the weight; the rest is that of the mean */
    float slack[WIDTH], per_reach2[WIDTH], intensity[WIDTH];
    uint32_t child[WIDTH]; /* LEAF | light, or a node */
    uint32_t place;        /* WIDTH times the parent, plus which child of it; the root's: LIGHT_TREE_NONE */
    uint32_t unused[15];   /* so that nodes fill cache lines */
} light_tree_node;

struct light_tree {
    light_tree_node *nodes; /* the root first */
    uint32_t *places;       /* per light: WIDTH times its node, plus which child of it */
};

#endif
