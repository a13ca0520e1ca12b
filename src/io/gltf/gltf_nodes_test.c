/* gltf_nodes_test.c - hierarchy, transforms, scenes, cameras and lights. */
#include "io/gltf/gltf_test_support.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static scene_pose pose_of(const facet_scene *scene, uint32_t index)
{
    scene_pose pose;
    facet_error error = {0};
    const facet_pose_desc desc = {.has_scene_index = index != SCENE_NONE, .scene_index = index};
    if (scene_pose_create(scene, &desc, NULL, 1, &pose, &error) != FACET_OK)
        fail_msg("%s", error.message);
    return pose;
}

static void trs_and_matrix_agree(void **state)
{
    (void)state;
    /* A turn of 90 degrees around +Y takes +X to -Z; scale (2, 3, 4) before it, the translation after. */
    facet_scene *scene =
        load("'cameras':[{'type':'perspective','perspective':{'yfov':1,'znear':0.1}}],'nodes':[{'camera':0,"
             "'translation':[5,6,7],'rotation':[0,0.70710678,0,0.70710678],'scale':[2,3,4]},{'camera':0,"
             "'matrix':[0,0,-2,0,0,3,0,0,4,0,0,0,5,6,7,1]}],'scenes':[{'nodes':[0,1]}]",
             NULL);
    scene_pose pose = pose_of(scene, 0);
    assert_int_equal(pose.camera_count, 2);
    assert_floats(pose.cameras[0].world.m, pose.cameras[1].world.m, 16, 1e-6);
    scene_pose_destroy(&pose);
    scene_destroy(scene);
}

static void worlds_are_products_down_the_tree(void **state)
{
    (void)state;
    facet_scene *scene =
        load("'cameras':[{'type':'perspective','perspective':{'yfov':1,'znear':0.1}}],'nodes':[{'camera':0,"
             "'translation':[1,0,0]},{'children':[0],'scale':[2,2,2]},{'children':[1],'translation':[0,0,"
             "10]}],'scenes':[{'nodes':[2]}]",
             NULL);
    scene_pose pose = pose_of(scene, SCENE_NONE);
    const float expected[3] = {2, 0, 10};
    assert_floats(pose.cameras[0].world.m + 12, expected, 3, 0);
    assert_int_equal(scene->nodes[0].parent, 1);
    assert_int_equal(scene->nodes[2].parent, SCENE_NONE);
    scene_pose_destroy(&pose);
    scene_destroy(scene);
}

static void broken_hierarchies_are_refused(void **state)
{
    (void)state;
    static const char *const cases[][2] = {
        {"'nodes':[{'children':[0]}]", "nodes[0]: is its own ancestor"},
        {"'nodes':[{'children':[1]},{'children':[0]}]", "nodes[0]: is its own ancestor"},
        {"'nodes':[{'children':[7]}]", "nodes[0].children[0]: node 7 does not exist (there is 1)"},
        {"'nodes':[{'mesh':0}]", "nodes[0].mesh: mesh 0 does not exist (there are 0)"},
        {"'nodes':[{'matrix':[1,2,3]}]", "must have 16 numbers, but has 3"},
        {"'nodes':[{}],'scenes':[{'nodes':[1]}]", "scenes[0].nodes[0]: node 1 does not exist"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        assert_refused(cases[i][0], NULL, FACET_ERROR_INVALID, cases[i][1]);
}

/* 3 has the parents 1 and 2, and a child. */
static void shared_nodes_are_copied(void **state)
{
    (void)state;
    test_model m = {0};
    const float times[2] = {0, 1};
    const float moves[6] = {0, 0, 0, 0, 5, 0};
    model_add_floats(&m, times, 2, "SCALAR");
    model_add_floats(&m, moves, 2, "VEC3");
    facet_scene *scene = model_load(
        &m, "'meshes':[{'primitives':[{'attributes':{}}]}],'cameras':[{'type':'perspective','perspective':{"
            "'yfov':1,'znear':1}}],'nodes':[{'children':[1,2]},{'translation':[1,0,0],'children':[3]},"
            "{'translation':[2,0,0],'children':[3,3]},{'children':[4],'camera':0},{'mesh':0}],'animations':[{"
            "'samplers':[{'input':0,'output':1}],'channels':[{'sampler':0,'target':{'node':4,'path':"
            "'translation'}}]}]");
    assert_int_equal(scene->node_count, 7);
    assert_true(has_warning(scene,
                            "nodes[2].children[0]: node 3 is a child of node 1 already; it is drawn under "
                            "each parent"));
    assert_true(has_note(scene, "nodes[2].children[1]: node 3 is listed twice"));
    const scene_node *n = scene->nodes;
    assert_int_equal(n[3].parent, 1);
    assert_int_equal(n[2].child_count, 1);
    assert_int_equal(n[2].children[0], 5);
    assert_int_equal(n[5].parent, 2);
    assert_int_equal(n[5].camera, SCENE_NONE);
    assert_int_equal(n[5].children[0], 6);
    assert_int_equal(n[6].parent, 5);
    assert_int_equal(n[6].mesh, 0);
    assert_int_equal(scene->animations[0].channel_count, 2);
    assert_int_equal(scene->animations[0].channels[1].index, 6);
    scene_destroy(scene);
}

/* Each node of a chain has two paths to the next: 2^20 to the last. */
static void copies_of_copies_have_a_limit(void **state)
{
    (void)state;
    char body[8192];
    size_t length = (size_t)snprintf(body, sizeof body, "'nodes':[");
    for (int i = 0; i < 20; i++) /* 3 i has 3 i + 1 and 3 i + 2, and both have 3 i + 3 */
        length += (size_t)snprintf(body + length, sizeof body - length,
                                   "{'children':[%d,%d]},{'children':[%d]},{'children':[%d]},", 3 * i + 1,
                                   3 * i + 2, 3 * i + 3, 3 * i + 3);
    snprintf(body + length, sizeof body - length, "{}]");
    assert_refused(body, NULL, FACET_ERROR_LIMIT, "with several parents make more than 65536 copies");
    assert_refused("'nodes':[{'children':[1,2]},{'children':[3]},{'children':[3]},{'children':[1]}]", NULL,
                   FACET_ERROR_INVALID, "is its own ancestor");
}

/* One node has more parents than the limit of copies, and nothing else is copied: counting stops at the
 * limit. */
static void one_node_has_a_limit_of_parents(void **state)
{
    static const char parent[] = ",{'children':[0]}";
    enum { PARENTS = 70000 };
    (void)state;
    char *body = malloc(16 + PARENTS * (sizeof parent - 1));
    assert_non_null(body);
    size_t length = (size_t)sprintf(body, "'nodes':[{}");
    for (int i = 0; i < PARENTS; i++, length += sizeof parent - 1)
        memcpy(body + length, parent, sizeof parent - 1);
    strcpy(body + length, "]");
    assert_refused(body, NULL, FACET_ERROR_LIMIT, "with several parents make more than 65536 copies");
    free(body);
}

/* Models of a file that states its place in the world. */
static void a_center_moves_the_roots(void **state)
{
    (void)state;
    facet_scene *scene =
        load("'extensionsUsed':['CESIUM_RTC'],'extensionsRequired':['CESIUM_RTC'],'extensions':{"
             "'CESIUM_RTC':{'center':[6378137.125,3,4]}},'nodes':[{'children':[1]},{},{}],"
             "'scenes':[{'nodes':[0]},{'nodes':[2]}]",
             NULL);
    assert_int_equal(scene->node_count, 5);
    assert_int_equal(scene->warning_count, 0);
    assert_int_equal(scene->scenes[0].nodes[0], 3);
    assert_int_equal(scene->scenes[1].nodes[0], 4);
    assert_int_equal(scene->nodes[0].parent, 3);
    assert_int_equal(scene->nodes[1].parent, 0);
    assert_int_equal(scene->nodes[3].children[0], 0);
    assert_true(scene->nodes[3].translation[0] == 6378137.125);
    scene_destroy(scene);
    assert_left_out("'extensionsUsed':['CESIUM_RTC'],'extensions':{'CESIUM_RTC':{'center':[1]}}", NULL,
                    "center: must have 3 numbers, but has 1; the model is not moved");
}

static void scenes_and_hidden_nodes_are_read(void **state)
{
    (void)state;
    facet_scene *scene =
        load("'extensionsUsed':['KHR_node_visibility'],'cameras':[{'type':'perspective','perspective':{"
             "'yfov':1,'znear':0.1}}],'nodes':[{'camera':0},{'camera':0,'children':[2],'extensions':{"
             "'KHR_node_visibility':{'visible':false}}},{'camera':0}],'scenes':[{'nodes':[0,1,0]},{'name':"
             "'b'}],'scene':1",
             NULL);
    assert_int_equal(scene->scene_count, 2);
    assert_int_equal(scene->default_scene, 1);
    assert_true(has_note(scene, "node 0 is listed twice"));
    scene_pose pose = pose_of(scene, SCENE_NONE);
    assert_int_equal(pose.camera_count, 0);
    scene_pose_destroy(&pose);
    pose = pose_of(scene, 0);
    assert_int_equal(pose.camera_count, 1);
    scene_pose_destroy(&pose);
    facet_error error;
    assert_int_equal(scene_pose_create(scene, &(facet_pose_desc){.has_scene_index = true, .scene_index = 2},
                                       NULL, 1, &pose, &error),
                     FACET_ERROR_ARGUMENT);
    scene_destroy(scene);
    scene = load("'nodes':[{},{'children':[2]},{}]", NULL);
    assert_int_equal(scene->default_scene, SCENE_NONE);
    assert_true(has_note(scene, "has no scene; all its nodes are drawn"));
    scene_destroy(scene);
}

static void cameras_are_read(void **state)
{
    (void)state;
    facet_scene *scene = load("'cameras':[{'type':'perspective','name':'p','perspective':{'yfov':0.5,'znear':"
                              "0.25,'aspectRatio':2}},{'type':"
                              "'orthographic','orthographic':{'xmag':3,'ymag':2,'znear':0,'zfar':10}},{'type'"
                              ":'perspective','perspective':{"
                              "'yfov':4,'znear':1,'zfar':0.5}}]",
                              NULL);
    const scene_camera *c = scene->cameras;
    assert_string_equal(c[0].name, "p");
    assert_false(c[0].is_orthographic);
    assert_near(c[0].fov_y_rad, 0.5, 0);
    assert_near(c[0].aspect, 2, 0);
    assert_near(c[0].near_m, 0.25, 0);
    assert_near(c[0].far_m, 0, 0); /* infinite */
    assert_true(c[1].is_orthographic);
    assert_near(c[1].ortho_width, 6, 0);
    assert_near(c[1].ortho_height, 4, 0);
    assert_near(c[1].far_m, 10, 0);
    assert_near(c[2].fov_y_rad, 0.8, 1e-6);
    assert_near(c[2].far_m, 0, 0);
    assert_int_equal(scene->warning_count, 1);
    assert_true(has_note(scene, "zfar: 0.5 must be above znear"));
    scene_destroy(scene);
    assert_left_out("'cameras':[{'type':'fisheye'}]", NULL, "must be perspective or orthographic");
    assert_left_out("'cameras':[{'type':'perspective'}]", NULL, "cameras[0].perspective: is missing");
    assert_left_out("'cameras':[{'type':'perspective','perspective':{'znear':1}}]", NULL,
                    "cameras[0].perspective.yfov: is missing");
}

static void lights_are_read_and_point_along_minus_z(void **state)
{
    (void)state;
    facet_scene *scene = load("'extensionsUsed':['KHR_lights_punctual'],'extensions':{'KHR_lights_punctual':{"
                              "'lights':[{'type':'directional'},"
                              "{'type':'point','color':[1,0.5,0.25],'intensity':7,'range':3},{'type':'spot','"
                              "spot':{'innerConeAngle':0.1,"
                              "'outerConeAngle':0.2}},{'type':'spot','spot':{'innerConeAngle':0.5,'"
                              "outerConeAngle':0.4}}]}},'nodes':[{'rotation"
                              "':[0,0.70710678,0,0.70710678],'scale':[5,5,5],'translation':[1,2,3],'"
                              "extensions':{'KHR_lights_punctual':{'light':"
                              "0}}}],'scenes':[{'nodes':[0]}]",
                              NULL);
    const scene_light *l = scene->lights;
    assert_int_equal(scene->light_count, 4);
    assert_int_equal(l[0].type, SCENE_LIGHT_DIRECTIONAL);
    assert_near(l[0].intensity, 1, 0);
    assert_near(l[0].range, 0, 0);
    assert_int_equal(l[1].type, SCENE_LIGHT_POINT);
    assert_near(l[1].color[1], 0.5, 0);
    assert_near(l[1].intensity, 7, 0);
    assert_near(l[1].range, 3, 0);
    assert_near(l[2].inner_cone_rad, 0.1f, 0);
    assert_near(l[2].outer_cone_rad, 0.2f, 0);
    assert_near(l[3].inner_cone_rad, 0.4f, 0);
    scene_pose pose = pose_of(scene, 0);
    const float direction[3] = {-1, 0,
                                0}; /* -Z, turned by 90 degrees around +Y; the node's scale has no part */
    const float position[3] = {1, 2, 3};
    assert_int_equal(pose.light_count, 1);
    assert_floats(pose.lights[0].direction, direction, 3, 1e-6);
    assert_floats(pose.lights[0].position, position, 3, 0);
    scene_pose_destroy(&pose);
    scene_destroy(scene);
}

static void deep_hierarchies_do_not_recurse(void **state)
{
    (void)state;
    /* A chain of 100 000 nodes would break any stack that grew with it. */
    enum { COUNT = 100000 };
    static char body[COUNT * 24];
    size_t length = (size_t)snprintf(body, sizeof body, "'nodes':[");
    for (int i = 0; i + 1 < COUNT; i++)
        length += (size_t)snprintf(body + length, sizeof body - length, "{'children':[%d]},", i + 1);
    snprintf(body + length, sizeof body - length, "{}],'scenes':[{'nodes':[0]}]");
    facet_scene *scene = load(body, NULL);
    scene_pose pose = pose_of(scene, 0);
    scene_pose_destroy(&pose);
    scene_destroy(scene);
}

static void broken_skins_and_animations_are_left_out(void **state)
{
    (void)state;
    const char *used =
        "'meshes':[{'primitives':[{'attributes':{}}]}],'nodes':[{'mesh':0,'skin':0}],'skins':[{%s}]";
    static const char *const skins[][2] = {{"'joints':[1]", "skins[0].joints[0]: node 1 does not exist"},
                                           {"", "skins[0].joints: is missing"}};
    for (size_t i = 0; i < sizeof skins / sizeof *skins; i++) {
        char body[256];
        snprintf(body, sizeof body, "'nodes':[{}],'skins':[{%s}]", skins[i][0]);
        assert_left_out(body, NULL, skins[i][1]);
        snprintf(body, sizeof body, used, skins[i][0]);
        assert_refused(body, NULL, FACET_ERROR_INVALID, skins[i][1]);
    }
    assert_left_out("'animations':[{'samplers':[{'input':0,'output':0}],'channels':[]}]", NULL,
                    "animations[0].samplers[0].input: accessor 0 does not exist (there are 0); it animates "
                    "nothing");
    assert_left_out("'animations':[{'samplers':[],'channels':[{'sampler':0,'target':{'path':'scale'}}]}]",
                    NULL, "channels[0].sampler: sampler 0 does not exist (there are 0); it animates nothing");
    assert_left_out("'nodes':[{'camera':1,'extensions':{'KHR_lights_punctual':{'light':7}}}]", NULL,
                    "nodes[0].camera: camera 1 does not exist (there are 0); the node has no camera");
    assert_left_out("'nodes':[{}],'scenes':[{'nodes':[0]}],'scene':4", NULL,
                    "scene: scene 4 does not exist (there is 1); the first scene is drawn");
    assert_left_out("'nodes':[{}],'scenes':[{'nodes':[0]},{'nodes':[9]}]", NULL,
                    "scenes[1].nodes[0]: node 9 does not exist (there is 1); that scene is empty");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(trs_and_matrix_agree),
        cmocka_unit_test(worlds_are_products_down_the_tree),
        cmocka_unit_test(broken_hierarchies_are_refused),
        cmocka_unit_test(shared_nodes_are_copied),
        cmocka_unit_test(copies_of_copies_have_a_limit),
        cmocka_unit_test(one_node_has_a_limit_of_parents),
        cmocka_unit_test(a_center_moves_the_roots),
        cmocka_unit_test(scenes_and_hidden_nodes_are_read),
        cmocka_unit_test(cameras_are_read),
        cmocka_unit_test(lights_are_read_and_point_along_minus_z),
        cmocka_unit_test(deep_hierarchies_do_not_recurse),
        cmocka_unit_test(broken_skins_and_animations_are_left_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
