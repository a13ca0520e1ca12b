/* view_input_test.c - view_input.h: every key once, every key with help, all of it in docs/view.md. */
#include "view/view_input.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

static char document[1 << 16];

static int read_document(void **state)
{
    (void)state;
    FILE *file = fopen("docs/view.md", "rb");
    if (!file)
        return 1;
    size_t size = fread(document, 1, sizeof document - 1, file);
    document[size] = 0;
    return fclose(file);
}

static void no_key_is_bound_twice(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < view_binding_count; i++)
        assert_ptr_equal(view_binding_find(view_bindings[i].key, view_bindings[i].modifiers),
                         &view_bindings[i]);
    assert_null(view_binding_find('H', VIEW_ALT));
}

/* A line without help shares that of the previous one. */
static void every_key_has_help(void **state)
{
    (void)state;
    assert_non_null(view_bindings[0].group);
    for (uint32_t i = 0; i < view_binding_count; i++) {
        assert_int_not_equal(view_bindings[i].action, VIEW_ACTION_NONE);
        if (!view_bindings[i].help)
            assert_int_equal(view_bindings[i].action, view_bindings[i - 1].action);
    }
}

static void every_action_has_a_key(void **state)
{
    (void)state;
    for (int action = VIEW_ACTION_MODEL; action <= VIEW_ACTION_QUIT; action++) {
        bool is_bound = false;
        for (uint32_t i = 0; i < view_binding_count; i++)
            is_bound = is_bound || (int)view_bindings[i].action == action;
        assert_true(is_bound);
    }
}

static void key_names_round_trip(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < view_binding_count; i++) {
        char name[32];
        uint32_t key;
        unsigned modifiers;
        view_key_write(view_bindings[i].key, view_bindings[i].modifiers, name, sizeof name);
        assert_true(view_key_parse(name, &key, &modifiers));
        assert_int_equal(key, view_bindings[i].key);
        assert_int_equal(modifiers, view_bindings[i].modifiers);
    }
    uint32_t key;
    unsigned modifiers;
    assert_false(view_key_parse("", &key, &modifiers));
    assert_false(view_key_parse("Shift+", &key, &modifiers));
    assert_false(view_key_parse("F99", &key, &modifiers));
    assert_true(view_key_parse("ctrl+shift+l", &key, &modifiers));
    assert_int_equal(key, 'L');
    assert_int_equal(modifiers, VIEW_CONTROL | VIEW_SHIFT);
}

/* "| `Left`, `Right` | previous, next model of the folder |", in the order of the table. */
static void the_document_lists_every_key(void **state)
{
    (void)state;
    const char *at = document;
    for (uint32_t i = 0; i < view_binding_count;) {
        char row[512] = "| ";
        const char *help = view_bindings[i].help;
        do {
            char name[32];
            view_key_write(view_bindings[i].key, view_bindings[i].modifiers, name, sizeof name);
            size_t used = strlen(row);
            snprintf(row + used, sizeof row - used, "%s`%s`", used > 2 ? ", " : "", name);
        } while (++i < view_binding_count && !view_bindings[i].help);
        size_t used = strlen(row);
        snprintf(row + used, sizeof row - used, " | %s |", help);
        const char *found = strstr(at, row);
        if (!found)
            fail_msg("docs/view.md lacks the line, or it stands elsewhere: %s", row);
        at = found;
    }
    for (uint32_t i = 0; i < view_pointer_line_count; i++)
        if (!strstr(document, view_pointer_lines[i].help))
            fail_msg("docs/view.md does not say: %s", view_pointer_lines[i].help);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_key_is_bound_twice), cmocka_unit_test(every_key_has_help),
        cmocka_unit_test(every_action_has_a_key), cmocka_unit_test(key_names_round_trip),
        cmocka_unit_test(the_document_lists_every_key)};
    return cmocka_run_group_tests(tests, read_document, NULL);
}
