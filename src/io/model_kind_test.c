/* Tests of model_kind.h: formats by content and by name, and the messages about unsupported ones. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "io/model_kind.h"

static void kinds_are_detected_by_content(void **state)
{
    (void)state;
    static const struct {
        const char *bytes, *name;
        model_kind kind;
    } cases[] = {
        {"glTF\2", "a.obj", MODEL_GLTF},
        {"\xef\xbb\xbf {\"asset\":{}}", "a", MODEL_GLTF},
        {"# x\nv 0 0 0\n", "a.glb", MODEL_OBJ},
        {"newmtl a\n  v 1 2 3\nf 1 2 3\n", "a.obj", MODEL_OBJ},
        {"// x\r\nv\t-.5 2 3\r\nl\t1 2\r\n", "stdin", MODEL_OBJ},
        {"OFF or so\nv 0 0 0\nf 1 1 1\n", "a.obj", MODEL_OBJ}, /* its name says so */
        {"newmtl a\nv 1 2 3\nfree\n", "a.obj", MODEL_UNKNOWN},
        {"newmtl a\nv is\nf not\n", "a.obj", MODEL_UNKNOWN},
        {"ply\nformat", "a.stl", MODEL_PLY},
        {"solid a\n facet", "a.ply", MODEL_STL},
        {"anything", "a.STL", MODEL_STL},
        {"anything", "a.ply", MODEL_PLY},
        {"anything", "a.glb", MODEL_UNKNOWN},
        {"", "a.glb", MODEL_UNKNOWN},
        {"Kaydara FBX Binary  ", "a.glb", MODEL_FOREIGN},
        {"anything", "a.fbx", MODEL_FOREIGN},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        if (model_kind_detect(cases[i].bytes, strlen(cases[i].bytes), cases[i].name) != cases[i].kind)
            fail_msg("%s: %s", cases[i].name, cases[i].bytes);
}

static void other_formats_come_with_advice(void **state)
{
    (void)state;
    static const struct {
        const char *bytes, *name, *message;
    } cases[] = {
        {"; FBX 7.3.0 project file", "stdin", "stdin: FBX files are not read; import it in Blender"},
        {"PK\x03\x04", "a.usdz", "a.usdz: USDZ files are not read"},
        {"PK\x03\x04", "a.3MF", "a.3MF: 3MF files are not read; export it as STL"},
        {"PK\x03\x04", "download", "zip files are not read; unpack it first"},
        {"<?xml version=\"1.0\"?>\n<COLLADA>", "stdin", "COLLADA files are not read"},
        {"ISO-10303-21;", "a.stp", "STEP files are not read; open it in FreeCAD"},
        {"BLENDER-v300", "a", "Blender files are not read; run: blender -b"},
        {"\x1f\x8b compressed", "a.blend", "Blender files are not read"},
        {"MM", "a.3ds", "3DS files are not read"},
        {"b3dm\1", "tile", "3D Tiles files are not read; run: npx 3d-tiles-tools b3dmToGlb"},
        {"LASF", "a.laz", "LAS files are not read; run: pdal translate"},
        {"<!DOCTYPE html>", "a.glb", "a.glb: is a web page, not a model"},
        {"version https://git-lfs.github.com/spec/v1\n", "a.glb", "is a Git LFS pointer, not a model; fetch"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        facet_error error = {0};
        size_t size = strlen(cases[i].bytes);
        assert_int_equal(model_kind_detect(cases[i].bytes, size, cases[i].name), MODEL_FOREIGN);
        assert_int_equal(model_kind_refuse(cases[i].bytes, size, cases[i].name, &error),
                         FACET_ERROR_UNSUPPORTED);
        if (!strstr(error.message, cases[i].message))
            fail_msg("%s", error.message);
    }
    facet_error error = {0};
    static const char png[] = "\x89PNG\r\n\x1a\n";
    assert_int_equal(model_kind_refuse(png, sizeof png - 1, "a.png", &error), FACET_ERROR_UNSUPPORTED);
    assert_non_null(strstr(error.message, "a.png: is an image (PNG), not a model; facet render --env"));
    assert_int_equal(model_kind_refuse("hello", 5, "a.txt", &error), FACET_ERROR_INVALID);
    assert_non_null(strstr(error.message, "a.txt: is neither a .glb file nor"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(kinds_are_detected_by_content),
        cmocka_unit_test(other_formats_come_with_advice),
    };
    return cmocka_run_group_tests_name("model_kind", tests, NULL, NULL);
}
