/* parts_test.c - joined scenes: every index points to what it did, each part has its place. */
#include "scene/motion_test_support.h"

#include "scene/legacy.h"

/* A scene with two of everything, in which all references are to the second element; name is in the names. */
typedef struct sample {
    scene_image images[2];
    scene_texture textures[2];
    scene_material materials[2];
    scene_camera cameras[2];
    scene_light lights[2];
    scene_skin skins[2];
    scene_image_light image_lights[1];
    uint32_t joints[2], children[1], cube[6];
    const char *variants[2];
    uint32_t variant_materials[2];
    legacy_material legacy_materials[2];
    legacy_light legacy_lights[1];
    scene_legacy legacy;
    scene_extension extensions[1];
} sample;

static const float corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
static const uint32_t triangle[3] = {0, 1, 2};

static void fill_primitive(facet_scene *scene, sample *s)
{
    scene_primitive *p = scene->meshes[1].primitives;
    *p = (scene_primitive){.mode = SCENE_TRIANGLES,
                           .vertex_count = 3,
                           .index_count = 3,
                           .indices = triangle,
                           .positions = corners,
                           .normals = corners,
                           .material = 1,
                           .bounds_max = {1, 1, 0},
                           .variant_materials = s->variant_materials,
                           .meta = {.extensions = "{}"}};
}

/* Nodes 0 and 1 are roots; node 2 is a child of node 1. */
static facet_scene *make(sample *s, const char *name, const char *shared_variant)
{
    *s = (sample){.joints = {1, 2}, .children = {2}, .variant_materials = {0, 1}};
    facet_scene *scene = test_scene(3);
    uint32_t *roots = arena_alloc(scene->arena, 2, sizeof *roots);
    roots[0] = 0;
    roots[1] = 1;
    scene->scenes[0] = (scene_root){
        .name = name, .node_count = 2, .nodes = roots, .image_light = 0, .meta = {.extras = "1"}};
    for (int i = 0; i < 2; i++) {
        s->images[i] = (scene_image){.name = name};
        s->textures[i] = (scene_texture){.name = name, .image = 1};
        s->materials[i] = scene_material_default();
        s->materials[i].name = name;
        s->materials[i].textures[SCENE_NORMAL_TEXTURE].texture = 1;
        s->cameras[i] = (scene_camera){.name = name, .fov_y_rad = 1.0f};
        s->lights[i] = (scene_light){.name = name};
        s->skins[i] = (scene_skin){.name = name, .joint_count = 2, .joints = s->joints, .skeleton = 1};
        s->legacy_materials[i] = legacy_material_default();
        s->legacy_materials[i].maps[LEGACY_DIFFUSE_MAP].ref.texture = 1;
    }
    for (int i = 0; i < 6; i++)
        s->cube[i] = 1;
    s->image_lights[0] = (scene_image_light){.name = name, .mip_count = 1, .images = s->cube};
    s->variants[0] = shared_variant;
    s->variants[1] = name;
    s->extensions[0] = (scene_extension){.name = name, .is_present = true};
    s->legacy = (scene_legacy){.materials = s->legacy_materials,
                               .lights = s->legacy_lights,
                               .light_count = 1,
                               .colors = FACET_LEGACY_COLORS_SRGB,
                               .is_source = true};
    scene->images = s->images, scene->image_count = 2;
    scene->textures = s->textures, scene->texture_count = 2;
    scene->materials = s->materials, scene->material_count = 2;
    scene->cameras = s->cameras, scene->camera_count = 2;
    scene->lights = s->lights, scene->light_count = 2;
    scene->skins = s->skins, scene->skin_count = 2;
    scene->image_lights = s->image_lights, scene->image_light_count = 1;
    scene->variants = s->variants, scene->variant_count = 2;
    scene->extensions = s->extensions, scene->extension_count = 1;
    scene->legacy = &s->legacy;
    fill_primitive(scene, s);
    scene->nodes[1].mesh = SCENE_NONE;
    scene->nodes[1].child_count = 1;
    scene->nodes[1].children = s->children;
    scene->nodes[2].parent = 1;
    scene->nodes[2].mesh = scene->nodes[2].camera = scene->nodes[2].light = 1;
    scene->nodes[2].translation[1] = 1.0;
    const float times[2] = {0, 1}, values[6] = {0, 1, 0, 0, 1, 0};
    float *kept = arena_alloc(scene->arena, 8, sizeof *kept);
    memcpy(kept, times, sizeof times);
    memcpy(kept + 2, values, sizeof values);
    const scene_sampler sampler = {SCENE_LINEAR, 2, kept, 3, kept + 2};
    const test_channel channels[] = {
        {{.kind = SCENE_TARGET_NODE, .index = 2, .offset = offsetof(scene_node, translation)}, sampler},
        {{.kind = SCENE_TARGET_MATERIAL, .index = 1, .pointer = "/materials/1/emissiveFactor"}, sampler},
        {{.kind = SCENE_TARGET_LIGHT,
          .index = 1,
          .pointer = "/extensions/KHR_lights_punctual/lights/1/color"},
         sampler}};
    test_animation(scene, channels, 3);
    return scene;
}

static void indices_follow_their_scene(void **state)
{
    (void)state;
    sample one, two;
    facet_scene *a = make(&one, "one", "red"), *b = make(&two, "two", "red");
    scene_warn(b, &(facet_log){0}, "two is old");
    assert_int_equal(scene_append(a, b, NULL), FACET_OK);
    /* 3 nodes and a place each */
    assert_int_equal(a->node_count, 8);
    assert_int_equal(a->material_count, 4);
    assert_int_equal(a->materials[3].textures[SCENE_NORMAL_TEXTURE].texture, 3);
    assert_int_equal(a->materials[1].textures[SCENE_NORMAL_TEXTURE].texture, 1);
    assert_int_equal(a->textures[3].image, 3);
    assert_int_equal(a->image_lights[1].images[5], 3);
    const scene_node *node = &a->nodes[4 + 2];
    assert_int_equal(node->parent, 4 + 1);
    assert_int_equal(a->nodes[4 + 1].children[0], 4 + 2);
    assert_int_equal(a->nodes[4 + 1].parent, 4 + 3);
    assert_int_equal(node->mesh, 3 + 1);
    assert_int_equal(node->camera, 3);
    assert_int_equal(node->light, 3);
    assert_int_equal(node->skin, SCENE_NONE);
    assert_int_equal(a->skins[3].joints[1], 4 + 2);
    assert_int_equal(a->skins[3].skeleton, 4 + 1);
    assert_int_equal(a->skins[1].joints[1], 2);
    const scene_primitive *p = a->meshes[3 + 1].primitives;
    assert_int_equal(p->material, 3);
    assert_null(p->meta.extensions);
    assert_non_null(a->meshes[1].primitives->meta.extensions);
    assert_int_equal(a->extension_count, 2);
    assert_int_equal(a->warning_count, 1);
    assert_int_equal(a->scene_count, 1);
    assert_int_equal(a->scenes[0].node_count, 2);
    assert_int_equal(a->scenes[0].image_light, 0);
    scene_destroy(a);
}

static void variants_are_joined_by_name(void **state)
{
    (void)state;
    sample one, two;
    facet_scene *a = make(&one, "one", "red"), *b = make(&two, "two", "red");
    assert_int_equal(scene_append(a, b, NULL), FACET_OK);
    assert_int_equal(a->variant_count, 3); /* red, one, two */
    assert_string_equal(a->variants[2], "two");
    const uint32_t *first = a->meshes[1].primitives->variant_materials;
    const uint32_t *second = a->meshes[4].primitives->variant_materials;
    const uint32_t wanted[2][3] = {{0, 1, SCENE_NONE}, {2, SCENE_NONE, 3}};
    assert_memory_equal(first, wanted[0], sizeof wanted[0]);
    assert_memory_equal(second, wanted[1], sizeof wanted[1]);
    scene_destroy(a);
}

static void animations_move_what_they_did(void **state)
{
    (void)state;
    sample one, two;
    facet_scene *a = make(&one, "one", "red"), *b = make(&two, "two", "red");
    assert_int_equal(scene_append(a, b, NULL), FACET_OK);
    const scene_channel *c = a->animations[1].channels;
    assert_int_equal(c[0].index, 4 + 2);
    assert_int_equal(c[1].index, 2 + 1);
    assert_string_equal(c[1].pointer, "/materials/3/emissiveFactor");
    assert_string_equal(c[2].pointer, "/extensions/KHR_lights_punctual/lights/3/color");
    assert_string_equal(a->animations[0].channels[1].pointer, "/materials/1/emissiveFactor");
    scene_destroy(a);
}

/* Both triangles are 1 m above their origins. */
static void each_part_has_its_place(void **state)
{
    (void)state;
    sample one, two;
    facet_scene *a = make(&one, "one", "red"), *b = make(&two, "two", "blue");
    const float there[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 100, 0, 0, 1};
    const float down[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -50, 0, 1};
    scene_pose pose;
    assert_int_equal(scene_append(a, b, NULL), FACET_OK);
    assert_int_equal(scene_place(a, 1, there, NULL), FACET_OK);
    assert_int_equal(scene_place(a, 0, down, NULL), FACET_OK);
    assert_int_equal(scene_place(a, 2, down, NULL), FACET_ERROR_ARGUMENT);
    assert_int_equal(scene_pose_create(a, NULL, NULL, 1, &pose, NULL), FACET_OK);
    assert_int_equal(pose.instance_count, 2);
    assert_int_equal(pose.camera_count, 2);
    assert_near(pose.bounds_min[1], -49, 1e-5);
    assert_near(pose.bounds_max[0], 101, 1e-5);
    assert_near(pose.bounds_max[1], 2, 1e-5);
    assert_int_equal(pose.instances[1].material, 3);
    scene_pose_destroy(&pose);
    /* a third one, into which two are appended */
    sample three;
    facet_scene *c = make(&three, "three", "red");
    assert_int_equal(scene_append(c, a, NULL), FACET_OK);
    assert_int_equal(c->part_count, 3);
    assert_int_equal(scene_place(c, 2, down, NULL), FACET_OK);
    assert_int_equal(scene_pose_create(c, NULL, NULL, 1, &pose, NULL), FACET_OK);
    assert_int_equal(pose.instance_count, 3);
    assert_near(pose.bounds_max[0], 1, 1e-5);
    scene_pose_destroy(&pose);
    scene_destroy(c);
}

static void legacy_materials_need_equal_rules(void **state)
{
    (void)state;
    sample one, two, three;
    facet_scene *a = make(&one, "one", "red"), *b = make(&two, "two", "red"),
                *c = make(&three, "three", "red");
    three.legacy.is_rgl = true;
    assert_int_equal(scene_append(a, b, NULL), FACET_OK);
    assert_true(scene_has_legacy_materials(a));
    assert_int_equal(a->legacy->materials[3].maps[LEGACY_DIFFUSE_MAP].ref.texture, 3);
    assert_int_equal(a->legacy->light_count, 2);
    assert_int_equal(scene_append(a, c, NULL), FACET_OK);
    assert_false(scene_has_legacy_materials(a));
    assert_int_equal(scene_append(a, a, NULL), FACET_ERROR_ARGUMENT);
    scene_destroy(a);
}

/* Most appended scenes need no larger arrays; all elements are where they should be. */
static void many_scenes_need_linear_memory(void **state)
{
    (void)state;
    enum { COUNT = 300 };
    static sample samples[COUNT + 1];
    failing_allocator memory = {.fail_at = -1};
    const facet_allocator allocator = failing_allocator_get(&memory);
    facet_scene *a = NULL, *filled = make(&samples[COUNT], "one", "red");
    assert_int_equal(scene_create(&allocator, "many", &a, NULL), FACET_OK);
    facet_scene own = *a;
    *a = *filled;
    a->arena = own.arena;
    a->allocator = own.allocator;
    for (uint32_t i = 0; i < COUNT; i++) {
        facet_scene *b = make(&samples[i], "one", "red");
        b->nodes[2].translation[1] = i;
        assert_int_equal(scene_append(a, b, NULL), FACET_OK);
        if (i == 100) /* as a conversion does */
            a->materials = memcpy(arena_alloc(a->arena, a->material_count, sizeof *a->materials),
                                  a->materials, a->material_count * sizeof *a->materials);
    }
    assert_true(memory.calls < 2 * COUNT);
    assert_int_equal(a->part_count, COUNT + 1);
    assert_int_equal(a->scenes[0].node_count, COUNT + 1);
    for (uint32_t i = 0; i < COUNT; i++) {
        assert_near(a->nodes[4 * (i + 1) + 2].translation[1], i, 0.0);
        assert_int_equal(a->nodes[4 * (i + 1) + 1].children[0], 4 * (i + 1) + 2);
        assert_int_equal(a->scenes[0].nodes[i + 1], 4 * (i + 1) + 3);
        assert_int_equal(a->materials[2 * i + 3].textures[SCENE_NORMAL_TEXTURE].texture, 2 * i + 3);
        assert_int_equal(a->meshes[3 * i + 4].primitives->material, 2 * i + 3);
        assert_int_equal(a->meshes[3 * i + 4].primitives->variant_materials[1], 2 * i + 3);
    }
    scene_destroy(a);
    scene_destroy(filled);
}

static void check_address(const facet_scene *scene, scene_item item, uint32_t index, const char *source,
                          uint32_t number)
{
    const scene_address at = scene_get_address(scene, item, index);
    assert_string_equal(at.source, source);
    assert_int_equal(at.number, number);
}

static void messages_name_the_file_of_the_part(void **state)
{
    (void)state;
    sample samples[5];
    facet_scene *s[5];
    const char *names[5] = {"a.glb", "b.glb", "c.glb", "b.glb", "d.glb"};
    for (int i = 0; i < 5; i++) {
        s[i] = make(&samples[i], names[i], "red");
        s[i]->source = names[i];
    }
    check_address(s[0], SCENE_ITEM_IMAGE, 1, "a.glb", 1);
    s[0]->image_count = 0;
    assert_int_equal(scene_append(s[0], s[1], NULL), FACET_OK);
    assert_string_equal(s[0]->source, "a.glb, b.glb");
    assert_int_equal(scene_append(s[2], s[0], NULL), FACET_OK);
    assert_string_equal(s[2]->source, "c.glb, a.glb, b.glb");
    assert_int_equal(scene_append(s[2], s[3], NULL), FACET_OK);
    assert_string_equal(s[2]->source, "c.glb, a.glb, b.glb");
    assert_int_equal(scene_append(s[2], s[4], NULL), FACET_OK);
    assert_string_equal(s[2]->source, "c.glb, a.glb, b.glb, ...");
    check_address(s[2], SCENE_ITEM_IMAGE, 1, "c.glb", 1);
    check_address(s[2], SCENE_ITEM_IMAGE, 2, "b.glb", 0); /* a.glb has none */
    check_address(s[2], SCENE_ITEM_IMAGE, 7, "d.glb", 1);
    check_address(s[2], SCENE_ITEM_MATERIAL, 3, "a.glb", 1);
    check_address(s[2], SCENE_ITEM_MATERIAL, 4, "b.glb", 0);
    check_address(s[2], SCENE_ITEM_IMAGE_LIGHT, 4, "d.glb", 0);
    scene_destroy(s[2]);
}

static void a_scene_belongs_to_one_other(void **state)
{
    (void)state;
    sample one, two, three;
    const float there[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 100, 0, 0, 1};
    facet_scene *a = make(&one, "one", "red"), *b = make(&two, "two", "red"),
                *c = make(&three, "three", "red");
    assert_int_equal(scene_append(a, b, NULL), FACET_OK);
    assert_int_equal(scene_append(b, a, NULL), FACET_ERROR_ARGUMENT); /* each would own the other */
    assert_int_equal(scene_append(a, b, NULL), FACET_ERROR_ARGUMENT); /* twice */
    assert_int_equal(scene_append(b, c, NULL), FACET_ERROR_ARGUMENT); /* a would not show it */
    assert_int_equal(scene_append(c, b, NULL), FACET_ERROR_ARGUMENT);
    assert_int_equal(scene_place(b, 0, there, NULL), FACET_ERROR_ARGUMENT);
    assert_int_equal(a->part_count, 2);
    assert_int_equal(c->part_count, 0);
    assert_int_equal(scene_append(c, a, NULL), FACET_OK);
    assert_int_equal(scene_append(b, c, NULL), FACET_ERROR_ARGUMENT); /* a longer circle */
    assert_int_equal(c->part_count, 3);
    scene_destroy(c);
}

/* Whatever allocation fails, both scenes are there as before. */
static void failures_leave_both_scenes(void **state)
{
    (void)state;
    sample one, two;
    bool has_passed = false;
    for (long n = 0; !has_passed; n = next_failure(n)) {
        failing_allocator memory = {.fail_at = -1};
        const facet_allocator allocator = failing_allocator_get(&memory);
        facet_scene *a = NULL, *b = make(&two, "two", "red"), *filled = make(&one, "one", "red");
        assert_int_equal(scene_create(&allocator, "failing", &a, NULL), FACET_OK);
        facet_scene own = *a;
        *a = *filled;
        a->arena = own.arena;
        a->allocator = own.allocator;
        /* the first have space behind them for the third; the arena's blocks are full */
        sample more[2];
        for (int i = 0; i < 2; i++)
            assert_int_equal(scene_append(a, make(&more[i], "more", i ? "red" : "blue"), NULL), FACET_OK);
        long few = memory.calls + 3;
        while (arena_alloc(a->arena, 1, 16000) && memory.calls < few)
            ;
        memory.fail_at = memory.calls + n;
        b->origin[0] = 1e7;
        facet_scene before[2];
        memcpy(&before[0], a, sizeof *a);
        memcpy(&before[1], b, sizeof *b);
        facet_result result = scene_append(a, b, NULL);
        has_passed = result == FACET_OK;
        memory.fail_at = -1;
        scene_pose pose;
        assert_int_equal(scene_pose_create(a, NULL, NULL, 1, &pose, NULL), FACET_OK);
        assert_int_equal(pose.instance_count, has_passed ? 4 : 3);
        scene_pose_destroy(&pose);
        if (!has_passed) {
            assert_int_equal(result, FACET_ERROR_MEMORY);
            assert_memory_equal(&before[0], a, sizeof *a);
            assert_memory_equal(&before[1], b, sizeof *b);
            assert_int_equal(scene_pose_create(b, NULL, NULL, 1, &pose, NULL), FACET_OK);
            assert_int_equal(pose.instance_count, 1);
            scene_pose_destroy(&pose);
            scene_destroy(b);
        }
        scene_destroy(a);
        scene_destroy(filled);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(indices_follow_their_scene),
        cmocka_unit_test(variants_are_joined_by_name),
        cmocka_unit_test(animations_move_what_they_did),
        cmocka_unit_test(each_part_has_its_place),
        cmocka_unit_test(legacy_materials_need_equal_rules),
        cmocka_unit_test(failures_leave_both_scenes),
        cmocka_unit_test(a_scene_belongs_to_one_other),
        cmocka_unit_test(many_scenes_need_linear_memory),
        cmocka_unit_test(messages_name_the_file_of_the_part),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
