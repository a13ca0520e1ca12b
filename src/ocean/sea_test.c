/* Tests of sea.h: a sea is made whole or not at all. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "tests/support/support.h"
#include "ocean/sea.h"

static void presets_can_be_made(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < sea_preset_count(); i++) {
        facet_sea_desc d;
        facet_sea *sea;
        assert_int_equal(sea_preset(sea_preset_name(i), &d, NULL), FACET_OK);
        d.resolution = 32;
        assert_int_equal(sea_create(&d, &sea, NULL), FACET_OK);
        assert_true(sea->waves.tile_count >= 3);
        assert_true(sea->foam.coverage < 0.11f);
        assert_true(sea->slopes.total.xx > 0.0f);
        sea_destroy(sea);
    }
}

static void wrong_numbers_make_none(void **state)
{
    (void)state;
    facet_sea_desc d = sea_default();
    facet_sea *sea = (facet_sea *)&d;
    facet_error error;
    d.wind_mps = 50.0f;
    assert_int_equal(sea_create(&d, &sea, &error), FACET_ERROR_ARGUMENT);
    assert_null(sea);
    assert_non_null(strstr(error.message, "wind"));
    sea_destroy(NULL);
}

static void running_out_of_memory_leaks_nothing(void **state)
{
    (void)state;
    facet_sea_desc d = sea_default();
    d.resolution = 32;
    d.cascade_count = 1;
    for (long fail_at = 0;; fail_at++) {
        failing_allocator f = {.fail_at = fail_at};
        d.allocator = failing_allocator_get(&f);
        facet_sea *sea;
        facet_result result = sea_create(&d, &sea, NULL);
        sea_destroy(sea);
        assert_int_equal(atomic_load(&f.blocks), 0);
        if (result == FACET_OK)
            break;
        assert_null(sea);
        assert_int_equal(result, FACET_ERROR_MEMORY);
        assert_in_range(fail_at, 0, 200);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(presets_can_be_made),
                                       cmocka_unit_test(wrong_numbers_make_none),
                                       cmocka_unit_test(running_out_of_memory_leaks_nothing)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
