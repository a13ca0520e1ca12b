/* fit_table_test.c - the packed table of browsers is that of other programs, bit by bit. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "legacy/fit_table.h"

const fit_table *packed_table_get(void);

/* The same function under another name. */
#define fit_table_get packed_table_get
#include "legacy/fit_table_packed.c"
#undef fit_table_get

static void packing_loses_nothing(void **state)
{
    (void)state;
    assert_memory_equal(fit_table_get(), packed_table_get(), sizeof(fit_table));
    assert_true(packed_table_get()->SP[1][GRAM_R * GRAM_S - 1] < 0.0f);
}

static void packing_pays(void **state)
{
    (void)state;
    assert_true(sizeof packed < sizeof(fit_table) / 3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(packing_loses_nothing),
        cmocka_unit_test(packing_pays),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
