/* mtl_write_test.c - written materials read back equal; glTF materials to the bit. */
#define _POSIX_C_SOURCE 200809L
#include "tests/support/support.h"
#include "io/obj/mtl_test_support.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "io/gltf/gltf.h"
#include "scene/legacy_extras.h"
#include "scene/material_table.h"

/* Text of the scene's materials; free() it. */
static char *write_mtl(const facet_scene *scene, const char *const *image_names,
                       const facet_scene_save_desc *desc)
{
    text t = {0};
    mtl_write(scene, "a test", image_names, desc, &t);
    assert_false(t.has_failed);
    char *copy = strdup(t.data);
    text_destroy(&t);
    return copy;
}

/* All that a material states, textures by number. */
static void assert_same_material(const legacy_material *a, const legacy_material *b)
{
    text first = {0};
    text second = {0};
    legacy_extras_write_material(a, NULL, &first);
    legacy_extras_write_material(b, NULL, &second);
    assert_string_equal(first.data, second.data);
    assert_string_equal(a->name, b->name);
    text_destroy(&first);
    text_destroy(&second);
}

static void assert_contains(const char *string, const char *part)
{
    if (!strstr(string, part))
        fail_msg("\"%s\" is not in:\n%s", part, string);
}

/* ---- statements ---- */

static const char LIBRARY[] =
    "newmtl all of it\nKa 0.1 0.2 0.3\nKd 0.5 0.5 0.5\nKs 1 2 3\nKe 10 0 0\nTf 0.9 0.8 0.7\nNs 96.078431\n"
    "Ni 1.45\nd -halo 0.25\nsharpness 100\nillum 7\nPr 0.2\nPm 0.3\nPs 0.4\nPc 0.5\nPcr 0.6\naniso -0.7\n"
    "anisor 0.8\nmap_Ka -o 0.1 0.2 -s 2 3 a.png\nmap_Kd -clamp on a.png\nmap_Ks -t 1 1 1 -mm 0.1 0.3 "
    "gone.tif\n"
    "bump a.png -bm 0.7\nnorm a.png\nmap_Pr -imfchan r a.png\nrefl -type sphere a.png\nmap_RMA a b "
    "-2.png\nkey 1 2\n"
    "refl -type cube_top b.png\nnewmtl plain\n";

static void all_statements_round_trip(void **state)
{
    (void)state;
    temporary_folder folder;
    temporary_folder_create(&folder);
    temporary_folder_put_png(&folder, "a.png");
    test_put_text(&folder, "a.mtl", LIBRARY);
    facet_scene *scene = mtl_load(folder.path, "a.mtl", NULL);
    const char *const names[] = {"a.png"};
    char *written = write_mtl(scene, names, NULL);
    assert_contains(written,
                    "# MTL file written by a test\n# 2 materials\n\nnewmtl all of it\nKa 0.1 0.2 0.3\n");
    assert_contains(written, "\nNs 96.07843\n");
    assert_contains(written, "\nd -halo 0.25\n");
    assert_contains(written, "\nillum 7\n");
    assert_contains(written, "\nmap_Ka -o 0.1 0.2 -s 2 3 a.png\n");
    assert_contains(written, "\nmap_Ks -t 1 1 1 -mm 0.1 0.3 gone.tif\n");
    assert_contains(written, "\nmap_Bump -bm 0.7 a.png\n");
    assert_contains(written, "\nmap_RMA \"a b -2.png\"\n");
    assert_contains(written, "\nkey 1 2\nrefl -type cube_top b.png\n");
    assert_contains(written, "\nnewmtl plain\nillum 1\n");
    assert_null(strstr(written, "#facet-gltf"));
    test_put_text(&folder, "b.mtl", written);
    facet_scene *again = mtl_load(folder.path, "b.mtl", NULL);
    assert_same_material(mtl_get(scene, 0), mtl_get(again, 0));
    assert_int_equal(again->legacy->dialect, FACET_MTL_DIALECT_SPEC);
    char *second = write_mtl(again, names, NULL);
    assert_string_equal(written, second);
    free(written);
    free(second);
    scene_destroy(again);
    scene_destroy(scene);
    temporary_folder_remove(&folder);
}

/* Offsets and scales without the text they were read from. */
static void offsets_are_short(void **state)
{
    (void)state;
    const double offsets[] = {0.1, 0.3, 0.7, 1.0 / 3.0, 12.5, 0.001};
    const double scales[] = {1, 2, 0.3, 7.7, -1};
    for (size_t i = 0; i < 6 * 5; i++)
        for (int is_flipped = 0; is_flipped < 2; is_flipped++) {
            char line[128];
            const facet_scene_desc desc = {.has_flipped_texcoords = is_flipped};
            const facet_scene_save_desc save = {.has_flipped_texcoords = is_flipped};
            snprintf(line, sizeof line, "newmtl a\nmap_Kd -o %.7g %.7g -s %.7g %.7g a.png\n", offsets[i / 5],
                     -offsets[i / 5], scales[i % 5], scales[i % 5]);
            facet_scene *scene = mtl_load_text(line, &desc);
            legacy_map *map = &scene->legacy->materials[0].maps[LEGACY_DIFFUSE_MAP];
            map->options = NULL;
            char *written = write_mtl(scene, NULL, &save);
            facet_scene *again = mtl_load_text(written, &desc);
            const scene_texture_ref *ref = &mtl_get(again, 0)->maps[LEGACY_DIFFUSE_MAP].ref;
            assert_memory_equal(ref->offset, map->ref.offset, sizeof ref->offset);
            assert_memory_equal(ref->scale, map->ref.scale, sizeof ref->scale);
            assert_true(strlen(written) < 150);
            free(written);
            scene_destroy(again);
            scene_destroy(scene);
        }
}

static void options_omit_statements(void **state)
{
    (void)state;
    facet_scene *scene = mtl_load_text(LIBRARY, NULL);
    const facet_scene_save_desc desc = {.omits_mtl_pbr = true, .mtl_shininess_scale = 2};
    scene->legacy->is_source = false;
    char *written = write_mtl(scene, NULL, &desc);
    const char *const absent[] = {"Pr ",   "Pm ",   "Ps ",   "Pc ",     "Pcr ",
                                  "aniso", "norm ", "map_P", "map_RMA", "#facet"};
    for (size_t i = 0; i < sizeof absent / sizeof *absent; i++)
        assert_null(strstr(written, absent[i]));
    assert_contains(written, "\nNs 192.15686\n");
    free(written);
    scene_destroy(scene);
}

static void illum_states_the_enabled_terms(void **state)
{
    (void)state;
    facet_scene *scene = mtl_load_text(
        "newmtl a\nKs 0 0 0\nnewmtl b\nKs 0 0.1 0\nnewmtl c\nKs 1\nnewmtl d\nmap_Ks x.png\n", NULL);
    scene->legacy->materials[2].is_lit = false;
    char *written = write_mtl(scene, NULL, NULL);
    assert_contains(written, "newmtl a\nKs 0 0 0\nillum 1\n");
    assert_contains(written, "newmtl b\nKs 0 0.1 0\nillum 2\n");
    assert_contains(written, "newmtl c\nKs 1 1 1\nillum 0\n");
    assert_contains(written, "newmtl d\nillum 2\n");
    free(written);
    scene_destroy(scene);
}

static void names_are_made_unique(void **state)
{
    (void)state;
    facet_scene *scene = mtl_load_text("newmtl a\nnewmtl b\nnewmtl c\nnewmtl d\nnewmtl e\n", NULL);
    const char *const given[] = {"x", "x", " x\n\ty\\", "", "x_2"};
    for (int i = 0; i < 5; i++)
        scene->legacy->materials[i].name = given[i];
    const char **names = mtl_names_create(scene, NULL);
    assert_string_equal(names[0], "x");
    assert_string_equal(names[1], "x_2");
    assert_string_equal(names[2], "x__y_");
    assert_string_equal(names[3], "material");
    assert_string_equal(names[4], "x_2_5");
    mem_free(names);
    scene_destroy(scene);
}

/* Names whose numbers are taken already: with all of them tried for each, this takes minutes. */
static void many_names_take_linear_time(void **state)
{
    (void)state;
    enum { HALF = 30000, ROOM = 24 };
    char(*text_of)[ROOM] = malloc(HALF * sizeof *text_of);
    legacy_material *materials = calloc(2 * HALF, sizeof *materials);
    assert_true(text_of && materials);
    for (size_t i = 0; i < HALF; i++) {
        snprintf(text_of[i], ROOM, "a_%zu", HALF + i);
        materials[i].name = text_of[i];
        materials[HALF + i].name = "a";
    }
    scene_legacy legacy = {.materials = materials};
    const facet_scene scene = {.material_count = 2 * HALF, .legacy = &legacy};
    clock_t start = clock();
    const char **names = mtl_names_create(&scene, NULL);
    assert_true((double)(clock() - start) / CLOCKS_PER_SEC < 5.0);
    assert_string_equal(names[HALF], "a");
    snprintf(text_of[0], ROOM, "a_%d", 3 * HALF - 2);
    assert_string_equal(names[2 * HALF - 1], text_of[0]);
    mem_free(names);
    free(materials);
    free(text_of);
}

/* Text that extras of a glTF file may hold begins no statements. */
static void text_from_extras_starts_no_statement(void **state)
{
    (void)state;
    facet_scene *scene = mtl_load_text("newmtl a\nKd 0.5 0.5 0.5\nmap_Kd -o 1 2 a.png\nrefl b.png\n"
                                       "newmtl b\nmap_Kd c.png\n",
                                       NULL);
    legacy_material *m = scene->legacy->materials;
    m[0].unknown =
        "key 1\nnewmtl evil\n  NEWMTL\tevil\rKd 0 1 0\n\tmap_Bump evil.png\nTr 0.5\nd 0.1\nillum 9\n"
        "#facet-gltf {}\n# Blender 2.70 MTL File\nmtllib evil.mtl\nKd spectral evil.rfl\n"
        "refl -type cube_top b.png\nlast \\";
    m[0].maps[LEGACY_DIFFUSE_MAP].options = "-o 1 2\nnewmtl evil\nKd 0 1 0";
    m[0].maps[LEGACY_REFLECTION_MAP].options = NULL;
    m[0].maps[LEGACY_REFLECTION_MAP].dropped = "-type sphere\nKd 0 1 0 -o 5 5";
    m[0].maps[LEGACY_REFLECTION_MAP].path = "b.png\nnewmtl evil";
    m[1].unknown = "refl evil.png\nkey 2\n";
    m[1].maps[LEGACY_DIFFUSE_MAP].options = "evil.png";
    m[1].maps[LEGACY_DIFFUSE_MAP].dropped = "evil.png\n-cc on";
    m[1].maps[LEGACY_DIFFUSE_MAP].path = "c.png";
    char *written = write_mtl(scene, NULL, NULL);
    facet_scene *again = mtl_load_text(written, NULL);
    assert_int_equal(again->material_count, 2);
    const legacy_material *a = mtl_get(again, 0);
    const legacy_material *b = mtl_get(again, 1);
    assert_near(a->diffuse[0], 0.5, 0);
    assert_near(a->opacity, 1, 0);
    assert_int_equal(a->illum, 1);
    assert_null(a->maps[LEGACY_BUMP_MAP].path);
    assert_string_equal(a->unknown, "key 1\nrefl -type cube_top b.png\nlast \\\n");
    assert_string_equal(a->maps[LEGACY_DIFFUSE_MAP].path, "a.png");
    assert_string_equal(a->maps[LEGACY_REFLECTION_MAP].path, "b.png_newmtl evil");
    assert_string_equal(b->unknown, "key 2\n");
    assert_string_equal(b->maps[LEGACY_DIFFUSE_MAP].path, "c.png");
    assert_null(b->maps[LEGACY_REFLECTION_MAP].path);
    assert_null(strstr(written, "\nnewmtl evil"));
    assert_null(strstr(written, "#facet-gltf"));
    assert_null(strstr(written, "Blender"));
    assert_null(strstr(written, "evil.png"));
    free(written);
    scene_destroy(again);
    scene_destroy(scene);
}

/* ---- glTF materials ---- */

/* A glTF model with every parameter and texture that a material can have, at values that are not the
 * defaults. */
static facet_scene *load_rich(temporary_folder *folder)
{
    temporary_folder_put_png(folder, "one.png");
    temporary_folder_put_png(folder, "two.png");
    text t = {0};
    text_add(&t, "{\"asset\":{\"version\":\"2.0\"},\"images\":[{\"uri\":\"one.png\"},{\"uri\":\"two.png\"}],"
                 "\"samplers\":[{\"magFilter\":9728,\"minFilter\":9984,\"wrapS\":33071,\"wrapT\":33648}],"
                 "\"textures\":[{\"source\":0},{\"source\":1,\"sampler\":0,\"name\":\"second\"}],"
                 "\"extensionsUsed\":[\"KHR_texture_transform\"");
    for (int i = 0; i < MATERIAL_EXTENSION_COUNT; i++)
        text_addf(&t, ",\"%s\"", material_extensions[i].name);
    text_add(&t,
             "],\"materials\":[{\"name\":\"rich "
             "\\u00e4\",\"alphaMode\":\"MASK\",\"alphaCutoff\":0.3,\"doubleSided\":true,"
             "\"extras\":{\"image\":{\"image\":7},\"list\":[0.1,1e300]},\"emissiveFactor\":[0.1,0.2,0.3],"
             "\"normalTexture\":{\"index\":1,\"scale\":0.7},"
             "\"occlusionTexture\":{\"index\":0,\"strength\":0.4},"
             "\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.1,0.2,0.30000001,0.4],\"metallicFactor\":0.25,"
             "\"roughnessFactor\":0.3333333,\"baseColorTexture\":{\"index\":1,\"extensions\":{"
             "\"KHR_texture_transform\":{\"offset\":[0.1,0.2],\"rotation\":0.5,\"scale\":[2,3]}}}},"
             "\"extensions\":{\"KHR_materials_clearcoat\":{\"clearcoatFactor\":0.5,\"clearcoatTexture\":{"
             "\"index\":0},"
             "\"clearcoatNormalTexture\":{\"index\":1,\"scale\":2}},\"KHR_materials_ior\":{\"ior\":1.7},"
             "\"KHR_materials_specular\":{\"specularFactor\":0.6,\"specularColorFactor\":[1,0.5,0.25]},"
             "\"KHR_materials_volume\":{\"thicknessFactor\":0.5,\"attenuationDistance\":3},"
             "\"KHR_materials_iridescence\":{\"iridescenceFactor\":0.5},"
             "\"KHR_materials_sheen\":{\"sheenColorFactor\":[0.1,0.2,0.3]}}},"
             "{\"extensions\":{\"KHR_materials_unlit\":{}}},"
             "{\"name\":\"sg\",\"extensions\":{\"KHR_materials_pbrSpecularGlossiness\":{\"diffuseFactor\":"
             "[0.5,0.5,0.5,1],\"glossinessFactor\":0.7,\"diffuseTexture\":{\"index\":0}}}}]}");
    temporary_folder_put(folder, "rich.gltf", t.data, t.length);
    text_destroy(&t);
    facet_scene *scene = NULL;
    facet_error error = {0};
    if (gltf_load(temporary_folder_file(folder, "rich.gltf"), NULL, &scene, &error) != FACET_OK)
        fail_msg("%s", error.message);
    assert_int_equal(scene->warning_count, 0);
    scene_legacy *legacy = arena_zalloc(scene->arena, 1, sizeof *legacy);
    legacy->materials = arena_alloc(scene->arena, scene->material_count, sizeof *legacy->materials);
    legacy->colors = FACET_LEGACY_COLORS_SRGB;
    legacy->dialect = FACET_MTL_DIALECT_SPEC;
    for (uint32_t i = 0; i < scene->material_count; i++) { /* as a conversion sets it */
        legacy_material *m = &legacy->materials[i];
        *m = legacy_material_default();
        m->name = scene->materials[i].name;
        m->fields = LEGACY_DIFFUSE | LEGACY_SPECULAR | LEGACY_SHININESS | LEGACY_ROUGHNESS;
        m->diffuse[0] = 0.123456f;
        m->shininess = 17.3f;
        m->roughness = 1.0f / 3.0f;
        m->maps[LEGACY_DIFFUSE_MAP].ref = scene->materials[i].textures[SCENE_BASE_COLOR_TEXTURE];
    }
    scene->legacy = legacy;
    return scene;
}

static void assert_same_texture(const facet_scene *a, const scene_texture_ref *x, const facet_scene *b,
                                const scene_texture_ref *y)
{
    assert_int_equal(x->texture == SCENE_NONE, y->texture == SCENE_NONE);
    assert_int_equal(x->texcoord, y->texcoord);
    assert_memory_equal(x->transform, y->transform, sizeof x->transform);
    if (x->texture == SCENE_NONE)
        return;
    const scene_texture *t = &a->textures[x->texture];
    const scene_texture *u = &b->textures[y->texture];
    assert_string_equal(t->name, u->name);
    assert_int_equal(t->wrap_u, u->wrap_u);
    assert_int_equal(t->wrap_v, u->wrap_v);
    assert_int_equal(t->mag_filter, u->mag_filter);
    assert_int_equal(t->min_filter, u->min_filter);
    assert_int_equal(t->mip_filter, u->mip_filter);
    assert_string_equal(path_base_name(a->images[t->image].uri), path_base_name(b->images[u->image].uri));
}

static void assert_same_gltf(const facet_scene *a, const facet_scene *b, uint32_t index)
{
    const scene_material *m = &a->materials[index];
    const scene_material *n = &b->materials[index];
    assert_string_equal(m->name, n->name);
    assert_int_equal(m->extensions, n->extensions);
    assert_int_equal(m->alpha_mode, n->alpha_mode);
    assert_int_equal(m->is_double_sided, n->is_double_sided);
    assert_int_equal(m->meta.extras != NULL, n->meta.extras != NULL);
    if (m->meta.extras)
        assert_string_equal(m->meta.extras, n->meta.extras);
    for (int i = 0; i < MATERIAL_PARAMETER_COUNT; i++)
        assert_memory_equal(material_floats_const(m, &material_parameters[i]),
                            material_floats_const(n, &material_parameters[i]),
                            material_parameters[i].count * sizeof(float));
    for (int i = 0; i < SCENE_TEXTURE_SLOT_COUNT; i++)
        assert_same_texture(a, &m->textures[i], b, &n->textures[i]);
}

static void gltf_materials_round_trip(void **state)
{
    (void)state;
    temporary_folder folder;
    temporary_folder_create(&folder);
    facet_scene *scene = load_rich(&folder);
    const char *const names[] = {"one.png", "two.png"};
    char *written = write_mtl(scene, names, NULL);
    test_put_text(&folder, "rich.mtl", written);
    facet_scene *again = mtl_load(folder.path, "rich.mtl", NULL);
    assert_int_equal(again->material_count, 3);
    assert_int_equal(again->warning_count, 0);
    for (uint32_t i = 0; i < 3; i++) {
        assert_true(mtl_get(again, i)->is_gltf_restored);
        assert_same_gltf(scene, again, i);
    }
    const char *const found[] = {again->images[0].uri, again->images[1].uri}; /* in the order of their use */
    char *second = write_mtl(again, found, NULL); /* from MTL now, and still with the comments */
    assert_string_equal(written, second);
    free(written);
    free(second);
    scene_destroy(again);
    scene_destroy(scene);
    temporary_folder_remove(&folder);
}

/* The comment is void once a statement differs. White space and a new name do not matter. */
static void changed_statements_override_the_comment(void **state)
{
    (void)state;
    temporary_folder folder;
    temporary_folder_create(&folder);
    facet_scene *scene = load_rich(&folder);
    const char *const names[] = {"one.png", "two.png"};
    char *written = write_mtl(scene, names, NULL);
    const struct {
        const char *from, *to;
        bool is_restored;
    } edits[] = {
        {"Ns 17.3\n", "  ns   1.73000e1 \n", true}, {"Ns 17.3\n", "Ns 17.4\n", false},
        {"newmtl rich", "newmtl poor", true},       {"Pr 0.33333334\n", "", false},
        {"two.png\n", "one.png\n", false},          {"Ns 17.3\n", "Ns 17.3\nKe 0 0 0\n", false},
        {"#facet-gltf {", "#facet-gltf [", false},  {"\"facet\":{", "\"other\":{", false},
    };
    for (size_t i = 0; i < sizeof edits / sizeof *edits; i++) {
        char *at = strstr(written, edits[i].from);
        assert_non_null(at);
        text t = {0};
        text_add_bytes(&t, written, (size_t)(at - written));
        text_add(&t, edits[i].to);
        text_add(&t, at + strlen(edits[i].from));
        temporary_folder_put(&folder, "edited.mtl", t.data, t.length);
        text_destroy(&t);
        facet_scene *again = mtl_load(folder.path, "edited.mtl", NULL);
        assert_int_equal(mtl_get(again, 0)->is_gltf_restored, edits[i].is_restored);
        assert_true(mtl_get(again, 1)->is_gltf_restored);
        assert_int_equal(again->materials[0].extensions != 0, edits[i].is_restored);
        if (i == 2)
            assert_string_equal(again->materials[0].name, "poor \xc3\xa4");
        assert_int_equal(again->warning_count, i == 6);
        scene_destroy(again);
    }
    /* A texture that is gone is a warning and leaves its place empty. */
    remove(temporary_folder_file(&folder, "one.png"));
    test_put_text(&folder, "rich.mtl", written);
    facet_scene *again = mtl_load(folder.path, "rich.mtl", NULL);
    assert_true(mtl_get(again, 0)->is_gltf_restored);
    assert_int_equal(again->materials[0].textures[SCENE_OCCLUSION_TEXTURE].texture, SCENE_NONE);
    assert_true(scene_material_has(&again->materials[0], SCENE_NORMAL_TEXTURE));
    assert_int_equal(mtl_count_warnings(again, "there is no file \"one.png\""), again->warning_count);
    assert_true(again->warning_count > 0);
    scene_destroy(again);
    free(written);
    scene_destroy(scene);
    temporary_folder_remove(&folder);
}

static void broken_comments_are_warnings(void **state)
{
    (void)state;
    static const char *const json[] = {"{",
                                       "[]",
                                       "7",
                                       "",
                                       "{\"facet\":{},\"pbrMetallicRoughness\":3}",
                                       "{\"facet\":{},\"normalTexture\":{\"image\":\"a.png\",\"index\":-3}}",
                                       "{\"facet\":{},\"normalTexture\":{\"image\":null,\"sampler\":[]}}"};
    for (size_t i = 0; i < sizeof json / sizeof *json; i++) {
        char library[256];
        snprintf(library, sizeof library, "newmtl a\n#facet-gltf %s\n", json[i]);
        facet_scene *scene = mtl_load_text(library, NULL);
        assert_int_equal(scene->material_count, 1);
        assert_true(scene->warning_count > 0);
        assert_true(strstr(scene->warnings[0], "#facet-gltf") || strstr(scene->warnings[0], "a.png") ||
                    strstr(scene->warnings[0], "sampler"));
        scene_destroy(scene);
    }
}

static void failed_allocations_are_reported(void **state)
{
    (void)state;
    temporary_folder folder;
    temporary_folder_create(&folder);
    facet_scene *scene = load_rich(&folder);
    const char *const names[] = {"one.png", "two.png"};
    char *written = write_mtl(scene, names, NULL);
    bool is_done = false;
    for (long fail_at = 0; !is_done; fail_at = next_failure(fail_at)) {
        assert_true(fail_at < 1000);
        failing_allocator f = {.fail_at = fail_at};
        const facet_scene_save_desc desc = {.allocator = failing_allocator_get(&f)};
        text t = {.allocator = desc.allocator};
        mtl_write(scene, "a test", names, &desc, &t);
        is_done = atomic_load(&f.calls) <= fail_at;
        assert_true(is_done || t.has_failed);
        if (is_done)
            assert_string_equal(t.data, written);
        text_destroy(&t);
        assert_int_equal(atomic_load(&f.blocks), 0);
    }
    free(written);
    scene_destroy(scene);
    temporary_folder_remove(&folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_statements_round_trip),
        cmocka_unit_test(offsets_are_short),
        cmocka_unit_test(options_omit_statements),
        cmocka_unit_test(illum_states_the_enabled_terms),
        cmocka_unit_test(names_are_made_unique),
        cmocka_unit_test(many_names_take_linear_time),
        cmocka_unit_test(text_from_extras_starts_no_statement),
        cmocka_unit_test(gltf_materials_round_trip),
        cmocka_unit_test(changed_statements_override_the_comment),
        cmocka_unit_test(broken_comments_are_warnings),
        cmocka_unit_test(failed_allocations_are_reported),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
