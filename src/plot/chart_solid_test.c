/* chart_solid_test.c - triangles in the z-buffer: coverage and depth order. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "tests/support/support.h"
#include "plot/chart_space.h"

enum { SIZE = 70 }; /* more than two bands */

static uint32_t colors[256];

static int set_up(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < 256; i++)
        colors[i] = 0xff000000u | i << 16 | (255 - i);
    return 0;
}

/* Two rows of two corners: a rectangle. */
static void make_sheet(solid_vertex v[4], float x0, float y0, float x1, float y1, float depth, float value)
{
    for (int i = 0; i < 4; i++)
        v[i] = (solid_vertex){
            .x = i & 1 ? x1 : x0, .y = i & 2 ? y1 : y0, .depth = depth, .value = value, .shade = 1.0f};
}

static void a_flat_surface_covers_its_pixels(void **state)
{
    (void)state;
    solid_vertex v[4];
    solid s;
    facet_error error;
    make_sheet(v, 10.0f, 20.0f, 40.5f, 60.0f, 3.0f, 1.0f);
    assert_int_equal(solid_create(NULL, SIZE, SIZE, v, 2, 2, colors, &s, &error), FACET_OK);
    for (int y = 0; y < SIZE; y++)
        for (int x = 0; x < SIZE; x++) {
            const uint32_t pixel = s.pixels[y * SIZE + x];
            const bool is_row = y >= 20 && y < 60;
            if (is_row && x >= 10 && x < 40) {
                assert_int_equal(pixel, 0xffff0000u);
                assert_true(fabsf(solid_depth_at(&s, x + 0.5, y + 0.5) - 3.0f) < 1e-5f);
            } else if (is_row && x == 40) { /* half of it: 3 or 6 of 9 samples, premultiplied */
                assert_in_range(pixel >> 24, 80, 175);
                assert_int_equal(pixel >> 16 & 0xff, pixel >> 24);
                assert_int_equal(pixel & 0xffff, 0);
            } else {
                assert_int_equal(pixel, 0);
                assert_true(solid_depth_at(&s, x + 0.5, y + 0.5) == -INFINITY);
            }
        }
    assert_true(solid_depth_at(&s, -1.0, 5.0) == -INFINITY && solid_depth_at(&s, 5.0, SIZE) == -INFINITY &&
                solid_depth_at(&s, (double)NAN, 5.0) == -INFINITY);
    solid_destroy(&s);
}

/* Two intersecting sheets, in both orders: the nearer one is visible. */
static void nearer_surfaces_hide_farther_ones(void **state)
{
    (void)state;
    for (int order = 0; order < 2; order++) {
        solid_vertex v[12]; /* six rows of two: a sheet, a gap, a sheet */
        make_sheet(v + (order ? 8 : 0), 0.0f, 0.0f, SIZE, SIZE, 0.0f, 1.0f);
        make_sheet(v + (order ? 0 : 8), 0.0f, 0.0f, SIZE, SIZE, 0.0f, 0.0f);
        for (int i = 0; i < 4; i++) {
            v[(order ? 8 : 0) + i].depth = i & 1 ? 1.0f : -1.0f;
            v[(order ? 0 : 8) + i].depth = i & 1 ? -1.0f : 1.0f;
            v[4 + i] = (solid_vertex){.x = NAN};
        }
        solid s;
        facet_error error;
        assert_int_equal(solid_create(NULL, SIZE, SIZE, v, 2, 6, colors, &s, &error), FACET_OK);
        for (int y = 0; y < SIZE; y++) {
            assert_int_equal(s.pixels[y * SIZE + SIZE - 2], 0xffff0000u);
            assert_int_equal(s.pixels[y * SIZE + 1], 0xff0000ffu);
        }
        solid_destroy(&s);
    }
}

static void invalid_corners_are_omitted(void **state)
{
    (void)state;
    static const float BAD[] = {NAN, INFINITY, -INFINITY, 1e30f};
    for (size_t i = 0; i < sizeof BAD / sizeof *BAD; i++)
        for (int field = 0; field < 3; field++) {
            solid_vertex v[4];
            make_sheet(v, 0.0f, 0.0f, SIZE, SIZE, 0.0f, 1.0f);
            float *fields[3] = {&v[3].x, &v[3].y, &v[3].depth};
            *fields[field] = BAD[i];
            if (field == 2 && BAD[i] == 1e30f) /* far, but a number */
                continue;
            solid s;
            facet_error error;
            assert_int_equal(solid_create(NULL, SIZE, SIZE, v, 2, 2, colors, &s, &error), FACET_OK);
            assert_int_equal(s.pixels[0], 0xffff0000u); /* the other triangle */
            assert_int_equal(s.pixels[SIZE * SIZE - 1], 0);
            solid_destroy(&s);
        }
}

static void running_out_of_memory_leaks_nothing(void **state)
{
    (void)state;
    for (long i = 0; i < 4; i++) {
        failing_allocator failing = {.fail_at = i};
        const facet_allocator allocator = failing_allocator_get(&failing);
        solid_vertex v[4];
        solid s;
        facet_error error;
        make_sheet(v, 0.0f, 0.0f, SIZE, SIZE, 0.0f, 1.0f);
        assert_int_equal(solid_create(&allocator, SIZE, SIZE, v, 2, 2, colors, &s, &error),
                         FACET_ERROR_MEMORY);
        assert_null(s.pixels);
        assert_int_equal(failing.blocks, 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_flat_surface_covers_its_pixels),
        cmocka_unit_test(nearer_surfaces_hide_farther_ones),
        cmocka_unit_test(invalid_corners_are_omitted),
        cmocka_unit_test(running_out_of_memory_leaks_nothing),
    };
    return cmocka_run_group_tests(tests, set_up, NULL);
}
