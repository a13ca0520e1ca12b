/* ogl1_overlay_test.c - parameters over a model: by material, by object, over all; and over models of
 * glTF. */
#include <stdio.h>
#include <string.h>

#include "tests/support/support.h"
#include "io/ogl1/ogl1_test_support.h"

/* Materials red, green; nodes: 0 "a" (mesh "m": red, green), 1 "b" (mesh "m" again), 2 "c" (mesh "n":
 * none), 3 "top" above 4 "d" (mesh "o": green) and 5 "" (mesh "p": red). */
static const char MODEL[] =
    "'buffers':[{'uri':'model.bin','byteLength':36}],'bufferViews':[{'buffer':0,'byteLength':36}],"
    "'accessors':[{'bufferView':0,'componentType':5126,'type':'VEC3','count':3,'min':[0,0,0],'max':[1,1,0]}],"
    "'materials':[{'name':'red','pbrMetallicRoughness':{'metallicFactor':0.5},'extras':{'k':1}},{'name':'"
    "green'}],"
    "'meshes':[{'name':'m','primitives':[{'attributes':{'POSITION':0},'material':0},"
    "{'attributes':{'POSITION':0},'material':1}]},"
    "{'name':'n','primitives':[{'attributes':{'POSITION':0}}]},"
    "{'name':'o','primitives':[{'attributes':{'POSITION':0},'material':1}]},"
    "{'name':'p','primitives':[{'attributes':{'POSITION':0},'material':0}]}],"
    "'nodes':[{'name':'a','mesh':0},{'name':'b','mesh':0},{'name':'c','mesh':1},{'name':'top','children':[4,"
    "5]},"
    "{'name':'d','mesh':2},{'mesh':3}],'scenes':[{'nodes':[0,1,2,3]}]";

static facet_scene *load_model(const temporary_folder *f)
{
    static const float triangle[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    char json[4096];
    facet_scene *scene = NULL;
    facet_error error = {0};
    temporary_folder_put(f, "model.bin", triangle, sizeof triangle);
    snprintf(json, sizeof json, "{'asset':{'version':'2.0'},%s}", MODEL);
    const char *path = ogl1_write_json(f, "model.gltf", json);
    if (gltf_load(path, NULL, &scene, &error) != FACET_OK)
        fail_msg("%s", error.message);
    return scene;
}

static facet_scene *lay(const temporary_folder *f, const char *parameters)
{
    facet_scene *scene = load_model(f);
    facet_error error = {0};
    const char *path = ogl1_write_json(f, "p.json", parameters);
    if (ogl1_json_overlay(scene, path, NULL, &error) != FACET_OK)
        fail_msg("%s", error.message);
    assert_non_null(scene->legacy);
    return scene;
}

/* The legacy material that primitive number k of a node has; NULL: it has no material. */
static const legacy_material *shown(const facet_scene *scene, uint32_t node, uint32_t k)
{
    const scene_primitive *p = &scene->meshes[scene->nodes[node].mesh].primitives[k];
    assert_true(p->material == SCENE_NONE || p->material < scene->material_count);
    return p->material == SCENE_NONE ? NULL : &scene->legacy->materials[p->material];
}

static float shininess(const facet_scene *scene, uint32_t node, uint32_t k)
{
    const legacy_material *m = shown(scene, node, k);
    return m ? m->shininess : -1.0f;
}

static void entries_apply_by_material_name(void **state)
{
    facet_scene *scene = lay(*state, "{'materials':[{'name':'red','shininess':7}]}");
    assert_int_equal(scene->material_count, 2);
    assert_true(shininess(scene, 0, 0) == 7.0f);
    assert_string_equal(scene->legacy->materials[0].name, "red");
    assert_string_equal(scene->materials[0].name, "red");
    /* Its glTF material is converted anew; the others keep theirs. */
    assert_true(scene->materials[0].metallic == 1.0f);
    assert_string_equal(scene->materials[0].meta.extras, "{\"k\":1}");
    assert_false(scene->legacy->materials[0].is_gltf_restored);
    assert_true(scene->legacy->materials[1].is_gltf_restored);
    assert_string_equal(scene->legacy->materials[1].name, "green");
    assert_true(shininess(scene, 2, 0) == -1.0f);
    assert_true(scene->legacy->is_source);
    assert_false(scene->legacy->is_rgl);
    assert_int_equal(scene->legacy->colors, FACET_LEGACY_COLORS_SRGB);
    assert_int_equal(scene->warning_count, 0);
    scene_destroy(scene);
}

static void entries_apply_by_object_name(void **state)
{
    facet_scene *scene =
        lay(*state, "{'materials':[{'objects':['b','c'],'shininess':7},{'name':'new','objects':'d',"
                    "'shininess':8}]}");
    assert_int_equal(scene->material_count, 4);
    assert_int_equal(scene->mesh_count, 5); /* b no longer shares the mesh of a */
    assert_true(scene->nodes[0].mesh != scene->nodes[1].mesh);
    assert_string_equal(shown(scene, 0, 0)->name, "red");
    assert_string_equal(shown(scene, 0, 1)->name, "green");
    assert_string_equal(shown(scene, 1, 0)->name, "b");
    assert_true(shininess(scene, 1, 0) == 7.0f && shininess(scene, 1, 1) == 7.0f);
    assert_ptr_equal(shown(scene, 1, 0), shown(scene, 2, 0));
    assert_string_equal(shown(scene, 4, 0)->name, "new");
    assert_true(shininess(scene, 4, 0) == 8.0f);
    assert_string_equal(shown(scene, 5, 0)->name, "red");
    assert_int_equal(scene->warning_count, 0);
    scene_destroy(scene);
}

static void entries_apply_by_mesh_and_by_ancestor(void **state)
{
    facet_scene *scene =
        lay(*state, "{'materials':[{'objects':'m','shininess':7},{'objects':'top','shininess':8},"
                    "{'objects':'o','shininess':9}]}");
    assert_int_equal(scene->mesh_count, 4);
    for (uint32_t node = 0; node < 2; node++)
        for (uint32_t k = 0; k < 2; k++)
            assert_true(shininess(scene, node, k) == 7.0f);
    assert_true(shininess(scene, 4, 0) == 9.0f); /* its own mesh before the node above */
    assert_true(shininess(scene, 5, 0) == 8.0f);
    assert_true(shininess(scene, 2, 0) == -1.0f);
    scene_destroy(scene);
}

static void the_more_specific_entry_wins(void **state)
{
    facet_scene *scene =
        lay(*state, "{'material3d':{'shininess':1},'materials':[{'objects':'a','shininess':7},"
                    "{'name':'green','shininess':8},{'shininess':2}]}");
    assert_true(shininess(scene, 0, 0) == 7.0f && shininess(scene, 0, 1) == 7.0f);
    assert_true(shininess(scene, 1, 0) == 1.0f); /* of those for all the last, material3d */
    assert_true(shininess(scene, 1, 1) == 8.0f);
    assert_true(shininess(scene, 2, 0) == 1.0f); /* it had no material */
    assert_true(shininess(scene, 4, 0) == 8.0f && shininess(scene, 5, 0) == 1.0f);
    assert_true(scene->legacy->is_rgl); /* nothing else is left */
    scene_destroy(scene);
    scene = lay(*state, "{'materials':[{'name':'red','shininess':7},{'name':'red','shininess':8},"
                        "{'objects':'c','shininess':3},{'objects':'c','shininess':4}]}");
    assert_true(shininess(scene, 0, 0) == 8.0f && shininess(scene, 2, 0) == 4.0f);
    assert_true(has_warning(scene, "material \"red\" is listed more than once"));
    assert_true(has_warning(scene, "object \"c\" is listed more than once"));
    scene_destroy(scene);
}

/* An entry with both: the material of that name, and the objects get it. */
static void entries_with_name_and_objects_apply_to_both(void **state)
{
    facet_scene *scene =
        lay(*state, "{'materials':[{'name':'red','objects':['c','nowhere'],'shininess':7}]}");
    assert_int_equal(scene->material_count, 2);
    assert_string_equal(shown(scene, 2, 0)->name, "red");
    assert_true(shininess(scene, 0, 0) == 7.0f && shininess(scene, 2, 0) == 7.0f);
    assert_int_equal(scene->warning_count, 0);
    scene_destroy(scene);
}

static void unused_entries_are_reported(void **state)
{
    facet_scene *scene =
        lay(*state, "{'materials':[{'name':'blue'},{'name':'x','objects':['y','c']}],'lights':[{}],"
                    "'fog':{'fogtype':'exp'}}");
    assert_true(has_warning(scene, "p.json: material \"blue\" is not in the model"));
    assert_true(has_warning(scene, "p.json: object \"y\" is not in the model"));
    assert_int_equal(scene->warning_count, 2);
    assert_int_equal(scene->legacy->light_count, 1);
    assert_int_equal(scene->legacy->fog.mode, LEGACY_FOG_EXP);
    assert_true(strstr(scene->source, "model.gltf") != NULL);
    scene_destroy(scene);
}

static void entries_apply_to_legacy_scenes(void **state)
{
    const temporary_folder *f = *state;
    facet_error error = {0};
    facet_scene *scene = ogl1_load("{'colors':'linear','materials':[{'name':'a','shininess':3},{'name':'b'}],"
                                   "'lights':[{},{}],'fog':{'fogtype':'exp'}}");
    const char *path =
        ogl1_write_json(f, "p.json", "{'materials':[{'name':'b','shininess':9}],'lights':[{}]}");
    assert_int_equal(ogl1_json_overlay(scene, path, NULL, &error), FACET_OK);
    assert_true(scene->legacy->materials[0].shininess == 3.0f &&
                scene->legacy->materials[1].shininess == 9.0f);
    assert_int_equal(scene->legacy->light_count, 1);
    assert_int_equal(scene->legacy->fog.mode, LEGACY_FOG_EXP); /* not stated: as it was */
    assert_int_equal(scene->legacy->colors, FACET_LEGACY_COLORS_LINEAR);
    const facet_scene_desc desc = {.legacy = {.colors = FACET_LEGACY_COLORS_SRGB}};
    assert_int_equal(ogl1_json_overlay(scene, path, &desc, &error), FACET_OK);
    assert_int_equal(scene->legacy->colors, FACET_LEGACY_COLORS_SRGB);
    scene_destroy(scene);
}

static void textures_are_appended(void **state)
{
    const temporary_folder *f = *state;
    temporary_folder_put_png(f, "a.png");
    facet_error error = {0};
    facet_scene *scene = NULL;
    const char *path =
        ogl1_write_json(f, "in.json", "{'materials':[{'name':'a','texture':'a.png'},{'name':'b'}]}");
    assert_int_equal(ogl1_json_load(path, NULL, &scene, &error), FACET_OK);
    temporary_folder_put_png(f, "b.png");
    path = ogl1_write_json(f, "p.json", "{'materials':[{'name':'b','texture':'b.png'}]}");
    assert_int_equal(ogl1_json_overlay(scene, path, NULL, &error), FACET_OK);
    assert_int_equal(scene->image_count, 2);
    assert_int_equal(scene->texture_count, 2);
    assert_int_equal(scene->legacy->materials[0].maps[LEGACY_DIFFUSE_MAP].ref.texture, 0);
    assert_int_equal(scene->legacy->materials[1].maps[LEGACY_DIFFUSE_MAP].ref.texture, 1);
    assert_int_equal(scene->textures[1].image, 1);
    assert_string_equal(scene->images[1].uri, "b.png");
    scene_destroy(scene);
}

static void failures_are_reported(void **state)
{
    const temporary_folder *f = *state;
    facet_scene *scene = load_model(f);
    facet_error error = {0};
    assert_int_equal(ogl1_json_overlay(scene, temporary_folder_file(f, "none.json"), NULL, &error),
                     FACET_ERROR_READ);
    const char *path = ogl1_write_json(f, "p.json", "{'materials':[{'shininess':'x'}]}");
    assert_int_equal(ogl1_json_overlay(scene, path, NULL, &error), FACET_ERROR_INVALID);
    assert_non_null(strstr(error.message, "p.json: materials[0].shininess: must be a number"));
    assert_null(scene->legacy);
    assert_true(strstr(scene->source, "model.gltf") != NULL);
    scene_destroy(scene);
}

static void failed_allocations_are_reported(void **state)
{
    const temporary_folder *f = *state;
    temporary_folder_put_png(f, "a.png");
    failing_allocator failing = {.fail_at = -1};
    facet_scene_desc desc = {.allocator = failing_allocator_get(&failing)};
    facet_result result = FACET_ERROR_MEMORY;
    facet_error error = {0};
    scene_destroy(load_model(f)); /* writes it */
    const char *parameters =
        ogl1_write_json(f, "p.json",
                        "{'materials':[{'objects':['b','d'],'texture':'a.png'},{'name':'red'},{}],"
                        "'lights':[{}]}");
    long n = 0;
    for (; n < 1000; n++) {
        facet_scene *scene = NULL;
        failing.fail_at = -1;
        assert_int_equal(gltf_load(temporary_folder_file(f, "model.gltf"), &desc, &scene, &error), FACET_OK);
        failing.calls = 0;
        failing.fail_at = n;
        result = ogl1_json_overlay(scene, parameters, &desc, &error);
        bool is_done = failing.calls <= n;
        scene_destroy(scene);
        assert_int_equal(failing.blocks, 0);
        if (is_done)
            break;
        if (result != FACET_OK)
            assert_int_equal(result, FACET_ERROR_MEMORY);
    }
    assert_int_equal(result, FACET_OK);
    assert_in_range(n, 5, 999);
}

int main(void)
{
#define IN_FOLDER(test) cmocka_unit_test_setup_teardown(test, ogl1_folder_create, ogl1_folder_remove)
    const struct CMUnitTest tests[] = {
        IN_FOLDER(entries_apply_by_material_name),
        IN_FOLDER(entries_apply_by_object_name),
        IN_FOLDER(entries_apply_by_mesh_and_by_ancestor),
        IN_FOLDER(the_more_specific_entry_wins),
        IN_FOLDER(entries_with_name_and_objects_apply_to_both),
        IN_FOLDER(unused_entries_are_reported),
        IN_FOLDER(entries_apply_to_legacy_scenes),
        IN_FOLDER(textures_are_appended),
        IN_FOLDER(failures_are_reported),
        IN_FOLDER(failed_allocations_are_reported),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
