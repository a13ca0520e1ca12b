/* mtl_reader_test.c - MTL files as different programs write them. */
#define _XOPEN_SOURCE 700
#include "io/obj/mtl_test_support.h"

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

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
    test_folder folder = test_folder_make();
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
    test_folder_remove(&folder);
}

/* ---- maps ---- */

/* -o and -s in MTL's coordinates are the map's offset and scale in glTF's: checked by transforming a point both ways. */
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

/* Common differences between written names and names on disk; each file is read, with one warning. */
static void alike_file_names_are_found(void **state)
{
    (void)state;
    test_folder folder = test_folder_make();
    static const char *const names[] = {"sub/WOOD.PNG",  "sub\\Wood.png",   "SUB\\wood.PNG",
                                        "my\\ wood.png", "wood.png?v=1",    "wood.png#top",
                                        "my%20wood.png", "t\xc3\xa9te.png", "Two.png"};
    static const char *const found[] = {"sub/wood.png", "sub/wood.png",     "sub/wood.png",
                                        "my wood.png",  "wood.png",         "wood.png",
                                        "my wood.png",  "te\xcc\x81te.png", NULL};
    test_put_png(&folder, "sub/wood.png");
    test_put_png(&folder, "wood.png");
    test_put_png(&folder, "my wood.png");
    test_put_png(&folder, "te\xcc\x81te.png");
    test_put_png(&folder, "two.png");
    test_put_png(&folder, "two.PNG");
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        char library[256];
        snprintf(library, sizeof library, "newmtl a\nmap_Kd %s\nmap_Ks %s\n", names[i], names[i]);
        test_put_text(&folder, "a.mtl", library);
        facet_scene *scene = mtl_load(folder.path, "A.mtl", NULL);
        assert_int_equal(
            mtl_count_warnings(scene, "test.obj: there is no file \"A.mtl\"; \"a.mtl\" is read instead"), 1);
        assert_int_equal(scene->image_count, found[i] != NULL);
        if (found[i])
            assert_string_equal(scene->images[0].uri, found[i]);
        /* A name with a query is unambiguous; other differences might mean another file. */
        assert_int_equal(scene->warning_count, i == 6 ? 1 : found[i] ? 2 : 3);
        scene_destroy(scene);
    }
    test_folder_remove(&folder);
}

/* No name leads out of the folder because it is only alike. */
static void alike_file_names_stay_inside_the_root(void **state)
{
    (void)state;
    test_folder folder = test_folder_make();
    test_put_png(&folder, "out/wood.png");
    test_put_text(&folder, "in/a.mtl", "newmtl a\nmap_Kd ../OUT/WOOD.PNG\nmap_Ks ..\\Out\\wood.png\n");
    facet_scene *scene = mtl_load(test_path(&folder, "in"), "a.mtl", NULL);
    assert_int_equal(scene->image_count, 0);
    assert_int_equal(mtl_count_warnings(scene, "leads out of the model's folder"), 1);
    scene_destroy(scene);
    scene = mtl_load(test_path(&folder, "in"), "a.mtl", &(facet_scene_desc){.root = folder.path});
    assert_int_equal(scene->image_count, 1);
    scene_destroy(scene);
    test_folder_remove(&folder);
}

static void textures_are_found_and_shared(void **state)
{
    (void)state;
    test_folder folder = test_folder_make();
    test_put_png(&folder, "sub/a.png");
    test_put_png(&folder, "with space.png");
    test_put(&folder, "sub/b.gif", "8BPS\0\1\0\1\0", 9);
    test_put(&folder, "c.pcx", "\012\0\2\0", 4);
    test_put_text(&folder, "sub/m.mtl",
                  "newmtl a\nmap_Kd a.png\nmap_Ks ./a.png\nmap_Ka .\\a.png\nmap_Ke C:\\textures\\a.png\n"
                  "map_Ns -clamp on a.png\nmap_d \"with space.png\"\nbump ../with space.png\ndisp b.gif\n"
                  "decal gone.png\nnorm c.pcx\nmap_Pr /nowhere/else/with space.png\nmap_Pm ../../out.png\n");
    facet_scene *scene = mtl_load(folder.path, "sub\\m.mtl", NULL);
    const legacy_material *m = mtl_get(scene, 0);
    assert_int_equal(scene->image_count, 2);
    assert_int_equal(scene->texture_count, 3);
    assert_string_equal(scene->images[0].mime_type, "image/png");
    assert_int_equal(scene->images[0].width, 1);
    assert_string_equal(scene->images[0].uri, "sub/a.png");
    const legacy_map_slot same[] = {LEGACY_DIFFUSE_MAP, LEGACY_SPECULAR_MAP, LEGACY_AMBIENT_MAP,
                                    LEGACY_EMISSION_MAP};
    for (int i = 0; i < 4; i++)
        assert_int_equal(m->maps[same[i]].ref.texture, 0);
    const scene_texture *clamped = &scene->textures[m->maps[LEGACY_SHININESS_MAP].ref.texture];
    assert_int_equal(clamped->image, 0);
    assert_int_equal(clamped->wrap_u, SCENE_WRAP_CLAMP);
    assert_int_equal(clamped->wrap_v, SCENE_WRAP_CLAMP);
    assert_int_equal(scene->textures[0].wrap_u, SCENE_WRAP_REPEAT);
    assert_int_equal(m->maps[LEGACY_OPACITY_MAP].ref.texture, 2);
    assert_int_equal(m->maps[LEGACY_BUMP_MAP].ref.texture, 2);
    assert_int_equal(m->maps[LEGACY_ROUGHNESS_MAP].ref.texture, 2);
    const legacy_map_slot none[] = {LEGACY_DISPLACEMENT_MAP, LEGACY_DECAL_MAP, LEGACY_NORMAL_MAP,
                                    LEGACY_METALLIC_MAP};
    for (int i = 0; i < 4; i++) {
        assert_int_equal(m->maps[none[i]].ref.texture, SCENE_NONE);
        assert_non_null(m->maps[none[i]].path);
    }
    assert_int_equal(
        mtl_count_warnings(scene, "line 9: \"b.gif\" is a PSD file, which facet does not read; a PNG, JPEG"),
        1);
    assert_int_equal(mtl_count_warnings(scene, "line 10: there is no file \"sub/gone.png\""), 1);
    assert_int_equal(mtl_count_warnings(scene, "line 11: \"c.pcx\" is a PCX file"), 1);
    assert_int_equal(mtl_count_warnings(scene, "line 13: \"../../out.png\" leads out of the model's folder"),
                     1);
    assert_int_equal(scene->warning_count, 4);
    scene_destroy(scene);
    test_folder_remove(&folder);
}

/* ---- comments ---- */

/* Members outside of materials are ignored, whatever they contain. */
static void unknown_members_are_ignored(void **state)
{
    (void)state;
    test_folder folder = test_folder_make();
    test_put_png(&folder, "a.png");
    text t = {0};
    text_add(
        &t,
        "newmtl a\nillum 2\n#facet-gltf {\"facet\":{\"illum\":2},\"normalTexture\":{\"image\":\"a.png\"}");
    for (int i = 0; i < 1000; i++)
        text_addf(&t, ",\"t%d\":{\"image\":\"a.png\",\"name\":\"%d\"}", i, i);
    text_add(&t, "}\n");
    test_put(&folder, "a.mtl", t.data, t.length);
    facet_scene *scene = mtl_load(folder.path, "a.mtl", NULL);
    assert_true(mtl_get(scene, 0)->is_gltf_restored);
    assert_true(scene_material_has(&scene->materials[0], SCENE_NORMAL_TEXTURE));
    assert_int_equal(scene->texture_count, 1);
    assert_int_equal(scene->warning_count, 0);
    scene_destroy(scene);
    text_destroy(&t);
    test_folder_remove(&folder);
}

/* OBJ has one set of coordinates: textures that read another one are left out, and the one that is written
 * is called
 * 0. */
static void one_texcoord_set_round_trips(void **state)
{
    (void)state;
    static const char statements[] = "map_Kd a.png\n";
    test_folder folder = test_folder_make();
    test_put_png(&folder, "a.png");
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
        test_put(&folder, "b.mtl", t.data, t.length);
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
    test_folder_remove(&folder);
}

/* ---- libraries ---- */

/* Where no library is there, the one that has the model's name, however many are named. */
static void a_library_named_like_the_model_is_found(void **state)
{
    (void)state;
    static const char *const statements[] = {"old.mtl", "old.mtl other.mtl", ""};
    static const char *const warnings[] = {
        "mtllib: there is no file \"old.mtl\"; \"Test.MTL\", which is named like the model, is read instead",
        "mtllib: there is no file \"old.mtl\"; \"Test.MTL\", which is named like the model, is read instead",
        "test.obj: names no library of materials; \"Test.MTL\", which is named like the model, is read"};
    test_folder folder = test_folder_make();
    test_put_text(&folder, "Test.MTL", "newmtl a\n");
    for (size_t i = 0; i < 3; i++) {
        facet_scene *scene = mtl_load(folder.path, statements[i], NULL);
        assert_int_equal(scene->material_count, 1);
        assert_int_equal(mtl_count_warnings(scene, warnings[i]), 1);
        scene_destroy(scene);
    }
    test_put_text(&folder, "there.mtl", "newmtl b\n");
    facet_scene *scene = mtl_load(folder.path, "gone.mtl there.mtl", NULL);
    assert_string_equal(scene->materials[0].name, "b");
    assert_int_equal(scene->material_count, 1);
    assert_int_equal(
        mtl_count_warnings(scene, "there is no file \"gone.mtl\"; its materials have default values"), 1);
    scene_destroy(scene);
    test_folder_remove(&folder);
}

static void libraries_are_found(void **state)
{
    (void)state;
    test_folder folder = test_folder_make();
    test_put_text(&folder, "a b.mtl", "newmtl ab\n");
    test_put_text(&folder, "c.mtl", "newmtl c\n");
    test_put_text(&folder, "d/e.mtl", "newmtl e\n");
    facet_scene *scene = mtl_load(
        folder.path, "  a b.mtl c.mtl d\\\\e.mtl c.mtl missing one.mtl \"c.mtl\" C:\\x\\c.mtl ", NULL);
    assert_int_equal(scene->material_count, 3);
    assert_string_equal(scene->materials[0].name, "ab");
    assert_string_equal(scene->materials[1].name, "c");
    assert_string_equal(scene->materials[2].name, "e");
    assert_int_equal(scene->warning_count, 1);
    assert_int_equal(mtl_count_warnings(scene, "test.obj: mtllib: there is no file \"missing one.mtl\""), 1);
    scene_destroy(scene);
    scene = mtl_load(test_path(&folder, "d"), "../c.mtl", NULL);
    assert_int_equal(scene->material_count, 0);
    assert_int_equal(mtl_count_warnings(scene, "leads out of the model's folder"), 1);
    scene_destroy(scene);
    const facet_scene_desc wide = {.root = folder.path};
    scene = mtl_load(test_path(&folder, "d"), "../c.mtl", &wide);
    assert_int_equal(scene->material_count, 1);
    scene_destroy(scene);
    scene =
        mtl_load(test_path(&folder, "d"), test_path(&folder, "c.mtl"), &wide); /* absolute, below the root */
    assert_int_equal(scene->material_count, 1);
    scene_destroy(scene);
    scene = mtl_load(NULL, "c.mtl", NULL);
    assert_int_equal(mtl_count_warnings(scene, "the model was not read from a folder"), 1);
    scene_destroy(scene);
    test_folder_remove(&folder);
}

/* However often a file is named, and by how many names, it is mapped and parsed once. */
static void files_are_opened_once(void **state)
{
    (void)state;
    test_folder folder = test_folder_make();
    text library = {0};
    text spectrum = {0};
    for (int i = 0; i < 300; i++)
        text_addf(&library, "newmtl %d\nKd spectral %s 0.%d\nmap_Kd a.png\nmap_Ks b.png\nmap_Ka c.png\n", i,
                  i % 2 ? "s.rfl" : "./s.rfl", 1 + i % 9);
    for (int i = 0; i < 20000; i++)
        text_addf(&spectrum, "%.2f 0.5\n", 380.0 + 0.02 * i);
    test_put(&folder, "a.mtl", library.data, library.length);
    test_put(&folder, "s.rfl", spectrum.data, spectrum.length);
    test_put_text(&folder, "c.png", "no image");
    test_put_png(&folder, "a.png");
    assert_int_equal(link(test_path(&folder, "a.png"), test_path(&folder, "b.png")), 0);
    assert_int_equal(symlink("a.mtl", test_path(&folder, "link.mtl")), 0);
    failing_allocator f = {.fail_at = -1};
    const facet_scene_desc desc = {.allocator = failing_allocator_get(&f)};
    facet_scene *scene = NULL;
    mtl_reader *reader = NULL;
    assert_int_equal(scene_create(&desc.allocator, "test.obj", &scene, NULL), FACET_OK);
    assert_int_equal(mtl_reader_create(scene, &desc, folder.path, &reader, NULL), FACET_OK);
    for (int i = 0; i < 100; i++)
        assert_int_equal(mtl_reader_load(reader, "a.mtl link.mtl ./a.mtl", 22, NULL), FACET_OK);
    assert_int_equal(mtl_reader_finish(reader, NULL), FACET_OK);
    mtl_reader_destroy(reader);
    assert_int_equal(scene->file_count, 4);
    assert_int_equal(scene->image_count, 1);
    assert_int_equal(scene->texture_count, 1);
    assert_int_equal(scene->material_count, 300);
    assert_int_equal(mtl_count_warnings(scene, "already"), 0);
    assert_near(mtl_get(scene, 1)->diffuse[0], srgb_encode(0.5 * 0.2), 1e-4);
    assert_near(mtl_get(scene, 2)->diffuse[1], srgb_encode(0.5 * 0.3), 1e-4);
    /* Samples of a spectrum grow by ten blocks and more each time that it is parsed. */
    assert_true(atomic_load(&f.calls) < 3000);
    scene_destroy(scene);
    assert_int_equal(atomic_load(&f.blocks), 0);
    text_destroy(&library);
    text_destroy(&spectrum);
    test_folder_remove(&folder);
}

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
        test_folder folder = test_folder_make();
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
        test_folder_remove(&folder);
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
    test_folder folder = test_folder_make();
    test_put_png(&folder, "a.png");
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
    test_folder_remove(&folder);
}

/* ---- real files ---- */

/* All libraries of the shared data: each has materials, and none is misunderstood in part. */
static int read_folder(const char *path)
{
    int count = 0;
    DIR *folder = opendir(path);
    assert_non_null(folder);
    for (struct dirent *entry; (entry = readdir(folder));) {
        char inner[1024];
        const char *dot = strrchr(entry->d_name, '.');
        snprintf(inner, sizeof inner, "%s/%s", path, entry->d_name);
        DIR *is_folder = entry->d_name[0] == '.' ? NULL : opendir(inner);
        if (is_folder) {
            closedir(is_folder);
            count += read_folder(inner);
        } else if (dot && strcmp(dot, ".mtl") == 0) {
            facet_scene *scene = mtl_load(path, entry->d_name, NULL);
            assert_true(scene->material_count > 0);
            assert_int_equal(mtl_count_warnings(scene, "is not a number"), 0);
            assert_int_equal(mtl_count_warnings(scene, "mtllib"), 0);
            for (uint32_t i = 0; i < scene->material_count; i++) {
                assert_true(legacy_has(mtl_get(scene, i), LEGACY_DIFFUSE));
                assert_false(mtl_get(scene, i)->is_transparency_ambiguous && !strstr(path, "tinyobjloader"));
            }
            scene_destroy(scene);
            count++;
        }
    }
    closedir(folder);
    return count;
}

static void real_files_are_read(void **state)
{
    (void)state;
    const char *data = getenv("FACET_TEST_DATA");
    if (!data) {
        print_message("skip: FACET_TEST_DATA is not set\n");
        skip();
    }
    char path[1024];
    snprintf(path, sizeof path, "%s/obj", data);
    assert_int_equal(read_folder(path), 40);

    snprintf(path, sizeof path, "%s/obj/obj2gltf/box-mtllib-spaces", data);
    facet_scene *scene = mtl_load(path, "box mtllib green.mtl box mtllib blue.mtl ", NULL);
    assert_int_equal(scene->material_count, 2);
    assert_int_equal(scene->warning_count, 0);
    scene_destroy(scene);

    snprintf(path, sizeof path, "%s/obj/obj2gltf/box-windows-paths", data);
    scene = mtl_load(path, "materials\\\\box-windows-paths.mtl", NULL);
    assert_int_equal(scene->warning_count, 0);
    assert_true(legacy_has_map(mtl_get(scene, 0), LEGACY_DIFFUSE_MAP));
    assert_int_equal(scene->legacy->dialect, FACET_MTL_DIALECT_BLENDER27);
    scene_destroy(scene);

    snprintf(path, sizeof path, "%s/obj/obj2gltf/box-complex-material", data);
    scene = mtl_load(path, "box-complex-material.mtl", NULL);
    assert_int_equal(scene->image_count, 6); /* ambient.gif among them */
    assert_int_equal(scene->warning_count, 0);
    scene_destroy(scene);

    snprintf(path, sizeof path, "%s/obj/cornell", data);
    scene = mtl_load(path, "models/CornellBox/CornellBox-Original.mtl", NULL); /* found beside */
    assert_true(scene->material_count > 0);
    scene_destroy(scene);
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
        cmocka_unit_test(alike_file_names_are_found),
        cmocka_unit_test(alike_file_names_stay_inside_the_root),
        cmocka_unit_test(textures_are_found_and_shared),
        cmocka_unit_test(unknown_members_are_ignored),
        cmocka_unit_test(one_texcoord_set_round_trips),
        cmocka_unit_test(a_library_named_like_the_model_is_found),
        cmocka_unit_test(libraries_are_found),
        cmocka_unit_test(files_are_opened_once),
        cmocka_unit_test(materials_are_found_by_name),
        cmocka_unit_test(dialects_are_detected_by_comments),
        cmocka_unit_test(failed_allocations_are_reported),
        cmocka_unit_test(real_files_are_read),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
