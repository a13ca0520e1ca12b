/* Tests of facet/part.h: parts merge into the image of facet_render(), byte for byte. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "facet/facet.h"
#include "tests/support/support.h"

enum { COUNT = 3, PATH_SIZE = 96 };
static temporary_folder folder;
static facet_scene *scene;
static facet_environment *studio;
static char paths[COUNT][PATH_SIZE];
static const char *list[COUNT];

static int begin(void **state)
{
    (void)state;
    temporary_folder_create(&folder);
    for (int i = 0; i < COUNT; i++) {
        snprintf(paths[i], PATH_SIZE, "%s/part_%d.exr", folder.path, i);
        list[i] = paths[i];
    }
    return facet_scene_create_builtin(NULL, &scene, NULL) != FACET_OK ||
           facet_environment_create_studio(NULL, &studio, NULL) != FACET_OK;
}

static int end(void **state)
{
    (void)state;
    facet_environment_destroy(studio);
    facet_scene_destroy(scene);
    temporary_folder_remove(&folder);
    return 0;
}

static facet_render_desc desc_of(facet_part_split split)
{
    return (facet_render_desc){.width = 40,
                               .height = 33,
                               .environment = studio,
                               .renderer = FACET_RENDERER_KIND_PATH,
                               .samples = 5,
                               .ground = FACET_GROUND_SHADOW,
                               .path.denoises = split == FACET_PART_SPLIT_TILES,
                               .tonemap = FACET_TONEMAP_ACES,
                               .background = FACET_BACKGROUND_COLOR,
                               .aovs = FACET_AOV_DEPTH | FACET_AOV_ALBEDO | FACET_AOV_VARIANCE};
}

/* Renders all parts of desc into files. False: this build has no OpenEXR. */
static bool make_parts(const facet_render_desc *desc, facet_part_split split)
{
    facet_error error;
    for (uint32_t i = 0; i < COUNT; i++) {
        facet_image *part;
        facet_render_desc one = *desc;
        one.part = (facet_part_desc){.index = i,
                                     .count = COUNT,
                                     .split = split,
                                     .has_display_tonemap = true,
                                     .command = "make {part:1}"};
        if (facet_render(scene, &one, &part, &error) != FACET_OK)
            fail_msg("%s", error.message);
        assert_int_equal(facet_image_save(part, "none.png", NULL, NULL), FACET_ERROR_ARGUMENT);
        facet_result result = facet_image_save(part, paths[i], NULL, &error);
        facet_image_destroy(part);
        if (result == FACET_ERROR_UNSUPPORTED)
            return false;
        if (result != FACET_OK)
            fail_msg("%s", error.message);
    }
    return true;
}

static void assert_same(const facet_image *a, const facet_image *b)
{
    assert_int_equal(facet_image_get_layer_count(a), facet_image_get_layer_count(b));
    for (uint32_t i = 0; i < facet_image_get_layer_count(a); i++) {
        facet_image_view x = facet_image_get_layer(a, i), y = facet_image_get_layer(b, i);
        assert_int_equal(x.height, y.height);
        assert_int_equal(x.row_stride_bytes, y.row_stride_bytes);
        assert_memory_equal(x.pixels, y.pixels, x.height * x.row_stride_bytes);
    }
}

static void parts_are_the_image(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        facet_part_split split = k ? FACET_PART_SPLIT_SAMPLES : FACET_PART_SPLIT_TILES;
        const facet_render_desc desc = desc_of(split);
        facet_image *whole, *merged;
        facet_part_info info;
        facet_error error;
        if (!make_parts(&desc, split)) {
            print_message("SKIP: no OpenEXR\n");
            skip();
        }
        assert_int_equal(facet_part_read_info(paths[1], &info, &error), FACET_OK);
        assert_true(info.index == 1 && info.count == COUNT && info.split == split && info.width == 40);
        assert_true(info.has_layers && info.has_display_tonemap && info.tonemap == FACET_TONEMAP_ACES);
        assert_string_equal(info.command, "make {part:1}");
        if (k)
            assert_true(info.rectangle[3] == 33 && info.first_sample == 1 && info.sample_count == 2);
        assert_int_equal(facet_render(scene, &desc, &whole, &error), FACET_OK);
        if (facet_part_merge(list, COUNT, NULL, &merged, &error) != FACET_OK)
            fail_msg("%s", error.message);
        assert_same(whole, merged);
        assert_int_equal(facet_image_get_render_stats(merged).samples,
                         facet_image_get_render_stats(whole).samples);
        facet_image_destroy(whole);
        facet_image_destroy(merged);
        assert_int_equal(facet_part_merge(list, COUNT - 1, NULL, &merged, &error), FACET_ERROR_ARGUMENT);
        assert_null(merged);
        assert_non_null(strstr(error.message, "it is one of 3 parts, of which only 2 are there"));
    }
}

static void failed_allocations_are_reported(void **state)
{
    (void)state;
    const facet_render_desc desc = desc_of(FACET_PART_SPLIT_SAMPLES);
    if (!make_parts(&desc, FACET_PART_SPLIT_SAMPLES))
        skip();
    for (long k = 0;; k = next_failure(k)) {
        failing_allocator failing = {.fail_at = k};
        const facet_merge_desc merging = {.allocator = failing_allocator_get(&failing), .thread_count = 1};
        facet_image *merged;
        facet_error error;
        facet_result result = facet_part_merge(list, COUNT, &merging, &merged, &error);
        facet_image_destroy(merged);
        assert_int_equal(failing.blocks, 0);
        if (result == FACET_OK) {
            assert_true(k > 8);
            return;
        }
        assert_int_equal(result, FACET_ERROR_MEMORY);
    }
}

static void what_cannot_be_divided_is_refused(void **state)
{
    (void)state;
    facet_render_desc descs[5];
    for (int i = 0; i < 5; i++) {
        descs[i] = desc_of(FACET_PART_SPLIT_TILES);
        descs[i].part = (facet_part_desc){.index = 1, .count = 2};
    }
    descs[0].path.noise = 0.1f;
    descs[1].part.index = 2;
    descs[2].part.count = 1000;
    descs[3].part.split = FACET_PART_SPLIT_SAMPLES;
    descs[3].aovs |= FACET_AOV_CRYPTO_OBJECT;
    descs[4].part.split = FACET_PART_SPLIT_SAMPLES;
    descs[4].part.count = 6;
    for (int i = 0; i < 5; i++) {
        facet_image *part;
        facet_error error = {0};
        assert_int_equal(facet_render(scene, &descs[i], &part, &error), FACET_ERROR_ARGUMENT);
        assert_null(part);
        assert_true(error.message[0] != 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(parts_are_the_image),
        cmocka_unit_test(failed_allocations_are_reported),
        cmocka_unit_test(what_cannot_be_divided_is_refused),
    };
    return cmocka_run_group_tests(tests, begin, end);
}
