/* dfg_nodes.c - the LUTs of directional albedo, which tables_generate.c computes when facet is built. */
#include "ibl/dfg.h"

static const float dfg_nodes[DFG_SIZE * DFG_SIZE * 2] = {
#include "ibl_dfg_table.h"
};

static const float sheen_nodes[SHEEN_SIZE * SHEEN_SIZE] = {
#include "ibl_sheen_table.h"
};

static const uint16_t glass_nodes[2 * GLASS_IORS * GLASS_SIZE * GLASS_SIZE * 3] = {
#include "ibl_glass_table.h"
};

const float *ibl_dfg_nodes(void)
{
    return dfg_nodes;
}

const float *ibl_sheen_nodes(void)
{
    return sheen_nodes;
}

const uint16_t *ibl_glass_nodes(void)
{
    return glass_nodes;
}
