/* convert_robust_test.c - conversions of whole scenes: equal for any number of threads, complete or not at
 * all if memory runs out, each distinct material solved once. */
#include "tests/support/support.h"
#include "legacy/convert_test_support.h"

#include "base/clock.h"

static const uint8_t WOOD[] = {200, 150, 100, 180, 120, 80, 90, 60, 30, 250, 240, 230};
static const uint8_t FADE[] = {255, 128, 64, 0};

/* Materials of all kinds: with and without maps, PBR statements, glass, lights. False: no memory. */
static bool fill(facet_scene *scene)
{
    legacy_material *m = scene->legacy->materials;
    uint32_t wood = add_texels(scene, 2, 2, 3, WOOD);
    uint32_t fade = add_texels(scene, 2, 2, 1, FADE);
    legacy_light *lights = arena_zalloc(scene->arena, 1, sizeof *lights);
    if (wood == SCENE_NONE || fade == SCENE_NONE || !lights)
        return false;
    lights[0] = legacy_light_default();
    scene->legacy->lights = lights;
    scene->legacy->light_count = 1;
    for (uint32_t i = 0; i < scene->material_count; i++) {
        m[i].fields = LEGACY_DIFFUSE | LEGACY_SPECULAR | LEGACY_SHININESS | LEGACY_AMBIENT;
        set_color(m[i].diffuse, .1f * (float)(i % 7), .5f, .3f);
        set_color(m[i].specular, .2f, .05f * (float)(i % 11), .1f);
        set_color(m[i].ambient, .1f, .1f, .1f);
        m[i].shininess = 5 + (float)(i % 13) * 9;
        if (i % 6 == 1)
            set_map(&m[i], LEGACY_DIFFUSE_MAP, wood);
        if (i % 6 == 2)
            set_map(&m[i], LEGACY_SPECULAR_MAP, wood);
        if (i % 6 == 3)
            set_map(&m[i], LEGACY_SHININESS_MAP, fade);
        if (i % 6 == 4)
            set_map(&m[i], LEGACY_OPACITY_MAP, fade);
        if (i % 6 == 5)
            set_map(&m[i], LEGACY_BUMP_MAP, fade);
    }
    return true;
}

static bool same_bytes(const facet_scene *a, const facet_scene *b)
{
    bool is_same = a->material_count == b->material_count && a->image_count == b->image_count;
    for (uint32_t i = 0; i < a->material_count && is_same; i++) {
        const facet_conversion *c = &a->conversion->materials[i].summary;
        const facet_conversion *d = &b->conversion->materials[i].summary;
        is_same &= memcmp(a->materials[i].base_color, b->materials[i].base_color, 4 * sizeof(float)) == 0;
        is_same &= a->materials[i].perceptual_roughness == b->materials[i].perceptual_roughness;
        is_same &= a->materials[i].specular == b->materials[i].specular;
        is_same &= strcmp(a->materials[i].meta.extras, b->materials[i].meta.extras) == 0;
        is_same &= c->error == d->error && c->error_display == d->error_display;
    }
    for (uint32_t i = 0; i < a->image_count && is_same; i++)
        is_same = a->images[i].size == b->images[i].size &&
                  memcmp(a->images[i].bytes, b->images[i].bytes, a->images[i].size) == 0;
    return is_same;
}

static void results_do_not_depend_on_threads(void **state)
{
    (void)state;
    facet_scene *scenes[2];
    for (int i = 0; i < 2; i++) {
        scenes[i] = legacy_scene(40);
        assert_true(fill(scenes[i]));
        scenes[i]->thread_count = i == 0 ? 1 : 7;
        convert(scenes[i], &(facet_legacy_desc){0});
    }
    assert_true(scenes[0]->image_count > 6);
    assert_true(same_bytes(scenes[0], scenes[1]));
    scene_destroy(scenes[0]);
    scene_destroy(scenes[1]);
}

/* Every allocation fails once: the call fails with FACET_ERROR_MEMORY, nothing leaks, the materials are
 * unchanged. */
static void run_out(facet_material_model to, bool is_legacy, const facet_legacy_desc *desc)
{
    for (long at = 0;; at = next_failure(at)) {
        failing_allocator failing = {.fail_at = -1};
        facet_allocator allocator = failing_allocator_get(&failing);
        facet_scene *scene = legacy_scene_in(&allocator, 6);
        assert_non_null(scene);
        scene->thread_count = 1;
        assert_true(fill(scene));
        if (!is_legacy) {
            scene->legacy = NULL;
            scene->materials[1].textures[SCENE_BASE_COLOR_TEXTURE].texture = 0;
            scene->materials[2].textures[SCENE_METALLIC_ROUGHNESS_TEXTURE].texture = 0;
            scene->materials[3].extensions = SCENE_SPECULAR_GLOSSINESS;
            scene->materials[3].textures[SCENE_SPECULAR_GLOSSINESS_TEXTURE].texture = 0;
        }
        const scene_material *before = scene->materials;
        const uint32_t images = scene->image_count;
        failing.fail_at = atomic_load(&failing.calls) + at;
        facet_result result = legacy_convert(scene, to, desc, &(facet_log){0}, NULL);
        bool has_failed = atomic_load(&failing.calls) > failing.fail_at;
        /* A warning without memory does not stop a conversion. */
        if (result == FACET_ERROR_MEMORY) {
            assert_true(has_failed);
            assert_ptr_equal(scene->materials, before);
            assert_int_equal(scene->image_count, images);
            assert_null(scene->conversion);
        } else {
            assert_int_equal(result, FACET_OK);
            assert_non_null(scene->conversion);
        }
        failing.fail_at = -1;
        scene_destroy(scene);
        assert_int_equal(atomic_load(&failing.blocks), 0);
        if (!has_failed)
            break;
        assert_true(at < 10000);
    }
}

static void failed_allocations_are_reported(void **state)
{
    (void)state;
    run_out(FACET_MATERIAL_MODEL_METALLIC_ROUGHNESS, true, &(facet_legacy_desc){0});
    run_out(FACET_MATERIAL_MODEL_METALLIC_ROUGHNESS, true,
            &(facet_legacy_desc){.profile = FACET_LEGACY_PROFILE_CORE});
    run_out(FACET_MATERIAL_MODEL_OGL1, false,
            &(facet_legacy_desc){.bakes_occlusion = true, .target = FACET_LEGACY_TARGET_LINEAR});
    run_out(FACET_MATERIAL_MODEL_METALLIC_ROUGHNESS, false, &(facet_legacy_desc){0});
    run_out(FACET_MATERIAL_MODEL_SPECULAR_GLOSSINESS, false, &(facet_legacy_desc){0});
}

/* Equal materials need one fit: ten thousand of five kinds take the time of five. */
static void equal_materials_are_solved_once(void **state)
{
    (void)state;
    enum { COUNT = IS_SLOW ? 1000 : 10000 };
    facet_scene *scene = legacy_scene(COUNT);
    for (uint32_t i = 0; i < COUNT; i++) {
        legacy_material *m = &scene->legacy->materials[i];
        m->fields = LEGACY_DIFFUSE | LEGACY_SPECULAR | LEGACY_SHININESS;
        set_color(m->diffuse, .1f * (float)(i % 5), .5f, .3f);
        set_color(m->specular, .2f, .2f, .2f);
        m->shininess = 40;
    }
    double begin = clock_seconds();
    convert(scene, &(facet_legacy_desc){.method = FACET_LEGACY_METHOD_FIT});
    double seconds = clock_seconds() - begin;
    print_message("%d materials of 5 kinds fitted in %.3f s\n", COUNT, seconds);
    /* A fit takes milliseconds, which would be half a minute for all. */
    assert_true(seconds < 15);
    for (uint32_t i = 5; i < COUNT; i++)
        assert_near(scene->materials[i].perceptual_roughness, scene->materials[i % 5].perceptual_roughness,
                    0);
    scene_destroy(scene);
}

static void many_different_materials_are_solved(void **state)
{
    (void)state;
    enum { COUNT = IS_SLOW ? 300 : 3000 };
    facet_scene *scene = legacy_scene(COUNT);
    for (uint32_t i = 0; i < COUNT; i++) {
        legacy_material *m = &scene->legacy->materials[i];
        m->fields = LEGACY_DIFFUSE | LEGACY_SPECULAR | LEGACY_SHININESS;
        set_color(m->diffuse, (float)i / COUNT, .5f, .3f);
        set_color(m->specular, .2f, .2f, .2f);
        m->shininess = 40;
    }
    double begin = clock_seconds();
    convert(scene, &(facet_legacy_desc){0});
    print_message("%d different materials converted in %.3f s\n", COUNT, clock_seconds() - begin);
    assert_true(scene->conversion->materials[COUNT - 1].summary.error > 0);
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(results_do_not_depend_on_threads),
        cmocka_unit_test(failed_allocations_are_reported),
        cmocka_unit_test(equal_materials_are_solved_once),
        cmocka_unit_test(many_different_materials_are_solved),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
