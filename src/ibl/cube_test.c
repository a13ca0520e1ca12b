/* cube_test.c - directions, solid angles and seams of cube maps. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "tests/support/support.h"

#include "ibl/cube.h"

static const double pi = 3.14159265358979323846;

/* Face directions of cube maps (OpenGL 4.6, table 8.19). */
static void faces_point_as_in_opengl(void **state)
{
    (void)state;
    const double s = 0.25;
    const double t = -0.5;
    const double expected[6][3] = {{1.0, -t, -s}, {-1.0, -t, s}, {s, 1.0, t},
                                   {s, -1.0, -t}, {s, -t, 1.0},  {-s, -t, -1.0}};
    for (uint32_t face = 0; face < 6; face++) {
        double d[3];
        cube_direction(face, s, t, d);
        for (int k = 0; k < 3; k++)
            assert_near(d[k], expected[face][k], 0.0);
    }
}

static void directions_round_trip(void **state)
{
    (void)state;
    for (uint32_t face = 0; face < 6; face++)
        for (int j = 0; j < 32; j++)
            for (int i = 0; i < 32; i++) {
                double s = (2.0 * i + 1.0) / 32.0 - 1.0;
                double t = (2.0 * j + 1.0) / 32.0 - 1.0;
                double d[3];
                cube_direction(face, s, t, d);
                cube_point p = cube_locate((float)(3.0 * d[0]), (float)(3.0 * d[1]), (float)(3.0 * d[2]));
                assert_int_equal(p.face, face);
                assert_near(p.s, s, 1e-6);
                assert_near(p.t, t, 1e-6);
            }
}

static void solid_angles_add_up(void **state)
{
    (void)state;
    static const uint32_t sizes[] = {1, 2, 7, 64, 256};
    for (int k = 0; k < 5; k++) {
        double sum = 0.0;
        for (uint32_t y = 0; y < sizes[k]; y++)
            for (uint32_t x = 0; x < sizes[k]; x++)
                sum += 6.0 * cube_texel_solid_angle(sizes[k], x, y);
        assert_near(sum, 4.0 * pi, 1e-10);
    }
}

static cube make_noise(uint32_t size)
{
    cube c;
    assert_int_equal(cube_create(size, NULL, &c, NULL), FACET_OK);
    uint32_t random = 1;
    for (uint32_t face = 0; face < 6; face++)
        for (int y = 0; y < (int)size; y++)
            for (int x = 0; x < (int)size; x++)
                for (int k = 0; k < 3; k++)
                    (*cube_texel(&c, face, x, y))[k] = (float)(lcg_next(&random) >> 8);
    cube_fill_borders(&c);
    return c;
}

/* Over each of the twelve edges and at the corners, lookups a hair's breadth apart agree although the
 * texels are noise. */
static void lookups_are_seamless(void **state)
{
    (void)state;
    cube c = make_noise(8);
    for (int axis = 0; axis < 3; axis++)
        for (int corner = 0; corner < 4; corner++)
            for (int i = 0; i <= 200; i++) {
                float a[3], b[3];
                int u = (axis + 1) % 3;
                int v = (axis + 2) % 3;
                a[axis] = b[axis] = (float)i / 100.0f - 1.0f;
                float su = corner & 1 ? 1.0f : -1.0f;
                float sv = corner & 2 ? 1.0f : -1.0f;
                a[u] = su * 1.000001f;
                a[v] = sv;
                b[u] = su;
                b[v] = sv * 1.000001f;
                rgbx p = cube_fetch(&c, cube_locate(a[0], a[1], a[2]));
                rgbx q = cube_fetch(&c, cube_locate(b[0], b[1], b[2]));
                for (int k = 0; k < 3; k++)
                    assert_near(p[k], q[k], 2e-4f * 16777216.0f);
            }
    cube_destroy(&c);
}

static void lookups_at_centers_give_texels(void **state)
{
    (void)state;
    cube c = make_noise(16);
    for (uint32_t face = 0; face < 6; face++)
        for (int y = 0; y < 16; y++)
            for (int x = 0; x < 16; x++) {
                double d[3];
                cube_direction(face, (2.0 * x + 1.0) / 16.0 - 1.0, (2.0 * y + 1.0) / 16.0 - 1.0, d);
                rgbx t = cube_fetch(&c, cube_locate((float)d[0], (float)d[1], (float)d[2]));
                assert_near(t[1], (*cube_texel(&c, face, x, y))[1], 16777216.0f * 1e-5f);
            }
    cube_destroy(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(faces_point_as_in_opengl),
        cmocka_unit_test(directions_round_trip),
        cmocka_unit_test(solid_angles_add_up),
        cmocka_unit_test(lookups_are_seamless),
        cmocka_unit_test(lookups_at_centers_give_texels),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
