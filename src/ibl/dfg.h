/* dfg.h - where the nodes of the split-sum table are: shared by its generator and its reader. */
#ifndef IBL_DFG_H
#define IBL_DFG_H

/* Node (x, y) holds the terms for sqrt(NdotV) = x / (DFG_SIZE - 1), perceptual roughness y / (DFG_SIZE - 1). The
 * square root spreads the grazing angles, where the terms change fastest. */
enum { DFG_SIZE = 128 };

#endif
