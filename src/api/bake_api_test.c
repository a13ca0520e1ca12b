/* bake_api_test.c - what is baked, through facet.h alone: files of cube maps that are read as environments
 * again, RGBM. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "facet/facet.h"

static facet_cube *bake(void)
{
    facet_environment *e = NULL;
    facet_cube *c = NULL;
    facet_error error;
    assert_int_equal(facet_environment_create_gradient(
                         (const float[3]){4.0f, 2.0f, 1.0f}, (const float[3]){1.0f, 1.0f, 1.0f},
                         (const float[3]){0.25f, 0.125f, 0.0f}, NULL, &e, &error),
                     FACET_OK);
    if (facet_cube_bake(e, &(facet_bake_desc){.lobe = FACET_LOBE_NONE, .size = 16}, &c, &error) != FACET_OK)
        fail_msg("%s", error.message);
    facet_environment_destroy(e);
    return c;
}

/* A cube map written, and read as an environment, has the same mean. */
static void cubes_are_environments(void **state)
{
    (void)state;
    static const facet_texel_format formats[] = {FACET_TEXEL_FORMAT_RGBA16F, FACET_TEXEL_FORMAT_RGBA32F,
                                                 FACET_TEXEL_FORMAT_RGB9E5, FACET_TEXEL_FORMAT_B10G11R11};
    facet_cube *c = bake();
    facet_environment_info infos[8];
    for (uint32_t k = 0; k < 8; k++) {
        unsigned char *bytes = NULL;
        size_t size = 0;
        facet_error error;
        const facet_ktx2_desc desc = {.format = formats[k % 4], .zstd_level = k / 4 * 5};
        facet_result result = facet_cube_encode_ktx2(c, &desc, &bytes, &size, &error);
        if (result == FACET_ERROR_UNSUPPORTED && desc.zstd_level) {
            assert_non_null(strstr(error.message, "libzstd"));
            infos[k] = infos[k % 4];
            continue;
        }
        assert_int_equal(result, FACET_OK);
        facet_environment *e = NULL;
        if (facet_environment_load_memory(bytes, size, "baked.ktx2", NULL, &e, &error) != FACET_OK)
            fail_msg("%s", error.message);
        assert_int_equal(facet_environment_get_info(e, &infos[k], NULL), FACET_OK);
        assert_int_equal(infos[k].layout, FACET_LAYOUT_FACES);
        assert_int_equal(infos[k].width, 16);
        assert_int_equal(infos[k].repaired_texels, 0);
        facet_environment_destroy(e);
        facet_bytes_destroy(bytes);
    }
    for (int k = 0; k < 4; k++)
        for (int i = 0; i < 3; i++) {
            const double share = infos[k].mean[i] / infos[1].mean[i];
            assert_true(fabs(share - 1.0) <
                        (k == 0 ? 1e-4 : 3e-3)); /* 5 bits and more, rounded to the nearest */
            assert_true(infos[k + 4].mean[i] == infos[k].mean[i]); /* compressed or not */
        }
    facet_cube_destroy(c);
}

/* Every layout that can be written can be read, as what it was written. */
static void layouts_are_environments(void **state)
{
    (void)state;
    facet_cube *c = bake();
    for (int layout = FACET_LAYOUT_EQUIRECTANGULAR; layout <= FACET_LAYOUT_OCTAHEDRAL; layout++) {
        facet_image *image = NULL;
        unsigned char *bytes = NULL;
        size_t size = 0;
        facet_environment *e = NULL;
        facet_environment_info info;
        facet_error error;
        if (facet_cube_unfold(c, 0, (facet_layout)layout, 0, NULL, &image, &error) != FACET_OK)
            fail_msg("%s", error.message);
        assert_int_equal(facet_image_encode(image, &(facet_image_save_desc){.format = FACET_IMAGE_FORMAT_PFM},
                                            &bytes, &size, NULL),
                         FACET_OK);
        const facet_environment_desc desc = {
            .layout = layout == FACET_LAYOUT_OCTAHEDRAL ? FACET_LAYOUT_OCTAHEDRAL : FACET_LAYOUT_AUTO};
        if (facet_environment_load_memory(bytes, size, "layout", &desc, &e, &error) != FACET_OK)
            fail_msg("%s", error.message);
        assert_int_equal(facet_environment_get_info(e, &info, NULL), FACET_OK);
        assert_int_equal(info.layout, layout);
        assert_true(info.mean[0] > info.mean[1] && info.mean[1] > info.mean[2]);
        facet_environment_destroy(e);
        facet_bytes_destroy(bytes);
        facet_image_destroy(image);
    }
    facet_cube_destroy(c);
}

static void rgbm(void **state)
{
    (void)state;
    facet_cube *c = bake();
    facet_image *image = NULL;
    unsigned char *bytes = NULL;
    size_t size = 0;
    facet_error error;
    assert_int_equal(facet_cube_unfold(c, 99, FACET_LAYOUT_STRIP_VERTICAL, 0, NULL, &image, &error),
                     FACET_ERROR_ARGUMENT);
    assert_non_null(strstr(error.message, "no level 99"));
    assert_int_equal(facet_cube_copy_face(c, 99, 0, NULL, &image, &error), FACET_ERROR_ARGUMENT);
    assert_int_equal(facet_cube_copy_face(c, 0, 6, NULL, &image, &error), FACET_ERROR_ARGUMENT);
    assert_int_equal(facet_cube_unfold(c, 0, FACET_LAYOUT_STRIP_VERTICAL, 0, NULL, &image, NULL), FACET_OK);
    assert_int_equal(facet_image_encode_rgbm(image, 8.0f, NULL, &bytes, &size, &error), FACET_OK);
    assert_memory_equal(bytes, "\x89PNG\r\n\x1a\n", 8);
    assert_memory_equal(bytes + 16, "\0\0\0\x10\0\0\0\x60\x08\x06", 10); /* 16 x 96, 8 bits, RGBA */
    facet_bytes_destroy(bytes);
    static const float ranges[] = {0.0f, -1.0f, NAN, INFINITY};
    for (int k = 0; k < 4; k++) {
        assert_int_equal(facet_image_encode_rgbm(image, ranges[k], NULL, &bytes, &size, &error),
                         FACET_ERROR_ARGUMENT);
        assert_null(bytes);
        assert_non_null(strstr(error.message, "RGBM: a range above 0"));
    }
    facet_image_destroy(image);
    facet_cube_destroy(c);
}

/* A image as a 2D texture: alpha as it is. */
static void images_as_textures(void **state)
{
    (void)state;
    facet_cube *c = bake();
    facet_image *image = NULL;
    unsigned char *bytes = NULL;
    size_t size = 0;
    facet_environment *e = NULL;
    facet_environment_info info;
    assert_int_equal(facet_cube_unfold(c, 0, FACET_LAYOUT_EQUIRECTANGULAR, 24, NULL, &image, NULL), FACET_OK);
    assert_int_equal(facet_image_encode_ktx2(image, NULL, &bytes, &size, NULL), FACET_OK);
    assert_int_equal(facet_environment_load_memory(bytes, size, "2d.ktx2", NULL, &e, NULL), FACET_OK);
    assert_int_equal(facet_environment_get_info(e, &info, NULL), FACET_OK);
    assert_int_equal(info.layout, FACET_LAYOUT_EQUIRECTANGULAR);
    assert_int_equal(info.width, 48);
    facet_environment_destroy(e);
    facet_bytes_destroy(bytes);
    facet_image_destroy(image);
    facet_cube_destroy(c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cubes_are_environments),
        cmocka_unit_test(layouts_are_environments),
        cmocka_unit_test(rgbm),
        cmocka_unit_test(images_as_textures),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
