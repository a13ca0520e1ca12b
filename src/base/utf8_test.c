/* utf8_test.c - valid UTF-8 sequences and invalid lookalikes. */
#include "base/utf8.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

/* RFC 3629, section 4: the first and the last of each range, and their neighbors outside. */
static void lengths_are_those_of_the_standard(void **state)
{
    (void)state;
    static const struct {
        const char *bytes;
        size_t length;
    } cases[] = {{"a", 1},
                 {"\x7f", 1},
                 {"\x80", 0},
                 {"\xc1\xbf", 0},
                 {"\xc2\x80", 2},
                 {"\xdf\xbf", 2},
                 {"\xdf\x3f", 0},
                 {"\xe0\x9f\xbf", 0},
                 {"\xe0\xa0\x80", 3},
                 {"\xed\x9f\xbf", 3},
                 {"\xed\xa0\x80", 0},
                 {"\xef\xbf\xbf", 3},
                 {"\xf0\x8f\xbf\xbf", 0},
                 {"\xf0\x90\x80\x80", 4},
                 {"\xf4\x8f\xbf\xbf", 4},
                 {"\xf4\x90\x80\x80", 0},
                 {"\xf5\x80\x80\x80", 0},
                 {"\xe9", 0},
                 {"\xe4\xb8", 0}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        size_t size = strlen(cases[i].bytes);
        assert_int_equal(utf8_length(cases[i].bytes, SIZE_MAX), cases[i].length);
        assert_int_equal(utf8_length(cases[i].bytes, size), cases[i].length);
        assert_int_equal(utf8_length(cases[i].bytes, size - 1), 0);
        assert_true(utf8_is_valid(cases[i].bytes, size) == (cases[i].length > 0));
    }
    assert_true(utf8_is_valid("", 0));
}

static void invalid_bytes_are_read_as_latin1(void **state)
{
    (void)state;
    const char text[] = "caf\xe9 \xc3\xa9\xff";
    char out[2 * sizeof text];
    size_t length = utf8_from_latin1(text, sizeof text - 1, out);
    assert_int_equal(length, 10);
    assert_memory_equal(out, "caf\xc3\xa9 \xc3\xa9\xc3\xbf", length);
    assert_true(utf8_is_valid(out, length));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lengths_are_those_of_the_standard),
        cmocka_unit_test(invalid_bytes_are_read_as_latin1),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
