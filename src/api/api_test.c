/* Tests of facet.h through the public header only. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "facet/facet.h"

/* Two scenes, the default one second: an unlit red triangle, and an unlit green one beside it. */
static const char two_scenes[] =
    "{\"asset\":{\"version\":\"2.0\"},\"scene\":1,\"scenes\":[{\"name\":\"red\",\"nodes\":[0]},{\"name\":"
    "\"green\","
    "\"nodes\":[1]}],\"nodes\":[{\"mesh\":0},{\"mesh\":1}],\"cameras\":[{\"name\":\"Hero\",\"type\":"
    "\"perspective\","
    "\"perspective\":{\"yfov\":1,\"znear\":0.1}}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":"
    "0},"
    "\"material\":0}]},{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"material\":1}]}],\"materials\":"
    "[{\"pbrMetallicRoughness\":{\"baseColorFactor\":[1,0,0,1]},\"extensions\":{\"KHR_materials_unlit\":{}}},"
    "{\"pbrMetallicRoughness\":{\"baseColorFactor\":[0,1,0,1]},\"extensions\":{\"KHR_materials_unlit\":{}}}],"
    "\"extensionsUsed\":[\"KHR_materials_unlit\"],\"accessors\":[{\"bufferView\":0,\"componentType\":5126,"
    "\"count\":3,"
    "\"type\":\"VEC3\",\"min\":[0,0,0],\"max\":[1,1,0]}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],"
    "\"buffers\":"
    "[{\"byteLength\":36,\"uri\":\"data:application/octet-stream;base64,"
    "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"}]}";

static facet_scene *load_two_scenes(void)
{
    facet_scene *scene = NULL;
    facet_error error;
    if (facet_scene_load_memory(two_scenes, sizeof two_scenes - 1, "two.gltf", NULL, &scene, &error) !=
        FACET_OK)
        fail_msg("%s", error.message);
    return scene;
}

/* The sum of the image's channels. */
static void sum_of(const facet_image *image, double sum[4])
{
    facet_image_view view = facet_image_get_layer(image, 0);
    memset(sum, 0, 4 * sizeof *sum);
    for (size_t i = 0; i < (size_t)view.width * view.height * 4; i++)
        sum[i % 4] += (double)view.pixels[i];
}

static void zero_desc_draws_the_default_scene(void **state)
{
    (void)state;
    facet_scene *scene = load_two_scenes();
    facet_image *image = NULL;
    double sum[4];
    assert_int_equal(facet_render(scene, &(facet_render_desc){.width = 32, .height = 32}, &image, NULL),
                     FACET_OK);
    sum_of(image, sum);
    assert_true(sum[0] == 0.0 && sum[1] > 50.0 && sum[3] > 50.0);
    facet_image_destroy(image);
    facet_render_desc first = {.width = 32, .height = 32, .pose = {.has_scene_index = true}};
    assert_int_equal(facet_render(scene, &first, &image, NULL), FACET_OK);
    sum_of(image, sum);
    assert_true(sum[0] > 50.0 && sum[1] == 0.0);
    facet_image_destroy(image);
    facet_render_desc missing = {
        .width = 32, .height = 32, .pose = {.has_scene_index = true, .scene_index = 2}};
    assert_int_equal(facet_render(scene, &missing, &image, NULL), FACET_ERROR_ARGUMENT);
    assert_null(image);
    facet_scene_destroy(scene);
}

static void names_and_numbers_are_found(void **state)
{
    (void)state;
    facet_scene *scene = load_two_scenes();
    facet_error error;
    uint32_t index = 9;
    assert_int_equal(facet_scene_find_scene(scene, "green", &index, &error), FACET_OK);
    assert_int_equal(index, 1);
    assert_int_equal(facet_scene_find_scene(scene, "0", &index, &error), FACET_OK);
    assert_int_equal(index, 0);
    assert_int_equal(facet_scene_find_scene(scene, "2", &index, &error), FACET_ERROR_ARGUMENT);
    assert_non_null(strstr(error.message, "\"red\""));
    assert_int_equal(facet_scene_find_camera(scene, "Hero", &index, &error), FACET_OK);
    facet_camera camera;
    assert_int_equal(facet_camera_from_scene(scene, 0, 0, &camera, &error),
                     FACET_ERROR_ARGUMENT); /* no node has it */
    assert_int_equal(facet_camera_from_scene(scene, 0, 7, &camera, &error), FACET_ERROR_ARGUMENT);
    facet_scene_destroy(scene);
}

static void layers_are_those_asked_for(void **state)
{
    (void)state;
    facet_scene *scene = load_two_scenes();
    facet_image *image = NULL;
    facet_render_desc desc = {.width = 16, .height = 8, .aovs = FACET_AOV_DEPTH | FACET_AOV_NORMAL};
    assert_int_equal(facet_render(scene, &desc, &image, NULL), FACET_OK);
    assert_int_equal(facet_image_get_layer_count(image), 3);
    facet_image_view depth = facet_image_get_layer(image, 1);
    assert_string_equal(depth.name, "depth");
    assert_int_equal(depth.channel_count, 1);
    assert_true(isinf(depth.pixels[0]));
    assert_true(isfinite(depth.pixels[(depth.height / 2) * depth.width + depth.width / 2]));
    facet_render_stats stats = facet_image_get_render_stats(image);
    assert_true(stats.rays >= 16 * 8 * 4 && stats.total_s > 0.0 && stats.thread_count >= 1);
    facet_image_destroy(image);
    facet_scene_destroy(scene);
}

static void every_format_is_written(void **state)
{
    (void)state;
    static const struct {
        facet_image_format format;
        const char *magic;
    } formats[] = {{FACET_IMAGE_FORMAT_PNG, "\x89PNG"},
                   {FACET_IMAGE_FORMAT_PNG16, "\x89PNG"},
                   {FACET_IMAGE_FORMAT_JPEG, "\xff\xd8\xff"},
                   {FACET_IMAGE_FORMAT_HDR, "#?"},
                   {FACET_IMAGE_FORMAT_PFM, "PF"},
                   {FACET_IMAGE_FORMAT_EXR, "\x76\x2f\x31\x01"},
                   {FACET_IMAGE_FORMAT_EXR_FLOAT, "\x76\x2f\x31\x01"},
                   {FACET_IMAGE_FORMAT_WEBP, "RIFF"}};
    facet_scene *scene = load_two_scenes();
    facet_image *image = NULL;
    assert_int_equal(facet_render(scene, &(facet_render_desc){.width = 9, .height = 7}, &image, NULL),
                     FACET_OK);
    for (size_t i = 0; i < sizeof formats / sizeof *formats; i++) {
        unsigned char *bytes;
        size_t size;
        facet_error error;
        facet_result result = facet_image_encode(image, &(facet_image_save_desc){.format = formats[i].format},
                                                 &bytes, &size, &error);
        if (result == FACET_ERROR_UNSUPPORTED) { /* built without that library */
            assert_true(bytes == NULL && strlen(error.message) > 10);
            continue;
        }
        assert_int_equal(result, FACET_OK);
        assert_true(size > 8 && memcmp(bytes, formats[i].magic, strlen(formats[i].magic)) == 0);
        facet_bytes_destroy(bytes);
    }
    facet_error error;
    assert_int_equal(facet_image_save(image, "image.tiff", NULL, &error), FACET_ERROR_ARGUMENT);
    assert_non_null(strstr(error.message, "image.tiff"));
    assert_non_null(strstr(error.message, ".png"));
    facet_image_destroy(image);
    facet_scene_destroy(scene);
}

static bool stop_at_once(void *user, const char *stage, double fraction)
{
    (void)stage;
    (void)fraction;
    ++*(int *)user;
    return false;
}

static void a_render_can_be_cancelled(void **state)
{
    (void)state;
    facet_scene *scene = load_two_scenes();
    facet_image *image = NULL;
    int calls = 0;
    facet_render_desc desc = {.progress = {.user = &calls, .report = stop_at_once}};
    assert_int_equal(facet_render(scene, &desc, &image, NULL), FACET_ERROR_CANCELLED);
    assert_null(image);
    assert_true(calls >= 1);
    facet_scene_destroy(scene);
}

static void everything_fits_into_a_budget_or_fails(void **state)
{
    (void)state;
    for (uint64_t limit = 1000; limit < 200000000; limit *= 3) {
        facet_budget *budget;
        assert_int_equal(facet_budget_create(limit, &budget, NULL), FACET_OK);
        facet_allocator allocator = facet_budget_allocator(budget);
        facet_scene *scene = NULL;
        facet_environment *studio = NULL;
        facet_image *image = NULL;
        facet_error error;
        facet_result result =
            facet_scene_create_builtin(&(facet_scene_desc){.allocator = allocator}, &scene, &error);
        if (result == FACET_OK)
            result = facet_environment_create_studio(&(facet_environment_desc){.allocator = allocator},
                                                     &studio, &error);
        facet_render_desc desc = {.allocator = allocator, .width = 64, .height = 48, .environment = studio};
        if (result == FACET_OK)
            result = facet_render(scene, &desc, &image, &error);
        assert_true(result == FACET_OK || result == FACET_ERROR_MEMORY);
        assert_int_equal(result == FACET_OK, image != NULL);
        assert_true(facet_budget_peak_bytes(budget) <= limit);
        facet_image_destroy(image);
        facet_environment_destroy(studio);
        facet_scene_destroy(scene);
        assert_int_equal(facet_budget_used_bytes(budget), 0);
        facet_budget_destroy(budget);
        if (result == FACET_OK)
            return;
    }
    fail_msg("200 MB are not enough for the built-in scene");
}

static void small_questions_are_answered(void **state)
{
    (void)state;
    char text[64];
    size_t length = facet_build_report(NULL, 0);
    assert_true(length > sizeof text);
    assert_int_equal(facet_build_report(text, sizeof text), length);
    assert_int_equal(strlen(text), sizeof text - 1);
    assert_memory_equal(text, "facet ", 6);
    char version[32];
    snprintf(version, sizeof version, "%d.%d.%d", FACET_VERSION_MAJOR, FACET_VERSION_MINOR,
             FACET_VERSION_PATCH);
    assert_string_equal(facet_version(), version);
    for (uint32_t i = 0; i < facet_get_library_count(); i++) {
        facet_library_info library = facet_get_library(i);
        assert_true(*library.name && *library.license);
        assert_true(*library.built_version || !*library.found_version);
        assert_true(library.file || strcmp(library.built_version, library.found_version) == 0);
    }
    assert_float_equal(facet_linear_from_srgb(0.5f), 0.21404114f, 1e-7f);
    assert_float_equal(facet_linear_from_srgb(0.04045f), 0.04045f / 12.92f, 1e-8f);
    facet_scene_destroy(NULL);
    facet_environment_destroy(NULL);
    facet_image_destroy(NULL);
    facet_budget_destroy(NULL);
    facet_text_destroy(NULL);
    facet_bytes_destroy(NULL);
}

/* NULL in the place of a desc is {0}: no function reads it. */
static void a_desc_may_be_null(void **state)
{
    (void)state;
    facet_error error;
    facet_image *image;
    facet_cube *cube;
    facet_sea *sea;
    facet_environment *environment;
    unsigned char *bytes;
    size_t size;
    float coefficients[9][3];
    double ev100;
    assert_int_equal(facet_dfg_bake(NULL, &image, NULL), FACET_OK);
    assert_int_equal(facet_image_encode(image, NULL, &bytes, &size, &error), FACET_ERROR_ARGUMENT);
    assert_null(bytes);
    assert_int_equal(facet_image_encode_ktx2(image, NULL, &bytes, &size, NULL), FACET_OK);
    facet_bytes_destroy(bytes);
    facet_image_destroy(image);
    assert_int_equal(facet_environment_create_studio(NULL, &environment, NULL), FACET_OK);
    assert_int_equal(facet_environment_project_sh(environment, NULL, coefficients, NULL), FACET_OK);
    assert_int_equal(facet_cube_bake(environment, NULL, &cube, NULL), FACET_OK);
    assert_int_equal(facet_cube_encode_ktx2(cube, NULL, &bytes, &size, NULL), FACET_OK);
    facet_bytes_destroy(bytes);
    assert_int_equal(facet_cube_encode_ktx1(cube, NULL, &bytes, &size, NULL), FACET_OK);
    facet_bytes_destroy(bytes);
    facet_cube_destroy(cube);
    facet_environment_destroy(environment);
    assert_int_equal(facet_sea_create(NULL, &sea, NULL), FACET_OK);
    assert_int_equal(facet_sea_meter(sea, NULL, &ev100, NULL), FACET_OK);
    facet_sea_destroy(sea);
    assert_int_equal(facet_shader_text(NULL, &bytes, &size, NULL), FACET_OK);
    facet_bytes_destroy(bytes);
    facet_scene *scene;
    assert_int_equal(facet_scene_create_builtin(NULL, &scene, NULL), FACET_OK);
    assert_int_equal(facet_scene_save(scene, "no/such/folder/a.glb", NULL, &error), FACET_ERROR_WRITE);
    facet_scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(zero_desc_draws_the_default_scene),
        cmocka_unit_test(names_and_numbers_are_found),
        cmocka_unit_test(layers_are_those_asked_for),
        cmocka_unit_test(every_format_is_written),
        cmocka_unit_test(a_render_can_be_cancelled),
        cmocka_unit_test(a_desc_may_be_null),
        cmocka_unit_test(everything_fits_into_a_budget_or_fails),
        cmocka_unit_test(small_questions_are_answered),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
