/* dfg_halves_packed.c - dfg_halves.c for browsers: what textures hold is half of the bytes of the nodes. The tables are packed as
 * those of dfg_nodes_packed.c, with the bits of each half as an integer. For programs of one thread. */
#include "base/packed_table.h"
#include "ibl/dfg.h"

static const unsigned char dfg_packed_halves[] = {
#include "ibl_dfg_halves_packed.h"
};

static const unsigned char sheen_packed_halves[] = {
#include "ibl_sheen_halves_packed.h"
};

static const unsigned char glass_packed_halves[] = {
#include "ibl_glass_halves_packed.h"
};

static void unpack(const unsigned char *packed, packed_shape shape, uint16_t *halves)
{
    static float values[GLASS_VALUES]; /* the largest table */
    packed_table_read(packed, shape, values);
    for (uint32_t i = 0; i < shape.channels * shape.width * shape.height * shape.depth; i++)
        halves[i] = (uint16_t)values[i];
}

void ibl_dfg_halves(uint16_t *halves)
{
    unpack(dfg_packed_halves, (packed_shape)DFG_SHAPE, halves);
}

void ibl_sheen_halves(uint16_t *halves)
{
    unpack(sheen_packed_halves, (packed_shape)SHEEN_SHAPE, halves);
}

void ibl_glass_halves(uint16_t *halves)
{
    unpack(glass_packed_halves, (packed_shape)GLASS_SHAPE, halves);
}
