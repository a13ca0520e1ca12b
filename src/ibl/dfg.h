/* dfg.h - where the nodes of the tables of directional albedo are: shared by generators and reader. */
#ifndef IBL_DFG_H
#define IBL_DFG_H

/* Node (x, y) of a table of size SIZE is for sqrt(NdotV) = x / (SIZE - 1), perceptual roughness y / (SIZE - 1). The
 * square root spreads the grazing angles, where the terms change fastest. */
enum {
    DFG_SIZE = 128,  /* the split sum's terms */
    SHEEN_SIZE = 128 /* sheen's albedo */
};

#endif
