/* framing_test.c - bounds and framing exclude geometry that no camera sees and few distant parts; many
 * instances give the same vertices as one. */
#include "scene/bounds.h"
#include "scene/motion_test_support.h"
#include "scene/stray.h"
#include "scene/unseen.h"
#include "scene/vertex_tree.h"

enum { CORNERS = 300, FAR_CORNERS = 3 };

/* ---- scenes ---- */

/* Node i has mesh i: triangles in [-1, 1]^3, with a material of its own. */
static facet_scene *make_parts(uint32_t count, const uint32_t *corners)
{
    facet_scene *scene = test_scene(count);
    scene->materials = arena_zalloc(scene->arena, count, sizeof *scene->materials);
    assert_non_null(scene->materials);
    scene->material_count = count;
    for (uint32_t i = 0; i < count; i++) {
        scene->materials[i] = scene_material_default();
        test_fill_primitive(scene, &scene->meshes[i].primitives[0], corners[i]);
        scene->meshes[i].primitives[0].material = i;
    }
    return scene;
}

static facet_camera fit(const facet_scene *scene, bool includes_far_parts, const facet_log *log)
{
    facet_orbit orbit = scene_orbit_default();
    facet_camera camera;
    orbit.includes_far_parts = includes_far_parts;
    if (log)
        orbit.log = *log;
    assert_int_equal(scene_fit_orbit(scene, NULL, &orbit, 1.5f, &camera, NULL), FACET_OK);
    return camera;
}

static void count_warning(void *user, facet_log_level level, const char *text)
{
    assert_int_equal(level, FACET_LOG_LEVEL_WARNING);
    assert_non_null(strstr(text, "--framing all"));
    ++*(int *)user;
}

/* The frame equals that of the scene without its last node. */
static void expect_without_last(facet_scene *scene, int wanted_warnings)
{
    int warnings = 0;
    const facet_log log = {&warnings, count_warning};
    facet_camera camera = fit(scene, false, &log);
    facet_camera all = fit(scene, true, &log);
    assert_int_equal(warnings, wanted_warnings);
    scene->nodes[scene->node_count - 1].mesh = SCENE_NONE;
    facet_camera rest = fit(scene, false, NULL);
    assert_memory_equal(&camera, &rest, sizeof camera);
    assert_true(wanted_warnings == 0 || memcmp(&all, &rest, sizeof all) != 0);
    scene_destroy(scene);
}

/* ---- unseen ---- */

static void transparent_parts_do_not_count(void **state)
{
    (void)state;
    static const struct {
        scene_alpha_mode mode;
        float alpha, vertex_alpha;
        bool is_unseen;
    } cases[] = {{SCENE_ALPHA_BLEND, 0, 1, true},     {SCENE_ALPHA_BLEND, 1, 0, true},
                 {SCENE_ALPHA_BLEND, .01f, 1, false}, {SCENE_ALPHA_MASK, .4f, 1, true},
                 {SCENE_ALPHA_MASK, 1, .4f, true},    {SCENE_ALPHA_MASK, .5f, 1, false},
                 {SCENE_ALPHA_OPAQUE, 0, 0, false}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        facet_scene *scene = make_parts(2, (const uint32_t[]){CORNERS, CORNERS});
        float *colors = arena_zalloc(scene->arena, CORNERS, 4 * sizeof *colors);
        for (int k = 0; k < CORNERS; k++)
            colors[4 * k + 3] = cases[i].vertex_alpha;
        scene->meshes[1].primitives[0].colors = colors;
        scene->materials[1].alpha_mode = cases[i].mode;
        scene->materials[1].base_color[3] = cases[i].alpha;
        scene->nodes[1].translation[0] = 20;
        scene_pose pose;
        assert_int_equal(scene_pose_create(scene, NULL, NULL, 1, &pose, NULL), FACET_OK);
        assert_int_equal(pose.instance_count, 2);
        assert_true(pose.instances[1].is_unseen == cases[i].is_unseen);
        assert_true((pose.bounds_max[0] < 2.0f) == cases[i].is_unseen);
        scene_pose_destroy(&pose);
        if (cases[i].is_unseen)
            expect_without_last(scene, 0);
        else
            scene_destroy(scene);
    }
}

/* A scene without visible geometry has the bounds of all of it. */
static void invisible_scenes_have_bounds(void **state)
{
    (void)state;
    facet_scene *scene = make_parts(1, (const uint32_t[]){CORNERS});
    scene->materials[0].alpha_mode = SCENE_ALPHA_BLEND;
    scene->materials[0].base_color[3] = 0;
    scene_pose pose;
    assert_int_equal(scene_pose_create(scene, NULL, NULL, 1, &pose, NULL), FACET_OK);
    assert_true(pose.has_bounds && pose.is_unseen && pose.bounds_max[0] > 0.5f);
    scene_pose_destroy(&pose);
    scene_destroy(scene);
}

/* Three equal corners, three on a line, and a thin one that has an area. */
static void triangles_without_area_do_not_count(void **state)
{
    (void)state;
    static const struct {
        float corners[9];
        bool is_flat;
    } cases[] = {{{1e5f, 0, 0, 1e5f, 0, 0, 1e5f, 0, 0}, true},
                 {{100, 1, 2, 300, 5, 4, 200, 3, 3}, true},
                 {{100, 0, 0, 300, 0, 0, 200, .01f, 0}, false}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        for (int is_turned = 0; is_turned < 2; is_turned++) {
            facet_scene *scene = make_parts(1, (const uint32_t[]){CORNERS});
            scene_primitive *p = &scene->meshes[0].primitives[0];
            p->index_count = CORNERS - 3;
            if (is_turned)
                memcpy(scene->nodes[0].rotation, (const float[]){.6f, 0, 0, .8f}, 4 * sizeof(float));
            unseen_tighten_bounds(scene);
            facet_camera rest = fit(scene, true, NULL);
            float *positions = arena_alloc(scene->arena, CORNERS, 3 * sizeof *positions);
            memcpy(positions, p->positions, CORNERS * 3 * sizeof *positions);
            memcpy(positions + 3 * (CORNERS - 3), cases[i].corners, sizeof cases[i].corners);
            p->positions = positions;
            p->index_count = CORNERS;
            p->bounds_max[0] = 300; /* as a reader finds it */
            unseen_tighten_bounds(scene);
            assert_true(p->has_flat_triangles == cases[i].is_flat && !p->is_flat);
            facet_camera camera = fit(scene, true, NULL);
            assert_true((memcmp(&camera, &rest, sizeof rest) == 0) == cases[i].is_flat);
            scene_destroy(scene);
        }
    facet_scene *scene = make_parts(2, (const uint32_t[]){CORNERS, FAR_CORNERS});
    scene_primitive *p = &scene->meshes[1].primitives[0];
    p->positions = cases[1].corners;
    unseen_tighten_bounds(scene);
    assert_true(p->is_flat);
    scene->nodes[1].translation[1] = 1000;
    expect_without_last(scene, 0);
}

/* ---- strays ---- */

static void few_distant_parts_are_excluded(void **state)
{
    (void)state;
    static const double places[][3] = {{1e3, 0, 0}, {0, -1e5, 40}, {-300, 200, 100}, {0, 0, 1e9}};
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        facet_scene *scene = make_parts(2, (const uint32_t[]){CORNERS, FAR_CORNERS});
        for (int k = 0; k < 3; k++)
            scene->nodes[1].translation[k] = places[i][k];
        expect_without_last(scene, 1);
    }
}

/* On opposite sides, so that the middle of the bounds is the model itself, and behind each other. */
static void several_strays_are_excluded(void **state)
{
    (void)state;
    static const double places[][4] = {{1e3, -1e3, 5e3, 200}, {3e2, 1e3, 1e4, 1e5}};
    for (int i = 0; i < 2; i++) {
        facet_scene *scene = make_parts(5, (const uint32_t[]){CORNERS, 3, 3, 3, 3});
        facet_camera alone;
        for (int k = 0; k < 4; k++)
            scene->nodes[k + 1].translation[k % (2 - i)] = places[i][k];
        facet_camera camera = fit(scene, false, NULL);
        for (int k = 0; k < 4; k++)
            scene->nodes[k + 1].mesh = SCENE_NONE;
        alone = fit(scene, false, NULL);
        assert_memory_equal(&camera, &alone, sizeof camera);
        scene_destroy(scene);
    }
}

/* One triangle of the same mesh. */
static void a_stray_may_be_of_the_same_mesh(void **state)
{
    (void)state;
    facet_scene *scene = make_parts(1, (const uint32_t[]){CORNERS});
    scene_primitive *p = &scene->meshes[0].primitives[0];
    p->index_count = CORNERS - 3;
    unseen_tighten_bounds(scene);
    facet_camera rest = fit(scene, false, NULL);
    float *positions = arena_alloc(scene->arena, CORNERS, 3 * sizeof *positions);
    memcpy(positions, p->positions, CORNERS * 3 * sizeof *positions);
    for (int k = 0; k < 3; k++)
        positions[3 * (CORNERS - 3 + k) + 2] += 5000;
    p->positions = positions;
    p->index_count = CORNERS;
    unseen_tighten_bounds(scene);
    facet_camera camera = fit(scene, false, NULL);
    assert_memory_equal(&camera, &rest, sizeof camera);
    scene_destroy(scene);
}

/* Subjects to be shown whole: an object with its context, equal objects far apart, a thin wall with
 * something in front of it, a row of objects. */
static void ordinary_scenes_have_no_strays(void **state)
{
    (void)state;
    static const struct {
        uint32_t count, corners[5];
        double x[5], scale[5];
    } cases[] = {
        {2, {3000, 6}, {0, 0}, {1, 1000}},            /* on a wide ground */
        {2, {300, 300}, {0, 1e6}, {1, 1}},            /* which of them is stray? */
        {3, {300, 300, 300}, {0, 3, 1e4}, {1, 1, 1}}, /* two of three are not enough */
        {2, {3000, 3}, {0, 40}, {1, 1}},              /* 40 times its size away: seen well */
        {5, {900, 3, 3, 3, 3}, {0, 50, 1000, 2e4, 4e5}, {1, 1, 1, 1, 1}}}; /* each not far from the last */
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        facet_scene *scene = make_parts(cases[i].count, cases[i].corners);
        for (uint32_t k = 0; k < cases[i].count; k++) {
            scene->nodes[k].translation[0] = cases[i].x[k];
            for (int axis = 0; axis < 3; axis++)
                scene->nodes[k].scale[axis] = (float)cases[i].scale[k];
        }
        int warnings = 0;
        const facet_log log = {&warnings, count_warning};
        facet_camera camera = fit(scene, false, &log);
        facet_camera all = fit(scene, true, NULL);
        assert_memory_equal(&camera, &all, sizeof camera);
        assert_int_equal(warnings, 0);
        scene_destroy(scene);
    }
}

/* Two triangles, 2 km wide, under a thing of 2 m. */
static void a_ground_is_not_stray(void **state)
{
    (void)state;
    static const float ground[18] = {-1, -1, -1, 1, -1, -1, 1, -1, 1, -1, -1, -1, 1, -1, 1, -1, -1, 1};
    facet_scene *scene = make_parts(2, (const uint32_t[]){3000, 6});
    scene_primitive *p = &scene->meshes[1].primitives[0];
    p->positions = ground;
    unseen_tighten_bounds(scene);
    scene->nodes[1].scale[0] = scene->nodes[1].scale[2] = 1000;
    facet_camera camera = fit(scene, false, NULL);
    facet_camera all = fit(scene, true, NULL);
    assert_memory_equal(&camera, &all, sizeof camera);
    scene_destroy(scene);
}

/* ---- many instances ---- */

/* Nodes that share a mesh have the same bounds, to the last bit, as nodes with separate vertices. */
static void shared_vertices_are_bounded_exactly(void **state)
{
    (void)state;
    enum { NODES = 150, VERTICES = 3000 };
    facet_scene *scene = test_scene(NODES);
    uint32_t random = 5;
    scene_primitive *shared = &scene->meshes[0].primitives[0];
    test_fill_primitive(scene, shared, VERTICES);
    scene_primitive *copies = arena_alloc(scene->arena, NODES, sizeof *copies);
    for (int i = 0; i < NODES; i++) {
        scene->nodes[i].mesh = 0;
        test_random_rotation(&random, scene->nodes[i].rotation);
        scene->nodes[i].translation[0] = 1.5 * i; /* each leaves the bounds of those before */
        scene->nodes[i].translation[1] = (double)test_random(&random);
    }
    for (int is_shared = 1; is_shared >= 0; is_shared--) {
        static scene_pose pose[2];
        static facet_camera cameras[2][3];
        for (int i = 0; i < NODES && !is_shared; i++) {
            copies[i] = *shared;
            scene->nodes[i].mesh = (uint32_t)i;
            scene->meshes[i].primitives = &copies[i];
            scene->meshes[i].primitive_count = 1;
        }
        assert_int_equal(scene_pose_create(scene, NULL, NULL, 2, &pose[is_shared], NULL), FACET_OK);
        for (int i = 0; i < 3; i++) {
            facet_orbit orbit = scene_orbit_default();
            orbit.azimuth_rad = (float)i;
            orbit.is_orthographic = i == 1;
            orbit.fits_all_azimuths = i == 2;
            assert_int_equal(scene_fit_orbit(scene, NULL, &orbit, 1.5f, &cameras[is_shared][i], NULL),
                             FACET_OK);
        }
        if (!is_shared) {
            assert_memory_equal(pose[0].bounds_min, pose[1].bounds_min, sizeof pose[0].bounds_min);
            assert_memory_equal(pose[0].bounds_max, pose[1].bounds_max, sizeof pose[0].bounds_max);
            assert_memory_equal(cameras[0], cameras[1], sizeof cameras[0]);
            scene_pose_destroy(&pose[0]);
            scene_pose_destroy(&pose[1]);
        }
    }
    scene_destroy(scene);
}

/* The tree holds each vertex that a triangle uses. */
typedef struct seen_vertices {
    uint32_t count;
    box bounds;
} seen_vertices;

static double always(void *context, const box *bounds)
{
    (void)context;
    (void)bounds;
    return 1.0;
}

static void see(void *context, const vertex_block *blocks, uint32_t count)
{
    seen_vertices *seen = context;
    seen->count += count * VERTEX_LANES;
    for (uint32_t i = 0; i < count; i++)
        for (int lane = 0; lane < VERTEX_LANES; lane++)
            box_add(&seen->bounds,
                    (const float[3]){blocks[i].xyz[0][lane], blocks[i].xyz[1][lane], blocks[i].xyz[2][lane]});
}

static void trees_hold_all_vertices(void **state)
{
    (void)state;
    for (uint32_t count = 3; count < 20000; count = count * 5 / 6 * 3) {
        facet_scene *scene = test_scene(1);
        scene_primitive *p = &scene->meshes[0].primitives[0];
        test_fill_primitive(scene, p, count);
        vertex_tree tree;
        assert_true(vertex_tree_create(p, NULL, &tree));
        seen_vertices seen = {.bounds = box_empty()};
        vertex_tree_visit(&tree, &(vertex_visitor){&seen, always, see});
        assert_true(seen.count >= count && seen.count <= count + count / 32 + VERTEX_LANES);
        assert_memory_equal(seen.bounds.minimum, p->bounds_min, sizeof p->bounds_min);
        assert_memory_equal(seen.bounds.maximum, p->bounds_max, sizeof p->bounds_max);
        vertex_tree_destroy(&tree);
        scene_destroy(scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(transparent_parts_do_not_count),
        cmocka_unit_test(invisible_scenes_have_bounds),
        cmocka_unit_test(triangles_without_area_do_not_count),
        cmocka_unit_test(few_distant_parts_are_excluded),
        cmocka_unit_test(several_strays_are_excluded),
        cmocka_unit_test(a_stray_may_be_of_the_same_mesh),
        cmocka_unit_test(ordinary_scenes_have_no_strays),
        cmocka_unit_test(a_ground_is_not_stray),
        cmocka_unit_test(shared_vertices_are_bounded_exactly),
        cmocka_unit_test(trees_hold_all_vertices),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
