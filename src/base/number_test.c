#include "base/number.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/hash.h"

/* Reads text, which may be followed by anything, and returns the length of the number; -1: none. */
static long read_text(const char *text, float *value)
{
    char padded[1024] = {0};
    assert_true(strlen(text) + NUMBER_TAIL + 1 < sizeof padded);
    memcpy(padded, text, strlen(text));
    const char *end = number_read_float(padded, value);
    return end ? end - padded : -1;
}

/* Against strtof() of the C library, which rounds correctly in the locale "C" that tests run in. */
static void assert_as_strtof(const char *text)
{
    float actual = -7.0f;
    char *end;
    float expected = strtof(text, &end);
    long length = read_text(text, &actual);
    if (length != end - text || memcmp(&actual, &expected, sizeof actual) != 0)
        fail_msg("\"%s\": read %a of %ld characters, not %a of %ld", text, (double)actual, length,
                 (double)expected, (long)(end - text));
}

static uint64_t next_random(uint64_t *state)
{
    return mix64(*state += MIX64_STEP);
}

/* Within a unit of the last place of the C library's result. */
static void check_double(const char *text)
{
    char room[128] = {0};
    double actual = 7.0;
    assert_true(strlen(text) + NUMBER_TAIL < sizeof room);
    strcpy(room, text);
    strcat(room, "\n");
    char *end;
    double expected = strtod(text, &end);
    assert_ptr_equal(number_read_double(room, &actual), room + (end - text));
    if (!(fabs(actual - expected) <= 2.3e-16 * fabs(expected)))
        fail_msg("\"%s\": read %.17g, not %.17g", text, actual, expected);
}

static void doubles_are_nearest(void **state)
{
    (void)state;
    const char *texts[] = {"0",
                           "-0.0",
                           "1000000.0625",
                           "-4526331.337",
                           "100000000.125",
                           "1e8",
                           "1.25e-3",
                           ".5",
                           "5.",
                           "-00012345678.9012345678901234567890",
                           "123456789012345678901234567890",
                           "0.000000000000000000000000000012345",
                           "4526331.33700000000000000001e0",
                           "1e+30",
                           "1E-30"};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++)
        check_double(texts[i]);
    uint64_t random = 1;
    for (int i = 0; i < 100000; i++) {
        char text[64];
        double value = (double)(int64_t)next_random(&random) * 0x1p-63 * pow(10.0, (double)(i % 12));
        snprintf(text, sizeof text, i % 3 ? "%.9f" : "%.16e", value);
        check_double(text);
    }
    double value = 7.0;
    assert_null(number_read_double("x\n       ", &value));
    assert_true(value == 7.0);
    assert_non_null(number_read_double("-inf\n       ", &value));
    assert_true(value == -HUGE_VAL);
}

static void floats_are_those_of_strtof(void **state)
{
    (void)state;
    const char *forms[] = {"0",
                           "-0",
                           "1",
                           "+1",
                           ".5",
                           "5.",
                           "-.5",
                           "1e3",
                           "1E3",
                           "1e+3",
                           "1e-3",
                           "1.5e2x",
                           "1e",
                           "1e+",
                           "12345678",
                           "123456789",
                           "0.1",
                           "00012",
                           "1..2",
                           "1.2.3",
                           "3.1+e2",
                           "1 2",
                           "-1e-45",
                           "1e-46",
                           "7e-46",
                           "3.4028235e38",
                           "3.4028236e38",
                           "1e39",
                           "1e400",
                           "1e-400",
                           "1e99999999999999999999",
                           "1e-99999999999999999999",
                           "16777217",
                           "16777219",
                           "0.000000000000000000000000000000000000000000000000000000000001e60"};
    for (size_t i = 0; i < sizeof forms / sizeof *forms; i++)
        assert_as_strtof(forms[i]);
}

static void text_without_a_number_is_refused(void **state)
{
    (void)state;
    const char *forms[] = {"", "-", "+", ".", "-.", "e5", ".e5", "x", "--1", "+-1", " 1", "/", "no"};
    for (size_t i = 0; i < sizeof forms / sizeof *forms; i++) {
        float value = 3.0f;
        assert_int_equal(read_text(forms[i], &value), -1);
        assert_true(value == 3.0f);
    }
}

static void nan_and_infinity_are_read(void **state)
{
    (void)state;
    float value;
    assert_int_equal(read_text("nan ", &value), 3);
    assert_true(isnan(value));
    assert_int_equal(read_text("-NaN(ind)", &value), 9);
    assert_true(isnan(value));
    assert_int_equal(read_text("-Inf", &value), 4);
    assert_true(isinf(value) && value < 0.0f);
    assert_int_equal(read_text("infinity", &value), 8);
    assert_true(isinf(value));
    assert_int_equal(read_text("1.#QNAN0", &value), 8);
    assert_true(isnan(value));
    assert_int_equal(read_text("-1.#INF ", &value), 7);
    assert_true(isinf(value) && value < 0.0f);
    assert_int_equal(read_text("1.5d2", &value), 5);
    assert_true(value == 150.0f);
    assert_int_equal(read_text("1D-1", &value), 4);
    assert_true(value == 0.1f);
}

/* Numbers as programs print them. */
static void random_decimals_are_nearest(void **state)
{
    (void)state;
    uint64_t random = 1;
    char text[64];
    for (int i = 0; i < 300000; i++) {
        double whole = (double)(next_random(&random) >> 11) * 0x1p-53;
        double scale = pow(10.0, (double)(next_random(&random) % 12) - 6.0);
        snprintf(text, sizeof text, "%.*f", (int)(next_random(&random) % 20), (whole - 0.5) * scale);
        assert_as_strtof(text);
        snprintf(text, sizeof text, "%.*g", 1 + (int)(next_random(&random) % 20), (whole - 0.5) * scale);
        assert_as_strtof(text);
    }
}

/* Floats of all sizes, and their midpoints, exact and off by one in the last digit. */
static void floats_of_all_magnitudes_and_midpoints_are_nearest(void **state)
{
    (void)state;
    uint64_t random = 2;
    char text[400];
    for (int i = 0; i < 60000; i++) {
        uint32_t bits = (uint32_t)next_random(&random) & 0x7fffffffu;
        if (i % 8 == 0)
            bits &= 0x7fffffu; /* not normal */
        bits = bits >= 0x7f800000u ? bits - 0x7f800000u : bits;
        float value;
        memcpy(&value, &bits, sizeof value);
        snprintf(text, sizeof text, "%.9g", (double)value);
        assert_as_strtof(text);
        float above = nextafterf(value, INFINITY);
        double middle = 0.5 * ((double)value + (isinf(above) ? 0x1p128 : (double)above));
        int length = snprintf(text, sizeof text, "%.180f", middle);
        assert_as_strtof(text);
        assert_true(length > 0);
        strcpy(text + length, "000000000000000000001");
        assert_as_strtof(text);
        text[length] = 0;
        for (char *p = text + length - 1; p > text;
             p--) { /* a little less: decrements the last nonzero digit */
            if (*p > '0' && *p <= '9') {
                *p = (char)(*p - 1);
                break;
            }
        }
        assert_as_strtof(text);
        snprintf(text, sizeof text, "%.120e", middle);
        assert_as_strtof(text);
    }
}

static void leading_digits_are_counted(void **state)
{
    (void)state;
    const char text[] = "1234567890/x12:;0\0\0\0\0\0\0\0\0";
    uint32_t value;
    assert_int_equal(number_read_digits(text, &value), 8);
    assert_int_equal(value, 12345678);
    assert_int_equal(number_read_digits(text + 8, &value), 2);
    assert_int_equal(value, 90);
    assert_int_equal(number_read_digits(text + 10, &value), 0);
    assert_int_equal(value, 0);
    assert_int_equal(number_read_digits(text + 12, &value), 2);
    assert_int_equal(value, 12);
    for (int c = 0; c < 256; c++) { /* no other byte is a digit, with any bytes behind it */
        char bytes[8];
        memset(bytes, c, sizeof bytes);
        bytes[0] = '7';
        unsigned expected = c >= '0' && c <= '9' ? 8 : 1;
        assert_int_equal(number_read_digits(bytes, &value), expected);
    }
}

/* The first numbers of splitmix64 from the seed 1234567 by Vigna's splitmix64.c. */
static void mix64_is_splitmix64(void **state)
{
    (void)state;
    static const uint64_t expected[] = {6457827717110365317u, 3203168211198807973u, 9817491932198370423u,
                                        4593380528125082431u, 16408922859458223821u};
    uint64_t random = 1234567;
    for (size_t i = 0; i < sizeof expected / sizeof *expected; i++)
        assert_true(next_random(&random) == expected[i]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(floats_are_those_of_strtof),
        cmocka_unit_test(doubles_are_nearest),
        cmocka_unit_test(text_without_a_number_is_refused),
        cmocka_unit_test(nan_and_infinity_are_read),
        cmocka_unit_test(random_decimals_are_nearest),
        cmocka_unit_test(floats_of_all_magnitudes_and_midpoints_are_nearest),
        cmocka_unit_test(leading_digits_are_counted),
        cmocka_unit_test(mix64_is_splitmix64),
    };
    return cmocka_run_group_tests_name("number", tests, NULL, NULL);
}
