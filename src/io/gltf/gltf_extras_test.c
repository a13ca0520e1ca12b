/* gltf_extras_test.c - variants, instances, image-based lights, metadata. */
#include "io/gltf/gltf_test_support.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const float CORNERS[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};

/* ---- variants ---- */

static void variants_name_materials(void **state)
{
    (void)state;
    test_model m = {0};
    model_add_floats(&m, CORNERS, 3, "VEC3");
    facet_scene *scene = model_load(
        &m, "'extensionsUsed':['KHR_materials_variants'],'materials':[{},{},{}],"
            "'extensions':{'KHR_materials_variants':{'variants':[{'name':'red'},{'name':'blue'},{}]}},"
            "'meshes':[{'primitives':[{'attributes':{'POSITION':0},'material':1,'extensions':{"
            "'KHR_materials_variants':{'mappings':[{'material':2,'variants':[1]},{'material':0,'variants':["
            "0,1]}]}}},{'attributes':{'POSITION':0}}]}]");
    assert_int_equal(scene->variant_count, 3);
    assert_string_equal(scene->variants[0], "red");
    assert_string_equal(scene->variants[2], "");
    const scene_primitive *p = scene->meshes[0].primitives;
    assert_int_equal(p[0].material, 1);
    assert_int_equal(p[0].variant_materials[0], 0);
    assert_int_equal(p[0].variant_materials[1], 2); /* the first one is kept */
    assert_int_equal(p[0].variant_materials[2], SCENE_NONE);
    assert_null(p[1].variant_materials);
    assert_true(has_note(scene, "mappings[1].variants[1]: variant 1 has a material already"));
    assert_true(has_note(scene, "variants[2].name: is missing"));
    scene_destroy(scene);
    static const char body[] =
        "'extensionsUsed':['KHR_materials_variants'],'materials':[{}],"
        "'extensions':{'KHR_materials_variants':{'variants':[{'name':'a'}]}},"
        "'meshes':[{'primitives':[{'attributes':{'POSITION':0},'extensions':{'KHR_materials_variants':{"
        "'mappings':[{'material':%d,'variants':[%d]}]}}}]}]";
    model_assert_left_out(&m, "mappings[0].material: material 1 does not exist", body, 1, 0);
    model_assert_left_out(&m, "mappings[0].variants[0]: variant 1 does not exist", body, 0, 1);
}

/* ---- instances ---- */

static void instances_are_read(void **state)
{
    (void)state;
    const float moves[6] = {1, 2, 3, 4, 5, 6};
    const short turns[8] = {0, 0, 0, 32767, 23170, 0, 0, 23170};
    const float scales[6] = {1, 1, 1, 2, INFINITY, 2};
    test_model m = {0};
    model_add_floats(&m, CORNERS, 3, "VEC3");
    model_add_floats(&m, moves, 2, "VEC3");
    model_add(&m, turns, 2, "VEC4", 5122, ",'normalized':true");
    model_add_floats(&m, scales, 2, "VEC3");
    facet_scene *scene = model_load(
        &m, "'extensionsUsed':['EXT_mesh_gpu_instancing'],'meshes':[{'primitives':[{'attributes':{"
            "'POSITION':0}}]}],'nodes':[{'mesh':0,'extensions':{'EXT_mesh_gpu_instancing':{'attributes':{"
            "'TRANSLATION':1,'ROTATION':2,'SCALE':3,'_ID':1}}}},{'mesh':0,'extensions':{"
            "'EXT_mesh_gpu_instancing':{'attributes':{'SCALE':1}}}},{'mesh':0,'extensions':{"
            "'EXT_mesh_gpu_instancing':{'attributes':{}}}}]");
    const scene_instancing *i = scene->nodes[0].instancing;
    assert_int_equal(i->count, 2);
    assert_floats(i->translations, moves, 6, 0);
    assert_near(i->rotations[4], sqrt(0.5), 1e-5);
    assert_near(i->rotations[4] * i->rotations[4] + i->rotations[7] * i->rotations[7], 1, 2e-5);
    assert_near(i->scales[3], 2, 0);
    assert_near(i->scales[4], 0, 0);
    i = scene->nodes[1].instancing;
    assert_null(i->translations);
    assert_null(i->rotations);
    assert_floats(i->scales, moves, 6, 0);
    assert_null(scene->nodes[2].instancing);
    assert_true(has_warning(scene, "accessor 3 has scales that are not finite"));
    assert_true(has_warning(scene, "has no TRANSLATION, ROTATION or SCALE"));
    scene_destroy(scene);
    static const char body[] =
        "'extensionsUsed':['EXT_mesh_gpu_instancing'],'meshes':[{'primitives':[{'attributes':{"
        "'POSITION':0}}]}],'nodes':[{'mesh':0,'extensions':{'EXT_mesh_gpu_instancing':{'attributes':{"
        "'TRANSLATION':%d,'ROTATION':%d}}}}]";
    model_assert_refused(&m, "ROTATION: accessor 2 has 2 elements, but there are 3 instances", body, 0, 2);
    model_assert_refused(
        &m, "accessor 1 has a type and componentType that are not allowed for ROTATION of instances", body, 1,
        1);
}

/* A few bytes of JSON that declare a million instances take no memory: without data, all of them coincide. */
static void instances_without_data_are_one(void **state)
{
    (void)state;
    static const float corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    test_model m = {0};
    model_add_floats(&m, corners, 3, "VEC3");
    static const char body[] =
        "'extensionsUsed':['EXT_mesh_gpu_instancing'],'meshes':[{'primitives':[{'attributes':{"
        "'POSITION':0}}]}],'nodes':[{'mesh':0,'extensions':{'EXT_mesh_gpu_instancing':{'attributes':{"
        "'%s':1}}}}]";
    strcpy(m.accessors + strlen(m.accessors), ",{'componentType':5126,'count':1000000,'type':'VEC3'}");
    static const char *const names[2] = {"TRANSLATION", "SCALE"};
    for (int i = 0; i < 2; i++) {
        facet_scene *scene = model_load(&m, body, names[i]);
        assert_int_equal(scene->nodes[0].instancing->count, 1);
        assert_null(scene->nodes[0].instancing->translations);
        assert_true((scene->nodes[0].instancing->scales != NULL) == (i == 1)); /* of size 0 */
        assert_true(has_warning(scene, "1000000 instances without data are in one place; one is drawn"));
        scene_destroy(scene);
    }
}

/* ---- lights that are images ---- */

#define PNG                                                                                                  \
    "'data:image/png;base64,"                                                                                \
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mP8z8BQDwAEhQGAhKmMIQAAAABJRU5ErkJggg=='"
#define IMAGE_LIGHT                                                                                          \
    "'extensionsUsed':['EXT_lights_image_based'],'images':[{'uri':" PNG "},{'uri':" PNG "}],"                \
    "'extensions':{'EXT_lights_image_based':{'lights':[{'name':'sky','intensity':2,'rotation':[0,2,0,0],"    \
    "'specularImageSize':%d,'specularImages':[[0,0,0,0,0,1],[1,1,1,1,1,%d]],'irradianceCoefficients':["      \
    "[1,2,3],[0,0,0],[0,0,0],[0,0,0],[0,0,0],[0,0,0],[0,0,0],[0,0,0],%s]}]}},"

static void image_lights_are_read(void **state)
{
    (void)state;
    char body[2048];
    snprintf(body, sizeof body,
             IMAGE_LIGHT "'scenes':[{},{'extensions':{'EXT_lights_image_based':{'light':0}}}]", 2, 0,
             "[7,8,9]");
    facet_scene *scene = load(body, NULL);
    assert_int_equal(scene->image_light_count, 1);
    const scene_image_light *l = &scene->image_lights[0];
    assert_string_equal(l->name, "sky");
    assert_near(l->intensity, 2, 0);
    assert_near(l->rotation[1], 1, 0);
    assert_near(l->irradiance[0][1], 2, 0);
    assert_near(l->irradiance[8][2], 9, 0);
    assert_int_equal(l->specular_size, 2);
    assert_int_equal(l->mip_count, 2);
    assert_int_equal(l->images[5], 1);
    assert_int_equal(l->images[11], 0);
    assert_int_equal(scene->scenes[0].image_light, SCENE_NONE);
    assert_int_equal(scene->scenes[1].image_light, 0);
    assert_int_equal(scene->warning_count, 0);
    scene_destroy(scene);
    static const struct {
        int image;
        const char *coefficient, *extension, *message;
    } cases[] = {
        {2, "[7,8,9]", "'light':0", "specularImages[1][5]: image 2 does not exist"},
        {0, "[7,8]", "'light':0", "irradianceCoefficients[8]: must have 3 numbers, but has 2"},
        {0, "[7,8,9],[0,0,0]", "'light':0", "must have 9 coefficients, but has 10"},
        {0, "[7,8,9]", "'light':1", "light: light 1 does not exist"},
        {0, "[7,8,9]", "", "light: is missing"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char whole[4096];
        snprintf(body, sizeof body, IMAGE_LIGHT, 2, cases[i].image, cases[i].coefficient);
        snprintf(whole, sizeof whole, "%s'scenes':[{'extensions':{'EXT_lights_image_based':{%s}}}]", body,
                 cases[i].extension);
        assert_left_out(whole, NULL, cases[i].message);
    }
}

/* ---- metadata ---- */

static void extras_are_kept_verbatim(void **state)
{
    (void)state;
    facet_scene *scene = load(
        "'extras':{'z':0.1,'a':[1,2.5,true,null,'\xc3\xa4\\n'],'u':'\\u0000'},'materials':[{'extras':3},{"
        "'extras':[0.30000000000000004]}],'nodes':[{'extras':{}}],'cameras':[{'extras':'c','type':"
        "'perspective','perspective':{'yfov':1,'znear':1}}],'scenes':[{'extras':false}],"
        "'images':[{'extras':1,'uri':" PNG "}],'textures':[{'source':0,'extras':2}]",
        NULL);
    assert_string_equal(scene->meta.extras,
                        "{\"z\":0.1,\"a\":[1,2.5,true,null,\"\xc3\xa4\\n\"],\"u\":\"\\u0000\"}");
    assert_null(scene->asset_meta.extras);
    assert_string_equal(scene->materials[0].meta.extras, "3");
    assert_string_equal(scene->materials[1].meta.extras, "[0.30000000000000004]");
    assert_string_equal(scene->nodes[0].meta.extras, "{}");
    assert_string_equal(scene->cameras[0].meta.extras, "\"c\"");
    assert_string_equal(scene->scenes[0].meta.extras, "false");
    assert_string_equal(scene->images[0].meta.extras, "1");
    assert_string_equal(scene->textures[0].meta.extras, "2");
    assert_null(scene->nodes[0].meta.extensions);
    scene_destroy(scene);
}

static void xmp_is_kept(void **state)
{
    (void)state;
    facet_scene *scene =
        load("'extensionsUsed':['KHR_xmp_json_ld'],'extensions':{'KHR_xmp_json_ld':{'packets':[{"
             "'dc:title':'t'}]}},'nodes':[{'extensions':{'KHR_xmp_json_ld':{'packet':0},'VENDOR_x':{}}},{"
             "'extensions':{'KHR_xmp_json_ld':{'packet':1}}}]",
             NULL);
    assert_string_equal(scene->meta.extensions, "{\"KHR_xmp_json_ld\":{\"packets\":[{\"dc:title\":\"t\"}]}}");
    assert_string_equal(scene->nodes[0].meta.extensions, "{\"KHR_xmp_json_ld\":{\"packet\":0}}");
    assert_true(has_note(scene, "nodes[1].KHR_xmp_json_ld.packet: is not the index of a packet"));
    assert_int_equal(scene->extensions[0].support, SCENE_SUPPORTED);
    scene_destroy(scene);
}

/* ---- where extensions may stand ---- */

static void misplaced_extensions_are_reported(void **state)
{
    (void)state;
    test_model m = {0};
    model_add_floats(&m, CORNERS, 3, "VEC3");
    facet_scene *scene = model_load(
        &m, "'extensionsUsed':['KHR_materials_variants','KHR_materials_sheen','EXT_mesh_gpu_instancing',"
            "'KHR_texture_transform','KHR_animation_pointer','EXT_lights_image_based'],"
            "'materials':[{'extensions':{'KHR_materials_sheen':{},'EXT_lights_image_based':{}}}],"
            "'meshes':[{'extensions':{'EXT_mesh_gpu_instancing':{}},'primitives':[{'extensions':{"
            "'KHR_materials_sheen':{}},'attributes':{'POSITION':0}}]}],"
            "'nodes':[{'extensions':{'KHR_materials_variants':{},'KHR_texture_transform':{}}}],"
            "'scenes':[{'extensions':{'KHR_animation_pointer':{}}}]");
    static const char *const wrong[] = {"KHR_materials_variants",  "KHR_materials_sheen",
                                        "EXT_mesh_gpu_instancing", "KHR_texture_transform",
                                        "KHR_animation_pointer",   "EXT_lights_image_based"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        char text[128];
        snprintf(text, sizeof text, "has %s in an object that it does not extend", wrong[i]);
        assert_true(has_note(scene, text));
    }
    scene_destroy(scene);
}

/* ---- real models ---- */

static void real_models_are_read(void **state)
{
    (void)state;
    facet_scene *scene = load_shared("materials/MaterialsVariantsShoe.glb");
    assert_int_equal(scene->variant_count, 3);
    assert_string_equal(scene->variants[0], "midnight");
    assert_non_null(first_primitive(scene)->variant_materials);
    scene_destroy(scene);

    scene = load_shared("extensions/SimpleInstancing.glb");
    const scene_instancing *instancing = NULL;
    for (uint32_t i = 0; i < scene->node_count; i++)
        instancing = scene->nodes[i].instancing ? scene->nodes[i].instancing : instancing;
    assert_non_null(instancing);
    assert_int_equal(instancing->count, 125);
    scene_destroy(scene);

    scene = load_shared("extensions/XmpMetadataRoundedCube.glb");
    assert_non_null(strstr(scene->meta.extensions, "\"KHR_xmp_json_ld\":{\"packets\":["));
    assert_int_equal(scene->warning_count, 0);
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(variants_name_materials),           cmocka_unit_test(instances_are_read),
        cmocka_unit_test(instances_without_data_are_one),    cmocka_unit_test(image_lights_are_read),
        cmocka_unit_test(extras_are_kept_verbatim),          cmocka_unit_test(xmp_is_kept),
        cmocka_unit_test(misplaced_extensions_are_reported), cmocka_unit_test(real_models_are_read),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
