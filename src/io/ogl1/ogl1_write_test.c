/* ogl1_write_test.c - written documents read back equal, and have a form that R accepts. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <jansson.h>

#include "tests/support/support.h"
#include "io/ogl1/ogl1_test_support.h"

static char *write(const facet_scene *scene)
{
    text t = {0};
    ogl1_json_write(scene, "test", NULL, &t);
    assert_false(t.has_failed);
    return t.data;
}

static facet_scene *read_back(const char *json)
{
    facet_scene *scene = NULL;
    facet_error error = {0};
    assert_true(ogl1_json_detect(json, strlen(json)));
    if (ogl1_json_load_memory(json, strlen(json), "back.json", NULL, &scene, &error) != FACET_OK)
        fail_msg("%s", error.message);
    assert_int_equal(scene->warning_count, 0);
    return scene;
}

static void assert_string_or_null_equal(const char *a, const char *b)
{
    assert_int_equal(a == NULL, b == NULL);
    if (a)
        assert_string_equal(a, b);
}

/* All members except pointers, bit by bit. */
static void assert_materials_equal(const legacy_material *a, const legacy_material *b)
{
    legacy_material x = *a;
    legacy_material y = *b;
    assert_string_equal(a->name, b->name);
    assert_int_equal(a->fields, b->fields);
    assert_memory_equal(a->ambient, b->ambient, sizeof a->ambient);
    assert_memory_equal(a->diffuse, b->diffuse, sizeof a->diffuse);
    assert_memory_equal(a->specular, b->specular, sizeof a->specular);
    assert_memory_equal(a->emission, b->emission, sizeof a->emission);
    assert_memory_equal(a->transmission_filter, b->transmission_filter, sizeof a->transmission_filter);
    const float numbers[2][12] = {
        {x.shininess, x.opacity, x.ior, x.sharpness, x.roughness, x.metallic, x.sheen, x.clearcoat,
         x.clearcoat_roughness, x.anisotropy, x.anisotropy_rotation, (float)x.illum},
        {y.shininess, y.opacity, y.ior, y.sharpness, y.roughness, y.metallic, y.sheen, y.clearcoat,
         y.clearcoat_roughness, y.anisotropy, y.anisotropy_rotation, (float)y.illum}};
    assert_memory_equal(numbers[0], numbers[1], sizeof numbers[0]);
    assert_true(x.is_lit == y.is_lit && x.is_smooth == y.is_smooth && x.has_fog == y.has_fog &&
                x.is_culled == y.is_culled && x.has_environment_map == y.has_environment_map);
    assert_int_equal(x.texture_type, y.texture_type);
    assert_int_equal(x.texture_mode, y.texture_mode);
    assert_int_equal(legacy_has_map(a, LEGACY_DIFFUSE_MAP), legacy_has_map(b, LEGACY_DIFFUSE_MAP));
    assert_string_or_null_equal(x.unknown, y.unknown);
}

static void assert_legacy_equal(const facet_scene *a, const facet_scene *b)
{
    assert_int_equal(a->material_count, b->material_count);
    for (uint32_t i = 0; i < a->material_count; i++)
        assert_materials_equal(&a->legacy->materials[i], &b->legacy->materials[i]);
    assert_int_equal(a->legacy->light_count, b->legacy->light_count);
    for (uint32_t i = 0; i < a->legacy->light_count; i++) {
        const legacy_light *x = &a->legacy->lights[i];
        const legacy_light *y = &b->legacy->lights[i];
        assert_true(x->is_point == y->is_point && x->is_viewpoint_relative == y->is_viewpoint_relative);
        assert_memory_equal(x->position, y->position, sizeof x->position);
        assert_memory_equal(x->ambient, y->ambient, sizeof x->ambient);
        assert_memory_equal(x->diffuse, y->diffuse, sizeof x->diffuse);
        assert_memory_equal(x->specular, y->specular, sizeof x->specular);
    }
    assert_int_equal(a->legacy->fog.mode, b->legacy->fog.mode);
    assert_true(a->legacy->fog.scale == b->legacy->fog.scale);
    assert_memory_equal(a->legacy->fog.color, b->legacy->fog.color, sizeof a->legacy->fog.color);
    assert_int_equal(a->legacy->colors, b->legacy->colors);
}

static const char DOCUMENT[] =
    "{'colors':'linear','materials':[{'name':'a "
    "\\u00fc\\n','color':'steelblue','alpha':0.1,'specular':[0.1,0.2,0.3],"
    "'shininess':1e-7,'emission':[3.5,0,0]},"
    "{'name':'b','lit':false,'smooth':false,'fog':false,'back':'culled','textype':'alpha','texmode':'blend',"
    "'texenvmap':true,'size':2.5,'polygon_offset':[1,0.1],'tag':'a \\\"b\\\"','foo':{'x':[null,1]}},"
    "{'name':'c','front':'lines','back':'points','texture':'gone.png',"
    "'mtl':{'illum':7,'Tf':[0.5,0.25,1],'Ni':1.45,'sharpness':3,'Pr':0.1,'Pm':0.2,'Ps':0.3,'Pc':0.4,'Pcr':0."
    "5,"
    "'aniso':-0.0,'anisor':0.7}},{'name':'d','front':'culled'}],"
    "'lights':[{},{'theta':30,'phi':40},{'theta':-123.4,'phi':5e-3},{'direction':[1,2,3],'ambient':'gray10'},"
    "{'x':0.1,'y':-2,'z':1e9,'viewpoint.rel':false,'specular':[0.3,0.3,2]},{'theta':0,'phi':90}],"
    "'fog':{'fogtype':'exp2','fogScale':0.7,'color':'gray90'}}";

static void all_parameters_round_trip(void **state)
{
    (void)state;
    facet_scene *scene = ogl1_load(DOCUMENT);
    char *json = write(scene);
    facet_scene *back = NULL;
    facet_error error;
    assert_int_equal(ogl1_json_load_memory(json, strlen(json), "back.json", NULL, &back, &error), FACET_OK);
    assert_legacy_equal(scene, back);
    char *again = write(back);
    assert_string_equal(json, again);
    mem_free(json);
    mem_free(again);
    scene_destroy(scene);
    scene_destroy(back);
}

/* Colors that MTL and extras may state round-trip, up to the largest that is read. */
static void bright_colors_round_trip(void **state)
{
    (void)state;
    facet_scene *scene = ogl1_load("{'materials':[{'color':'red'}]}");
    legacy_material *m = (legacy_material *)scene->legacy->materials;
    m->fields |= LEGACY_EMISSION | LEGACY_SPECULAR;
    for (int i = 0; i < 3; i++) {
        m->emission[i] = i ? LEGACY_LARGEST : 2e6f;
        m->specular[i] = LEGACY_LARGEST;
    }
    char *json = write(scene);
    facet_scene *back = NULL;
    facet_error error = {0};
    if (ogl1_json_load_memory(json, strlen(json), "back.json", NULL, &back, &error) != FACET_OK)
        fail_msg("%s", error.message);
    assert_memory_equal(back->legacy->materials[0].emission, m->emission, sizeof m->emission);
    assert_memory_equal(back->legacy->materials[0].specular, m->specular, sizeof m->specular);
    mem_free(json);
    scene_destroy(back);
    scene_destroy(scene);
}

static void random_directions_round_trip(void **state)
{
    (void)state;
    facet_scene *scene = ogl1_load("{'materials':[{'name':'a'}],'lights':[{}]}");
    uint32_t seed = 1;
    for (int i = 0; i < 300; i++) {
        double v[3];
        double length = 0.0;
        for (int k = 0; k < 3; k++) {
            lcg_next(&seed);
            v[k] = (double)(seed >> 8) / (double)(1 << 23) - 1.0;
            length += v[k] * v[k];
        }
        for (int k = 0; k < 3; k++)
            scene->legacy->lights[0].position[k] = (float)(v[k] / sqrt(length));
        char *json = write(scene);
        facet_scene *back = read_back(json);
        assert_legacy_equal(scene, back);
        mem_free(json);
        scene_destroy(back);
    }
    scene_destroy(scene);
}

/* As R reads it: names of material3d() and light3d(), colors that are strings wherever 8 bits hold them. */
static void the_json_has_the_names_of_r(void **state)
{
    (void)state;
    facet_scene *scene =
        ogl1_load("{'materials':[{'name':'a','color':'steelblue','specular':[0.1,0.2,0.3],'size':2}],"
                  "'lights':[{'theta':30,'phi':40,'specular':'gray30'}],"
                  "'background':{'fogtype':'linear','color':'white'}}");
    char *json = write(scene);
    json_t *root = json_loads(json, 0, NULL);
    assert_non_null(root);
    const json_t *m = json_array_get(json_object_get(root, "materials"), 0);
    const json_t *l = json_array_get(json_object_get(root, "lights"), 0);
    const json_t *b = json_object_get(root, "background");
    assert_string_equal(json_string_value(json_object_get(root, "facet")), "ogl1");
    assert_string_equal(json_string_value(json_object_get(root, "generator")), "test");
    assert_string_equal(json_string_value(json_object_get(root, "colors")), "srgb");
    assert_string_equal(json_string_value(json_object_get(m, "color")), "#4682B4");
    assert_int_equal(json_array_size(json_object_get(m, "specular")), 3);
    assert_true(json_is_true(json_object_get(m, "lit")));
    assert_string_equal(json_string_value(json_object_get(m, "front")), "filled");
    assert_int_equal(json_integer_value(json_object_get(m, "size")), 2);
    assert_null(json_object_get(m, "texture"));
    assert_true(json_number_value(json_object_get(l, "theta")) == 30.0);
    assert_true(json_number_value(json_object_get(l, "phi")) == 40.0);
    assert_null(json_object_get(l, "direction"));
    assert_true(json_is_true(json_object_get(l, "viewpoint.rel")));
    assert_string_equal(json_string_value(json_object_get(l, "specular")), "#4D4D4D");
    assert_string_equal(json_string_value(json_object_get(b, "fogtype")), "linear");
    assert_string_equal(json_string_value(json_object_get(b, "color")), "#FFFFFF");
    json_decref(root);
    mem_free(json);
    scene_destroy(scene);
}

/* Unknown statements of an MTL file may be any text, even the names of parameters. */
static void unknown_statements_of_mtl_round_trip(void **state)
{
    (void)state;
    facet_scene *scene = ogl1_load("{'materials':[{'name':'a'}]}");
    scene->legacy->materials[0].unknown =
        "Pe 0.20\nmap_aat on\nlonely\n\nodd \"open\nPe 3\ncolor 1 0 0\ntwo  blanks\nNaN nan\nshininess 7";
    char *json = write(scene);
    facet_scene *back = NULL;
    facet_error error;
    assert_int_equal(ogl1_json_load_memory(json, strlen(json), "back.json", NULL, &back, &error), FACET_OK);
    const legacy_material *m = &back->legacy->materials[0];
    assert_string_equal(
        m->unknown, "Pe 0.2\nmap_aat \"on\"\nlonely \"\"\nodd \"\\\"open\"\ntwo \" blanks\"\nNaN \"nan\"");
    ogl1_assert_color(m->diffuse, 0xFFFFFF);
    assert_true(m->shininess == 50.0f);
    mem_free(json);
    scene_destroy(scene);
    scene_destroy(back);
}

/* An object is named only where its name alone says its material. */
static void objects_are_named_where_names_are_ambiguous(void **state)
{
    (void)state;
    facet_scene *scene = ogl1_load("{'materials':[{'name':'a'},{'name':'b'},{'name':'c'},{'name':'d'},{}]}");
    scene->nodes[1].name = "";       /* its mesh is called b */
    scene->nodes[3].name = "c";      /* as that of another material */
    scene->nodes[4].child_count = 1; /* its descendants would get it, too */
    scene->legacy->materials[4].name = "";
    char *json = write(scene);
    facet_scene *back = NULL;
    json_t *root = json_loads(json, 0, NULL);
    const json_t *materials = json_object_get(root, "materials");
    const char *const expected[] = {"a", "b", NULL, NULL, NULL};
    for (size_t i = 0; i < 5; i++) {
        const json_t *objects = json_object_get(json_array_get(materials, i), "objects");
        assert_int_equal(json_array_size(objects), expected[i] != NULL);
        if (expected[i])
            assert_string_equal(json_string_value(json_array_get(objects, 0)), expected[i]);
    }
    /* An entry with neither would apply to all. */
    assert_string_equal(json_string_value(json_object_get(json_array_get(materials, 4), "name")),
                        "material 5");
    json_decref(root);
    mem_free(json);
    scene_destroy(scene);
    scene_destroy(back);
}

static void count_warnings(void *user, facet_log_level level, const char *message)
{
    (void)level;
    *(int *)user += strstr(message, "rgl ") != NULL;
}

static void images_are_saved_beside(void **state)
{
    const temporary_folder *f = *state;
    facet_error error = {0};
    facet_scene *scene = NULL;
    facet_scene *back = NULL;
    int warnings = 0;
    const facet_scene_save_desc desc = {.log = {.user = &warnings, .message = count_warnings}};
    temporary_folder_put_png(f, "a.png");
    const char *in = ogl1_write_json(f, "in.json",
                                     "{'materials':[{'name':'x','texture':'a.png','texmipmap':true,"
                                     "'texminfilter':'linear.mipmap.nearest','texmagfilter':'nearest',"
                                     "'texenvmap':true},{'name':'y'},{'name':'z','texture':'gone.png'}]}");
    assert_int_equal(ogl1_json_load(in, NULL, &scene, &error), FACET_OK);
    const char *out = temporary_folder_file(f, "out.json");
    assert_int_equal(ogl1_json_save(scene, out, "test", &desc, &error), FACET_OK);
    assert_int_equal(warnings, 0);
    assert_int_equal(ogl1_json_load(out, NULL, &back, &error), FACET_OK);
    assert_legacy_equal(scene, back);
    assert_string_equal(back->images[0].uri, "out_image0.png");
    assert_int_equal(back->images[0].size, scene->images[0].size);
    assert_memory_equal(back->images[0].bytes, scene->images[0].bytes, back->images[0].size);
    assert_int_equal(back->textures[0].mip_filter, SCENE_MIP_NEAREST);
    assert_int_equal(back->textures[0].min_filter, SCENE_FILTER_LINEAR);
    assert_int_equal(back->textures[0].mag_filter, SCENE_FILTER_NEAREST);
    assert_string_equal(back->legacy->materials[2].maps[LEGACY_DIFFUSE_MAP].path, "gone.png");
    scene_destroy(back);

    /* Values without a counterpart in rgl are reported. */
    scene->legacy->materials[0].maps[LEGACY_SPECULAR_MAP].ref.texture = 0;
    scene->legacy->materials[0].maps[LEGACY_DIFFUSE_MAP].gain = 0.5f;
    assert_int_equal(ogl1_json_save(scene, out, "test", &desc, &error), FACET_OK);
    assert_int_equal(warnings, 2);

    /* The document cannot be written. */
    assert_int_equal(ogl1_json_save(scene, temporary_folder_file(f, "no/out.json"), "test", &desc, &error),
                     FACET_ERROR_WRITE);
    scene_destroy(scene);
}

static void failed_allocations_are_reported(void **state)
{
    const temporary_folder *f = *state;
    facet_error error = {0};
    facet_scene *scene = NULL;
    temporary_folder_put_png(f, "a.png");
    const char *in =
        ogl1_write_json(f, "in.json", "{'materials':[{'name':'x','texture':'a.png','foo':1}],'lights':[{}]}");
    assert_int_equal(ogl1_json_load(in, NULL, &scene, &error), FACET_OK);
    failing_allocator failing = {.fail_at = 0};
    facet_result result = FACET_ERROR_MEMORY;
    for (; failing.fail_at < 1000; failing.fail_at++) {
        const facet_scene_save_desc desc = {.allocator = failing_allocator_get(&failing)};
        failing.calls = 0;
        result = ogl1_json_save(scene, temporary_folder_file(f, "out.json"), "test", &desc, &error);
        assert_int_equal(failing.blocks, 0);
        if (failing.calls <= failing.fail_at)
            break;
        assert_int_equal(result, FACET_ERROR_MEMORY);
    }
    assert_int_equal(result, FACET_OK);
    assert_in_range(failing.fail_at, 5, 999);
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_parameters_round_trip),
        cmocka_unit_test(bright_colors_round_trip),
        cmocka_unit_test(random_directions_round_trip),
        cmocka_unit_test(the_json_has_the_names_of_r),
        cmocka_unit_test(unknown_statements_of_mtl_round_trip),
        cmocka_unit_test(objects_are_named_where_names_are_ambiguous),
        cmocka_unit_test_setup_teardown(images_are_saved_beside, ogl1_folder_create, ogl1_folder_remove),
        cmocka_unit_test_setup_teardown(failed_allocations_are_reported, ogl1_folder_create,
                                        ogl1_folder_remove),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
