/* motion_test.c - animations through the public interface: models at several times against another
 * implementation's vertices, names and lengths of animations, cameras that move. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "tests/support/support.h"
#include "scene/scene.h"

/* NULL, after a line that says so, where there is no such model. */
static facet_scene *load_model(const char *name)
{
    const char *folder = getenv("FACET_TEST_DATA");
    char path[1024];
    snprintf(path, sizeof path, "%s/models/animation/%s", folder ? folder : "", name);
    FILE *file = folder ? fopen(path, "rb") : NULL;
    if (!file) {
        print_message("skipped: FACET_TEST_DATA has no models/animation/%s\n", name);
        return NULL;
    }
    fclose(file);
    facet_scene *scene = NULL;
    facet_error error;
    if (facet_scene_load(path, NULL, &scene, &error) != FACET_OK)
        fail_msg("%s", error.message);
    return scene;
}

static scene_pose pose_at(const facet_scene *scene, int animation, double time_s)
{
    uint32_t index = (uint32_t)animation;
    facet_error error;
    scene_pose pose;
    facet_pose_desc desc = {.animation_count = animation >= 0, .animations = &index, .time_s = time_s};
    if (scene_pose_create(scene, &desc, NULL, 2, &pose, &error) != FACET_OK)
        fail_msg("%s", error.message);
    return pose;
}

/* World positions of all corners: bounds, mean, and the last corner of the last mesh; m. From three.js
 * r187 in Node: its GLTFLoader, AnimationMixer.setTime() and Mesh.getVertexPosition() with matrixWorld,
 * seven digits; quaternions of keys were made unit before, which the files are to three digits only. */
typedef struct golden {
    const char *model;
    int animation; /* -1: at rest */
    double time_s;
    uint32_t corner_count;
    float minimum[3], maximum[3], mean[3], last[3];
} golden;

static const golden GOLDEN[] = {
    {"Fox.glb",
     -1,
     0,
     1728,
     {-12.59272f, -0.1217442f, -88.09501f},
     {12.59272f, 78.9072f, 66.62486f},
     {-0.007822113f, 33.82729f, -3.586796f},
     {-4.738458e-7f, 56.01973f, 66.62433f}},
    {"Fox.glb",
     0,
     0.1,
     1728,
     {-28.54044f, -0.1308104f, -84.89452f},
     {11.59275f, 74.51054f, 57.68431f},
     {-2.946561f, 32.25535f, -2.715317f},
     {-27.79908f, 48.52346f, 55.21966f}},
    {"Fox.glb",
     0,
     1.7,
     1728,
     {-11.59651f, -0.1307018f, -84.91232f},
     {18.53741f, 77.7259f, 67.44333f},
     {1.350518f, 32.74289f, -1.786929f},
     {9.598677f, 53.19174f, 67.02805f}},
    {"Fox.glb",
     1,
     0.35,
     1728,
     {-12.77886f, -0.02648134f, -91.32674f},
     {12.40646f, 74.45987f, 70.04306f},
     {-0.2005014f, 33.91842f, -2.204851f},
     {-0.2227825f, 51.68161f, 70.02591f}},
    {"Fox.glb",
     2,
     0.9,
     1728,
     {-16.92973f, -1.837967f, -97.6262f},
     {16.48114f, 67.6513f, 66.09198f},
     {-0.287768f, 37.3252f, -9.498343f},
     {-0.00001578408f, 47.49587f, 65.73809f}},
    {"SimpleSkin.glb", -1, 0, 24, {-0.5f, 0, 0}, {0.5f, 2, 0}, {0, 1, 0}, {-0.5f, 2, 0}},
    {"SimpleSkin.glb",
     0,
     1.2,
     24,
     {-1, 0, 0},
     {0.5f, 1.5f, 0},
     {-0.2083333f, 0.8333333f, 0},
     {-1, 0.5000001f, 0}},
    {"SimpleSkin.glb",
     0,
     3.75,
     24,
     {-0.5383037f, 0, 0},
     {1.115202f, 1.844443f, 0},
     {0.1603796f, 0.864961f, 0},
     {0.7327458f, 1.844443f, 0}},
    {"SimpleMorph.glb", -1, 0, 3, {0, 0, 0}, {1, 1.5f, 0}, {0.5f, 0.5f, 0}, {0.5f, 1.5f, 0}},
    {"SimpleMorph.glb", 0, 0.6, 3, {0, 0, 0}, {1.1f, 1.1f, 0}, {0.7f, 0.3666667f, 0}, {1.1f, 1.1f, 0}},
    {"SimpleMorph.glb", 0, 2.3, 3, {0, 0, 0}, {1, 2.2f, 0}, {0.4f, 0.7333333f, 0}, {0.2f, 2.2f, 0}},
    {"MorphStressTest.glb",
     -1,
     0,
     7236,
     {-2, -0.1f, -0.5f},
     {2, 0.5f, 0.5f},
     {-7.907747e-10f, 0.2485075f, 0},
     {1.675f, 0, 0.2f}},
    {"MorphStressTest.glb",
     0,
     1.1,
     7236,
     {-2, -0.1f, -0.5f},
     {2, 0.5f, 0.5f},
     {-7.907747e-10f, 0.2485075f, 0},
     {1.675f, 0, 0.2f}},
    {"MorphStressTest.glb",
     1,
     0.8,
     7236,
     {-2, -0.1f, -0.5f},
     {2, 1.5f, 0.5f},
     {-6.172471e-10f, 0.4757048f, 0},
     {1.675f, 0, 0.2f}},
    {"MorphStressTest.glb",
     2,
     3.3,
     7236,
     {-2, -0.1f, -0.5f},
     {2, 1.5f, 0.5f},
     {-7.907751e-10f, 0.7395522f, 0},
     {1.675f, 0, 0.2f}},
    {"AnimatedMorphCube.glb",
     0,
     0.5,
     36,
     {-1, -0.9999999f, -1},
     {1, 0.9999999f, 0.5608913f},
     {-2.069605e-8f, -1.168304e-8f, -0.2195544f},
     {1, 0.9999998f, -0.9999996f}},
    {"AnimatedMorphCube.glb",
     0,
     2.9,
     36,
     {-1, -0.9999999f, -1},
     {1, 0.9999998f, 0.6581626f},
     {-2.069605e-8f, -3.077834e-8f, -0.5784045f},
     {1, 0.9999998f, -0.9999996f}},
    {"BoxAnimated.glb",
     0,
     0.4,
     762,
     {-0.5f, -0.5f, -0.5f},
     {0.5f, 1.3064f, 0.5f},
     {0.000006421266f, 0.1889953f, -0.001787154f},
     {0.33204f, 0.3064f, -0.33204f}},
    {"BoxAnimated.glb",
     0,
     2.2,
     762,
     {-0.5f, -0.5f, -0.5844536f},
     {0.5f, 3.111781f, 0.5844536f},
     {0.000006421266f, 0.6078586f, -0.0002749741f},
     {0.33204f, 3.111781f, -0.1002268f}},
    {"RiggedSimple.glb",
     -1,
     0,
     564,
     {-1, -4.575077f, -1},
     {1, 4.575078f, 0.9999996f},
     {0.002215532f, 2.082178e-7f, -0.00006847035f},
     {0.08780619f, 4.575078f, 0.4414315f}},
    {"RiggedSimple.glb",
     0,
     0.9,
     564,
     {-1, -4.575077f, -1},
     {2.647094f, 4.217162f, 0.9999996f},
     {0.7461571f, -0.1895883f, -0.00006843824f},
     {2.331891f, 3.952023f, 0.4414316f}},
    {"RiggedSimple.glb",
     0,
     1.9,
     564,
     {-1, -4.575077f, -1},
     {1, 4.600022f, 0.9999996f},
     {0.1596607f, -0.006955875f, -0.00006846372f},
     {0.5648784f, 4.543812f, 0.4414316f}},
    {"AnimatedTriangle.glb",
     0,
     0.3,
     3,
     {-0.9510565f, -0.309017f, 0},
     {0, 0.9510565f, 0},
     {-0.4200245f, 0.2140132f, 0},
     {-0.9510565f, -0.309017f, 0}},
};

static void corner(const scene_instance *instance, uint32_t i, float out[3])
{
    mat4_transform_point(&instance->world, instance->positions + 3 * (size_t)instance->primitive->indices[i],
                         out);
}

static void check_golden(const golden *g, const facet_scene *scene)
{
    scene_pose pose = pose_at(scene, g->animation, g->time_s);
    double sum[3] = {0, 0, 0};
    float last[3] = {0, 0, 0};
    uint32_t count = 0;
    double size = 0.0;
    for (uint32_t i = 0; i < pose.instance_count; i++)
        for (uint32_t k = 0; k < pose.instances[i].primitive->index_count; k++, count++) {
            corner(&pose.instances[i], k, last);
            for (int axis = 0; axis < 3; axis++)
                sum[axis] += (double)last[axis];
        }
    assert_int_equal(count, g->corner_count);
    for (int axis = 0; axis < 3; axis++)
        size = fmax(size, (double)g->maximum[axis] - (double)g->minimum[axis]);
    for (int axis = 0; axis < 3; axis++) {
        assert_near(pose.bounds_min[axis], g->minimum[axis], 2e-6 * size);
        assert_near(pose.bounds_max[axis], g->maximum[axis], 2e-6 * size);
        assert_near(sum[axis] / count, g->mean[axis], 2e-6 * size);
        assert_near(last[axis], g->last[axis], 2e-6 * size);
    }
    scene_pose_destroy(&pose);
}

static void models_move_as_elsewhere(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof GOLDEN / sizeof *GOLDEN; i++) {
        facet_scene *scene = load_model(GOLDEN[i].model);
        if (!scene)
            skip();
        check_golden(&GOLDEN[i], scene);
        facet_scene_destroy(scene);
    }
}

static void pointers_move_colors(void **state)
{
    (void)state;
    /* The file's keys interpolated in Node in double, the rotations with slerp() of three.js. */
    static const struct {
        double time_s;
        float x, rotation[4], color[3];
    } expected[] = {{0.42, -0.2069330f, {0, 0.6677806f, 0, 0.7443582f}, {0.07380269f, 0.7461973f, 0.02f}},
                    {1.27, 1.679467f, {0, 0.9408335f, 0, 0.3388691f}, {0.02f, 0.3633386f, 0.4566614f}}};
    facet_scene *scene = load_model("AnimatedColorsCube.glb");
    if (!scene)
        skip();
    for (int i = 0; i < 2; i++) {
        scene_pose pose = pose_at(scene, 0, expected[i].time_s);
        bool is_found = false;
        for (uint32_t k = 0; k < pose.instance_count; k++) {
            const scene_instance *instance = &pose.instances[k];
            if (instance->material != 0)
                continue;
            is_found = true;
            const scene_material *m = scene_pose_material(scene, &pose, instance);
            for (int c = 0; c < 3; c++)
                assert_near(m->base_color[c], expected[i].color[c], 1e-6);
            assert_near(instance->world.m[12], expected[i].x, 1e-5);
            assert_near(instance->world.m[13], 3, 1e-5);
            mat4 turned = mat4_from_trs((float[3]){0, 0, 0}, expected[i].rotation, (float[3]){1, 1, 1});
            for (int c = 0; c < 11; c++)
                assert_near(instance->world.m[c], turned.m[c], 1e-6);
        }
        assert_true(is_found);
        scene_pose_destroy(&pose);
    }
    facet_scene_destroy(scene);
}

static void animations_are_found_by_name(void **state)
{
    (void)state;
    facet_scene *scene = load_model("Fox.glb");
    if (!scene)
        skip();
    facet_error error;
    uint32_t index = 9;
    assert_int_equal(facet_scene_get_counts(scene).animations, 3);
    assert_int_equal(facet_scene_find_animation(scene, "Walk", &index, &error), FACET_OK);
    assert_int_equal(index, 1);
    assert_int_equal(facet_scene_find_animation(scene, "2", &index, &error), FACET_OK);
    assert_int_equal(index, 2);
    facet_animation walk = facet_scene_get_animation(scene, 1);
    assert_string_equal(walk.name, "Walk");
    assert_near(walk.begin_s, 0, 0);
    assert_near(walk.end_s, 0.7083333, 1e-5);
    assert_null(facet_scene_get_animation(scene, 3).name);
    assert_int_equal(facet_scene_find_animation(scene, "Fly", &index, &error), FACET_ERROR_ARGUMENT);
    assert_non_null(
        strstr(error.message, "there is no animation \"Fly\"; there are 0 \"Survey\", 1 \"Walk\""));
    facet_scene_destroy(scene);
}

static void bounds_and_cameras_follow_the_pose(void **state)
{
    (void)state;
    facet_scene *scene = load_model("BoxAnimated.glb");
    if (!scene)
        skip();
    const uint32_t first[1] = {0};
    facet_pose_desc pose = {.animation_count = 1, .animations = first, .time_s = 2.2};
    float minimum[3], maximum[3];
    assert_true(facet_scene_get_bounds(scene, &pose, minimum, maximum));
    assert_near(maximum[1], 3.111781, 1e-5);
    facet_orbit orbit = facet_orbit_default();
    facet_camera still, moving, later;
    assert_int_equal(facet_camera_from_orbit(scene, NULL, &orbit, 1, &still, NULL), FACET_OK);
    orbit.fits_all_times = true;
    assert_int_equal(facet_camera_from_orbit(scene, &pose, &orbit, 1, &moving, NULL), FACET_OK);
    assert_true(moving.target[1] > still.target[1] + 0.5f); /* the inner box rises by more than 2 m */
    pose.time_s = 0.1;
    assert_int_equal(facet_camera_from_orbit(scene, &pose, &orbit, 1, &later, NULL), FACET_OK);
    assert_memory_equal(&moving, &later, sizeof later);
    facet_scene_destroy(scene);
}

/* A camera on a node that goes from (0, 0, 0) to (1, 2, 3) in a second while its angle grows from 0.5 to 1
 * rad. */
static const char MOVING_CAMERA[] =
    "{\"asset\":{\"version\":\"2.0\"},\"extensionsUsed\":[\"KHR_animation_pointer\"],\"scenes\":[{\"nodes\":["
    "0]}],"
    "\"scene\":0,\"nodes\":[{\"camera\":0}],\"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"yfov\":"
    "0.3,"
    "\"znear\":0.1}}],\"animations\":[{\"name\":\"dolly\",\"samplers\":[{\"input\":0,\"output\":1},{"
    "\"input\":0,"
    "\"output\":2}],\"channels\":[{\"sampler\":0,\"target\":{\"node\":0,\"path\":\"translation\"}},{"
    "\"sampler\":1,"
    "\"target\":{\"path\":\"pointer\",\"extensions\":{\"KHR_animation_pointer\":{\"pointer\":"
    "\"/cameras/0/perspective/"
    "yfov\"}}}}]}],\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":2,"
    "\"type\":\"SCALAR\",\"min\":[0],\"max\":[1]},{\"bufferView\":0,\"byteOffset\":8,\"componentType\":5126,"
    "\"count\":2,\"type\":\"VEC3\"},{\"bufferView\":0,\"byteOffset\":32,\"componentType\":5126,\"count\":2,"
    "\"type\":"
    "\"SCALAR\"}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":40}],\"buffers\":[{\"byteLength\":40,\"uri\":"
    "\"data:application/octet-stream;base64,AAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/AAAAQAAAQEAAAAA/AACAPw==\"}]}";

static void cameras_of_the_file_move(void **state)
{
    (void)state;
    facet_scene *scene = NULL;
    facet_error error;
    if (facet_scene_load_memory(MOVING_CAMERA, sizeof MOVING_CAMERA - 1, "dolly.gltf", NULL, &scene,
                                &error) != FACET_OK)
        fail_msg("%s", error.message);
    const uint32_t first[1] = {0};
    facet_camera camera;
    facet_pose_desc pose = {.animation_count = 1, .animations = first, .time_s = 0.5};
    assert_int_equal(facet_camera_from_scene(scene, &pose, 0, &camera, &error), FACET_OK);
    for (int i = 0; i < 3; i++)
        assert_near(camera.eye[i], 0.5 * (i + 1), 1e-6);
    assert_near(camera.fov_y_rad, 0.75, 1e-6);
    assert_int_equal(facet_camera_from_scene(scene, NULL, 0, &camera, &error), FACET_OK);
    assert_near(camera.fov_y_rad, 0.3, 1e-6);
    /* What is not there is named. */
    const uint32_t second[1] = {1};
    pose.animations = second;
    assert_int_equal(facet_camera_from_scene(scene, &pose, 0, &camera, &error), FACET_ERROR_ARGUMENT);
    assert_string_equal(error.message, "dolly.gltf: has no animation 1; the last one is 0");
    facet_scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(models_move_as_elsewhere),     cmocka_unit_test(pointers_move_colors),
        cmocka_unit_test(animations_are_found_by_name), cmocka_unit_test(bounds_and_cameras_follow_the_pose),
        cmocka_unit_test(cameras_of_the_file_move),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
