/* keyframes_test.c - each interpolation against its closed form. */
#include "scene/keyframes.h"

#include <setjmp.h>
#include <stdarg.h>
#include <string.h>

#include <cmocka.h>

#include "tests/support/support.h"

static const float TIMES[4] = {0.5f, 1.0f, 2.5f, 3.0f};

static double value_at(const scene_sampler *sampler, double time_s, size_t i)
{
    sampler_blend blend = sampler_at(sampler, time_s, false);
    return sampler_blend_value(&blend, i);
}

static void keys_are_exact_and_ends_are_held(void **state)
{
    (void)state;
    /* Value, and for the spline tangents that would pull hard. */
    float values[4 * 3 * 2];
    for (int interpolation = SCENE_STEP; interpolation <= SCENE_CUBIC_SPLINE; interpolation++) {
        size_t per_key = interpolation == SCENE_CUBIC_SPLINE ? 3 : 1;
        for (size_t i = 0; i < 4 * per_key * 2; i++)
            values[i] = 0.1f + 1.7f * (float)((i * 37) % 11);
        scene_sampler s = {.interpolation = (scene_interpolation)interpolation,
                           .key_count = 4,
                           .times = TIMES,
                           .width = 2,
                           .values = values};
        size_t middle = per_key == 3 ? 2 : 0; /* floats before the value of a key */
        for (size_t key = 0; key < 4; key++)
            for (size_t i = 0; i < 2; i++)
                assert_true((float)value_at(&s, (double)TIMES[key], i) ==
                            values[key * per_key * 2 + middle + i]);
        static const double early[] = {-1e300, -1.0, 0.0, 0.4999999};
        static const double late[] = {3.0000001, 4.0, 1e300};
        for (int k = 0; k < 4; k++)
            assert_true((float)value_at(&s, early[k], 1) == values[middle + 1]);
        for (int k = 0; k < 3; k++)
            assert_true((float)value_at(&s, late[k], 1) == values[3 * per_key * 2 + middle + 1]);
    }
}

static void steps_hold_until_the_next_key(void **state)
{
    (void)state;
    static const float values[4] = {1, 2, 3, 4};
    scene_sampler s = {SCENE_STEP, 4, TIMES, 1, values};
    assert_near(value_at(&s, 0.9999999, 0), 1, 0);
    assert_near(value_at(&s, 1.0, 0), 2, 0);
    assert_near(value_at(&s, 2.4999, 0), 2, 0);
    assert_near(value_at(&s, 2.9, 0), 3, 0);
}

static void linear_keys_draw_straight_lines(void **state)
{
    (void)state;
    float values[8];
    for (int i = 0; i < 4; i++) {
        values[2 * i] = 3.0f - 2.0f * TIMES[i]; /* a line through all keys */
        values[2 * i + 1] = i == 2 ? 5.0f : 0.0f;
    }
    scene_sampler s = {SCENE_LINEAR, 4, TIMES, 2, values};
    for (double t = 0.5; t <= 3.0; t += 0.03125) {
        assert_near(value_at(&s, t, 0), 3.0 - 2.0 * t, 1e-12);
        double tent = t < 1.0 ? 0.0 : t < 2.5 ? 5.0 * (t - 1.0) / 1.5 : 5.0 * (3.0 - t) / 0.5;
        assert_near(value_at(&s, t, 1), tent, 1e-12);
    }
}

/* 1 - 2 t + 3 t^2 - t^3 / 2 and its derivative. */
static double polynomial(double t)
{
    return 1.0 + t * (-2.0 + t * (3.0 - 0.5 * t));
}
static double slope(double t)
{
    return -2.0 + t * (6.0 - 1.5 * t);
}

static void cubic_keys_reproduce_a_cubic_polynomial(void **state)
{
    (void)state;
    float values[12];
    for (int i = 0; i < 4; i++) {
        double t = (double)TIMES[i]; /* halves and integers: all of this is exact in float */
        values[3 * i] = values[3 * i + 2] = (float)slope(t);
        values[3 * i + 1] = (float)polynomial(t);
    }
    scene_sampler s = {SCENE_CUBIC_SPLINE, 4, TIMES, 1, values};
    for (double t = 0.5; t <= 3.0; t += 0.03125)
        assert_near(value_at(&s, t, 0), polynomial(t), 1e-12);
}

static void spline_sides_of_a_key_have_their_own_tangents(void **state)
{
    (void)state;
    /* Out 4 on the left, in -8 on the right: a + of each basis function times the 1.5 s between the keys. */
    static const float times[2] = {1, 2.5f};
    static const float values[6] = {99, 0, 4, -8, 0, 99};
    scene_sampler s = {SCENE_CUBIC_SPLINE, 2, times, 1, values};
    /* At the middle the bases are 1/8 and -1/8. */
    assert_near(value_at(&s, 1.75, 0), 1.5 * (4.0 + 8.0) / 8.0, 1e-12);
    double h = 1e-6;
    assert_near((value_at(&s, 1.0 + h, 0) - value_at(&s, 1.0, 0)) / h, 4.0, 1e-4);
    assert_near((value_at(&s, 2.5, 0) - value_at(&s, 2.5 - h, 0)) / h, -8.0, 1e-4);
}

/* Unit quaternion of a turn by angle around an axis. */
static void turn(const double axis[3], double angle, float out[4])
{
    double length = sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
    for (int i = 0; i < 3; i++)
        out[i] = (float)(sin(0.5 * angle) * axis[i] / length);
    out[3] = (float)cos(0.5 * angle);
}

static void rotations_are_uniform_along_the_shorter_arc(void **state)
{
    (void)state;
    static const float times[2] = {0, 2};
    static const double axes[3][3] = {{0, 0, 1}, {1, -2, 0.5}, {-3, 1, 1}};
    static const double angles[] = {1e-9, 1e-5, 0.01, 1.0, 3.0, 3.14, -2.0};
    for (int i = 0; i < 3 * 7 * 2; i++) {
        const double *axis = axes[i % 3];
        double angle = angles[i / 3 % 7];
        float values[8];
        turn(axis, 0.3, values);
        turn(axis, 0.3 + angle, values + 4);
        if (i / 21) /* the same rotation, by the opposite quaternion */
            for (int k = 4; k < 8; k++)
                values[k] = -values[k];
        scene_sampler s = {SCENE_LINEAR, 2, times, 4, values};
        for (double t = 0.0; t <= 2.0; t += 0.125) {
            float expected[4], rotation[4];
            turn(axis, 0.3 + angle * 0.5 * t, expected);
            assert_true(sampler_rotation_at(&s, t, rotation));
            double dot = 0.0, length = 0.0;
            for (int k = 0; k < 4; k++) {
                dot += (double)rotation[k] * (double)expected[k];
                length += (double)rotation[k] * (double)rotation[k];
            }
            assert_near(length, 1.0, 3e-7);
            for (int k = 0; k < 4; k++)
                assert_near(rotation[k], (dot < 0.0 ? -1.0 : 1.0) * (double)expected[k], 2e-6);
        }
    }
}

static void opposite_rotations_take_either_arc(void **state)
{
    (void)state;
    /* 180 degrees apart: both paths are equally long, and the result is a rotation. */
    static const float times[2] = {0, 1};
    static const float values[8] = {0, 0, 0, 1, 0, 1, 0, 0};
    scene_sampler s = {SCENE_LINEAR, 2, times, 4, values};
    float rotation[4];
    assert_true(sampler_rotation_at(&s, 0.5, rotation));
    assert_near(fabsf(rotation[1]), sqrt(0.5), 1e-6);
    assert_near(rotation[3], sqrt(0.5), 1e-6);
}

static void cubic_rotations_are_normalised(void **state)
{
    (void)state;
    static const float times[2] = {0, 1};
    static const float values[24] = {0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 2, 0, 0, 0, -2, 0, 0, 0, 1, 0, 0, 0, 0, 0};
    scene_sampler s = {SCENE_CUBIC_SPLINE, 2, times, 4, values};
    float rotation[4];
    assert_true(sampler_rotation_at(&s, 0.5, rotation));
    /* Unnormalised: z = 1/2 + 2/8 + 2/8, w = 1/2. */
    assert_near(rotation[2], 1.0 / sqrt(1.25), 1e-6);
    assert_near(rotation[3], 0.5 / sqrt(1.25), 1e-6);
    /* Keys that cancel give none. */
    static const float cancel[24] = {0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, -1, 0, 0, 0, 0};
    s.values = cancel;
    assert_false(sampler_rotation_at(&s, 0.5, rotation));
}

static void rotation_keys_keep_their_bits(void **state)
{
    (void)state;
    float values[4 * 4];
    for (int i = 0; i < 4; i++)
        turn((const double[3]){1, i, -2}, 0.7 * i, values + 4 * i);
    scene_sampler s = {SCENE_LINEAR, 4, TIMES, 4, values};
    for (int i = 0; i < 4; i++) {
        float rotation[4];
        assert_true(sampler_rotation_at(&s, (double)TIMES[i], rotation));
        assert_memory_equal(rotation, values + 4 * i, sizeof rotation);
    }
}

static void one_key_is_constant(void **state)
{
    (void)state;
    static const float values[3] = {7, 8, 9};
    for (int interpolation = SCENE_STEP; interpolation <= SCENE_CUBIC_SPLINE; interpolation++) {
        scene_sampler s = {(scene_interpolation)interpolation, 1, TIMES, 1, values};
        for (double t = -1.0; t < 3.0; t += 0.5)
            assert_near(value_at(&s, t, 0), interpolation == SCENE_CUBIC_SPLINE ? 8 : 7, 0);
    }
}

static void many_keys_are_searched(void **state)
{
    (void)state;
    enum { COUNT = 1000 };
    static float times[COUNT], values[COUNT];
    for (int i = 0; i < COUNT; i++) {
        times[i] = (float)(i * i) * 0.01f;
        values[i] = (float)i;
    }
    for (uint32_t count = 1; count < COUNT; count += 37) {
        scene_sampler s = {SCENE_STEP, count, times, 1, values};
        for (uint32_t i = 0; i + 1 < count; i++)
            assert_near(value_at(&s, 0.5 * ((double)times[i] + (double)times[i + 1]), 0), i, 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(keys_are_exact_and_ends_are_held),
        cmocka_unit_test(steps_hold_until_the_next_key),
        cmocka_unit_test(linear_keys_draw_straight_lines),
        cmocka_unit_test(cubic_keys_reproduce_a_cubic_polynomial),
        cmocka_unit_test(spline_sides_of_a_key_have_their_own_tangents),
        cmocka_unit_test(rotations_are_uniform_along_the_shorter_arc),
        cmocka_unit_test(opposite_rotations_take_either_arc),
        cmocka_unit_test(cubic_rotations_are_normalised),
        cmocka_unit_test(rotation_keys_keep_their_bits),
        cmocka_unit_test(one_key_is_constant),
        cmocka_unit_test(many_keys_are_searched),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
