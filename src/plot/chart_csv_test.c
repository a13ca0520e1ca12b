/* chart_csv_test.c - charts as CSV, byte for byte. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "tests/support/support.h"
#include "plot/chart.h"

static void expect_csv(const chart *c, const char *expected)
{
    unsigned char *bytes;
    size_t size;
    facet_error error;
    assert_int_equal(chart_write_csv(c, NULL, &bytes, &size, &error), FACET_OK);
    assert_int_equal(size, strlen((const char *)bytes));
    assert_string_equal((const char *)bytes, expected);
    mem_free(bytes);
}

static const double X[3] = {0.0, 0.5, 1.0}, Y[3] = {0.1, (double)NAN, 1.0 / 3.0}, Z[3] = {1e-5, 2.0, -3.0};
static const double X_EQUAL[3] = {0.0, 0.5, 1.0}, X_OTHER[2] = {7.0, 8.0};

static void curves_share_an_equal_x(void **state)
{
    (void)state;
    const chart_curve curves[] = {{.name = "PBR", .count = 3, .x = X, .y = Y},
                                  {.name = "measured", .count = 2, .x = X_OTHER, .y = Z},
                                  {.name = "", .count = 3, .x = X_EQUAL, .y = Z}};
    const chart_panel panel = {.title = "slice",
                               .x = {.label = "angle, degrees"},
                               .y = {.label = "BRDF"},
                               .curve_count = 3,
                               .curves = curves};
    expect_csv(&(chart){.panel_count = 1, .panels = &panel},
               "# slice\n"
               "\"angle, degrees\",PBR: BRDF,BRDF,\"angle, degrees\",measured: BRDF\n"
               "0,0.1,1e-05,7,1e-05\n"
               "0.5,,2,8,2\n"
               "1,0.3333333333333333,-3,,\n");
}

static void fields_are_quoted_as_rfc_4180_has_it(void **state)
{
    (void)state;
    const chart_curve curves[] = {{.name = "say \"a\", b", .count = 1, .x = X, .y = Z},
                                  {.name = "two\nlines", .count = 1, .x = X, .y = Z},
                                  {.name = "# no comment", .count = 1, .x = X, .y = Z}};
    const chart_panel panel = {.title = "a\r\n1,2", .note = "E = 0.04", .curve_count = 3, .curves = curves};
    expect_csv(&(chart){.panel_count = 1, .panels = &panel},
               "# a  1,2\n# E = 0.04\n"
               "x,\"say \"\"a\"\", b\",\"two\nlines\",\"# no comment\"\n"
               "0,1e-05,1e-05,1e-05\n");
}

static void grids_are_rows_of_x_y_value(void **state)
{
    (void)state;
    static const double VALUES[4] = {1.0, 2.0, (double)NAN, 4.0}, ONES[4] = {1.0, 1.0, 1.0, 1.0};
    const chart_field field = {.width = 2,
                               .height = 2,
                               .values = VALUES,
                               .x0 = 0.0,
                               .x1 = 1.0,
                               .y0 = 0.0,
                               .y1 = 2.0,
                               .label = "scale"};
    const chart_surface surface = {
        .width = 2, .height = 2, .x = ONES, .y = ONES, .z = VALUES, .values = ONES};
    const chart_panel panels[2] = {
        {.kind = CHART_FIELD, .x = {.label = "N.V"}, .y = {.label = "roughness"}, .field = &field},
        {.kind = CHART_SURFACE, .title = "lobe", .surface = &surface}};
    expect_csv(&(chart){.title = "unused", .panel_count = 2, .panels = panels},
               "# panel 1\nN.V,roughness,scale\n"
               "0.25,1.5,1\n0.75,1.5,2\n"
               "0.25,0.5,\n0.75,0.5,4\n"
               "\n# lobe\nx,y,z,value\n"
               "1,1,1,1\n1,1,2,1\n1,1,,1\n1,1,4,1\n");
}

static void a_lone_panel_has_the_title_of_the_chart(void **state)
{
    (void)state;
    const chart_curve curve = {.name = "", .count = 1, .x = X, .y = Z};
    const chart_panel panel = {.kind = CHART_POLAR, .curve_count = 1, .curves = &curve};
    expect_csv(&(chart){.title = "lobes", .panel_count = 1, .panels = &panel},
               "# lobes\n\"angle, rad\",y\n0,1e-05\n");
    expect_csv(&(chart){.title = "nothing"}, "");
    const chart_panel empty = {.kind = CHART_XY};
    expect_csv(&(chart){.panel_count = 1, .panels = &empty}, "# panel 1\n");
}

static void running_out_of_memory_leaks_nothing(void **state)
{
    (void)state;
    const chart_curve curves[] = {{.name = "a", .count = 3, .x = X, .y = Y},
                                  {.name = "b", .count = 3, .x = X, .y = Z}};
    const chart_panel panel = {.title = "t", .curve_count = 2, .curves = curves};
    const chart c = {.panel_count = 1, .panels = &panel};
    for (long i = 0;; i = next_failure(i)) {
        failing_allocator failing = {.fail_at = i};
        const facet_allocator allocator = failing_allocator_get(&failing);
        unsigned char *bytes;
        size_t size;
        facet_error error;
        const facet_result result = chart_write_csv(&c, &allocator, &bytes, &size, &error);
        mem_free(bytes);
        assert_int_equal(failing.blocks, 0);
        if (failing.calls <= i) {
            assert_int_equal(result, FACET_OK);
            assert_true(i >= 3);
            break;
        }
        assert_int_equal(result, FACET_ERROR_MEMORY);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(curves_share_an_equal_x),
        cmocka_unit_test(fields_are_quoted_as_rfc_4180_has_it),
        cmocka_unit_test(grids_are_rows_of_x_y_value),
        cmocka_unit_test(a_lone_panel_has_the_title_of_the_chart),
        cmocka_unit_test(running_out_of_memory_leaks_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
