/* chart_text_test.c - any bytes become lines that fit. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "plot/chart_text.h"

static canvas *page;
static const canvas_font FONT = {.size = 12.0};

static int set_up(void **state)
{
    (void)state;
    facet_error error;
    if (canvas_create(&(canvas_desc){.format = FACET_PLOT_FORMAT_SVG, .width = 100, .height = 100}, &page,
                      &error) != FACET_OK) {
        print_message("%s\n", error.message);
        return -1;
    }
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    canvas_destroy(page);
    return 0;
}

static void clean_text_is_utf8(void **state)
{
    (void)state;
    static const struct {
        const char *text, *expected;
    } CASES[] = {
        {"plain \xc3\xa9 \xe2\x82\xac \xf0\x9f\x98\x80", "plain \xc3\xa9 \xe2\x82\xac \xf0\x9f\x98\x80"},
        {"a\tb\x01"
         "c\x7f"
         "d\nf",
         "a b c d\nf"},
        {"\xff\xc3", "\xef\xbf\xbd\xef\xbf\xbd"},
        {"\xc0\xaf", "\xef\xbf\xbd\xef\xbf\xbd"},                                 /* overlong */
        {"\xed\xa0\x80", "\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd"},                 /* a surrogate */
        {"\xf4\x90\x80\x80", "\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd"}, /* above U+10FFFF */
        {"x\xef\xbf\xbfy\xc2\x85z", "x y z"},                                     /* U+FFFF, a control */
        {NULL, ""}};
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        char out[LABEL_SIZE];
        label_clean(CASES[i].text, out);
        assert_string_equal(out, CASES[i].expected);
    }
    /* cut between characters, not within one */
    char text[3 * LABEL_SIZE + 1], out[LABEL_SIZE];
    for (int i = 0; i < LABEL_SIZE; i++)
        memcpy(text + 3 * i, "\xe2\x82\xac", 4);
    label_clean(text, out);
    assert_int_equal(strlen(out), (LABEL_SIZE - 1) / 3 * 3);
}

/* Whether s consists of complete characters. */
static bool is_whole(const char *s)
{
    char again[LABEL_SIZE];
    label_clean(s, again);
    return strcmp(s, again) == 0;
}

static void lines_fit_and_are_as_long_as_possible(void **state)
{
    (void)state;
    static const char TEXT[] = "a l\xc3\xb6ng \xe2\x82\xac text \xf0\x9f\x98\x80 of "
                               "\xd0\xbc\xd0\xbd\xd0\xbe\xd0\xb3\xd0\xb8\xd0\xb5 words";
    label_line whole, l;
    label_fit(page, FONT, TEXT, 1e6, &whole);
    assert_string_equal(whole.text, TEXT);
    double last = 0.0;
    for (double width = 0.0; width < whole.width + 10.0; width += 0.7) {
        label_fit(page, FONT, TEXT, width, &l);
        assert_true(l.width <= width && l.width >= last - 4.0 &&
                    is_whole(l.text)); /* trailing spaces are removed */
        last = l.width;
        if (width >= whole.width) {
            assert_string_equal(l.text, TEXT);
        } else if (*l.text) {
            const size_t length = strlen(l.text);
            assert_string_equal(l.text + length - 3, "\xe2\x80\xa6");
            assert_true(strncmp(l.text, TEXT, length - 3) == 0);
            assert_true(width - l.width < 22.0); /* the widest character, a space and an ellipsis' rest */
        }
    }
}

static void text_is_wrapped_at_spaces(void **state)
{
    (void)state;
    label_line lines[LABEL_MAX_LINES];
    const double width = canvas_text_width(page, FONT, "one two");
    assert_int_equal(label_wrap(page, FONT, "one two one two one", width + 0.1, 4, lines), 3);
    assert_string_equal(lines[0].text, "one two");
    assert_string_equal(lines[1].text, "one two");
    assert_string_equal(lines[2].text, "one");
    assert_int_equal(label_wrap(page, FONT, "one two one two one", width + 0.1, 2, lines), 2);
    assert_non_null(strstr(lines[1].text, "\xe2\x80\xa6"));
    assert_int_equal(label_wrap(page, FONT, "a\nb\n\n c", 1e6, 4, lines), 3);
    assert_string_equal(lines[2].text, "c");
    assert_int_equal(label_wrap(page, FONT, "", 1e6, 4, lines), 0);
    assert_int_equal(label_wrap(page, FONT, NULL, 1e6, 4, lines), 0);
    assert_int_equal(label_wrap(page, FONT, "unbreakablebutlong x", 40.0, 2, lines), 2);
    for (int i = 0; i < 2; i++)
        assert_true(lines[i].width <= 40.0);
}

static void exponents_are_raised_and_smaller(void **state)
{
    (void)state;
    const tick_label plain = {.text = "10"}, power = {.text = "10", .exponent = "3"};
    const double width = label_tick_width(page, FONT, &plain);
    assert_true(width == canvas_text_width(page, FONT, "10"));
    assert_true(label_tick_width(page, FONT, &power) > width);
    assert_true(label_tick_width(page, FONT, &power) < canvas_text_width(page, FONT, "103"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(clean_text_is_utf8),
        cmocka_unit_test(lines_fit_and_are_as_long_as_possible),
        cmocka_unit_test(text_is_wrapped_at_spaces),
        cmocka_unit_test(exponents_are_raised_and_smaller),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
