/* view_framing_test.c - view_framing.h: the sphere holds the model, and its width fits from every direction. */
#include "view/view_framing.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "scene/scene.h"

static const double pi = 3.14159265358979323846;
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

static void the_bounds_are_those_of_the_pose(void **state)
{
    (void)state;
    view_framing f;
    scene_pose pose;
    assert_int_equal(scene_pose_create(scene, NULL, NULL, 1, &pose, NULL), FACET_OK);
    assert_int_equal(view_framing_measure(scene, NULL, NULL, pi / 6.0, &f, NULL), FACET_OK);
    double half_diagonal = 0.0, half_side = 0.0;
    for (int i = 0; i < 3; i++) {
        double half = 0.5 * (f.high[i] - f.low[i]);
        assert_true(f.low[i] == (double)pose.bounds_min[i] && f.high[i] == (double)pose.bounds_max[i]);
        assert_true(fabs(f.target[i] - 0.5 * (f.low[i] + f.high[i])) < 1e-12);
        half_diagonal += half * half;
        half_side = fmax(half_side, half);
    }
    assert_true(f.radius >= half_side && f.radius <= sqrt(half_diagonal) + 1e-12);
    scene_pose_destroy(&pose);
}

static void a_narrow_image_widens_the_view_until_the_width_fits(void **state)
{
    (void)state;
    view_framing f;
    double fov = pi / 6.0;
    assert_int_equal(view_framing_measure(scene, NULL, NULL, fov, &f, NULL), FACET_OK);
    assert_true(f.aspect > 0.0);
    assert_true(fabs(view_framing_fov(&f, fov, 2.0 * f.aspect) - fov) < 1e-12);
    /* tan of the horizontal half angle stays what fits at that aspect */
    double narrow = view_framing_fov(&f, fov, 0.5 * f.aspect);
    assert_true(fabs(tan(0.5 * narrow) - 2.0 * tan(0.5 * fov)) < 1e-9);
    assert_true(fabs(view_framing_distance(&f, fov) * sin(0.5 * fov) - f.radius) < 1e-9);
}

static void another_target_needs_a_larger_sphere(void **state)
{
    (void)state;
    view_framing middle, aside;
    assert_int_equal(view_framing_measure(scene, NULL, NULL, 0.5, &middle, NULL), FACET_OK);
    const double target[3] = {middle.high[0], middle.high[1], middle.high[2]};
    assert_int_equal(view_framing_measure(scene, NULL, target, 0.5, &aside, NULL), FACET_OK);
    assert_true(aside.radius > middle.radius);
    assert_true(aside.target[0] == target[0]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_bounds_are_those_of_the_pose),
        cmocka_unit_test(a_narrow_image_widens_the_view_until_the_width_fits),
        cmocka_unit_test(another_target_needs_a_larger_sphere),
    };
    return cmocka_run_group_tests(tests, make_scene, drop_scene);
}
