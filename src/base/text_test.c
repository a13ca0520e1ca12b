/* Tests of text.h: JSON that any reader takes back. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/base64.h"
#include "base/text.h"
#include "tests/support/support.h"

static void json_has_commas_where_they_belong(void **state)
{
    (void)state;
    text t = {0};
    text_json_begin_object(&t, NULL);
    text_json_string(&t, "name", "a");
    text_json_begin_array(&t, "list");
    text_json_integer(&t, NULL, -3);
    text_json_begin_object(&t, NULL);
    text_json_end_object(&t);
    text_json_bool(&t, NULL, true);
    text_json_end_array(&t);
    text_json_string(&t, "none", NULL);
    text_json_end_object(&t);
    assert_string_equal(t.data, "{\"name\":\"a\",\"list\":[-3,{},true],\"none\":null}");
    text_destroy(&t);
}

static void numbers_read_back(void **state)
{
    (void)state;
    text t = {0};
    text_json_begin_array(&t, NULL);
    text_json_float(&t, NULL, 0.3f);
    text_json_float(&t, NULL, 1.0f / 3.0f);
    text_json_float(&t, NULL, 0.1f);
    text_json_float(&t, NULL, 16777217.0f);
    text_json_float(&t, NULL, NAN);
    text_json_float(&t, NULL, -INFINITY);
    text_json_end_array(&t);
    assert_string_equal(t.data, "[0.3,0.33333334,0.1,16777216,null,null]");
    text_destroy(&t);
}

static void strings_are_valid_utf8(void **state)
{
    (void)state;
    text t = {0};
    text_json_string(&t, NULL, "\"\\\n\x7f\xc3\xa9\xe2\x99\xbb\xf0\x9f\x98\x80");
    assert_string_equal(t.data, "\"\\\"\\\\\\u000a\\u007f\xc3\xa9\xe2\x99\xbb\xf0\x9f\x98\x80\"");
    text_destroy(&t);
    t = (text){0};
    text_json_string(&t, NULL, "\xff-\xc0\xaf-\xed\xa0\x80-\xe2\x99"); /* bad, overlong, surrogate, cut off */
    assert_string_equal(t.data,
                        "\"\xef\xbf\xbd-\xef\xbf\xbd\xef\xbf\xbd-\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd-"
                        "\xef\xbf\xbd\xef\xbf\xbd\"");
    text_destroy(&t);
}

static void long_text_grows_and_failure_sticks(void **state)
{
    (void)state;
    text t = {0};
    for (int i = 0; i < 1000; i++)
        text_addf(&t, "%0300d", i);
    assert_int_equal(t.length, 300000);
    text_destroy(&t);

    facet_budget *budget;
    assert_int_equal(facet_budget_create(2000, &budget, NULL), FACET_OK);
    t = (text){.allocator = facet_budget_allocator(budget)};
    for (int i = 0; i < 1000; i++)
        text_add(&t, "0123456789");
    assert_true(t.has_failed);
    text_destroy(&t);
    assert_int_equal(facet_budget_used_bytes(budget), 0);
    facet_budget_destroy(budget);
}

/* text_shortest_float() by the C library alone. */
static void assert_shortest(uint32_t bits)
{
    float value;
    char expected[TEXT_FLOAT_SIZE];
    char actual[TEXT_FLOAT_SIZE];
    memcpy(&value, &bits, sizeof value);
    if (!isfinite(value))
        return;
    for (int precision = 6; precision <= 9; precision++) {
        snprintf(expected, sizeof expected, "%.*g", precision, (double)value);
        if (strtof(expected, NULL) == value)
            break;
    }
    text_shortest_float(value, actual);
    assert_string_equal(actual, expected);
}

static void shortest_floats_are_those_of_printf(void **state)
{
    (void)state;
    uint64_t random = 1;
    for (int i = 0; i < 300000; i++) { /* any bits; then sizes that models have */
        lcg64_next(&random);
        assert_shortest((uint32_t)(random >> 32));
        assert_shortest((uint32_t)(random >> 32) % 0x1a000000 + 0x2f000000);
    }
    for (uint32_t exponent = 0; exponent < 256; exponent++) /* powers of two and their neighbors */
        for (uint32_t k = 0; k < 5; k++)
            assert_shortest((exponent << 23) + k - 2);
    for (int digits = 1; digits < 100000; digits++) { /* short decimals, ties and carries among them */
        float value = (float)digits / 64.0f;
        float decimal = (float)digits / 1000.0f;
        uint32_t bits;
        memcpy(&bits, &value, sizeof bits);
        assert_shortest(bits);
        memcpy(&bits, &decimal, sizeof bits);
        assert_shortest(bits);
        assert_shortest(bits - 1);
        assert_shortest(bits + 1 + 0x80000000u);
    }
}

static void shortest_doubles_are_more_precise_than_floats(void **state)
{
    (void)state;
    static const struct {
        double value;
        const char *digits;
    } cases[] = {{0.0, "0"},
                 {0.1, "0.1"},
                 {(double)0.1f, "0.1"}, /* doubles that equal floats print as floats */
                 {-2.5, "-2.5"},
                 {1000000.0625, "1000000.0625"},
                 {1e8 + 0.001, "100000000.001"},
                 {-4526331.337, "-4526331.337"},
                 {1e30, "1e+30"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char digits[TEXT_FLOAT_SIZE];
        text_shortest_double(cases[i].value, digits);
        assert_string_equal(digits, cases[i].digits);
    }
    uint64_t random = 1;
    for (int i = 0; i < 100000; i++) {
        lcg64_next(&random);
        double value = 4096.0 + (double)(random >> 11) * 0x1p-53 * 1e9;
        char digits[TEXT_FLOAT_SIZE];
        text_shortest_double(value, digits);
        assert_true(strtod(digits, NULL) == value);
    }
}

static void places_keep_origin_and_offset(void **state)
{
    (void)state;
    static const struct {
        float value;
        double origin;
        const char *digits;
    } cases[] = {{0.1f, 0.0, "0.1"},         {0.1234567f, 1e6, "1000000.1234567"},
                 {-0.5f, 1e8, "99999999.5"}, {0.0f, -4096.0, "-4096"},
                 {100.0f, 1e6, "1000100"},   {0.25f, -1e6, "-999999.75"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char digits[TEXT_FLOAT_SIZE];
        text_shortest_place(cases[i].value, cases[i].origin, digits);
        assert_string_equal(digits, cases[i].digits);
    }
    uint64_t random = 1;
    for (int i = 0; i < 100000; i++) {
        lcg64_next(&random);
        float value = (float)((int64_t)random >> 20) * 0x1p-40f;
        double origin = (double)(1 << (10 + i % 17));
        char digits[TEXT_FLOAT_SIZE];
        text_shortest_place(value, origin, digits);
        double back = strtod(digits, NULL) - origin;
        assert_true((float)back == value ||
                    fabs(back - (double)value) < 1e-8); /* half a step of a double there */
    }
}

static void html_is_escaped(void **state)
{
    (void)state;
    text t = {0};
    text_add_html(&t, "a<b>&\"\x01\xff\xc3\xa9\xed\xa0\x80");
    assert_string_equal(
        t.data, "a&lt;b&gt;&amp;&quot;\xef\xbf\xbd\xef\xbf\xbd\xc3\xa9\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd");
    text_destroy(&t);
}

static void urls_are_escaped(void **state)
{
    (void)state;
    text t = {0};
    text_add_url(&t, "aZ/09 %?#&\"+:\xc3\xa9-._~");
    assert_string_equal(t.data, "aZ/09%20%25%3F%23%26%22%2B%3A%C3%A9-._~");
    text_destroy(&t);
}

static void base64_is_padded(void **state)
{
    (void)state;
    static const char *const cases[][2] = {
        {"", ""}, {"M", "TQ=="}, {"Ma", "TWE="}, {"Man", "TWFu"}, {"Many", "TWFueQ=="}};
    text t = {0};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        text_add(&t, ".");
        text_add_base64(&t, cases[i][0], strlen(cases[i][0]));
        assert_string_equal(t.data + 1, cases[i][1]);
        text_destroy(&t);
    }
    /* longer than the pieces that it is made of */
    static const unsigned char zeros[3000];
    text_add_base64(&t, zeros, sizeof zeros);
    assert_int_equal(t.length, 4000);
    assert_int_equal(strspn(t.data, "A"), 4000);
    text_destroy(&t);
}

static void base64_is_read_back(void **state)
{
    (void)state;
    unsigned char bytes[] = {0, 255, 16, 62, 63, 128, 1}, back[16];
    for (size_t size = 0; size <= sizeof bytes; size++) {
        text t = {0};
        text_add_base64(&t, bytes, size);
        size_t count = 99;
        assert_true(base64_decode(size ? t.data : "", t.length, back, &count));
        assert_int_equal(count, size);
        assert_memory_equal(back, bytes, size);
        text_destroy(&t);
    }
    size_t count;
    assert_true(base64_decode("-_8", 3, back, &count)); /* URL-safe, without padding */
    assert_memory_equal(back, "\xfb\xff", 2);
    assert_false(base64_decode("A", 1, back, &count));
    assert_false(base64_decode("AA*A", 4, back, &count));
    assert_false(base64_decode("AA\n=", 4, back, &count));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(json_has_commas_where_they_belong),
        cmocka_unit_test(numbers_read_back),
        cmocka_unit_test(shortest_floats_are_those_of_printf),
        cmocka_unit_test(shortest_doubles_are_more_precise_than_floats),
        cmocka_unit_test(places_keep_origin_and_offset),
        cmocka_unit_test(strings_are_valid_utf8),
        cmocka_unit_test(html_is_escaped),
        cmocka_unit_test(urls_are_escaped),
        cmocka_unit_test(base64_is_padded),
        cmocka_unit_test(base64_is_read_back),
        cmocka_unit_test(long_text_grows_and_failure_sticks),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
