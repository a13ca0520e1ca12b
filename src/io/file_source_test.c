/* Tests of file_source.h: models whose files the caller supplies. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include "base/result.h" /* before cmocka.h, which has a macro of the name of its function fail() */

#include <cmocka.h>

#include <string.h>

#include "io/file_source.h"
#include "io/model_file.h"
#include "scene/scene.h"

/* Three corners of a triangle. */
static const float corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};

static const char gltf[] =
    "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],"
    "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}},{\"attributes\":{\"POSITION\":1}}]}],"
    "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"min\":[0,0,0],"
    "\"max\":[1,1,0]},"
    "{\"bufferView\":1,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"min\":[0,0,0],\"max\":[1,1,0]}]"
    ","
    "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36},{\"buffer\":1,\"byteLength\":36}],"
    "\"buffers\":[{\"byteLength\":36,\"uri\":\"data/mesh%201.bin\"},{\"byteLength\":36,\"uri\":\"./data/"
    "mesh%201.bin\"}]}";

static const char obj[] = "mtllib Parts/Red.MTL\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n";
static const char mtl[] = "newmtl red\nKd 1 0 0\n";

/* A pack file: its entries, and how many of them are open. */
typedef struct entry {
    const char *path;
    const void *bytes;
    size_t size;
} entry;

typedef struct pack {
    const entry *entries;
    size_t count;
    int open, opened;
} pack;

static bool open_entry(void *user, const char *path, const void **bytes, size_t *size)
{
    pack *p = user;
    for (size_t i = 0; i < p->count; i++)
        if (strcmp(p->entries[i].path, path) == 0) {
            *bytes = p->entries[i].bytes;
            *size = p->entries[i].size;
            p->open++;
            p->opened++;
            return true;
        }
    return false;
}

static void close_entry(void *user, const void *bytes, size_t size)
{
    pack *p = user;
    (void)bytes, (void)size;
    p->open--;
}

static const char *list_entry(void *user, size_t index)
{
    const pack *p = user;
    return index < p->count ? p->entries[index].path : NULL;
}

static const entry entries[] = {
    {"a/model.gltf", gltf, sizeof gltf - 1}, {"a/data/mesh 1.bin", corners, sizeof corners},
    {"b/model.gltf", gltf, sizeof gltf - 1}, {"b/Data/MESH 1.bin", corners, sizeof corners},
    {"c/model.gltf", gltf, sizeof gltf - 1}, {"c/model.obj", obj, sizeof obj - 1},
    {"c/parts/red.mtl", mtl, sizeof mtl - 1}};

static facet_scene_desc desc_of(pack *p)
{
    *p = (pack){.entries = entries, .count = sizeof entries / sizeof *entries};
    return (facet_scene_desc){
        .files = {.user = p, .open = open_entry, .close = close_entry, .list = list_entry}};
}

/* Loads a model, and compares how many warnings it has and how many files it opened. */
static void expect_model(const char *path, uint32_t warnings, int opened)
{
    pack p;
    facet_error error;
    facet_scene *scene;
    const facet_scene_desc desc = desc_of(&p);
    if (model_file_load(path, &desc, &scene, &error) != FACET_OK)
        fail_msg("%s: %s", path, error.message);
    assert_int_equal(scene->warning_count, warnings);
    assert_int_equal(scene_count(scene).drawn_triangles, strstr(path, "obj") ? 1 : 2);
    assert_int_equal(p.opened, opened);
    scene_destroy(scene);
    assert_int_equal(p.open, 0);
}

static void models_of_several_files_are_read(void **state)
{
    (void)state;
    expect_model("a/model.gltf", 0,
                 3); /* the model twice: its kind, and its content; two buffers are one file */
    expect_model("./a//x/../model.gltf", 0, 3);
}

static void names_that_differ_in_case_are_found_with_a_warning(void **state)
{
    (void)state;
    expect_model("b/model.gltf", 2, 3); /* a warning for each of the two names */
    expect_model("c/model.obj", 1, 3);
}

static void expect_failure(const char *path, const facet_scene_desc *desc, pack *p, facet_result result,
                           const char *sentence)
{
    facet_error error;
    facet_scene *scene;
    assert_int_equal(model_file_load(path, desc, &scene, &error), result);
    if (!strstr(error.message, sentence))
        fail_msg("%s: %s", path, error.message);
    assert_null(scene);
    assert_int_equal(p->open, 0);
}

static void what_is_missing_is_named(void **state)
{
    (void)state;
    pack p;
    facet_scene_desc desc = desc_of(&p);
    expect_failure("c/model.gltf", &desc, &p, FACET_ERROR_READ, "there is no file \"data/mesh 1.bin\"");
    expect_failure("none.glb", &desc, &p, FACET_ERROR_READ, "none.glb: there is no such file");
    expect_failure("../a/model.gltf", &desc, &p, FACET_ERROR_READ, "there is no such file");
    desc.files.list = NULL;
    expect_failure("b/model.gltf", &desc, &p, FACET_ERROR_READ, "there is no file \"data/mesh 1.bin\"");
    desc.max_file_bytes = 35;
    expect_failure("a/model.gltf", &desc, &p, FACET_ERROR_LIMIT, "a/model.gltf");
}

static void a_size_without_bytes_is_refused(void **state)
{
    (void)state;
    static const char *const paths[] = {"a.glb", "a.gltf", "a.obj", "a.stl", "a.ply"};
    for (size_t i = 0; i < sizeof paths / sizeof *paths; i++) {
        entry broken = {paths[i], NULL, 100};
        pack p = {&broken, 1, 0, 0};
        const facet_scene_desc desc = {.files = {&p, open_entry, close_entry, NULL}};
        expect_failure(paths[i], &desc, &p, FACET_ERROR_READ, "gave no bytes, but a size of 100");
    }
}

/* Names may not leave the folder of the model, nor the root. */
static void names_stay_in_their_folder(void **state)
{
    (void)state;
    static const char outside[] = "mtllib ../c/parts/red.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    const entry two[] = {{"a/out.obj", outside, sizeof outside - 1},
                         {"c/parts/red.mtl", mtl, sizeof mtl - 1}};
    static const struct {
        const char *root;
        uint32_t warnings;
    } cases[] = {{NULL, 1}, {".", 0}, {"a", 1}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        pack p;
        facet_error error;
        facet_scene *scene;
        facet_scene_desc desc = desc_of(&p);
        desc.root = cases[i].root;
        p.entries = two;
        p.count = 2;
        assert_int_equal(model_file_load("a/out.obj", &desc, &scene, &error), FACET_OK);
        assert_int_equal(scene->warning_count, cases[i].warnings);
        scene_destroy(scene);
        assert_int_equal(p.open, 0);
    }
}

static void paths_are_made_plain(void **state)
{
    (void)state;
    static const char *const cases[][2] = {{"a/b", "a/b"},  {"/a//b/", "a/b"},     {"./a/./b", "a/b"},
                                           {"a/../b", "b"}, {"ab/c/../d", "ab/d"}, {"a/..", ""}};
    bool leaves_top;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char *plain = file_source_path(NULL, cases[i][0], &leaves_top);
        assert_string_equal(plain, cases[i][1]);
        mem_free(plain);
    }
    assert_null(file_source_path(NULL, "a/../../b", &leaves_top));
    assert_true(leaves_top);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(models_of_several_files_are_read),
        cmocka_unit_test(names_that_differ_in_case_are_found_with_a_warning),
        cmocka_unit_test(what_is_missing_is_named),
        cmocka_unit_test(a_size_without_bytes_is_refused),
        cmocka_unit_test(names_stay_in_their_folder),
        cmocka_unit_test(paths_are_made_plain),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
