/* glsl_test.c - the shader library as GLSL: complete, in order, and in parts that compile alone. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/memory.h"
#include "facet/facet.h"

static char *text_of(const char *version, const char *const *parts, uint32_t count)
{
    const facet_shader_desc desc = {.version = version, .parts = parts, .part_count = count};
    unsigned char *bytes;
    size_t size;
    facet_error error = {0};
    if (facet_shader_text(&desc, &bytes, &size, &error) != FACET_OK)
        fail_msg("%s", error.message);
    assert_int_equal(strlen((char *)bytes), size);
    return (char *)bytes;
}

static void the_library_has_all_parts_in_order(void **state)
{
    (void)state;
    char *text = text_of("300 es", NULL, 0);
    assert_memory_equal(text, "#version 300 es\n", 16);
    assert_null(strstr(text, "\n#include"));
    const char *before = text;
    static const char *const marks[] = {"precision highp float", "#define PI ", "FN vec3 F_Schlick(",
                                        "FN float D_GGX(", "FN vec3 tonemap_"};
    const char *dialect = strstr(text, marks[0]);
    assert_true(dialect && strstr(dialect, marks[1]));
    assert_true(strstr(text, marks[3]) > strstr(text, marks[1]));
    assert_true(strstr(text, marks[4]) > strstr(text, marks[2]));
    assert_true(before && facet_shader_get_part_count() > 20);
    for (uint32_t i = 0; i < facet_shader_get_part_count(); i++) {
        char mark[80];
        snprintf(mark, sizeof mark, "/* %s.h - ", facet_shader_get_part_name(i));
        before = strstr(before, mark);
        assert_non_null(before);
    }
    assert_null(facet_shader_get_part_name(facet_shader_get_part_count()));
    mem_free(text);
}

static void a_part_comes_with_its_dependencies_only(void **state)
{
    (void)state;
    static const char *const fresnel[] = {"fresnel"};
    char *text = text_of(NULL, fresnel, 1);
    assert_null(strstr(text, "\n#version"));
    assert_non_null(strstr(text, "FN vec3 F_Schlick("));
    assert_null(strstr(text, "FN vec3 tonemap_"));
    assert_null(strstr(text, "FN float D_Charlie("));
    mem_free(text);
    static const char *const layers[] = {"layers_ibl"};
    text = text_of(NULL, layers, 1);
    assert_non_null(strstr(text, "FN float D_Charlie("));
    assert_non_null(strstr(text, "#define PI "));
    assert_null(strstr(text, "FN vec3 tonemap_"));
    mem_free(text);
}

static void versions_and_parts_are_checked(void **state)
{
    (void)state;
    static const char *const good[] = {"300 es", "320 es", "330", "330 core", "460", "450 core"};
    static const char *const bad[] = {
        "100", "120", "300", "300es", "300 es core", "", "4600", "330 compatibility", "es"};
    unsigned char *bytes;
    size_t size;
    facet_error error;
    for (size_t i = 0; i < sizeof good / sizeof *good; i++)
        mem_free(text_of(good[i], NULL, 0));
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        const facet_shader_desc desc = {.version = bad[i]};
        assert_int_equal(facet_shader_text(&desc, &bytes, &size, &error), FACET_ERROR_ARGUMENT);
        assert_null(bytes);
    }
    static const char *const unknown[] = {"fresnel", "radiosity"};
    const facet_shader_desc desc = {.parts = unknown, .part_count = 2};
    assert_int_equal(facet_shader_text(&desc, &bytes, &size, &error), FACET_ERROR_ARGUMENT);
    assert_non_null(strstr(error.message, "radiosity"));
}

static void *refuse(void *user, size_t size)
{
    (void)user, (void)size;
    return NULL;
}

static void take_back(void *user, void *memory, size_t size)
{
    (void)user, (void)memory, (void)size;
}

static void running_out_of_memory_is_a_result(void **state)
{
    (void)state;
    static const char *const fresnel[] = {"fresnel"};
    facet_shader_desc desc = {.allocator = {.allocate = refuse, .release = take_back}};
    unsigned char *bytes;
    size_t size;
    facet_error error;
    assert_int_equal(facet_shader_text(&desc, &bytes, &size, &error), FACET_ERROR_MEMORY);
    desc.parts = fresnel;
    desc.part_count = 1;
    assert_int_equal(facet_shader_text(&desc, &bytes, &size, &error), FACET_ERROR_MEMORY);
    assert_null(bytes);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_library_has_all_parts_in_order),
        cmocka_unit_test(a_part_comes_with_its_dependencies_only),
        cmocka_unit_test(versions_and_parts_are_checked),
        cmocka_unit_test(running_out_of_memory_is_a_result),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
