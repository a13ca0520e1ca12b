/* dfg_nodes_packed.c - the LUTs of dfg_nodes.c for browsers, where bytes to download cost more than the milliseconds of unpacking
 * a table when it is first used. For programs of one thread. */
#include <stdbool.h>

#include "base/packed_table.h"
#include "ibl/dfg.h"

static const unsigned char dfg_packed[] = {
#include "ibl_dfg_packed.h"
};

static const unsigned char glass_packed[] = {
#include "ibl_glass_packed.h"
};

const float *ibl_dfg_nodes(void)
{
    static float nodes[DFG_SIZE * DFG_SIZE * 2];
    static bool is_unpacked;
    if (!is_unpacked)
        packed_table_read(dfg_packed, (packed_shape)DFG_SHAPE, nodes);
    is_unpacked = true;
    return nodes;
}

const uint16_t *ibl_glass_nodes(void)
{
    enum { COUNT = 2 * GLASS_IORS * GLASS_SIZE * GLASS_SIZE * 3 };
    static float values[COUNT];
    static uint16_t nodes[COUNT];
    static bool is_unpacked;
    if (!is_unpacked) {
        packed_table_read(glass_packed, (packed_shape)GLASS_SHAPE, values);
        for (int i = 0; i < COUNT; i++)
            nodes[i] = (uint16_t)values[i];
    }
    is_unpacked = true;
    return nodes;
}
