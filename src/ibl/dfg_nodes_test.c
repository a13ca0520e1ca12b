/* dfg_nodes_test.c - the packed LUTs of browsers are those of other programs, bit by bit. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "ibl/dfg.h"

/* The same functions under other names. */
#define ibl_dfg_nodes packed_dfg_nodes
#define ibl_sheen_nodes packed_sheen_nodes
#define ibl_glass_nodes packed_glass_nodes
#include "ibl/dfg_nodes_packed.c"
#undef ibl_dfg_nodes
#undef ibl_sheen_nodes
#undef ibl_glass_nodes

static void packing_loses_nothing(void **state)
{
    (void)state;
    assert_memory_equal(ibl_dfg_nodes(), packed_dfg_nodes(), DFG_SIZE * DFG_SIZE * 2 * sizeof(float));
    assert_memory_equal(ibl_sheen_nodes(), packed_sheen_nodes(), SHEEN_SIZE * SHEEN_SIZE * sizeof(float));
    assert_memory_equal(ibl_glass_nodes(), packed_glass_nodes(),
                        2 * GLASS_IORS * GLASS_SIZE * GLASS_SIZE * 3 * sizeof(uint16_t));
}

static void packing_pays(void **state)
{
    (void)state;
    assert_true(sizeof dfg_packed < DFG_SIZE * DFG_SIZE * 2 * sizeof(float) / 3);
    assert_true(sizeof sheen_packed < SHEEN_SIZE * SHEEN_SIZE * sizeof(float) / 3);
    assert_true(sizeof glass_packed < sizeof(uint16_t) * 2 * GLASS_IORS * GLASS_SIZE * GLASS_SIZE * 3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(packing_loses_nothing),
        cmocka_unit_test(packing_pays),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
