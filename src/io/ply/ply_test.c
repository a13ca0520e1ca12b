/* Tests of ply.h: the three forms, types, faces and strips, attributes, points, damage. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "tests/support/support.h"
#include "image/srgb.h"
#include "io/obj/mtl_test_support.h"
#include "io/obj/obj_test_support.h"
#include "io/ply/ply.h"

static facet_scene *load(const void *bytes, size_t size, const facet_scene_desc *desc)
{
    facet_scene *scene = NULL;
    facet_error error = {0};
    assert_true(ply_detect(bytes, size));
    if (ply_load_memory(bytes, size, "test.ply", NULL, desc, &scene, &error) != FACET_OK)
        fail_msg("%s", error.message);
    return scene;
}

static facet_scene *load_text(const char *string)
{
    return load(string, strlen(string), NULL);
}

#define XYZ "property float x\nproperty float y\nproperty float z\n"
#define CORNERS "property list uchar int vertex_indices\n"
#define SQUARE "0 0 0\n2 0 0\n2 1 0\n0 1 0\n"

/* ---- forms ---- */

/* A file that is written value by value, in the form of its header. */
typedef struct writing {
    char bytes[4096];
    size_t size;
    int form; /* 0 text, 1 little endian, 2 big endian */
} writing;

static void put_text(writing *w, const char *string)
{
    memcpy(w->bytes + w->size, string, strlen(string) + 1);
    w->size += strlen(string);
}

/* kind: 'f' float, 'd' double, 'u' unsigned, 'i' signed; of size bytes. */
static void put(writing *w, char kind, size_t size, double value)
{
    if (w->form == 0) {
        w->size += (size_t)snprintf(w->bytes + w->size, sizeof w->bytes - w->size, "%.17g ", value);
        return;
    }
    uint64_t bits = 0;
    float single = (float)value;
    uint32_t word;
    memcpy(&word, &single, sizeof word);
    if (kind == 'd')
        memcpy(&bits, &value, sizeof bits);
    else
        bits = kind == 'f' ? word : (uint64_t)(int64_t)value;
    for (size_t i = 0; i < size; i++)
        w->bytes[w->size++] = (char)(bits >> 8 * (w->form == 1 ? i : size - 1 - i));
}

static void all_forms_and_types_are_the_same(void **state)
{
    (void)state;
    static const char *const formats[] = {"ascii", "binary_little_endian", "binary_big_endian"};
    static const struct {
        const char *name;
        char kind;
        size_t size;
    } types[] = {{"char", 'i', 1},  {"uchar", 'u', 1},  {"short", 'i', 2}, {"ushort", 'u', 2},
                 {"int", 'i', 4},   {"uint", 'u', 4},   {"int8", 'i', 1},  {"uint8", 'u', 1},
                 {"int16", 'i', 2}, {"uint16", 'u', 2}, {"int32", 'i', 4}, {"uint32", 'u', 4}};
    static const float square[4][3] = {{0, 0, -5}, {2, 0, -5}, {2, 1, -5}, {0, 1, -5}};
    static const unsigned corners[] = {0, 1, 2, 3};
    for (int form = 0; form < 3; form++)
        for (size_t t = 0; t < sizeof types / sizeof *types; t++) {
            writing w = {.form = form};
            char header[512];
            bool is_signed = types[t].kind == 'i';
            snprintf(
                header, sizeof header,
                "ply\r\nformat %s 1.0\r\ncomment x\r\nobj_info y\r\nelement vertex 4\r\nproperty double x\r\n"
                "property float64 y\r\nproperty %s z\r\nproperty list uchar float32 extra\r\nelement face "
                "1\r\n"
                "property uchar flag\r\nproperty list %s %s vertex_index\r\nend_header\r\n",
                formats[form], is_signed ? types[t].name : "float", types[t].name, types[t].name);
            put_text(&w, header);
            for (int i = 0; i < 4; i++) {
                put(&w, 'd', 8, (double)square[i][0]);
                put(&w, 'd', 8, (double)square[i][1]);
                put(&w, is_signed ? 'i' : 'f', is_signed ? types[t].size : 4, (double)square[i][2]);
                put(&w, 'u', 1, i);
                for (int k = 0; k < i; k++)
                    put(&w, 'f', 4, 0.5);
            }
            put(&w, 'u', 1, 7);
            put(&w, types[t].kind, types[t].size, 4);
            for (int i = 0; i < 4; i++)
                put(&w, types[t].kind, types[t].size, corners[i]);
            facet_scene *scene = load(w.bytes, w.size, NULL);
            const scene_primitive *p = obj_only_primitive(scene);
            assert_int_equal(p->vertex_count, 4);
            assert_int_equal(p->index_count, 6);
            assert_memory_equal(p->positions, square, sizeof square);
            assert_near(obj_normal(p, 0)[2], 1, 0);
            assert_int_equal(scene->warning_count, 0);
            scene_destroy(scene);
        }
}

/* All digits of a place in double count, however far it is from the origin. */
static void far_places_are_exact(void **state)
{
    (void)state;
    facet_scene *scene =
        load_text("ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\n"
                  "property double z\nelement face 1\n" CORNERS "end_header\n"
                  "4500000.125 -1e7 0\n4500001.0625 -1e7 0\n4500000.125 -9999999.5 0.001\n3 0 1 2\n");
    const scene_primitive *p = obj_only_primitive(scene);
    const double *at = scene->nodes[0].translation;
    static const double places[3][3] = {
        {4500000.125, -1e7, 0}, {4500001.0625, -1e7, 0}, {4500000.125, -9999999.5, 0.001}};
    for (size_t i = 0; i < 3; i++)
        for (size_t k = 0; k < 3; k++)
            assert_near((double)obj_position(p, i)[k] + at[k], places[i][k], 1e-6);
    scene_destroy(scene);
}

/* ---- attributes ---- */

static void attributes_of_vertices_are_read(void **state)
{
    (void)state;
    facet_scene *scene =
        load_text("ply\nformat ascii 1.0\nelement vertex 3\n" XYZ
                  "property float nx\nproperty float ny\nproperty float nz\nproperty uchar red\n"
                  "property uchar green\nproperty uchar blue\nproperty uchar alpha\nproperty float s\n"
                  "property float t\nelement face 1\n" CORNERS "end_header\n"
                  "0 0 0  0 0.6 0.8  255 0 51 255  0.25 0.75\n1 0 0  0 3 4  0 0 0 128  1 0\n"
                  "0 1 0  0 6 8  0 0 0 0  0 1\n3 0 1 2\n");
    const scene_primitive *p = obj_only_primitive(scene);
    assert_near(obj_normal(p, 1)[1], 0.6, 1e-6);
    assert_near(p->colors[0], 1, 0);
    assert_near(p->colors[2], srgb_decode(0.2), 1e-6);
    assert_near(p->colors[4 + 3], 128 / 255.0, 1e-6);
    assert_near(obj_texcoord(p, 0)[0], 0.25, 0);
    assert_near(obj_texcoord(p, 0)[1], 0.25, 0); /* from the top */
    assert_near(scene->materials[0].base_color[0], 1, 0);
    assert_int_equal(scene->materials[0].alpha_mode, SCENE_ALPHA_BLEND);
    scene_destroy(scene);
}

static void colors_are_of_many_types(void **state)
{
    (void)state;
    static const struct {
        const char *type, *numbers;
    } ways[] = {{"uchar", "255 51 0"},  {"ushort", "65535 13107 0"}, {"float", "1 0.2 0"},
                {"double", "255 51 0"}, {"int", "255 51 -3"},        {"float", "7000 51 nan"}};
    for (size_t i = 0; i < sizeof ways / sizeof *ways; i++)
        for (int is_linear = 0; is_linear < 2; is_linear++) {
            char bytes[512];
            snprintf(
                bytes, sizeof bytes,
                "ply\nformat ascii 1.0\nelement vertex 1\n" XYZ
                "property %s diffuse_red\nproperty %s diffuse_green\nproperty %s diffuse_blue\nend_header\n"
                "0 0 0 %s\n",
                ways[i].type, ways[i].type, ways[i].type, ways[i].numbers);
            const facet_scene_desc desc = {.legacy.colors = is_linear ? FACET_LEGACY_COLORS_LINEAR
                                                                      : FACET_LEGACY_COLORS_SRGB};
            facet_scene *scene = load(bytes, strlen(bytes), &desc);
            const float *c = obj_only_primitive(scene)->colors;
            assert_near(c[0], 1, 0);
            assert_near(c[1], is_linear ? 0.2 : srgb_decode(0.2), 1e-6);
            assert_near(c[2], 0, 0);
            assert_near(c[3], 1, 0);
            scene_destroy(scene);
        }
    facet_scene *scene =
        load_text("ply\nformat ascii 1.0\nelement vertex 1\n" XYZ
                  "property float f_dc_0\nproperty float f_dc_1\nproperty float f_dc_2\nend_header\n"
                  "0 0 0 0 1.7724538 -9\n"); /* Gaussian splats */
    const float *c = obj_only_primitive(scene)->colors;
    assert_near(c[0], srgb_decode(0.5), 1e-6);
    assert_near(c[1], 1, 1e-6);
    assert_near(c[2], 0, 0);
    scene_destroy(scene);
}

static void texture_coordinates_of_faces_and_an_image_are_read(void **state)
{
    (void)state;
    static const char bytes[] =
        "ply\nformat ascii 1.0\ncomment TextureFile My wood.png\nelement vertex 4\n" XYZ
        "element face 2\n" CORNERS "property list uchar float texcoord\nend_header\n" SQUARE
        "3 0 1 2 6 0 0 1 0 1 1\n3 0 2 3 6 0.5 0.5 0.75 0.5 0.75 0.75\n";
    temporary_folder folder;
    temporary_folder_create(&folder);
    temporary_folder_put_png(&folder, "my wood.PNG");
    facet_scene *scene = NULL;
    assert_int_equal(ply_load_memory(bytes, sizeof bytes - 1, "test.ply", folder.path, NULL, &scene, NULL),
                     FACET_OK);
    const scene_primitive *p = obj_only_primitive(scene);
    assert_int_equal(p->vertex_count, 6);
    assert_near(obj_texcoord(p, 2)[0], 1, 0);
    assert_near(obj_texcoord(p, 3)[0], 0.5, 0);
    assert_near(obj_texcoord(p, 5)[1], 0.25, 0);
    assert_int_equal(scene->image_count, 1);
    assert_int_equal(scene->materials[0].textures[SCENE_BASE_COLOR_TEXTURE].texture, 0);
    assert_true(obj_has_warning(scene, "\"my wood.PNG\" is read instead"));
    scene_destroy(scene);
    temporary_folder_remove(&folder);
    scene = load(bytes, sizeof bytes - 1, NULL);
    assert_int_equal(scene->image_count, 0);
    assert_true(obj_has_warning(scene, "test.ply: line 3: "));
    scene_destroy(scene);
}

/* ---- faces ---- */

static void polygons_and_strips_are_triangles(void **state)
{
    (void)state;
    facet_scene *scene = load_text("ply\nformat ascii 1.0\nelement vertex 6\n" XYZ "element face 3\n" CORNERS
                                   "element edge 1\nproperty int vertex1\nproperty int vertex2\nend_header\n"
                                   "0 0 0\n4 0 0\n4 4 0\n0 4 0\n2 1 0\n0 0 1\n"
                                   "5 0 4 1 2 3\n2 0 1\n0\n0 1\n"); /* concave */
    const scene_primitive *p = obj_only_primitive(scene);
    assert_int_equal(p->index_count, 9);
    double area = 0;
    for (size_t i = 0; i < 9; i += 3) {
        const float *a = obj_position(p, i);
        const float *b = obj_position(p, i + 1);
        const float *c = obj_position(p, i + 2);
        double z = (double)((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
        assert_true(z > 0);
        area += z / 2;
    }
    assert_near(area, 14, 1e-5);
    scene_destroy(scene);
    scene = load_text("ply\nformat ascii 1.0\nelement vertex 6\n" XYZ "element tristrips 1\n"
                      "property list int int vertex_indices\nend_header\n"
                      "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n1 2 0\n9 0 1 2 3 -1 2 3 4 5\n");
    p = obj_only_primitive(scene);
    assert_int_equal(p->index_count, 12);
    for (size_t i = 0; i < 12; i++)
        assert_near(obj_normal(p, i)[2], 1, 1e-6);
    scene_destroy(scene);
}

static void vertices_alone_are_points(void **state)
{
    (void)state;
    facet_scene *scene =
        load_text("ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
                  "element face 0\n" CORNERS "end_header\n0 0\n1 0\n1 inf\n0 1\n");
    const scene_primitive *p = obj_only_primitive(scene);
    assert_int_equal(p->mode, SCENE_POINTS);
    assert_int_equal(p->index_count, 3);
    assert_true(obj_has_warning(scene, "1 points have a place that is not finite"));
    scene_destroy(scene);
}

/* ---- damage ---- */

static void damage_is_reported(void **state)
{
    (void)state;
    static const struct {
        const char *bytes, *warning;
    } cut[] = {
        {"ply\nformat ascii 1.0\nelement vertex 4000000000\n" XYZ "end_header\n" SQUARE,
         "4000000000 vertices were declared, 4 are there"},
        {"ply\nformat ascii 1.0\nelement vertex 4\n" XYZ "element face 99\n" CORNERS "end_header\n" SQUARE
         "3 0 1 2\n3 0 1",
         "99 faces were declared, 1 are there"},
        {"ply\nformat ascii 1.0\nelement vertex 4\n" XYZ "element face 1\n" CORNERS
         "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n" SQUARE
         "3 0 1 2 255 0 0\n",
         "colors of faces are not supported"},
        {"ply\nformat ascii 1.0\nelement vertex 4\n" XYZ "element face 4\n" CORNERS "end_header\n" SQUARE
         "3 0 1 2\n3 0 1 4\n3 -1 1 2\n3 0 1.5 2\n",
         "3 faces refer to a vertex that does not exist"},
    };
    for (size_t i = 0; i < sizeof cut / sizeof *cut; i++) {
        facet_scene *scene = load_text(cut[i].bytes);
        assert_true(obj_has_warning(scene, cut[i].warning));
        assert_int_equal(scene->mesh_count, 1);
        scene_destroy(scene);
    }
    static const struct {
        const char *bytes, *message;
    } bad[] = {
        {"ply\n", "test.ply: has no \"end_header\""},
        {"ply\nend_header\n", "its header has no format"},
        {"ply\nformat ascii 1.0\nend_header\n", "has no element \"vertex\""},
        {"ply\nformat ascii 1.0\nelement vertex 1\nproperty float a\nend_header\n1\n", "have no x and y"},
        {"ply\nformat latin 1.0\nend_header\n", "format \"latin\" is not one of"},
        {"ply\nformat ascii 1.0\nelement vertex many\nend_header\n", "a number of elements was expected"},
        {"ply\nformat ascii 1.0\nproperty float x\nend_header\n", "type and name behind an element"},
        {"ply\nformat ascii 1.0\nelement vertex 1\nproperty real x\nend_header\n", "type and name"},
        {"ply\nformat ascii 1.0\nelement vertex 1\nproperty list float int x\nend_header\n", "type and name"},
        {"ply\nformat ascii 1.0\nhello\nend_header\n", "\"hello\" is not a line of a header"},
        {"ply\nformat ascii 1.0\nelement vertex 1\n" XYZ
         "element face 1\nproperty int a\nend_header\n0 0 0\n1\n",
         "has no list of corners"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        facet_scene *scene = NULL;
        facet_error error = {0};
        assert_int_equal(
            ply_load_memory(bad[i].bytes, strlen(bad[i].bytes), "test.ply", NULL, NULL, &scene, &error),
            FACET_ERROR_INVALID);
        assert_null(scene);
        if (!strstr(error.message, bad[i].message))
            fail_msg("%s", error.message);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_forms_and_types_are_the_same),
        cmocka_unit_test(far_places_are_exact),
        cmocka_unit_test(attributes_of_vertices_are_read),
        cmocka_unit_test(colors_are_of_many_types),
        cmocka_unit_test(texture_coordinates_of_faces_and_an_image_are_read),
        cmocka_unit_test(polygons_and_strips_are_triangles),
        cmocka_unit_test(vertices_alone_are_points),
        cmocka_unit_test(damage_is_reported),
    };
    return cmocka_run_group_tests_name("ply", tests, NULL, NULL);
}
