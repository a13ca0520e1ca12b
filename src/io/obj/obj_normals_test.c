/* Normals of files that have none: flat, by smoothing groups, by angles. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "io/obj/obj_test_support.h"

#define CUBE_POINTS "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n"
#define CUBE_FACES "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 3 4 8 7\nf 2 3 7 6\nf 1 5 8 4\n"

static facet_scene *load(const char *bytes, facet_obj_normals normals)
{
    return obj_load_text(bytes, &(facet_scene_desc){.obj_normals = normals});
}

/* Each corner of a cube around the origin has the normal of its face. */
static void assert_cube_is_flat(const scene_primitive *p)
{
    assert_int_equal(p->index_count, 36);
    for (size_t i = 0; i < 36; i += 3)
        for (size_t k = 0; k < 3; k++) {
            const float *n = obj_normal(p, i + k);
            int axis = fabsf(n[0]) > 0.5f ? 0 : fabsf(n[1]) > 0.5f ? 1 : 2;
            assert_near(fabsf(n[axis]), 1.0f, 1e-6f);
            for (size_t j = 0; j < 3; j++)
                assert_near(obj_position(p, i + j)[axis], n[axis], 1e-6f);
        }
}

static void flat_faces_have_their_normals(void **state)
{
    (void)state;
    const char *flat[] = {CUBE_POINTS CUBE_FACES, "s off\n" CUBE_POINTS CUBE_FACES,
                          CUBE_POINTS "s 0\n" CUBE_FACES, CUBE_POINTS CUBE_FACES "s 1\n"};
    for (size_t i = 0; i < sizeof flat / sizeof *flat; i++) {
        facet_scene *scene = load(flat[i], i == 0 ? FACET_OBJ_NORMALS_FLAT : FACET_OBJ_NORMALS_AUTO);
        const scene_primitive *p = obj_only_primitive(scene);
        assert_true(p->has_flat_normals);
        assert_int_equal(p->vertex_count, 36);
        assert_cube_is_flat(p);
        scene_destroy(scene);
    }
}

static void sharp_edges_stay_sharp(void **state)
{
    (void)state;
    facet_scene *scene = load(CUBE_POINTS CUBE_FACES, FACET_OBJ_NORMALS_AUTO);
    const scene_primitive *p = obj_only_primitive(scene);
    assert_int_equal(p->vertex_count, 24); /* shared across the diagonals */
    assert_false(p->has_flat_normals);
    assert_cube_is_flat(p);
    scene_destroy(scene);
}

/* However its sides are cut, a cube's corners point along its diagonals: weights are angles. */
static void smooth_cubes_have_diagonal_normals(void **state)
{
    (void)state;
    const char *smooth[] = {CUBE_POINTS CUBE_FACES, CUBE_POINTS "s 1\n" CUBE_FACES,
                            CUBE_POINTS
                            "s on\nf 4 3 2\nf 2 1 4\nf 5 6 7\nf 5 7 8\nf 1 2 6\nf 1 6 5\nf 3 4 8\nf 3 8 7\n"
                            "f 3 7 6\nf 6 2 3\nf 1 5 8\nf 8 4 1\n"};
    for (size_t i = 0; i < sizeof smooth / sizeof *smooth; i++) {
        facet_scene *scene = load(smooth[i], i == 0 ? FACET_OBJ_NORMALS_SMOOTH : FACET_OBJ_NORMALS_AUTO);
        const scene_primitive *p = obj_only_primitive(scene);
        assert_int_equal(p->vertex_count, 8);
        for (size_t k = 0; k < 36; k++)
            for (size_t axis = 0; axis < 3; axis++)
                assert_near(obj_normal(p, k)[axis], obj_position(p, k)[axis] * 0.57735027f, 2e-5f);
        scene_destroy(scene);
    }
}

/* A tube of count sides with lids: sides of 24 are smooth, of 6 are not; lids are flat. */
static facet_scene *load_tube(int count)
{
    char bytes[8192];
    size_t length = 0;
    for (int i = 0; i < 2 * count; i++)
        length += (size_t)snprintf(bytes + length, sizeof bytes - length, "v %.9g %.9g %d\n",
                                   cos(6.283185307179586 * i / count), sin(6.283185307179586 * i / count),
                                   i / count);
    for (int i = 0; i < count; i++)
        length += (size_t)snprintf(bytes + length, sizeof bytes - length, "f %d %d %d %d\n", i + 1,
                                   (i + 1) % count + 1, (i + 1) % count + 1 + count, i + 1 + count);
    length += (size_t)snprintf(bytes + length, sizeof bytes - length, "f");
    for (int i = 0; i < count; i++)
        length += (size_t)snprintf(bytes + length, sizeof bytes - length, " %d", count + 1 + i);
    length += (size_t)snprintf(bytes + length, sizeof bytes - length, "\nf");
    for (int i = count; i > 0; i--)
        length += (size_t)snprintf(bytes + length, sizeof bytes - length, " %d", i);
    return load(bytes, FACET_OBJ_NORMALS_AUTO);
}

static void tubes_are_smooth_with_sharp_rims(void **state)
{
    (void)state;
    facet_scene *scene = load_tube(24);
    const scene_primitive *p = obj_only_primitive(scene);
    assert_int_equal(p->vertex_count, 4 * 24);
    assert_int_equal(p->index_count, 3 * (2 * 24 + 2 * 22));
    for (size_t i = 0; i < p->vertex_count; i++) {
        const float *n = p->normals + 3 * i;
        const float *at = p->positions + 3 * i;
        if (fabsf(n[2]) > 0.5f)
            assert_near(n[2], at[2] > 0.5f ? 1.0f : -1.0f, 1e-6f);
        else
            assert_near(n[0] * at[0] + n[1] * at[1], 1.0f, 1e-5f);
    }
    scene_destroy(scene);
    scene = load_tube(6); /* 60 degrees */
    p = obj_only_primitive(scene);
    assert_int_equal(p->vertex_count, 6 * 4 + 2 * 6);
    scene_destroy(scene);
    scene = load_tube(8); /* 45 degrees is the first that is sharp, give or take rounding */
    scene_destroy(scene);
}

/* Two squares like an open book, 90 degrees. */
#define BOOK_POINTS "v 0 0 0\nv 0 1 0\nv 1 0 0\nv 1 1 0\nv 0 0 1\nv 0 1 1\n"

static void groups_override_the_angle(void **state)
{
    (void)state;
    facet_scene *scene = load(BOOK_POINTS "s 3\nf 1 3 4 2\nf 1 2 6 5\n", FACET_OBJ_NORMALS_AUTO);
    const scene_primitive *p = obj_only_primitive(scene);
    assert_int_equal(p->vertex_count, 6);
    assert_near(obj_normal(p, 0)[0], 0.70710678f, 1e-5f); /* at the back: the mean of +X and +Z */
    assert_near(obj_normal(p, 0)[2], 0.70710678f, 1e-5f);
    assert_near(obj_normal(p, 1)[2], 1.0f, 1e-6f);
    scene_destroy(scene);

    scene = load(BOOK_POINTS "s 3\nf 1 3 4 2\ns 4\nf 1 2 6 5\n", FACET_OBJ_NORMALS_AUTO);
    p = obj_only_primitive(scene);
    assert_int_equal(p->vertex_count, 8);
    assert_near(obj_normal(p, 0)[2], 1.0f, 1e-6f);
    assert_false(p->has_flat_normals);
    scene_destroy(scene);

    scene =
        load(BOOK_POINTS "f 1 3 4 2\ns 4\nf 1 2 6 5\n", FACET_OBJ_NORMALS_AUTO); /* off before the first s */
    assert_int_equal(obj_only_primitive(scene)->vertex_count, 6 + 4);
    scene_destroy(scene);

    /* Across materials and objects: it is the position that is shared. */
    scene = load(BOOK_POINTS "s 3\no a\nf 1 3 4 2\no b\nf 1 2 6 5\n", FACET_OBJ_NORMALS_AUTO);
    assert_near(obj_normal(&obj_find_mesh(scene, "a")->primitives[0], 0)[0], 0.70710678f, 1e-5f);
    assert_near(obj_normal(&obj_find_mesh(scene, "b")->primitives[0], 0)[2], 0.70710678f, 1e-5f);
    scene_destroy(scene);
}

/* A bent sheet of 6 x 6 squares: in front, then behind as well (cut along the same or along other
 * diagonals). */
enum { SHEET_SIDE = 7 };

static size_t write_sheet(char *out, size_t room, const char *group, int sides)
{
    size_t length = 0;
    for (int i = 0; i < SHEET_SIDE * SHEET_SIDE; i++) {
        double x = (i % SHEET_SIDE) / 3.0 - 1.0;
        double y = i / SHEET_SIDE / 3.0 - 1.0;
        length += (size_t)snprintf(out + length, room - length, "v %.6f %.6f %.6f\n", x, y,
                                   0.5 * cos(1.3 * x) + 0.2 * x * y);
    }
    length += (size_t)snprintf(out + length, room - length, "%s", group);
    for (int side = 0; side < sides; side++)
        for (int i = 0; i < (SHEET_SIDE - 1) * (SHEET_SIDE - 1); i++) {
            int a = i / (SHEET_SIDE - 1) * SHEET_SIDE + i % (SHEET_SIDE - 1) + 1;
            int c = a + SHEET_SIDE + 1;
            length += side == 0 ? (size_t)snprintf(out + length, room - length, "f %d %d %d\nf %d %d %d\n", a,
                                                   a + 1, c, a, c, c - 1)
                      : side == 1 ? (size_t)snprintf(out + length, room - length, "f %d %d %d\nf %d %d %d\n",
                                                     c, a + 1, a, c - 1, c, a)
                                  : (size_t)snprintf(out + length, room - length, "f %d %d %d\nf %d %d %d\n",
                                                     c - 1, a + 1, a, c - 1, c, a + 1);
        }
    return length;
}

/* A sheet that exists twice, with opposite windings, has the normals of the front one, to the last bit. */
static void sheets_with_two_sides_have_the_normals_of_the_front(void **state)
{
    (void)state;
    static const struct {
        const char *group;
        facet_obj_normals normals;
    } ways[] = {{"s 1\n", FACET_OBJ_NORMALS_AUTO}, {"", FACET_OBJ_NORMALS_SMOOTH}};
    const size_t front = 6 * (SHEET_SIDE - 1) * (SHEET_SIDE - 1);
    char *bytes = malloc(1 << 16);
    assert_non_null(bytes);
    for (size_t i = 0; i < 2; i++) {
        write_sheet(bytes, 1 << 16, ways[i].group, 1);
        facet_scene *one = load(bytes, ways[i].normals);
        for (int sides = 2; sides <= 3; sides++) {
            write_sheet(bytes, 1 << 16, ways[i].group, sides);
            facet_scene *two = load(bytes, ways[i].normals);
            const scene_primitive *p = obj_only_primitive(two);
            for (size_t k = 0; k < front; k++) {
                const float *wanted = obj_normal(obj_only_primitive(one), k);
                assert_memory_equal(obj_normal(p, k), wanted, 3 * sizeof *wanted);
                assert_true(wanted[2] > 0.5f);
            }
            for (size_t k = front; k < p->index_count; k++)
                assert_true(obj_normal(p, k)[2] < -0.5f);
            scene_destroy(two);
        }
        scene_destroy(one);
    }
    free(bytes);
}

/* A wall on a floor, both with two sides in one group: each side of each stays with itself. */
static void sheets_that_meet_stay_separate(void **state)
{
    (void)state;
    facet_scene *scene =
        load("v 0 0 0\nv 0 0 1\nv 1 0 0\nv 1 0 1\nv -1 0 0\nv -1 0 1\nv 0.2 1 0\nv 0.2 1 1\ns 1\n"
             "f 1 2 4 3\nf 1 3 4 2\nf 5 6 2 1\nf 5 1 2 6\nf 1 7 8 2\nf 1 2 8 7\n",
             FACET_OBJ_NORMALS_AUTO);
    const scene_primitive *p = obj_only_primitive(scene);
    const float up[] = {1, -1, 1, -1};
    for (size_t k = 0; k < 24; k++)
        assert_near(obj_normal(p, k)[1], up[k / 6], 1e-5f);
    for (size_t k = 24; k < 36; k++)
        assert_true(obj_normal(p, k)[0] * (k < 30 ? 1.0f : -1.0f) > 0.9f);
    scene_destroy(scene);
}

static void normals_of_the_file_come_first(void **state)
{
    (void)state;
    facet_scene *scene =
        load(BOOK_POINTS "vn 0 0.6 0.8\nf 1//1 3//1 4//1 2//1\nf 1//1 2 6 5\n", FACET_OBJ_NORMALS_FLAT);
    const scene_primitive *p = obj_only_primitive(scene);
    assert_int_equal(p->vertex_count, 4 + 6);
    assert_near(obj_normal(p, 0)[1], 0.6f, 1e-6f);
    assert_near(obj_normal(p, 6)[0], 1.0f, 1e-6f); /* not all corners of this one have some */
    assert_false(p->has_flat_normals);
    scene_destroy(scene);
}

/* Triangles without area leave the others as they are. */
static void triangles_without_area_do_not_affect_others(void **state)
{
    (void)state;
    facet_scene *scene = load(CUBE_POINTS "v -1 -1 -1\nv 0 -1 -1\n" CUBE_FACES "f 1 2 9\nf 1 10 2\n",
                              FACET_OBJ_NORMALS_SMOOTH);
    const scene_primitive *p = obj_only_primitive(scene);
    for (size_t k = 0; k < 36; k++)
        assert_near(obj_normal(p, k)[0], obj_position(p, k)[0] * 0.57735027f, 2e-5f);
    scene_destroy(scene);
    scene = load("v 0 0 0\nv 0 0 0\nv 0 0 0\nf 1 2 3\n", FACET_OBJ_NORMALS_AUTO);
    assert_near(obj_normal(obj_only_primitive(scene), 0)[1], 1.0f, 1e-6f);
    scene_destroy(scene);
}

/* A cone of many triangles around one point, flat enough to be smooth, then with a group per triangle. */
static void many_triangles_at_one_position_are_smoothed(void **state)
{
    (void)state;
    enum { COUNT = 5000 };
    size_t room = (size_t)COUNT * 96;
    char *bytes = malloc(room);
    assert_non_null(bytes);
    for (int has_groups = 0; has_groups < 2; has_groups++) {
        size_t length = (size_t)snprintf(bytes, room, "v 0 0 0.2\n");
        for (int i = 0; i < COUNT; i++)
            length +=
                (size_t)snprintf(bytes + length, room - length, "v %.9g %.9g 0\n",
                                 cos(6.283185307179586 * i / COUNT), sin(6.283185307179586 * i / COUNT));
        for (int i = 0; i < COUNT; i++)
            length += (size_t)snprintf(bytes + length, room - length,
                                       has_groups ? "s %d\nf 1 %d %d\n" : "#%d\nf 1 %d %d\n", 1 + i % 7,
                                       i + 2, (i + 1) % COUNT + 2);
        facet_scene *scene = load(bytes, FACET_OBJ_NORMALS_AUTO);
        const scene_primitive *p = obj_only_primitive(scene);
        assert_int_equal(p->vertex_count, has_groups ? 2 * COUNT + 7 - (COUNT % 7 == 1) : COUNT + 1);
        for (size_t i = 0; i < p->index_count; i += 3)
            assert_near(obj_normal(p, i)[2], 1.0f, has_groups ? 2e-3f : 1e-6f);
        scene_destroy(scene);
    }
    free(bytes);
}

/* Three sheets along one edge: the two that are level are smooth, the third is not. */
static void of_three_sheets_the_level_ones_are_smooth(void **state)
{
    (void)state;
    facet_scene *scene = load("v 0 0 0\nv 0 1 0\nv 1 0 0\nv -1 0 0\nv 0 0 1\nf 1 3 2\nf 1 5 2\nf 1 2 4\n",
                              FACET_OBJ_NORMALS_AUTO);
    const scene_primitive *p = obj_only_primitive(scene);
    assert_int_equal(p->vertex_count, 4 + 3);
    assert_near(obj_normal(p, 0)[2], 1.0f, 1e-6f);
    assert_near(fabsf(obj_normal(p, 3)[0]), 1.0f, 1e-6f);
    assert_int_equal(p->indices[0], p->indices[6]);
    scene_destroy(scene);
}

/* Tiny and huge ones keep their directions. */
static void normals_do_not_depend_on_size(void **state)
{
    (void)state;
    const char *sizes[] = {"1e-30", "1e-18", "1", "1e16"};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++)
        for (int normals = 0; normals < 3; normals++) {
            char bytes[256];
            snprintf(bytes, sizeof bytes, "v 0 0 0\nv %s 0 0\nv 0 %s 0\nf 1 2 3\n", sizes[i], sizes[i]);
            facet_scene *scene = load(bytes, (facet_obj_normals)normals);
            for (size_t k = 0; k < 3; k++)
                assert_near(obj_normal(obj_only_primitive(scene), k)[2], 1.0f, 1e-6f);
            scene_destroy(scene);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(flat_faces_have_their_normals),
        cmocka_unit_test(sharp_edges_stay_sharp),
        cmocka_unit_test(smooth_cubes_have_diagonal_normals),
        cmocka_unit_test(tubes_are_smooth_with_sharp_rims),
        cmocka_unit_test(groups_override_the_angle),
        cmocka_unit_test(sheets_with_two_sides_have_the_normals_of_the_front),
        cmocka_unit_test(sheets_that_meet_stay_separate),
        cmocka_unit_test(normals_of_the_file_come_first),
        cmocka_unit_test(triangles_without_area_do_not_affect_others),
        cmocka_unit_test(many_triangles_at_one_position_are_smoothed),
        cmocka_unit_test(of_three_sheets_the_level_ones_are_smooth),
        cmocka_unit_test(normals_do_not_depend_on_size),
    };
    return cmocka_run_group_tests_name("obj_normals", tests, NULL, NULL);
}
