/* dfg.c - the split-sum table and its lookup. The numbers are computed by dfg_generate.c when facet is built. */
#include <math.h>

#include "ibl/dfg.h"
#include "ibl/ibl.h"

static const float table[DFG_SIZE][DFG_SIZE][2] = {
#include "ibl_dfg_table.h"
};

void ibl_dfg(float NdotV, float perceptual_roughness, float out[2])
{
    float x = sqrtf(NdotV > 0.0f ? NdotV : 0.0f) * (DFG_SIZE - 1);
    float y = (perceptual_roughness > 0.0f ? perceptual_roughness : 0.0f) * (DFG_SIZE - 1);
    x = x < DFG_SIZE - 1 ? x : DFG_SIZE - 1;
    y = y < DFG_SIZE - 1 ? y : DFG_SIZE - 1;
    int x0 = x < DFG_SIZE - 2 ? (int)x : DFG_SIZE - 2;
    int y0 = y < DFG_SIZE - 2 ? (int)y : DFG_SIZE - 2;
    float wx = x - (float)x0;
    float wy = y - (float)y0;
    for (int i = 0; i < 2; i++) {
        float a = table[y0][x0][i] + (table[y0][x0 + 1][i] - table[y0][x0][i]) * wx;
        float b = table[y0 + 1][x0][i] + (table[y0 + 1][x0 + 1][i] - table[y0 + 1][x0][i]) * wx;
        out[i] = a + (b - a) * wy;
    }
}
