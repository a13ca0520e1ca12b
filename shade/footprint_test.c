/* footprint_test.c - ellipses of known axes, and the second moment of the probes that cover them. */
#include "testing/test_support.h"

/* Axes p >= q of a rotated ellipse: derivatives along the image's x and y are any pair of conjugate radii. */
static Footprint turned(double p, double q, double turn, double phase, vec2 size)
{
    double c = cos(turn), s = sin(turn), cp = cos(phase), sp = sin(phase);
    vec2 dx = vec2((float)((c * p * cp - s * q * sp) / (double)size[0]),
                   (float)((s * p * cp + c * q * sp) / (double)size[1]));
    vec2 dy = vec2((float)((-c * p * sp - s * q * cp) / (double)size[0]),
                   (float)((-s * p * sp + c * q * cp) / (double)size[1]));
    return footprint_from_derivatives(size, dx, dy);
}

static void test_axes(void **state)
{
    (void)state;
    vec2 size = vec2(512.0f, 300.0f);
    for (int i = 0; i < 40; ++i) {
        double turn = 0.157 * i, phase = 0.3 * i, p = 2.0 + i, q = 1.5;
        Footprint f = turned(p, q, turn, phase, size);
        expect_relative(f.major2, p * p, 1e-4, "major axis, turn %g", turn);
        expect_near((double)f.minor2, q * q, 1e-5 * p * p, "minor axis, turn %g", turn);
        assert_true(footprint_is_finite(f));
        double cross = (double)f.axis_u * sin(turn) - (double)f.axis_v * cos(turn);
        double length = sqrt((double)f.axis_u * (double)f.axis_u + (double)f.axis_v * (double)f.axis_v);
        expect_near(cross / length, 0.0, 2e-3, "direction, turn %g", turn);
    }
    vec2 huge = vec2(1e30f, 0.0f);
    assert_false(footprint_is_finite(footprint_from_derivatives(size, huge, huge)));
    vec2 none = vec2(NAN, 0.0f);
    assert_false(footprint_is_finite(footprint_from_derivatives(size, none, none)));
}

/* n probes of width w, s apart, have the second moment (w^2 + (n^2 - 1) s^2) / 12: that of the major axis.
 * None is narrower than the minor axis, the finest texel, or a sixteenth of the major axis. */
static void test_probes_cover_it(void **state)
{
    (void)state;
    vec2 size = vec2(512.0f, 300.0f);
    int before = 0;
    for (int i = 0; i < 400; ++i) {
        double q = i % 3 ? 2.0 : 0.25, p = q * (1.0 + 0.06 * i);
        Footprint f = turned(p, q, 0.4, 0.9, size);
        ProbeRow r = footprint_probes(f, 1.0f, 1.0f / size);
        double u = (double)r.step_u * (double)size[0], v = (double)r.step_v * (double)size[1];
        double moment = (double)r.width2 + (r.count * r.count - 1.0) * (u * u + v * v);
        assert_true(r.count >= 1 && r.count <= FOOTPRINT_MAX_PROBES);
        expect_relative(moment, p * p, 1e-3, "ratio %g", p / q);
        if (r.count > 1) {
            assert_true((double)r.width2 >= 0.99 * (double)max(f.minor2, 1.0f));
            assert_true((double)r.width2 >= 0.99 * p * p / 256.0);
        }
        if (i % 3 == 1) {
            assert_true(r.count >= before); /* more, the longer it is */
            before = r.count;
        }
    }
    assert_int_equal(before, FOOTPRINT_MAX_PROBES);
    assert_int_equal(footprint_probes(turned(3.0, 2.9, 0.1, 0.2, size), 1.0f, 1.0f / size).count, 1);
}

/* Fewer probes cover as much, because they are wider. */
static void test_a_limit_widens_them(void **state)
{
    (void)state;
    vec2 size = vec2(512.0f, 300.0f);
    for (int limit = 1; limit <= FOOTPRINT_MAX_PROBES; limit *= 2)
        for (double ratio = 1.0; ratio < 40.0; ratio *= 1.3) {
            ProbeRow r =
                footprint_probes_up_to(limit, turned(2.0 * ratio, 2.0, 0.4, 0.9, size), 1.0f, 1.0f / size);
            double u = (double)r.step_u * (double)size[0], v = (double)r.step_v * (double)size[1];
            assert_true(r.count <= limit);
            expect_relative((double)r.width2 + (r.count * r.count - 1.0) * (u * u + v * v),
                            4.0 * ratio * ratio, 1e-3, "ratio %g, limit %d", ratio, limit);
            assert_true((double)r.width2 >= 0.99 * 4.0 * ratio * ratio / (limit * limit));
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_axes), cmocka_unit_test(test_probes_cover_it),
                                       cmocka_unit_test(test_a_limit_widens_them)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
