/* sheen_nodes.c - the LUT of sheen from its half floats, which the viewer has for textures: the table of floats would be 16 kB
 * more to download. Their rounding, at most 0.05 %, is what filters of environments for sheen can bear. */
#include <stdbool.h>

#include "ibl/dfg.h"
#include "image/half.h"

const float *ibl_sheen_nodes(void)
{
    enum { COUNT = SHEEN_SIZE * SHEEN_SIZE };
    static float nodes[COUNT];
    static uint16_t halves[COUNT];
    static bool is_made;
    if (!is_made) {
        ibl_sheen_halves(halves);
        for (int i = 0; i < COUNT; i++)
            nodes[i] = half_to_float(halves[i]);
    }
    is_made = true;
    return nodes;
}
