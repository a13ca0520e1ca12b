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
#include "ibl/sheen_nodes_packed.c"
#undef ibl_dfg_nodes
#undef ibl_sheen_nodes
#undef ibl_glass_nodes
#define ibl_dfg_halves packed_dfg_halves
#define ibl_sheen_halves packed_sheen_halves
#define ibl_glass_halves packed_glass_halves
#include "ibl/dfg_halves_packed.c"
#undef ibl_dfg_halves
#undef ibl_sheen_halves
#undef ibl_glass_halves

static void packing_loses_nothing(void **state)
{
    (void)state;
    assert_memory_equal(ibl_dfg_nodes(), packed_dfg_nodes(), DFG_SIZE * DFG_SIZE * 2 * sizeof(float));
    assert_memory_equal(ibl_sheen_nodes(), packed_sheen_nodes(), SHEEN_SIZE * SHEEN_SIZE * sizeof(float));
    assert_memory_equal(ibl_glass_nodes(), packed_glass_nodes(), GLASS_VALUES * sizeof(uint16_t));
}

static void halves_are_those_of_the_nodes(void **state)
{
    (void)state;
    static const struct {
        void (*plain)(uint16_t *), (*packed)(uint16_t *);
        size_t count;
    } tables[] = {{ibl_dfg_halves, packed_dfg_halves, DFG_VALUES},
                  {ibl_sheen_halves, packed_sheen_halves, SHEEN_VALUES},
                  {ibl_glass_halves, packed_glass_halves, GLASS_VALUES}};
    static uint16_t plain[GLASS_VALUES], packed[GLASS_VALUES];
    for (size_t i = 0; i < sizeof tables / sizeof *tables; i++) {
        memset(plain, 0, sizeof plain);
        memset(packed, 0, sizeof packed);
        tables[i].plain(plain);
        tables[i].packed(packed);
        assert_memory_equal(plain, packed, sizeof plain);
        assert_int_not_equal(plain[tables[i].count - 1], 0);
    }
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
        cmocka_unit_test(halves_are_those_of_the_nodes),
        cmocka_unit_test(packing_pays),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
