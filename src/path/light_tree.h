/* light_tree.h - importance sampling of many lights by their estimated irradiance at a point: a tree of
 * bounds, traversed from the root.
 *
 * Conty Estevez and Kulla 2018, "Importance Sampling of Many Lights with Adaptive Tree Splitting", with
 * eight children per node, weighted together: up to eight lights are all compared with one another, and
 * 100 000 are six levels deep. Each weight is an upper bound of the irradiance from any light below, so
 * that 0 is exact. */
#ifndef PATH_LIGHT_TREE_H
#define PATH_LIGHT_TREE_H

#include "facet/facet.h"
#include "shade/shade.h"

enum { LIGHT_TREE_WIDTH = 8 };
#define LIGHT_TREE_NONE 0xffffffffu

/* Bounds of the positions and directions of a light. */
typedef struct light_bounds {
    vec3 center; /* m */
    float radius;
    vec3 axis;        /* unit: axis of a cone around all its normals; {0}: all directions */
    float cos_spread; /* of that cone's half-angle */
    /* cosines of angles from a normal: no emission from dark on, all up to full, linear between */
    float dark, full;
    /* m by which it extends behind the plane through center with normal axis, beyond which it does not emit;
     * INFINITY: it may */
    float slack;
    float reach;       /* range in m from center; INFINITY: none */
    float intensity;   /* cd along a normal, positive; finite, as are the others unless INFINITY is allowed */
    bool is_two_sided; /* emits against its normals as well */
} light_bounds;

typedef struct light_tree light_tree;

/* Of count > 0 lights. Fails with FACET_ERROR_MEMORY. */
facet_result light_tree_create(const light_bounds *lights, uint32_t count, const facet_allocator *allocator,
                               light_tree **out, facet_error *error);
void light_tree_destroy(light_tree *tree); /* NULL is allowed */

/* The lights as seen by a surface with one normal at one place. */
typedef struct light_tree_view {
    vec3 P, N;
    float root[LIGHT_TREE_WIDTH];
    /* lx, approximately that of all of them; 0: none reaches P. With N {0} as if P faced each. */
    float irradiance;
} light_tree_view;

/* N: unit, only lights above its horizon count; {0}: all count alike. */
void light_tree_see(const light_tree *tree, vec3 P, vec3 N, light_tree_view *view);
/* Samples a light by u, uniform in [0, 1); view->irradiance is positive. *rest: the position of u within
 * its share, again uniform. LIGHT_TREE_NONE: the subtree that was chosen does not reach P after all. */
uint32_t light_tree_sample(const light_tree *tree, const light_tree_view *view, double u, float *probability,
                           double *rest);
/* The probability with which light_tree_sample() chooses that light, bit for bit. */
float light_tree_probability(const light_tree *tree, const light_tree_view *view, uint32_t light);

#endif
