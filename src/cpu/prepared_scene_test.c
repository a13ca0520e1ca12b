/* prepared_scene_test.c - data kept from image to image: each image is bit for bit that of a separate render,
 * and unchanged data are not rebuilt. prepared_failure_test.c has failures. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "tests/support/support.h"
#include "base/memory.h"
#include "cpu/embree_scene.h"
#include "cpu/prepared_fixture.h"

static const embree_scene *embree_of(const prepared_scene *p)
{
    const ray_tracer *tracer = NULL;
    assert_int_equal(embree_find_tracer(&tracer, NULL), FACET_OK);
    assert_ptr_equal(p->rays.tracer, tracer);
    return p->rays.bvh;
}

/* ---- views ---- */

static void turntables_keep_everything_but_the_camera(void **state)
{
    (void)state;
    for (int has_sprites = 0; has_sprites < 2; has_sprites++) {
        fixture f = prepared_still_scene();
        if (!has_sprites)
            f.scene->node_count -= 3; /* lines, points, the light */
        prepared_scene p;
        prepared_scene_init(&p, f.scene, NULL);
        RTCScene first = NULL;
        for (int i = 0; i < 8; i++) {
            prepared_orbit(&f, 0.8f * (float)i, 5.0f);
            facet_render_stats stats = prepared_compare(&f, &p);
            assert_true(i == 0 || stats.decoded_texels == 0);
            first = i ? first : embree_of(&p)->scene;
            assert_true(has_sprites || embree_of(&p)->scene == first);
            assert_int_equal(p.tangents.count, 1);
        }
        prepared_scene_clear(&p);
        fixture_destroy(&f);
    }
}

/* Moving closer decodes finer mips; moving back reads the coarser ones again. */
static void each_image_has_textures_as_fine_as_it_needs(void **state)
{
    (void)state;
    static const float distances[9] = {40.0f, 10.0f, 3.0f, 40.0f, 10.0f, 3.0f, 80.0f, 5.0f, 3.0f};
    fixture f = prepared_still_scene();
    prepared_scene p;
    prepared_scene_init(&p, f.scene, NULL);
    for (int i = 0; i < 9; i++) {
        prepared_orbit(&f, 0.3f, distances[i]);
        facet_render_stats stats = prepared_compare(&f, &p);
        if (i == 1 || i == 2)
            assert_true(stats.decoded_texels > 0);
        if (i == 3 || i == 4 || i == 5 || i == 7)
            assert_int_equal(stats.decoded_texels, 0);
    }
    prepared_scene_clear(&p);
    fixture_destroy(&f);
}

static void settings_may_change_between_images(void **state)
{
    (void)state;
    fixture f = prepared_still_scene();
    facet_environment *other;
    float radiance[3] = {0.2f, 0.5f, 1.0f};
    assert_int_equal(facet_environment_create_constant(radiance, NULL, &other, NULL), FACET_OK);
    facet_environment *first = f.environment;
    prepared_scene p;
    prepared_scene_init(&p, f.scene, NULL);
    for (uint32_t i = 0; i < 24; i++) {
        prepared_orbit(&f, 0.1f * (float)i, 5.0f);
        f.desc.width = i % 2 ? 90 : 50;
        f.desc.height = i % 3 ? 50 : 80;
        f.desc.samples = i % 5 == 1 ? 16 : i % 5 == 3 ? 1 : 4;
        f.desc.quality = i % 4 == 2 ? FACET_QUALITY_FINAL : FACET_QUALITY_NORMAL;
        f.desc.thread_count = 1 + i % 3;
        f.desc.aovs = i % 2 ? FACET_AOV_NORMAL | FACET_AOV_UV : 0;
        f.desc.background = i % 3 == 1 ? FACET_BACKGROUND_ENVIRONMENT : FACET_BACKGROUND_TRANSPARENT;
        f.desc.energy = i % 2 ? FACET_ENERGY_CONSERVING : FACET_ENERGY_GLTF;
        f.desc.ignores_scene_lights = i % 4 == 0;
        f.desc.exposure_ev = (float)(i % 3);
        f.environment = i % 4 == 3 ? NULL : i % 2 ? other : first;
        memset(f.desc.crop, 0, sizeof f.desc.crop);
        if (i % 6 == 5) {
            const uint32_t crop[4] = {7, 9, 30, 20};
            memcpy(f.desc.crop, crop, sizeof crop);
        }
        prepared_compare(&f, &p);
    }
    prepared_scene_clear(&p);
    f.environment = first;
    facet_environment_destroy(other);
    fixture_destroy(&f);
}

/* A plane of squares, each hit by a ray on its diagonal: which triangle it hits depends on the quality of
 * the BVH, and that on the number of rays. */
static void each_image_has_a_bvh_as_good_as_it_needs(void **state)
{
    (void)state;
    enum { SIDE = 64 };
    fixture f = fixture_create();
    uint32_t mesh = fixture_add_sphere(&f, SIDE, SCENE_NONE);
    scene_primitive *p = fixture_primitive(&f, mesh);
    for (uint32_t i = 0; i < p->vertex_count; i++) {
        float *position = (float *)(uintptr_t)p->positions + 3 * i;
        position[0] = (float)(i % (SIDE + 1)) / (SIDE / 2) - 1.0f;
        position[1] = (float)(i / (SIDE + 1)) / (SIDE / 2) - 0.5f;
        position[2] = 0.0f;
    }
    scene_material material = scene_material_default();
    material.is_double_sided = true;
    p->material = fixture_add_material(&f, material);
    fixture_place(&f, mesh, 0, 0, 0, 1.0f);
    f.desc.aovs = FACET_AOV_UV | FACET_AOV_NORMAL;
    prepared_scene prepared;
    prepared_scene_init(&prepared, f.scene, NULL);
    for (int i = 0; i < 4; i++) {
        f.desc.samples = i % 2 ? 16 : 4;
        prepared_compare(&f, &prepared);
        assert_int_equal(embree_of(&prepared)->quality,
                         i % 2 ? RTC_BUILD_QUALITY_MEDIUM : RTC_BUILD_QUALITY_LOW);
    }
    prepared_scene_clear(&prepared);
    fixture_destroy(&f);
}

static void scenes_and_variants_may_change(void **state)
{
    (void)state;
    static const uint32_t nodes[2][2] = {{0, 1}, {2, 3}};
    static const scene_root roots[2] = {
        {.name = "", .node_count = 2, .nodes = nodes[0], .image_light = SCENE_NONE},
        {.name = "", .node_count = 2, .nodes = nodes[1], .image_light = SCENE_NONE}};
    fixture f = prepared_still_scene();
    const char *names[2] = {"as it is", "red"};
    scene_material red = scene_material_default();
    red.base_color[1] = 0.0f;
    /* with a normal texture, along another set of coordinates than the primitive's own material */
    red.textures[SCENE_NORMAL_TEXTURE] = f.scene->materials[0].textures[SCENE_NORMAL_TEXTURE];
    const uint32_t variants[2] = {SCENE_NONE, fixture_add_material(&f, red)};
    fixture_primitive(&f, 0)->variant_materials = variants;
    f.scene->variants = names;
    f.scene->variant_count = 2;
    f.scene->scenes = (scene_root *)(uintptr_t)roots;
    f.scene->scene_count = 2;
    prepared_scene p;
    prepared_scene_init(&p, f.scene, NULL);
    for (uint32_t i = 0; i < 16; i++) {
        f.desc.pose = (facet_pose_desc){
            .has_scene_index = i & 1, .scene_index = i >> 1 & 1, .has_variant = i & 4, .variant = i >> 3 & 1};
        prepared_compare(&f, &p);
    }
    prepared_scene_clear(&p);
    fixture_destroy(&f);
}

/* ---- motion ---- */

static void rigid_parts_move_in_a_bvh_that_stays(void **state)
{
    (void)state;
    fixture f = prepared_moving_scene();
    prepared_animate(&f, prepared_rotation_of(1));
    prepared_scene p;
    prepared_scene_init(&p, f.scene, NULL);
    RTCScene still = NULL;
    RTCScene shape = NULL;
    for (int i = 0; i < 7; i++) {
        f.desc.pose.time_s = 0.3 * i;
        prepared_orbit(&f, 0.2f * (float)(i / 2), 6.0f);
        prepared_compare(&f, &p);
        assert_int_equal(p.geometries.shape_count, 2);
        assert_true(p.geometries.is_animated && embree_of(&p)->still.scene && embree_of(&p)->shapes[0].scene);
        assert_true(i == 0 ||
                    (embree_of(&p)->still.scene == still && embree_of(&p)->shapes[0].scene == shape));
        still = embree_of(&p)->still.scene;
        shape = embree_of(&p)->shapes[0].scene;
    }
    /* At rest, without animations, all is flat again. */
    f.desc.pose.animation_count = 0;
    prepared_compare(&f, &p);
    assert_int_equal(p.geometries.shape_count, 0);
    prepared_scene_clear(&p);
    fixture_destroy(&f);
}

/* An image of frames is that of flat vertices, but for rounding: animated and, at the same place, not. */
static void frames_equal_still_images_of_the_same_pose(void **state)
{
    (void)state;
    fixture f = prepared_moving_scene();
    prepared_animate(&f, prepared_rotation_of(1));
    f.desc.pose.time_s = 1.0;
    film moving = fixture_render(&f);
    f.desc.pose.animation_count = 0;
    memcpy(f.scene->nodes[1].rotation, prepared_rotations + 4, 4 * sizeof(float));
    film flat = fixture_render(&f);
    uint32_t others = 0;
    for (uint32_t i = 0; i < 64 * 64 * 4; i++)
        others += fabsf(moving.layers[0].pixels[i] - flat.layers[0].pixels[i]) > 1.0f / 255.0f;
    assert_true(others <= 8);
    film_destroy(&moving);
    film_destroy(&flat);
    fixture_destroy(&f);
}

static void small_animations_are_flat(void **state)
{
    (void)state;
    fixture f = prepared_still_scene();
    prepared_animate(&f, prepared_rotation_of(0));
    prepared_scene p;
    prepared_scene_init(&p, f.scene, NULL);
    for (int i = 0; i < 5; i++) {
        f.desc.pose.time_s = 0.5 * i;
        prepared_compare(&f, &p);
        assert_false(embree_of(&p)->has_instances);
    }
    prepared_scene_clear(&p);
    fixture_destroy(&f);
}

/* Morph targets: the sphere becomes pointed; tangents follow, other meshes stay. */
static void deformed_meshes_are_rebuilt(void **state)
{
    (void)state;
    for (int is_large = 0; is_large < 2; is_large++) {
        fixture f = is_large ? prepared_moving_scene() : prepared_still_scene();
        scene_primitive *ball = fixture_primitive(&f, 0);
        scene_morph_target *target = arena_zalloc(f.scene->arena, 1, sizeof *target);
        float *moves = arena_zalloc(f.scene->arena, ball->vertex_count, 3 * sizeof *moves);
        float *turns = arena_zalloc(f.scene->arena, ball->vertex_count, 3 * sizeof *turns);
        float *weights = arena_zalloc(f.scene->arena, 1, sizeof *weights);
        assert_true(target && moves && turns && weights);
        for (uint32_t i = 0; i < 3 * ball->vertex_count; i++) {
            moves[i] = 0.5f * ball->positions[i] * fabsf(ball->positions[i]);
            turns[i] = i % 3 == 1 ? 0.2f : 0.0f;
        }
        *target = (scene_morph_target){.positions = moves, .normals = turns};
        ball->target_count = 1;
        ball->targets = target;
        f.scene->meshes[0].weight_count = 1;
        f.scene->meshes[0].weights = weights;
        prepared_animate(&f, (scene_channel){.kind = SCENE_TARGET_WEIGHTS, .index = 0});
        prepared_scene p;
        prepared_scene_init(&p, f.scene, NULL);
        RTCScene still = NULL;
        for (int i = 0; i < 6; i++) {
            f.desc.pose.time_s = i == 3 ? 0.0 : 0.4 * i;
            prepared_compare(&f, &p);
            assert_true(p.geometries.is_animated == is_large);
            assert_true(i == 0 || embree_of(&p)->still.scene == still);
            still = embree_of(&p)->still.scene;
            assert_true(p.tangents.count <= 5); /* of four meshes at rest, and one as it is now */
        }
        prepared_scene_clear(&p);
        fixture_destroy(&f);
    }
}

/* Only a color changes: the geometry is that of the frame before. */
static void animated_materials_keep_the_geometry(void **state)
{
    (void)state;
    fixture f = prepared_still_scene();
    prepared_animate(&f, (scene_channel){.kind = SCENE_TARGET_MATERIAL,
                                         .index = 0,
                                         .offset = offsetof(scene_material, base_color)});
    prepared_scene p;
    prepared_scene_init(&p, f.scene, NULL);
    RTCScene first = NULL;
    for (int i = 0; i < 5; i++) {
        f.desc.pose.time_s = 0.4 * i;
        facet_render_stats stats = prepared_compare(&f, &p);
        first = i ? first : embree_of(&p)->scene;
        assert_true(embree_of(&p)->scene == first);
        assert_true(i == 0 || stats.decoded_texels == 0);
    }
    prepared_scene_clear(&p);
    fixture_destroy(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(turntables_keep_everything_but_the_camera),
        cmocka_unit_test(each_image_has_textures_as_fine_as_it_needs),
        cmocka_unit_test(settings_may_change_between_images),
        cmocka_unit_test(each_image_has_a_bvh_as_good_as_it_needs),
        cmocka_unit_test(scenes_and_variants_may_change),
        cmocka_unit_test(rigid_parts_move_in_a_bvh_that_stays),
        cmocka_unit_test(frames_equal_still_images_of_the_same_pose),
        cmocka_unit_test(small_animations_are_flat),
        cmocka_unit_test(deformed_meshes_are_rebuilt),
        cmocka_unit_test(animated_materials_keep_the_geometry),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
