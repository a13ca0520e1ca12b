/* Tests of model_needs.h: decoders that files need, by content. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "io/model_needs.h"
#include "tests/support/support.h"

#define WEBP "RIFF\x0c\0\0\0WEBPVP8 "
#define AVIF                                                                                                 \
    "\0\0\0\x1c"                                                                                             \
    "ftypavif\0\0\0\0"

static unsigned needs_of(const char *path)
{
    const facet_scene_desc desc = {0};
    unsigned needs = ~0u;
    facet_error error = {0};
    if (model_needs_of_file(path, &desc, &needs, &error) != FACET_OK)
        fail_msg("%s", error.message);
    return needs;
}

static unsigned needs_of_text(const temporary_folder *folder, const char *name, const char *text)
{
    return needs_of(temporary_folder_put(folder, name, text, strlen(text)));
}

static void images_count_by_content(void **state)
{
    (void)state;
    temporary_folder folder;
    temporary_folder_create(&folder);
    temporary_folder_put(&folder, "a.png", WEBP, sizeof WEBP - 1);
    temporary_folder_put(&folder, "b.webp", AVIF, sizeof AVIF - 1);
    temporary_folder_put_png(&folder, "c.webp");
    const char *header =
        "{\"asset\":{\"version\":\"2.0\"},\"extensionsUsed\":[\"EXT_texture_webp\"],\"images\":";
    char text[512];
    static const struct {
        const char *images;
        unsigned needs;
    } cases[] = {
        {"[{\"uri\":\"c.webp\"}]}", 0},
        {"[{\"uri\":\"a.png\",\"mimeType\":\"image/png\"}]}", MODEL_NEED_WEBP},
        {"[{\"uri\":\"data:image/png;base64,UklGRgwAAABXRUJQVlA4IA==\"}]}", MODEL_NEED_WEBP},
        {"[{\"uri\":\"a.png\"},{\"uri\":\"b.webp\"}]}", MODEL_NEED_WEBP | MODEL_NEED_AVIF},
        {"[{\"uri\":\"missing.webp\"}]}", 0},
    };
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        snprintf(text, sizeof text, "%s%s", header, cases[i].images);
        if (needs_of_text(&folder, "model.gltf", text) != cases[i].needs)
            fail_msg("%s", cases[i].images);
    }
    temporary_folder_remove(&folder);
}

static void draco_counts_by_its_extension(void **state)
{
    (void)state;
    assert_int_equal(needs_of("src/io/testdata/sail_draco_edgebreaker.glb"), MODEL_NEED_DRACO);
    assert_int_equal(needs_of("src/io/testdata/sail_draco_sequential.glb"), MODEL_NEED_DRACO);
    assert_int_equal(needs_of("src/io/testdata/sail.glb"), 0);
    assert_int_equal(needs_of("src/io/testdata/sail_meshopt_ext.glb"), 0);
}

static void other_files_are_told_apart(void **state)
{
    (void)state;
    temporary_folder folder;
    temporary_folder_create(&folder);
    assert_int_equal(needs_of_text(&folder, "a.hdr", "\x76\x2f\x31\x01 and more"), MODEL_NEED_EXR);
    assert_int_equal(needs_of_text(&folder, "a.exr", "#?RADIANCE\n"), 0);
    assert_int_equal(needs_of("src/image/testdata/uastc_zstd.ktx2"), MODEL_NEED_ZSTD);
    assert_int_equal(needs_of("src/image/testdata/uastc_modes.ktx2"), 0);
    assert_int_equal(needs_of_text(&folder, "a.obj", "v 0 0 0\nf 1 1 1\n"), 0);
    assert_int_equal(needs_of_text(&folder, "a.glb", "nonsense"), 0);
    temporary_folder_remove(&folder);
}

static void unreadable_files_have_their_sentence(void **state)
{
    (void)state;
    const facet_scene_desc desc = {0};
    unsigned needs = ~0u;
    facet_error error = {0};
    assert_int_equal(model_needs_of_file("does/not/exist.glb", &desc, &needs, &error), FACET_ERROR_READ);
    assert_int_equal(needs, 0);
    temporary_folder folder;
    temporary_folder_create(&folder);
    const char *path = temporary_folder_put(&folder, "a.gltf", "{\"asset\":1}", 11);
    assert_int_equal(model_needs_of_file(path, &desc, &needs, &error), FACET_ERROR_INVALID);
    assert_non_null(strstr(error.message, "a.gltf"));
    temporary_folder_remove(&folder);
}

static void names_are_those_of_modules(void **state)
{
    (void)state;
    static const char *const names[MODEL_NEED_COUNT] = {"draco", "webp", "avif", "exr", "zstd"};
    for (int i = 0; i < MODEL_NEED_COUNT; i++)
        assert_string_equal(model_need_name((model_need)(1 << i)), names[i]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(images_count_by_content),    cmocka_unit_test(draco_counts_by_its_extension),
        cmocka_unit_test(other_files_are_told_apart), cmocka_unit_test(unreadable_files_have_their_sentence),
        cmocka_unit_test(names_are_those_of_modules),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
