/* Tests of identity.h: numbers, names and Cryptomatte's IDs and manifests. */
#include "scene/motion_test_support.h"

#include <stdio.h>
#include <string.h>

#include "tests/support/support.h"
#include "base/text.h"
#include "scene/identity.h"

static const float CORNERS[9] = {0, 0, 0, 1, 0, 0, 0, 2, 0};
static const uint32_t INDICES[3] = {0, 1, 2};
static const float PLACES[9] = {0, 0, 0, 1, 0, 0, 2, 0, 0};
static const float SCALES[9] = {1, 1, 1, 0, 0, 0, 1, 1, 1}; /* the second copy is not drawn */

/* Three nodes of one mesh; the middle one is drawn at three places. */
static facet_scene *make_scene(void)
{
    facet_scene *scene = test_scene(3);
    static const scene_instancing instancing = {.count = 3, .translations = PLACES, .scales = SCALES};
    scene->meshes[0].primitives[0] = (scene_primitive){.mode = SCENE_TRIANGLES,
                                                       .vertex_count = 3,
                                                       .index_count = 3,
                                                       .indices = INDICES,
                                                       .positions = CORNERS,
                                                       .normals = CORNERS,
                                                       .material = SCENE_NONE,
                                                       .bounds_max = {1, 2, 0}};
    for (int i = 0; i < 3; i++)
        scene->nodes[i].mesh = 0;
    scene->meshes[0].name = "tree";
    scene->nodes[0].name = "hello";
    scene->nodes[1].name = "";
    scene->nodes[1].instancing = &instancing;
    scene->nodes[2].name = "hello";
    return scene;
}

static void ids_do_not_depend_on_the_pose(void **state)
{
    (void)state;
    facet_scene *scene = make_scene();
    scene_pose pose;
    scene_identity *ids;
    assert_int_equal(scene_pose_create(scene, NULL, NULL, 2, &pose, NULL), FACET_OK);
    assert_int_equal(scene_identities_create(scene, &pose, NULL, &ids, NULL), FACET_OK);
    static const float objects[] = {1, 2, 2, 3}, instances[] = {1, 2, 4, 5};
    assert_int_equal(pose.instance_count, 4);
    for (int i = 0; i < 4; i++) {
        assert_near(ids[i].numbers[SCENE_IDENTITY_OBJECT], objects[i], 0);
        assert_near(ids[i].numbers[SCENE_IDENTITY_INSTANCE], instances[i], 0);
        assert_near(ids[i].numbers[SCENE_IDENTITY_MATERIAL], 0, 0);
    }
    float hello = scene_identity_hash("hello"), second = scene_identity_hash("tree#4");
    assert_memory_equal(&ids[0].hashes[SCENE_IDENTITY_OBJECT], &hello, sizeof hello);
    assert_memory_equal(&ids[3].hashes[SCENE_IDENTITY_OBJECT], &hello, sizeof hello);
    assert_memory_equal(&ids[2].hashes[SCENE_IDENTITY_INSTANCE], &second, sizeof second);
    mem_free(ids);
    scene_pose_destroy(&pose);
    scene_destroy(scene);
}

/* Names that several nodes share are one ID; names of instances are their own. 248bfa47 is MurmurHash3 of
 * "hello". */
static void manifests_have_every_name_once(void **state)
{
    (void)state;
    facet_scene *scene = make_scene();
    text objects = {0}, instances = {0}, materials = {0};
    assert_int_equal(scene_identity_manifest(scene, SCENE_IDENTITY_OBJECT, &objects, NULL), FACET_OK);
    assert_int_equal(scene_identity_manifest(scene, SCENE_IDENTITY_INSTANCE, &instances, NULL), FACET_OK);
    assert_int_equal(scene_identity_manifest(scene, SCENE_IDENTITY_MATERIAL, &materials, NULL), FACET_OK);
    assert_non_null(strstr(objects.data, "{\"hello\":\"248bfa47\",\"tree\":\""));
    assert_int_equal(objects.length, strlen("{\"hello\":\"248bfa47\",\"tree\":\"00000000\"}"));
    assert_non_null(strstr(instances.data, "\"hello#1\":"));
    assert_non_null(strstr(instances.data, "\"tree#4\":"));
    assert_non_null(strstr(instances.data, "\"hello#5\":"));
    assert_non_null(strstr(materials.data, "{\"default material\":\""));
    text_destroy(&objects);
    text_destroy(&instances);
    text_destroy(&materials);
    scene_destroy(scene);
}

/* A few bytes of a file may stand for any number of instances, which no image shows. */
static void manifests_are_limited(void **state)
{
    (void)state;
    facet_scene *scene = make_scene();
    const scene_instancing many = {.count = UINT32_MAX};
    for (uint32_t i = 0; i < scene->node_count; i++)
        scene->nodes[i].instancing = scene->nodes[i].mesh == SCENE_NONE ? NULL : &many;
    text manifest = {0};
    assert_int_equal(scene_identity_manifest(scene, SCENE_IDENTITY_INSTANCE, &manifest, NULL), FACET_OK);
    size_t names = 0;
    for (const char *c = manifest.data; *c; c++)
        names += *c == ':';
    assert_int_equal(names, SCENE_IDENTITY_MAX_NAMES);
    text_destroy(&manifest);
    scene_destroy(scene);
}

/* The bits of an ID are a float that every program compares and copies without change. */
static void ids_are_ordinary_floats(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < 20000; i++) {
        char name[16];
        snprintf(name, sizeof name, "n%u", i);
        float id = scene_identity_hash(name);
        uint32_t bits;
        memcpy(&bits, &id, sizeof bits);
        assert_true((bits >> 23 & 255) != 0 && (bits >> 23 & 255) != 255);
    }
}

static void every_failed_allocation_is_an_error(void **state)
{
    (void)state;
    facet_scene *scene = make_scene();
    scene_pose pose;
    assert_int_equal(scene_pose_create(scene, NULL, NULL, 2, &pose, NULL), FACET_OK);
    facet_result result = FACET_ERROR_MEMORY;
    for (int fails_at = 0; result != FACET_OK && fails_at < 100; fails_at++) {
        failing_allocator failing = {.fail_at = fails_at};
        facet_allocator allocator = failing_allocator_get(&failing);
        scene_identity *ids;
        text manifest = {.allocator = allocator};
        facet_error error = {0};
        result = scene_identities_create(scene, &pose, &allocator, &ids, &error);
        if (result == FACET_OK)
            mem_free(ids);
        if (result == FACET_OK)
            result = scene_identity_manifest(scene, SCENE_IDENTITY_INSTANCE, &manifest, &error);
        assert_true(result == FACET_OK || (result == FACET_ERROR_MEMORY && error.message[0]));
        text_destroy(&manifest);
    }
    assert_int_equal(result, FACET_OK);
    scene_pose_destroy(&pose);
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ids_do_not_depend_on_the_pose),
        cmocka_unit_test(manifests_have_every_name_once),
        cmocka_unit_test(manifests_are_limited),
        cmocka_unit_test(ids_are_ordinary_floats),
        cmocka_unit_test(every_failed_allocation_is_an_error),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
