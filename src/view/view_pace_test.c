/* view_pace_test.c - the pace of view_state.h: coarse where it helps, and sharp as soon as possible. */
#include "view/view_state.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

static void what_rests_is_sharp(void **state)
{
    (void)state;
    assert_int_equal(view_pace_divisor(&(view_pace){.full_s = 100.0}, false), 1);
    assert_int_equal(view_pace_divisor(&(view_pace){.full_s = 0.0}, true), 1);
    assert_int_equal(view_pace_divisor(&(view_pace){.full_s = 0.04}, true), 1);
}

static void slower_is_coarser(void **state)
{
    (void)state;
    assert_int_equal(view_pace_divisor(&(view_pace){.full_s = 0.1}, true), 2);
    assert_int_equal(view_pace_divisor(&(view_pace){.full_s = 0.3}, true), 4);
}

/* After a first frame of a second, in which a driver compiled, one coarse frame shows how fast it is. */
static void a_slow_first_frame_is_forgotten(void **state)
{
    (void)state;
    view_pace p = {.full_s = 0.0};
    view_pace_measure(&p, 1, 1.0);
    assert_int_equal(view_pace_divisor(&p, true), 4);
    view_pace_measure(&p, 4, 0.001);
    assert_int_equal(view_pace_divisor(&p, true), 1);
    view_pace_measure(&p, 1, 0.02);
    view_pace_measure(&p, 1, 0.4); /* a change of the light, for example */
    assert_int_equal(view_pace_divisor(&p, true), 4);
    view_pace_measure(&p, 4, 0.05); /* limited by its vertices, not its pixels */
    assert_int_equal(view_pace_divisor(&p, true), 4);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(what_rests_is_sharp),
                                       cmocka_unit_test(slower_is_coarser),
                                       cmocka_unit_test(a_slow_first_frame_is_forgotten)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
