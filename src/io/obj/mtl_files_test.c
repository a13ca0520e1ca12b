/* mtl_files_test.c - the files that MTL files name: images with alike names, textures that share one,
 * libraries. */
#define _XOPEN_SOURCE 700
#include "io/obj/mtl_test_support.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "tests/support/support.h"
#include "image/srgb.h"

/* ---- images ---- */

/* Common differences between written names and names on disk; each file is read, with one warning. */
static void alike_file_names_are_found(void **state)
{
    (void)state;
    temporary_folder folder;
    temporary_folder_create(&folder);
    static const char *const names[] = {"sub/WOOD.PNG",  "sub\\Wood.png",   "SUB\\wood.PNG",
                                        "my\\ wood.png", "wood.png?v=1",    "wood.png#top",
                                        "my%20wood.png", "t\xc3\xa9te.png", "Two.png"};
    static const char *const found[] = {"sub/wood.png", "sub/wood.png",     "sub/wood.png",
                                        "my wood.png",  "wood.png",         "wood.png",
                                        "my wood.png",  "te\xcc\x81te.png", NULL};
    temporary_folder_put_png(&folder, "sub/wood.png");
    temporary_folder_put_png(&folder, "wood.png");
    temporary_folder_put_png(&folder, "my wood.png");
    temporary_folder_put_png(&folder, "te\xcc\x81te.png");
    temporary_folder_put_png(&folder, "two.png");
    temporary_folder_put_png(&folder, "two.PNG");
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
    temporary_folder_remove(&folder);
}

/* No name leads out of the folder because it is only alike. */
static void alike_file_names_stay_inside_the_root(void **state)
{
    (void)state;
    temporary_folder folder;
    temporary_folder_create(&folder);
    temporary_folder_put_png(&folder, "out/wood.png");
    test_put_text(&folder, "in/a.mtl", "newmtl a\nmap_Kd ../OUT/WOOD.PNG\nmap_Ks ..\\Out\\wood.png\n");
    facet_scene *scene = mtl_load(temporary_folder_file(&folder, "in"), "a.mtl", NULL);
    assert_int_equal(scene->image_count, 0);
    assert_int_equal(mtl_count_warnings(scene, "leads out of the model's folder"), 1);
    scene_destroy(scene);
    scene = mtl_load(temporary_folder_file(&folder, "in"), "a.mtl", &(facet_scene_desc){.root = folder.path});
    assert_int_equal(scene->image_count, 1);
    scene_destroy(scene);
    temporary_folder_remove(&folder);
}

static void textures_are_found_and_shared(void **state)
{
    (void)state;
    temporary_folder folder;
    temporary_folder_create(&folder);
    temporary_folder_put_png(&folder, "sub/a.png");
    temporary_folder_put_png(&folder, "with space.png");
    temporary_folder_put(&folder, "sub/b.gif", "8BPS\0\1\0\1\0", 9);
    temporary_folder_put(&folder, "c.pcx", "\012\0\2\0", 4);
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
    temporary_folder_remove(&folder);
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
    temporary_folder folder;
    temporary_folder_create(&folder);
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
    temporary_folder_remove(&folder);
}

static void libraries_are_found(void **state)
{
    (void)state;
    temporary_folder folder;
    temporary_folder_create(&folder);
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
    scene = mtl_load(temporary_folder_file(&folder, "d"), "../c.mtl", NULL);
    assert_int_equal(scene->material_count, 0);
    assert_int_equal(mtl_count_warnings(scene, "leads out of the model's folder"), 1);
    scene_destroy(scene);
    const facet_scene_desc wide = {.root = folder.path};
    scene = mtl_load(temporary_folder_file(&folder, "d"), "../c.mtl", &wide);
    assert_int_equal(scene->material_count, 1);
    scene_destroy(scene);
    scene = mtl_load(temporary_folder_file(&folder, "d"), temporary_folder_file(&folder, "c.mtl"),
                     &wide); /* absolute, below the root */
    assert_int_equal(scene->material_count, 1);
    scene_destroy(scene);
    scene = mtl_load(NULL, "c.mtl", NULL);
    assert_int_equal(mtl_count_warnings(scene, "the model was not read from a folder"), 1);
    scene_destroy(scene);
    temporary_folder_remove(&folder);
}

/* However often a file is named, and by how many names, it is mapped and parsed once. */
static void files_are_opened_once(void **state)
{
    (void)state;
    temporary_folder folder;
    temporary_folder_create(&folder);
    text library = {0};
    text spectrum = {0};
    for (int i = 0; i < 300; i++)
        text_addf(&library, "newmtl %d\nKd spectral %s 0.%d\nmap_Kd a.png\nmap_Ks b.png\nmap_Ka c.png\n", i,
                  i % 2 ? "s.rfl" : "./s.rfl", 1 + i % 9);
    for (int i = 0; i < 20000; i++)
        text_addf(&spectrum, "%.2f 0.5\n", 380.0 + 0.02 * i);
    temporary_folder_put(&folder, "a.mtl", library.data, library.length);
    temporary_folder_put(&folder, "s.rfl", spectrum.data, spectrum.length);
    test_put_text(&folder, "c.png", "no image");
    temporary_folder_put_png(&folder, "a.png");
    assert_int_equal(link(temporary_folder_file(&folder, "a.png"), temporary_folder_file(&folder, "b.png")),
                     0);
    assert_int_equal(symlink("a.mtl", temporary_folder_file(&folder, "link.mtl")), 0);
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
    temporary_folder_remove(&folder);
}

/* ---- real files ---- */

/* A library has materials, and none is misunderstood in part. */
static bool read_library(const char *folder, const char *name, void *context)
{
    (void)context;
    facet_scene *scene = mtl_load(folder, name, NULL);
    assert_true(scene->material_count > 0);
    assert_int_equal(mtl_count_warnings(scene, "is not a number"), 0);
    assert_int_equal(mtl_count_warnings(scene, "mtllib"), 0);
    for (uint32_t i = 0; i < scene->material_count; i++) {
        assert_true(legacy_has(mtl_get(scene, i), LEGACY_DIFFUSE));
        assert_false(mtl_get(scene, i)->is_transparency_ambiguous && !strstr(folder, "tinyobjloader"));
    }
    scene_destroy(scene);
    return true;
}

static void real_files_are_read(void **state)
{
    (void)state;
    const char *data = test_data();
    char path[1024];
    snprintf(path, sizeof path, "%s/obj", data);
    assert_int_equal(test_visit_files(path, ".mtl", read_library, NULL), 40);

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
        cmocka_unit_test(alike_file_names_are_found),
        cmocka_unit_test(alike_file_names_stay_inside_the_root),
        cmocka_unit_test(textures_are_found_and_shared),
        cmocka_unit_test(a_library_named_like_the_model_is_found),
        cmocka_unit_test(libraries_are_found),
        cmocka_unit_test(files_are_opened_once),
        cmocka_unit_test(real_files_are_read),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
