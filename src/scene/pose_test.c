/* pose_test.c - instances, mirrored ones, and bounds from every used vertex. */
#include "scene/scene_test_support.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* Corners of a triangle and a vertex that nothing uses, far out. */
static const float POSITIONS[12] = {0, 0, 0, 1, 0, 0, 0, 2, 0, 100, 100, 100};
static const float NORMALS[12] = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
static const uint32_t INDICES[3] = {0, 1, 2};

static facet_scene *make_scene(mat4 matrix)
{
    facet_scene *scene = test_scene(1);
    scene->meshes[0].primitives[0] = (scene_primitive){.mode = SCENE_TRIANGLES,
                                                       .vertex_count = 4,
                                                       .index_count = 3,
                                                       .indices = INDICES,
                                                       .positions = POSITIONS,
                                                       .normals = NORMALS,
                                                       .material = SCENE_NONE,
                                                       .bounds_max = {1, 2, 0}};
    scene->nodes[0].has_matrix = true;
    scene->nodes[0].matrix = matrix;
    return scene;
}

static scene_pose make_pose(const facet_scene *scene)
{
    scene_pose pose;
    assert_int_equal(scene_pose_create(scene, NULL, NULL, 2, &pose, NULL), FACET_OK);
    return pose;
}

static void bounds_leave_out_unused_vertices(void **state)
{
    (void)state;
    facet_scene *scene = make_scene(mat4_identity());
    scene_pose pose = make_pose(scene);
    assert_true(pose.has_bounds);
    assert_near(pose.bounds_max[0], 1, 0);
    assert_near(pose.bounds_max[1], 2, 0);
    scene_pose_destroy(&pose);
    scene_destroy(scene);
}

static void bounds_are_exact_when_turned(void **state)
{
    (void)state;
    /* By 45 degrees around Z the box's corner (1, 2) would reach y = 2.12; no vertex does. */
    const float none[3] = {0};
    const float one[3] = {1, 1, 1};
    const float turn[4] = {0, 0, sinf(0.392699082f), cosf(0.392699082f)};
    facet_scene *scene = make_scene(mat4_from_trs(none, turn, one));
    scene_pose pose = make_pose(scene);
    assert_near(pose.bounds_min[0], -sqrt(2.0), 1e-6);
    assert_near(pose.bounds_max[0], sqrt(0.5), 1e-6);
    assert_near(pose.bounds_max[1], sqrt(2.0), 1e-6);
    scene_pose_destroy(&pose);
    scene_destroy(scene);
}

static void axis_aligned_bounds_equal_those_of_vertices(void **state)
{
    (void)state;
    /* A quarter turn with a mirror and odd scales: rows with one entry each. */
    facet_scene *scene =
        make_scene((mat4){{0, -0.3f, 0, 0, 1.7f, 0, 0, 0, 0, 0, -9.1f, 0, 0.1f, 0.2f, 0.3f, 1}});
    scene_pose pose = make_pose(scene);
    for (int axis = 0; axis < 3; axis++) {
        float minimum = FLT_MAX;
        float maximum = -FLT_MAX;
        for (int i = 0; i < 3; i++) {
            float p[3];
            mat4_transform_point(&pose.instances[0].world, POSITIONS + 3 * i, p);
            minimum = fminf(minimum, p[axis]);
            maximum = fmaxf(maximum, p[axis]);
        }
        assert_true(pose.bounds_min[axis] == minimum && pose.bounds_max[axis] == maximum);
    }
    scene_pose_destroy(&pose);
    scene_destroy(scene);
}

static void mirrored_instances_keep_outward_normals(void **state)
{
    (void)state;
    for (int mirrored = 0; mirrored < 2; mirrored++) {
        mat4 m = mat4_identity();
        m.m[0] = mirrored ? -2.0f : 2.0f;
        m.m[10] = 1e-12f; /* tiny scales keep their sign and direction */
        facet_scene *scene = make_scene(m);
        scene_pose pose = make_pose(scene);
        assert_int_equal(pose.instance_count, 1);
        assert_int_equal(pose.instances[0].is_mirrored, mirrored);
        const float *n = pose.instances[0].normal_matrix;
        /* Local +Z, the third column, stays +Z in world space. */
        assert_true(n[8] > 0.0f);
        assert_near(n[2], 0, 0);
        assert_near(n[5], 0, 0);
        scene_pose_destroy(&pose);
        scene_destroy(scene);
    }
}

static void singular_and_endless_matrices_draw_nothing(void **state)
{
    (void)state;
    mat4 cases[4] = {mat4_identity(), mat4_identity(), mat4_identity(), mat4_identity()};
    cases[0].m[5] = 0.0f;
    cases[1].m[12] = NAN;
    cases[2].m[0] = 1e30f;
    cases[3].m[12] = INFINITY;
    for (int i = 0; i < 4; i++) {
        facet_scene *scene = make_scene(cases[i]);
        scene_pose pose = make_pose(scene);
        assert_int_equal(pose.instance_count, 0);
        assert_false(pose.has_bounds);
        assert_near(pose.bounds_max[0], 0, 0);
        scene_pose_destroy(&pose);
        scene_destroy(scene);
    }
}

static void small_models_are_regular(void **state)
{
    (void)state;
    mat4 m = mat4_identity();
    m.m[0] = m.m[5] = m.m[10] = 1e-10f;
    facet_scene *scene = make_scene(m);
    scene_pose pose = make_pose(scene);
    assert_int_equal(pose.instance_count, 1);
    assert_true(pose.instances[0].normal_matrix[8] > 0.1f); /* scaled, or it would be 1e-20 */
    scene_pose_destroy(&pose);
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bounds_leave_out_unused_vertices),
        cmocka_unit_test(bounds_are_exact_when_turned),
        cmocka_unit_test(axis_aligned_bounds_equal_those_of_vertices),
        cmocka_unit_test(mirrored_instances_keep_outward_normals),
        cmocka_unit_test(singular_and_endless_matrices_draw_nothing),
        cmocka_unit_test(small_models_are_regular),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
