#include "io/obj/obj_triangulate.h"
#include "tests/support/support.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_CORNERS = 200000 };

typedef struct shape {
    uint32_t count;
    double xy[2 * MAX_CORNERS];
} shape;

static shape s;
static obj_polygon polygon;
static uint32_t triangles[3 * MAX_CORNERS];

static void add(double x, double y)
{
    assert_true(s.count < MAX_CORNERS);
    s.xy[2 * s.count] = x;
    s.xy[2 * s.count + 1] = y;
    s.count++;
}

/* The shape in space: axis 0 .. 2 is the plane's normal, 3 a tilted plane. */
static void place(int plane)
{
    static const double u[4][3] = {{0, 1, 0}, {0, 0, 1}, {1, 0, 0}, {0.8, 0.0, 0.6}};
    static const double v[4][3] = {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-0.36, 0.8, 0.48}};
    assert_true(obj_polygon_reserve(&polygon, s.count));
    for (size_t i = 0; i < s.count; i++)
        for (size_t k = 0; k < 3; k++)
            polygon.points[3 * i + k] =
                (float)(s.xy[2 * i] * u[plane][k] + s.xy[2 * i + 1] * v[plane][k] + 3.0);
}

static double signed_area(uint32_t a, uint32_t b, uint32_t c)
{
    const double *p = s.xy + 2 * (size_t)a;
    const double *q = s.xy + 2 * (size_t)b;
    const double *r = s.xy + 2 * (size_t)c;
    return 0.5 * ((q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]));
}

static double shape_area(void)
{
    double sum = 0.0;
    for (uint32_t i = 1; i + 1 < s.count; i++)
        sum += signed_area(0, i, i + 1);
    return sum;
}

/* Triangles with the area of the shape, none inverted, every corner used. slack: area that rounding may
 * turn over. */
static void check_triangles(double slack)
{
    obj_triangulate(&polygon, s.count, triangles);
    assert_false(polygon.is_rough);
    double area = shape_area();
    double sum = 0.0;
    double wrong = 0.0;
    uint8_t *is_used = calloc(s.count, 1);
    for (uint32_t t = 0; t + 2 < s.count; t++) {
        const uint32_t *corners = triangles + 3 * (size_t)t;
        for (int k = 0; k < 3; k++) {
            assert_true(corners[k] < s.count);
            is_used[corners[k]] = 1;
        }
        assert_true(corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0]);
        double own = signed_area(corners[0], corners[1], corners[2]) * (area < 0.0 ? -1.0 : 1.0);
        sum += own;
        wrong = fmin(wrong, own);
    }
    for (uint32_t i = 0; i < s.count; i++)
        assert_true(is_used[i]);
    free(is_used);
    if (fabs(sum - fabs(area)) > 1e-9 * fabs(area) + slack || wrong < -slack)
        fail_msg("%u corners: area %.12g of %.12g, least %.3g", s.count, sum, fabs(area), wrong);
}

static void check_in_all_planes(void)
{
    for (int plane = 0; plane < 4; plane++) {
        place(plane);
        check_triangles(plane == 3 ? 1e-6 * fabs(shape_area()) : 1e-7 * fabs(shape_area()));
    }
    for (uint32_t i = 0; i < s.count / 2; i++) /* the other way round */
        for (int k = 0; k < 2; k++) {
            size_t a = 2 * (size_t)i + (size_t)k;
            size_t b = 2 * (size_t)(s.count - 1 - i) + (size_t)k;
            double swapped = s.xy[a];
            s.xy[a] = s.xy[b];
            s.xy[b] = swapped;
        }
    place(1);
    check_triangles(1e-7 * fabs(shape_area()));
}

static void stars_are_triangulated(void **state)
{
    (void)state;
    uint64_t random = 1;
    for (int round = 0; round < 400; round++) {
        s.count = 0;
        uint32_t count = 3 + (uint32_t)(lcg64_double(&random) * (round < 300 ? 30 : 500));
        for (uint32_t i = 0; i < count; i++) {
            double angle = 6.283185307179586 * ((double)i + 0.8 * lcg64_double(&random)) / (double)count;
            double radius = 0.1 + lcg64_double(&random);
            add(radius * cos(angle), radius * sin(angle));
        }
        check_in_all_planes();
    }
}

/* Along a spiral, and back beside it. */
static void make_spiral(uint32_t count, double turns)
{
    s.count = 0;
    for (uint32_t i = 0; i < count; i++) {
        double t = (double)i / (double)(count - 1);
        double angle = 6.283185307179586 * turns * t;
        add((1.0 + turns * t) * cos(angle), (1.0 + turns * t) * sin(angle));
    }
    for (uint32_t i = count; i-- > 0;) {
        double t = (double)i / (double)(count - 1);
        double angle = 6.283185307179586 * turns * t;
        add((0.6 + turns * t) * cos(angle), (0.6 + turns * t) * sin(angle));
    }
}

static void make_comb(uint32_t teeth)
{
    s.count = 0;
    add(0, -1);
    add(teeth, -1);
    for (uint32_t i = teeth; i-- > 0;) {
        add(i + 1, 0);
        add(i + 0.75, 10);
        add(i + 0.25, 10);
        add(i, 0);
        if (i > 0 && i % 3 == 0) /* points on a straight line, and one point twice */
            add(i, 0);
    }
}

static void spirals_and_combs_are_triangulated(void **state)
{
    (void)state;
    for (uint32_t count = 8; count < 300; count += 13) {
        make_spiral(count, 0.02 * count);
        check_in_all_planes();
        make_comb(count);
        check_in_all_planes();
    }
}

/* Examining all pairs of so many corners would take minutes. */
static void large_polygons_are_fast(void **state)
{
    (void)state;
    make_spiral(20000, 30.0);
    place(2);
    check_triangles(1e-6 * shape_area());
    make_comb(30000);
    place(2);
    check_triangles(1e-6 * shape_area());
}

static void straight_corners_are_triangulated(void **state)
{
    (void)state;
    s.count = 0;
    for (int i = 0; i < 10; i++)
        add(i, 0);
    for (int i = 0; i < 10; i++)
        add(10, i);
    for (int i = 10; i > 0; i--)
        add(i, 10);
    for (int i = 10; i > 0; i--)
        add(0, i);
    check_in_all_planes();
    /* None of its triangles is flat: the points on the sides are corners of others. */
    obj_triangulate(&polygon, s.count, triangles);
    for (uint32_t t = 0; t + 2 < s.count; t++)
        assert_true(fabs(signed_area(triangles[3 * t], triangles[3 * t + 1], triangles[3 * t + 2])) > 0.1);
}

/* A square with a square hole, reached over a bridge that is passed twice. */
static void holes_over_a_bridge_are_kept(void **state)
{
    (void)state;
    const double corners[][2] = {{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0},
                                 {1, 1}, {1, 3}, {3, 3}, {3, 1}, {1, 1}};
    s.count = 0;
    for (size_t i = 0; i < sizeof corners / sizeof *corners; i++)
        add(corners[i][0], corners[i][1]);
    check_in_all_planes();
    place(2);
    check_triangles(0.0);
    for (uint32_t t = 0; t + 2 < s.count; t++) { /* the hole stays free: its middle is in no triangle */
        const uint32_t *c = triangles + 3 * (size_t)t;
        uint32_t middle = s.count;
        s.xy[2 * middle] = s.xy[2 * middle + 1] = 2.0;
        assert_false(signed_area(c[0], c[1], middle) > 0.0 && signed_area(c[1], c[2], middle) > 0.0 &&
                     signed_area(c[2], c[0], middle) > 0.0);
    }
}

/* Two holes that share one corner of the outline. */
static void two_bridges_may_share_a_corner(void **state)
{
    (void)state;
    const double corners[][2] = {{0, 0}, {10, 0}, {10, 10}, {0, 10}, {0, 0}, {1, 4}, {1, 6}, {3, 6},
                                 {3, 4}, {1, 4},  {0, 0},   {4, 1},  {4, 3}, {6, 3}, {6, 1}, {4, 1}};
    s.count = 0;
    for (size_t i = 0; i < sizeof corners / sizeof *corners; i++)
        add(corners[i][0], corners[i][1]);
    assert_true(fabs(shape_area() - 92.0) < 1e-9);
    check_in_all_planes();
}

/* Triangles of one that crosses itself, or has no area: as many, and their signed areas sum up. */
static void odd_polygons_keep_their_signed_area(void **state)
{
    (void)state;
    uint64_t random = 5;
    for (int round = 0; round < 200; round++) {
        s.count = 0;
        uint32_t count = 5 + (uint32_t)(lcg64_double(&random) * 60);
        for (uint32_t i = 0; i < count; i++)
            add(floor(8 * lcg64_double(&random)), floor((round % 5 ? 8 : 1) * lcg64_double(&random)));
        place(2);
        obj_triangulate(&polygon, s.count, triangles);
        double sum = 0.0;
        for (uint32_t t = 0; t + 2 < s.count; t++)
            sum += signed_area(triangles[3 * t], triangles[3 * t + 1], triangles[3 * t + 2]);
        assert_true(fabs(sum - shape_area()) < 1e-9);
    }
}

/* The work is limited for the worst polygons, too. */
static void the_work_is_limited(void **state)
{
    (void)state;
    uint64_t random = 6;
    s.count = 0;
    for (uint32_t i = 0; i < 100000; i++)
        add(lcg64_double(&random), lcg64_double(&random));
    place(2);
    obj_triangulate(&polygon, s.count, triangles);
    for (uint32_t i = 0; i < 3 * (s.count - 2); i++)
        assert_true(triangles[i] < s.count);
    assert_true(polygon.is_rough);
}

static void quads_are_split_well(void **state)
{
    (void)state;
    const float a[3] = {0, 0, 0};
    const float b[3] = {1, 0, 0};
    const float c[3] = {1, 1, 0};
    const float d[3] = {0, 1, 0};
    const float dent[3] = {0.75f, 0.75f, 0};
    const float middle[3] = {0.5f, 0.5f, 0};
    assert_int_equal(obj_split_quad(a, b, c, d)[5], 3);
    assert_int_equal(obj_split_quad(a, b, c, d)[2],
                     2); /* from the first corner where both diagonals will do */
    assert_int_equal(obj_split_quad(d, c, b, a)[2], 2);
    assert_int_equal(obj_split_quad(dent, b, c, d)[2], 2); /* the dent at a, b, c or d */
    assert_int_equal(obj_split_quad(b, c, d, dent)[2], 3);
    assert_int_equal(obj_split_quad(c, d, dent, b)[2], 2);
    assert_int_equal(obj_split_quad(d, dent, b, c)[2], 3);
    assert_int_equal(obj_split_quad(b, c, d, middle)[2], 3); /* a straight corner */
    assert_int_equal(obj_split_quad(a, a, a, a)[2], 2);
}

static int release(void **state)
{
    (void)state;
    obj_polygon_release(&polygon);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(quads_are_split_well),
        cmocka_unit_test(stars_are_triangulated),
        cmocka_unit_test(spirals_and_combs_are_triangulated),
        cmocka_unit_test(straight_corners_are_triangulated),
        cmocka_unit_test(holes_over_a_bridge_are_kept),
        cmocka_unit_test(two_bridges_may_share_a_corner),
        cmocka_unit_test(odd_polygons_keep_their_signed_area),
        cmocka_unit_test(large_polygons_are_fast),
        cmocka_unit_test(the_work_is_limited),
    };
    return cmocka_run_group_tests_name("obj_triangulate", tests, NULL, release);
}
