/* gl_bvh.h - a bounding volume hierarchy for shaders: nodes in depth-first order, each with the node that follows its
 * subtree. The first child of an inner node is the next node, the second one follows the first one's subtree. No more
 * than GL_BVH_DEPTH inner nodes contain each other, which bounds the stack of a shader. */
#ifndef GL_GL_BVH_H
#define GL_GL_BVH_H

#include "facet/facet.h"

enum {
    GL_BVH_LEAF = 4,  /* most items of a leaf */
    GL_BVH_DEPTH = 30 /* enough for 2^32 items */
};

typedef struct gl_bvh_node {
    float low[3], high[3]; /* m */
    uint32_t next;         /* the node after the subtree; the number of nodes: none */
    uint32_t first,
        count; /* items of a leaf in gl_bvh.order; count 0: an inner node, whose child is the next node */
} gl_bvh_node;

typedef struct gl_bvh {
    gl_bvh_node *nodes; /* the root first */
    uint32_t *order;    /* items by leaf */
    uint32_t node_count, count;
} gl_bvh;

/* Builds the hierarchy of count boxes, 6 floats each: lowest, highest corner. Splits by the surface area heuristic
 * over bins of centers (Wald 2007, "On fast construction of SAH-based bounding volume hierarchies"). Depends on the
 * boxes only. FACET_ERROR_MEMORY; *out is {0} then. */
facet_result gl_bvh_build(const float *boxes, uint32_t count, const facet_allocator *allocator, gl_bvh *out,
                          facet_error *error);
void gl_bvh_destroy(gl_bvh *bvh); /* {0} is allowed; leaves {0} */

#endif
