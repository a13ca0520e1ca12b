/* pose_test.c - instances, mirrored ones, copies, hidden nodes, variants, and bounds from every used
 * vertex. */
#include "scene/motion_test_support.h"

#include <float.h>
#include <math.h>
#include "tests/support/support.h"

/* Corners of a triangle and an unused vertex, far out. */
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
    scene->nodes[0].matrix = dmat4_from_float(&matrix);
    return scene;
}

static scene_pose make_pose(const facet_scene *scene)
{
    scene_pose pose;
    assert_int_equal(scene_pose_create(scene, NULL, NULL, 2, &pose, NULL), FACET_OK);
    return pose;
}

static void bounds_exclude_unused_vertices(void **state)
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

static void singular_and_infinite_matrices_draw_nothing(void **state)
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

static void instances_beyond_the_limit_are_excluded(void **state)
{
    (void)state;
    /* A matrix that is near enough, and a corner at 1.4e17 m; turned or not. */
    for (int is_turned = 0; is_turned < 2; is_turned++) {
        mat4 m = mat4_identity();
        m.m[0] = m.m[5] = m.m[10] = 5e16f;
        m.m[12] = 9e16f;
        m.m[4] = is_turned ? 1e16f : 0.0f;
        facet_scene *scene = make_scene(m);
        scene_pose pose = make_pose(scene);
        assert_int_equal(pose.instance_count, 0);
        assert_false(pose.has_bounds);
        scene_pose_destroy(&pose);
        scene_destroy(scene);
    }
}

static void nodes_listed_twice_are_drawn_once(void **state)
{
    (void)state;
    static const uint32_t roots[3] = {0, 1, 0};
    facet_scene *scene = test_scene(2);
    for (uint32_t i = 0; i < 2; i++)
        test_fill_primitive(scene, &scene->meshes[i].primitives[0], 3);
    scene->scenes[0].nodes = roots;
    scene->scenes[0].node_count = 3;
    scene_pose pose = make_pose(scene);
    assert_int_equal(pose.instance_count, 2);
    scene_pose_destroy(&pose);
    scene_destroy(scene);
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

/* ---- copies ---- */

static void copies_stand_where_node_and_instance_put_them(void **state)
{
    (void)state;
    enum { COPIES = 50 };
    static float translations[3 * COPIES], rotations[4 * COPIES], scales[3 * COPIES];
    uint32_t random = 11;
    for (uint32_t i = 0; i < COPIES; i++) {
        test_random_rotation(&random, rotations + 4 * i);
        for (uint32_t k = 0; k < 3; k++) {
            translations[3 * i + k] = 9.0f * test_random(&random);
            scales[3 * i + k] = i == 7 ? 0.0f : 1.0f + 0.5f * test_random(&random); /* number 7 is singular */
        }
    }
    for (int given = 0; given < 8; given++) {
        const float turn[4] = {0.5f, 0.5f, 0.5f, 0.5f};
        mat4 node = mat4_from_trs((float[3]){1, 2, 3}, turn, (float[3]){2, 2, 2});
        facet_scene *scene = make_scene(node);
        scene_instancing instancing = {.count = COPIES,
                                       .translations = given & 1 ? translations : NULL,
                                       .rotations = given & 2 ? rotations : NULL,
                                       .scales = given & 4 ? scales : NULL};
        scene->nodes[0].instancing = &instancing;
        scene_primitive two[2] = {scene->meshes[0].primitives[0], scene->meshes[0].primitives[0]};
        scene->meshes[0].primitives = two;
        scene->meshes[0].primitive_count = 2;
        scene_pose pose = make_pose(scene);
        uint32_t per_primitive = given & 4 ? COPIES - 1 : COPIES;
        assert_int_equal(pose.instance_count, 2 * per_primitive);
        float low[3] = {FLT_MAX, FLT_MAX, FLT_MAX};
        for (uint32_t i = 0; i < pose.instance_count; i++) {
            const scene_instance *instance = &pose.instances[i];
            assert_int_equal(instance->is_copy, i % per_primitive != 0);
            assert_ptr_equal(instance->primitive, &two[i / per_primitive]);
            uint32_t c = i % per_primitive;
            c += given & 4 && c >= 7;
            /* The third corner by the definition: scaled, turned, moved, then all that the node does. */
            double p[3] = {0, 2, 0};
            if (given & 4)
                for (uint32_t k = 0; k < 3; k++)
                    p[k] *= (double)scales[3 * c + k];
            if (given & 2) {
                /* p + 2 w (q x p) + 2 q x (q x p) */
                double q[3], a[3], b[3];
                for (uint32_t k = 0; k < 3; k++)
                    q[k] = (double)rotations[4 * c + k];
                for (int k = 0; k < 3; k++)
                    a[k] = q[(k + 1) % 3] * p[(k + 2) % 3] - q[(k + 2) % 3] * p[(k + 1) % 3];
                for (int k = 0; k < 3; k++)
                    b[k] = q[(k + 1) % 3] * a[(k + 2) % 3] - q[(k + 2) % 3] * a[(k + 1) % 3];
                for (int k = 0; k < 3; k++)
                    p[k] += 2.0 * (double)rotations[4 * c + 3] * a[k] + 2.0 * b[k];
            }
            for (uint32_t k = 0; k < 3 && given & 1; k++)
                p[k] += (double)translations[3 * c + k];
            /* The node turns x to y, y to z, z to x. */
            const double world[3] = {1.0 + 2.0 * p[2], 2.0 + 2.0 * p[0], 3.0 + 2.0 * p[1]};
            float corner[3];
            mat4_transform_point(&instance->world, POSITIONS + 6, corner);
            for (int k = 0; k < 3; k++)
                assert_near(corner[k], world[k], 1e-5);
            for (int v = 0; v < 3; v++) {
                mat4_transform_point(&instance->world, POSITIONS + 3 * v, corner);
                for (int k = 0; k < 3; k++)
                    low[k] = fminf(low[k], corner[k]);
            }
        }
        /* Exact, although most copies are inside of the bounds of others and are not examined. */
        for (int k = 0; k < 3; k++)
            assert_true(pose.bounds_min[k] == low[k]);
        scene_pose_destroy(&pose);
        scene_destroy(scene);
    }
}

static void too_many_copies_are_refused(void **state)
{
    (void)state;
    facet_scene *scene = make_scene(mat4_identity());
    scene_instancing instancing = {.count = (1u << 22) + 1};
    scene->nodes[0].instancing = &instancing;
    scene_pose pose;
    facet_error error;
    assert_int_equal(scene_pose_create(scene, NULL, NULL, 1, &pose, &error), FACET_ERROR_LIMIT);
    assert_string_equal(error.message, "test: draws more than 4194304 primitives");
    instancing.count = 0;
    pose = make_pose(scene);
    assert_int_equal(pose.instance_count, 0);
    scene_pose_destroy(&pose);
    scene_destroy(scene);
}

static void copies_share_morphed_vertices(void **state)
{
    (void)state;
    static const float changes[12] = {0, 0, 5, 0, 0, 5, 0, 0, 5, 0, 0, 0};
    static const float translations[6] = {0, 0, 0, 10, 0, 0};
    static const float weight[1] = {2};
    static const scene_morph_target target = {.positions = changes};
    facet_scene *scene = make_scene(mat4_identity());
    scene_instancing instancing = {.count = 2, .translations = translations};
    scene->nodes[0].instancing = &instancing;
    scene->meshes[0].weight_count = 1;
    scene->meshes[0].weights = weight;
    scene->meshes[0].primitives[0].target_count = 1;
    scene->meshes[0].primitives[0].targets = &target;
    scene_pose pose = make_pose(scene);
    assert_int_equal(pose.instance_count, 2);
    assert_true(pose.instances[1].is_copy && pose.instances[1].is_deformed);
    assert_ptr_equal(pose.instances[0].positions, pose.instances[1].positions);
    assert_near(pose.bounds_max[2], 10, 0);
    assert_near(pose.bounds_max[0], 11, 0);
    scene_pose_destroy(&pose);
    scene_destroy(scene);
}

/* ---- visibility, variants, materials ---- */

static void children_of_hidden_nodes_are_hidden(void **state)
{
    (void)state;
    /* 0 - 1 - 2, and 3 beside; 1 has a light, 2 a mesh, a light and a camera, 3 a mesh. */
    static const uint32_t parents[4] = {SCENE_NONE, 0, 1, SCENE_NONE};
    static const float times[2] = {0, 1};
    static const float shown[2] = {1, 0};
    facet_scene *scene = test_scene(4);
    scene_light light = {.name = "", .color = {1, 1, 1}, .intensity = 1};
    scene_camera camera = {.name = "", .fov_y_rad = 1};
    test_tree(scene, parents);
    for (uint32_t i = 2; i < 4; i++) {
        test_fill_primitive(scene, &scene->meshes[i].primitives[0], 3);
        scene->nodes[i].mesh = i;
    }
    scene->lights = &light;
    scene->cameras = &camera;
    scene->light_count = scene->camera_count = 1;
    scene->nodes[1].light = scene->nodes[2].light = scene->nodes[2].camera = 0;
    const test_channel channel = {{.kind = SCENE_TARGET_VISIBLE, .index = 1},
                                  {SCENE_STEP, 2, times, 1, shown}};
    test_animation(scene, &channel, 1);
    for (int i = 0; i < 2; i++) {
        scene_pose pose = test_pose_at(scene, 1, i, 1);
        assert_int_equal(pose.instance_count, i ? 1 : 2);
        assert_int_equal(pose.light_count, i ? 0 : 2);
        assert_int_equal(pose.camera_count, i ? 0 : 1);
        assert_int_equal(pose.instances[0].node, 3); /* roots come first */
        scene_pose_destroy(&pose);
    }
    /* An animation shows a node that the file hides. */
    scene->nodes[1].is_hidden = true;
    for (uint32_t i = 0; i < 2; i++) {
        scene_pose pose = test_pose_at(scene, i, 0.0, 1);
        assert_int_equal(pose.instance_count, i ? 2 : 1);
        scene_pose_destroy(&pose);
    }
    scene_destroy(scene);
}

static void variants_choose_materials(void **state)
{
    (void)state;
    static const uint32_t choices[2] = {1, SCENE_NONE};
    static const char *names[2] = {"a", "b"};
    facet_scene *scene = make_scene(mat4_identity());
    scene_material materials[2] = {scene_material_default(), scene_material_default()};
    scene->materials = materials;
    scene->material_count = scene->variant_count = 2;
    scene->variants = names;
    scene->meshes[0].primitives[0].material = 0;
    scene->meshes[0].primitives[0].variant_materials = choices;
    static const uint32_t expected[3] = {1, 0, 0};
    for (uint32_t i = 0; i < 3; i++) {
        scene_pose pose;
        facet_pose_desc desc = {.has_variant = i < 2, .variant = i};
        assert_int_equal(scene_pose_create(scene, &desc, NULL, 1, &pose, NULL), FACET_OK);
        assert_int_equal(pose.instances[0].material, expected[i]);
        assert_ptr_equal(scene_pose_material(scene, &pose, &pose.instances[0]), &materials[expected[i]]);
        scene_pose_destroy(&pose);
    }
    scene_pose pose;
    facet_error error;
    facet_pose_desc desc = {.has_variant = true, .variant = 2};
    assert_int_equal(scene_pose_create(scene, &desc, NULL, 1, &pose, &error), FACET_ERROR_ARGUMENT);
    assert_string_equal(error.message, "test: has no variant 2; the last one is 1");
    scene_destroy(scene);
}

static void moved_materials_are_the_pose_s_own(void **state)
{
    (void)state;
    static const float times[2] = {0, 1};
    static const float values[2] = {0, 1};
    facet_scene *scene = make_scene(mat4_identity());
    scene_material material = scene_material_default();
    scene->materials = &material;
    scene->material_count = 1;
    scene->meshes[0].primitives[0].material = 0;
    const test_channel channel = {
        {.kind = SCENE_TARGET_MATERIAL, .offset = offsetof(scene_material, metallic)},
        {SCENE_LINEAR, 2, times, 1, values}};
    test_animation(scene, &channel, 1);
    scene_pose pose = test_pose_at(scene, 1, 0.25, 1);
    assert_near(scene_pose_material(scene, &pose, &pose.instances[0])->metallic, 0.25, 0);
    assert_near(material.metallic, 1, 0);
    scene_pose_destroy(&pose);
    pose = test_pose_at(scene, 0, 0.25, 1);
    assert_ptr_equal(pose.materials, scene->materials);
    scene_pose_destroy(&pose);
    scene_destroy(scene);
}

/* ---- memory ---- */

/* Everything that moves, at once. */
static facet_scene *make_motion(void)
{
    static const uint32_t parents[4] = {SCENE_NONE, SCENE_NONE, 1, SCENE_NONE};
    static const float times[2] = {0, 1};
    static const float ones[6] = {0, 0, 0, 1, 1, 1};
    static const uint32_t joints[2] = {1, 2};
    facet_scene *scene = test_scene(4);
    test_tree(scene, parents);
    scene->nodes[0].mesh = scene->nodes[0].skin = scene->nodes[3].mesh = 0;
    scene_primitive *p = &scene->meshes[0].primitives[0];
    test_fill_primitive(scene, p, 300);
    uint16_t *numbers = arena_zalloc(scene->arena, 1200, sizeof *numbers);
    float *weights = arena_zalloc(scene->arena, 1200, sizeof *weights);
    scene_morph_target *target = arena_zalloc(scene->arena, 1, sizeof *target);
    scene->skins = arena_zalloc(scene->arena, 1, sizeof *scene->skins);
    scene->materials = arena_zalloc(scene->arena, 1, sizeof *scene->materials);
    for (uint32_t i = 0; i < 300; i++) {
        numbers[4 * i] = i % 2;
        weights[4 * i] = 1.0f;
    }
    target->positions = p->positions;
    scene->skins[0] = (scene_skin){.name = "", .joint_count = 2, .joints = joints};
    scene->materials[0] = scene_material_default();
    scene->skin_count = scene->material_count = 1;
    p->influence_count = 4;
    p->joints = numbers;
    p->weights = weights;
    p->target_count = scene->meshes[0].weight_count = 1;
    p->targets = target;
    scene->meshes[0].weights = ones;
    const test_channel channels[4] = {
        {{.index = 2, .offset = offsetof(scene_node, translation)}, {SCENE_LINEAR, 2, times, 3, ones}},
        {{.kind = SCENE_TARGET_WEIGHTS}, {SCENE_LINEAR, 2, times, 1, ones + 2}},
        {{.kind = SCENE_TARGET_WEIGHTS, .index = 3}, {SCENE_LINEAR, 2, times, 1, ones + 2}},
        {{.kind = SCENE_TARGET_MATERIAL, .offset = offsetof(scene_material, metallic)},
         {SCENE_LINEAR, 2, times, 1, ones}}};
    test_animation(scene, channels, 4);
    return scene;
}

static void failed_allocations_leak_nothing(void **state)
{
    (void)state;
    facet_scene *scene = make_motion();
    static const uint32_t first[1] = {0};
    facet_pose_desc desc = {.animation_count = 1, .animations = first, .time_s = 0.5};
    facet_result result = FACET_ERROR_MEMORY;
    long calls = 0;
    for (long at = 0; result == FACET_ERROR_MEMORY; at++) {
        failing_allocator memory = {.fail_at = at};
        facet_allocator allocator = failing_allocator_get(&memory);
        scene_pose pose;
        facet_error error;
        result = scene_pose_create(scene, &desc, &allocator, 2, &pose, &error);
        if (result == FACET_OK)
            assert_int_equal(pose.instance_count, 2);
        else
            assert_null(pose.instances);
        scene_pose_destroy(&pose);
        assert_int_equal(memory.blocks, 0);
        calls = at;
    }
    assert_int_equal(result, FACET_OK);
    assert_true(calls >= 12); /* state, hierarchy, skins, vertices, instances, bounds */
    scene_destroy(scene);
}

/* A skin's vertices do not follow the node: all instances are at one place, and as many as fit the memory
 * are written. */
static void instances_of_a_skin_are_one(void **state)
{
    (void)state;
    facet_scene *scene = make_motion();
    static const float translations[9] = {1, 0, 0, 2, 0, 0, 3, 0, 0};
    scene_instancing instancing = {.translations = translations};
    scene->nodes[0].instancing = &instancing;
    for (uint32_t count = 0; count <= 3; count++) {
        instancing.count = count;
        scene_pose pose = test_pose_at(scene, 1, 0.5, 2);
        uint32_t drawn = count > 0; /* and the node without a skin, which comes last */
        assert_int_equal(pose.instance_count, drawn + 1);
        for (uint32_t i = 0; i < drawn; i++)
            assert_near(pose.instances[i].world.m[12], 0, 0);
        assert_int_equal(pose.instances[drawn].node, 3);
        scene_pose_destroy(&pose);
    }
    scene_destroy(scene);
}

static void the_same_mesh_under_a_skin_and_a_node_differs(void **state)
{
    (void)state;
    facet_scene *scene = make_motion();
    scene_pose pose = test_pose_at(scene, 1, 0.5, 2);
    const float *p = scene->meshes[0].primitives[0].positions;
    assert_int_equal(pose.instance_count, 2);
    for (uint32_t i = 0; i < 900; i++) {
        /* Half of the target, which is the positions again; every second vertex follows joint 1, at 0.5 m. */
        double morphed = 1.5 * (double)p[i];
        assert_near(pose.instances[1].positions[i], morphed, 1e-6);
        assert_near(pose.instances[0].positions[i], morphed + (i / 3 % 2 ? 0.5 : 0.0), 1e-6);
    }
    scene_pose_destroy(&pose);
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bounds_exclude_unused_vertices),
        cmocka_unit_test(bounds_are_exact_when_turned),
        cmocka_unit_test(axis_aligned_bounds_equal_those_of_vertices),
        cmocka_unit_test(mirrored_instances_keep_outward_normals),
        cmocka_unit_test(singular_and_infinite_matrices_draw_nothing),
        cmocka_unit_test(small_models_are_regular),
        cmocka_unit_test(instances_beyond_the_limit_are_excluded),
        cmocka_unit_test(nodes_listed_twice_are_drawn_once),
        cmocka_unit_test(copies_stand_where_node_and_instance_put_them),
        cmocka_unit_test(too_many_copies_are_refused),
        cmocka_unit_test(copies_share_morphed_vertices),
        cmocka_unit_test(children_of_hidden_nodes_are_hidden),
        cmocka_unit_test(variants_choose_materials),
        cmocka_unit_test(moved_materials_are_the_pose_s_own),
        cmocka_unit_test(failed_allocations_leak_nothing),
        cmocka_unit_test(instances_of_a_skin_are_one),
        cmocka_unit_test(the_same_mesh_under_a_skin_and_a_node_differs),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
