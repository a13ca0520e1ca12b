/* usdz_test.c - the archive's layout, and what its usda says of a scene. */
#include "io/usd/usd.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "io/gltf/gltf_test_support.h"
#include "io/usd/usdz_zip.h"

static temporary_folder folder;

static int make_folder(void **state)
{
    (void)state;
    temporary_folder_create(&folder);
    return 0;
}

static int remove_folder(void **state)
{
    (void)state;
    temporary_folder_remove(&folder);
    return 0;
}

static uint32_t load_u32(const unsigned char *p)
{
    return p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
}

static uint32_t load_u16(const unsigned char *p)
{
    return (uint32_t)(p[0] | p[1] << 8);
}

/* Every file is stored, begins at a multiple of 64, and is where the directory says. */
static void files_are_stored_and_aligned(void **state)
{
    (void)state;
    usdz_zip zip = {0};
    const char *names[] = {"model.usda", "textures/image0.png", "a"};
    const char *contents[] = {"123456789", "", "x"};
    for (size_t i = 0; i < 3; i++)
        usdz_zip_add(&zip, names[i], contents[i], strlen(contents[i]));
    const uint32_t directory_begin = (uint32_t)zip.files.length,
                   directory_size = (uint32_t)zip.directory.length;
    assert_true(usdz_zip_finish(&zip));
    const unsigned char *bytes = (const unsigned char *)zip.files.data;
    const unsigned char *end = bytes + zip.files.length - 22;
    assert_int_equal(load_u32(end), 0x06054b50);
    assert_int_equal(load_u16(end + 10), 3);
    assert_int_equal(load_u32(end + 12), directory_size);
    assert_int_equal(load_u32(end + 16), directory_begin);
    const unsigned char *entry = bytes + directory_begin;
    for (size_t i = 0; i < 3; i++) {
        const unsigned char *local = bytes + load_u32(entry + 42);
        const uint32_t name_size = load_u16(local + 26), extra = load_u16(local + 28);
        const unsigned char *data = local + 30 + name_size + extra;
        assert_int_equal(load_u32(entry), 0x02014b50);
        assert_int_equal(load_u32(local), 0x04034b50);
        assert_int_equal(load_u16(local + 8), 0); /* stored */
        assert_memory_equal(local + 30, names[i], name_size);
        assert_int_equal((data - bytes) % 64, 0);
        assert_int_equal(load_u32(local + 18), strlen(contents[i]));
        assert_memory_equal(data, contents[i], strlen(contents[i]));
        /* the check value of CRC-32 for these digits */
        if (i == 0)
            assert_int_equal(load_u32(local + 14), 0xcbf43926);
        entry += 46 + load_u16(entry + 28);
    }
    assert_ptr_equal(entry, end);
    text_destroy(&zip.files);
    text_destroy(&zip.directory);
}

/* Saves a scene; the usda of model.usda, to be freed. */
static char *save(const facet_scene *scene)
{
    const char *path = temporary_folder_file(&folder, "a.usdz");
    facet_error error;
    if (usdz_save(scene, path, "a test", NULL, &error) != FACET_OK)
        fail_msg("%s", error.message);
    file_bytes file;
    assert_int_equal(file_open(path, 0, NULL, &file, NULL), FACET_OK);
    const uint32_t size = load_u32(file.data + 18);
    char *usda = calloc(size + 1, 1);
    memcpy(usda, file.data + 30 + load_u16(file.data + 26) + load_u16(file.data + 28), size);
    file_close(&file);
    return usda;
}

static void expect(const char *usda, const char *part)
{
    if (!strstr(usda, part))
        fail_msg("\"%s\" is not in\n%s", part, usda);
}

static void scenes_are_described(void **state)
{
    (void)state;
    const float triangle[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0}, uv[6] = {0, 0, 1, 0, 0.25f, 0.75f};
    const float times[2] = {0, 0.5f}, turns[8] = {0, 0, 0, 1, 0, 1, 0, 0};
    test_model m = {0};
    model_add_floats(&m, triangle, 3, "VEC3");
    model_add_floats(&m, uv, 3, "VEC2");
    model_add_floats(&m, times, 2, "SCALAR");
    model_add_floats(&m, turns, 2, "VEC4");
    facet_scene *scene = model_load(
        &m, "%s",
        "'images':[{'uri':'data:image/png;base64,"
        "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR42mP4DwABAQEAHLCMmQAAAABJRU5ErkJggg=='}],"
        "'textures':[{'source':0}],'extensionsUsed':['KHR_texture_transform','KHR_materials_clearcoat'],"
        "'materials':[{'name':'red','doubleSided':true,'alphaMode':'MASK','alphaCutoff':0.25,"
        "'pbrMetallicRoughness':{'baseColorFactor':[1,0.5,0,1],'roughnessFactor':0.75,'metallicFactor':0,"
        "'baseColorTexture':{'index':0,'extensions':{'KHR_texture_transform':{'offset':[0.5,0.25],"
        "'scale':[2,4]}}}},'extensions':{'KHR_materials_clearcoat':{'clearcoatFactor':0.5}}}],"
        "'meshes':[{'primitives':[{'attributes':{'POSITION':0,'TEXCOORD_0':1},'material':0}]}],"
        "'nodes':[{'name':'3 a','children':[1],'translation':[1,2,3]},{'name':'b','mesh':0},"
        "{'matrix':[1,0,0,0,0,1,0,0,0,0,1,0,7,8,9,1]}],'scenes':[{'nodes':[0,2]}],"
        "'animations':[{'channels':[{'sampler':0,'target':{'node':1,'path':'rotation'}}],"
        "'samplers':[{'input':2,'output':3}]}]");
    char *usda = save(scene);
    expect(usda, "#usda 1.0\n");
    expect(usda, "metersPerUnit = 1");
    expect(usda, "upAxis = \"Y\"");
    expect(usda, "endTimeCode = 12");
    expect(usda, "def Xform \"_3_a_0\"");
    expect(usda, "double3 xformOp:translate = (1, 2, 3)");
    expect(usda, "quatf xformOp:orient.timeSamples = {\n0: (1, 0, 0, 0),\n12: (0, 0, 1, 0),\n}");
    expect(usda, "((1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (7, 8, 9, 1))");
    expect(usda, "int[] faceVertexIndices = [0, 1, 2]");
    expect(usda, "primvars:st = [(0, 1), (1, 1), (0.25, 0.25)]");
    expect(usda, "uniform bool doubleSided = 1");
    expect(usda, "asset inputs:file = @textures/image0.png@");
    expect(usda, "float inputs:roughness = 0.75");
    expect(usda, "float inputs:clearcoat = 0.5");
    expect(usda, "float inputs:opacityThreshold = 0.25");
    /* the lower left corner, (0, 1) in glTF, reads (0.5, 4.25) there, which is (0.5, -3.25) with v up */
    expect(usda, "float2 inputs:translation = (0.5, -3.25)");
    free(usda);
    scene_destroy(scene);
}

/* Each node is written once, within its parent, in the file's order. */
static void nodes_nest_as_in_the_scene(void **state)
{
    (void)state;
    test_model m = {0};
    facet_scene *scene =
        model_load(&m, "%s",
                   "'nodes':[{'name':'a','children':[1,3,4]},{'name':'b','children':[2]},{'name':'c'},"
                   "{'name':'d'},{'name':'e','children':[5]},{'name':'f'}],'scenes':[{'nodes':[0]}]");
    char *usda = save(scene), nesting[32] = "";
    size_t length = 0;
    for (const char *c = strstr(usda, "def Xform \"a_0\""); c && *c && length + 1 < sizeof nesting; c++) {
        if (strncmp(c, "def Xform \"", 11) == 0)
            nesting[length++] = c[11];
        else if (*c == '}')
            nesting[length++] = '}';
    }
    assert_string_equal(nesting, "abc}}d}ef}}}}"); /* and Root */
    free(usda);
    scene_destroy(scene);
}

static void losses_are_named_in_one_warning(void **state)
{
    (void)state;
    test_model m = {0};
    const float points[3] = {0, 0, 0};
    model_add_floats(&m, points, 1, "VEC3");
    facet_scene *scene = model_load(&m, "%s",
                                    "'extensionsUsed':['KHR_materials_variants'],"
                                    "'extensions':{'KHR_materials_variants':{'variants':[{'name':'v'}]}},"
                                    "'cameras':[{'type':'perspective','perspective':{'yfov':1,'znear':0.1}}],"
                                    "'meshes':[{'primitives':[{'attributes':{'POSITION':0},'mode':0}]}],"
                                    "'nodes':[{'mesh':0,'camera':0}],'scenes':[{'nodes':[0]}]");
    captured_messages messages = {0};
    const facet_scene_save_desc desc = {.log = capture_log(&messages)};
    assert_int_equal(usdz_save(scene, temporary_folder_file(&folder, "b.usdz"), "a test", &desc, NULL),
                     FACET_OK);
    expect(messages.text, "points and lines, cameras, material variants");
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(files_are_stored_and_aligned),
        cmocka_unit_test(scenes_are_described),
        cmocka_unit_test(nodes_nest_as_in_the_scene),
        cmocka_unit_test(losses_are_named_in_one_warning),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
