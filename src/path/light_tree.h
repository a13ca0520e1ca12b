/* light_tree.h - a choice among many lights by what each may give a point: a tree of their bounds, drawn from the root
 * down.
 *
 * Conty Estevez and Kulla 2018, "Importance Sampling of Many Lights with Adaptive Tree Splitting", with eight children a
 * node, weighed together: up to eight lights are all compared with one another, and 100 000 are six steps down. Each
 * weight bounds the irradiance that any light below can give from above, so that 0 is certain. */
#ifndef PATH_LIGHT_TREE_H
#define PATH_LIGHT_TREE_H

#include "facet/facet.h"
#include "shade/shade.h"

enum { LIGHT_TREE_WIDTH = 8 };
#define LIGHT_TREE_NONE 0xffffffffu

/* Where a light is and where it shines. */
typedef struct light_bounds {
    vec3 center; /* m */
    float radius;
    vec3 axis;        /* unit: all its normals are within a cone around it; {0}: they go all ways */
    float cos_spread; /* of that cone's half-angle */
    float dark,
        full; /* cosines of angles from a normal: nothing from dark on, all up to full, in between linear */
    /* m that it stands out behind the plane through center that axis is normal to, beyond which it does not shine;
     * INFINITY: it may */
    float slack;
    float reach;       /* m from center, from where on there is nothing; INFINITY */
    float intensity;   /* cd along a normal, above 0; finite, as are the others but where INFINITY is said */
    bool is_two_sided; /* shines against its normals as well */
} light_bounds;

typedef struct light_tree light_tree;

/* Of count > 0 lights. Fails with FACET_ERROR_MEMORY. */
facet_result light_tree_create(const light_bounds *lights, uint32_t count, const facet_allocator *allocator,
                               light_tree **out, facet_error *error);
void light_tree_destroy(light_tree *tree); /* NULL is allowed */

/* The lights as a surface with one normal at one place sees them. */
typedef struct light_tree_view {
    vec3 P, N;
    float root[LIGHT_TREE_WIDTH];
    float irradiance; /* lx, about that of all of them; 0: none reaches P. With N {0} as if P faced each. */
} light_tree_view;

/* N: unit, only what is above its horizon counts; {0}: all counts alike. */
void light_tree_see(const light_tree *tree, vec3 P, vec3 N, light_tree_view *view);
/* A light for u, uniform in [0, 1), and its probability; view->irradiance is above 0. *rest: where in its share u fell, as good
 * as u. LIGHT_TREE_NONE: what u led to does not reach P after all. */
uint32_t light_tree_sample(const light_tree *tree, const light_tree_view *view, double u, float *probability,
                           double *rest);
/* The probability that light_tree_sample() chooses that light with, to the bit. */
float light_tree_probability(const light_tree *tree, const light_tree_view *view, uint32_t light);

#endif
