/* gltf_files_test.c - containers, JSON, versions, extensions; and which files a model may reach. */
#define _POSIX_C_SOURCE 200809L
#include "io/gltf/gltf_test_support.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* ---- a folder of files ---- */

/* outside.bin; model/ with inside.bin, "a b.bin", deep/inside.bin, link.bin -> ../outside.bin */
static int make_folder(void **state)
{
    temporary_folder *f = malloc(sizeof *f);
    assert_non_null(f);
    temporary_folder_create(f);
    const float triangle[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    temporary_folder_put(f, "outside.bin", triangle, sizeof triangle);
    temporary_folder_put(f, "model/inside.bin", triangle, sizeof triangle);
    temporary_folder_put(f, "model/short.bin", triangle, 35);
    temporary_folder_put(f, "model/a b.bin", triangle, sizeof triangle);
    temporary_folder_put(f, "model/100%.bin", triangle, sizeof triangle);
    temporary_folder_put(f, "model/deep/inside.bin", triangle, sizeof triangle);
    assert_int_equal(symlink("../outside.bin", temporary_folder_file(f, "model/link.bin")), 0);
    *state = f;
    return 0;
}

static int remove_folder(void **state)
{
    temporary_folder_remove(*state);
    free(*state);
    return 0;
}

/* Loads a model of one triangle, whose buffer is uri. */
static facet_result load_uri_model(const temporary_folder *f, const char *uri, const char *root,
                                   facet_scene **scene, facet_error *error)
{
    char json[2048];
    int size =
        snprintf(json, sizeof json,
                 "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":36,\"uri\":\"%s\"}],"
                 "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],\"accessors\":[{\"bufferView\":0,"
                 "\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}],\"meshes\":[{\"primitives\":[{"
                 "\"attributes\":{\"POSITION\":0}}]}]}",
                 uri);
    const facet_scene_desc desc = {.root = root};
    return gltf_load(temporary_folder_put(f, "model/model.gltf", json, (size_t)size), &desc, scene, error);
}

static void files_below_the_model_are_read(void **state)
{
    static const char *const uris[] = {
        "inside.bin", "./inside.bin", "deep/inside.bin", "deep/../inside.bin", "deep/./inside.bin",
        "a b.bin",    "a%20b.bin",    "100%.bin",        "100%25.bin",         "deep\\\\inside.bin"};
    for (size_t i = 0; i < sizeof uris / sizeof *uris; i++) {
        facet_scene *scene = NULL;
        facet_error error = {0};
        if (load_uri_model(*state, uris[i], NULL, &scene, &error) != FACET_OK)
            fail_msg("%s: %s", uris[i], error.message);
        assert_near(first_primitive(scene)->positions[3], 1, 0);
        /* both files by the names under which they were opened */
        assert_non_null(strstr(scene_get_file(scene, 0), "/model/model.gltf"));
        assert_non_null(strstr(scene_get_file(scene, 1), "/model/"));
        assert_null(scene_get_file(scene, 2));
        scene_destroy(scene);
    }
}

static void files_with_alike_names_are_read_with_a_warning(void **state)
{
    static const char *const uris[] = {"Inside.BIN",   "DEEP/inside.bin", "inside.bin?v=1", "inside.bin#a",
                                       "deep/A%20B.x", "a\\\\ b.bin",     "A%20b.bin?x"};
    for (size_t i = 0; i < sizeof uris / sizeof *uris; i++) {
        facet_scene *scene = NULL;
        facet_error error = {0};
        facet_result result = load_uri_model(*state, uris[i], NULL, &scene, &error);
        if ((result == FACET_OK) != (i != 4))
            fail_msg("%s: %s", uris[i], error.message);
        if (result == FACET_OK) {
            assert_int_equal(scene->warning_count, 1);
            assert_non_null(strstr(scene->warnings[0], "is read instead"));
        }
        scene_destroy(scene);
    }
}

static void files_outside_the_root_are_not_read(void **state)
{
    const temporary_folder *f = *state;
    char absolute[256];
    snprintf(absolute, sizeof absolute, "%s/model/inside.bin", f->path);
    const char *const uris[] = {"../outside.bin",
                                "deep/../../outside.bin",
                                "%2e%2e/outside.bin",
                                "..%2Foutside.bin",
                                "..\\\\outside.bin",
                                "../OUTSIDE.bin",
                                "../outside.bin?v=1",
                                "LINK.bin",
                                "link.bin",
                                absolute,
                                "file:///etc/passwd",
                                "http://example.com/a.bin",
                                "C:/a.bin",
                                "missing.bin",
                                "deep",
                                "."};
    for (size_t i = 0; i < sizeof uris / sizeof *uris; i++) {
        facet_scene *scene = (facet_scene *)1;
        facet_error error = {0};
        if (load_uri_model(f, uris[i], NULL, &scene, &error) != FACET_ERROR_READ)
            fail_msg("%s: %s", uris[i], error.message);
        assert_null(scene);
        assert_non_null(strstr(error.message, "model.gltf: buffers[0].uri: "));
    }
}

static void a_root_admits_more_files(void **state)
{
    const temporary_folder *f = *state;
    facet_scene *scene = NULL;
    facet_error error = {0};
    static const char *const uris[] = {"../outside.bin", "link.bin", "inside.bin"};
    for (size_t i = 0; i < sizeof uris / sizeof *uris; i++) {
        if (load_uri_model(f, uris[i], f->path, &scene, &error) != FACET_OK)
            fail_msg("%s: %s", uris[i], error.message);
        scene_destroy(scene);
    }
    assert_int_equal(load_uri_model(f, "../../etc/passwd", f->path, &scene, &error), FACET_ERROR_READ);
}

static void files_that_are_too_short_are_refused(void **state)
{
    facet_scene *scene;
    facet_error error = {0};
    assert_int_equal(load_uri_model(*state, "short.bin", NULL, &scene, &error), FACET_ERROR_INVALID);
    assert_non_null(strstr(error.message, "buffers[0].byteLength: declares 36 bytes, but there are 35"));
}

static void data_uris_are_decoded(void **state)
{
    facet_scene *scene = NULL;
    facet_error error = {0};
    /* Three vertices; the same without padding, and with the URL-safe alphabet (no difference here). */
    static const char *const good[] = {"data:application/octet-stream;base64,"
                                       "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA",
                                       "data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"};
    for (int i = 0; i < 2; i++) {
        if (load_uri_model(*state, good[i], NULL, &scene, &error) != FACET_OK)
            fail_msg("%s", error.message);
        assert_near(first_primitive(scene)->positions[3], 1, 0);
        scene_destroy(scene);
    }
    static const char *const bad[][2] = {{"data:", "is a data URI that is not base64"},
                                         {"data:text/plain,hello", "is a data URI that is not base64"},
                                         {"data:;base64,AAA!", "characters that are not base64"},
                                         {"data:;base64,AAAAA", "characters that are not base64"},
                                         {"data:;base64,", "declares 36 bytes, but there are 0"}};
    for (int i = 0; i < 5; i++) {
        assert_int_equal(load_uri_model(*state, bad[i][0], NULL, &scene, &error), FACET_ERROR_INVALID);
        if (!strstr(error.message, bad[i][1]))
            fail_msg("%s", error.message);
    }
}

static void missing_files_are_read_errors(void **state)
{
    (void)state;
    facet_scene *scene = (facet_scene *)1;
    facet_error error = {0};
    assert_int_equal(gltf_load("/nonexistent/model.glb", NULL, &scene, &error), FACET_ERROR_READ);
    assert_null(scene);
    assert_int_equal(gltf_load("/tmp", NULL, &scene, &error), FACET_ERROR_READ);
}

/* ---- containers ---- */

static void broken_containers_are_refused_with_a_reason(void **state)
{
    (void)state;
    static const struct {
        const char *bytes;
        size_t size;
        facet_result result;
        const char *message;
    } cases[] = {
        {"", 0, FACET_ERROR_INVALID, "test: is empty"},
        {"hello", 5, FACET_ERROR_INVALID, "is neither a .glb file nor the JSON"},
        {"   ", 3, FACET_ERROR_INVALID, "is neither a .glb file nor the JSON"},
        {"glTF", 4, FACET_ERROR_INVALID, "is cut off: 4 bytes are less than the 12"},
        {"glTF\1\0\0\0\14\0\0\0", 12, FACET_ERROR_UNSUPPORTED, "is binary glTF 1.0"},
        {"glTF\3\0\0\0\14\0\0\0", 12, FACET_ERROR_UNSUPPORTED, "is GLB version 3"},
        {"glTF\2\0\0\0\14\0\0\0", 12, FACET_ERROR_INVALID, "has no JSON chunk"},
        {"glTF\2\0\0\0\15\0\0\0", 12, FACET_ERROR_INVALID, "its header declares 13 bytes, but there are 12"},
        {"glTF\2\0\0\0\20\0\0\0abcd", 16, FACET_ERROR_INVALID, "is cut off in the header of chunk 0"},
        {"glTF\2\0\0\0\24\0\0\0\4\0\0\0JSON", 20, FACET_ERROR_INVALID,
         "chunk 0 declares 4 bytes, but 0 follow"},
        {"glTF\2\0\0\0\24\0\0\0\377\377\377\377JSON", 20, FACET_ERROR_INVALID,
         "chunk 0 declares 4294967295 bytes"},
        {"glTF\2\0\0\0\24\0\0\0\0\0\0\0BIN\0", 20, FACET_ERROR_INVALID, "the first chunk must be JSON"},
        {"{", 1, FACET_ERROR_INVALID, "is not valid JSON: line 1"},
        {"{}", 2, FACET_ERROR_INVALID, "asset.version: is missing"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        facet_scene *scene = (facet_scene *)1;
        facet_error error = {0};
        assert_int_equal(gltf_load_memory(cases[i].bytes, cases[i].size, "test", NULL, &scene, &error),
                         cases[i].result);
        assert_null(scene);
        if (!strstr(error.message, cases[i].message))
            fail_msg("%s", error.message);
    }
}

static void deep_json_is_refused(void **state)
{
    (void)state;
    char *json = malloc(200001);
    assert_non_null(json);
    strcpy(json, "{\"a\":");
    memset(json + 5, '[', 199990);
    json[199995] = 0;
    facet_scene *scene;
    facet_error error = {0};
    assert_int_equal(try_load_text(json, &scene, &error), FACET_ERROR_INVALID);
    assert_non_null(strstr(error.message, "maximum parsing depth"));
    free(json);
}

static void json_counts_against_a_budget(void **state)
{
    (void)state;
    enum { COUNT = 100000 };
    char *json = malloc(COUNT * 3 + 100);
    assert_non_null(json);
    strcpy(json, "{\"asset\":{\"version\":\"2.0\"},\"extras\":[0");
    size_t length = strlen(json);
    for (int i = 0; i < COUNT; i++, length += 2)
        memcpy(json + length, ",0", 2);
    strcpy(json + length, "]}");
    facet_budget *budget = NULL;
    assert_int_equal(facet_budget_create(1 << 20, &budget, NULL), FACET_OK);
    facet_scene_desc desc = {.allocator = facet_budget_allocator(budget)};
    facet_scene *scene = NULL;
    facet_error error = {0};
    assert_int_equal(gltf_load_memory(json, strlen(json), "test", &desc, &scene, &error), FACET_ERROR_MEMORY);
    assert_int_equal(facet_budget_used_bytes(budget), 0);
    facet_budget_destroy(budget);
    free(json);
}

/* Latin-1; GBK, whose second bytes may be a backslash, before a letter and before the quote; half of a
 * surrogate pair. */
static void text_of_other_encodings_is_read(void **state)
{
    (void)state;
    static const struct {
        const char *names[2], *read[2];
    } cases[] = {
        {{"caf\xe9", "caf\xea"}, {"caf\xc3\xa9", "caf\xc3\xaa"}},
        {{"caf\xe9\\n", "\xe9\\u0041"},
         {"caf\xc3\xa9\n", "\xc3\xa9"
                           "A"}},
        {{"\xbd\xf0\xca\xf4", "\xd6\xd0"}, {"\xc2\xbd\xc3\xb0\xc3\x8a\xc3\xb4", "\xc3\x96\xc3\x90"}},
        {{"\xe5\\x", "\x95\\"}, {"\xc3\xa5\\x", "\xc2\x95\\"}},
        {{"\\ud83d", "\\ud83d\\ude00"}, {"\xef\xbf\xbd", "\xf0\x9f\x98\x80"}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char json[256];
        snprintf(json, sizeof json, "{'asset':{'version':'2.0'},'materials':[{'name':'%s'},{'name':'%s'}]}",
                 cases[i].names[0], cases[i].names[1]);
        facet_scene *scene = NULL;
        facet_error error = {0};
        if (try_load_text(json, &scene, &error) != FACET_OK)
            fail_msg("%s", error.message);
        assert_string_equal(scene->materials[0].name, cases[i].read[0]);
        assert_string_equal(scene->materials[1].name, cases[i].read[1]);
        assert_int_equal(scene->warning_count, 1);
        assert_true(has_warning(scene, "has text that is not UTF-8; its bytes are taken as Latin-1"));
        scene_destroy(scene);
    }
    facet_scene *scene = NULL;
    facet_error error = {0};
    assert_int_equal(try_load_text("{'asset':{'version':'2.0','x':'\xe9'}", &scene, &error),
                     FACET_ERROR_INVALID);
    assert_non_null(strstr(error.message, "is not valid JSON"));
}

static void unusual_spellings_of_version_2_are_read(void **state)
{
    (void)state;
    static const char *const versions[] = {"2", "2.0.0"};
    for (int i = 0; i < 2; i++) {
        char json[64];
        facet_scene *scene = NULL;
        facet_error error = {0};
        snprintf(json, sizeof json, "{'asset':{'version':'%s'}}", versions[i]);
        if (try_load_text(json, &scene, &error) != FACET_OK)
            fail_msg("%s", error.message);
        assert_true(has_note(scene, "is not a version such as \"2.0\""));
        scene_destroy(scene);
    }
}

static void large_numbers_are_rounded(void **state)
{
    (void)state;
    facet_scene *scene = load("'materials':[{'name':'a','extras':{'id':18446744073709551615}}],'nodes':[{}],"
                              "'scenes':[{'nodes':[0]}],'scene':0",
                              NULL);
    assert_string_equal(scene->materials[0].meta.extras, "{\"id\":1.8446744073709552e19}");
    assert_int_equal(scene->warning_count, 0);
    assert_true(has_note(scene, "has integers beyond 2^63; they are rounded"));
    scene_destroy(scene);
}

static void other_versions_are_refused(void **state)
{
    (void)state;
    static const struct {
        const char *json;
        facet_result result;
        const char *message;
    } cases[] = {
        {"{'asset':{'version':'1.0'}}", FACET_ERROR_UNSUPPORTED,
         "asset.version: is glTF 1.0; only glTF 2.0 is read"},
        {"{'asset':{'version':'3.1'}}", FACET_ERROR_UNSUPPORTED, "is glTF 3.1"},
        {"{'asset':{'version':'two'}}", FACET_ERROR_INVALID, "is not a version"},
        {"{'asset':{'version':'20'}}", FACET_ERROR_INVALID, "is not a version"},
        {"{'asset':{'version':2}}", FACET_ERROR_INVALID, "must be a string, but is a number"},
        {"{'asset':{'version':'2.0','minVersion':'2.2'}}", FACET_ERROR_UNSUPPORTED,
         "requires a reader of glTF 2.2"},
        {"{'asset':{'version':'2.2'}}", FACET_OK, "is glTF 2.2; it is read as glTF 2.1"},
        {"{'asset':{'version':'2.2','minVersion':'2.1'}}", FACET_OK, "is glTF 2.2; it is read as glTF 2.1"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        facet_scene *scene = NULL;
        facet_error error = {0};
        assert_int_equal(try_load_text(cases[i].json, &scene, &error), cases[i].result);
        if (scene ? !has_warning(scene, cases[i].message) : !strstr(error.message, cases[i].message))
            fail_msg("%s", error.message);
        scene_destroy(scene);
    }
}

static void unsupported_extensions_are_reported(void **state)
{
    (void)state;
    assert_refused("'extensionsUsed':['VENDOR_x'],'extensionsRequired':['VENDOR_x']", NULL,
                   FACET_ERROR_UNSUPPORTED, "requires the extension VENDOR_x, which facet does not support");
    facet_scene *scene =
        load("'extensionsUsed':['VENDOR_x','EXT_lights_ies','KHR_xmp_json_ld','KHR_materials_ior'],"
             "'extensionsRequired':['KHR_materials_ior'],'materials':[{'extensions':{'VENDOR_y':{},'VENDOR_x'"
             ":{}}}],"
             "'nodes':[{'extensions':{'KHR_materials_ior':{},'EXT_lights_ies':{}}}]",
             NULL);
    assert_true(has_warning(scene, "uses the extension VENDOR_x, which facet does not support"));
    assert_true(has_warning(scene, "uses EXT_lights_ies, which is not drawn: its lights are left out"));
    assert_true(has_warning(scene, "uses VENDOR_y without naming it in extensionsUsed"));
    assert_true(has_note(scene, "has KHR_materials_ior in an object that it does not extend"));
    assert_false(has_warning(scene, "xmp"));
    assert_int_equal(scene->extension_count, 4);
    assert_int_equal(scene->extensions[1].support, SCENE_IGNORED);
    assert_int_equal(scene->extensions[3].support, SCENE_SUPPORTED);
    assert_true(scene->extensions[3].is_required);
    scene_destroy(scene);
}

/* One warning per name, wherever and however often objects have it. */
static void extensions_that_change_the_image_are_named_once(void **state)
{
    (void)state;
    facet_scene *scene = load("'extensionsUsed':['VENDOR_y','EXT_materials_bump'],"
                              "'materials':[{'extensions':{'VENDOR_y':{},'EXT_materials_bump':{}}},"
                              "{'extensions':{'VENDOR_y':{},'EXT_materials_bump':{}}}],"
                              "'textures':[{'extensions':{'VENDOR_y':{}}}],"
                              "'meshes':[{'primitives':[{'attributes':{},'extensions':{'VENDOR_y':{}}}]}]",
                              NULL);
    assert_true(has_warning(scene, "uses the extension VENDOR_y, which facet does not support"));
    assert_true(
        has_warning(scene, "uses EXT_materials_bump, which is not drawn: its heights do not tilt normals"));
    uint32_t named = 0;
    for (uint32_t i = 0; i < scene->warning_count; i++)
        named += strstr(scene->warnings[i], "VENDOR_y") || strstr(scene->warnings[i], "EXT_materials_bump");
    assert_int_equal(named, 2);
    scene_destroy(scene);
    assert_refused("'extensionsUsed':['EXT_materials_bump'],'extensionsRequired':['EXT_materials_bump']",
                   NULL, FACET_ERROR_UNSUPPORTED, "requires the extension EXT_materials_bump");
}

static void asset_and_names_are_kept(void **state)
{
    (void)state;
    facet_scene *scene = NULL;
    facet_error error = {0};
    assert_int_equal(
        try_load_text(
            "{'asset':{'version':'2.0','generator':'g','copyright':'\xc2\xa9 c'},'materials':[{'name'"
            ":'\xe2\x9d\xa4'},{'name':7}]}",
            &scene, &error),
        FACET_OK);
    assert_string_equal(scene->generator, "g");
    assert_string_equal(scene->copyright, "\xc2\xa9 c");
    assert_string_equal(scene->materials[0].name, "\xe2\x9d\xa4");
    assert_string_equal(scene->materials[1].name, "");
    assert_true(has_note(scene, "materials[1].name: must be a string, but is a number"));
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(files_below_the_model_are_read),
        cmocka_unit_test(files_with_alike_names_are_read_with_a_warning),
        cmocka_unit_test(files_outside_the_root_are_not_read),
        cmocka_unit_test(a_root_admits_more_files),
        cmocka_unit_test(files_that_are_too_short_are_refused),
        cmocka_unit_test(data_uris_are_decoded),
        cmocka_unit_test(missing_files_are_read_errors),
        cmocka_unit_test(broken_containers_are_refused_with_a_reason),
        cmocka_unit_test(deep_json_is_refused),
        cmocka_unit_test(json_counts_against_a_budget),
        cmocka_unit_test(text_of_other_encodings_is_read),
        cmocka_unit_test(unusual_spellings_of_version_2_are_read),
        cmocka_unit_test(large_numbers_are_rounded),
        cmocka_unit_test(other_versions_are_refused),
        cmocka_unit_test(unsupported_extensions_are_reported),
        cmocka_unit_test(extensions_that_change_the_image_are_named_once),
        cmocka_unit_test(asset_and_names_are_kept),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
