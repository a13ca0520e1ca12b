/* Tests of stl.h: both forms, their detection, welding, damage. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "tests/support/support.h"
#include "io/obj/obj_test_support.h"
#include "io/stl/stl.h"

/* A cube of 12 triangles, corners at -1 and 1. */
static const float POINTS[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                                   {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};
static const unsigned char TRIANGLES[12][3] = {{3, 2, 1}, {1, 0, 3}, {4, 5, 6}, {4, 6, 7},
                                               {0, 1, 5}, {0, 5, 4}, {2, 3, 7}, {2, 7, 6},
                                               {2, 6, 5}, {5, 1, 2}, {0, 4, 7}, {7, 3, 0}};
enum { BINARY_SIZE = 84 + 50 * 12 };

static void put_u32(unsigned char *p, uint32_t value)
{
    for (int i = 0; i < 4; i++)
        p[i] = (unsigned char)(value >> (8 * i));
}

static void write_binary(const char *header, unsigned char out[BINARY_SIZE])
{
    memset(out, 0, BINARY_SIZE);
    memcpy(out, header, strlen(header));
    put_u32(out + 80, 12);
    for (size_t i = 0; i < 36; i++)
        for (size_t k = 0; k < 3; k++) {
            uint32_t bits;
            memcpy(&bits, &POINTS[TRIANGLES[i / 3][i % 3]][k], sizeof bits);
            put_u32(out + 84 + 50 * (i / 3) + 12 + 12 * (i % 3) + 4 * k, bits);
        }
}

static size_t write_text(char *out, size_t room)
{
    size_t length = (size_t)snprintf(out, room, "\xef\xbb\xbfSolid  a cube \r\n");
    for (int i = 0; i < 12; i++) {
        length += (size_t)snprintf(out + length, room - length, "facet normal 0 0 0\r\nOUTER LOOP\r\n");
        for (int k = 0; k < 3; k++) {
            const float *p = POINTS[TRIANGLES[i][k]];
            length += (size_t)snprintf(out + length, room - length, "vertex %g %.1f %.3e\r\n", (double)p[0],
                                       (double)p[1], (double)p[2]);
        }
        length += (size_t)snprintf(out + length, room - length, "endloop\r\nendfacet\r\n");
    }
    return length + (size_t)snprintf(out + length, room - length, "endsolid a cube");
}

static facet_scene *load(const void *bytes, size_t size, const facet_scene_desc *desc)
{
    facet_scene *scene = NULL;
    facet_error error = {0};
    if (stl_load_memory(bytes, size, "test.stl", desc, &scene, &error) != FACET_OK)
        fail_msg("%s", error.message);
    return scene;
}

static void assert_cube(const void *bytes, size_t size, const char *name)
{
    static const facet_obj_normals normals[] = {FACET_OBJ_NORMALS_AUTO, FACET_OBJ_NORMALS_FLAT,
                                                FACET_OBJ_NORMALS_SMOOTH};
    static const uint32_t vertices[] = {24, 36, 8};
    assert_true(stl_detect(bytes, size));
    for (size_t i = 0; i < 3; i++) {
        facet_scene *scene = load(bytes, size, &(facet_scene_desc){.obj_normals = normals[i]});
        const scene_primitive *p = obj_only_primitive(scene);
        assert_string_equal(scene->meshes[0].name, name);
        assert_int_equal(p->vertex_count, vertices[i]);
        assert_int_equal(p->index_count, 36);
        for (size_t k = 0; k < 36; k++)
            assert_memory_equal(obj_position(p, k), POINTS[TRIANGLES[k / 3][k % 3]], sizeof *POINTS);
        assert_near(obj_normal(p, 0)[2], i == 2 ? -0.57735027 : -1.0, 2e-5);
        assert_true(scene->materials[p->material].is_double_sided);
        assert_near(scene->materials[p->material].metallic, 0, 0);
        assert_int_equal(scene->warning_count, 0);
        scene_destroy(scene);
    }
}

static void both_forms_are_read(void **state)
{
    (void)state;
    unsigned char binary[BINARY_SIZE];
    char text[8192];
    write_binary("by a test", binary);
    assert_cube(binary, sizeof binary, "");
    write_binary("solid, but binary", binary);
    assert_cube(binary, sizeof binary, "");
    assert_cube(text, write_text(text, sizeof text), "a cube");
}

static void other_files_are_not(void **state)
{
    (void)state;
    static const char *const others[] = {"", "solid", "solid a\nv 1 2 3\n", "solidworks\nfacet\n",
                                         "o solid\nfacet"};
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        assert_false(stl_detect(others[i], strlen(others[i])));
    unsigned char binary[BINARY_SIZE + 1] = {0};
    write_binary("x", binary);
    assert_false(stl_detect(binary, BINARY_SIZE + 1)); /* only a name says so */
    facet_scene *scene = load(binary, BINARY_SIZE + 1, NULL);
    assert_int_equal(obj_only_primitive(scene)->index_count, 36);
    scene_destroy(scene);
}

static void solids_are_objects(void **state)
{
    (void)state;
    static const char bytes[] = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex "
                                "1 1 0\nvertex 0 1 0\nendloop\n"
                                "endfacet\nendsolid a\nsolid b\nfacet normal 0 0 1\nouter loop\nvertex 0 0 "
                                "1\nvertex 1 0 1\nendloop\nendfacet\n"
                                "facet normal 0 0 1\nouter loop\nvertex 0 0 1\nvertex 1 0 1\nvertex 0 1 "
                                "1\nendloop\nendfacet\nendsolid b\n"
                                "solid empty\nendsolid empty\n";
    facet_scene *scene = load(bytes, sizeof bytes - 1, NULL);
    assert_int_equal(scene->mesh_count, 2);
    const scene_primitive *a = &obj_find_mesh(scene, "a")->primitives[0];
    assert_int_equal(a->index_count, 6); /* a loop of four corners */
    assert_int_equal(a->vertex_count, 4);
    assert_int_equal(obj_find_mesh(scene, "b")->primitives[0].index_count, 3);
    assert_true(obj_has_warning(scene, "1 facets have fewer than 3 vertices"));
    scene_destroy(scene);
}

/* The triangles behind it are not those of the solid before. */
static void a_solid_ends_a_loop(void **state)
{
    (void)state;
    static const char bytes[] = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
                                "solid b\nfacet normal 0 0 1\nouter loop\nvertex 0 0 1\nvertex 1 0 1\n"
                                "vertex 0 1 1\nendloop\nendfacet\nendsolid b\n";
    facet_scene *scene = load(bytes, sizeof bytes - 1, NULL);
    assert_int_equal(scene->mesh_count, 1);
    assert_string_equal(scene->meshes[0].name, "b");
    assert_true(obj_has_warning(scene, "1 facets have fewer than 3 vertices"));
    scene_destroy(scene);
}

/* Corners that are one as floats stay apart where the text says so, relative to the place of the node. */
static void far_places_are_exact(void **state)
{
    (void)state;
    static const char bytes[] =
        "solid a\nfacet normal 0 0 1\nouter loop\nvertex 4500000.125 0 0\n"
        "vertex 4500000.25 0 0\nvertex 4500000.125 0.1 0\nendloop\nendfacet\nendsolid a\n";
    facet_scene *scene = load(bytes, sizeof bytes - 1, NULL);
    const scene_primitive *p = obj_only_primitive(scene);
    double at = scene->nodes[0].translation[0];
    assert_int_equal(p->vertex_count, 3);
    assert_near((double)obj_position(p, 0)[0] + at, 4500000.125, 1e-7);
    assert_near((double)obj_position(p, 1)[0] + at, 4500000.25, 1e-7);
    scene_destroy(scene);
}

static void damage_is_reported(void **state)
{
    (void)state;
    unsigned char binary[BINARY_SIZE];
    write_binary("x", binary);
    facet_scene *scene = load(binary, 84 + 50 * 5 + 7, NULL);
    assert_int_equal(obj_only_primitive(scene)->index_count, 15);
    assert_true(obj_has_warning(scene, "is cut off: 12 triangles were declared, 5 are there"));
    scene_destroy(scene);
    put_u32(binary + 84 + 12, 0x7fc00000u); /* not a number */
    put_u32(binary + 80, UINT32_MAX);
    scene = load(binary, sizeof binary, NULL);
    assert_int_equal(obj_only_primitive(scene)->index_count, 33);
    assert_true(obj_has_warning(scene, "1 triangles have a place that is not finite"));
    scene_destroy(scene);
    static const struct {
        const char *bytes, *message;
    } bad[] = {{"solid a\nfacet normal 0 0 0\nouter loop\nvertex 0 0 zero\n",
                "test.stl: line 4: a vertex must have three"},
               {"short", "is neither STL text"}};
    for (size_t i = 0; i < 2; i++) {
        facet_error error = {0};
        assert_int_equal(
            stl_load_memory(bad[i].bytes, strlen(bad[i].bytes), "test.stl", NULL, &scene, &error),
            FACET_ERROR_INVALID);
        assert_null(scene);
        assert_non_null(strstr(error.message, bad[i].message));
    }
    scene = load("solid a\nendsolid a\n", 19, NULL);
    assert_int_equal(scene->mesh_count, 0);
    assert_true(obj_has_warning(scene, "has no triangle or point that can be drawn"));
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(both_forms_are_read),  cmocka_unit_test(other_files_are_not),
        cmocka_unit_test(solids_are_objects),   cmocka_unit_test(a_solid_ends_a_loop),
        cmocka_unit_test(far_places_are_exact), cmocka_unit_test(damage_is_reported),
    };
    return cmocka_run_group_tests_name("stl", tests, NULL, NULL);
}
