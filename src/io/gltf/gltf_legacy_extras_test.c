/* gltf_legacy_extras_test.c - the sources of converted materials survive in the extras of a glTF file. */
#include "io/gltf/gltf_test_support.h"

#include <stdio.h>
#include <string.h>

#include "scene/legacy_extras.h"

/* A material that states everything. */
static legacy_material make_material(void)
{
    legacy_material m = legacy_material_default();
    m.name = "m";
    for (int i = 0; i < LEGACY_PARAMETER_COUNT; i++) {
        float *values = legacy_floats(&m, &legacy_parameters[i]);
        for (uint32_t k = 0; k < legacy_parameters[i].count; k++)
            values[k] = 0.1f + 0.05f * (float)(3 * i % 16 + (int)k);
        m.fields |= legacy_parameters[i].field;
    }
    for (int i = 0; i < LEGACY_FLAG_COUNT; i++) {
        bool value = !legacy_flags[i].fallback;
        memcpy((char *)&m + legacy_flags[i].offset, &value, sizeof value);
    }
    m.illum = 4;
    m.fields |= LEGACY_ILLUM;
    m.texture_type = LEGACY_LUMINANCE_ALPHA;
    m.texture_mode = LEGACY_ADD;
    for (int i = 0; i < LEGACY_MAP_COUNT; i++)
        m.maps[i].path = "a \"quoted\" \xc3\xa4.png";
    legacy_map *map = &m.maps[LEGACY_DIFFUSE_MAP];
    map->ref = (scene_texture_ref){
        .texture = 1, .texcoord = 2, .offset = {0.1f, -0.2f}, .rotation_rad = 0.5f, .scale = {2, 3}};
    scene_texture_ref_update(&map->ref);
    map->base = 0.1f;
    map->gain = -1;
    map->bump_multiplier = 0.3f;
    map->channel = 'z';
    map->options = "-mm 0.1 -1";
    map->dropped = "-t 1";
    m.unknown = "key 1\nother 2\n";
    return m;
}

static scene_material make_pbr(void)
{
    scene_material m = scene_material_default();
    m.extensions = SCENE_SPECULAR | SCENE_IOR | SCENE_EMISSIVE_STRENGTH;
    m.base_color[0] = 0.1f;
    m.base_color[3] = 0.5f;
    m.metallic = 0;
    m.perceptual_roughness = 0.37f;
    m.specular = 0.1035f;
    m.specular_color[1] = 0.5f;
    m.ior = 0;
    m.emissive[0] = 0.5f;
    m.emissive_strength = 3;
    return m;
}

/* A file with that material, whose roughness is as given. */
static facet_scene *load_with(const legacy_material *m, const char *roughness, const char *root_extras)
{
    const scene_material pbr = make_pbr();
    text body = {0};
    text extras = {0};
    scene_legacy legacy = {.materials = (legacy_material *)m};
    legacy_extras_write(&legacy, 0, &pbr, &extras);
    assert_false(extras.has_failed);
    text_addf(
        &body,
        "\"extensionsUsed\":[\"KHR_materials_specular\",\"KHR_materials_ior\","
        "\"KHR_materials_emissive_strength\"],\"textures\":[{},{}],\"materials\":[{\"name\":\"plain\"},"
        "{\"name\":\"m\",\"emissiveFactor\":[0.5,0,0],\"pbrMetallicRoughness\":{"
        "\"baseColorFactor\":[0.1,1,1,0.5],\"metallicFactor\":0,\"roughnessFactor\":%s},\"extensions\":{"
        "\"KHR_materials_specular\":{\"specularFactor\":0.1035,\"specularColorFactor\":[1,0.5,1]},"
        "\"KHR_materials_ior\":{\"ior\":0},\"KHR_materials_emissive_strength\":{\"emissiveStrength\":3}},"
        "\"extras\":{\"mine\":1,\"facet_legacy\":%s}}]%s",
        roughness, extras.data, root_extras);
    facet_scene *scene = load(body.data, NULL);
    text_destroy(&body);
    text_destroy(&extras);
    return scene;
}

static void assert_same(const legacy_material *a, const legacy_material *b)
{
    text first = {0};
    text second = {0};
    legacy_extras_write_material(a, NULL, &first);
    legacy_extras_write_material(b, NULL, &second);
    assert_string_equal(first.data, second.data);
    text_destroy(&first);
    text_destroy(&second);
}

static void values_round_trip(void **state)
{
    (void)state;
    const legacy_material m = make_material();
    facet_scene *scene = load_with(&m, "0.37", "");
    assert_non_null(scene->legacy);
    assert_false(scene->legacy->is_source);
    assert_int_equal(scene->legacy->colors, FACET_LEGACY_COLORS_SRGB);
    assert_int_equal(scene->legacy->dialect, FACET_MTL_DIALECT_SPEC);
    assert_same(&m, &scene->legacy->materials[1]);
    assert_memory_equal(m.maps[LEGACY_DIFFUSE_MAP].ref.transform,
                        scene->legacy->materials[1].maps[LEGACY_DIFFUSE_MAP].ref.transform,
                        6 * sizeof(float));
    assert_string_equal(scene->legacy->materials[0].name, "plain");
    assert_int_equal(scene->legacy->materials[0].fields, 0);
    assert_non_null(strstr(scene->materials[1].meta.extras, "\"mine\":1"));
    scene_destroy(scene);
}

static void extras_of_edited_materials_are_ignored(void **state)
{
    (void)state;
    const legacy_material m = make_material();
    facet_scene *scene = load_with(&m, "0.370001", "");
    assert_null(scene->legacy);
    assert_true(has_warning(scene, "has no source; white is used (2 times in all)"));
    scene_destroy(scene);
    scene = load_with(&m, "0.37000003", ""); /* one float off */
    assert_non_null(scene->legacy);
    scene_destroy(scene);
}

/* If an image is missing, by its mark or by its index, the glTF material is used. An image that was
 * missing from the start, or that no surface shows, does not matter. */
static void extras_of_materials_without_their_images_are_ignored(void **state)
{
    (void)state;
    legacy_material m = make_material();
    m.maps[LEGACY_BUMP_MAP].is_left_out = true;
    facet_scene *scene = load_with(&m, "0.37", ",\"extras\":{\"facet_legacy\":{\"colors\":\"linear\"}}");
    assert_non_null(scene->legacy);
    assert_int_equal(scene->legacy->colors, FACET_LEGACY_COLORS_LINEAR);
    assert_int_equal(scene->legacy->materials[1].fields, 0);
    assert_string_equal(scene->legacy->materials[1].name, "m");
    assert_null(scene->legacy->materials[1].maps[LEGACY_BUMP_MAP].path);
    scene_destroy(scene);
    m = make_material();
    m.maps[LEGACY_SPECULAR_MAP].ref.texture = 2; /* of two */
    scene = load_with(&m, "0.37", "");
    assert_int_equal(scene->legacy->materials[1].fields, 0);
    scene_destroy(scene);
    m = make_material();
    m.maps[LEGACY_DISPLACEMENT_MAP].is_left_out = true;
    m.maps[LEGACY_DISPLACEMENT_MAP].path = NULL;
    scene = load_with(&m, "0.37", "");
    assert_same(&m, &scene->legacy->materials[1]);
    assert_true(scene->legacy->materials[1].maps[LEGACY_DISPLACEMENT_MAP].is_left_out);
    assert_true(scene->legacy->materials[1].fields != 0);
    scene_destroy(scene);
}

static void lights_and_fog_round_trip(void **state)
{
    (void)state;
    legacy_light lights[2] = {legacy_light_default(),
                              {.is_point = true, .position = {1, 2, 3}, .diffuse = {0.1f, 0.2f, 0.3f}}};
    const scene_legacy legacy = {.light_count = 2,
                                 .lights = lights,
                                 .fog = {.mode = LEGACY_FOG_EXP2, .color = {0.1f, 0, 1}, .scale = 2},
                                 .colors = FACET_LEGACY_COLORS_LINEAR,
                                 .dialect = FACET_MTL_DIALECT_BLENDER28,
                                 .is_rgl = true};
    text object = {0};
    text extras = {0};
    legacy_extras_write_scene(&legacy, &object);
    text_add(&extras, ",\"extras\":");
    legacy_extras_merge("{\"a\":[1,{\"facet_legacy\":2}]}", object.data, &extras);
    const legacy_material m = make_material();
    facet_scene *scene =
        load_with(&m, "0.1", extras.data); /* lights are restored independently of materials */
    const scene_legacy *read = scene->legacy;
    assert_non_null(read);
    assert_int_equal(read->light_count, 2);
    for (int i = 0; i < 2; i++) {
        assert_int_equal(read->lights[i].is_point, lights[i].is_point);
        assert_int_equal(read->lights[i].is_viewpoint_relative, lights[i].is_viewpoint_relative);
        assert_floats(read->lights[i].position, lights[i].position, 3, 0);
        assert_floats(read->lights[i].ambient, lights[i].ambient, 3, 0);
        assert_floats(read->lights[i].diffuse, lights[i].diffuse, 3, 0);
        assert_floats(read->lights[i].specular, lights[i].specular, 3, 0);
    }
    assert_int_equal(read->fog.mode, LEGACY_FOG_EXP2);
    assert_near(read->fog.scale, 2, 0);
    assert_near(read->fog.color[0], 0.1, 1e-8);
    assert_int_equal(read->colors, FACET_LEGACY_COLORS_LINEAR);
    assert_int_equal(read->dialect, FACET_MTL_DIALECT_BLENDER28);
    assert_true(read->is_rgl);
    assert_int_equal(read->materials[1].fields, 0);
    text_destroy(&object);
    text_destroy(&extras);
    scene_destroy(scene);
}

/* Any program may use extras: unexpected content is no error. */
static void foreign_extras_are_ignored(void **state)
{
    (void)state;
    static const char *const extras[] = {"7",
                                         "[]",
                                         "{'facet_legacy':[]}",
                                         "{'facet_legacy':{}}",
                                         "{'facet_legacy':{'pbr':{}}}",
                                         "{'facet_legacy':{'pbr':{'baseColorFactor':['a',1,1],'alpha':1}}}"};
    char body[512];
    for (size_t i = 0; i < sizeof extras / sizeof *extras; i++) {
        snprintf(body, sizeof body, "'materials':[{'extras':%s}],'extras':%s", extras[i], extras[i]);
        facet_scene *scene = load(body, NULL);
        assert_null(scene->legacy);
        assert_int_equal(scene->warning_count, 0);
        scene_destroy(scene);
    }
    facet_scene *scene =
        load("'materials':[{'extras':{'facet_legacy':{'pbr':{'baseColorFactor':[1,1,1],'alpha':1,'"
             "metallicFactor':1,"
             "'roughnessFactor':1,'specularFactor':1,'specularColorFactor':[1,1,1],'ior':1.5,'emissiveFactor'"
             ":[0,0,0]},"
             "'Kd':[1,2],'Ks':'red','Ns':-1,'d':[0.5],'illum':11,'lit':0,'texture_type':'cmyk','map_Kd':"
             "{'texture':-9,'texCoord':-1,'offset':7,'imfchan':'rg','path':3},'map_Ks':[]}}}],"
             "'extras':{'facet_legacy':{'lights':[7,{'position':[1,2]}],'fog':9,'colors':'default','dialect':"
             "'auto'}}",
             NULL);
    const legacy_material *m = &scene->legacy->materials[0];
    assert_int_equal(m->fields, LEGACY_OPACITY);
    assert_near(m->opacity, 0.5, 0);
    assert_near(m->diffuse[0], 0.8, 1e-7);
    assert_true(m->is_lit);
    assert_int_equal(m->texture_type, LEGACY_RGB);
    assert_int_equal(m->maps[LEGACY_DIFFUSE_MAP].ref.texture, SCENE_NONE);
    assert_null(m->maps[LEGACY_DIFFUSE_MAP].path);
    assert_int_equal(scene->legacy->light_count, 2);
    assert_int_equal(scene->legacy->colors, FACET_LEGACY_COLORS_SRGB);
    assert_int_equal(scene->legacy->dialect, FACET_MTL_DIALECT_SPEC);
    scene_destroy(scene);
}

static void extras_are_merged(void **state)
{
    (void)state;
    static const struct {
        const char *extras, *object, *expected;
    } cases[] = {
        {NULL, "{}", "{\"facet_legacy\":{}}"},
        {"{}", "{}", "{\"facet_legacy\":{}}"},
        {"{\"a\":1}", "{\"b\":2}", "{\"a\":1,\"facet_legacy\":{\"b\":2}}"},
        {"{\"facet_legacy\":{\"x\":[1,\"}\"]},\"a\":\"\\\",{\"}", "{}",
         "{\"a\":\"\\\",{\",\"facet_legacy\":{}}"},
        {"{\"a\":{\"facet_legacy\":1},\"facet_legacy\":2}", NULL, "{\"a\":{\"facet_legacy\":1}}"},
        {"[1,2]", "{}", "{\"extras\":[1,2],\"facet_legacy\":{}}"},
        {"7", NULL, "7"},
        {"{\"facet_legacy\":{}}", NULL, NULL},
        {NULL, NULL, NULL},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        text out = {0};
        legacy_extras_merge(cases[i].extras, cases[i].object, &out);
        if (cases[i].expected)
            assert_string_equal(out.data, cases[i].expected);
        else
            assert_int_equal(out.length, 0);
        text_destroy(&out);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(values_round_trip),
        cmocka_unit_test(extras_of_edited_materials_are_ignored),
        cmocka_unit_test(extras_of_materials_without_their_images_are_ignored),
        cmocka_unit_test(lights_and_fog_round_trip),
        cmocka_unit_test(foreign_extras_are_ignored),
        cmocka_unit_test(extras_are_merged),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
