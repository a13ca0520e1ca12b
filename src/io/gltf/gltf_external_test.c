/* gltf_external_test.c - assets of other files: the tree that a file makes of them, and what it may not do. */
#include "io/gltf/gltf_test_support.h"

#include <stdio.h>
#include <string.h>

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

/* Writes a .gltf file from JSON with ' for ", without the asset. */
static const char *put(const char *name, const char *body)
{
    char text[8192];
    int size = snprintf(text, sizeof text, "{'asset':{'version':'2.1'},%s}", body);
    assert_true(size > 0 && (size_t)size < sizeof text);
    for (char *c = text; *c; c++)
        if (*c == '\'')
            *c = '"';
    return temporary_folder_put(&folder, name, text, (size_t)size);
}

static facet_scene *load_file(const char *path)
{
    facet_scene *scene = NULL;
    facet_error error;
    if (gltf_load(path, NULL, &scene, &error) != FACET_OK)
        fail_msg("%s", error.message);
    return scene;
}

static void refuse_file(const char *path, facet_result result, const char *text)
{
    facet_scene *scene = NULL;
    facet_error error = {0};
    assert_int_equal(gltf_load(path, NULL, &scene, &error), result);
    assert_null(scene);
    if (!strstr(error.message, text))
        fail_msg("\"%s\" does not contain \"%s\"", error.message, text);
}

#define REFERENCE(uri)                                                                                       \
    "'files':[{'uri':'" uri "','mimeType':'model/gltf+json'}],'externalAssets':[{'file':0}],"
#define LEAF(name) "'scene':0,'scenes':[{'nodes':[0]}],'nodes':[{'name':'" name "'}]"

/* The tree below a node as "a(b,c(d))". */
static void write_tree(const facet_scene *s, uint32_t node, char *text, size_t size)
{
    size_t used = strlen(text);
    const scene_node *n = &s->nodes[node];
    snprintf(text + used, size - used, "%s%s", n->name, n->child_count ? "(" : "");
    for (uint32_t i = 0; i < n->child_count; i++) {
        assert_int_equal(s->nodes[n->children[i]].parent, node);
        write_tree(s, n->children[i], text, size);
        used = strlen(text);
        snprintf(text + used, size - used, "%s", i + 1 < n->child_count ? "," : ")");
    }
}

/* The example of the draft's appendix, with a mesh in B. */
static void assets_become_children(void **state)
{
    (void)state;
    put("sub/b.gltf",
        "'scene':1,'scenes':[{'nodes':[1]},{'nodes':[0]}],"
        "'buffers':[{'byteLength':36,'uri':'t.bin'}],'bufferViews':[{'buffer':0,'byteLength':36}],"
        "'accessors':[{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'}],"
        "'materials':[{'name':'paint'}],"
        "'meshes':[{'primitives':[{'attributes':{'POSITION':0},'material':0}]}],"
        "'cameras':[{'name':'eye','type':'perspective','perspective':{'yfov':1,'znear':0.1}}],"
        "'nodes':[{'name':'B1','mesh':0,'camera':0},{'name':'unused'}]");
    const float triangle[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    temporary_folder_put(&folder, "sub/t.bin", triangle, sizeof triangle);
    put("c.gltf", "'scene':0,'scenes':[{'nodes':[0,1]}],'nodes':[{'name':'C1'},{'name':'C2'}]");
    const char *path = put(
        "a.gltf", "'scene':0,'scenes':[{'nodes':[0]}],'materials':[{'name':'own'}],"
                  "'files':[{'uri':'sub/b.gltf','mimeType':'model/gltf+json'},"
                  "{'uri':'c.gltf','mimeType':'model/gltf-binary'}],"
                  "'externalAssets':[{'file':0,'name':'b'},{'file':1,'name':'c'}],"
                  "'nodes':[{'name':'A1','children':[1,2,3]},{'name':'A1n','externalAsset':0,'children':[4]},"
                  "{'name':'A2n','externalAsset':0},{'name':'A3n','externalAsset':1},{'name':'own child'}]");
    facet_scene *scene = load_file(path);
    char tree[512] = "";
    write_tree(scene, scene->scenes[0].nodes[0], tree, sizeof tree);
    assert_string_equal(tree, "A1(A1n(own child,A1n/B1),A2n(A2n/B1),A3n(A3n/C1,A3n/C2))");
    assert_int_equal(scene->mesh_count, 1); /* shared by both copies */
    assert_int_equal(scene->material_count, 2);
    assert_int_equal(scene->meshes[0].primitives[0].material, 1);
    assert_int_equal(scene->camera_count, 2);
    assert_string_equal(scene->cameras[1].name, "A2n/eye");
    assert_int_equal(scene->nodes[scene->nodes[2].children[0]].camera, 1);
    assert_int_equal(scene->external_count, 3);
    assert_string_equal(scene->externals[2].name, "A3n");
    assert_non_null(strstr(scene->externals[2].file, "/c.gltf"));
    assert_int_equal(scene->externals[2].node_count, 2);
    assert_true(scene_has_file(scene, temporary_folder_file(&folder, "sub/t.bin")));
    assert_int_equal(scene->warning_count, 1);
    assert_true(
        has_warning(scene, "files[1].mimeType: says \"model/gltf-binary\", but the file is model/gltf+json"));
    scene_pose pose;
    assert_int_equal(scene_pose_create(scene, NULL, NULL, 1, &pose, NULL), FACET_OK);
    assert_int_equal(pose.instance_count, 2);
    scene_pose_destroy(&pose);
    scene_destroy(scene);
}

static void animations_and_skins_follow_their_nodes(void **state)
{
    (void)state;
    put("mover.gltf",
        "'scene':0,'scenes':[{'nodes':[0]}],'nodes':[{'name':'arm'}],'skins':[{'joints':[0]}],"
        "'buffers':[{'byteLength':32,'uri':'keys.bin'}],'bufferViews':[{'buffer':0,'byteLength':32}],"
        "'accessors':[{'bufferView':0,'componentType':5126,'count':2,'type':'SCALAR'},"
        "{'bufferView':0,'byteOffset':8,'componentType':5126,'count':2,'type':'VEC3'}],"
        "'animations':[{'name':'wave','channels':[{'sampler':0,'target':{'node':0,'path':'translation'}}],"
        "'samplers':[{'input':0,'output':1}]}]");
    const float keys[8] = {0, 1, 0, 0, 0, 4, 0, 0};
    temporary_folder_put(&folder, "keys.bin", keys, sizeof keys);
    facet_scene *scene = load_file(put(
        "a.gltf",
        REFERENCE("mover.gltf") "'scene':0,'scenes':[{'nodes':[0,1]}],"
                                "'nodes':[{'name':'x','externalAsset':0},{'name':'y','externalAsset':0}]"));
    assert_int_equal(scene->animation_count, 2);
    assert_string_equal(scene->animations[1].name, "y/wave");
    assert_true(scene->animations[0].is_external);
    assert_int_equal(scene->skin_count, 2);
    for (uint32_t i = 0; i < 2; i++) {
        const uint32_t arm = scene->nodes[i].children[0];
        assert_int_equal(scene->animations[i].channels[0].index, arm);
        assert_int_equal(scene->skins[i].joints[0], arm);
    }
    scene_destroy(scene);
}

static void assets_may_have_assets(void **state)
{
    (void)state;
    put("deep/c.gltf", LEAF("C"));
    put("b.gltf",
        REFERENCE("deep/c.gltf") "'scene':0,'scenes':[{'nodes':[0,1]}],"
                                 "'nodes':[{'name':'p','externalAsset':0},{'name':'q','externalAsset':0}]");
    facet_scene *scene = load_file(
        put("a.gltf",
            REFERENCE("b.gltf") "'scene':0,'scenes':[{'nodes':[0,1]}],"
                                "'nodes':[{'name':'x','externalAsset':0},{'name':'y','externalAsset':0}]"));
    char tree[512] = "";
    write_tree(scene, 1, tree, sizeof tree);
    assert_string_equal(tree, "y(y/p(y/p/C),y/q(y/q/C))");
    assert_int_equal(scene->external_count, 6);
    static const struct {
        const char *name;
        uint32_t depth;
    } expected[] = {{"x", 0}, {"x/p", 1}, {"x/q", 1}, {"y", 0}, {"y/p", 1}, {"y/q", 1}};
    for (uint32_t i = 0; i < 6; i++) {
        assert_string_equal(scene->externals[i].name, expected[i].name);
        assert_int_equal(scene->externals[i].depth, expected[i].depth);
        char name[64];
        snprintf(name, sizeof name, "%s", scene->nodes[scene->externals[i].node].name);
        assert_string_equal(name, expected[i].name);
    }
    scene_destroy(scene);
}

static void cycles_are_refused_with_their_chain(void **state)
{
    (void)state;
    put("b.gltf", REFERENCE("a.gltf") "'scene':0,'scenes':[{'nodes':[0]}],'nodes':[{'externalAsset':0}]");
    refuse_file(
        put("a.gltf", REFERENCE("b.gltf") "'scene':0,'scenes':[{'nodes':[0]}],'nodes':[{'externalAsset':0}]"),
        FACET_ERROR_INVALID, "is a cycle of files, a.gltf -> b.gltf -> a.gltf");
    refuse_file(
        put("self.gltf",
            REFERENCE("./self.gltf") "'scene':0,'scenes':[{'nodes':[0]}],'nodes':[{'externalAsset':0}]"),
        FACET_ERROR_INVALID, "is a cycle of files, self.gltf -> self.gltf");
}

/* Files n0 .. n17, each in the one before it. */
static void depth_is_limited(void **state)
{
    (void)state;
    char name[32], body[512];
    put("n17.gltf", LEAF("end"));
    for (int i = 16; i >= 0; i--) {
        snprintf(name, sizeof name, "n%d.gltf", i);
        snprintf(body, sizeof body,
                 "'files':[{'uri':'n%d.gltf','mimeType':'model/gltf+json'}],'externalAssets':[{'file':0}],"
                 "'scene':0,'scenes':[{'nodes':[0]}],'nodes':[{'externalAsset':0}]",
                 i + 1);
        put(name, body);
    }
    facet_scene *scene = load_file(temporary_folder_file(&folder, "n1.gltf"));
    assert_int_equal(scene->node_count, 17);
    scene_destroy(scene);
    refuse_file(temporary_folder_file(&folder, "n0.gltf"), FACET_ERROR_LIMIT,
                "is nested in more than 16 other assets");
}

/* Ten nodes with the next file each, in 9 files: 10^9 nodes, which are counted before they are made. */
static void expansion_is_counted_first(void **state)
{
    (void)state;
    char name[32], body[2048];
    put("w9.gltf", LEAF("end"));
    for (int i = 8; i >= 0; i--) {
        snprintf(name, sizeof name, "w%d.gltf", i);
        int used = snprintf(
            body, sizeof body,
            "'files':[{'uri':'w%d.gltf','mimeType':'model/gltf+json'}],'externalAssets':[{'file':0}],"
            "'scene':0,'scenes':[{'nodes':[0,1,2,3,4,5,6,7,8,9]}],'nodes':[{'externalAsset':0}",
            i + 1);
        for (int k = 1; k < 10; k++)
            used += snprintf(body + used, sizeof body - (size_t)used, ",{'externalAsset':0}");
        snprintf(body + used, sizeof body - (size_t)used, "]");
        put(name, body);
    }
    refuse_file(temporary_folder_file(&folder, "w0.gltf"), FACET_ERROR_LIMIT,
                "makes more than 1048576 nodes");
}

static void aliases_replace_URIs_of_the_asset_only(void **state)
{
    (void)state;
    put("c.gltf", LEAF("C"));
    put("other.gltf", LEAF("other"));
    put("b.gltf", "'files':[{'uri':'c.gltf','mimeType':'model/gltf+json'},{'uri':'./"
                  "c.gltf','mimeType':'model/gltf+json'}],"
                  "'externalAssets':[{'file':0},{'file':1}],'scene':0,'scenes':[{'nodes':[0,1]}],"
                  "'nodes':[{'name':'hit','externalAsset':0},{'name':'miss','externalAsset':1}]");
    facet_scene *scene = load_file(
        put("a.gltf",
            "'files':[{'uri':'b.gltf','mimeType':'model/gltf+json','aliases':[{'alias':'c.gltf','file':1}]},"
            "{'uri':'other.gltf','mimeType':'model/gltf+json'}],'externalAssets':[{'file':0}],"
            "'scene':0,'scenes':[{'nodes':[0]}],'nodes':[{'name':'A','externalAsset':0}]"));
    char tree[512] = "";
    write_tree(scene, 0, tree, sizeof tree);
    assert_string_equal(tree, "A(A/hit(A/hit/other),A/miss(A/miss/C))");
    scene_destroy(scene);
}

/* A file inside the file: its relative URIs start in the folder of the outer one. */
static void embedded_assets_start_in_the_folder_of_their_file(void **state)
{
    (void)state;
    const char *inner = "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],"
                        "\"nodes\":[{\"name\":\"inner\"}],\"images\":[{\"uri\":\"p.png\"}]}";
    char body[2048];
    temporary_folder_put_png(&folder, "p.png");
    temporary_folder_put(&folder, "sub/inner.bin", inner, strlen(inner));
    snprintf(
        body, sizeof body,
        "'buffers':[{'uri':'sub/inner.bin','byteLength':%zu}],'bufferViews':[{'buffer':0,'byteLength':%zu}],"
        "'files':[{'bufferView':0,'mimeType':'model/gltf+json'}],"
        "'externalAssets':[{'file':0}],'scene':0,'scenes':[{'nodes':[0]}],'nodes':[{'externalAsset':0}]",
        strlen(inner), strlen(inner));
    facet_scene *scene = load_file(put("a.gltf", body));
    assert_int_equal(scene->warning_count, 0);
    assert_int_equal(scene->node_count, 2);
    assert_int_equal(scene->images[0].width, 1);
    assert_non_null(strstr(scene->externals[0].file, "a.gltf: files[0]"));
    scene_destroy(scene);
}

static void what_cannot_be_read_leaves_an_empty_node(void **state)
{
    (void)state;
    static const struct {
        const char *file, *warning;
    } cases[] = {
        {"'uri':'missing.gltf'", "there is no file \"missing.gltf\"; the asset is left out"},
        {"'uri':'../outside.gltf'", "leads out of the model's folder; the asset is left out"},
        {"'uri':'http://example.org/a.gltf'", "the asset is left out"},
        {"'uri':'broken.gltf'", "cannot be read, so that its nodes are empty"},
        {"'uri':'needs.gltf'", "requires the extension VENDOR_x, which facet does not support"},
        {"'name':'nothing'", "must have either a uri or a bufferView; the asset is left out"},
    };
    temporary_folder_put(&folder, "broken.gltf", "{\"asset\":", 9);
    put("needs.gltf", "'extensionsUsed':['VENDOR_x'],'extensionsRequired':['VENDOR_x']," LEAF("n"));
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char body[1024];
        snprintf(body, sizeof body,
                 "'files':[{%s,'mimeType':'model/gltf+json'}],'externalAssets':[{'file':0}],"
                 "'scene':0,'scenes':[{'nodes':[0]}],'nodes':[{'name':'A','externalAsset':0}]",
                 cases[i].file);
        facet_scene *scene = load_file(put("a.gltf", body));
        assert_int_equal(scene->node_count, 1);
        if (!has_warning(scene, cases[i].warning))
            fail_msg("no warning \"%s\", but \"%s\"", cases[i].warning,
                     scene->warning_count ? scene->warnings[0] : "");
        scene_destroy(scene);
    }
}

static void assets_that_nothing_shows_are_not_opened(void **state)
{
    (void)state;
    facet_scene *scene =
        load_file(put("a.gltf", REFERENCE("missing.gltf") "'scene':0,'scenes':[{'nodes':[0]}],"
                                                          "'nodes':[{},{'externalAsset':0}]"));
    assert_int_equal(scene->warning_count, 0);
    scene_destroy(scene);
    /* an asset without a default scene shows nothing */
    put("b.gltf", "'scenes':[{'nodes':[0]}],'nodes':[{}]");
    scene = load_file(put("a.gltf", REFERENCE("b.gltf") "'scene':0,'scenes':[{'nodes':[0]}],"
                                                        "'nodes':[{'externalAsset':0}]"));
    assert_int_equal(scene->nodes[0].child_count, 0);
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(assets_become_children),
        cmocka_unit_test(animations_and_skins_follow_their_nodes),
        cmocka_unit_test(assets_may_have_assets),
        cmocka_unit_test(cycles_are_refused_with_their_chain),
        cmocka_unit_test(depth_is_limited),
        cmocka_unit_test(expansion_is_counted_first),
        cmocka_unit_test(aliases_replace_URIs_of_the_asset_only),
        cmocka_unit_test(embedded_assets_start_in_the_folder_of_their_file),
        cmocka_unit_test(what_cannot_be_read_leaves_an_empty_node),
        cmocka_unit_test(assets_that_nothing_shows_are_not_opened),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
