/* Tests of the triangles of light_emitters.h: directions against solid angles and closed forms. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "path/light_emitters.h"
#include "tests/support/support.h"

static uint64_t random_state = 1;
static float random_number(void)
{
    lcg64_next(&random_state);
    return (float)(random_state >> 40) * 0x1p-24f;
}

static vec3 random_point(void)
{
    float x = random_number();
    float y = random_number();
    return vec3(2.0f * x - 1.0f, 2.0f * y - 1.0f, 2.0f * random_number() - 1.0f);
}

static light_triangle random_triangle(void)
{
    light_triangle t;
    t.corner = random_point();
    t.edge1 = random_point() - t.corner;
    t.edge2 = random_point() - t.corner;
    return t;
}

static vec3 point_of(const light_triangle *t, float u, float v)
{
    return t->corner + t->edge1 * u + t->edge2 * v;
}

/* Solid angle of a b c from P: Van Oosterom and Strackee 1983. */
static double solid_angle(vec3 a, vec3 b, vec3 c, vec3 P)
{
    vec3 corners[3] = {a - P, b - P, c - P};
    double d[3][3];
    for (int i = 0; i < 3; i++) {
        double length2 = 0.0;
        for (int k = 0; k < 3; k++)
            length2 += (double)corners[i][k] * (double)corners[i][k];
        for (int k = 0; k < 3; k++)
            d[i][k] = (double)corners[i][k] / sqrt(length2);
    }
    double volume = 0.0;
    double sum = 1.0;
    for (int k = 0; k < 3; k++) {
        int m = (k + 1) % 3;
        int n = (k + 2) % 3;
        volume += d[0][k] * (d[1][m] * d[2][n] - d[1][n] * d[2][m]);
        sum += d[0][k] * d[1][k] + d[1][k] * d[2][k] + d[2][k] * d[0][k];
    }
    return 2.0 * atan2(fabs(volume), sum);
}

/* Near triangles are sampled uniformly in direction: parts of one in proportion to their solid angles. */
static void near_directions_are_uniform(void **state)
{
    (void)state;
    int tested = 0;
    for (int trial = 0; trial < 60; trial++) {
        enum { SAMPLES = 20000 };
        light_triangle t = random_triangle();
        vec3 P = random_point() * 0.5f;
        light_triangle_point point;
        if (!light_triangle_sample(&t, P, vec2(0.3f, 0.6f), &point))
            continue;
        double all = solid_angle(t.corner, point_of(&t, 1, 0), point_of(&t, 0, 1), P);
        if (all < 0.05)
            continue;
        tested++;
        assert_true(fabs((double)point.pdf * all - 1.0) < 1e-4);
        /* three parts around a point inside */
        float u = 0.1f + 0.4f * random_number();
        float v = 0.1f + 0.4f * random_number();
        vec3 inside = point_of(&t, u, v);
        double expected[3] = {solid_angle(t.corner, point_of(&t, 1, 0), inside, P),
                              solid_angle(point_of(&t, 1, 0), point_of(&t, 0, 1), inside, P),
                              solid_angle(point_of(&t, 0, 1), t.corner, inside, P)};
        double found[3] = {0.0, 0.0, 0.0};
        for (int i = 0; i < SAMPLES; i++) {
            float x = random_number();
            assert_true(light_triangle_sample(&t, P, vec2(x, random_number()), &point));
            assert_true(point.u >= 0.0f && point.v >= 0.0f && point.u + point.v <= 1.000001f);
            assert_true(fabsf(dot(point.L, point.L) - 1.0f) < 1e-5f);
            vec3 off = P + point.L * point.distance_m - point_of(&t, point.u, point.v);
            assert_true(dot(off, off) < 1e-8f);
            /* in which part: signs of areas around `inside` */
            float a = u * point.v - v * point.u;                   /* against the line corner - inside */
            float b = (u - 1.0f) * point.v - v * (point.u - 1.0f); /* second corner - inside */
            float c = u * (point.v - 1.0f) - (v - 1.0f) * point.u; /* third corner - inside */
            int part = a < 0.0f && b > 0.0f ? 0 : b < 0.0f && c > 0.0f ? 1 : 2;
            found[part] += 1.0;
        }
        for (int k = 0; k < 3; k++) {
            double p = expected[k] / all;
            double error = sqrt(p * (1.0 - p) / SAMPLES);
            if (fabs(found[k] / SAMPLES - p) > 4.5 * error + 1e-4)
                fail_msg("part %d: %.4f, expected %.4f", k, found[k] / SAMPLES, p);
        }
    }
    assert_true(tested > 30);
}

/* The estimate of a solid angle, 1 / pdf, is right on average for far and for near triangles, and sample
 * and pdf agree. */
static void densities_match_solid_angles(void **state)
{
    (void)state;
    for (int trial = 0; trial < 200; trial++) {
        enum { SAMPLES = 2000 };
        light_triangle t = random_triangle();
        vec3 P = random_point() * (trial % 4 == 0   ? 0.5f
                                   : trial % 4 == 1 ? 3.0f
                                   : trial % 4 == 2 ? 30.0f
                                                    : 8.0f);
        double expected = solid_angle(t.corner, point_of(&t, 1, 0), point_of(&t, 0, 1), P);
        double sum = 0.0;
        double sum2 = 0.0;
        for (int i = 0; i < SAMPLES; i++) {
            light_triangle_point point;
            float x = random_number();
            if (!light_triangle_sample(&t, P, vec2(x, random_number()), &point))
                continue;
            assert_true(point.pdf > 0.0f && isfinite(point.pdf));
            float pdf = light_triangle_pdf(&t, P, point.L, point.distance_m);
            assert_true(fabsf(pdf / point.pdf - 1.0f) < 1e-5f);
            sum += 1.0 / (double)point.pdf;
            sum2 += 1.0 / ((double)point.pdf * (double)point.pdf);
        }
        double mean = sum / SAMPLES;
        double error = sqrt(fmax(sum2 / SAMPLES - mean * mean, 0.0) / SAMPLES);
        if (fabs(mean - expected) > 4.5 * error + 1e-4 * expected + 1e-6)
            fail_msg("%g +- %g, expected %g", mean, error, expected);
    }
}

/* On its plane, on its edges, at its corners; needles; far away: nothing but a number or a no. */
static void odd_views_are_finite(void **state)
{
    (void)state;
    for (int trial = 0; trial < 20000; trial++) {
        light_triangle t = random_triangle();
        if (trial % 5 == 1)
            t.edge2 = t.edge1 * random_number() + vec3(1e-6f * random_number());
        if (trial % 5 == 2)
            t.edge2 = t.edge1;
        float scale = trial % 7 == 0 ? 1e-15f : trial % 7 == 1 ? 1e12f : 1.0f;
        t.corner *= scale;
        t.edge1 *= scale;
        t.edge2 *= scale;
        vec3 P = trial % 3 == 0   ? point_of(&t, random_number(), random_number())
                 : trial % 3 == 1 ? point_of(&t, (float)(trial / 3 % 2), (float)(trial / 6 % 2))
                                  : random_point() * 2.0f;
        light_triangle_point point;
        float ends[3] = {0.0f, 0x1.fffffep-1f, random_number()};
        if (!light_triangle_sample(&t, P, vec2(ends[trial % 3], ends[trial / 3 % 3]), &point))
            continue;
        assert_true(point.pdf > 0.0f && isfinite(point.pdf));
        assert_true(point.distance_m > 0.0f && isfinite(point.distance_m));
        assert_true(fabsf(dot(point.L, point.L) - 1.0f) < 1e-4f);
        assert_true(point.u >= 0.0f && point.v >= 0.0f && point.u + point.v <= 1.000001f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(near_directions_are_uniform),
        cmocka_unit_test(densities_match_solid_angles),
        cmocka_unit_test(odd_views_are_finite),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
