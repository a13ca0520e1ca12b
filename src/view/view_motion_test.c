/* view_motion_test.c - view_motion.h: goals are reached, limits hold, input moves as in <model-viewer>. */
#include "view/view_motion.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

static const double pi = 3.14159265358979323846;

static view_motion start(void)
{
    view_motion m;
    view_motion_create(&m);
    m.goal[VIEW_AXIS_RADIUS] = 4.0;
    view_motion_jump(&m);
    return m;
}

static void assert_near(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance))
        fail_msg("%.9g is not %.9g", value, expected);
}

static void a_glide_is_critically_damped_and_ends(void **state)
{
    (void)state;
    view_motion m = start();
    view_motion_turn(&m, -100.0, 0.0, 400.0); /* a quarter turn */
    assert_near(m.goal[VIEW_AXIS_AZIMUTH], 0.5 * pi, 1e-12);
    double last = 0.0;
    int frames = 0;
    for (; view_motion_advance(&m, 0.016); frames++) {
        assert_true(m.now[VIEW_AXIS_AZIMUTH] >= last); /* without overshooting */
        last = m.now[VIEW_AXIS_AZIMUTH];
        /* x = 1 - (1 + t / T) e^(-t / T) of the way */
        double t = 0.016 * (frames + 1) / m.decay_s;
        assert_near(last, 0.5 * pi * (1.0 - (1.0 + t) * exp(-t)), 2e-3);
    }
    assert_true(frames > 10 && frames < 60);
    assert_true(m.now[VIEW_AXIS_AZIMUTH] == m.goal[VIEW_AXIS_AZIMUTH]);
    assert_false(view_motion_is_moving(&m));
}

static void the_path_does_not_depend_on_the_frame_rate(void **state)
{
    (void)state;
    view_motion fine = start();
    view_motion coarse = start();
    view_motion_turn(&fine, 60.0, 20.0, 400.0);
    view_motion_turn(&coarse, 60.0, 20.0, 400.0);
    for (int i = 0; i < 8; i++)
        view_motion_advance(&fine, 0.01);
    view_motion_advance(&coarse, 0.08);
    assert_near(fine.now[VIEW_AXIS_AZIMUTH], coarse.now[VIEW_AXIS_AZIMUTH], 1e-12);
    assert_near(fine.velocity[VIEW_AXIS_POLAR], coarse.velocity[VIEW_AXIS_POLAR], 1e-12);
}

static void reduced_motion_and_no_decay_jump(void **state)
{
    (void)state;
    view_motion m = start();
    assert_true(view_motion_set(&m, "decay", 0.0));
    view_motion_turn(&m, 10.0, 0.0, 100.0);
    assert_true(view_motion_advance(&m, 1e-6));
    assert_true(m.now[VIEW_AXIS_AZIMUTH] == m.goal[VIEW_AXIS_AZIMUTH]);
    assert_true(view_motion_set(&m, "decay", 0.05) && view_motion_set(&m, "reduced", 1.0) &&
                view_motion_set(&m, "auto-rotate", 1.0));
    assert_false(view_motion_is_moving(&m));
    view_motion_advance(&m, 100.0);
    assert_true(m.turntable_rad == 0.0);
}

static void drags_stop_at_the_poles_and_do_not_lap_the_camera(void **state)
{
    (void)state;
    view_motion m = start();
    view_motion_turn(&m, 0.0, 1000.0, 400.0);
    assert_true(m.goal[VIEW_AXIS_POLAR] == 0.0);
    view_motion_turn(&m, 0.0, -2000.0, 400.0);
    assert_near(m.goal[VIEW_AXIS_POLAR], pi, 1e-12);
    view_motion_turn(&m, -4000.0, 0.0, 400.0);
    assert_true(m.goal[VIEW_AXIS_AZIMUTH] < m.now[VIEW_AXIS_AZIMUTH] + pi);
    assert_true(view_motion_set(&m, "orbit-sensitivity", 0.5));
    view_motion_jump(&m);
    double before = m.goal[VIEW_AXIS_AZIMUTH];
    view_motion_turn(&m, 100.0, 0.0, 400.0);
    assert_near(m.goal[VIEW_AXIS_AZIMUTH], before - 0.25 * pi, 1e-12);
}

static void limits_hold_and_the_goal_follows_them(void **state)
{
    (void)state;
    view_motion m = start();
    const double low[VIEW_AXIS_TARGET] = {-0.5, 1.0, 2.0, VIEW_UNSET};
    const double high[VIEW_AXIS_TARGET] = {0.5, 1.2, 3.0, log(0.6)};
    view_motion_limit(&m, low, high);
    assert_near(m.goal[VIEW_AXIS_POLAR], 1.2, 0.0);
    assert_near(m.goal[VIEW_AXIS_RADIUS], 3.0, 0.0);
    assert_near(exp(m.low[VIEW_AXIS_LOG_FOV]), 12.0 * pi / 180.0, 1e-12);
    view_motion_turn(&m, -1000.0, 0.0, 400.0);
    assert_near(m.goal[VIEW_AXIS_AZIMUTH], 0.5, 0.0);
    view_motion_aim(&m,
                    (const double[VIEW_AXIS_COUNT]){VIEW_UNSET, 0.0, HUGE_VAL, VIEW_UNSET, 7.0, 8.0, 9.0});
    assert_near(m.goal[VIEW_AXIS_AZIMUTH], 0.5, 0.0);
    assert_near(m.goal[VIEW_AXIS_POLAR], 1.0, 0.0);
    assert_near(m.goal[VIEW_AXIS_RADIUS], 3.0, 0.0);
    assert_near(m.goal[VIEW_AXIS_TARGET + 2], 9.0, 0.0);
}

static void a_free_azimuth_takes_the_shorter_way(void **state)
{
    (void)state;
    view_motion m = start();
    view_motion_aim(&m, (const double[VIEW_AXIS_COUNT]){1.75 * pi, VIEW_UNSET, VIEW_UNSET, VIEW_UNSET,
                                                        VIEW_UNSET, VIEW_UNSET, VIEW_UNSET});
    assert_near(m.goal[VIEW_AXIS_AZIMUTH] - m.now[VIEW_AXIS_AZIMUTH], -0.25 * pi, 1e-12);
}

static void zoom_moves_radius_and_field_of_view_to_their_limits_together(void **state)
{
    (void)state;
    view_motion m = start();
    const double low[VIEW_AXIS_TARGET] = {VIEW_UNSET, VIEW_UNSET, 2.0, VIEW_UNSET};
    const double high[VIEW_AXIS_TARGET] = {VIEW_UNSET, VIEW_UNSET, 4.0, log(30.0 * pi / 180.0)};
    view_motion_limit(&m, low, high);
    double steps = log(30.0 / 12.0) / 0.04;
    view_motion_zoom(&m, -0.5 * steps);
    assert_near(m.goal[VIEW_AXIS_RADIUS], 3.0, 1e-9);
    assert_near(m.goal[VIEW_AXIS_LOG_FOV], 0.5 * (log(12.0 * pi / 180.0) + log(30.0 * pi / 180.0)), 1e-9);
    view_motion_zoom(&m, -2.0 * steps);
    assert_near(m.goal[VIEW_AXIS_RADIUS], 2.0, 1e-9);
    view_motion_zoom(&m, 0.001);
    assert_true(m.goal[VIEW_AXIS_RADIUS] > 2.0);
    for (int i = 0; i < 200; i++)
        view_motion_step(&m, VIEW_STEP_OUT, false, 100.0);
    assert_near(m.goal[VIEW_AXIS_RADIUS], 4.0, 1e-9);
}

static void a_pan_keeps_points_under_the_pointer_and_the_model_in_reach(void **state)
{
    (void)state;
    view_motion m = start();
    m.now[VIEW_AXIS_POLAR] = m.goal[VIEW_AXIS_POLAR] = 0.5 * pi;
    double height = 2.0 * 4.0 * tan(15.0 * pi / 180.0); /* of the plane of the target */
    view_motion_pan(&m, 10.0, -20.0, 100.0);
    assert_near(m.goal[VIEW_AXIS_TARGET], -0.1 * height, 1e-9);
    assert_near(m.goal[VIEW_AXIS_TARGET + 1], -0.2 * height, 1e-9);
    assert_near(m.goal[VIEW_AXIS_TARGET + 2], 0.0, 1e-9);
    m.reach = 1.0;
    view_motion_pan(&m, -4000.0, 0.0, 100.0);
    assert_near(m.goal[VIEW_AXIS_TARGET] * m.goal[VIEW_AXIS_TARGET] +
                    m.goal[VIEW_AXIS_TARGET + 1] * m.goal[VIEW_AXIS_TARGET + 1],
                1.0, 1e-9);
}

static void a_pivot_leaves_the_eye(void **state)
{
    (void)state;
    view_motion m = start();
    m.now[VIEW_AXIS_POLAR] = m.goal[VIEW_AXIS_POLAR] = 0.5 * pi;
    view_motion_set_pivot(&m, (const double[3]){0.0, 0.0, 1.5});
    assert_near(m.goal[VIEW_AXIS_RADIUS], 2.5, 1e-9);
    assert_near(m.goal[VIEW_AXIS_TARGET + 2], 1.5, 1e-9);
}

static void keys_turn_by_an_eighth_of_half_a_turn(void **state)
{
    (void)state;
    view_motion m = start();
    view_motion_step(&m, VIEW_STEP_LEFT, false, 300.0);
    assert_near(m.goal[VIEW_AXIS_AZIMUTH], pi / 8.0, 1e-12);
    view_motion_step(&m, VIEW_STEP_UP, false, 300.0);
    assert_near(m.goal[VIEW_AXIS_POLAR], 75.0 * pi / 180.0 + pi / 8.0, 1e-12);
    view_motion_step(&m, VIEW_STEP_RIGHT, true, 300.0);
    assert_true(m.goal[VIEW_AXIS_TARGET] < 0.0);
}

static void the_turntable_waits_and_turns_camera_against_it(void **state)
{
    (void)state;
    view_motion m = start();
    facet_orbit orbit = {0};
    view_motion_set(&m, "auto-rotate", 1.0);
    assert_true(view_motion_is_moving(&m));
    assert_false(view_motion_is_gliding(&m));
    assert_false(view_motion_advance(&m, 2.0));
    assert_true(view_motion_advance(&m, 2.0)); /* one of them after the delay */
    assert_near(m.turntable_rad, pi / 32.0, 1e-12);
    view_motion_place(&m, &orbit);
    assert_near((double)orbit.azimuth_rad, -pi / 32.0, 1e-6);
    view_motion_turn(&m, 1.0, 0.0, 100.0); /* input stops it for a while */
    view_motion_advance(&m, 2.9);
    assert_near(m.turntable_rad, pi / 32.0, 1e-12);
    assert_false(view_motion_set(&m, "speed", 1.0));
    assert_false(view_motion_set(&m, "decay", (double)NAN));
}

static void sides_have_names(void **state)
{
    (void)state;
    view_motion m = start();
    assert_string_equal(view_motion_side(&m), "front");
    m.now[VIEW_AXIS_POLAR] = 0.2;
    m.now[VIEW_AXIS_AZIMUTH] = -0.5 * pi;
    assert_string_equal(view_motion_side(&m), "upper-left");
    m.now[VIEW_AXIS_POLAR] = pi;
    m.now[VIEW_AXIS_AZIMUTH] = 0.5 * pi;
    assert_string_equal(view_motion_side(&m), "lower-right");
    m.now[VIEW_AXIS_AZIMUTH] = 3.0 * pi;
    assert_string_equal(view_motion_side(&m), "lower-back");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_glide_is_critically_damped_and_ends),
        cmocka_unit_test(the_path_does_not_depend_on_the_frame_rate),
        cmocka_unit_test(reduced_motion_and_no_decay_jump),
        cmocka_unit_test(drags_stop_at_the_poles_and_do_not_lap_the_camera),
        cmocka_unit_test(limits_hold_and_the_goal_follows_them),
        cmocka_unit_test(a_free_azimuth_takes_the_shorter_way),
        cmocka_unit_test(zoom_moves_radius_and_field_of_view_to_their_limits_together),
        cmocka_unit_test(a_pan_keeps_points_under_the_pointer_and_the_model_in_reach),
        cmocka_unit_test(a_pivot_leaves_the_eye),
        cmocka_unit_test(keys_turn_by_an_eighth_of_half_a_turn),
        cmocka_unit_test(the_turntable_waits_and_turns_camera_against_it),
        cmocka_unit_test(sides_have_names),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
