/* chart_ticks_test.c - ticks increase, lie in their range, are round, and have the requested density. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "plot/chart_ticks.h"
#include "tests/support/support.h"

static void expect_order(const ticks *t, double minimum, double maximum, bool is_fixed)
{
    if (is_fixed) {
        assert_true(t->minimum == minimum && t->maximum == maximum);
    } else {
        assert_true(t->minimum <= minimum && t->maximum >= maximum);
    }
    for (int i = 0; i < t->count; i++) {
        assert_true(t->values[i] >= t->minimum && t->values[i] <= t->maximum);
        assert_true(i == 0 || t->values[i] > t->values[i - 1]);
        assert_true(*t->labels[i].text != 0);
        assert_true(i == 0 || strcmp(t->labels[i].text, t->labels[i - 1].text) != 0 ||
                    strcmp(t->labels[i].exponent, t->labels[i - 1].exponent) != 0);
    }
    for (int i = 0; i < t->minor_count; i++)
        assert_true(t->minor[i] >= t->minimum && t->minor[i] <= t->maximum);
}

/* The label with its power of ten equals the tick. */
static void expect_labels_are_values(const ticks *t)
{
    for (int i = 0; i < t->count; i++) {
        char plain[2 * NUMBER_SIZE] = "";
        for (const char *p = t->labels[i].text; *p; p++)
            if (strncmp(p, "\xe2\x88\x92", 3) == 0) {
                strcat(plain, "-");
                p += 2;
            } else if ((unsigned char)*p < 0x80) {
                strncat(plain, p, 1);
            }
        const double shown = strtod(plain, NULL) * pow(10.0, t->power);
        const double size = fmax(fabs(t->values[0]), fabs(t->values[t->count - 1]));
        assert_true(fabs(shown - t->values[i]) <= 1e-9 * size);
    }
}

/* Steps are 1, 2, 2.5, 3 or 5 times a power of ten, and ticks are multiples of them. */
static void expect_round(const ticks *t)
{
    const double step = (t->values[t->count - 1] - t->values[0]) / (t->count - 1);
    const double digit = step / pow(10.0, floor(log10(step) + 1e-6));
    static const double DIGITS[] = {1.0, 2.0, 2.5, 3.0, 5.0};
    bool is_round = false;
    for (int i = 0; i < 5; i++)
        is_round = is_round || fabs(digit - DIGITS[i]) < 1e-5;
    assert_true(is_round);
    for (int i = 0; i < t->count; i++)
        assert_true(fabs(t->values[i] / step - rint(t->values[i] / step)) < 1e-5);
}

static void linear_ticks_have_their_properties(void **state)
{
    (void)state;
    uint64_t random = 1;
    for (int i = 0; i < 20000; i++) {
        const double size = pow(10.0, floor(lcg64_double(&random) * 560.0 - 280.0));
        const double a = (lcg64_double(&random) * 2.0 - 1.0) * size;
        const double width = size * pow(10.0, -4.0 * lcg64_double(&random));
        ticks_desc d = {.minimum = a,
                        .maximum = a + width,
                        .is_fixed = i % 2 == 0,
                        .target = 3 + (int)(7.0 * lcg64_double(&random))};
        ticks t;
        ticks_create(&d, &t);
        assert_in_range(t.count, 2, d.is_fixed ? d.target + 1 : 2 * d.target);
        expect_order(&t, d.minimum, d.maximum, d.is_fixed);
        expect_labels_are_values(&t);
        expect_round(&t);
        if (!d.is_fixed) { /* the range ends on ticks, and is not mostly empty */
            assert_true(t.minimum == t.values[0] && t.maximum == t.values[t.count - 1]);
            assert_true(t.maximum - t.minimum < 3.0 * width);
        }
    }
}

/* Hand-picked ticks. */
static void known_ranges_have_known_ticks(void **state)
{
    (void)state;
    const struct {
        double minimum, maximum;
        bool is_degrees;
        int target;
        const char *labels;
    } cases[] = {
        {0.0, 1.0, false, 6, "0.0 0.2 0.4 0.6 0.8 1.0"},
        {0.0, 100.0, false, 6, "0 20 40 60 80 100"},
        {-1.0, 1.0, false, 5,
         "\xe2\x88\x92"
         "1.0 \xe2\x88\x92"
         "0.5 0.0 0.5 1.0"},
        {0.0, 90.0, true, 7, "0\xc2\xb0 15\xc2\xb0 30\xc2\xb0 45\xc2\xb0 60\xc2\xb0 75\xc2\xb0 90\xc2\xb0"},
        {0.0, 90.0, true, 4, "0\xc2\xb0 30\xc2\xb0 60\xc2\xb0 90\xc2\xb0"},
        {0.0, 360.0, true, 5, "0\xc2\xb0 90\xc2\xb0 180\xc2\xb0 270\xc2\xb0 360\xc2\xb0"},
        {0.0, 1e6, false, 6, "0.0 0.2 0.4 0.6 0.8 1.0"},
        {0.0, 2e-6, false, 5, "0.0 0.5 1.0 1.5 2.0"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        ticks t;
        ticks_create(&(ticks_desc){.minimum = cases[i].minimum,
                                   .maximum = cases[i].maximum,
                                   .is_fixed = true,
                                   .is_degrees = cases[i].is_degrees,
                                   .target = cases[i].target},
                     &t);
        char labels[512] = "";
        for (int k = 0; k < t.count; k++) {
            strcat(labels, k ? " " : "");
            strcat(labels, t.labels[k].text);
        }
        assert_string_equal(labels, cases[i].labels);
    }
}

/* 0.3 is the double nearest to 0.3, not 3 times that of 0.1. */
static void ticks_are_the_nearest_doubles(void **state)
{
    (void)state;
    ticks t;
    ticks_create(&(ticks_desc){.minimum = 0.0, .maximum = 1.0, .is_fixed = true, .target = 10}, &t);
    assert_int_equal(t.count, 11);
    static const double EXPECTED[] = {0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0};
    assert_memory_equal(t.values, EXPECTED, sizeof EXPECTED);
}

static void logarithmic_ticks_have_their_properties(void **state)
{
    (void)state;
    uint64_t random = 7;
    for (int i = 0; i < 20000; i++) {
        const double low = lcg64_double(&random) * 500.0 - 280.0;
        const double decades = pow(10.0, lcg64_double(&random) * 3.2 - 1.0);
        ticks_desc d = {.scale = CHART_LOG10,
                        .minimum = pow(10.0, low),
                        .maximum = pow(10.0, fmin(low + decades, 295.0)),
                        .is_fixed = i % 2 == 0,
                        .target = 3 + (int)(7.0 * lcg64_double(&random))};
        ticks t;
        ticks_create(&d, &t);
        expect_order(&t, d.minimum, d.maximum, d.is_fixed);
        assert_in_range(t.count, d.is_fixed ? 0 : 1, TICKS_MAX);
        for (int k = 0; k < t.count && decades > 3.0; k++) { /* powers of ten */
            const double exponent = log10(t.values[k]);
            assert_true(fabs(exponent - rint(exponent)) < 1e-9);
        }
        if (decades > 3.0)
            assert_true(t.count <= d.target);
    }
}

static void decades_are_labeled_by_powers(void **state)
{
    (void)state;
    ticks t;
    ticks_create(
        &(ticks_desc){.scale = CHART_LOG10, .minimum = 1e-6, .maximum = 1e2, .is_fixed = true, .target = 9},
        &t);
    assert_int_equal(t.count, 9);
    assert_string_equal(t.labels[0].text, "10");
    assert_string_equal(t.labels[0].exponent, "\xe2\x88\x92"
                                              "6");
    assert_string_equal(t.labels[8].exponent, "2");
    assert_int_equal(t.minor_count, 8 * 8); /* 2 to 9 of each decade */
    ticks_create(
        &(ticks_desc){.scale = CHART_LOG10, .minimum = 1e-2, .maximum = 1e2, .is_fixed = true, .target = 6},
        &t);
    assert_int_equal(t.count, 5);
    assert_string_equal(t.labels[0].text, "0.01");
    assert_string_equal(t.labels[4].text, "100");
    assert_string_equal(t.labels[4].exponent, "");
}

static void ranges_are_never_empty(void **state)
{
    (void)state;
    const double specials[] = {0.0,    -0.0,   1.0,    -1.0,       1e-320,     -1e-320,
                               1e-300, 1e300,  -1e300, 1.7e308,    -1.7e308,   0.35,
                               -0.35,  1e-290, 1e15,   1e15 + 1.0, 1.0 + 1e-13};
    const size_t count = sizeof specials / sizeof *specials;
    for (size_t i = 0; i < count; i++)
        for (size_t k = 0; k < count; k++)
            for (int scale = 0; scale < 2; scale++) {
                double low = specials[i], high = specials[k];
                ticks_range((chart_scale)scale, &low, &high);
                assert_true(low < high && isfinite(high - low));
                assert_true(scale == 0 || low > 0.0);
                ticks t;
                ticks_create(
                    &(ticks_desc){.scale = (chart_scale)scale, .minimum = low, .maximum = high, .target = 6},
                    &t);
                assert_true(t.count >= 1);
                expect_order(&t, low, high, false);
            }
    /* ranges include 0 unless the values are far from it */
    double low = 0.2, high = 1.0;
    ticks_range(CHART_LINEAR, &low, &high);
    assert_true(low == 0.0 && high == 1.0);
    low = 0.9;
    ticks_range(CHART_LINEAR, &low, &high);
    assert_true(low == 0.9);
    low = 1.0;
    high = -1.0; /* no values */
    ticks_range(CHART_LINEAR, &low, &high);
    assert_true(low == 0.0 && high == 1.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(linear_ticks_have_their_properties),
        cmocka_unit_test(known_ranges_have_known_ticks),
        cmocka_unit_test(ticks_are_the_nearest_doubles),
        cmocka_unit_test(logarithmic_ticks_have_their_properties),
        cmocka_unit_test(decades_are_labeled_by_powers),
        cmocka_unit_test(ranges_are_never_empty),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
