/* path_sea_test.c - the surface of a sea as paths meet it: nothing is lost or gained in a closed box, from above and below; what is
 * sampled has the density that it says; light goes both ways alike; the water between. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/test_effort.h"

#include "path/path_sea.h"

static const float IOR = 1.34f;

static path_sea sea_of_light(void)
{
    path_sea s = {.sun_spread = 0.06f};
    s.water.ior = IOR;
    s.water.absorption = vec3(0.3f, 0.06f, 0.02f);
    s.water.scattering = vec3(0.09f, 0.1f, 0.12f);
    s.water.backscattering = vec3(0.002f, 0.003f, 0.004f);
    s.water.reflectance = vec3(0.001f, 0.006f, 0.025f);
    s.water.foam_albedo = 0.55f;
    s.downwelling = vec3(1000.0f, 1100.0f, 1200.0f);
    s.sunward = normalize(vec3(0.3f, 1.0f, 0.2f));
    return s;
}

static path_sea_point point_of(const path_sea *s, float variance, float foam, float side)
{
    vec3 up = vec3(0.0f, 1.0f, 0.0f);
    return (path_sea_point){.sea = s,
                            .N = up,
                            .Ng = up,
                            .C = vec3(1.2f * variance, 0.8f * variance, 0.1f * variance),
                            .foam = foam,
                            .side = side};
}

static vec3 seen_from(float degrees, float side)
{
    float a = degrees * (PI / 180.0f);
    return vec3(sin(a) * 0.8f, cos(a) * side, sin(a) * 0.6f);
}

/* Numbers of a lattice in four dimensions: i times the powers of a root. */
static float lattice(uint32_t i, int dimension)
{
    static const double steps[4] = {0.8566748838545029, 0.733891856627126, 0.6287067210378087,
                                    0.5385972572236101};
    double x = ((double)i + 0.5) * steps[dimension];
    return (float)(x - (double)(uint64_t)x);
}

/* Radiance 1 from above and n^2 from below: the surface shows 1 to an eye above, n^2 to one below. */
static void closed_box(void **state)
{
    (void)state;
    path_sea s = sea_of_light();
    uint32_t count = IS_SLOW ? 4000 : 40000;
    for (int k = 0; k < 48; k++) {
        float side = k % 2 ? -1.0f : 1.0f, degrees = 28.0f * (float)(k / 2 % 4);
        static const float variances[] = {1e-6f, 0.01f, 0.04f}, foams[] = {0.0f, 0.7f};
        path_sea_point p = point_of(&s, variances[k / 8 % 3], foams[k / 24], side);
        vec3 V = seen_from(degrees, side);
        p.N = water_faced(p.N, V * side);
        double sum = 0.0;
        for (uint32_t i = 0; i < count; i++) {
            path_sea_direction d = path_sea_sample(&p, V, lattice(i, 2), vec2(lattice(i, 0), lattice(i, 1)));
            bool is_below = (side < 0.0f) != d.is_through;
            assert_true(d.weight >= 0.0f && d.weight < 2.0f);
            assert_true(d.L[1] * (is_below ? -1.0f : 1.0f) > 0.0f);
            sum += (double)d.weight * (is_below ? (double)(IOR * IOR) : 1.0);
        }
        double shown = sum / count / (side < 0.0f ? (double)(IOR * IOR) : 1.0);
        if (!(fabsf((float)shown - 1.0f) < 2e-4f))
            fail_msg("side %g, %g degrees, variance %g, foam %g: %g", (double)side, (double)degrees,
                     (double)p.C[0], (double)p.foam, shown);
    }
}

/* Between equal indices there is no surface: the ray goes on, with all its light, but for foam. */
static void equal_indices_let_through(void **state)
{
    (void)state;
    path_sea s = sea_of_light();
    s.water.ior = 1.0f;
    for (int k = 0; k < 8; k++) {
        float side = k % 2 ? -1.0f : 1.0f, pdf;
        path_sea_point p = point_of(&s, 0.03f, k / 4 ? 0.3f : 0.0f, side);
        vec3 V = seen_from(20.0f * (float)(k / 2), side);
        for (uint32_t i = 0; i < 200; i++) {
            float u = lattice(i, 2);
            path_sea_direction d = path_sea_sample(&p, V, u, vec2(lattice(i, 0), lattice(i, 1)));
            if (u < p.foam)
                continue;
            assert_true(d.is_straight && d.is_through && !d.is_second && d.weight == 1.0f);
            assert_true(dot(d.L, V) < -0.999999f);
        }
        assert_true((path_sea_scatter(&p, V, -V, &pdf)[0] == 0.0f) == (p.foam == 0.0f));
    }
}

/* Means of a function of the direction, by sampling and by quadrature over directions: both agree, but for second facets, whose share
 * is counted. */
static void sampling_finds_what_is_scattered(void **state)
{
    (void)state;
    path_sea s = sea_of_light();
    const uint32_t count = IS_SLOW ? 20000 : 200000, rows = 700;
    for (int k = 0; k < 12; k++) {
        float side = k % 2 ? -1.0f : 1.0f;
        path_sea_point p = point_of(&s, 0.03f, k / 6 ? 0.4f : 0.0f, side);
        vec3 V = seen_from(15.0f + 28.0f * (float)(k / 2 % 3), side);
        double sampled[2] = {0.0, 0.0}, integrated[2] = {0.0, 0.0}, pdf_sum = 0.0, first = 0.0;
        for (uint32_t i = 0; i < count; i++) {
            path_sea_direction d = path_sea_sample(&p, V, lattice(i, 2), vec2(lattice(i, 0), lattice(i, 1)));
            if (d.is_second)
                continue;
            first += 1.0 / count;
            sampled[d.L[1] < 0.0f] += (double)(d.weight * (1.0f + d.L[0] * d.L[0] + 0.5f * d.L[2])) / count;
        }
        for (uint32_t y = 0; y < rows; y++)
            for (uint32_t x = 0; x < 2 * rows; x++) {
                float c = 1.0f - 2.0f * ((float)y + 0.5f) / (float)rows, r = sqrt(1.0f - c * c);
                float phi = PI * ((float)x + 0.5f) / (float)rows, pdf;
                vec3 L = vec3(r * cos(phi), c, r * sin(phi));
                vec3 f = path_sea_scatter(&p, V, L, &pdf);
                double solid_angle = 4.0 * 3.14159265358979 / (2.0 * rows * (double)rows);
                integrated[c < 0.0f] += (double)(f[0] * (1.0f + L[0] * L[0] + 0.5f * L[2])) * solid_angle;
                pdf_sum += (double)pdf * solid_angle;
            }
        for (int half = 0; half < 2; half++)
            if (!(fabsf((float)(sampled[half] - integrated[half])) < 6e-3f))
                fail_msg("case %d, half %d: %g sampled, %g integrated", k, half, sampled[half],
                         integrated[half]);
        assert_true(fabsf((float)(pdf_sum - first)) < 4e-3f);
    }
}

/* f(V, L) |N.L| / |N.V| / n^2 is the same both ways, n being that of the side that it is seen from. */
static void light_goes_both_ways(void **state)
{
    (void)state;
    path_sea s = sea_of_light();
    uint32_t compared = 0;
    for (uint32_t i = 0; i < 4000; i++) {
        vec3 A = seen_from(80.0f * lattice(i, 0), 1.0f);
        float side = i % 2 ? -1.0f : 1.0f, phi = 6.2831853f * lattice(i, 1), r = 0.7f * lattice(i, 2), pdf;
        vec3 B = vec3(r * cos(phi), sqrt(1.0f - r * r) * side, r * sin(phi));
        path_sea_point a = point_of(&s, 0.05f, 0.0f, 1.0f), b = point_of(&s, 0.05f, 0.0f, side);
        float n = side < 0.0f ? IOR * IOR : 1.0f;
        float there = path_sea_scatter(&a, A, B, &pdf)[0] / abs(B[1]);
        float back = path_sea_scatter(&b, B, A, &pdf)[0] / A[1] / n;
        if (there > 1e-3f) {
            assert_true(abs(there / back - 1.0f) < 1e-3f);
            compared++;
        }
    }
    assert_true(compared > 400);
}

/* Water that is endless shines as water_from_deep() has it, whatever the direction; what is at its end takes the place of the rest. */
static void deep_water_shines(void **state)
{
    (void)state;
    path_sea s = sea_of_light();
    vec3 deep = water_from_deep(s.water, s.downwelling), P = vec3(3.0f, 0.0f, 4.0f);
    s.fall = 0.1f;
    P[1] = -2.5f; /* on the level there */
    s.beam = vec3(0.0f);
    for (int i = 0; i < 5; i++) {
        vec3 D = seen_from(12.0f * (float)i, -1.0f), all = path_sea_glow(&s, P, D, INFINITY);
        vec3 part = path_sea_glow(&s, P, D, 7.0f);
        for (int c = 0; c < 3; c++) {
            assert_true(abs(all[c] / deep[c] - 1.0f) < 1e-4f);
            assert_true(part[c] > 0.0f && part[c] < all[c]);
        }
    }
    assert_true(path_sea_depth(&s, P) < 1e-6f &&
                abs(path_sea_depth(&s, P - vec3(0.0f, 2.0f, 0.0f)) - 2.0f) < 1e-5f);
    vec3 left = path_sea_transmittance(&s, 3.0f);
    assert_true(abs(left[0] - exp(-0.302f * 3.0f)) < 1e-6f);
    assert_true(max3(path_sea_transmittance(&s, INFINITY)) == 0.0f);
}

/* The density of directions towards the sun is that with which they are drawn. */
static void the_sun_is_aimed_at(void **state)
{
    (void)state;
    path_sea s = sea_of_light();
    double mean = 0.0, expected = 0.0, all = 0.0;
    const uint32_t count = 20000, rings = 400;
    for (uint32_t i = 0; i < count; i++) {
        vec3 L = path_sea_sunward(&s, vec2(lattice(i, 0), lattice(i, 1)));
        mean += (double)(1.0f - dot(L, s.sunward)) / count;
    }
    mat3 frame = basis_from_normal(s.sunward);
    for (uint32_t i = 0; i < rings; i++) {
        float angle = 0.5f * ((float)i + 0.5f) / (float)rings;
        vec3 L = mul(frame, vec3(sin(angle), 0.0f, cos(angle)));
        double ring = 2.0 * 3.14159265358979 * (double)sin(angle) * 0.5 / rings;
        double pdf = (double)path_sea_sunward_pdf(&s, L) * ring;
        all += pdf;
        expected += pdf * (double)(1.0f - cos(angle));
    }
    assert_true(fabsf((float)all - 1.0f) < 1e-3f);
    assert_true(fabsf((float)(mean / expected) - 1.0f) < 2e-2f);
    assert_true(path_sea_sunward_pdf(&s, -s.sunward) == 0.0f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(closed_box),
                                       cmocka_unit_test(equal_indices_let_through),
                                       cmocka_unit_test(sampling_finds_what_is_scattered),
                                       cmocka_unit_test(light_goes_both_ways),
                                       cmocka_unit_test(deep_water_shines),
                                       cmocka_unit_test(the_sun_is_aimed_at)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
