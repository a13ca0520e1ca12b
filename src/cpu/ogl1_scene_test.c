/* Tests of FACET_SHADING_OGL1: reuse between images, independence of glTF, unsupported scenes. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

#include "tests/support/support.h"
#include "cpu/ogl1_fixture.h"
#include "cpu/prepared_scene.h"
#include "cpu/preview.h"

/* ---- sameness ---- */

/* Transparent, textured, mapped, fogged, under all kinds of light. */
static fixture busy_scene(void)
{
    scene_legacy *legacy;
    fixture f = ogl1_fixture_head_on(&legacy);
    f.camera = (facet_camera){.eye = {1.0f, 2.0f, 9.0f}, .fov_y_rad = 0.4f};
    f.desc.width = 90;
    f.desc.height = 70;
    f.desc.samples = 4;
    f.desc.aovs = FACET_AOV_NORMAL | FACET_AOV_ALBEDO;
    unsigned char texels[4 * 64];
    for (uint32_t i = 0; i < sizeof texels; i++)
        texels[i] = (unsigned char)(i * 37 % 251);
    uint32_t texture = fixture_add_texture(&f, 8, 8, texels);
    for (uint32_t i = 0; i < 4; i++) {
        scene_material gltf = scene_material_default();
        gltf.alpha_mode = SCENE_ALPHA_BLEND;
        gltf.base_color[3] = 0.5f;
        gltf.textures[SCENE_NORMAL_TEXTURE].texture = texture;
        fixture_add_material(&f, gltf);
        legacy_material *m = &legacy->materials[i];
        m->specular[i % 3] = 1.0f;
        m->shininess = 30.0f;
        m->opacity = i ? 1.0f : 0.5f;
        m->texture_type = i == 1 ? LEGACY_RGBA : LEGACY_RGB;
        m->has_environment_map = i == 2;
        if (i)
            m->maps[LEGACY_DIFFUSE_MAP].ref.texture = texture;
        if (i == 3)
            m->maps[LEGACY_NORMAL_MAP].ref.texture = texture;
    }
    legacy->light_count = 2;
    legacy->lights[1] = legacy_light_default();
    legacy->lights[1].is_point = true;
    legacy->fog = (legacy_fog){.mode = LEGACY_FOG_EXP, .color = {0.5f, 0.6f, 0.7f}, .scale = 1.0f};
    for (uint32_t i = 0; i < 4; i++) {
        fixture_place(&f, fixture_add_sphere(&f, 48, i), (float)i - 1.5f, 0.0f, 0.3f * (float)i, 0.8f);
        fixture_place(&f, fixture_add_quad(&f, i), (float)i - 1.5f, 0.2f, 0.5f, 0.7f);
    }
    return f;
}

static void images_do_not_depend_on_threads(void **state)
{
    (void)state;
    for (int variant = 0; variant < 4; variant++) {
        static const uint32_t threads[] = {2, 3, 8};
        fixture f = busy_scene();
        f.desc.ogl1.variant = (facet_ogl1_variant)variant;
        f.desc.thread_count = 1;
        film first = fixture_render(&f);
        for (int i = 0; i < 3; i++) {
            f.desc.thread_count = threads[i];
            film rendered = fixture_render(&f);
            fixture_assert_same(&first, &rendered);
            film_destroy(&rendered);
        }
        film_destroy(&first);
        fixture_destroy(&f);
    }
}

/* One prepared scene rendered alternately in both models gives the images of new ones. */
static void models_take_turns(void **state)
{
    (void)state;
    fixture f = busy_scene();
    prepared_scene prepared;
    prepared_scene_init(&prepared, f.scene, NULL);
    for (int i = 0; i < 6; i++) {
        f.desc.shading = i % 3 == 1 ? FACET_SHADING_GLTF : FACET_SHADING_OGL1;
        f.desc.ogl1.is_linear = i == 3;
        film fresh = fixture_render(&f), kept;
        facet_render_desc desc = f.desc;
        facet_render_stats stats;
        desc.camera = &f.camera;
        desc.crop[2] = desc.width;
        desc.crop[3] = desc.height;
        assert_int_equal(film_create(NULL, desc.width, desc.height, desc.aovs, &kept, NULL), FACET_OK);
        assert_int_equal(preview_render_prepared(&prepared, &desc, &kept, &stats, NULL), FACET_OK);
        fixture_assert_same(&fresh, &kept);
        film_destroy(&fresh);
        film_destroy(&kept);
    }
    prepared_scene_clear(&prepared);
    fixture_destroy(&f);
}

/* An environment is not prepared, which glTF would. */
static void environments_are_left_alone(void **state)
{
    (void)state;
    uint64_t used[3];
    facet_budget *budget;
    assert_int_equal(facet_budget_create(0, &budget, NULL), FACET_OK);
    fixture f = busy_scene();
    const float radiance[3] = {1.0f, 1.0f, 1.0f};
    facet_environment_desc desc = {.allocator = facet_budget_allocator(budget)};
    assert_int_equal(facet_environment_create_constant(radiance, &desc, &f.environment, NULL), FACET_OK);
    used[0] = facet_budget_used_bytes(budget);
    film with = fixture_render(&f);
    used[1] = facet_budget_used_bytes(budget);
    f.desc.shading = FACET_SHADING_GLTF;
    film gltf = fixture_render(&f);
    used[2] = facet_budget_used_bytes(budget);
    assert_true(used[1] == used[0] && used[2] > used[0]);
    f.desc.shading = FACET_SHADING_OGL1;
    facet_environment_destroy(f.environment);
    f.environment = NULL;
    film without = fixture_render(&f);
    fixture_assert_same(&with, &without);
    film_destroy(&with);
    film_destroy(&without);
    film_destroy(&gltf);
    fixture_destroy(&f);
    facet_budget_destroy(budget);
}

/* ---- unsupported scenes ---- */

static void errors_say_what_to_do(void **state)
{
    (void)state;
    fixture f = busy_scene();
    film rendered;
    facet_render_stats stats;
    facet_error error;
    f.desc.background = FACET_BACKGROUND_ENVIRONMENT;
    assert_int_equal(fixture_try_render(&f, &rendered, &stats, &error), FACET_ERROR_ARGUMENT);
    assert_non_null(strstr(error.message, "background: OpenGL 1"));
    film_destroy(&rendered);
    f.desc.background = FACET_BACKGROUND_TRANSPARENT;
    f.scene->legacy = NULL;
    assert_int_equal(fixture_try_render(&f, &rendered, &stats, &error), FACET_ERROR_ARGUMENT);
    assert_non_null(strstr(error.message, "facet_scene_convert_materials"));
    film_destroy(&rendered);
    f.desc.shading = FACET_SHADING_GLTF;
    assert_int_equal(fixture_try_render(&f, &rendered, &stats, &error), FACET_OK);
    film_destroy(&rendered);
    fixture_destroy(&f);
}

static void running_out_of_memory_leaks_nothing(void **state)
{
    (void)state;
    fixture f = busy_scene();
    f.desc.width = f.desc.height = 24;
    f.desc.thread_count = 1;
    for (long fail_at = 0;; fail_at = next_failure(fail_at)) {
        failing_allocator memory = {.fail_at = fail_at};
        f.desc.allocator = failing_allocator_get(&memory);
        film rendered = {0};
        facet_render_stats stats;
        facet_error error;
        facet_result result = fixture_try_render(&f, &rendered, &stats, &error);
        film_destroy(&rendered);
        assert_int_equal(memory.blocks, 0);
        assert_true(result == FACET_OK || result == FACET_ERROR_MEMORY);
        if (memory.calls <= fail_at) {
            assert_int_equal(result, FACET_OK);
            break;
        }
    }
    fixture_destroy(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(images_do_not_depend_on_threads),     cmocka_unit_test(models_take_turns),
        cmocka_unit_test(environments_are_left_alone),         cmocka_unit_test(errors_say_what_to_do),
        cmocka_unit_test(running_out_of_memory_leaks_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
