/* sheen_nodes_packed.c - the sheen of dfg_nodes_packed.c. The viewer's module has web/module/sheen_nodes.c in place of it. */
#include <stdbool.h>

#include "base/packed_table.h"
#include "ibl/dfg.h"

static const unsigned char sheen_packed[] = {
#include "ibl_sheen_packed.h"
};

const float *ibl_sheen_nodes(void)
{
    static float nodes[SHEEN_SIZE * SHEEN_SIZE];
    static bool is_unpacked;
    if (!is_unpacked)
        packed_table_read(sheen_packed, (packed_shape)SHEEN_SHAPE, nodes);
    is_unpacked = true;
    return nodes;
}
