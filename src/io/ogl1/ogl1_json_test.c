/* ogl1_json_test.c - rgl's parameters as toJSON() writes them, as users write them, and malformed. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tests/support/support.h"
#include "io/ogl1/ogl1_test_support.h"

/* toJSON(list(materials = list(gold = material3d(id = id)), lights = ..), auto_unbox = TRUE) of rgl 1.0.1 */
static const char FROM_R[] =
    "{'materials':{'gold':{'color':['#FF0000','#4682B4'],'alpha':[0.498,0.498],'lit':true,"
    "'ambient':'#000000','specular':'#1A1A1A','emission':'#000000','shininess':20,'smooth':true,"
    "'front':'filled','back':'filled','size':3,'lwd':1,'fog':true,'point_antialias':false,"
    "'line_antialias':false,'texture':{},'textype':'rgb','texmipmap':false,'texminfilter':'linear',"
    "'texmagfilter':'linear','texenvmap':false,'depth_mask':true,'depth_test':'less',"
    "'isTransparent':true,'polygon_offset':[0,0],'margin':'','floating':false,'tag':'',"
    "'blend':['src_alpha','one_minus_src_alpha']}},"
    "'lights':[{'theta':0,'phi':15,'viewpoint.rel':true,'ambient':'#FFFFFF'}]}";

/* The same without auto_unbox: every value in an array. Lights as scene3d() lists them. */
static const char FROM_R_BOXED[] =
    "{'materials':[{'name':['gold'],'color':['#FF0000'],'alpha':[0.498],'lit':[true],'specular':['#1A1A1A'],"
    "'shininess':[20],'texture':{},'tag':['']}],"
    "'lights':{'5':{'id':[5],'type':['light'],'vertices':[[0,0,1]],"
    "'colors':[[1,1,1,1],[0.5,1,1,1],[0,1,0.25,1]],'viewpoint':[false],'finite':[false]},"
    "'6':{'vertices':[[1,2,3]],'finite':true,'viewpoint':true}},"
    "'background':{'fogtype':'exp2','fogscale':2,'colors':[[0.5,0.25,0.125,1]],'sphere':false}}";

static void json_of_r_is_read(void **state)
{
    (void)state;
    facet_scene *scene = ogl1_load(FROM_R);
    const legacy_material *m = &scene->legacy->materials[0];
    assert_int_equal(scene->material_count, 1);
    assert_string_equal(m->name, "gold");
    assert_string_equal(scene->materials[0].name, "gold");
    ogl1_assert_color(m->diffuse, 0xFF0000);
    ogl1_assert_color(m->specular, 0x1A1A1A);
    ogl1_assert_color(m->ambient, 0);
    assert_true(m->opacity == 0.498f);
    assert_true(m->shininess == 20.0f);
    assert_true(m->is_lit && m->is_smooth && m->has_fog && !m->is_culled);
    assert_int_equal(m->fields, LEGACY_AMBIENT | LEGACY_DIFFUSE | LEGACY_SPECULAR | LEGACY_EMISSION |
                                    LEGACY_SHININESS | LEGACY_OPACITY);
    assert_false(legacy_has_map(m, LEGACY_DIFFUSE_MAP));
    assert_null(m->maps[LEGACY_DIFFUSE_MAP].path);
    assert_string_equal(m->unknown,
                        "size 3\nlwd 1\npoint_antialias false\nline_antialias false\ndepth_mask true\n"
                        "depth_test \"less\"\nisTransparent true\npolygon_offset [0,0]\nmargin \"\"\n"
                        "floating false\ntag \"\"\nblend [\"src_alpha\",\"one_minus_src_alpha\"]");
    assert_int_equal(scene->legacy->light_count, 1);
    const legacy_light expected = legacy_light_default();
    assert_memory_equal(scene->legacy->lights[0].position, expected.position, sizeof expected.position);
    assert_true(scene->legacy->is_source && scene->legacy->is_rgl);
    assert_int_equal(scene->legacy->colors, FACET_LEGACY_COLORS_SRGB);
    assert_true(has_warning(scene, "materials.gold.color: has 2 colors"));
    assert_int_equal(scene->warning_count, 1);
    scene_destroy(scene);
}

static void boxed_values_are_read(void **state)
{
    (void)state;
    facet_scene *scene = ogl1_load(FROM_R_BOXED);
    const legacy_material *m = &scene->legacy->materials[0];
    assert_string_equal(m->name, "gold");
    ogl1_assert_color(m->diffuse, 0xFF0000);
    assert_true(m->opacity == 0.498f && m->shininess == 20.0f);
    assert_int_equal(scene->legacy->light_count, 2);
    const legacy_light *l = scene->legacy->lights;
    assert_false(l[0].is_point || l[0].is_viewpoint_relative);
    assert_true(l[0].position[2] == 1.0f && l[0].diffuse[0] == 0.5f && l[0].specular[2] == 0.25f);
    assert_true(l[1].is_point && l[1].is_viewpoint_relative);
    assert_true(l[1].position[0] == 1.0f && l[1].position[2] == 3.0f);
    assert_int_equal(scene->legacy->fog.mode, LEGACY_FOG_EXP2);
    assert_true(scene->legacy->fog.scale == 2.0f && scene->legacy->fog.color[2] == 0.125f);
    assert_int_equal(scene->warning_count, 0);
    scene_destroy(scene);
}

static void defaults_are_those_of_rgl(void **state)
{
    (void)state;
    facet_scene *scene = ogl1_load("{'materials':[{}],'material3d':null}");
    const legacy_material *m = &scene->legacy->materials[0];
    ogl1_assert_color(m->diffuse, 0xFFFFFF);
    ogl1_assert_color(m->specular, 0xFFFFFF);
    ogl1_assert_color(m->ambient, 0);
    ogl1_assert_color(m->emission, 0);
    assert_true(m->shininess == 50.0f && m->opacity == 1.0f && m->is_lit && m->is_smooth && m->has_fog);
    assert_string_equal(m->name, "material 1");
    assert_null(m->unknown);
    assert_int_equal(scene->legacy->light_count, 0);
    assert_int_equal(scene->legacy->fog.mode, LEGACY_FOG_NONE);
    assert_true(scene->legacy->fog.scale == 1.0f);
    scene_destroy(scene);
}

static void bare_parameters_are_read(void **state)
{
    (void)state;
    facet_scene *scene = ogl1_load("{'material3d':{'col':'steelblue','shininess':7}}");
    ogl1_assert_color(scene->legacy->materials[0].diffuse, 0x4682B4);
    scene_destroy(scene);
    /* toJSON(material3d()) alone, and one material in place of a list */
    scene = ogl1_load("{'color':'tomato','alpha':1,'fog':false,'size':3}");
    ogl1_assert_color(scene->legacy->materials[0].diffuse, 0xFF6347);
    assert_false(scene->legacy->materials[0].has_fog);
    assert_int_equal(scene->warning_count, 0);
    scene_destroy(scene);
    scene = ogl1_load("{'materials':{'color':'tomato','texture':{}},'lights':{'theta':90,'phi':0}}");
    assert_int_equal(scene->material_count, 1);
    ogl1_assert_color(scene->legacy->materials[0].diffuse, 0xFF6347);
    assert_int_equal(scene->legacy->light_count, 1);
    assert_near(scene->legacy->lights[0].position[0], 1.0, 1e-6);
    scene_destroy(scene);
}

static void colors_of_r_are_read(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        float r, g, b, opacity;
    } rows[] = {
        {"'#336699'", 0.2f, 0.4f, 0.6f, 1.0f},
        {"'#33669980'", 0.2f, 0.4f, 0.6f, 128.0f / 255.0f},
        {"'Dark Slate Grey 2'", 141.0f / 255.0f, 238.0f / 255.0f, 238.0f / 255.0f, 1.0f},
        {"[0.1, 0.2, 0.3]", 0.1f, 0.2f, 0.3f, 1.0f},
        {"[0, 1, 0.5, 0.25]", 0.0f, 1.0f, 0.5f, 0.25f},
        {"[[0, 1, 0.5]]", 0.0f, 1.0f, 0.5f, 1.0f},
        {"['#FF0000','#00FF00']", 1.0f, 0.0f, 0.0f, 1.0f},
        {"[[0, 1, 0], [1, 0, 0]]", 0.0f, 1.0f, 0.0f, 1.0f},
        {"2", 223.0f / 255.0f, 83.0f / 255.0f, 107.0f / 255.0f, 1.0f},
        {"'2'", 223.0f / 255.0f, 83.0f / 255.0f, 107.0f / 255.0f, 1.0f},
        {"'transparent'", 1.0f, 1.0f, 1.0f, 0.0f},
        {"'NA'", 1.0f, 1.0f, 1.0f, 1.0f},
        {"null", 1.0f, 1.0f, 1.0f, 1.0f},
        {"[3, 0.5, 0]", 3.0f, 0.5f, 0.0f, 1.0f},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char json[256];
        snprintf(json, sizeof json, "{'materials':[{'color':%s}]}", rows[i].text);
        facet_scene *scene = ogl1_load(json);
        const legacy_material *m = &scene->legacy->materials[0];
        if (m->diffuse[0] != rows[i].r || m->diffuse[1] != rows[i].g || m->diffuse[2] != rows[i].b ||
            m->opacity != rows[i].opacity)
            fail_msg("%s: %g %g %g, %g", rows[i].text, (double)m->diffuse[0], (double)m->diffuse[1],
                     (double)m->diffuse[2], (double)m->opacity);
        assert_int_equal(has_warning(scene, "above 1"), rows[i].r > 1.0f);
        scene_destroy(scene);
    }
    facet_scene *scene = ogl1_load("{'materials':[{'color':'#33669980','alpha':0.75}]}");
    assert_true(scene->legacy->materials[0].opacity == 0.75f); /* as stated */
    scene_destroy(scene);
}

static void invalid_colors_are_refused(void **state)
{
    (void)state;
    static const char *const rows[][2] = {
        {"'stealblue'", "\"stealblue\" is not a color of R"},
        {"'#12345'", "\"#12345\" is not a color"},
        {"[0.1, 0.2]", "has 2 numbers"},
        {"[1, 2, 3, 4, 5]", "has 5 numbers"},
        {"[0.1, -0.2, 0]", "[1]: -0.2 is not a component"},
        {"[0.1, 'a', 0]", "[1]: must be a number"},
        {"true", "must be a color, but is a boolean"},
        {"0.5", "must be a color, but is a number"},
        {"{'r':1}", "must be a color, but is an object"},
        {"[1e300, 0, 0]", "not a component of a color"},
        {"-3", "\"-3\" is not a color"},
        {"'a\\u0000b'", "contains a NUL character"},
        {"[[1, 0], [1, 0]]", "has 2 numbers"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char json[256];
        snprintf(json, sizeof json, "{'materials':[{},{'specular':%s}]}", rows[i][0]);
        ogl1_assert_refused(json, FACET_ERROR_INVALID, "materials[1].specular", rows[i][1]);
    }
}

static void all_parameters_are_read(void **state)
{
    (void)state;
    facet_scene *scene = ogl1_load(
        "{'colors':'linear','materials':[{'name':'a','lit':false,'smooth':0,'fog':[false],'back':'culled',"
        "'front':'lines','textype':'luminance.alpha','texmode':'decal','texenvmap':true,'emission':'gray20',"
        "'ambient':[0.25,0.5,1],'shininess':128,'foo':{'bar':[1,2.5,'x']},'two words':1,"
        "'mtl':{'illum':2,'Ni':1.45,'Tf':[1,0.5,0.25],'Pr':0.3,'anisor':0.125}}]}");
    const legacy_material *m = &scene->legacy->materials[0];
    assert_false(m->is_lit || m->is_smooth || m->has_fog);
    assert_true(m->is_culled && m->has_environment_map);
    assert_int_equal(m->texture_type, LEGACY_LUMINANCE_ALPHA);
    assert_int_equal(m->texture_mode, LEGACY_DECAL);
    ogl1_assert_color(m->emission, 0x333333);
    assert_true(m->ambient[0] == 0.25f && m->ambient[2] == 1.0f && m->shininess == 128.0f);
    assert_string_equal(m->unknown, "foo {\"bar\":[1,2.5,\"x\"]}\nfront \"lines\"");
    assert_string_equal(m->kept, "front \"lines\"");
    assert_true(legacy_has(m, LEGACY_ILLUM | LEGACY_IOR | LEGACY_TRANSMISSION_FILTER | LEGACY_ROUGHNESS |
                                  LEGACY_ANISOTROPY_ROTATION));
    assert_false(legacy_has(m, LEGACY_METALLIC));
    assert_true(m->illum == 2 && m->ior == 1.45f && m->transmission_filter[1] == 0.5f &&
                m->roughness == 0.3f && m->anisotropy_rotation == 0.125f);
    assert_true(has_warning(scene, "\"foo\" is not a parameter of material3d(); it is kept"));
    assert_true(has_warning(scene, "\"two words\" is not a parameter of material3d(); it is dropped"));
    assert_int_equal(scene->warning_count, 2);
    assert_int_equal(scene->legacy->colors, FACET_LEGACY_COLORS_LINEAR);
    scene_destroy(scene);
}

static void values_out_of_range_are_clamped(void **state)
{
    (void)state;
    facet_scene *scene =
        ogl1_load("{'materials':[{'alpha':1.5,'shininess':-2},{'shininess':1e300},{'alpha':-1}]}");
    const legacy_material *m = scene->legacy->materials;
    assert_true(m[0].opacity == 1.0f && m[0].shininess == 0.0f && m[1].shininess == 1e6f &&
                m[2].opacity == 0.0f);
    assert_true(has_warning(scene, "materials[0].alpha: 1.5 is out of range; 1 is used"));
    assert_true(has_warning(scene, "materials[0].shininess: -2 is out of range; 0 is used"));
    scene_destroy(scene);
}

static void unknown_parameters_are_reported_once(void **state)
{
    (void)state;
    facet_scene *scene =
        ogl1_load("{'materials':[{'foo':1},{'foo':2},{'foo':[]}],'lights':[{'baz':1},{'baz':2}],"
                  "'extra':1}");
    assert_string_equal(scene->legacy->materials[1].unknown, "foo 2");
    assert_null(scene->legacy->materials[1].kept);
    assert_null(scene->legacy->materials[2].unknown);
    assert_int_equal(scene->warning_count, 3);
    assert_true(has_warning(scene, "\"foo\""));
    assert_true(has_warning(scene, "\"baz\" is not a parameter of light3d(); it is dropped"));
    assert_true(has_warning(scene, "\"extra\" has no meaning here"));
    scene_destroy(scene);
}

static void lights_are_read(void **state)
{
    (void)state;
    facet_scene *scene = ogl1_load("{'materials':[{}],'lights':["
                                   "{'theta':30,'phi':40,'viewpoint_rel':false,'diffuse':'red'},"
                                   "{'x':1,'y':2,'z':3},{'x':[4,5,6]},{'theta':750,'phi':40},"
                                   "{'direction':[0,3,4]},{'x':{},'y':null,'theta':0,'phi':90}]}");
    const legacy_light *l = scene->legacy->lights;
    assert_int_equal(scene->legacy->light_count, 6);
    /* rgl 1.0.1: light3d(30, 40); rgl.attrib(id, "vertices") */
    assert_near(l[0].position[0], 0.3830222, 1e-6);
    assert_near(l[0].position[1], 0.6427876, 1e-6);
    assert_near(l[0].position[2], 0.6634139, 1e-6);
    assert_false(l[0].is_viewpoint_relative);
    ogl1_assert_color(l[0].diffuse, 0xFF0000);
    ogl1_assert_color(l[0].specular, 0xFFFFFF);
    assert_true(l[1].is_point && l[1].is_viewpoint_relative && l[1].position[1] == 2.0f);
    assert_true(l[2].is_point && l[2].position[0] == 4.0f && l[2].position[2] == 6.0f);
    assert_memory_equal(l[3].position, l[0].position, sizeof l[0].position);
    assert_true(!l[4].is_point && l[4].position[1] == 0.6f && l[4].position[2] == 0.8f);
    assert_true(!l[5].is_point && l[5].position[1] == 1.0f);
    scene_destroy(scene);
    scene = ogl1_load("{'materials':[{}],'lights':[]}");
    assert_true(has_warning(scene, "lights: is empty"));
    scene_destroy(scene);
    scene = ogl1_load("{'materials':[{}],'lights':[{},{},{},{},{},{},{},{},{}]}");
    assert_int_equal(scene->legacy->light_count, 9);
    assert_true(has_warning(scene, "OpenGL 1 supports 8"));
    scene_destroy(scene);
}

static void fog_is_read(void **state)
{
    (void)state;
    facet_scene *scene =
        ogl1_load("{'materials':[{}],'background':{'color':'gray90','fogtype':'linear','lit':false},"
                  "'fog':{'fogtype':'exp','fogScale':0.5}}");
    assert_int_equal(scene->legacy->fog.mode, LEGACY_FOG_EXP);
    assert_true(scene->legacy->fog.scale == 0.5f);
    ogl1_assert_color(scene->legacy->fog.color, 0xE5E5E5);
    scene_destroy(scene);
    ogl1_assert_refused("{'materials':[{}],'fog':{'fogtype':'thick'}}", FACET_ERROR_INVALID, "fog.fogtype",
                        "\"thick\" is not one of none, linear, exp, exp2");
}

static void invalid_documents_are_refused(void **state)
{
    (void)state;
    static const struct {
        const char *json, *place, *what;
    } rows[] = {
        {"", "is not valid JSON", ""},
        {"[]", "must be a JSON object", ""},
        {"{'materials':[{'shininess':NaN}]}", "is not valid JSON", "line 1"},
        {"{'materials':[{'shininess':1e999}]}", "is not valid JSON", "overflow"},
        {"{'materials':[]}", "nothing to show", ""},
        {"{'lights':[{}]}", "nothing to show", ""},
        {"{'materials':7}", "materials: ", "must be an array of objects, but is a number"},
        {"{'materials':[7]}", "materials[0]: ", "must be an object, but is a number"},
        {"{'materials':{'a':7}}", "materials.a: ", "must be an object"},
        {"{'materials':[{'shininess':'shiny'}]}",
         "materials[0].shininess: ", "must be a number, but is a string"},
        {"{'materials':[{'lit':'yes'}]}", "materials[0].lit: ", "must be a boolean"},
        {"{'materials':[{'lit':2}]}", "materials[0].lit: ", "must be a boolean"},
        {"{'materials':[{'name':7}]}", "materials[0].name: ", "must be a string"},
        {"{'materials':[{'objects':['a',7]}]}", "materials[0].objects[1]: ", "must be a string"},
        {"{'materials':[{'textype':'cmyk'}]}", "materials[0].textype: ", "luminance.alpha"},
        {"{'materials':[{'texture':1}]}", "materials[0].texture: ", "must be a string"},
        {"{'materials':[{'mtl':7}]}", "materials[0].mtl: ", "must be an object"},
        {"{'material3d':[1]}", "material3d: ", "must be an object"},
        {"{'materials':[{}],'lights':3}", "lights: ", "must be an array of objects"},
        {"{'materials':[{}],'lights':[3]}", "lights[0]: ", "must be an object"},
        {"{'materials':[{}],'lights':[{'x':1,'y':2}]}", "lights[0].z: ", "is missing"},
        {"{'materials':[{}],'lights':[{'x':[1,2]}]}", "lights[0].x: ", "three numbers"},
        {"{'materials':[{}],'lights':[{'direction':[0,0,0]}]}", "lights[0].direction: ", "not a direction"},
        {"{'materials':[{}],'lights':[{'vertices':[[1e30,0,0]]}]}", "lights[0].vertices[0]: ", "too far out"},
        {"{'materials':[{}],'lights':[{'colors':[[1,1,1]]}]}", "lights[0].colors: ", "three rows"},
        {"{'materials':[{}],'fog':7}", "fog: ", "must be an object"},
        {"{'materials':[{}],'colors':'cmyk'}", "colors: ", "srgb, linear"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        ogl1_assert_refused(rows[i].json, FACET_ERROR_INVALID, rows[i].place, rows[i].what);
    ogl1_assert_refused("{'facet':'scene','materials':[{}]}", FACET_ERROR_UNSUPPORTED,
                        "facet: ", "\"scene\"");
    ogl1_assert_refused("{'version':2,'materials':[{}]}", FACET_ERROR_UNSUPPORTED,
                        "version: ", "2 is not supported");
}

static void hostile_sizes_are_refused(void **state)
{
    (void)state;
    size_t size = 4 * 20000 + 64;
    char *json = malloc(size);
    assert_non_null(json);
    strcpy(json, "{'materials':[{}");
    for (size_t i = 0, at = strlen(json); i < 20000; i++, at += 3)
        strcpy(json + at, ",{}");
    strcat(json, "]}");
    ogl1_assert_refused(json, FACET_ERROR_LIMIT, "materials: ", "20001 materials");
    strcpy(json, "{'materials':[{}],'lights':[{}");
    for (size_t i = 0, at = strlen(json); i < 2000; i++, at += 3)
        strcpy(json + at, ",{}");
    strcat(json, "]}");
    ogl1_assert_refused(json, FACET_ERROR_LIMIT, "lights: ", "2001 lights");
    /* Deeper than the parser goes, and as deep as it goes. */
    strcpy(json, "{'materials':[{'foo':");
    size_t begin = strlen(json);
    memset(json + begin, '[', 30000);
    json[begin + 30000] = 0;
    ogl1_assert_refused(json, FACET_ERROR_INVALID, "is not valid JSON", "depth");
    memset(json + begin, '[', 2000);
    memset(json + begin + 2000, ']', 2000);
    strcpy(json + begin + 4000, "}]}");
    scene_destroy(ogl1_load(json));
    free(json);
}

static void documents_are_detected(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        bool is_ours;
    } rows[] = {
        {"{\"materials\":[]}", true},
        {" \n{ \"x\" : {\"asset\":\"}\\\"\"} , \"material3d\" : {} }", true},
        {"\xef\xbb\xbf{\"facet\":\"ogl1\",\"lights\":[]}", true},
        {"{\"materials\":[],\"asset\":{\"version\":\"2.0\"}}", false},
        {"{\"asset\":{},\"materials\":[]}", false},
        {"{\"materials\":[],\"meshes\":[]}", false},
        {"{\"x\":{\"materials\":[]}}", false},
        {"{\"x\":\"materials\"}", false},
        {"{\"materials", false},
        {"{\"materials\"", true}, /* broken, but ours: the message should speak of it */
        {"[\"materials\"]", false},
        {"", false},
        {"{", false},
        {"{\"", false},
        {"v 1 2 3\n", false},
        {"glTF", false},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        if (ogl1_json_detect(rows[i].text, strlen(rows[i].text)) != rows[i].is_ours)
            fail_msg("%s", rows[i].text);
}

static void materials_are_shown_on_balls(void **state)
{
    (void)state;
    facet_scene *scene =
        ogl1_load("{'generator':'me','materials':[{'name':'a'},{'name':'b'},{'objects':['x','y']},"
                  "{},{'name':'e'}]}");
    assert_int_equal(scene->node_count, 5);
    assert_int_equal(scene->scenes[0].node_count, 5);
    assert_string_equal(scene->generator, "me");
    assert_string_equal(scene->nodes[2].name, "x");
    assert_string_equal(scene->nodes[3].name, "material 4");
    /* 3 columns, 2 rows, in the middle of nothing */
    assert_true(scene->nodes[0].translation[0] == -2.5 && scene->nodes[0].translation[1] == 1.25);
    assert_true(scene->nodes[4].translation[0] == 0.0 && scene->nodes[4].translation[1] == -1.25);
    for (uint32_t i = 0; i < 5; i++) {
        const scene_primitive *p = &scene->meshes[scene->nodes[i].mesh].primitives[0];
        assert_int_equal(p->material, i);
        assert_true(p->texcoord_count == 1 && p->normals && p->index_count == 3 * 64 * 31 * 2);
    }
    scene_pose pose;
    assert_int_equal(scene_pose_create(scene, NULL, NULL, 1, &pose, NULL), FACET_OK);
    assert_int_equal(pose.instance_count, 5);
    assert_near(pose.bounds_max[0], 3.5, 1e-6);
    assert_near(pose.bounds_max[1], 2.25, 1e-6);
    scene_pose_destroy(&pose);
    scene_destroy(scene);
}

static void textures_are_found(void **state)
{
    const temporary_folder *f = *state;
    facet_error error = {0};
    facet_scene *scene = NULL;
    temporary_folder_put_png(f, "a.png");
    temporary_folder_put(f, "b.png", "8BPS\0\1", 6);
    const char *path = ogl1_write_json(
        f, "p.json",
        "{'materials':[{'texture':'a.png','texmipmap':true,'texminfilter':'nearest.mipmap.linear'},"
        "{'texture':['a.png']},{'texture':'/somewhere/else/a.png','texmagfilter':'nearest'},"
        "{'texture':'C:\\\\Users\\\\me\\\\a.png'},{'texture':'b.png'},{'texture':'gone.png'},{'texture':''},"
        "{'texture':'../../etc/passwd'}]}");
    assert_int_equal(ogl1_json_load(path, NULL, &scene, &error), FACET_OK);
    const legacy_material *m = scene->legacy->materials;
    assert_int_equal(scene->image_count, 1);
    assert_int_equal(scene->images[0].width, 1);
    assert_string_equal(scene->images[0].mime_type, "image/png");
    assert_int_equal(scene->texture_count, 3);
    uint32_t kept = 0;
    for (uint32_t i = 0; i < scene->file_count; i++)
        kept += scene->files[i].data != NULL;
    assert_int_equal(kept, 2); /* a.png and b.png, however often they are named */
    assert_int_equal(m[0].maps[LEGACY_DIFFUSE_MAP].ref.texture, 0);
    assert_int_equal(scene->textures[0].min_filter, SCENE_FILTER_NEAREST);
    assert_int_equal(scene->textures[0].mip_filter, SCENE_MIP_LINEAR);
    assert_int_equal(m[1].maps[LEGACY_DIFFUSE_MAP].ref.texture, 1);
    assert_int_equal(scene->textures[1].mip_filter, SCENE_MIP_NONE);
    assert_int_equal(m[2].maps[LEGACY_DIFFUSE_MAP].ref.texture, 2);
    assert_int_equal(scene->textures[2].mag_filter, SCENE_FILTER_NEAREST);
    assert_int_equal(m[3].maps[LEGACY_DIFFUSE_MAP].ref.texture, 1);
    for (int i = 4; i < 8; i++)
        assert_false(legacy_has_map(&m[i], LEGACY_DIFFUSE_MAP));
    assert_string_equal(m[5].maps[LEGACY_DIFFUSE_MAP].path, "gone.png");
    assert_null(m[6].maps[LEGACY_DIFFUSE_MAP].path);
    assert_true(has_warning(scene, "texture \"b.png\": is a PSD file"));
    assert_true(has_warning(scene, "texture \"gone.png\": there is no file"));
    assert_true(has_warning(scene, "texture \"../../etc/passwd\": "));
    scene_destroy(scene);
    assert_int_equal(ogl1_json_load(temporary_folder_file(f, "none.json"), NULL, &scene, &error),
                     FACET_ERROR_READ);
}

/* Every allocation fails once. */
static void failed_allocations_are_reported(void **state)
{
    const temporary_folder *f = *state;
    temporary_folder_put_png(f, "a.png");
    const char *path =
        ogl1_write_json(f, "p.json",
                        "{'generator':'g','materials':[{'name':'a','objects':['x'],'texture':'a.png',"
                        "'size':3,'foo':1},{'texture':'a.png','texmagfilter':'nearest'},{}],"
                        "'lights':[{}],'fog':{}}");
    facet_result result = FACET_ERROR_MEMORY;
    failing_allocator failing = {.fail_at = 0};
    for (; failing.fail_at < 1000; failing.fail_at++) {
        facet_scene_desc desc = {.allocator = failing_allocator_get(&failing)};
        facet_scene *scene = NULL;
        facet_error error = {0};
        failing.calls = 0;
        result = ogl1_json_load(path, &desc, &scene, &error);
        assert_int_equal(scene != NULL, result == FACET_OK);
        scene_destroy(scene);
        assert_int_equal(failing.blocks, 0);
        if (failing.calls <= failing.fail_at) /* it was not reached */
            break;
        if (result != FACET_OK) /* a warning may be lost for lack of memory, nothing else */
            assert_int_equal(result, FACET_ERROR_MEMORY);
    }
    assert_int_equal(result, FACET_OK);
    assert_in_range(failing.fail_at, 10, 999);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(json_of_r_is_read),
        cmocka_unit_test(boxed_values_are_read),
        cmocka_unit_test(defaults_are_those_of_rgl),
        cmocka_unit_test(bare_parameters_are_read),
        cmocka_unit_test(colors_of_r_are_read),
        cmocka_unit_test(invalid_colors_are_refused),
        cmocka_unit_test(all_parameters_are_read),
        cmocka_unit_test(values_out_of_range_are_clamped),
        cmocka_unit_test(unknown_parameters_are_reported_once),
        cmocka_unit_test(lights_are_read),
        cmocka_unit_test(fog_is_read),
        cmocka_unit_test(invalid_documents_are_refused),
        cmocka_unit_test(hostile_sizes_are_refused),
        cmocka_unit_test(documents_are_detected),
        cmocka_unit_test(materials_are_shown_on_balls),
        cmocka_unit_test_setup_teardown(textures_are_found, ogl1_folder_create, ogl1_folder_remove),
        cmocka_unit_test_setup_teardown(failed_allocations_are_reported, ogl1_folder_create,
                                        ogl1_folder_remove),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
