/* chart_space_test.c - view and shading of a surface in space. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "plot/chart_space.h"

enum { ROWS = 19, COLUMNS = 37 };
static const double DEGREE = 0.017453292519943295;

static double x[ROWS * COLUMNS], y[ROWS * COLUMNS], z[ROWS * COLUMNS];
static chart_surface sphere = {.width = COLUMNS, .height = ROWS, .x = x, .y = y, .z = z};

/* Rows from pole to pole, columns once around: with the seams and poles of lobes. */
static int set_up(void **state)
{
    (void)state;
    for (int row = 0; row < ROWS; row++)
        for (int column = 0; column < COLUMNS; column++) {
            const double polar = 10.0 * DEGREE * row, turn = 10.0 * DEGREE * column;
            const int i = row * COLUMNS + column;
            x[i] = sin(polar) * cos(turn);
            y[i] = sin(polar) * sin(turn);
            z[i] = cos(polar);
        }
    return 0;
}

static void directions_are_orthonormal(void **state)
{
    (void)state;
    for (double azimuth = -4.0; azimuth < 4.0; azimuth += 0.7)
        for (double elevation = -1.6; elevation < 1.7; elevation += 0.4) {
            sphere.azimuth_rad = azimuth;
            sphere.elevation_rad = elevation;
            const space_view w = space_look_at(&sphere);
            assert_true(fabs(space_dot(w.right, w.right) - 1.0) < 1e-12 &&
                        fabs(space_dot(w.up, w.up) - 1.0) < 1e-12);
            assert_true(fabs(space_dot(w.right, w.up)) < 1e-12 &&
                        fabs(space_dot(w.right, w.toward)) < 1e-12 &&
                        fabs(space_dot(w.up, w.toward)) < 1e-12);
            assert_true(w.right[2] == 0.0 && w.up[2] >= 0.0); /* z is up */
            assert_true(w.base_radius == 1.0);
        }
}

static void all_points_are_inside_the_plot(void **state)
{
    (void)state;
    const chart_box plot = {50.0, 30.0, 400.0, 220.0};
    sphere.azimuth_rad = 0.6;
    sphere.elevation_rad = 0.4;
    space_view w = space_look_at(&sphere);
    space_place(&w, &plot);
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (size_t i = 0; i < ROWS * COLUMNS; i++) {
        double p[3], px, py;
        assert_true(space_point(&sphere, i, p));
        space_project(&w, p, &px, &py);
        assert_true(px >= 50.0 - 1e-9 && px <= 450.0 + 1e-9 && py >= 30.0 - 1e-9 && py <= 250.0 + 1e-9);
        low = fmin(low, py);
        high = fmax(high, py);
    }
    assert_true(high - low > 200.0);
    /* seen from +x, +y is at the right and +z above */
    sphere.azimuth_rad = sphere.elevation_rad = 0.0;
    w = space_look_at(&sphere);
    space_place(&w, &plot);
    double origin[2], at[2];
    space_project(&w, (const double[3]){0.0, 0.0, 0.0}, &origin[0], &origin[1]);
    space_project(&w, (const double[3]){0.0, 1.0, 0.0}, &at[0], &at[1]);
    assert_true(at[0] > origin[0] + 10.0 && fabs(at[1] - origin[1]) < 1e-9);
    space_project(&w, (const double[3]){0.0, 0.0, 1.0}, &at[0], &at[1]);
    assert_true(at[1] < origin[1] - 10.0 && fabs(at[0] - origin[0]) < 1e-9);
}

/* Normals of a sphere point outwards, also at the seam and the poles. */
static void normals_of_a_sphere_are_radial(void **state)
{
    (void)state;
    static double normals[ROWS * COLUMNS][3];
    for (size_t i = 0; i < ROWS * COLUMNS; i++)
        for (int c = 0; c < 3; c++)
            normals[i][c] = 0.0;
    space_add_normals(&sphere, normals);
    double side = 0.0;
    for (size_t i = 0; i < ROWS * COLUMNS; i++) {
        const double p[3] = {x[i], y[i], z[i]};
        const double cosine = space_dot(normals[i], p) / sqrt(space_dot(normals[i], normals[i]));
        side = side == 0.0 ? copysign(1.0, cosine) : side;
        assert_true(side * cosine > 0.995); /* the grid's quads are 10 degrees wide */
    }
}

static void both_sides_are_shaded(void **state)
{
    (void)state;
    sphere.azimuth_rad = 0.3;
    sphere.elevation_rad = 0.2;
    const space_view w = space_look_at(&sphere);
    double brightest = 0.0;
    for (size_t i = 0; i < ROWS * COLUMNS; i++) {
        const double n[3] = {3.0 * x[i], 3.0 * y[i], 3.0 * z[i]}, back[3] = {-x[i], -y[i], -z[i]};
        const double shade = space_shade(&w, n);
        assert_true(shade > 0.5 && shade <= 1.0 + 1e-12);
        assert_true(fabs(space_shade(&w, back) - shade) < 1e-12);
        brightest = fmax(brightest, shade);
    }
    assert_true(brightest > 0.98);
    assert_true(space_shade(&w, (const double[3]){0.0, 0.0, 0.0}) == 1.0);
    assert_true(space_shade(&w, (const double[3]){(double)NAN, 0.0, 0.0}) == 1.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(directions_are_orthonormal),
        cmocka_unit_test(all_points_are_inside_the_plot),
        cmocka_unit_test(normals_of_a_sphere_are_radial),
        cmocka_unit_test(both_sides_are_shaded),
    };
    return cmocka_run_group_tests(tests, set_up, NULL);
}
