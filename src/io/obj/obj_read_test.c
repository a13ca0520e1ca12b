/* Statements of OBJ files: numbers, indices, objects, materials, flaws. Normals: obj_normals_test.c. */
#define _POSIX_C_SOURCE 200809L
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "tests/support/support.h"
#include "io/obj/obj_test_support.h"

#define SQUARE "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"

static void files_are_detected(void **state)
{
    (void)state;
    const char *are[] = {"v 1 2 3", "# c\n\n  \tv 1 2 3\n", "\xef\xbb\xbfo x\n", "mtllib a.mtl\r\n", "G\n",
                         "s off\n", "usemtl x\n",           "cstype bezier\n"};
    const char *are_not[] = {"",           "# only a comment\n", "{\"asset\":{}}", "glTF\2",
                             "vx 1 2 3\n", "value 3\n",          "\x89PNG"};
    for (size_t i = 0; i < sizeof are / sizeof *are; i++)
        assert_true(obj_detect(are[i], strlen(are[i])));
    for (size_t i = 0; i < sizeof are_not / sizeof *are_not; i++)
        assert_false(obj_detect(are_not[i], strlen(are_not[i])));
    assert_false(obj_detect("usemtl", 4)); /* "usem" */
}

static void a_triangle_is_read(void **state)
{
    (void)state;
    facet_scene *scene =
        obj_load_text("# made by hand\no thing\nv 0 0 0\nv 2 0 0\nv 0 3 0\nvt 0.25 0.75\nvt 1 0\nvt 0 1\n"
                      "vn 0 0 2\nf 1/1/1 2/2/1 3/3/1\n",
                      NULL);
    const scene_primitive *p = obj_only_primitive(scene);
    assert_string_equal(scene->generator, "made by hand");
    assert_string_equal(scene->meshes[0].name, "thing");
    assert_string_equal(scene->nodes[0].name, "thing");
    assert_int_equal(p->vertex_count, 3);
    assert_int_equal(p->material, 0); /* OBJ has no surface without a material */
    assert_int_equal(scene->material_count, 1);
    assert_string_equal(scene->materials[0].name, "");
    assert_false(scene->legacy->materials[0].is_culled);
    const uint32_t indices[3] = {0, 1, 2};
    assert_memory_equal(p->indices, indices, sizeof indices);
    assert_true(p->positions[3] == 2.0f && p->positions[7] == 3.0f);
    assert_true(p->texcoords[0][0] == 0.25f && p->texcoords[0][1] == 0.25f); /* from the top */
    assert_true(p->normals[2] == 1.0f);
    assert_false(p->has_flat_normals);
    assert_int_equal(scene->warning_count, 0);
    scene_destroy(scene);
}

/* Positions are relative to the node's place, with all digits that the text has. */
static void distant_positions_keep_all_digits(void **state)
{
    (void)state;
    facet_scene *near =
        obj_load_text("o a\nv 0 0 0 1 0 0\nv 2.0000625 0 0.25\nv 0 3 1\nf 1 2 3\no b\nv 5 0 1e-3\n"
                      "f 1 2 -1\n",
                      NULL);
    facet_scene *far =
        obj_load_text("o a\nv 4526331 -1e8 0 1 0 0\nv 4526333.0000625 -1e8 0.25\nv +4526331 -99999997.000 1\n"
                      "f 1 2 3\no b\nv 4526336 -100000000 1e-3\nf 1 2 -1\n",
                      NULL);
    assert_int_equal(far->node_count, 2);
    for (uint32_t i = 0; i < 2; i++) {
        const double *at = far->nodes[i].translation;
        assert_near(at[0], 4526331.0, 16.0);
        assert_near(at[1], -1e8, 16.0);
        assert_true(at[0] == floor(at[0]) && at[1] == floor(at[1]) && at[2] == 0.0);
        const scene_primitive *p = &near->meshes[i].primitives[0], *q = &far->meshes[i].primitives[0];
        assert_int_equal(p->vertex_count, q->vertex_count);
        for (size_t k = 0; k < 3 * (size_t)p->vertex_count; k++) {
            const double move[3] = {4526331.0, -1e8, 0.0};
            assert_near((double)q->positions[k] + at[k % 3] - move[k % 3], p->positions[k], 2e-7);
            assert_near(q->normals[k], p->normals[k], 1e-6);
        }
        assert_memory_equal(p->colors, q->colors, 4 * p->vertex_count * sizeof(float));
    }
    assert_int_equal(far->warning_count, 0);
    scene_destroy(near);
    scene_destroy(far);
}

static void texcoords_are_kept_as_written_on_request(void **state)
{
    (void)state;
    const facet_scene_desc desc = {.has_flipped_texcoords = true};
    facet_scene *scene =
        obj_load_text("v 0 0 0\nv 2 0 0\nv 0 3 0\nvt 0.25 0.75\nvt 1\nvt 0 1 7\nf 1/1 2/2 3/3\n", &desc);
    const scene_primitive *p = obj_only_primitive(scene);
    assert_true(obj_texcoord(p, 0)[1] == 0.75f);
    assert_true(obj_texcoord(p, 1)[0] == 1.0f && obj_texcoord(p, 1)[1] == 0.0f);
    assert_true(obj_texcoord(p, 2)[1] == 1.0f);
    scene_destroy(scene);
}

/* Every notation of the same square gives the same scene. */
static void all_notations_give_the_same_scene(void **state)
{
    (void)state;
    facet_scene *expected = obj_load_text("g a b\n" SQUARE "f 1 2 3 4\n", NULL);
    assert_int_equal(obj_only_primitive(expected)->vertex_count, 4);
    assert_near(obj_area(obj_only_primitive(expected)), 1.0, 1e-12);
    assert_string_equal(expected->meshes[0].name, "a b");
    const char *ways[] = {
        "g a b\n" SQUARE "f -4 -3 -2 -1",
        "g a b\r\nv 0 0 0\r\nv 1 0 0\r\nv 1 1 0\r\nv 0 1 0\r\nf 1 2 3 4\r\n",
        "g a b\rv 0 0 0\rv 1 0 0\rv 1 1 0\rv 0 1 0\rf 1 2 3 4\r",
        "\xef\xbb\xbfG a b  \nV 0 0 0\nV\t1\t0\t0\t\n  v +1 1. .0 \nv 0 1e0 0 # end\nF 1 2 3 4 # end",
        "g a b\nv 0 0\\\n 0\nv 1 0 0\nv 1 1 0\nv 0 1 \\\r\n0\nf 1 \\\n2 \\\n 3 4\\\n",
        "g a b\n" SQUARE "fo 1 2 3 4\nvp 0 1\n#f 1 2 3\n\n   \n",
        "g a b\nf 1 2 3 4\n" SQUARE, /* before its use */
        "g a b\n" SQUARE "f 1 1 2 3 3 4 4 1\n",
        "g a b\nv 0 0 0 1\nv 1 0 0 1\nv 1 1 0 1\nv 0 1 0 1\nf 1// 2/ 3 4\n",
        "g b\ng a b\n" SQUARE "f 1 2 3 4\ng\n",
    };
    for (size_t i = 0; i < sizeof ways / sizeof *ways; i++) {
        facet_scene *scene = obj_load_text(ways[i], NULL);
        scene->warning_count = 0; /* one of them has statements that are left out */
        obj_assert_equal(scene, expected);
        scene_destroy(scene);
    }
    scene_destroy(expected);
}

static void vertices_are_shared(void **state)
{
    (void)state;
    /* Corner 2 with two texture coordinates, corner 3 with two normals. */
    facet_scene *scene =
        obj_load_text(SQUARE "vt 0 0\nvt 1 1\nvn 0 0 1\nvn 0 1 1\n"
                             "f 1/1/1 2/1/1 3/1/1\nf 1/1/1 3/1/2 4/1/1\nf 1/1/1 2/2/1 3/1/1\n",
                      NULL);
    const scene_primitive *p = obj_only_primitive(scene);
    assert_int_equal(p->index_count, 9);
    assert_int_equal(p->vertex_count, 6);
    assert_int_equal(p->indices[0], p->indices[3]);
    assert_int_equal(p->indices[2], p->indices[8]);
    assert_int_not_equal(p->indices[2], p->indices[4]);
    assert_int_not_equal(p->indices[1], p->indices[7]);
    scene_destroy(scene);
}

/* A million corners at one position, each with its own texture coordinate: a table keyed by position alone
 * would take minutes. */
static void many_vertices_at_one_position_are_fast(void **state)
{
    (void)state;
    enum { COUNT = 150000 };
    size_t room = (size_t)COUNT * 64;
    char *bytes = malloc(room);
    assert_non_null(bytes);
    size_t length = (size_t)snprintf(bytes, room, "v 0 0 0\nv 1 0 0\nv 0 1 0\n");
    for (int i = 0; i < COUNT; i++)
        length += (size_t)snprintf(bytes + length, room - length, "vt %d\n", i);
    for (int i = 1; i <= COUNT; i++)
        length += (size_t)snprintf(bytes + length, room - length, "f 1/%d 2/%d 3/%d\n", i, i, i);
    facet_scene *scene = obj_load_text(bytes, &(facet_scene_desc){.obj_normals = FACET_OBJ_NORMALS_SMOOTH});
    assert_int_equal(obj_only_primitive(scene)->vertex_count, 3 * COUNT);
    scene_destroy(scene);
    free(bytes);
}

static void objects_and_materials_are_read(void **state)
{
    (void)state;
    facet_scene *scene =
        obj_load_text("usemtl red\n" SQUARE "f 1 2 3\no one\nusemtl blue\nf 1 2 3\nusemtl red\nf 1 3 4\n"
                      "o two\ng part\nf 1 2 4\nusemtl\nf 2 3 4\no none\no one\nusemtl blue\nf 1 2 4\n"
                      "l 1 2 3\np 4\nl 3 4\n",
                      NULL);
    assert_int_equal(scene->mesh_count, 3);
    assert_string_equal(scene->meshes[0].name, "");
    const scene_mesh *one = obj_find_mesh(scene, "one");
    const scene_mesh *two = obj_find_mesh(scene, "two");
    assert_int_equal(one->primitive_count, 4);
    assert_int_equal(two->primitive_count, 2);
    assert_string_equal(scene->materials[one->primitives[0].material].name, "blue");
    assert_int_equal(one->primitives[0].index_count, 6); /* from both places */
    assert_string_equal(scene->materials[one->primitives[1].material].name, "red");
    assert_int_equal(one->primitives[2].mode, SCENE_LINES);
    assert_int_equal(one->primitives[2].index_count, 6);
    assert_int_equal(one->primitives[3].mode, SCENE_POINTS);
    assert_int_equal(two->primitives[0].material, one->primitives[1].material);
    assert_string_equal(scene->materials[two->primitives[1].material].name, "");
    assert_int_equal(scene->material_count, 3);
    assert_true(obj_has_warning(scene, "material \"red\" and 1 more are in no library"));
    scene_destroy(scene);
}

static void groups_without_objects_become_meshes(void **state)
{
    (void)state;
    facet_scene *scene =
        obj_load_text(SQUARE "g a\nf 1 2 3\ng\nf 1 2 3\ng b c\nf 1 2 3\ng a\nf 1 3 4\n", NULL);
    assert_int_equal(scene->mesh_count, 3);
    assert_int_equal(obj_find_mesh(scene, "a")->primitives[0].index_count, 6);
    assert_int_equal(obj_find_mesh(scene, "default")->primitives[0].index_count, 3);
    assert_int_equal(obj_find_mesh(scene, "b c")->primitives[0].index_count, 3);
    scene_destroy(scene);
}

static void names_are_read(void **state)
{
    (void)state;
    facet_scene *scene = obj_load_text(SQUARE "o caf\xe9 na\xc3\xafve #1 \nusemtl a \\\n b\nf 1 2 3\n", NULL);
    assert_string_equal(scene->meshes[0].name, "caf\xc3\xa9 na\xc3\xafve #1"); /* Latin-1 and UTF-8 */
    assert_string_equal(scene->materials[0].name, "a   b");
    scene_destroy(scene);
}

static void vertex_colors_are_read(void **state)
{
    (void)state;
    const char *numbers = "v 0 0 0 1 0.5 0\nv 1 0 0 0.2 0.2 0.2 0.25\nv 0 1 0\nf 1 2 3\n";
    facet_scene *scene = obj_load_text(numbers, NULL);
    const scene_primitive *p = obj_only_primitive(scene);
    const float expected[12] = {1, 0.2140411f, 0, 1, 0.0331048f, 0.0331048f, 0.0331048f, 0.25f, 1, 1, 1, 1};
    for (int i = 0; i < 12; i++)
        assert_near(p->colors[i], expected[i], 1e-6f);
    scene_destroy(scene);

    const facet_scene_desc linear = {.legacy.colors = FACET_LEGACY_COLORS_LINEAR};
    scene = obj_load_text(numbers, &linear);
    assert_true(obj_only_primitive(scene)->colors[1] == 0.5f);
    scene_destroy(scene);

    scene =
        obj_load_text("v 0 0 0 255 0 0\nv 1 0 0 0 51 0\nv 0 1 0 0 0 1\nf 1 2 3\n", &linear); /* of 8 bits */
    assert_true(obj_only_primitive(scene)->colors[0] == 1.0f);
    assert_near(obj_only_primitive(scene)->colors[5], 0.2f, 1e-7f);
    scene_destroy(scene);

    scene = obj_load_text("v 0 0 0 inf 1e9 -1 1e30\nv 1 0 0 nan 0 0 -1\nv 0 1 0\nf 1 2 3\n",
                          &linear); /* a vertex that does not exist */
    assert_true(obj_only_primitive(scene)->colors[3] == 1.0f && obj_only_primitive(scene)->colors[7] == 0.0f);
    scene_destroy(scene);

    scene = obj_load_text(SQUARE "#MRGB ff80FF00ff000000ffffffff\n#MRGB 00000033\nf 1 2 3\n", &linear);
    const float *colors = obj_only_primitive(scene)->colors;
    assert_near(colors[0], 128.0f / 255.0f, 1e-7f);
    assert_true(colors[1] == 1.0f && colors[2] == 0.0f && colors[8] == 1.0f);
    scene_destroy(scene);

    scene = obj_load_text("g a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\ng b\nv 0 0 0 1 1 1\nf 4 2 3\n", NULL);
    assert_null(obj_find_mesh(scene, "a")->primitives[0].colors);
    assert_non_null(obj_find_mesh(scene, "b")->primitives[0].colors);
    scene_destroy(scene);
}

static void invalid_indices_are_reported(void **state)
{
    (void)state;
    facet_scene *scene =
        obj_load_text(SQUARE "f 1 2 3\nf 0 1 2\nf 1 2 5\nf 1 2 999999999999999999999\nf -5 1 2\nf 1 2 x\n"
                             "f 1 2 3x 4\nf 1 2\nf 1 2 4000000000\nf 1 2 2147483653\nf 1/2/3/4 2 3\n"
                             "f 1 2 -9999999999\nl 1\nl 7 8\np 0\nf\n",
                      NULL);
    assert_int_equal(obj_only_primitive(scene)->index_count, 3);
    assert_true(obj_has_warning(
        scene, "test.obj: line 6: an element refers to a vertex that does not exist; it is left out "
               "(12 times in all)"));
    assert_true(obj_has_warning(
        scene, "line 12: a face has fewer than 3 different corners, or a line fewer than 2; it "
               "is left out (3 times in all)"));
    assert_int_equal(scene->warning_count, 2);
    scene_destroy(scene);
}

static void invalid_attributes_are_reported(void **state)
{
    (void)state;
    facet_scene *scene =
        obj_load_text(SQUARE "vt 0.5 0.5\nvn 0 0 1\nvn 0 0 0\nf 1/1/1 2/9/1 3/1/1\nf 1//1 3//7 4//-3\n"
                             "f 1//1 2//2 3//1\n",
                      NULL);
    const scene_primitive *p = obj_only_primitive(scene);
    assert_int_equal(p->index_count, 9);
    assert_true(obj_texcoord(p, 1)[0] == 0.0f && obj_texcoord(p, 1)[1] == 0.0f);
    assert_true(obj_has_warning(
        scene, "line 8: an element refers to a texture coordinate or normal that does not exist; it is "
               "drawn without (3 times in all)"));
    assert_true(obj_has_warning(scene, "line 10: a normal has no direction"));
    assert_true(obj_has_warning(scene, "get (0, 0) (7 times in all)"));
    assert_int_equal(scene->warning_count, 3);
    scene_destroy(scene);
}

static void invalid_numbers_are_reported(void **state)
{
    (void)state;
    facet_scene *scene =
        obj_load_text("v nan 0 0\nv 0 inf 0\nv 0 0 1e30\nv abc 0 0\nv 1 2\nv 3.1+e2 1 1\nv 1 0 0\n"
                      "vt nan 1\nf 1 5 6\nf 2 5 6\nf 3 5 6\nf 4 5 6\nf 5/1 6/1 7/1\nhello world\n",
                      NULL);
    const scene_primitive *p = obj_only_primitive(scene);
    assert_int_equal(p->index_count, 3);
    assert_true(obj_position(p, 0)[1] == 2.0f && obj_position(p, 0)[2] == 0.0f);
    assert_true(obj_position(p, 1)[0] == 3.1f);
    assert_true(obj_has_warning(scene, "line 1: a vertex is not finite"));
    assert_true(obj_has_warning(scene, "line 4: a word is not a number"));
    assert_true(obj_has_warning(scene, "line 5: a vertex has fewer than 3 coordinates"));
    assert_true(obj_has_warning(scene, "line 8: a texture coordinate is not finite"));
    assert_true(obj_has_warning(
        scene, "line 9: an element uses a vertex that is not finite; it is left out (4 times"));
    assert_true(obj_has_warning(scene, "line 14: the statement is unknown"));
    scene_destroy(scene);
}

static void unsupported_statements_are_reported(void **state)
{
    (void)state;
    facet_scene *scene =
        obj_load_text(SQUARE "f 1 2 3\nvp 0.3 0.7\ncstype bspline\ndeg 3\ncurv 0 1 \\\n 1 2 3\n"
                             "PARM u 0 1\nend\nlod 3\nbevel on\n",
                      NULL);
    assert_int_equal(obj_only_primitive(scene)->index_count, 3);
    assert_true(obj_has_warning(scene, "free-form curves and surfaces are not supported; ignored: "
                                       "vp, cstype, deg, curv, parm, end"));
    assert_true(obj_has_warning(scene, "ignored: bevel, lod"));
    assert_int_equal(scene->warning_count, 2);
    scene_destroy(scene);
}

static void files_without_geometry_are_refused(void **state)
{
    (void)state;
    facet_scene *scene = (facet_scene *)1;
    facet_error error;
    const char *nothing[] = {"", "\n\n", "# comment", "hello\nworld\n", "\xef\xbb\xbf"};
    for (size_t i = 0; i < sizeof nothing / sizeof *nothing; i++) {
        scene = (facet_scene *)1;
        assert_int_equal(obj_load_memory(nothing[i], strlen(nothing[i]), "test.obj", NULL, &scene, &error),
                         FACET_ERROR_INVALID);
        assert_null(scene);
        assert_non_null(strstr(error.message, "test.obj: has no statement of an OBJ file"));
    }
    scene = obj_load_text("g only a name\n", NULL);
    assert_int_equal(scene->mesh_count, 0);
    assert_true(obj_has_warning(scene, "has no face, line or point"));
    scene_destroy(scene);
    scene = NULL;
    assert_int_equal(obj_load("/nonexistent/x.obj", NULL, &scene, &error), FACET_ERROR_READ);
    assert_null(scene);
}

static void point_clouds_are_read(void **state)
{
    (void)state;
    facet_scene *scene = obj_load_text("v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv nan 0 0\nv 1 1 1 0 0 1\n", NULL);
    const scene_primitive *p = obj_only_primitive(scene);
    assert_int_equal(p->mode, SCENE_POINTS);
    assert_int_equal(p->vertex_count, 3);
    assert_true(p->colors[10] == 1.0f);
    assert_true(obj_has_warning(scene, "has vertices only; they are shown as points"));
    scene_destroy(scene);
}

static void lines_and_points_are_read(void **state)
{
    (void)state;
    facet_scene *scene = obj_load_text(SQUARE "vt 0 0\nvt 0.5 0\nl 1/1 2/2 3/1\nl 3 4 1\np 1 2\np 2\n", NULL);
    assert_int_equal(scene->meshes[0].primitive_count, 2);
    const scene_primitive *lines = &scene->meshes[0].primitives[0];
    assert_int_equal(lines->mode, SCENE_LINES);
    assert_int_equal(lines->index_count, 8);
    assert_int_equal(lines->texcoord_count, 1);
    assert_true(obj_texcoord(lines, 1)[0] == 0.5f);
    assert_int_equal(lines->indices[1], lines->indices[2]);
    const scene_primitive *points = &scene->meshes[0].primitives[1];
    assert_int_equal(points->mode, SCENE_POINTS);
    assert_int_equal(points->index_count, 3);
    assert_int_equal(points->vertex_count, 2);
    scene_destroy(scene);
}

static void polygons_are_triangulated(void **state)
{
    (void)state;
    /* An L of area 3, a dart of area 1, a square with a hole over a bridge: 16 - 4. */
    facet_scene *scene =
        obj_load_text("g l\nv 0 0 1\nv 2 0 1\nv 2 1 1\nv 1 1 1\nv 1 2 1\nv 0 2 1\nf 1 2 3 4 5 6\n"
                      "g dart\nv 0 5 0\nv 0 5.5 0.5\nv 0 7 0\nv 0 5.5 -0.5\nv 0 6 0\nf 9 8 11 10\n"
                      "g hole\nv 0 0 0\nv 4 0 0\nv 4 0 4\nv 0 0 4\nv 1 0 1\nv 1 0 3\nv 3 0 3\nv 3 0 1\n"
                      "f 12 13 14 15 12 16 17 18 19 16\n",
                      NULL);
    const scene_primitive *l = &obj_find_mesh(scene, "l")->primitives[0];
    assert_int_equal(l->index_count, 12);
    assert_near(obj_area(l), 3.0, 1e-12);
    const scene_primitive *dart = &obj_find_mesh(scene, "dart")->primitives[0];
    assert_int_equal(dart->index_count, 6);
    assert_near(obj_area(dart), 0.5, 1e-6); /* the other diagonal would give 1 */
    const scene_primitive *hole = &obj_find_mesh(scene, "hole")->primitives[0];
    assert_int_equal(hole->index_count, 24);
    assert_near(obj_area(hole), 12.0, 1e-12);
    scene_destroy(scene);
}

static void many_groups_are_read(void **state)
{
    (void)state;
    enum { COUNT = 100000 };
    size_t room = (size_t)COUNT * 64;
    char *bytes = malloc(room);
    assert_non_null(bytes);
    size_t length = (size_t)snprintf(bytes, room, SQUARE);
    for (int i = 0; i < COUNT; i++)
        length += (size_t)snprintf(bytes + length, room - length, "g %d\ns %d\nf 1 2 3\n", i, i);
    facet_scene *scene = obj_load_text(bytes, NULL);
    assert_int_equal(scene->mesh_count, COUNT);
    assert_string_equal(scene->meshes[COUNT - 1].name, "99999");
    scene_destroy(scene);
    free(bytes);
}

static void roots_and_size_limits_hold(void **state)
{
    (void)state;
    char path[] = "/tmp/facet-obj-XXXXXX";
    int descriptor = mkstemp(path);
    assert_true(descriptor >= 0);
    close(descriptor);
    facet_error error;
    assert_int_equal(file_write(path, SQUARE "f 1 2 3 4\n", strlen(SQUARE) + 10, &error), FACET_OK);
    facet_scene *scene = NULL;
    assert_int_equal(obj_load(path, &(facet_scene_desc){.max_file_bytes = 10}, &scene, &error),
                     FACET_ERROR_LIMIT);
    assert_null(scene);
    assert_int_equal(obj_load(path, NULL, &scene, &error), FACET_OK);
    assert_int_equal(obj_only_primitive(scene)->index_count, 6);
    scene_destroy(scene);
    remove(path);
}

/* If any allocation fails, that is the result, and nothing leaks. */
static void failed_allocations_are_reported(void **state)
{
    (void)state;
    const char *bytes =
        "mtllib none.mtl\no a\nusemtl m\n" SQUARE
        "v 2 2 2 1 0 0\nvt 0 0\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1\nf 1 2 3 4\nf 1 2 3 4 5\nl 1 2\np 3\ns 1\n"
        "f 1 3 4\nf 9 9 9\nvp 1\n#MRGB ff00ff00\nl 1 2\n";
    bool is_done = false;
    for (long at = 0; !is_done; at = next_failure(at)) {
        failing_allocator failing = {.fail_at = at};
        const facet_scene_desc desc = {.allocator = failing_allocator_get(&failing), .thread_count = 1};
        facet_scene *scene = NULL;
        facet_error error = {0};
        facet_result result = obj_load_memory(bytes, strlen(bytes), "test.obj", &desc, &scene, &error);
        assert_true(result == FACET_OK || (result == FACET_ERROR_MEMORY && !scene && error.message[0]));
        is_done = atomic_load(&failing.calls) <= at;
        assert_true(!is_done || result == FACET_OK);
        scene_destroy(scene);
        assert_int_equal(atomic_load(&failing.blocks), 0);
        assert_true(at < 10000);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(files_are_detected),
        cmocka_unit_test(a_triangle_is_read),
        cmocka_unit_test(distant_positions_keep_all_digits),
        cmocka_unit_test(texcoords_are_kept_as_written_on_request),
        cmocka_unit_test(all_notations_give_the_same_scene),
        cmocka_unit_test(vertices_are_shared),
        cmocka_unit_test(many_vertices_at_one_position_are_fast),
        cmocka_unit_test(objects_and_materials_are_read),
        cmocka_unit_test(groups_without_objects_become_meshes),
        cmocka_unit_test(names_are_read),
        cmocka_unit_test(vertex_colors_are_read),
        cmocka_unit_test(invalid_indices_are_reported),
        cmocka_unit_test(invalid_attributes_are_reported),
        cmocka_unit_test(invalid_numbers_are_reported),
        cmocka_unit_test(unsupported_statements_are_reported),
        cmocka_unit_test(files_without_geometry_are_refused),
        cmocka_unit_test(point_clouds_are_read),
        cmocka_unit_test(lines_and_points_are_read),
        cmocka_unit_test(polygons_are_triangulated),
        cmocka_unit_test(many_groups_are_read),
        cmocka_unit_test(roots_and_size_limits_hold),
        cmocka_unit_test(failed_allocations_are_reported),
    };
    return cmocka_run_group_tests_name("obj_read", tests, NULL, NULL);
}
