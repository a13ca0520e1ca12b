/* chart_number_test.c - the shortest decimals that read back, and labels. */
#include <float.h>
#include <locale.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "plot/chart_ticks.h"

static void expect_shortest(double value, const char *expected)
{
    char digits[NUMBER_SIZE];
    number_shortest(value, digits);
    assert_string_equal(digits, expected);
}

/* Expected values from Python's repr() and Steele and White 1990. */
static void known_numbers_are_shortest(void **state)
{
    (void)state;
    expect_shortest(0.0, "0");
    expect_shortest(-0.0, "-0");
    expect_shortest(0.1, "0.1");
    expect_shortest(-1.5, "-1.5");
    expect_shortest(1.0 / 3.0, "0.3333333333333333");
    expect_shortest(0.1 + 0.2, "0.30000000000000004");
    expect_shortest(3.141592653589793, "3.141592653589793");
    expect_shortest(1e23, "1e+23");
    expect_shortest(9007199254740993.0, "9007199254740992");
    expect_shortest(DBL_MAX, "1.7976931348623157e+308");
    expect_shortest(DBL_MIN, "2.2250738585072014e-308");
    expect_shortest(4.9406564584124654e-324, "5e-324");
    expect_shortest((double)NAN, "");
    expect_shortest(HUGE_VAL, "inf");
    expect_shortest(-HUGE_VAL, "-inf");
    /* powers of two, where the nearest of 16 digits does not read back but its neighbor does */
    expect_shortest(ldexp(1.0, -44), "5.684341886080802e-14");
    expect_shortest(ldexp(1.0, -1017), "7.120236347223045e-307");
}

static size_t significant_digits(const char *text)
{
    size_t count = 0, zeros = 0;
    for (; *text && *text != 'e'; text++) {
        if (*text < '0' || *text > '9')
            continue;
        if (*text == '0') {
            zeros += count > 0;
            continue;
        }
        count += zeros + 1;
        zeros = 0;
    }
    return count;
}

/* For random bits: the text reads back, and no decimal of fewer digits does. */
static void random_numbers_read_back(void **state)
{
    (void)state;
    uint64_t bits = 88172645463325252u;
    for (int i = 0; i < 200000; i++) {
        bits ^= bits << 13;
        bits ^= bits >> 7;
        bits ^= bits << 17;
        double value;
        memcpy(&value, &bits, sizeof value);
        if (!isfinite(value))
            continue;
        char digits[NUMBER_SIZE], shorter[64];
        number_shortest(value, digits);
        assert_true(strtod(digits, NULL) == value);
        const size_t count = significant_digits(digits);
        if (count > 1) {
            snprintf(shorter, sizeof shorter, "%.*e", (int)count - 2, value);
            assert_true(strtod(shorter, NULL) != value);
        }
    }
}

static void numbers_do_not_depend_on_the_locale(void **state)
{
    (void)state;
    static const char *const NAMES[] = {"de_DE.UTF-8", "fr_FR.UTF-8", "de_DE", "ar_EG.UTF-8"};
    const char *set = NULL;
    for (int i = 0; i < 4 && !set; i++)
        set = setlocale(LC_NUMERIC, NAMES[i]);
    if (!set || strcmp(localeconv()->decimal_point, ".") == 0) {
        setlocale(LC_NUMERIC, "C");
        print_message("no locale with another decimal point is installed\n");
        skip();
    }
    char label[NUMBER_SIZE];
    expect_shortest(0.5, "0.5");
    expect_shortest(-1.25e-10, "-1.25e-10");
    number_label(0.25, 2, label);
    assert_string_equal(label, "0.25");
    setlocale(LC_NUMERIC, "C");
}

static void labels_have_a_minus_sign_and_no_negative_zero(void **state)
{
    (void)state;
    const struct {
        double value;
        int decimals;
        const char *expected;
    } cases[] = {{0.0, 0, "0"},
                 {-0.0, 1, "0.0"},
                 {-0.001, 2, "0.00"},
                 {-0.5, 1,
                  "\xe2\x88\x92"
                  "0.5"},
                 {1.0, 2, "1.00"},
                 {-30.0, 0,
                  "\xe2\x88\x92"
                  "30"},
                 {1e300, 2, "1e+300"},
                 {1e-5, 5, "0.00001"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char label[NUMBER_SIZE];
        number_label(cases[i].value, cases[i].decimals, label);
        assert_string_equal(label, cases[i].expected);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(known_numbers_are_shortest),
        cmocka_unit_test(random_numbers_read_back),
        cmocka_unit_test(numbers_do_not_depend_on_the_locale),
        cmocka_unit_test(labels_have_a_minus_sign_and_no_negative_zero),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
