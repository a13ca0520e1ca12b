/* chart_trace_test.c - lines are clipped to a box. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "plot/chart_trace.h"
#include "tests/support/support.h"

static const chart_box BOX = {10.0, 20.0, 100.0, 50.0};

static bool is_inside(double x, double y, double slack)
{
    return x >= BOX.x - slack && x <= BOX.x + BOX.width + slack && y >= BOX.y - slack &&
           y <= BOX.y + BOX.height + slack;
}

/* Compared with 1000 points of the line: the same part is inside. */
static void clipping_keeps_the_inside(void **state)
{
    (void)state;
    uint64_t random = 3;
    for (int i = 0; i < 5000; i++) {
        double x[2], y[2];
        for (int k = 0; k < 2; k++) {
            x[k] = lcg64_double(&random) * 200.0 - 40.0;
            y[k] = i % 7 == 0 && k == 1 ? y[0] : lcg64_double(&random) * 150.0 - 30.0;
        }
        if (i % 11 == 0)
            x[1] = x[0];
        double cx[2] = {x[0], x[1]}, cy[2] = {y[0], y[1]};
        const bool is_kept = trace_clip(&BOX, cx, cy);
        int inside = 0;
        for (int s = 0; s <= 1000; s++)
            inside += is_inside(x[0] + s * 1e-3 * (x[1] - x[0]), y[0] + s * 1e-3 * (y[1] - y[0]), 0.0);
        const double length = hypot(x[1] - x[0], y[1] - y[0]);
        const double kept = is_kept ? hypot(cx[1] - cx[0], cy[1] - cy[0]) : 0.0;
        assert_true(fabs(kept - length * inside / 1001.0) <= 2e-3 * length);
        if (!is_kept)
            continue;
        for (int k = 0; k < 2; k++) { /* inside, and on the line */
            assert_true(is_inside(cx[k], cy[k], 1e-9));
            assert_true(fabs((cx[k] - x[0]) * (y[1] - y[0]) - (cy[k] - y[0]) * (x[1] - x[0])) <
                        1e-8 * (1.0 + length));
        }
        if (is_inside(x[0], y[0], 0.0)) /* bit-equal: points inside stay */
            assert_true(cx[0] == x[0] && cy[0] == y[0]);
    }
}

static void lengths_add_up(void **state)
{
    (void)state;
    static double x[6] = {0.0, 60.0, (double)NAN, 60.0, 60.0, 1e6},
                  y[6] = {45.0, 45.0, 45.0, 0.0, 1000.0, 1e6};
    const chart_curve curve = {.name = "", .count = 6};
    trace t = {.curve = &curve, .count = 6, .x = x, .y = y};
    const trace_list list = {.count = 1, .traces = &t};
    /* 50 of the first, 50 of the third; the point before the gap counts 1 */
    assert_true(fabs(trace_list_length_inside(&list, &BOX) - 101.0) < 1e-9);
    const chart_box elsewhere = {-50.0, -50.0, 10.0, 10.0};
    assert_true(trace_list_length_inside(&list, &elsewhere) == 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(clipping_keeps_the_inside),
        cmocka_unit_test(lengths_add_up),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
