/* Tests of origin.h: the same model at the origin and far from it has the same pose. */
#include <math.h>
#include <string.h>

#include "scene/origin.h"
#include "scene/motion_test_support.h"
#include "scene/scene_test_support.h"

/* Two squares of 1 m, which differ in how they are turned. */
static const float SQUARE[12] = {-0.5f, 0, -0.5f, 0.5f, 0, -0.5f, 0.5f, 0.25f, 0.5f, -0.5f, 0, 0.5f};
static const uint32_t INDICES[6] = {0, 2, 1, 0, 3, 2};

static void set_square(scene_primitive *p, const float positions[12])
{
    *p = (scene_primitive){.mode = SCENE_TRIANGLES,
                           .vertex_count = 4,
                           .index_count = 6,
                           .indices = INDICES,
                           .positions = positions,
                           .material = SCENE_NONE};
    for (int axis = 0; axis < 3; axis++) {
        p->bounds_min[axis] = p->bounds_max[axis] = positions[axis];
        for (int i = 1; i < 4; i++) {
            p->bounds_min[axis] = fminf(p->bounds_min[axis], positions[3 * i + axis]);
            p->bounds_max[axis] = fmaxf(p->bounds_max[axis], positions[3 * i + axis]);
        }
    }
}

/* Node 0 above nodes 1 and 2, whose meshes are the squares. */
static facet_scene *make_scene(void)
{
    static const uint32_t children[2] = {1, 2};
    facet_scene *scene = test_scene(3);
    for (uint32_t i = 1; i < 3; i++) {
        set_square(scene->meshes[i].primitives, SQUARE);
        scene->nodes[i].parent = 0;
    }
    scene->nodes[0].mesh = SCENE_NONE;
    scene->nodes[0].child_count = 2;
    scene->nodes[0].children = children;
    scene->scenes[0].node_count = 1;
    scene->nodes[2].translation[0] = 1.25;
    scene->nodes[2].translation[1] = 0.5;
    scene->nodes[2].rotation[1] = scene->nodes[2].rotation[3] = sqrtf(0.5f);
    return scene;
}

static scene_pose settle_and_pose(facet_scene *scene)
{
    scene_pose pose;
    assert_int_equal(scene_settle_origin(scene, NULL, NULL, NULL), FACET_OK);
    assert_int_equal(scene_pose_create(scene, NULL, NULL, 1, &pose, NULL), FACET_OK);
    return pose;
}

/* All corners of all instances, relative to the file's origin moved by move. */
static void expect_same_places(const facet_scene *scene, const scene_pose *pose, const double move[3],
                               double tolerance)
{
    facet_scene *near_scene = make_scene();
    scene_pose near_pose = settle_and_pose(near_scene);
    assert_int_equal(pose->instance_count, near_pose.instance_count);
    for (uint32_t i = 0; i < pose->instance_count; i++)
        for (uint32_t k = 0; k < 4; k++) {
            float a[3], b[3];
            mat4_transform_point(&pose->instances[i].world, pose->instances[i].positions + 3 * (size_t)k, a);
            mat4_transform_point(&near_pose.instances[i].world,
                                 near_pose.instances[i].positions + 3 * (size_t)k, b);
            for (int axis = 0; axis < 3; axis++)
                assert_near((double)a[axis] + (scene->origin[axis] - move[axis]), b[axis], tolerance);
        }
    scene_pose_destroy(&near_pose);
    scene_destroy(near_scene);
}

static void near_models_have_no_origin(void **state)
{
    (void)state;
    for (double far_out = 0.0; far_out <= 31.0; far_out = 2.0 * far_out + 1.0) {
        facet_scene *scene = make_scene();
        scene->nodes[0].translation[2] = far_out;
        scene_pose pose = settle_and_pose(scene);
        assert_false(scene->is_far);
        for (int axis = 0; axis < 3; axis++)
            assert_true(scene->origin[axis] == 0.0);
        assert_ptr_equal(scene->meshes[1].primitives[0].positions, SQUARE);
        scene_pose_destroy(&pose);
        scene_destroy(scene);
    }
}

static void translated_nodes_keep_every_bit(void **state)
{
    (void)state;
    for (int power = 0; power <= 8; power++)
        for (int axis = 0; axis < 3; axis++)
            for (int as_matrix = 0; as_matrix < 2; as_matrix++) {
                facet_scene *scene = make_scene();
                double move[3] = {0, 0, 0};
                move[axis] = (axis == 1 ? -1.0 : 1.0) * (pow(10.0, power) + 0.125);
                memcpy(scene->nodes[0].translation, move, sizeof move);
                scene->nodes[0].has_matrix = as_matrix;
                scene->nodes[0].matrix = dmat4_translation(move);
                scene_pose pose = settle_and_pose(scene);
                assert_int_equal(scene->is_far, power > 1);
                expect_same_places(scene, &pose, move, power > 1 ? 1e-7 : 3e-7 * pow(10.0, power));
                assert_int_equal(scene->warning_count, 0);
                scene_pose_destroy(&pose);
                scene_destroy(scene);
            }
}

/* Vertices that are far out in the file keep the values of its floats, with one warning that gives their
 * precision. */
static void vertices_are_moved_to_their_mesh(void **state)
{
    (void)state;
    float positions[12];
    facet_scene *scene = make_scene();
    const double move[3] = {1048576.0, 0, -2097152.0}; /* steps of 1/8 and 1/4 m */
    for (size_t i = 0; i < 12; i++)
        positions[i] = (float)((double)SQUARE[i] + move[i % 3]);
    set_square(scene->meshes[1].primitives, positions);
    scene->nodes[2].translation[0] += move[0];
    scene->nodes[2].translation[2] += move[2];
    scene_pose pose = settle_and_pose(scene);
    assert_true(scene->origin[0] == 1048576.0 && scene->origin[1] == 0.0 && scene->origin[2] == -2097152.0);
    assert_true(scene->meshes[1].origin[0] == 1048576.0 && scene->meshes[1].origin[2] == -2097152.0);
    assert_ptr_equal(scene->meshes[2].primitives[0].positions, SQUARE);
    expect_same_places(scene, &pose, move, 1e-7); /* 0.5 and 0.25 are multiples of the steps */
    for (int axis = 0; axis < 3; axis++)
        assert_true(fabsf(pose.instances[0].bounds_min[axis]) <= 1.0f);
    assert_int_equal(scene->warning_count, 1);
    assert_non_null(
        strstr(scene->warnings[0], "2.1e+06 m from its origin, where 32-bit numbers have steps of 0.25 m"));
    scene_pose_destroy(&pose);
    scene_destroy(scene);
}

/* A near model with far parts: nodes cancel the offset of vertices. */
static void distances_that_cancel_are_exact(void **state)
{
    (void)state;
    float positions[12];
    facet_scene *scene = make_scene();
    const float turn[4] = {0, sqrtf(0.5f), 0, sqrtf(0.5f)}; /* x to -z */
    for (size_t i = 0; i < 12; i++)
        positions[i] = SQUARE[i] + (i % 3 == 0 ? 1048576.0f : 0.0f);
    set_square(scene->meshes[1].primitives, positions);
    set_square(scene->meshes[2].primitives, positions);
    scene->nodes[1].translation[0] = -1048576.0;
    scene->nodes[2].translation[2] += 1048576.0;
    memcpy(scene->nodes[2].rotation, turn, sizeof turn);
    scene_pose pose = settle_and_pose(scene);
    assert_true(scene->is_far && scene->origin[0] == 0.0 && scene->origin[2] == 0.0);
    expect_same_places(scene, &pose, (double[3]){0, 0, 0}, 1e-6);
    scene_pose_destroy(&pose);
    scene_destroy(scene);
}

static void copies_are_placed_in_double(void **state)
{
    (void)state;
    const float translations[6] = {1048576.0f, 0, 0, 1048577.25f, 0.5f, 0};
    const float rotations[8] = {0, 0, 0, 1, 0, sqrtf(0.5f), 0, sqrtf(0.5f)};
    const scene_instancing copies = {.count = 2, .translations = translations, .rotations = rotations};
    const double move[3] = {1048576.0 + 1e8, 0, 0};
    facet_scene *scene = make_scene();
    scene->nodes[0].translation[0] = 1e8;
    scene->nodes[0].child_count = 1;
    scene->nodes[1].instancing = &copies;
    scene_pose pose = settle_and_pose(scene);
    expect_same_places(scene, &pose, move, 1e-6);
    assert_int_equal(scene->warning_count, 1);
    assert_non_null(strstr(scene->warnings[0], "has instances 1.05e+06 m from its origin"));
    scene_pose_destroy(&pose);
    scene_destroy(scene);
}

static void outliers_do_not_move_the_origin(void **state)
{
    (void)state;
    facet_scene *scene = test_scene(40);
    for (uint32_t i = 0; i < 40; i++) {
        set_square(scene->meshes[i].primitives, SQUARE);
        scene->nodes[i].translation[0] = i == 7 ? 0.0 : 4526331.0 + i;
    }
    scene_pose pose = settle_and_pose(scene);
    assert_near(scene->origin[0], 4526331.0, 100.0);
    assert_true(floor(scene->origin[0]) == scene->origin[0]);
    scene_pose_destroy(&pose);
    scene_destroy(scene);
}

static void lights_and_cameras_move_with_the_origin(void **state)
{
    (void)state;
    facet_scene *scene = make_scene();
    scene->lights = arena_zalloc(scene->arena, 1, sizeof *scene->lights);
    scene->cameras = arena_zalloc(scene->arena, 1, sizeof *scene->cameras);
    scene->light_count = scene->camera_count = 1;
    scene->nodes[0].translation[1] = 1e7;
    scene->nodes[1].light = scene->nodes[2].camera = 0;
    scene_pose pose = settle_and_pose(scene);
    assert_near(scene->origin[1] + (double)pose.lights[0].position[1], 1e7, 1e-6);
    assert_near(scene->origin[1] + (double)pose.cameras[0].world.m[13], 1e7 + 0.5, 1e-6);
    assert_true(fabsf(pose.lights[0].position[1]) < 4.0f);
    scene_pose_destroy(&pose);
    scene_destroy(scene);
}

/* A model at the origin at rest, and elsewhere in motion: the origin follows, and returns. */
static void the_origin_follows_the_shown_scene(void **state)
{
    (void)state;
    static const float times[2] = {0, 1},
                       places[6] = {8388608.0f, 0, -1048576.0f, 8388609.0f, 0, -1048576.0f};
    static const uint32_t first = 0;
    const double move[3] = {8388608.5, 0, -1048576.0}; /* half-way between keys, which floats would round */
    const facet_pose_desc desc = {.animation_count = 1, .animations = &first, .time_s = 0.5};
    const facet_pose_desc missing = {.has_scene_index = true, .scene_index = 7};
    facet_scene *scene = make_scene();
    const test_channel channel = {{.offset = offsetof(scene_node, translation)},
                                  {SCENE_LINEAR, 2, times, 3, places}};
    test_animation(scene, &channel, 1);
    scene_pose pose = settle_and_pose(scene);
    assert_false(scene->is_far);
    scene_pose_destroy(&pose);
    assert_int_equal(scene_settle_origin(scene, &desc, NULL, NULL), FACET_OK);
    assert_near(scene->origin[0], move[0], 8.0);
    assert_int_equal(scene_pose_create(scene, &desc, NULL, 1, &pose, NULL), FACET_OK);
    expect_same_places(scene, &pose, move, 1e-6);
    scene_pose_destroy(&pose);
    assert_int_equal(scene_settle_origin(scene, &missing, NULL, NULL), FACET_ERROR_ARGUMENT);
    pose = settle_and_pose(scene);
    assert_true(!scene->is_far && scene->origin[0] == 0.0);
    expect_same_places(scene, &pose, (double[3]){0, 0, 0}, 0);
    scene_pose_destroy(&pose);
    scene_destroy(scene);
}

/* A matrix in world coordinates keeps its meaning. */
static void a_placed_model_has_the_origin_of_its_place(void **state)
{
    (void)state;
    facet_scene *scene = make_scene();
    scene->nodes[0].translation[0] = 1e8 + 0.125;
    scene_pose before = settle_and_pose(scene);
    float matrix[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 10, 20, 30, 1};
    for (int i = 0; i < 2; i++) {
        scene_pose pose;
        assert_int_equal(scene_place(scene, 0, matrix, NULL), FACET_OK);
        assert_true(scene->origin[0] == 0.0);
        assert_int_equal(scene_pose_create(scene, NULL, NULL, 1, &pose, NULL), FACET_OK);
        for (int axis = 0; axis < 3; axis++)
            assert_near(pose.bounds_min[axis], before.bounds_min[axis] + matrix[12 + axis], 1e-6);
        scene_pose_destroy(&pose);
        matrix[13] = -5;
    }
    scene_pose_destroy(&before);
    scene_destroy(scene);
}

static void points_are_judged_without_outliers(void **state)
{
    (void)state;
    float points[3 * 1000];
    double origin[3];
    for (size_t i = 0; i < 1000; i++) {
        points[3 * i] = i % 50 ? 500000.0f + (float)(i % 100) : 0.0f;
        points[3 * i + 1] = (float)(i % 7);
        points[3 * i + 2] = i == 3 ? NAN : -6000000.0f;
    }
    assert_true(scene_find_origin(points, 1000, NULL, origin));
    assert_near(origin[0], 500050.0, 100.0);
    assert_true(origin[1] == 0.0);
    assert_near(origin[2], -6e6, 100.0);
    for (size_t i = 0; i < 3000; i++)
        points[i] = (float)(i % 100);
    assert_false(scene_find_origin(points, 1000, NULL, origin));
    assert_false(scene_find_origin(points, 0, NULL, origin));
    assert_true(origin[0] == 0.0 && origin[1] == 0.0 && origin[2] == 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(near_models_have_no_origin),
        cmocka_unit_test(translated_nodes_keep_every_bit),
        cmocka_unit_test(vertices_are_moved_to_their_mesh),
        cmocka_unit_test(distances_that_cancel_are_exact),
        cmocka_unit_test(copies_are_placed_in_double),
        cmocka_unit_test(outliers_do_not_move_the_origin),
        cmocka_unit_test(lights_and_cameras_move_with_the_origin),
        cmocka_unit_test(the_origin_follows_the_shown_scene),
        cmocka_unit_test(a_placed_model_has_the_origin_of_its_place),
        cmocka_unit_test(points_are_judged_without_outliers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
