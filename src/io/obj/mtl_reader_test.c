/* mtl_reader_test.c - statements of MTL files as different programs write them: values, maps, comments,
 * dialects. */
#include "io/obj/mtl_test_support.h"

#include <stdio.h>
#include <string.h>

#include "tests/support/support.h"
#include "image/srgb.h"
#include "io/obj/mtl_parts.h"

#define FLOATS(actual, a, b, c)                                                                              \
    do {                                                                                                     \
        assert_near((actual)[0], a, 1e-6);                                                                   \
        assert_near((actual)[1], b, 1e-6);                                                                   \
        assert_near((actual)[2], c, 1e-6);                                                                   \
    } while (0)

/* ---- statements ---- */

static void all_statements_are_read(void **state)
{
    (void)state;
    facet_scene *scene =
        mtl_load_text("newmtl all\nKa .1 .2 .3\nKd 0.5\nKs 1 2 3\nKe 1e1 0 0\nTf 0.9 0.8 0.7\n"
                      "Ns 96.078431\nNi 1.45\nd 0.25\nsharpness 100\nillum 7\nPr 0.2\nPm 0.3\n"
                      "Ps 0.4\nPc 0.5\nPcr 0.6\naniso -0.7\nanisor 0.8\nfoo bar 1\nmap_aat on\n",
                      NULL);
    const legacy_material *m = mtl_get(scene, 0);
    assert_string_equal(m->name, "all");
    assert_string_equal(scene->materials[0].name, "all");
    assert_int_equal(m->fields, 0x1ffff);
    FLOATS(m->ambient, 0.1, 0.2, 0.3);
    FLOATS(m->diffuse, 0.5, 0.5, 0.5);
    FLOATS(m->specular, 1, 2, 3);
    FLOATS(m->emission, 10, 0, 0);
    FLOATS(m->transmission_filter, 0.9, 0.8, 0.7);
    assert_near(m->shininess, 96.078431, 1e-5);
    assert_near(m->ior, 1.45, 1e-6);
    assert_near(m->opacity, 0.25, 0);
    assert_near(m->sharpness, 100, 0);
    assert_int_equal(m->illum, 7);
    assert_near(m->roughness, 0.2, 1e-7);
    assert_near(m->metallic, 0.3, 1e-7);
    assert_near(m->sheen, 0.4, 1e-7);
    assert_near(m->clearcoat, 0.5, 0);
    assert_near(m->clearcoat_roughness, 0.6, 1e-7);
    assert_near(m->anisotropy, -0.7, 1e-7);
    assert_near(m->anisotropy_rotation, 0.8, 1e-7);
    assert_string_equal(m->unknown, "foo bar 1\nmap_aat on\n");
    assert_int_equal(scene->warning_count, 0);
    assert_true(scene->legacy->is_source);
    scene_destroy(scene);
}

static void unstated_values_are_absent(void **state)
{
    (void)state;
    facet_scene *scene = mtl_load_text("newmtl none\n", NULL);
    const legacy_material *m = mtl_get(scene, 0);
    const legacy_material defaults = legacy_material_default();
    assert_int_equal(m->fields, 0);
    assert_int_equal(m->illum, -1);
    FLOATS(m->diffuse, 0.8, 0.8, 0.8);
    assert_near(m->opacity, defaults.opacity, 0);
    assert_null(m->unknown);
    assert_false(m->is_transparency_ambiguous);
    scene_destroy(scene);
}

/* A byte order mark, CRLF and CR, tabs, blanks at the ends, case, continued lines, comments behind values. */
static void odd_spellings_of_lines_are_read(void **state)
{
    (void)state;
    facet_scene *scene = mtl_load_text(
        "\xef\xbb\xbf# a comment \\\r\n  NEWMTL  two words \t\r\n\tkD\t.5 \\\r\n .25   1 # red\r\n"
        "KS 1 0 0\rnS 10 #100\r\r\n   \t\n#d 0\nNewMtl b\nILLUM 2",
        NULL);
    assert_int_equal(scene->material_count, 2);
    const legacy_material *m = mtl_get(scene, 0);
    assert_string_equal(m->name, "two words");
    FLOATS(m->diffuse, 0.5, 0.25, 1);
    FLOATS(m->specular, 1, 0, 0);
    assert_near(m->shininess, 10, 0);
    assert_int_equal(m->fields, LEGACY_DIFFUSE | LEGACY_SPECULAR | LEGACY_SHININESS);
    assert_int_equal(mtl_get(scene, 1)->illum, 2);
    assert_int_equal(scene->warning_count, 0);
    scene_destroy(scene);
}

static void invalid_values_are_clamped_or_ignored(void **state)
{
    (void)state;
    facet_scene *scene = mtl_load_text("newmtl a\nKd nan 0 0\nKs -1 0 2e10\nNs inf\nNs -5\nd 7\nillum 11\n"
                                       "illum 1.5\nPr x\nKe\nmap_Kd\nmtllib other.mtl\nNi 1e400\n",
                                       NULL);
    const legacy_material *m = mtl_get(scene, 0);
    assert_int_equal(m->fields, LEGACY_SPECULAR | LEGACY_SHININESS | LEGACY_OPACITY);
    FLOATS(m->specular, 0, 0, 1e9);
    assert_near(m->shininess, 0, 0);
    assert_near(m->opacity, 1, 0);
    assert_null(m->maps[LEGACY_DIFFUSE_MAP].path);
    assert_int_equal(mtl_count_warnings(scene, "a.mtl: line 2: Kd: \"nan\" is not a number"), 1);
    assert_int_equal(mtl_count_warnings(scene, "a.mtl: line 3: Ks: has components below 0 or above 1e+09"),
                     1);
    assert_int_equal(mtl_count_warnings(scene, "line 4: Ns: \"inf\" is not a number"), 1);
    assert_int_equal(mtl_count_warnings(scene, "line 5: Ns: -5 is not in [0, 1e+06]; 0 is used"), 1);
    assert_int_equal(mtl_count_warnings(scene, "line 6: d: 7 is not in [0, 1]; 1 is used"), 1);
    assert_int_equal(mtl_count_warnings(scene, "illum: \"11\" is not one of 0, 1, .. 10"), 1);
    assert_int_equal(mtl_count_warnings(scene, "illum: \"1.5\""), 1);
    assert_int_equal(mtl_count_warnings(scene, "line 9: Pr: \"x\""), 1);
    assert_int_equal(mtl_count_warnings(scene, "line 10: Ke: \"\""), 1);
    assert_int_equal(mtl_count_warnings(scene, "line 11: map_Kd: names no file"), 1);
    assert_int_equal(mtl_count_warnings(scene, "line 12: mtllib is not a statement of an MTL file"), 1);
    assert_int_equal(mtl_count_warnings(scene, "line 13: Ni"), 1);
    assert_int_equal(scene->warning_count, 12);
    scene_destroy(scene);
}

static void names_count_once(void **state)
{
    (void)state;
    facet_scene *scene =
        mtl_load_text("Kd 1 1 1\nNs 3\nnewmtl a\nKd .1\nnewmtl b\nnewmtl a\nKd .9\nbogus\n", NULL);
    assert_int_equal(scene->material_count, 2);
    assert_near(mtl_get(scene, 0)->diffuse[0], 0.1, 1e-7);
    assert_null(mtl_get(scene, 0)->unknown);
    assert_int_equal(mtl_count_warnings(scene, "line 1: \"Kd\" stands before the first newmtl"), 1);
    assert_int_equal(mtl_count_warnings(scene, "line 6: material \"a\" is defined more than once"), 1);
    assert_int_equal(scene->warning_count, 2);
    scene_destroy(scene);
}

/* Latin-1, and a name in UTF-8 that is the same word: three materials stay three. */
static void names_become_utf8(void **state)
{
    (void)state;
    facet_scene *scene = mtl_load_text("newmtl caf\xe9\nnewmtl caf\xc3\xa9\nnewmtl caf\xea\n", NULL);
    assert_int_equal(scene->material_count, 3);
    assert_string_equal(scene->materials[0].name, "caf\xc3\xa9_2");
    assert_string_equal(scene->materials[1].name, "caf\xc3\xa9");
    assert_string_equal(scene->materials[2].name, "caf\xc3\xaa");
    assert_string_equal(scene->legacy->materials[2].name, "caf\xc3\xaa");
    assert_int_equal(
        mtl_count_warnings(scene, "is not UTF-8; its bytes are taken as Latin-1, as those of others"), 1);
    scene_destroy(scene);
}

static void transparency_is_settled(void **state)
{
    (void)state;
    facet_scene *scene =
        mtl_load_text("newmtl a\nTr .25\nnewmtl b\nd .75\nTr .5\nnewmtl c\nTr .5\nd .75\nnewmtl d\n"
                      "d .9\nTr .1\nnewmtl e\nd -halo .5\nnewmtl f\nmap_Tr x.png\nnewmtl g\n"
                      "map_d d.png\nmap_Tr x.png\n",
                      NULL);
    const struct {
        double opacity;
        bool is_ambiguous, is_halo;
    } expected[] = {{0.75, true, false}, {0.75, true, false}, {0.75, true, false}, {0.9, false, false},
                    {0.5, false, true},  {1, true, false},    {1, false, false}};
    for (uint32_t i = 0; i < 7; i++) {
        const legacy_material *m = mtl_get(scene, i);
        assert_near(m->opacity, expected[i].opacity, 1e-7);
        assert_int_equal(m->is_transparency_ambiguous, expected[i].is_ambiguous);
        assert_int_equal(m->is_halo, expected[i].is_halo);
        assert_int_equal(legacy_has(m, LEGACY_OPACITY), i < 5);
    }
    assert_string_equal(mtl_get(scene, 5)->maps[LEGACY_OPACITY_MAP].path, "x.png");
    assert_string_equal(mtl_get(scene, 6)->maps[LEGACY_OPACITY_MAP].path, "d.png");
    scene_destroy(scene);
}

/* ---- colors ---- */

static void colors_may_be_xyz(void **state)
{
    (void)state;
    /* The white of D65 is white, and its green primary's coordinates are green (IEC 61966-2-1). */
    const char *library = "newmtl a\nKd xyz 0.9505 1 1.089\nKs xyz 0.17879 0.35758 0.05960\nKe xyz 1\n";
    const facet_scene_desc linear = {.legacy = {.colors = FACET_LEGACY_COLORS_LINEAR}};
    facet_scene *scene = mtl_load_text(library, &linear);
    const legacy_material *m = mtl_get(scene, 0);
    for (int i = 0; i < 3; i++) {
        assert_near(m->diffuse[i], 1, 2e-4);
        assert_near(m->specular[i], i == 1 ? 0.5 : 0, 1e-4);
    }
    assert_near(m->emission[0], 1.2048, 1e-4); /* equal energy: a row's sum */
    assert_int_equal(scene->legacy->colors, FACET_LEGACY_COLORS_LINEAR);
    scene_destroy(scene);
    scene = mtl_load_text(library, NULL);
    assert_near(mtl_get(scene, 0)->specular[1], srgb_encode(0.5), 1e-4);
    assert_int_equal(scene->legacy->colors, FACET_LEGACY_COLORS_SRGB);
    scene_destroy(scene);
}

static void colors_may_be_spectra(void **state)
{
    (void)state;
    temporary_folder folder;
    temporary_folder_create(&folder);
    test_put_text(&folder, "white.rfl", "spectrum\n400 1\n700 1\n");
    test_put_text(&folder, "red one.rfl", "# nm\n0.38 0\n0.59 0\n0.6 1\n0.78 1\n");
    test_put_text(&folder, "bad.rfl", "500 1\n400 1\n");
    test_put_text(&folder, "a.mtl",
                  "newmtl a\nKd spectral white.rfl 0.5\nKs spectral red one.rfl\nKe spectral none.rfl 2\n"
                  "Ka spectral bad.rfl\nTf spectral\n");
    const facet_scene_desc linear = {.legacy = {.colors = FACET_LEGACY_COLORS_LINEAR}};
    facet_scene *scene = mtl_load(folder.path, "a.mtl", &linear);
    const legacy_material *m = mtl_get(scene, 0);
    FLOATS(m->diffuse, 0.5, 0.5, 0.5); /* a flat reflectance is gray in any light */
    assert_true(m->specular[0] > 0.7f && m->specular[1] < 0.1f && m->specular[2] < 0.02f);
    assert_int_equal(m->fields, LEGACY_DIFFUSE | LEGACY_SPECULAR);
    assert_int_equal(
        mtl_count_warnings(scene, "line 4: Ke: the spectrum cannot be read: there is no file \"none.rfl\""),
        1);
    assert_int_equal(mtl_count_warnings(scene, "line 5: Ka: \"bad.rfl\" is not a list of wavelengths"), 1);
    assert_int_equal(mtl_count_warnings(scene, "line 6: Tf: the spectrum cannot be read: names no file"), 1);
    scene_destroy(scene);
    temporary_folder_remove(&folder);
}

/* ---- maps ---- */

/* -o and -s in MTL's coordinates are the map's offset and scale in glTF's: checked by transforming a
 * point both ways. */
static void offset_and_scale_are_converted(void **state)
{
    (void)state;
    facet_scene *scene =
        mtl_load_text("newmtl a\nmap_Kd -o 0.1 0.2 -s 2 3 a.png\nmap_Ks -s 2 a.png\n"
                      "map_Ke -o 0 0.25 0 a.png\nmap_Ns -s 1.0 1.0 1.0 -o 0.0 0.0 0.0 a.png\n",
                      NULL);
    const legacy_material *m = mtl_get(scene, 0);
    const double o[4][2] = {{0.1, 0.2}, {0, 0}, {0, 0.25}, {0, 0}};
    const double s[4][2] = {{2, 3}, {2, 1}, {1, 1}, {1, 1}};
    const legacy_map_slot slots[4] = {LEGACY_DIFFUSE_MAP, LEGACY_SPECULAR_MAP, LEGACY_EMISSION_MAP,
                                      LEGACY_SHININESS_MAP};
    for (int i = 0; i < 4; i++) {
        const scene_texture_ref *ref = &m->maps[slots[i]].ref;
        const double u = 0.3;
        const double v = 0.7; /* up */
        const float *t = ref->transform;
        double gltf_u = (double)t[0] * u + (double)t[1] * (1 - v) + (double)t[2];
        double gltf_v = (double)t[3] * u + (double)t[4] * (1 - v) + (double)t[5];
        assert_near(gltf_u, s[i][0] * u + o[i][0], 1e-6);
        assert_near(1 - gltf_v, s[i][1] * v + o[i][1], 1e-6);
        assert_int_equal(ref->has_transform, i < 3);
    }
    scene_destroy(scene);
    const facet_scene_desc flipped = {.has_flipped_texcoords = true};
    scene = mtl_load_text("newmtl a\nmap_Kd -o 0.1 0.2 -s 2 3 a.png\n", &flipped);
    assert_near(mtl_get(scene, 0)->maps[LEGACY_DIFFUSE_MAP].ref.offset[1], 0.2, 1e-7);
    scene_destroy(scene);
}

static void options_are_read(void **state)
{
    (void)state;
    facet_scene *scene = mtl_load_text(
        "newmtl a\nmap_Kd -BlendU off -mm 0.1 0.3 -imfchan M -cc on -boost 2 -t 0 1 -texres 512 my file.png\n"
        "bump  bump 2.jpg -bm 1.5\t-imfchan r \nmap_Ks -blendu on -cc off -t 0 0 0 -boost 0 s.png # shiny\n"
        "map_d \"a -bm 3 b.png\" -clamp on\nrefl -type sphere r.png\nrefl -type cube_top t.png\n"
        "disp -bm d.png\ndecal -o 1 2 3 e.png\nnorm -2.png\nmap_RMA o.png\n",
        NULL);
    const legacy_material *m = mtl_get(scene, 0);
    const legacy_map *map = &m->maps[LEGACY_DIFFUSE_MAP];
    assert_string_equal(map->path, "my file.png");
    assert_string_equal(map->dropped, "-BlendU off -cc on -boost 2 -t 0 1 -texres 512");
    assert_string_equal(map->options,
                        "-BlendU off -mm 0.1 0.3 -imfchan M -cc on -boost 2 -t 0 1 -texres 512");
    assert_near(map->base, 0.1, 1e-7);
    assert_near(map->gain, 0.3, 1e-7);
    assert_int_equal(map->channel, 'm');
    map = &m->maps[LEGACY_BUMP_MAP];
    assert_string_equal(map->path, "bump 2.jpg");
    assert_near(map->bump_multiplier, 1.5, 0);
    assert_int_equal(map->channel, 'r');
    assert_string_equal(map->options, "-bm 1.5 -imfchan r");
    assert_string_equal(m->maps[LEGACY_SPECULAR_MAP].path, "s.png");
    assert_null(m->maps[LEGACY_SPECULAR_MAP].dropped);
    assert_string_equal(m->maps[LEGACY_OPACITY_MAP].path, "a -bm 3 b.png");
    assert_string_equal(m->maps[LEGACY_OPACITY_MAP].options, "-clamp on");
    assert_string_equal(m->maps[LEGACY_REFLECTION_MAP].path, "r.png");
    assert_string_equal(m->maps[LEGACY_DISPLACEMENT_MAP].path, "d.png");
    assert_string_equal(m->maps[LEGACY_DECAL_MAP].dropped, "-o 1 2 3");
    assert_string_equal(m->maps[LEGACY_NORMAL_MAP].path, "-2.png");
    assert_string_equal(m->maps[LEGACY_ORM_MAP].path, "o.png");
    assert_true(m->is_rma);
    assert_string_equal(m->unknown, "refl -type cube_top t.png\n");
    assert_int_equal(mtl_count_warnings(scene, "line 8: disp: -bm lacks its value"), 1);
    scene_destroy(scene);
}

/* ---- comments ---- */

/* Members outside of materials are ignored, whatever they contain. */
static void unknown_members_are_ignored(void **state)
{
    (void)state;
    temporary_folder folder;
    temporary_folder_create(&folder);
    temporary_folder_put_png(&folder, "a.png");
    text t = {0};
    text_add(
        &t,
        "newmtl a\nillum 2\n#facet-gltf {\"facet\":{\"illum\":2},\"normalTexture\":{\"image\":\"a.png\"}");
    for (int i = 0; i < 1000; i++)
        text_addf(&t, ",\"t%d\":{\"image\":\"a.png\",\"name\":\"%d\"}", i, i);
    text_add(&t, "}\n");
    temporary_folder_put(&folder, "a.mtl", t.data, t.length);
    facet_scene *scene = mtl_load(folder.path, "a.mtl", NULL);
    assert_true(mtl_get(scene, 0)->is_gltf_restored);
    assert_true(scene_material_has(&scene->materials[0], SCENE_NORMAL_TEXTURE));
    assert_int_equal(scene->texture_count, 1);
    assert_int_equal(scene->warning_count, 0);
    scene_destroy(scene);
    text_destroy(&t);
    temporary_folder_remove(&folder);
}

/* OBJ has one set of coordinates: textures that read another one are left out, and the one that is written
 * is called
 * 0. */
static void one_texcoord_set_round_trips(void **state)
{
    (void)state;
    static const char statements[] = "map_Kd a.png\n";
    temporary_folder folder;
    temporary_folder_create(&folder);
    temporary_folder_put_png(&folder, "a.png");
    test_put_text(&folder, "a.mtl", "newmtl a\nmap_Kd a.png\n");
    facet_scene *scene = mtl_load(folder.path, "a.mtl", NULL);
    scene_texture_ref *refs = scene->materials[0].textures;
    for (uint32_t written = 0; written < 2; written++) {
        const facet_scene_save_desc desc = {0};
        const char *const images[] = {"a.png"};
        text t = {0};
        refs[SCENE_BASE_COLOR_TEXTURE] = (scene_texture_ref){.texcoord = written, .scale = {1, 1}};
        refs[SCENE_OCCLUSION_TEXTURE] = (scene_texture_ref){.texcoord = 1 - written, .scale = {1, 1}};
        scene->legacy->materials[0].maps[LEGACY_DIFFUSE_MAP].ref.texcoord = written;
        text_addf(&t, "newmtl a\n%s#facet-gltf ", statements);
        mtl_gltf_write(scene, 0, "a", statements, images, &desc, &t);
        temporary_folder_put(&folder, "b.mtl", t.data, t.length);
        facet_scene *again = mtl_load(folder.path, "b.mtl", NULL);
        const scene_material *m = &again->materials[0];
        assert_true(mtl_get(again, 0)->is_gltf_restored);
        assert_true(scene_material_has(m, SCENE_BASE_COLOR_TEXTURE));
        assert_int_equal(m->textures[SCENE_BASE_COLOR_TEXTURE].texcoord, 0);
        assert_false(scene_material_has(m, SCENE_OCCLUSION_TEXTURE));
        assert_int_equal(mtl_count_warnings(again, "material \"a\": occlusionTexture reads another set"), 1);
        scene_destroy(again);
        text_destroy(&t);
    }
    scene_destroy(scene);
    scene =
        mtl_load_text("newmtl t\n#facet-gltf {\"facet\":{\"illum\":2},\"normalTexture\":{\"image\":\"a.png\","
                      "\"extensions\":{\"KHR_texture_transform\":{\"texCoord\":1}}}}\nillum 2\n",
                      NULL);
    assert_true(mtl_get(scene, 0)->is_gltf_restored);
    assert_false(scene_material_has(&scene->materials[0], SCENE_NORMAL_TEXTURE));
    assert_int_equal(mtl_count_warnings(scene, "material \"t\": normalTexture reads another set"), 1);
    scene_destroy(scene);
    temporary_folder_remove(&folder);
}

/* ---- names of materials ---- */

static void materials_are_found_by_name(void **state)
{
    (void)state;
    const facet_scene_desc desc = {0};
    facet_scene *scene = NULL;
    mtl_reader *reader = NULL;
    assert_int_equal(scene_create(NULL, "test.obj", &scene, NULL), FACET_OK);
    assert_int_equal(mtl_reader_create(scene, &desc, NULL, &reader, NULL), FACET_OK);
    assert_int_equal(mtl_reader_find(reader, "m0", 2), SCENE_NONE);
    char name[16];
    for (unsigned i = 0; i < 1000; i++) {
        int length = snprintf(name, sizeof name, "m%u", i);
        assert_int_equal(mtl_reader_add(reader, name, (size_t)length), i);
    }
    for (unsigned i = 0; i < 1000; i++) {
        int length = snprintf(name, sizeof name, "m%u and", i) - 4;
        assert_int_equal(mtl_reader_find(reader, name, (size_t)length), i);
    }
    assert_int_equal(mtl_reader_find(reader, "m", 1), SCENE_NONE);
    assert_int_equal(mtl_reader_finish(reader, NULL), FACET_OK);
    assert_int_equal(scene->material_count, 1000);
    assert_string_equal(scene->legacy->materials[999].name, "m999");
    mtl_reader_destroy(reader);
    scene_destroy(scene);
}

/* ---- dialects ---- */

static void dialects_are_detected_by_comments(void **state)
{
    (void)state;
    const struct {
        const char *obj, *mtl;
        facet_mtl_dialect dialect;
        bool is_guessed;
    } cases[] = {
        {"", "# made by hand\nnewmtl a\n", FACET_MTL_DIALECT_SPEC, false},
        {"", "# 3ds Max Wavefront OBJ Exporter v0.97b\nnewmtl a\n", FACET_MTL_DIALECT_SPEC, true},
        {"", "# Blender MTL File: 'None'\nnewmtl a\nNs 96.078431\n", FACET_MTL_DIALECT_BLENDER27, true},
        {"", "# Blender MTL File: 'None'\nnewmtl a\nNs 225.000000\n", FACET_MTL_DIALECT_BLENDER28, true},
        {"", "# Blender MTL File: 'None'\nnewmtl a\nNs 0\n", FACET_MTL_DIALECT_BLENDER27, true},
        {" Blender v2.78 (sub 0) OBJ File: ''", "# Blender MTL File: ''\nnewmtl a\nNs 225\n",
         FACET_MTL_DIALECT_BLENDER27, true},
        {" Blender v2.93.1 OBJ File: ''", "# Blender MTL File: ''\nnewmtl a\n", FACET_MTL_DIALECT_BLENDER28,
         true},
        {" Blender v3.0.0 OBJ File: ''", "newmtl a\n", FACET_MTL_DIALECT_BLENDER28, true},
        {" Blender 3.3.0", "newmtl a\n", FACET_MTL_DIALECT_BLENDER3, true},
        {"", "# Blender 4.2.1 LTS MTL File: 'a.blend'\nnewmtl a\n", FACET_MTL_DIALECT_BLENDER3, true},
        {" Blender v2.79 (sub 0)", "# Blender 3.3.0 MTL File: 'a.blend'\nnewmtl a\n",
         FACET_MTL_DIALECT_BLENDER3, true},
        {"", "# obj2gltf --metallicRoughness\nnewmtl a\n", FACET_MTL_DIALECT_OBJ2GLTF_MR, true},
        {"", "# for obj2gltf --specularGlossiness\nnewmtl a\n", FACET_MTL_DIALECT_OBJ2GLTF_SG, true},
        {"", "newmtl a\n# Blender 3.3.0 MTL File: ''\n", FACET_MTL_DIALECT_SPEC, false},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        temporary_folder folder;
        temporary_folder_create(&folder);
        const facet_scene_desc desc = {0};
        facet_scene *scene = NULL;
        mtl_reader *reader = NULL;
        test_put_text(&folder, "a.mtl", cases[i].mtl);
        assert_int_equal(scene_create(NULL, "test.obj", &scene, NULL), FACET_OK);
        assert_int_equal(mtl_reader_create(scene, &desc, folder.path, &reader, NULL), FACET_OK);
        mtl_reader_hint(reader, cases[i].obj, strlen(cases[i].obj));
        assert_int_equal(mtl_reader_load(reader, "a.mtl", 5, NULL), FACET_OK);
        assert_int_equal(mtl_reader_finish(reader, NULL), FACET_OK);
        assert_int_equal(scene->legacy->dialect, cases[i].dialect);
        assert_int_equal(scene->legacy->is_dialect_guessed, cases[i].is_guessed);
        mtl_reader_destroy(reader);
        scene_destroy(scene);
        temporary_folder_remove(&folder);
    }
    const facet_scene_desc chosen = {.legacy = {.dialect = FACET_MTL_DIALECT_BLENDER28}};
    facet_scene *scene = mtl_load_text("# Blender 3.3.0 MTL File: ''\nnewmtl a\n", &chosen);
    assert_int_equal(scene->legacy->dialect, FACET_MTL_DIALECT_BLENDER28);
    assert_false(scene->legacy->is_dialect_guessed);
    scene_destroy(scene);
}

/* ---- memory ---- */

/* If any allocation fails, the result reports it and nothing leaks. */
static void failed_allocations_are_reported(void **state)
{
    (void)state;
    temporary_folder folder;
    temporary_folder_create(&folder);
    temporary_folder_put_png(&folder, "a.png");
    test_put_text(&folder, "w.rfl", "400 1\n");
    test_put_text(
        &folder, "a.mtl",
        "newmtl a\nKd spectral w.rfl\nfoo\nmap_Kd -o 1 2 3 \\\n a.png\n#facet-gltf {\"facet\":{}}\n");
    long fail_at = 0;
    facet_result result = FACET_ERROR_MEMORY;
    for (; result != FACET_OK; fail_at++) {
        assert_true(fail_at < 1000);
        failing_allocator f = {.fail_at = fail_at};
        const facet_scene_desc desc = {.allocator = failing_allocator_get(&f)};
        facet_scene *scene = NULL;
        mtl_reader *reader = NULL;
        result = scene_create(&desc.allocator, "test.obj", &scene, NULL);
        if (result == FACET_OK)
            result = mtl_reader_create(scene, &desc, folder.path, &reader, NULL);
        if (result == FACET_OK)
            result = mtl_reader_load(reader, "a.mtl", 5, NULL);
        if (result == FACET_OK)
            result = mtl_reader_finish(reader, NULL);
        assert_true(result == FACET_OK || result == FACET_ERROR_MEMORY);
        mtl_reader_destroy(reader);
        scene_destroy(scene);
        assert_int_equal(atomic_load(&f.blocks), 0);
    }
    assert_true(fail_at > 10);
    temporary_folder_remove(&folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_statements_are_read),
        cmocka_unit_test(unstated_values_are_absent),
        cmocka_unit_test(odd_spellings_of_lines_are_read),
        cmocka_unit_test(invalid_values_are_clamped_or_ignored),
        cmocka_unit_test(names_count_once),
        cmocka_unit_test(names_become_utf8),
        cmocka_unit_test(transparency_is_settled),
        cmocka_unit_test(colors_may_be_xyz),
        cmocka_unit_test(colors_may_be_spectra),
        cmocka_unit_test(offset_and_scale_are_converted),
        cmocka_unit_test(options_are_read),
        cmocka_unit_test(unknown_members_are_ignored),
        cmocka_unit_test(one_texcoord_set_round_trips),
        cmocka_unit_test(materials_are_found_by_name),
        cmocka_unit_test(dialects_are_detected_by_comments),
        cmocka_unit_test(failed_allocations_are_reported),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
