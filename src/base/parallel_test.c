/* Tests of parallel.h: every item once, for any number of threads, nested too. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "base/parallel.h"

enum { COUNT = 10007 };

static void count_visits(void *context, size_t begin, size_t end)
{
    unsigned char *visits = context;
    for (size_t i = begin; i < end; i++)
        visits[i]++;
}

static void each_item_is_visited_once(void **state)
{
    (void)state;
    static unsigned char visits[COUNT];
    for (uint32_t threads = 0; threads <= 9; threads += 3)
        for (size_t grain = 0; grain < 5000; grain = grain * 3 + 1) {
            memset(visits, 0, sizeof visits);
            parallel_for(threads, COUNT, grain, count_visits, visits);
            for (size_t i = 0; i < COUNT; i++)
                assert_int_equal(visits[i], 1);
        }
    parallel_for(4, 0, 1, count_visits, NULL);
}

static void run_inner(void *context, size_t begin, size_t end)
{
    for (size_t i = begin; i < end; i++)
        parallel_for(3, 100, 7, count_visits, (unsigned char *)context + 100 * i);
}

static void loops_nest(void **state)
{
    (void)state;
    unsigned char visits[1000] = {0};
    parallel_for(4, 10, 1, run_inner, visits);
    for (size_t i = 0; i < sizeof visits; i++)
        assert_int_equal(visits[i], 1);
}

static void the_default_thread_count_is_positive(void **state)
{
    (void)state;
    assert_in_range(facet_thread_count(), 1, 256);
}

static void threads_that_can_be_started_are_counted(void **state)
{
    (void)state;
    assert_int_equal(parallel_startable(0), 0);
    assert_in_range(parallel_startable(3), 1, 3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(threads_that_can_be_started_are_counted),
        cmocka_unit_test(each_item_is_visited_once),
        cmocka_unit_test(loops_nest),
        cmocka_unit_test(the_default_thread_count_is_positive),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
