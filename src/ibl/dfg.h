/* dfg.h - where the nodes of the tables of directional albedo are: shared by generators and reader. */
#ifndef IBL_DFG_H
#define IBL_DFG_H

#include <stdint.h>

/* Node (x, y) of a table of size SIZE is for sqrt(NdotV) = x / (SIZE - 1), perceptual roughness y / (SIZE - 1). The
 * square root spreads the grazing angles, where the terms change fastest. */
enum {
    DFG_SIZE = 128,   /* the split sum's terms */
    SHEEN_SIZE = 128, /* sheen's albedo */
    GLASS_SIZE = 24,  /* a boundary's terms (glass.h), for each of GLASS_IORS from either side */
    GLASS_IORS = 17
};

/* Node z of a boundary's terms is for ((ior - 1) / (ior + 1)) = GLASS_ROOT_MAX (z / (GLASS_IORS - 1))^2: close where ior
 * is near 1 and the terms change fastest; the last is ior 9. Terms are stored times GLASS_UNIT. */
#define GLASS_ROOT_MAX 0.8f
#define GLASS_UNIT 65535.0f

/* The nodes themselves, which ibl_dfg(), ibl_sheen_albedo() and ibl_glass() look up in: rows of roughness, columns of
 * sqrt(NdotV). Glass has a layer per ior for light from outside (eta above 1), then those for light from inside, times
 * GLASS_UNIT. */
const float *ibl_dfg_nodes(void);      /* DFG_SIZE x DFG_SIZE x 2 */
const float *ibl_sheen_nodes(void);    /* SHEEN_SIZE x SHEEN_SIZE */
const uint16_t *ibl_glass_nodes(void); /* 2 GLASS_IORS x GLASS_SIZE x GLASS_SIZE x 3 */

#endif
