/* view_camera_test.c - view_camera.h: drags do what users expect. */
#include "view/view_camera.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

static const float pi = 3.14159265f;
static const float low[3] = {-1.0f, -1.0f, -1.0f};
static const float high[3] = {1.0f, 1.0f, 1.0f};

static facet_orbit start(bool is_z_up)
{
    return (facet_orbit){.azimuth_rad = 0.3f,
                         .polar_rad = 1.2f,
                         .radius = 4.0f,
                         .fov_y_rad = 0.5f,
                         .target = {0.1f, 0.2f, 0.3f},
                         .has_target = true,
                         .is_z_up = is_z_up};
}

/* Projects a point to an image of 200 x 100 pixels, from its top left. */
static void project(const facet_camera *c, const double p[3], double out[2])
{
    double back[3];
    double right[3];
    double up[3] = {(double)c->up[0], (double)c->up[1], (double)c->up[2]};
    double length = 0.0;
    for (int i = 0; i < 3; i++)
        back[i] = (double)c->eye[i] - (double)c->target[i];
    length = sqrt(back[0] * back[0] + back[1] * back[1] + back[2] * back[2]);
    for (int i = 0; i < 3; i++)
        back[i] /= length;
    right[0] = up[1] * back[2] - up[2] * back[1];
    right[1] = up[2] * back[0] - up[0] * back[2];
    right[2] = up[0] * back[1] - up[1] * back[0];
    double x = 0.0;
    double y = 0.0;
    double depth = 0.0;
    for (int i = 0; i < 3; i++) {
        double d = p[i] - (double)c->eye[i];
        x += d * right[i];
        y += d * up[i];
        depth -= d * back[i];
    }
    double half =
        c->fov_y_rad > 0.0f ? depth * tan(0.5 * (double)c->fov_y_rad) : 0.5 * (double)c->ortho_height;
    out[0] = 100.0 + 50.0 * x / half;
    out[1] = 50.0 - 50.0 * y / half;
}

static void a_drag_over_the_height_is_a_full_turn(void **state)
{
    (void)state;
    facet_orbit o = start(false);
    view_camera_turn(&o, 240.0, 0.0, 240);
    assert_true(fabsf(remainderf(o.azimuth_rad - 0.3f, 2.0f * pi)) < 1e-5f);
    assert_true(fabsf(o.polar_rad - 1.2f) < 1e-6f);
    view_camera_turn(&o, 60.0, 0.0, 240); /* to the right: the front moves right */
    assert_true(fabsf(o.azimuth_rad - (0.3f - 0.5f * pi)) < 1e-5f);
    view_camera_turn(&o, 0.0, -1000.0, 240); /* up: the eye sinks, at most straight below */
    assert_true(fabsf(o.polar_rad - pi) < 1e-6f);
    view_camera_turn(&o, 0.0, 1000.0, 240);
    assert_true(o.polar_rad == 0.0f);
}

/* The point at the target's depth that was under the pointer stays under it. */
static void panning_keeps_the_point_under_the_pointer(void **state)
{
    (void)state;
    for (int variant = 0; variant < 4; variant++) {
        facet_orbit o = start(variant & 1);
        o.is_orthographic = (variant & 2) != 0;
        const double held[3] = {(double)o.target[0], (double)o.target[1], (double)o.target[2]};
        view_camera_pan(&o, 17.0, -9.0, 100);
        facet_camera c = view_camera_of(&o, 2.0f, low, high);
        double at[2];
        project(&c, held, at);
        assert_true(fabs(at[0] - 117.0) < 1e-3);
        assert_true(fabs(at[1] - 41.0) < 1e-3);
    }
}

static void dollying_never_reaches_the_target(void **state)
{
    (void)state;
    facet_orbit o = start(false);
    view_camera_dolly(&o, 1.0, 2.0);
    assert_true(fabsf(o.radius - 3.6f) < 1e-5f);
    view_camera_dolly(&o, -1.0, 2.0);
    assert_true(fabsf(o.radius - 4.0f) < 1e-5f);
    view_camera_dolly(&o, 1e6, 2.0);
    assert_true(o.radius > 0.0f);
    view_camera_dolly(&o, -1e6, 2.0);
    assert_true(isfinite(o.radius));
}

static void view_keys_look_along_axes(void **state)
{
    (void)state;
    static const struct {
        view_direction direction;
        float back[3];
    } expected[] = {{VIEW_FRONT, {0, 0, 1}},      {VIEW_BACK, {0, 0, -1}}, {VIEW_RIGHT_SIDE, {1, 0, 0}},
                    {VIEW_LEFT_SIDE, {-1, 0, 0}}, {VIEW_TOP, {0, 1, 0}},   {VIEW_BOTTOM, {0, -1, 0}}};
    for (size_t k = 0; k < sizeof expected / sizeof *expected; k++) {
        facet_orbit o = start(false);
        view_camera_look(&o, expected[k].direction);
        facet_camera c = view_camera_of(&o, 1.0f, low, high);
        for (int i = 0; i < 3; i++)
            assert_true(fabsf((c.eye[i] - c.target[i]) / 4.0f - expected[k].back[i]) < 1e-5f);
    }
}

/* A window's camera is the one that facet render makes of --orbit, and orbits of cameras round-trip. */
static void orbits_round_trip_through_cameras(void **state)
{
    (void)state;
    for (int variant = 0; variant < 4; variant++) {
        facet_orbit o = start(variant & 1);
        o.is_orthographic = (variant & 2) != 0;
        facet_camera c = view_camera_of(&o, 2.0f, low, high);
        facet_orbit again = view_camera_orbit(&c, &o, o.target);
        assert_true(fabsf(again.azimuth_rad - o.azimuth_rad) < 1e-5f);
        assert_true(fabsf(again.polar_rad - o.polar_rad) < 1e-5f);
        assert_true(fabsf(again.radius - o.radius) < 1e-4f);
        assert_int_equal(again.is_orthographic, o.is_orthographic);
        for (int i = 0; i < 3; i++)
            assert_true(fabsf(again.target[i] - o.target[i]) < 1e-5f);
    }
}

/* Rounding is invisible, and keeps zero, halves and whole numbers exact. */
static void rounding_is_invisible_and_short(void **state)
{
    (void)state;
    const double degree = 0.017453292519943295;
    facet_orbit o = start(false);
    o.azimuth_rad = (float)(45.0000013 * degree);
    o.polar_rad = (float)(54.9999993 * degree);
    o.radius = 0.162345678f;
    o.target[0] = -7.4505806e-09f;
    o.target[1] = 0.5f;
    o.target[2] = -1234.56789f;
    facet_orbit r = view_camera_round(&o);
    assert_true(r.azimuth_rad == (float)(45.0 * degree) && r.polar_rad == (float)(55.0 * degree));
    assert_true(r.radius == 0.162346f);
    assert_true(r.target[0] == 0.0f && !signbit(r.target[0]));
    assert_true(r.target[1] == 0.5f && r.target[2] == -1234.567871f);
    o.radius = 3456789.0f;
    assert_true(view_camera_round(&o).radius == 3456790.0f);
    facet_orbit again = view_camera_round(&r);
    assert_memory_equal(&again, &r, sizeof r);
}

/* An orthographic eye may be anywhere on its axis, but not inside the model. */
static void an_orthographic_eye_is_outside_the_model(void **state)
{
    (void)state;
    facet_orbit o = start(false);
    o.is_orthographic = true;
    o.radius = 0.01f;
    facet_camera c = view_camera_of(&o, 1.0f, low, high);
    double distance2 = 0.0;
    for (int i = 0; i < 3; i++)
        distance2 += pow((double)c.eye[i] - (double)c.target[i], 2.0);
    assert_true(distance2 > 3.0); /* of a corner from the middle, squared */
    assert_true(fabsf(c.ortho_height - 0.02f * tanf(0.25f)) < 1e-6f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_drag_over_the_height_is_a_full_turn),
                                       cmocka_unit_test(panning_keeps_the_point_under_the_pointer),
                                       cmocka_unit_test(dollying_never_reaches_the_target),
                                       cmocka_unit_test(view_keys_look_along_axes),
                                       cmocka_unit_test(orbits_round_trip_through_cameras),
                                       cmocka_unit_test(rounding_is_invisible_and_short),
                                       cmocka_unit_test(an_orthographic_eye_is_outside_the_model)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
