/* view_terms_test.c - view_terms.h: values of camera attributes as <model-viewer> reads them. */
#include "view/view_terms.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

static const double degree = 3.14159265358979323846 / 180.0;

/* An orbit: 100 % are 90 degrees, 45 degrees, 2 m; automatic are 1 rad, 2 rad, 3 m. */
static facet_result read(const char *text, double out[3], facet_error *error)
{
    const view_term terms[3] = {{VIEW_UNIT_ANGLE, 90.0 * degree, 1.0},
                                {VIEW_UNIT_ANGLE, 45.0 * degree, 2.0},
                                {VIEW_UNIT_LENGTH, 2.0, 3.0}};
    return view_terms_read("camera-orbit", text, terms, 3, 0.25, out, error);
}

static void values_have_units_percent_and_arithmetic(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        double expected[3];
    } cases[] = {{"0deg 75deg 105%", {0.0, 75.0, 2.1}},
                 {"  -45deg\t1.5707963267948966rad 250cm ", {-45.0, 90.0, 2.5}},
                 {"10 20 1", {10.0, 20.0, 1.0}},
                 {"50% 200% 50mm", {45.0, 90.0, 0.05}},
                 {"calc(30deg + env(window-scroll-y) * 4deg) 75deg calc(1m - 50cm)", {31.0, 75.0, 0.5}},
                 {"calc(-1 * (10deg - 30deg) / 2) 1deg calc(50% + 1m)", {10.0, 1.0, 2.0}}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        double out[3];
        assert_int_equal(read(cases[i].text, out, NULL), FACET_OK);
        assert_true(fabs(out[0] / degree - cases[i].expected[0]) < 1e-9);
        assert_true(fabs(out[1] / degree - cases[i].expected[1]) < 1e-9);
        assert_true(fabs(out[2] - cases[i].expected[2]) < 1e-9);
    }
}

static void missing_words_and_auto_are_automatic(void **state)
{
    (void)state;
    double out[3];
    assert_int_equal(read("", out, NULL), FACET_OK);
    assert_true(out[0] == 1.0 && out[1] == 2.0 && out[2] == 3.0);
    assert_int_equal(read("auto 10deg", out, NULL), FACET_OK);
    assert_true(out[0] == 1.0 && fabs(out[1] - 10.0 * degree) < 1e-12 && out[2] == 3.0);
    assert_int_equal(read("-Infinity auto Infinity", out, NULL), FACET_OK);
    assert_true(isinf(out[0]) && isinf(out[2]));
}

static void other_text_is_refused_and_changes_nothing(void **state)
{
    (void)state;
    static const char *const texts[] = {
        "left",      "1deg 2deg 3deg", "1m 2deg 3m",      "1deg 2deg 3m 4m",   "calc(1deg",
        "1degrees",  "nan 1deg 1m",    "calc(1deg + 1)",  "calc(1deg * 2deg)", "calc(1 / 0deg)",
        "1deg,2deg", "calc()",         "0deg 75deg 105%)"};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        double out[3] = {7.0, 7.0, 7.0};
        facet_error error = {0};
        assert_int_equal(read(texts[i], out, &error), FACET_ERROR_ARGUMENT);
        assert_non_null(strstr(error.message, "camera-orbit=\""));
        assert_true(out[0] == 7.0 && out[1] == 7.0 && out[2] == 7.0);
    }
    char deep[2001];
    memset(deep, '(', sizeof deep - 1);
    deep[sizeof deep - 1] = 0;
    double out[3];
    assert_int_equal(read(deep, out, NULL), FACET_ERROR_ARGUMENT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(values_have_units_percent_and_arithmetic),
        cmocka_unit_test(missing_words_and_auto_are_automatic),
        cmocka_unit_test(other_text_is_refused_and_changes_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
