/* dfg.h - parametrization of the LUTs of directional albedo, shared by generator and lookup. */
#ifndef IBL_DFG_H
#define IBL_DFG_H

#include <stdint.h>

/* Node (x, y) of a LUT of size SIZE is at sqrt(NdotV) = x / (SIZE - 1), perceptual roughness y / (SIZE - 1).
 * The square root refines grazing angles, where the terms change fastest. */
enum {
    DFG_SIZE = 128,   /* split-sum terms */
    SHEEN_SIZE = 128, /* albedo of sheen */
    GLASS_SIZE = 24,  /* terms of a dielectric boundary (glass.h), for each of GLASS_IORS from either side */
    GLASS_IORS = 17
};

/* Node z of a boundary is at ((ior - 1) / (ior + 1)) = GLASS_ROOT_MAX (z / (GLASS_IORS - 1))^2, dense near
 * ior 1, where the terms change fastest; the last is ior 9. Terms are stored times GLASS_UNIT. */
#define GLASS_ROOT_MAX 0.8f
#define GLASS_UNIT 65535.0f

/* In the terms of packed_table.h: channels, width, height, depth. */
#define DFG_SHAPE                                                                                            \
    {                                                                                                        \
        2, DFG_SIZE, DFG_SIZE, 1                                                                             \
    }
#define SHEEN_SHAPE                                                                                          \
    {                                                                                                        \
        1, SHEEN_SIZE, SHEEN_SIZE, 1                                                                         \
    }
#define GLASS_SHAPE                                                                                          \
    {                                                                                                        \
        3, GLASS_SIZE, GLASS_SIZE, 2 * GLASS_IORS                                                            \
    }

/* The nodes of ibl_dfg(), ibl_sheen_albedo() and ibl_glass(): rows of roughness, columns of sqrt(NdotV).
 * Glass has a layer per ior for light from outside (eta above 1), then those for light from inside, times
 * GLASS_UNIT. dfg_nodes.c has them as arrays, dfg_nodes_packed.c unpacks them. */
const float *ibl_dfg_nodes(void);      /* DFG_SIZE x DFG_SIZE x 2 */
const float *ibl_sheen_nodes(void);    /* SHEEN_SIZE x SHEEN_SIZE */
const uint16_t *ibl_glass_nodes(void); /* 2 GLASS_IORS x GLASS_SIZE x GLASS_SIZE x 3 */

/* The same as half floats, glass from 0 to 1, for textures. dfg_halves.c rounds the nodes, dfg_halves_packed.c unpacks tables that
 * were rounded beforehand. Each fills a whole table. */
void ibl_dfg_halves(uint16_t *halves);
void ibl_sheen_halves(uint16_t *halves);
void ibl_glass_halves(uint16_t *halves);

enum {
    DFG_VALUES = DFG_SIZE * DFG_SIZE * 2,
    SHEEN_VALUES = SHEEN_SIZE * SHEEN_SIZE,
    GLASS_VALUES = 2 * GLASS_IORS * GLASS_SIZE * GLASS_SIZE * 3
};

#endif
