/* fit_test.c - framing: everything is in the image, and something touches its border, also in motion. */
#include "scene/keyframes.h"
#include "scene/motion_test_support.h"
#include "tests/support/support.h"

#include <math.h>
#include <string.h>

enum { COUNT = 400 };
static float positions[3 * COUNT];
static uint32_t indices[COUNT];

/* Points on an odd shape around (5, -3, 2), after a fixed recipe. */
static facet_scene *make_scene(void)
{
    uint32_t random = 12345;
    scene_primitive p = {.mode = SCENE_POINTS,
                         .vertex_count = COUNT,
                         .index_count = COUNT,
                         .indices = indices,
                         .positions = positions,
                         .material = SCENE_NONE};
    const float extent[3] = {1.0f, 0.3f, 2.0f};
    const float middle[3] = {5, -3, 2};
    for (int k = 0; k < 3; k++) {
        p.bounds_min[k] = 1e9f;
        p.bounds_max[k] = -1e9f;
    }
    for (uint32_t i = 0; i < COUNT; i++) {
        indices[i] = i;
        for (uint32_t k = 0; k < 3; k++) {
            lcg_next(&random);
            float value = middle[k] + extent[k] * ((float)(random >> 8) / 8388608.0f - 1.0f);
            positions[3 * i + k] = value;
            p.bounds_min[k] = fminf(p.bounds_min[k], value);
            p.bounds_max[k] = fmaxf(p.bounds_max[k], value);
        }
    }
    facet_scene *scene = test_scene(1);
    scene->meshes[0].primitives[0] = p;
    return scene;
}

/* How far a vertex is from the center of the image, 1: on its border; behind the camera it is infinite. */
static double reach(const facet_camera *camera, double aspect, const float point[3])
{
    double axis[3], up[3], right[3], v[3];
    double length = 0, along = 0;
    for (int k = 0; k < 3; k++) {
        axis[k] = (double)camera->target[k] - (double)camera->eye[k];
        length += axis[k] * axis[k];
        v[k] = (double)point[k] - (double)camera->eye[k];
    }
    for (int k = 0; k < 3; k++) {
        axis[k] /= sqrt(length);
        along += axis[k] * (double)camera->up[k];
    }
    length = 0;
    for (int k = 0; k < 3; k++) {
        up[k] = (double)camera->up[k] - along * axis[k];
        length += up[k] * up[k];
    }
    double x = 0, y = 0, z = 0;
    for (int k = 0; k < 3; k++)
        up[k] /= sqrt(length);
    for (int k = 0; k < 3; k++) {
        right[k] = axis[(k + 1) % 3] * up[(k + 2) % 3] - axis[(k + 2) % 3] * up[(k + 1) % 3];
        x += v[k] * right[k];
        y += v[k] * up[k];
        z += v[k] * axis[k];
    }
    double half = camera->fov_y_rad > 0.0f ? tan(0.5 * (double)camera->fov_y_rad) * z
                                           : 0.5 * (double)camera->ortho_height;
    return z > 0.0 ? fmax(fabs(x) / (half * aspect), fabs(y) / half) : HUGE_VAL;
}

static double farthest_reach(const facet_camera *camera, double aspect)
{
    double most = 0.0;
    for (int i = 0; i < COUNT; i++)
        most = fmax(most, reach(camera, aspect, positions + 3 * i));
    return most;
}

static const float ANGLES[][2] = {{0, 1.3f}, {0.7f, 0.9f},     {-2.5f, 1.57079633f},
                                  {3, 0},    {1, 3.14159265f}, {4, 2.2f}};
enum { ANGLE_COUNT = 6 };

static void the_outermost_vertex_touches_the_border(void **state)
{
    (void)state;
    facet_scene *scene = make_scene();
    static const float aspects[] = {1.0f, 1.7778f, 0.5f};
    for (int i = 0; i < ANGLE_COUNT * 3 * 2 * 2; i++) {
        facet_orbit orbit = {.azimuth_rad = ANGLES[i % ANGLE_COUNT][0],
                             .polar_rad = ANGLES[i % ANGLE_COUNT][1],
                             .radius_scale = 1.0f,
                             .fov_y_rad = 0.6f,
                             .is_orthographic = i / ANGLE_COUNT % 2 != 0,
                             .is_z_up = i / ANGLE_COUNT / 2 % 2 != 0};
        float aspect = aspects[i / ANGLE_COUNT / 4];
        facet_camera camera;
        assert_int_equal(scene_fit_orbit(scene, NULL, &orbit, aspect, &camera, NULL), FACET_OK);
        assert_near(farthest_reach(&camera, (double)aspect), 1.0, 1e-5);
    }
    scene_destroy(scene);
}

static void a_turntable_keeps_its_distance_and_crops_nothing(void **state)
{
    (void)state;
    facet_scene *scene = make_scene();
    scene_pose pose;
    assert_int_equal(scene_pose_create(scene, NULL, NULL, 1, &pose, NULL), FACET_OK);
    for (int i = 0; i < ANGLE_COUNT * 2; i++) {
        double most = 0.0;
        double distance = 0.0;
        for (int step = 0; step < 720; step++) {
            facet_orbit orbit = {.azimuth_rad = (float)step * 0.00872664626f,
                                 .polar_rad = ANGLES[i % ANGLE_COUNT][1],
                                 .radius_scale = 1.0f,
                                 .fov_y_rad = 0.6f,
                                 .is_orthographic = i >= ANGLE_COUNT,
                                 .fits_all_azimuths = true};
            facet_camera camera;
            assert_int_equal(scene_fit_pose(scene, &pose, &orbit, 1.5f, 1, &camera, NULL), FACET_OK);
            double own = 0.0;
            for (int k = 0; k < 3; k++)
                own += pow((double)camera.eye[k] - (double)camera.target[k], 2);
            distance = step == 0 ? sqrt(own) : distance;
            assert_near(sqrt(own), distance, 1e-5 * distance);
            most = fmax(most, farthest_reach(&camera, 1.5));
        }
        /* Exact for the whole turn: some azimuth touches the border, half a degree of steps aside. */
        assert_near(most, 1.0, 2e-4);
        assert_true(most <= 1.0 + 1e-5);
    }
    scene_pose_destroy(&pose);
    scene_destroy(scene);
}

static void angles_are_those_of_model_viewer(void **state)
{
    (void)state;
    facet_scene *scene = make_scene();
    static const struct {
        float azimuth, polar, direction[3];
        bool is_z_up;
    } cases[] = {{0, 1.57079633f, {0, 0, 1}, false},
                 {1.57079633f, 1.57079633f, {1, 0, 0}, false},
                 {0, 0, {0, 1, 0}, false},
                 {0, 1.57079633f, {0, -1, 0}, true},
                 {1.57079633f, 1.57079633f, {1, 0, 0}, true},
                 {0, 0, {0, 0, 1}, true}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        facet_orbit orbit = {.azimuth_rad = cases[i].azimuth,
                             .polar_rad = cases[i].polar,
                             .radius = 7,
                             .fov_y_rad = 0.5f,
                             .target = {1, 2, 3},
                             .has_target = true,
                             .is_z_up = cases[i].is_z_up};
        facet_camera camera;
        assert_int_equal(scene_fit_orbit(scene, NULL, &orbit, 1, &camera, NULL), FACET_OK);
        for (int k = 0; k < 3; k++)
            assert_near(camera.eye[k], orbit.target[k] + 7 * cases[i].direction[k], 1e-5);
    }
    scene_destroy(scene);
}

static void every_size_is_framed_alike(void **state)
{
    (void)state;
    static const float scales[] = {1e-4f, 1, 1e6f};
    facet_scene *scene = make_scene();
    double distances[3];
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++)
            scene->nodes[0].scale[k] = scales[i];
        facet_orbit orbit = {.polar_rad = 1.3f, .radius_scale = 1.05f, .fov_y_rad = 0.5f};
        facet_camera camera;
        assert_int_equal(scene_fit_orbit(scene, NULL, &orbit, 1.5f, &camera, NULL), FACET_OK);
        distances[i] = ((double)camera.eye[2] - (double)camera.target[2]) / (double)scales[i];
    }
    assert_near(distances[0], distances[1], 1e-4 * distances[1]);
    assert_near(distances[2], distances[1], 1e-4 * distances[1]);
    scene_destroy(scene);
}

static void empty_scenes_and_single_points_have_a_camera(void **state)
{
    (void)state;
    for (uint32_t points = 0; points < 2; points++) {
        facet_scene *scene = make_scene();
        scene_primitive *p = &scene->meshes[0].primitives[0];
        p->index_count = points;
        memcpy(p->bounds_min, positions, sizeof p->bounds_min);
        memcpy(p->bounds_max, positions, sizeof p->bounds_max);
        for (int orthographic = 0; orthographic < 2; orthographic++) {
            facet_orbit orbit = {.polar_rad = 1.3f,
                                 .radius_scale = 1.05f,
                                 .fov_y_rad = 0.5f,
                                 .is_orthographic = orthographic != 0};
            facet_camera camera;
            assert_int_equal(scene_fit_orbit(scene, NULL, &orbit, 1, &camera, NULL), FACET_OK);
            double distance = 0.0;
            for (int k = 0; k < 3; k++)
                distance += fabs((double)camera.eye[k] - (double)camera.target[k]);
            assert_true(distance > 0.1 && distance < 100.0);
            assert_true(orthographic ? camera.ortho_height > 1.0f : camera.fov_y_rad == 0.5f);
        }
        scene_destroy(scene);
    }
}

static void invalid_orbits_are_refused(void **state)
{
    (void)state;
    const facet_orbit good = {.polar_rad = 1, .radius_scale = 1, .fov_y_rad = 0.5f};
    facet_orbit bad[6] = {good, good, good, good, good, good};
    bad[0].fov_y_rad = 0;
    bad[1].fov_y_rad = 4;
    bad[2].radius_scale = -1;
    bad[3].azimuth_rad = NAN;
    bad[4].radius = INFINITY;
    bad[5].has_target = true;
    bad[5].target[1] = NAN;
    facet_scene *scene = make_scene();
    facet_camera camera;
    facet_error error;
    for (int i = 0; i < 6; i++)
        assert_int_equal(scene_fit_orbit(scene, NULL, &bad[i], 1, &camera, &error), FACET_ERROR_ARGUMENT);
    assert_int_equal(scene_fit_orbit(scene, NULL, &good, 0, &camera, &error), FACET_ERROR_ARGUMENT);
    assert_int_equal(scene_fit_orbit(scene, &(facet_pose_desc){.has_scene_index = true, .scene_index = 9},
                                     &good, 1, &camera, &error),
                     FACET_ERROR_ARGUMENT);
    scene_destroy(scene);
}

/* ---- motion ---- */

/* The cloud of points rises, comes back and turns, in 2 s, with keys off the even steps. */
static facet_scene *make_moving(void)
{
    static const float times[3] = {0, 0.61f, 2};
    static const float translations[9] = {0, 0, 0, 4, 9, -3, -2, 0, 0};
    static const float rotations[12] = {0, 0, 0, 1, 0, 0.6f, 0, 0.8f, 0.6f, 0, 0.8f, 0};
    const test_channel channels[2] = {
        {{.offset = offsetof(scene_node, translation)}, {SCENE_LINEAR, 3, times, 3, translations}},
        {{.offset = offsetof(scene_node, rotation), .is_rotation = true},
         {SCENE_LINEAR, 3, times, 4, rotations}}};
    facet_scene *scene = make_scene();
    test_animation(scene, channels, 2);
    return scene;
}

static const uint32_t FIRST_ANIMATION[1] = {0};

/* The farthest reach of all points at all times that the camera was made for. */
static double farthest_ever(const facet_scene *scene, const facet_camera *camera, double aspect)
{
    facet_pose_desc desc = {.animation_count = 1, .animations = FIRST_ANIMATION};
    keyframe_times list;
    double most = 0.0;
    keyframes_list_times(scene, &desc, &list);
    for (uint32_t i = 0; i < list.count; i++) {
        scene_pose pose = test_pose_at(scene, 1, list.times[i], 1);
        for (int k = 0; k < COUNT; k++) {
            float world[3];
            mat4_transform_point(&pose.instances[0].world, positions + 3 * k, world);
            most = fmax(most, reach(camera, aspect, world));
        }
        scene_pose_destroy(&pose);
    }
    return most;
}

static void a_whole_animation_touches_the_border(void **state)
{
    (void)state;
    facet_scene *scene = make_moving();
    facet_pose_desc desc = {.animation_count = 1, .animations = FIRST_ANIMATION, .time_s = 0.4};
    for (int i = 0; i < ANGLE_COUNT * 4; i++) {
        facet_orbit orbit = {.azimuth_rad = ANGLES[i % ANGLE_COUNT][0],
                             .polar_rad = ANGLES[i % ANGLE_COUNT][1],
                             .radius_scale = 1.0f,
                             .fov_y_rad = 0.6f,
                             .is_orthographic = i / ANGLE_COUNT % 2 != 0,
                             .has_target = i / ANGLE_COUNT / 2 != 0,
                             .target = {3, 2, 1},
                             .fits_all_times = true};
        facet_camera camera, later, still;
        assert_int_equal(scene_fit_orbit(scene, &desc, &orbit, 1.5f, &camera, NULL), FACET_OK);
        assert_near(farthest_ever(scene, &camera, 1.5), 1.0, 1e-5);
        /* Whatever the time; and one time alone is framed closer. */
        desc.time_s = 1.7;
        assert_int_equal(scene_fit_orbit(scene, &desc, &orbit, 1.5f, &later, NULL), FACET_OK);
        assert_memory_equal(&camera, &later, sizeof camera);
        orbit.fits_all_times = false;
        assert_int_equal(scene_fit_orbit(scene, &desc, &orbit, 1.5f, &still, NULL), FACET_OK);
        assert_true(farthest_ever(scene, &still, 1.5) > 1.1);
    }
    scene_destroy(scene);
}

static void the_target_is_the_center_of_the_animation(void **state)
{
    (void)state;
    /* One point that moves from (0, 0, 0) over (8, 2, 0) to (4, 0, -6). */
    static const float times[3] = {1, 2, 4};
    static const float translations[9] = {0, 0, 0, 8, 2, 0, 4, 0, -6};
    static const float origin[3] = {0, 0, 0};
    static const uint32_t index[1] = {0};
    facet_scene *scene = test_scene(1);
    scene->meshes[0].primitives[0] = (scene_primitive){.mode = SCENE_POINTS,
                                                       .vertex_count = 1,
                                                       .index_count = 1,
                                                       .indices = index,
                                                       .positions = origin,
                                                       .material = SCENE_NONE};
    const test_channel channel = {{.offset = offsetof(scene_node, translation)},
                                  {SCENE_LINEAR, 3, times, 3, translations}};
    test_animation(scene, &channel, 1);
    facet_pose_desc desc = {.animation_count = 1, .animations = FIRST_ANIMATION};
    facet_orbit orbit = {
        .polar_rad = 1.57079633f, .radius_scale = 1, .fov_y_rad = 0.5f, .fits_all_times = true};
    facet_camera camera;
    assert_int_equal(scene_fit_orbit(scene, &desc, &orbit, 1, &camera, NULL), FACET_OK);
    const float middle[3] = {4, 1, -3};
    for (int k = 0; k < 3; k++)
        assert_near(camera.target[k], middle[k], 1e-6);
    /* The nearest that frames x in [-4, 4] at z = 0 is 4 / tan(0.25) from the point there, 3 m before the
     * target. */
    assert_near(camera.eye[2] - camera.target[2], 3.0 + 4.0 / tan(0.25), 1e-4);
    scene_destroy(scene);
}

static void a_turntable_of_an_animation_crops_nothing(void **state)
{
    (void)state;
    facet_scene *scene = make_moving();
    facet_pose_desc desc = {.animation_count = 1, .animations = FIRST_ANIMATION};
    double most = 0.0;
    for (int step = 0; step < 60; step++) {
        facet_orbit orbit = {.azimuth_rad = (float)step * 0.104719755f,
                             .polar_rad = 1.2f,
                             .radius_scale = 1.0f,
                             .fov_y_rad = 0.6f,
                             .fits_all_azimuths = true,
                             .fits_all_times = true};
        facet_camera camera;
        assert_int_equal(scene_fit_orbit(scene, &desc, &orbit, 1.5f, &camera, NULL), FACET_OK);
        most = fmax(most, farthest_ever(scene, &camera, 1.5));
    }
    assert_true(most <= 1.0 + 1e-5 && most > 0.98); /* steps of 6 degrees */
    scene_destroy(scene);
}

static void times_are_the_keys_and_24_per_second(void **state)
{
    (void)state;
    enum { KEYS = 300 };
    static float times[KEYS], values[3 * KEYS];
    facet_pose_desc desc = {.animation_count = 1, .animations = FIRST_ANIMATION};
    static const struct {
        float begin, step;
        uint32_t keys, expected;
    } cases[] = {
        {3, 1, 1, 1},           /* one key: one time */
        {0, 1, 2, 25},          /* 0, 1/24 .. 1 */
        {0, 1.0f / 24, 25, 25}, /* keys on the even steps */
        {0, 0.37f, 2, 10},      /* 8.88 steps: 9 */
        {0, 0.01f, 100, 121}, /* keys, and 24 steps of 0.04125 s between, of which 0.33 and 0.66 s are keys */
        {0, 0.001f, KEYS, SCENE_FIT_TIMES},
        {-5, 20, 2, SCENE_FIT_TIMES},
        {0, 1e36f, 2, SCENE_FIT_TIMES}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        facet_scene *scene = make_scene();
        for (uint32_t k = 0; k < cases[i].keys; k++)
            times[k] = cases[i].begin + cases[i].step * (float)k;
        const test_channel channel = {{.offset = offsetof(scene_node, translation)},
                                      {SCENE_LINEAR, cases[i].keys, times, 3, values}};
        test_animation(scene, &channel, 1);
        keyframe_times list;
        keyframes_list_times(scene, &desc, &list);
        assert_int_equal(list.count, cases[i].expected);
        assert_true(list.times[0] == (double)times[0]);
        assert_near(list.times[list.count - 1], times[cases[i].keys - 1],
                    1e-6 * fabs((double)times[cases[i].keys - 1]));
        double span = (double)times[cases[i].keys - 1] - (double)times[0];
        for (uint32_t k = 1; k < list.count; k++) {
            double gap = list.times[k] - list.times[k - 1];
            assert_true(gap > 0.0 && gap <= fmax(1.0 / 24.0 + 1e-3, span / 255.0 * 1.001));
        }
        /* Every key is in the list if there is room for all. */
        for (uint32_t k = 0; k < cases[i].keys && list.count < SCENE_FIT_TIMES; k++) {
            bool is_there = false;
            for (uint32_t n = 0; n < list.count; n++)
                is_there |= list.times[n] == (double)times[k];
            assert_true(is_there);
        }
        scene_destroy(scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_outermost_vertex_touches_the_border),
        cmocka_unit_test(a_turntable_keeps_its_distance_and_crops_nothing),
        cmocka_unit_test(angles_are_those_of_model_viewer),
        cmocka_unit_test(every_size_is_framed_alike),
        cmocka_unit_test(empty_scenes_and_single_points_have_a_camera),
        cmocka_unit_test(invalid_orbits_are_refused),
        cmocka_unit_test(a_whole_animation_touches_the_border),
        cmocka_unit_test(the_target_is_the_center_of_the_animation),
        cmocka_unit_test(a_turntable_of_an_animation_crops_nothing),
        cmocka_unit_test(times_are_the_keys_and_24_per_second),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
