/* lights_test.c - lights of OpenGL 1 in a glTF scene, and the reverse. */
#include "legacy/convert_test_support.h"

static const facet_legacy_desc PLAIN = {0};
#define PI 3.14159265358979323846

/* A scene of one triangle with bounds of +-1 around (0, 2, 0). */
static facet_scene *stage(uint32_t light_count)
{
    static const float positions[] = {-1, 1, -1, 1, 3, 1, 1, 1, 1};
    static const uint32_t indices[] = {0, 1, 2};
    static const float normals[] = {0, 0, 1, 0, 0, 1, 0, 0, 1};
    facet_scene *scene = legacy_scene(1);
    arena *a = scene->arena;
    scene->meshes = arena_zalloc(a, 1, sizeof *scene->meshes);
    scene->nodes = arena_zalloc(a, 1, sizeof *scene->nodes);
    scene->scenes = arena_zalloc(a, 1, sizeof *scene->scenes);
    scene->legacy->lights = arena_zalloc(a, light_count + 1, sizeof *scene->legacy->lights);
    scene_primitive *primitive = arena_zalloc(a, 1, sizeof *primitive);
    uint32_t *roots = arena_zalloc(a, 1, sizeof *roots);
    *primitive = (scene_primitive){.mode = SCENE_TRIANGLES,
                                   .vertex_count = 3,
                                   .index_count = 3,
                                   .indices = indices,
                                   .positions = positions,
                                   .normals = normals,
                                   .bounds_min = {-1, 1, -1},
                                   .bounds_max = {1, 3, 1}};
    scene->meshes[0] = (scene_mesh){.name = "", .primitive_count = 1, .primitives = primitive};
    scene->nodes[0] = scene_node_default("");
    scene->nodes[0].mesh = 0;
    scene->scenes[0] = (scene_root){.name = "", .node_count = 1, .nodes = roots, .image_light = SCENE_NONE};
    scene->mesh_count = scene->node_count = scene->scene_count = 1;
    scene->default_scene = 0;
    scene->legacy->light_count = light_count;
    for (uint32_t i = 0; i < light_count; i++) {
        scene->legacy->lights[i] = legacy_light_default();
        scene->legacy->lights[i].is_viewpoint_relative = false;
    }
    return scene;
}

/* The default scene's lights, in world space. */
static void pose_of(const facet_scene *scene, scene_pose *pose)
{
    assert_int_equal(scene_pose_create(scene, NULL, NULL, 1, pose, NULL), FACET_OK);
}

static void directional_lights_are_pi_times_their_color(void **state)
{
    (void)state;
    facet_scene *scene = stage(2);
    legacy_light *lights = scene->legacy->lights;
    set_color(lights[0].diffuse, .5f, .25f, 0);
    set_color(lights[0].specular, .5f, .25f, 0);
    set_color(lights[1].position, 0, 0, -1); /* straight behind: half a turn */
    convert(scene, &PLAIN);
    scene_pose pose;
    pose_of(scene, &pose);
    assert_int_equal(pose.light_count, 2);
    const scene_posed_light *p = pose.lights;
    assert_int_equal(p[0].light.type, SCENE_LIGHT_DIRECTIONAL);
    for (int k = 0; k < 3; k++) {
        assert_near(p[0].light.intensity * p[0].light.color[k], PI * (double)lights[0].diffuse[k], 1e-5);
        assert_near(p[0].direction[k], -lights[0].position[k], 1e-6);
        assert_near(p[1].direction[k], k == 2 ? 1 : 0, 1e-6);
    }
    assert_near(scene->conversion->light_scale, PI, 1e-12);
    assert_false(has_warning(scene, SCENE_NONE, "light-simplified"));
    assert_false(has_warning(scene, SCENE_NONE, "point-light-attenuation"));
    assert_true(has_warning(scene, SCENE_NONE, "legacy-light-pi"));
    scene_pose_destroy(&pose);
    /* Again, with the same indices: replaced. */
    convert(scene, &(facet_legacy_desc){.keeps_light = true});
    assert_int_equal(scene->light_count, 2);
    assert_int_equal(scene->node_count, 3);
    assert_near(scene->lights[0].intensity, .5, 1e-6);
    assert_near(scene->conversion->light_scale, 1, 0);
    assert_false(has_warning(scene, SCENE_NONE, "legacy-light-pi"));
    scene_destroy(scene);
}

static void point_lights_are_exact_at_the_center(void **state)
{
    (void)state;
    facet_scene *scene = stage(1);
    legacy_light *light = &scene->legacy->lights[0];
    light->is_point = true;
    set_color(light->position, 0, 12, 0); /* 10 m from the center */
    set_color(light->specular, 1, 0, 0);
    convert(scene, &PLAIN);
    assert_true(has_warning(scene, SCENE_NONE, "point-light-attenuation"));
    assert_true(has_warning(scene, SCENE_NONE, "light-simplified"));
    assert_int_equal(scene->lights[0].type, SCENE_LIGHT_POINT);
    assert_near(scene->lights[0].intensity / 100, PI, 1e-4);
    scene_pose pose;
    pose_of(scene, &pose);
    assert_color(pose.lights[0].position, 0, 12, 0, 1e-6);
    scene_pose_destroy(&pose);
    scene_destroy(scene);
}

/* The default camera looks from 75 degrees, that is 15 above the horizon. */
static void lights_of_the_viewer_are_placed_for_the_default_camera(void **state)
{
    (void)state;
    facet_scene *scene = stage(1);
    scene->legacy->lights[0].is_viewpoint_relative = true;
    set_color(scene->legacy->lights[0].position, 0, 0, 1); /* at the eye */
    convert(scene, &PLAIN);
    assert_true(has_warning(scene, SCENE_NONE, "viewpoint-light"));
    scene_pose pose;
    pose_of(scene, &pose);
    const float *d = pose.lights[0].direction;
    assert_near(d[0], 0, 1e-6);
    assert_near(d[1], -sin(PI / 12), 1e-5);
    assert_near(d[2], -cos(PI / 12), 1e-5);
    scene_pose_destroy(&pose);
    scene_destroy(scene);
}

static void lights_round_trip(void **state)
{
    (void)state;
    facet_scene *scene = stage(2);
    legacy_light *lights = scene->legacy->lights;
    set_color(lights[0].diffuse, .5f, .25f, .1f);
    lights[1].is_point = true;
    set_color(lights[1].position, 3, 2, 4);
    convert(scene, &PLAIN);
    const legacy_light wanted[2] = {lights[0], lights[1]};
    scene->legacy = NULL;
    scene->conversion = NULL;
    convert_to(scene, FACET_MATERIAL_MODEL_OGL1, &(facet_legacy_desc){.colors = FACET_LEGACY_COLORS_LINEAR});
    assert_int_equal(scene->legacy->light_count, 2);
    for (int i = 0; i < 2; i++) {
        const legacy_light *found = &scene->legacy->lights[i];
        assert_int_equal(found->is_point, wanted[i].is_point);
        for (int k = 0; k < 3; k++) {
            assert_near(found->position[k], wanted[i].position[k], 1e-5);
            assert_near(found->diffuse[k], wanted[i].diffuse[k], 1e-5);
        }
    }
    assert_true(has_warning(scene, SCENE_NONE, "point-light-attenuation"));
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(directional_lights_are_pi_times_their_color),
        cmocka_unit_test(point_lights_are_exact_at_the_center),
        cmocka_unit_test(lights_of_the_viewer_are_placed_for_the_default_camera),
        cmocka_unit_test(lights_round_trip),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
