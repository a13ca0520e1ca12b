/* frame_list_test.c - the notations of --frames. */
#include "cli/render/frame_list.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

/* The numbers of a list, separated by blanks; "no" where text is none. */
static const char *numbers(const char *text)
{
    static char out[256];
    frame_list list;
    size_t used = 0;
    out[0] = 0;
    if (!frame_list_parse(text, &list))
        return "no";
    for (uint32_t i = 0; i < list.frame_count && used < sizeof out - 12; i++)
        used +=
            (size_t)snprintf(out + used, sizeof out - used, "%s%u", i ? " " : "", frame_list_at(&list, i));
    return out;
}

static void lists_are_read(void **state)
{
    (void)state;
    assert_string_equal(numbers("7"), "7");
    assert_string_equal(numbers("1-3"), "1 2 3");
    assert_string_equal(numbers("1-10x4"), "1 5 9");
    assert_string_equal(numbers("1, 3,5..7"), "1 3 5 6 7");
    assert_string_equal(numbers("5,1-2,5"), "5 1 2 5");
    assert_string_equal(numbers("1-9x4,20"), "1 5 9 20");
}

static void what_is_no_list_is_refused(void **state)
{
    (void)state;
    const char *const wrong[] = {"",
                                 " ",
                                 "a",
                                 "1-",
                                 "3-1",
                                 "1-5x0",
                                 "1,,2",
                                 "1-5x",
                                 "-1",
                                 "0",
                                 "0-3",
                                 "1.5",
                                 "1-2000000",
                                 "1;2",
                                 "1 2",
                                 "1...3",
                                 "1-3,4-",
                                 "999999999",
                                 "1-600000,1-600000"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        if (strcmp(numbers(wrong[i]), "no") != 0)
            fail_msg("\"%s\" was read as %s", wrong[i], numbers(wrong[i]));
    assert_string_not_equal(numbers("1-1000000"), "no");
}

static void all_frames_are_one_range(void **state)
{
    (void)state;
    frame_list list = frame_list_all(1, 48);
    assert_int_equal(list.frame_count, 48);
    assert_int_equal(frame_list_at(&list, 0), 1);
    assert_int_equal(frame_list_at(&list, 47), 48);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lists_are_read),
        cmocka_unit_test(what_is_no_list_is_refused),
        cmocka_unit_test(all_frames_are_one_range),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
