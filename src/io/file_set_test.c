/* Tests of file_set.h: all files or none, and inputs stay. */
#define _GNU_SOURCE
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "io/file_set.h"
#include "tests/support/support.h"

static temporary_folder folder;

static int make_folder(void **state)
{
    (void)state;
    temporary_folder_create(&folder);
    return 0;
}

static int remove_folder(void **state)
{
    (void)state;
    temporary_folder_remove(&folder);
    return 0;
}

static const char *in_folder(const char *name)
{
    return temporary_folder_file(&folder, name);
}

static bool is_there(const char *name)
{
    return access(in_folder(name), F_OK) == 0;
}

static void files_appear_together(void **state)
{
    (void)state;
    facet_error error;
    char main_path[256];
    snprintf(main_path, sizeof main_path, "%s/a.obj", folder.path);
    file_set set = {.main = main_path};
    assert_int_equal(file_set_add(&set, "a.mtl", "m", 1, &error), FACET_OK);
    assert_int_equal(file_set_add(&set, NULL, "o", 1, &error), FACET_OK);
    assert_false(is_there("a.mtl"));
    assert_false(is_there("a.obj"));
    assert_int_equal(file_set_commit(&set, &error), FACET_OK);
    file_set_destroy(&set);
    assert_true(is_there("a.mtl"));
    assert_true(is_there("a.obj"));
}

static void uncommitted_files_are_removed(void **state)
{
    (void)state;
    facet_error error;
    char main_path[256];
    snprintf(main_path, sizeof main_path, "%s/b.obj", folder.path);
    file_set set = {.main = main_path};
    assert_int_equal(file_set_add(&set, "b.mtl", "m", 1, &error), FACET_OK);
    assert_int_equal(file_set_add(&set, "no/such/folder", "m", 1, &error), FACET_ERROR_WRITE);
    file_set_destroy(&set);
    assert_false(is_there("b.mtl"));
}

/* Progress is reported before each file and before the end; cancelling at any of them leaves no file. */
static bool until(void *user, const char *stage, double fraction)
{
    int *left = user;
    assert_string_equal(stage, "write");
    assert_true(fraction == 0.0 || fraction == 1.0);
    return (*left)-- > 0;
}

static void cancelled_sets_leave_nothing(void **state)
{
    (void)state;
    facet_error error;
    char main_path[256];
    snprintf(main_path, sizeof main_path, "%s/c.obj", folder.path);
    for (int n = 0; n <= 3; n++) {
        int left = n;
        const facet_scene_save_desc desc = {.progress = {.user = &left, .report = until}};
        file_set set = file_set_begin(NULL, main_path, &desc);
        facet_result result = file_set_add(&set, "c.mtl", "m", 1, &error);
        if (result == FACET_OK)
            result = file_set_add(&set, NULL, "o", 1, &error);
        if (result == FACET_OK)
            result = file_set_commit(&set, &error);
        file_set_destroy(&set);
        assert_int_equal(result, n < 3 ? FACET_ERROR_CANCELLED : FACET_OK);
        assert_true(is_there("c.mtl") == (n == 3) && is_there("c.obj") == (n == 3));
    }
}

static void inputs_are_not_replaced(void **state)
{
    (void)state;
    facet_error error;
    facet_scene *scene = NULL;
    char main_path[256];
    assert_int_equal(file_write(in_folder("input.mtl"), "old", 3, &error), FACET_OK);
    assert_int_equal(scene_create(NULL, "source.obj", &scene, &error), FACET_OK);
    file_bytes file;
    assert_int_equal(file_open(in_folder("input.mtl"), 0, NULL, &file, &error), FACET_OK);
    assert_true(scene_keep_file(scene, &file, "file"));
    snprintf(main_path, sizeof main_path, "%s/input.obj", folder.path);
    file_set set = {.main = main_path, .inputs = scene};
    assert_int_equal(file_set_add(&set, "input.mtl", "new", 3, &error), FACET_ERROR_ARGUMENT);
    assert_non_null(strstr(error.message, "which belongs to source.obj"));
    file_set_destroy(&set);
    set = (file_set){.main = main_path};
    assert_int_equal(file_set_add(&set, "input.mtl", "new", 3, &error), FACET_OK);
    file_set_destroy(&set);
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(files_appear_together),
        cmocka_unit_test(uncommitted_files_are_removed),
        cmocka_unit_test(cancelled_sets_leave_nothing),
        cmocka_unit_test(inputs_are_not_replaced),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
