/* view_script_test.c - view_script.h, and the queue of its events. */
#define _POSIX_C_SOURCE 200809L /* strdup */
#include "view/view_script.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "tests/support/support.h"

static facet_result parse(const char *text, view_script *out, facet_error *error)
{
    return view_script_parse(text, strlen(text), "test", &(facet_allocator){0}, out, error);
}

static void lines_become_steps(void **state)
{
    (void)state;
    view_script s;
    facet_error error;
    assert_int_equal(parse("# all of it\n\nload\r\n  key Shift+l \ndrag Ctrl+right 1 2.5 3 -4\nscroll 0 -1\n"
                           "drop a model.glb \ntrace\ntrace 16\nwait 0.5\ntrace 0 2.5",
                           &s, &error),
                     FACET_OK);
    assert_int_equal(s.count, 9);
    assert_int_equal(s.steps[0].kind, VIEW_STEP_LOAD);
    assert_int_equal(s.steps[0].line, 3);
    assert_int_equal(s.steps[1].key, 'L');
    assert_int_equal(s.steps[1].modifiers, VIEW_SHIFT);
    assert_int_equal(s.steps[2].button, VIEW_RIGHT_BUTTON);
    assert_int_equal(s.steps[2].modifiers, VIEW_CONTROL);
    assert_true(s.steps[2].numbers[1] == 2.5 && s.steps[2].numbers[3] == -4.0);
    assert_string_equal(s.steps[4].path, "a model.glb");
    assert_true(s.steps[5].numbers[0] == 0.0 && s.steps[6].numbers[0] == 16.0);
    assert_true(s.steps[7].numbers[0] == 0.5);
    assert_true(s.steps[8].numbers[0] == 0.0 && s.steps[8].numbers[1] == 2.5);
    view_script_destroy(&s);
}

static void errors_name_their_line(void **state)
{
    (void)state;
    static const char *const wrong[] = {"load\njump\n",     "load\nkey\n",          "load\nkey F99\n",
                                        "load\nwait\n",     "load\nwait 1 2\n",     "load\nwait nan\n",
                                        "load\ndrop\n",     "load\ndrag 1 2 3 4\n", "load\ndrag left 1 2 3\n",
                                        "load\nload 1",     "load\nsize 4x3",       "load\nkey a b",
                                        "load\ntrace 1 2 3"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        view_script s;
        facet_error error;
        assert_int_equal(parse(wrong[i], &s, &error), FACET_ERROR_ARGUMENT);
        assert_non_null(strstr(error.message, "test: line 2: "));
        assert_null(s.steps);
    }
}

static void running_out_of_memory_is_a_result(void **state)
{
    (void)state;
    static const char text[] = "load\nkey h\nclose\n";
    facet_result result = FACET_ERROR_MEMORY;
    for (int i = 0; result == FACET_ERROR_MEMORY && i < 10; i++) {
        failing_allocator failing = {.fail_at = i};
        facet_allocator allocator = failing_allocator_get(&failing);
        view_script s;
        result = view_script_parse(text, strlen(text), "test", &allocator, &s, NULL);
        assert_true(result == FACET_OK || result == FACET_ERROR_MEMORY);
        assert_true(i > 0 || result == FACET_ERROR_MEMORY);
        view_script_destroy(&s);
        assert_int_equal(atomic_load(&failing.blocks), 0);
    }
    assert_int_equal(result, FACET_OK);
}

static void consecutive_movements_are_merged(void **state)
{
    (void)state;
    view_queue *q = calloc(1, sizeof *q);
    assert_non_null(q);
    for (int i = 0; i < 1000; i++)
        assert_true(view_queue_put(q, (view_event){.kind = VIEW_MOVE, .x = i}));
    assert_int_equal(q->count, 1);
    view_event e;
    assert_true(view_queue_take(q, &e));
    assert_true(e.x == 999.0);
    assert_false(view_queue_take(q, &e));
    for (int i = 0; i < VIEW_QUEUE_SIZE; i++)
        assert_true(view_queue_put(q, (view_event){.kind = VIEW_KEY, .key = (uint32_t)i}));
    assert_false(view_queue_put(q, (view_event){.kind = VIEW_DROP, .path = strdup("lost, not leaked")}));
    for (uint32_t i = 0; i < VIEW_QUEUE_SIZE; i++) {
        assert_true(view_queue_take(q, &e));
        assert_int_equal(e.key, i);
    }
    free(q);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(lines_become_steps),
                                       cmocka_unit_test(errors_name_their_line),
                                       cmocka_unit_test(running_out_of_memory_is_a_result),
                                       cmocka_unit_test(consecutive_movements_are_merged)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
