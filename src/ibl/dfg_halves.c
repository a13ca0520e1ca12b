/* dfg_halves.c - see dfg.h. */
#include "ibl/dfg.h"
#include "image/half.h"

static void round_values(const float *values, int count, uint16_t *halves)
{
    for (int i = 0; i < count; i++)
        halves[i] = half_from_float(values[i]);
}

void ibl_dfg_halves(uint16_t *halves)
{
    round_values(ibl_dfg_nodes(), DFG_VALUES, halves);
}

void ibl_sheen_halves(uint16_t *halves)
{
    round_values(ibl_sheen_nodes(), SHEEN_VALUES, halves);
}

void ibl_glass_halves(uint16_t *halves)
{
    const uint16_t *nodes = ibl_glass_nodes();
    for (int i = 0; i < GLASS_VALUES; i++)
        halves[i] = half_from_float((float)nodes[i] * (1.0f / GLASS_UNIT));
}
