/* bake_names_test.c - names of the files of facet bake. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "cli/bake/bake_names.h"

static void test_expand(void **state)
{
    (void)state;
    static const struct {
        const char *pattern;
        int level;
        bool has_levels;
        int face;
        const char *name;
    } cases[] = {
        {"a.ktx2", -1, false, -1, "a.ktx2"},
        {"a.exr", 3, true, -1, "a_m3.exr"},
        {"a.exr", 0, false, -1, "a.exr"},
        {"a.exr", 12, true, 5, "a_m12_nz.exr"},
        {"a.exr", 0, false, 0, "a_px.exr"},
        {"m{level}_{face}.hdr", 2, true, 3, "m2_ny.hdr"},
        {"{face}.hdr", 2, true, 3, "ny_m2.hdr"},
        {"{level}/{face}.hdr", 2, true, 3, "2/ny.hdr"},
        {"{stem}-{stem}.exr", 1, false, -1, "studio-studio.exr"},
        {"v1.2/plain", 1, true, -1, "v1.2/plain_m1"},
        {"{other}{.exr", -1, false, -1, "{other}{.exr"},
        {".exr", 1, true, -1, "_m1.exr"},
    };
    char name[BAKE_NAME_SIZE];
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        assert_true(bake_name_expand(cases[i].pattern, "studio", cases[i].level, cases[i].has_levels,
                                     cases[i].face, name));
        assert_string_equal(name, cases[i].name);
    }
}

static void test_too_long(void **state)
{
    (void)state;
    char pattern[BAKE_NAME_SIZE + 8], name[BAKE_NAME_SIZE];
    memset(pattern, 'a', sizeof pattern);
    pattern[BAKE_NAME_SIZE - 1] = 0;
    assert_true(bake_name_expand(pattern, "s", -1, false, -1, name));
    assert_int_equal(strlen(name), BAKE_NAME_SIZE - 1);
    assert_false(bake_name_expand(pattern, "s", 1, true, -1, name));
    assert_false(bake_name_join(pattern, "b", name));
    pattern[BAKE_NAME_SIZE - 1] = 'a';
    pattern[BAKE_NAME_SIZE] = 0;
    assert_false(bake_name_expand(pattern, "s", -1, false, -1, name));
}

static void test_containers(void **state)
{
    (void)state;
    assert_int_equal(bake_container_of("a.b/c.KTX2"), CONTAINER_KTX2);
    assert_int_equal(bake_container_of("a.hdr/c"), CONTAINER_FROM_NAME);
    assert_int_equal(bake_container_of("a.jpeg"), CONTAINER_JPEG);
    assert_int_equal(bake_container_of("a.exr"), CONTAINER_EXR);
    assert_string_equal(bake_container_extension(CONTAINER_EXR_FLOAT), "exr");
}

static void test_folders(void **state)
{
    (void)state;
    char name[BAKE_NAME_SIZE];
    assert_true(bake_name_join("out//", "a/b.ktx2", name));
    assert_string_equal(name, "out/a/b.ktx2");
    assert_true(bake_name_join("/", "a", name));
    assert_string_equal(name, "/a");
    bake_name_of_folder("out/studio/", name);
    assert_string_equal(name, "studio");
    bake_name_of_folder("studio", name);
    assert_string_equal(name, "studio");
    bake_name_of_folder("/", name);
    assert_string_equal(name, "environment");
    bake_name_of_folder(".", name);
    assert_true(name[0] && !strchr(name, '/') && strcmp(name, ".") != 0);
}

static void test_symbols(void **state)
{
    (void)state;
    char symbol[8];
    bake_symbol("a/9 lives.h", symbol, sizeof symbol);
    assert_string_equal(symbol, "_9_live");
    bake_symbol("a/sh.h", symbol, sizeof symbol);
    assert_string_equal(symbol, "sh");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_expand),  cmocka_unit_test(test_too_long), cmocka_unit_test(test_containers),
        cmocka_unit_test(test_folders), cmocka_unit_test(test_symbols),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
