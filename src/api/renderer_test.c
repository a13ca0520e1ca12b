/* Tests of facet_renderer through facet.h: its images are those of facet_render(), byte for byte. */
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

static void assert_same_image(const facet_image *a, const facet_image *b)
{
    assert_int_equal(facet_image_get_layer_count(a), facet_image_get_layer_count(b));
    for (uint32_t i = 0; i < facet_image_get_layer_count(a); i++) {
        facet_image_view x = facet_image_get_layer(a, i);
        facet_image_view y = facet_image_get_layer(b, i);
        assert_int_equal(x.width, y.width);
        assert_int_equal(x.height, y.height);
        for (uint32_t row = 0; row < x.height; row++)
            assert_memory_equal((const char *)x.pixels + row * x.row_stride_bytes,
                                (const char *)y.pixels + row * y.row_stride_bytes,
                                (size_t)x.width * x.channel_count * sizeof(float));
    }
}

static facet_render_stats compare(const facet_scene *scene, facet_renderer *renderer,
                                  const facet_render_desc *desc)
{
    facet_image *kept;
    facet_image *fresh;
    facet_error error = {0};
    if (facet_renderer_render(renderer, desc, &kept, &error) != FACET_OK)
        fail_msg("%s", error.message);
    assert_int_equal(facet_render(scene, desc, &fresh, &error), FACET_OK);
    assert_same_image(kept, fresh);
    facet_render_stats stats = facet_image_get_render_stats(kept);
    facet_image_destroy(kept);
    facet_image_destroy(fresh);
    return stats;
}

static void a_turntable_of_the_builtin_scene(void **state)
{
    (void)state;
    facet_scene *scene;
    facet_environment *studio;
    facet_renderer *renderer;
    assert_int_equal(facet_scene_create_builtin(NULL, &scene, NULL), FACET_OK);
    assert_int_equal(facet_environment_create_studio(NULL, &studio, NULL), FACET_OK);
    assert_int_equal(facet_renderer_create(scene, NULL, &renderer, NULL), FACET_OK);
    for (int i = 0; i < 4; i++) {
        facet_camera camera;
        facet_orbit orbit = facet_orbit_default();
        orbit.azimuth_rad = 1.6f * (float)i;
        assert_int_equal(facet_camera_from_orbit(scene, NULL, &orbit, 1.0f, &camera, NULL), FACET_OK);
        facet_render_desc desc = {.width = 96,
                                  .height = 96,
                                  .environment = studio,
                                  .camera = i == 2 ? NULL : &camera,
                                  .tonemap = FACET_TONEMAP_ACES,
                                  .background = FACET_BACKGROUND_COLOR,
                                  .aovs = FACET_AOV_DEPTH | FACET_AOV_ALBEDO};
        compare(scene, renderer, &desc);
    }
    compare(scene, renderer, NULL); /* 1024 x 768, black */
    facet_renderer_destroy(renderer);
    facet_environment_destroy(studio);
    facet_scene_destroy(scene);
}

static void count_warning(void *user, facet_log_level level, const char *text)
{
    (void)text;
    *(int *)user += level == FACET_LOG_LEVEL_WARNING;
}

/* 16 times the light is 4 stops; meters_exposure is the exposure that the meter reads; OpenGL 1 has no light. */
static void the_meter_follows_the_light(void **state)
{
    (void)state;
    facet_scene *scene;
    facet_environment *studio;
    facet_renderer *renderer;
    facet_image *images[2];
    double read[3];
    int warnings = 0;
    assert_int_equal(facet_scene_create_builtin(NULL, &scene, NULL), FACET_OK);
    assert_int_equal(facet_environment_create_studio(NULL, &studio, NULL), FACET_OK);
    assert_int_equal(facet_renderer_create(scene, NULL, &renderer, NULL), FACET_OK);
    facet_render_desc desc = {.width = 96,
                              .height = 64,
                              .environment = studio,
                              .tonemap = FACET_TONEMAP_NEUTRAL,
                              .log = {&warnings, count_warning}};
    desc.samples = 2;
    for (int i = 0; i < 2; i++) {
        desc.renderer = i ? FACET_RENDERER_KIND_PATH : FACET_RENDERER_KIND_PREVIEW;
        desc.environment_ev = 0.0f;
        assert_int_equal(facet_renderer_meter(renderer, &desc, &read[0], NULL), FACET_OK);
        desc.environment_ev = 4.0f;
        assert_int_equal(facet_renderer_meter(renderer, &desc, &read[1], NULL), FACET_OK);
        assert_true(read[1] - read[0] > 3.9 && read[1] - read[0] < 4.0); /* one of the spheres emits */
    }
    desc.meters_exposure = true;
    assert_int_equal(facet_renderer_render(renderer, &desc, &images[0], NULL), FACET_OK);
    assert_int_equal(warnings, 0);
    desc.meters_exposure = false;
    desc.exposure_ev = facet_exposure_from_ev100(read[1]);
    assert_int_equal(facet_render(scene, &desc, &images[1], NULL), FACET_OK);
    assert_same_image(images[0], images[1]);
    facet_image_destroy(images[0]);
    facet_image_destroy(images[1]);
    desc.exposure_ev = 0.0f; /* 3 stops beyond white: one warning for all images of a renderer */
    for (int i = 0; i < 2; i++) {
        assert_int_equal(facet_renderer_render(renderer, &desc, &images[0], NULL), FACET_OK);
        facet_image_destroy(images[0]);
    }
    assert_int_equal(warnings, 1);
    desc.shading = FACET_SHADING_OGL1;
    desc.renderer = FACET_RENDERER_KIND_PREVIEW;
    assert_int_equal(facet_renderer_meter(renderer, &desc, &read[2], NULL), FACET_ERROR_ARGUMENT);
    facet_renderer_destroy(renderer);
    facet_environment_destroy(studio);
    facet_scene_destroy(scene);
}

/* Frames of real models: skins, morph targets, rigid parts, materials. */
static void animations_of_models(void **state)
{
    (void)state;
    static const char *const names[] = {
        "Fox", "BoxAnimated", "AnimatedMorphCube", "AnimatedColorsCube", "MorphStressTest", "RiggedSimple"};
    const char *data = test_data();
    facet_environment *studio;
    assert_int_equal(facet_environment_create_studio(NULL, &studio, NULL), FACET_OK);
    for (size_t m = 0; m < sizeof names / sizeof *names; m++) {
        char path[1024];
        facet_error error = {0};
        facet_scene *scene;
        facet_renderer *renderer;
        snprintf(path, sizeof path, "%s/models/animation/%s.glb", data, names[m]);
        if (facet_scene_load(path, NULL, &scene, &error) != FACET_OK)
            fail_msg("%s", error.message);
        assert_int_equal(facet_renderer_create(scene, NULL, &renderer, NULL), FACET_OK);
        assert_true(facet_scene_get_counts(scene).animations > 0);
        facet_animation animation = facet_scene_get_animation(scene, 0);
        for (uint32_t i = 0; i < 5; i++) {
            const uint32_t first = 0;
            facet_render_desc desc = {.width = 80, .height = 60, .environment = studio};
            desc.pose.animation_count = 1;
            desc.pose.animations = &first;
            desc.pose.time_s = animation.begin_s + (animation.end_s - animation.begin_s) * 0.23 * i;
            desc.thread_count = 1 + i % 2;
            facet_render_stats stats = compare(scene, renderer, &desc);
            assert_true(i == 0 || stats.decoded_texels == 0 || strcmp(names[m], "Fox") == 0);
            desc.pose = (facet_pose_desc){0}; /* at rest between frames */
            if (i == 3)
                compare(scene, renderer, &desc);
        }
        facet_renderer_destroy(renderer);
        facet_scene_destroy(scene);
    }
    facet_environment_destroy(studio);
}

static void a_renderer_fits_into_a_budget_or_fails(void **state)
{
    (void)state;
    facet_scene *scene;
    assert_int_equal(facet_scene_create_builtin(NULL, &scene, NULL), FACET_OK);
    for (uint64_t limit = 100; limit < 200000000; limit *= 3) {
        facet_budget *budget;
        assert_int_equal(facet_budget_create(limit, &budget, NULL), FACET_OK);
        facet_allocator allocator = facet_budget_allocator(budget);
        facet_renderer *renderer = NULL;
        facet_error error;
        facet_result result = facet_renderer_create(scene, &allocator, &renderer, &error);
        assert_int_equal(result == FACET_OK, renderer != NULL);
        for (uint32_t i = 0; i < 3 && renderer; i++) {
            facet_image *image = NULL;
            facet_render_desc desc = {.allocator = allocator, .width = 64 + 8 * i, .height = 48};
            result = facet_renderer_render(renderer, &desc, &image, &error);
            assert_true(result == FACET_OK || result == FACET_ERROR_MEMORY);
            assert_int_equal(result == FACET_OK, image != NULL);
            assert_true(facet_budget_peak_bytes(budget) <= limit);
            facet_image_destroy(image);
        }
        facet_renderer_destroy(renderer);
        assert_int_equal(facet_budget_used_bytes(budget), 0);
        facet_budget_destroy(budget);
        if (result == FACET_OK) {
            facet_scene_destroy(scene);
            return;
        }
    }
    fail_msg("200 MB are not enough for the built-in scene");
}

/* Between images parts move, and scenes are appended and converted; the last change comes before the end. */
static void scenes_change_between_images(void **state)
{
    (void)state;
    for (int kind = 0; kind <= FACET_RENDERER_KIND_GL; kind++) {
        facet_scene *scene, *other;
        facet_renderer *renderer;
        facet_image *first;
        facet_error error;
        float matrix[16] = {[0] = 1, [5] = 1, [10] = 1, [15] = 1, [12] = 0.5f};
        const facet_render_desc desc = {.width = 40,
                                        .height = 30,
                                        .samples = 1,
                                        .renderer = (facet_renderer_kind)kind,
                                        .sun = {.elevation_rad = 1, .illuminance_lux = {3, 3, 3}},
                                        .aovs = FACET_AOV_DEPTH};
        assert_int_equal(facet_scene_create_builtin(NULL, &scene, NULL), FACET_OK);
        assert_int_equal(facet_renderer_create(scene, NULL, &renderer, NULL), FACET_OK);
        facet_result result = facet_renderer_render(renderer, &desc, &first, &error);
        facet_image_destroy(first);
        bool is_there = result != FACET_ERROR_SYSTEM || kind != FACET_RENDERER_KIND_GL;
        if (!is_there)
            print_message("OpenGL: skipped: %s\n", error.message);
        for (int i = 0; i < 3 && is_there; i++) {
            assert_int_equal(facet_scene_create_builtin(NULL, &other, NULL), FACET_OK);
            assert_int_equal(facet_scene_append(scene, other, NULL), FACET_OK);
            if (i == 2) /* the renderer is destroyed with what it has made of less */
                break;
            compare(scene, renderer, &desc);
            matrix[13] += 1.5f;
            assert_int_equal(facet_scene_place_part(scene, 1, matrix, NULL), FACET_OK);
            compare(scene, renderer, &desc);
            assert_int_equal(
                facet_scene_convert_materials(scene, FACET_MATERIAL_MODEL_OGL1, NULL, NULL, NULL), FACET_OK);
            compare(scene, renderer, &desc);
            assert_int_equal(facet_scene_choose_origin(scene, NULL, NULL), FACET_OK);
            compare(scene, renderer, &desc);
        }
        facet_renderer_destroy(renderer);
        facet_scene_destroy(scene);
    }
}

static bool refuse(void *user, const char *stage, double fraction)
{
    (void)user;
    (void)stage;
    return fraction < 0.5;
}

static void after_a_cancelled_image_others_follow(void **state)
{
    (void)state;
    facet_scene *scene;
    facet_renderer *renderer;
    facet_image *image;
    assert_int_equal(facet_scene_create_builtin(NULL, &scene, NULL), FACET_OK);
    assert_int_equal(facet_renderer_create(scene, NULL, &renderer, NULL), FACET_OK);
    facet_render_desc desc = {.width = 128, .height = 96};
    facet_render_desc cancelled = desc;
    cancelled.progress.report = refuse;
    for (int i = 0; i < 2; i++) {
        assert_int_equal(facet_renderer_render(renderer, &cancelled, &image, NULL), FACET_ERROR_CANCELLED);
        assert_null(image);
        compare(scene, renderer, &desc);
    }
    facet_renderer_destroy(renderer);
    facet_scene_destroy(scene);
}

/* Refuses from the share *user on. */
static bool refuse_from(void *user, const char *stage, double fraction)
{
    return strcmp(stage, "sample") != 0 || fraction < *(const double *)user;
}

/* A path traced image that is cancelled late is what there is so far; one that is cancelled at once is none. */
static void a_cancelled_path_trace_is_partial(void **state)
{
    (void)state;
    facet_scene *scene;
    facet_image *image;
    double from = 0.3;
    assert_int_equal(facet_scene_create_builtin(NULL, &scene, NULL), FACET_OK);
    facet_render_desc desc = {.width = 32,
                              .height = 24,
                              .samples = 64,
                              .renderer = FACET_RENDERER_KIND_PATH,
                              .progress = {.user = &from, .report = refuse_from}};
    assert_int_equal(facet_render(scene, &desc, &image, NULL), FACET_ERROR_CANCELLED);
    desc.path.keeps_cancelled = true;
    assert_int_equal(facet_render(scene, &desc, &image, NULL), FACET_OK);
    facet_render_stats stats = facet_image_get_render_stats(image);
    assert_true(stats.is_partial);
    assert_true(stats.samples >= 32 * 24 && stats.samples < 64 * 32 * 24);
    facet_image_destroy(image);
    from = 0.0;
    facet_error error;
    assert_int_equal(facet_render(scene, &desc, &image, &error), FACET_ERROR_CANCELLED);
    assert_null(image);
    assert_non_null(strstr(error.message, "before every pixel had a sample"));
    facet_scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_turntable_of_the_builtin_scene),
        cmocka_unit_test(the_meter_follows_the_light),
        cmocka_unit_test(animations_of_models),
        cmocka_unit_test(scenes_change_between_images),
        cmocka_unit_test(a_renderer_fits_into_a_budget_or_fails),
        cmocka_unit_test(after_a_cancelled_image_others_follow),
        cmocka_unit_test(a_cancelled_path_trace_is_partial),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
