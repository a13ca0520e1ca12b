/* view_rig_test.c - view_rig.h: attributes of the camera mean what they mean to <model-viewer>. */
#include "view/view_rig.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

#include "scene/scene.h"

static const double degree = 3.14159265358979323846 / 180.0;
static facet_scene *scene;

static int make_scene(void **state)
{
    (void)state;
    return scene_create_builtin(&(facet_scene_desc){0}, &scene, NULL) == FACET_OK ? 0 : 1;
}

static int drop_scene(void **state)
{
    (void)state;
    scene_destroy(scene);
    return 0;
}

static void assert_near(double value, double expected)
{
    if (!(fabs(value - expected) <= 1e-9 * fmax(1.0, fabs(expected))))
        fail_msg("%.12g is not %.12g", value, expected);
}

static view_rig framed(double aspect)
{
    view_rig rig;
    view_rig_create(&rig);
    view_rig_set_aspect(&rig, aspect);
    assert_int_equal(view_rig_frame(&rig, scene, NULL, true, NULL), FACET_OK);
    return rig;
}

static void the_defaults_frame_the_sphere_around_the_model(void **state)
{
    (void)state;
    view_rig rig = framed(10.0);
    double ideal = rig.framing.radius / sin(15.0 * degree);
    assert_near(rig.motion.now[VIEW_AXIS_AZIMUTH], 0.0);
    assert_near(rig.motion.now[VIEW_AXIS_POLAR], 75.0 * degree);
    assert_near(rig.motion.now[VIEW_AXIS_RADIUS], 1.05 * ideal);
    assert_near(rig.motion.low[VIEW_AXIS_RADIUS], 2.2 * rig.framing.radius);
    assert_near(view_motion_fov(&rig.motion), 30.0 * degree);
    for (int i = 0; i < 3; i++)
        assert_near(rig.motion.now[VIEW_AXIS_TARGET + i], 0.5 * (rig.framing.low[i] + rig.framing.high[i]));
}

static void texts_are_goals_and_wrong_ones_change_nothing(void **state)
{
    (void)state;
    view_rig rig = framed(10.0);
    assert_int_equal(view_rig_set(&rig, "camera-orbit", "45deg 60deg 80%", NULL), FACET_OK);
    assert_near(rig.motion.goal[VIEW_AXIS_AZIMUTH], 45.0 * degree);
    assert_near(rig.motion.goal[VIEW_AXIS_RADIUS], 0.8 * view_framing_distance(&rig.framing, 30.0 * degree));
    assert_near(rig.motion.now[VIEW_AXIS_AZIMUTH], 0.0);
    view_rig before = rig;
    assert_int_equal(view_rig_set(&rig, "camera-orbit", "left", NULL), FACET_ERROR_ARGUMENT);
    assert_int_equal(view_rig_set(&rig, "camera", "45deg", NULL), FACET_ERROR_ARGUMENT);
    char longer[300];
    memset(longer, ' ', sizeof longer - 1);
    longer[sizeof longer - 1] = 0;
    assert_int_equal(view_rig_set(&rig, "camera-orbit", longer, NULL), FACET_ERROR_ARGUMENT);
    assert_memory_equal(&rig, &before, sizeof rig);
    assert_int_equal(view_rig_set(&rig, "max-camera-orbit", "20deg auto auto", NULL), FACET_OK);
    assert_near(rig.motion.now[VIEW_AXIS_AZIMUTH], 20.0 * degree); /* limits hold at once */
    assert_int_equal(view_rig_set(&rig, "rotation-per-second", "-20deg", NULL), FACET_OK);
    assert_near(rig.motion.rotation_rad_s, -20.0 * degree);
}

static void a_second_model_keeps_the_direction(void **state)
{
    (void)state;
    view_rig rig = framed(2.0);
    view_motion_turn(&rig.motion, -50.0, 20.0, 400.0);
    view_motion_jump(&rig.motion);
    double azimuth = rig.motion.now[VIEW_AXIS_AZIMUTH];
    assert_int_equal(view_rig_frame(&rig, scene, NULL, true, NULL), FACET_OK);
    assert_near(rig.motion.now[VIEW_AXIS_AZIMUTH], azimuth);
    assert_int_equal(view_rig_frame(&rig, scene, NULL, false, NULL), FACET_OK);
    assert_near(rig.motion.now[VIEW_AXIS_AZIMUTH], 0.0);
}

static void a_narrow_image_widens_the_view_and_keeps_the_zoom(void **state)
{
    (void)state;
    view_rig rig = framed(10.0);
    view_motion_zoom(&rig.motion, -10.0);
    view_motion_jump(&rig.motion);
    double zoom = view_motion_fov(&rig.motion) / (30.0 * degree);
    view_rig_set_aspect(&rig, 0.25 * rig.framing.aspect);
    double wide = 2.0 * atan(4.0 * tan(15.0 * degree));
    assert_near(view_motion_fov(&rig.motion), zoom * wide);
    assert_near(exp(rig.motion.high[VIEW_AXIS_LOG_FOV]), wide);
    view_rig_set_aspect(&rig, 10.0);
    assert_near(view_motion_fov(&rig.motion), zoom * 30.0 * degree);
}

static void a_target_is_the_center_of_the_frame(void **state)
{
    (void)state;
    view_rig rig;
    view_rig_create(&rig);
    assert_int_equal(view_rig_set(&rig, "camera-target", "1m 0m auto", NULL), FACET_OK);
    assert_int_equal(view_rig_frame(&rig, scene, NULL, true, NULL), FACET_OK);
    assert_near(rig.framing.target[0], 1.0);
    assert_near(rig.framing.target[2], 0.5 * (rig.framing.low[2] + rig.framing.high[2]));
    assert_near(rig.motion.now[VIEW_AXIS_TARGET], 1.0);
    view_rig_look_at(&rig, (const double[3]){0.5, 0.25, 0.0});
    assert_near(rig.motion.goal[VIEW_AXIS_TARGET + 1], 0.25);
    view_rig_look_at(&rig, NULL);
    assert_near(rig.motion.goal[VIEW_AXIS_TARGET], 1.0);
    assert_near(rig.motion.goal[VIEW_AXIS_RADIUS], rig.motion.high[VIEW_AXIS_RADIUS]);
}

static void an_orbit_by_number_may_leave_the_limits(void **state)
{
    (void)state;
    view_rig rig = framed(2.0);
    facet_orbit orbit = scene_orbit_default();
    orbit.radius = 1000.0f;
    orbit.azimuth_rad = 1.0f;
    view_rig_follow(&rig, &orbit);
    facet_orbit placed = {0};
    view_motion_place(&rig.motion, &placed);
    assert_true(placed.radius == 1000.0f && fabsf(placed.azimuth_rad - 1.0f) < 1e-6f);
    assert_false(view_motion_is_gliding(&rig.motion));
}

static void home_is_where_every_viewer_begins(void **state)
{
    (void)state;
    view_rig rig = framed(2.0);
    facet_orbit home = scene_orbit_default(), now = home;
    assert_int_equal(view_rig_set(&rig, "camera-target", "auto auto auto", NULL), FACET_OK);
    view_motion_step(&rig.motion, VIEW_STEP_LEFT, false, 100.0);
    view_motion_jump(&rig.motion);
    assert_true(view_rig_home(&rig, &home));
    view_motion_place(&rig.motion, &now);
    assert_true(home.azimuth_rad == 0.0f && now.azimuth_rad != 0.0f && home.radius == now.radius);
    view_rig_set_aspect(&rig, 0.5);
    assert_true(view_rig_home(&rig, &now) && now.fov_y_rad > home.fov_y_rad);
    assert_int_equal(view_rig_set(&rig, "camera-orbit", "0deg 75deg 100%", NULL), FACET_OK);
    assert_false(view_rig_home(&rig, &home));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_defaults_frame_the_sphere_around_the_model),
        cmocka_unit_test(texts_are_goals_and_wrong_ones_change_nothing),
        cmocka_unit_test(a_second_model_keeps_the_direction),
        cmocka_unit_test(a_narrow_image_widens_the_view_and_keeps_the_zoom),
        cmocka_unit_test(a_target_is_the_center_of_the_frame),
        cmocka_unit_test(an_orbit_by_number_may_leave_the_limits),
        cmocka_unit_test(home_is_where_every_viewer_begins),
    };
    return cmocka_run_group_tests(tests, make_scene, drop_scene);
}
