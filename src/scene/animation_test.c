/* animation_test.c - channels change their targets, in copies of those only, and within valid ranges. */
#include "scene/animation.h"
#include "scene/motion_test_support.h"

#include <float.h>

static const float SECOND[2] = {0, 1};

#define NODE(member) offsetof(scene_node, member)

static scene_sampler line(uint32_t width, const float *values)
{
    return (scene_sampler){SCENE_LINEAR, 2, SECOND, width, values};
}

static scene_state state_at(const facet_scene *scene, double time_s)
{
    static const uint32_t all[8] = {0, 1, 2, 3, 4, 5, 6, 7};
    scene_state state;
    facet_pose_desc desc = {.animation_count = scene->animation_count, .animations = all, .time_s = time_s};
    assert_int_equal(scene_state_create(scene, &desc, NULL, &state, NULL), FACET_OK);
    return state;
}

static void without_an_animation_the_state_is_the_scene(void **state)
{
    (void)state;
    static const float values[6] = {0, 0, 0, 1, 2, 3};
    facet_scene *scene = test_scene(1);
    test_animation(scene, &(test_channel){{.offset = NODE(translation)}, line(3, values)}, 1);
    for (int i = 0; i < 2; i++) {
        scene_state s;
        facet_pose_desc desc = {.time_s = 0.5};
        assert_int_equal(scene_state_create(scene, i ? &desc : NULL, NULL, &s, NULL), FACET_OK);
        assert_ptr_equal(s.nodes, scene->nodes);
        assert_ptr_equal(s.materials, scene->materials);
        assert_null(s.node_copies);
        scene_state_destroy(&s);
    }
    scene_destroy(scene);
}

static void nodes_move_and_the_scene_stays(void **state)
{
    (void)state;
    static const float translations[6] = {0, 0, 0, 1, 2, 4};
    static const float rotations[8] = {0, 0, 0, 1, 0, 0, 1, 0};
    static const float scales[6] = {1, 1, 1, 3, -1, 1};
    const test_channel channels[3] = {
        {{.index = 1, .offset = NODE(translation)}, line(3, translations)},
        {{.index = 1, .offset = NODE(rotation), .is_rotation = true}, line(4, rotations)},
        {{.index = 1, .offset = NODE(scale)}, line(3, scales)}};
    facet_scene *scene = test_scene(2);
    test_animation(scene, channels, 3);
    scene_state s = state_at(scene, 0.5);
    const scene_node *n = &s.nodes[1];
    const float translation[3] = {0.5f, 1, 2};
    const float scale[3] = {2, 0, 1};
    for (int i = 0; i < 3; i++) {
        assert_near(n->translation[i], translation[i], 1e-6);
        assert_near(n->scale[i], scale[i], 1e-6);
        assert_near(s.nodes[0].translation[i], 0, 0);
        assert_near(scene->nodes[1].translation[i], 0, 0);
    }
    assert_near(n->rotation[2], sqrt(0.5), 1e-6);
    assert_near(n->rotation[3], sqrt(0.5), 1e-6);
    assert_ptr_equal(s.materials, scene->materials); /* none of those is animated */
    assert_null(s.light_copies);
    scene_state_destroy(&s);
    scene_destroy(scene);
}

static void animated_matrices_are_decomposed(void **state)
{
    (void)state;
    static const float translations[6] = {0, 0, 0, 10, 20, 30};
    facet_scene *scene = test_scene(1);
    const float turn[4] = {0.5f, 0.5f, -0.5f, 0.5f};
    scene->nodes[0].has_matrix = true;
    scene->nodes[0].matrix = dmat4_from_trs((double[3]){7, 8, 9}, turn, (float[3]){2, 3, 4});
    test_animation(scene, &(test_channel){{.offset = NODE(translation)}, line(3, translations)}, 1);
    scene_state s = state_at(scene, 1.0);
    const scene_node *n = &s.nodes[0];
    assert_false(n->has_matrix);
    dmat4 m = dmat4_from_trs(n->translation, n->rotation, n->scale);
    for (int i = 0; i < 12; i++)
        assert_near(m.m[i], scene->nodes[0].matrix.m[i], 1e-6);
    for (int i = 0; i < 3; i++)
        assert_near(m.m[12 + i], 10 * (i + 1), 0);
    scene_state_destroy(&s);
    scene_destroy(scene);
}

static void weights_are_animated_per_node_from_an_offset(void **state)
{
    (void)state;
    static const float rest[4] = {0.1f, 0.2f, 0.3f, 0.4f};
    static const float own[4] = {0.5f, 0.5f, 0.5f, 0.5f};
    static const float values[6] = {0, 0, 0, 1, 2, 3};
    facet_scene *scene = test_scene(3);
    scene->meshes[0].weight_count = 4;
    scene->meshes[0].weights = rest;
    scene->nodes[1].mesh = scene->nodes[2].mesh = 0;
    scene->nodes[1].weights = own;
    const test_channel channels[2] = {
        {{.kind = SCENE_TARGET_WEIGHTS, .index = 0, .offset = 1}, line(2, values + 1)},
        {{.kind = SCENE_TARGET_WEIGHTS, .index = 1, .offset = 2, .scale = 2}, line(3, values)}};
    test_animation(scene, channels, 2);
    scene_state s = state_at(scene, 1.0);
    const float expected[3][4] = {{0.1f, 1, 2, 0.4f}, {0.5f, 0.5f, 2, 4}, {0.1f, 0.2f, 0.3f, 0.4f}};
    /* line(2, values + 1) has the keys (0, 0) and (1, 2); the third number of the other has no weight. */
    for (uint32_t n = 0; n < 3; n++)
        for (int i = 0; i < 4; i++)
            assert_near(scene_state_weights(scene, &s, n)[i], expected[n][i], 1e-7);
    assert_ptr_equal(scene_state_weights(scene, &s, 2), rest);
    scene_state_destroy(&s);
    scene_destroy(scene);
}

static void visibility_is_a_step_function(void **state)
{
    (void)state;
    static const float values[2] = {0, 1};
    facet_scene *scene = test_scene(2);
    scene->nodes[1].is_hidden = true;
    const test_channel channel = {{.kind = SCENE_TARGET_VISIBLE}, {SCENE_STEP, 2, SECOND, 1, values}};
    test_animation(scene, &channel, 1);
    for (int i = 0; i < 2; i++) {
        scene_state s = state_at(scene, i ? 1.0 : 0.99);
        assert_int_equal(s.nodes[0].is_hidden, !i);
        assert_true(s.nodes[1].is_hidden);
        scene_state_destroy(&s);
    }
    scene_destroy(scene);
}

static void materials_move_with_their_texture_transforms(void **state)
{
    (void)state;
    static const float colors[8] = {0, 0, 0, 0, 1, 0.5f, 0.25f, 1};
    static const float offsets[4] = {0, 0, 2, 4};
    static const float roughness[2] = {0.5f, 9};
    facet_scene *scene = test_scene(1);
    scene_material materials[2] = {scene_material_default(), scene_material_default()};
    scene->materials = materials;
    scene->material_count = 2;
    size_t ref = offsetof(scene_material, textures) + SCENE_NORMAL_TEXTURE * sizeof(scene_texture_ref);
    const test_channel channels[3] = {
        {{SCENE_TARGET_MATERIAL, 1, offsetof(scene_material, base_color), 0, false, 0, "/x"},
         line(4, colors)},
        {{SCENE_TARGET_MATERIAL, 1, ref + offsetof(scene_texture_ref, offset), 0, false, 0, "/x"},
         line(2, offsets)},
        {{SCENE_TARGET_MATERIAL, 1, offsetof(scene_material, perceptual_roughness), 0, false, 0, "/x"},
         line(1, roughness)}};
    test_animation(scene, channels, 3);
    scene_state s = state_at(scene, 0.5);
    const scene_material *m = &s.materials[1];
    assert_near(m->base_color[1], 0.25, 1e-7);
    assert_near(m->base_color[3], 0.5, 1e-7);
    assert_near(m->perceptual_roughness, 1, 0); /* 4.75 is more than there is */
    const scene_texture_ref *t = &m->textures[SCENE_NORMAL_TEXTURE];
    assert_true(t->has_transform);
    assert_near(t->transform[2], 1, 1e-7);
    assert_near(t->transform[5], 2, 1e-7);
    assert_false(m->textures[SCENE_BASE_COLOR_TEXTURE].has_transform);
    assert_near(s.materials[0].base_color[0], 1, 0);
    assert_near(materials[1].base_color[0], 1, 0);
    scene_state_destroy(&s);
    scene_destroy(scene);
}

static void animated_lights_and_cameras_stay_in_range(void **state)
{
    (void)state;
    static const float intensity[2] = {-10, 30};
    static const float cones[2] = {0.5f, 1.5f};
    static const float fov[2] = {1, 5};
    static const float magnitude[2] = {1, 3};
    facet_scene *scene = test_scene(1);
    scene_light light = {.name = "", .type = SCENE_LIGHT_SPOT, .color = {1, 1, 1}, .outer_cone_rad = 0.8f};
    scene_camera camera = {.name = "", .fov_y_rad = 0.7f, .ortho_height = 1, .ortho_width = 1};
    scene->lights = &light;
    scene->cameras = &camera;
    scene->light_count = scene->camera_count = 1;
#define LIGHT(member) SCENE_TARGET_LIGHT, 0, offsetof(scene_light, member)
#define CAMERA(member) SCENE_TARGET_CAMERA, 0, offsetof(scene_camera, member)
    const test_channel channels[4] = {{{LIGHT(inner_cone_rad), 1, false, 0, NULL}, line(1, cones)},
                                      {{LIGHT(intensity), 1, false, 0, NULL}, line(1, intensity)},
                                      {{CAMERA(fov_y_rad), 1, false, 0, NULL}, line(1, fov)},
                                      {{CAMERA(ortho_height), 2, false, 0, NULL}, line(1, magnitude)}};
    test_animation(scene, channels, 4);
    scene_state s = state_at(scene, 0.0);
    assert_near(s.lights[0].intensity, 0, 0);
    assert_near(s.lights[0].inner_cone_rad, 0.5, 0);
    assert_near(s.cameras[0].fov_y_rad, 1, 0);
    scene_state_destroy(&s);
    s = state_at(scene, 1.0);
    assert_near(s.lights[0].intensity, 30, 0);
    assert_near(s.lights[0].inner_cone_rad, 0.8f, 0); /* not outside of the outer one */
    assert_near(s.cameras[0].fov_y_rad, 0.7f, 0);     /* 5 rad is not a field of view */
    assert_near(s.cameras[0].ortho_height, 6, 0);
    scene_state_destroy(&s);
    scene_destroy(scene);
}

static void the_last_animation_wins(void **state)
{
    (void)state;
    static const float first[6] = {1, 1, 1, 1, 1, 1};
    static const float second[6] = {2, 2, 2, 2, 2, 2};
    facet_scene *scene = test_scene(2);
    const test_channel channels[2] = {{{.offset = NODE(translation)}, line(3, second)},
                                      {{.offset = NODE(translation)}, line(3, first)}};
    test_animation(scene, channels, 2);
    test_animation(scene, channels, 1);
    static const uint32_t orders[3][2] = {{0, 1}, {1, 0}, {0, 0}};
    static const float expected[3] = {2, 1, 1};
    for (int i = 0; i < 3; i++) {
        scene_state s;
        facet_pose_desc desc = {.animation_count = 2, .animations = orders[i]};
        assert_int_equal(scene_state_create(scene, &desc, NULL, &s, NULL), FACET_OK);
        assert_near(s.nodes[0].translation[0], expected[i], 0);
        scene_state_destroy(&s);
    }
    scene_destroy(scene);
}

static void overflowing_values_are_not_applied(void **state)
{
    (void)state;
    /* Hermite between the largest floats with the largest tangents. */
    static const float times[2] = {0, 1e30f};
    static const float values[18] = {FLT_MAX,  FLT_MAX,  FLT_MAX, FLT_MAX, -FLT_MAX, 1, FLT_MAX, FLT_MAX, 0,
                                     -FLT_MAX, -FLT_MAX, 0,       FLT_MAX, FLT_MAX,  1, 0,       0,       0};
    facet_scene *scene = test_scene(1);
    const test_channel channel = {{.offset = NODE(translation)}, {SCENE_CUBIC_SPLINE, 2, times, 3, values}};
    scene->nodes[0].translation[0] = 4;
    test_animation(scene, &channel, 1);
    scene_state s = state_at(scene, 4e29);
    assert_near(s.nodes[0].translation[0], 4, 0);
    assert_near(s.nodes[0].translation[2], 1, 1e-6);
    scene_state_destroy(&s);
    scene_destroy(scene);
}

static void channels_without_a_target_have_no_effect(void **state)
{
    (void)state;
    static const float values[16] = {0};
    facet_scene *scene = test_scene(1);
    const test_channel channels[5] = {{{.index = 1, .offset = NODE(translation)}, line(3, values)},
                                      {{.offset = sizeof(scene_node) - 4}, line(3, values)},
                                      {{.offset = SIZE_MAX - 3}, line(3, values)},
                                      {{.kind = SCENE_TARGET_WEIGHTS, .offset = 0}, line(3, values)},
                                      {{.kind = SCENE_TARGET_MATERIAL, .index = 0}, line(3, values)}};
    test_animation(scene, channels, 5);
    scene_state s = state_at(scene, 0.5);
    assert_memory_equal(s.nodes, scene->nodes, sizeof *scene->nodes);
    scene_state_destroy(&s);
    scene_destroy(scene);
}

static void unknown_animations_are_refused(void **state)
{
    (void)state;
    static const float values[6] = {0};
    static const uint32_t second[1] = {1};
    facet_scene *scene = test_scene(1);
    facet_error error;
    scene_state s;
    facet_pose_desc desc = {.animation_count = 1, .animations = second};
    assert_int_equal(scene_state_create(scene, &desc, NULL, &s, &error), FACET_ERROR_ARGUMENT);
    assert_string_equal(error.message, "test: has no animation 1; it has none");
    test_animation(scene, &(test_channel){{.offset = NODE(translation)}, line(3, values)}, 1);
    assert_int_equal(scene_state_create(scene, &desc, NULL, &s, &error), FACET_ERROR_ARGUMENT);
    assert_string_equal(error.message, "test: has no animation 1; the last one is 0");
    static const double times[3] = {(double)NAN, (double)INFINITY, -(double)INFINITY};
    for (int i = 0; i < 3; i++) {
        desc = (facet_pose_desc){.time_s = times[i]};
        assert_int_equal(scene_state_create(scene, &desc, NULL, &s, &error), FACET_ERROR_ARGUMENT);
    }
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(without_an_animation_the_state_is_the_scene),
        cmocka_unit_test(nodes_move_and_the_scene_stays),
        cmocka_unit_test(animated_matrices_are_decomposed),
        cmocka_unit_test(weights_are_animated_per_node_from_an_offset),
        cmocka_unit_test(visibility_is_a_step_function),
        cmocka_unit_test(materials_move_with_their_texture_transforms),
        cmocka_unit_test(animated_lights_and_cameras_stay_in_range),
        cmocka_unit_test(the_last_animation_wins),
        cmocka_unit_test(overflowing_values_are_not_applied),
        cmocka_unit_test(channels_without_a_target_have_no_effect),
        cmocka_unit_test(unknown_animations_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
