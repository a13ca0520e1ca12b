/* Tests of FACET_SHADING_OGL1 through facet.h: the bytes of a file, backgrounds, one renderer for both
 * models, errors. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "facet/facet.h"
#include "scene/legacy.h"

enum { SIZE = 48 };

/* The built-in scene, all of it in one unlit legacy color. */
static facet_scene *unlit_scene(float red, float green, float blue, float opacity)
{
    facet_scene *scene;
    assert_int_equal(facet_scene_create_builtin(NULL, &scene, NULL), FACET_OK);
    scene_legacy *legacy = arena_zalloc(scene->arena, 1, sizeof *legacy);
    assert_non_null(legacy);
    legacy->colors = FACET_LEGACY_COLORS_SRGB;
    legacy->dialect = FACET_MTL_DIALECT_SPEC;
    legacy->materials = arena_zalloc(scene->arena, scene->material_count, sizeof *legacy->materials);
    assert_non_null(legacy->materials);
    for (uint32_t i = 0; i < scene->material_count; i++) {
        legacy->materials[i] = legacy_material_default();
        legacy->materials[i].is_lit = false;
        legacy->materials[i].is_culled =
            true; /* one layer in each pixel, but for spheres before each other */
        legacy->materials[i].diffuse[0] = red;
        legacy->materials[i].diffuse[1] = green;
        legacy->materials[i].diffuse[2] = blue;
        legacy->materials[i].opacity = opacity;
    }
    for (uint32_t i = 0; i < scene->mesh_count; i++)
        for (uint32_t k = 0; k < scene->meshes[i].primitive_count; k++)
            scene->meshes[i].primitives[k].colors = NULL;
    scene->legacy = legacy;
    return scene;
}

static unsigned char *render_codes(const facet_scene *scene, const facet_render_desc *desc)
{
    facet_image *image;
    facet_error error = {0};
    unsigned char *bytes;
    size_t size;
    if (facet_render(scene, desc, &image, &error) != FACET_OK)
        fail_msg("%s", error.message);
    facet_image_save_desc raw = {.format = FACET_IMAGE_FORMAT_RAW};
    assert_int_equal(facet_image_encode(image, &raw, &bytes, &size, &error), FACET_OK);
    assert_int_equal(size, SIZE * SIZE * 4);
    facet_image_destroy(image);
    return bytes;
}

/* How many pixels have these codes. */
static int count_codes(const unsigned char *bytes, int red, int green, int blue, int alpha)
{
    int count = 0;
    for (int i = 0; i < SIZE * SIZE; i++)
        count += bytes[4 * i] == red && bytes[4 * i + 1] == green && bytes[4 * i + 2] == blue &&
                 bytes[4 * i + 3] == alpha;
    return count;
}

/* steelblue, #4682b4, over white: these codes and no others. */
static void colors_come_back_as_codes(void **state)
{
    (void)state;
    facet_scene *scene = unlit_scene(70.0f / 255.0f, 130.0f / 255.0f, 180.0f / 255.0f, 1.0f);
    facet_render_desc desc = {.width = SIZE,
                              .height = SIZE,
                              .samples = 1,
                              .shading = FACET_SHADING_OGL1,
                              .background = FACET_BACKGROUND_COLOR,
                              .background_color = {1.0f, 1.0f, 1.0f}};
    for (int variant = FACET_OGL1_VARIANT_VIGNETTE; variant <= FACET_OGL1_VARIANT_RGL_DESKTOP; variant++)
        for (int is_linear = 0; is_linear < 2; is_linear++) {
            desc.ogl1 = (facet_ogl1_desc){.variant = (facet_ogl1_variant)variant, .is_linear = is_linear};
            unsigned char *bytes = render_codes(scene, &desc);
            int model = count_codes(bytes, 70, 130, 180, 255);
            int white = count_codes(bytes, 255, 255, 255, 255);
            assert_true(model > 400 && white > 400);
            assert_int_equal(model + white, SIZE * SIZE);
            facet_bytes_destroy(bytes);
        }
    facet_scene_destroy(scene);
}

/* Half of a color over a background: half of both codes, as OpenGL blended them; as light it would be
 * brighter. A transparent image holds the color itself. */
static void layers_are_blended_as_codes(void **state)
{
    (void)state;
    facet_scene *scene = unlit_scene(0.0f, 0.4f, 1.0f, 0.5f);
    const float grey = facet_linear_from_srgb(0.2f);
    facet_render_desc desc = {.width = SIZE,
                              .height = SIZE,
                              .samples = 1,
                              .shading = FACET_SHADING_OGL1,
                              .background = FACET_BACKGROUND_COLOR,
                              .background_color = {grey, grey, grey}};
    unsigned char *bytes = render_codes(scene, &desc);
    /* 0.1 and 0.6 are 25.5 and 153; the former may round either way */
    assert_true(count_codes(bytes, 25, 77, 153, 255) + count_codes(bytes, 26, 77, 153, 255) +
                    count_codes(bytes, 25, 76, 153, 255) + count_codes(bytes, 26, 76, 153, 255) >
                400);
    facet_bytes_destroy(bytes);
    desc.background = FACET_BACKGROUND_TRANSPARENT;
    bytes = render_codes(scene, &desc);
    assert_true(count_codes(bytes, 0, 102, 255, 128) > 400);
    facet_bytes_destroy(bytes);
    desc.background = FACET_BACKGROUND_COLOR;
    desc.ogl1.is_linear = true;
    bytes = render_codes(scene, &desc);
    float blue = 0.5f * (1.0f + grey);
    int code = 0;
    while (facet_linear_from_srgb(((float)code + 0.5f) / 255.0f) < blue)
        code++;
    int count = 0;
    for (int i = 0; i < SIZE * SIZE; i++)
        count += bytes[4 * i + 2] == code;
    assert_true(code > 180 && count > 400);
    facet_bytes_destroy(bytes);
    facet_scene_destroy(scene);
}

static void assert_same_pixels(const facet_image *a, const facet_image *b)
{
    facet_image_view x = facet_image_get_layer(a, 0);
    facet_image_view y = facet_image_get_layer(b, 0);
    assert_memory_equal(x.pixels, y.pixels, (size_t)SIZE * x.row_stride_bytes);
}

static void one_renderer_for_both_models(void **state)
{
    (void)state;
    facet_scene *scene = unlit_scene(0.2f, 0.4f, 0.6f, 0.75f);
    facet_renderer *renderer;
    assert_int_equal(facet_renderer_create(scene, NULL, &renderer, NULL), FACET_OK);
    for (int i = 0; i < 4; i++) {
        facet_render_desc desc = {.width = SIZE,
                                  .height = SIZE,
                                  .shading = i % 2 ? FACET_SHADING_GLTF : FACET_SHADING_OGL1,
                                  .background = FACET_BACKGROUND_COLOR};
        facet_image *kept;
        facet_image *fresh;
        assert_int_equal(facet_renderer_render(renderer, &desc, &kept, NULL), FACET_OK);
        assert_int_equal(facet_render(scene, &desc, &fresh, NULL), FACET_OK);
        assert_same_pixels(kept, fresh);
        facet_image_destroy(kept);
        facet_image_destroy(fresh);
    }
    facet_renderer_destroy(renderer);
    facet_scene_destroy(scene);
}

static void expect_error(const facet_scene *scene, const facet_render_desc *desc, const char *part)
{
    facet_image *image = (facet_image *)(void *)&image;
    facet_error error;
    assert_int_equal(facet_render(scene, desc, &image, &error), FACET_ERROR_ARGUMENT);
    assert_null(image);
    if (!strstr(error.message, part))
        fail_msg("\"%s\" does not say \"%s\"", error.message, part);
}

static void what_cannot_be_drawn(void **state)
{
    (void)state;
    facet_scene *scene;
    assert_int_equal(facet_scene_create_builtin(NULL, &scene, NULL), FACET_OK);
    facet_render_desc desc = {.width = 8, .height = 8, .shading = FACET_SHADING_OGL1};
    expect_error(scene, &desc, "facet_scene_convert_materials");
    desc.ogl1.variant = (facet_ogl1_variant)17;
    expect_error(scene, &desc, "variant 17");
    desc = (facet_render_desc){.width = 8, .height = 8, .shading = (facet_shading)5};
    expect_error(scene, &desc, "shading: 5");
    facet_scene_destroy(scene);
    scene = unlit_scene(1.0f, 1.0f, 1.0f, 1.0f);
    desc = (facet_render_desc){
        .width = 8, .height = 8, .shading = FACET_SHADING_OGL1, .background = FACET_BACKGROUND_ENVIRONMENT};
    expect_error(scene, &desc, "background");
    facet_scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(colors_come_back_as_codes),
        cmocka_unit_test(layers_are_blended_as_codes),
        cmocka_unit_test(one_renderer_for_both_models),
        cmocka_unit_test(what_cannot_be_drawn),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
