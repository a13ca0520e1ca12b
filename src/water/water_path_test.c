/* water_path_test.c - the surface of water as paths hit it: energy is conserved in a closed box, from
 * above and below; the pdf is that of the samples; the BSDF is reciprocal; the water below attenuates and
 * emits as it should. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "tests/support/support.h"

#include "water/water_path.h"

static const float IOR = 1.34f;

static water_path bright_water(void)
{
    water_path s = {.sun_spread = 0.06f};
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

static path_surface_point point_of(float variance, float foam, float side)
{
    vec3 up = vec3(0.0f, 1.0f, 0.0f);
    return (path_surface_point){
        .N = up, .Ng = up, .values = {1.2f * variance, 0.8f * variance, 0.1f * variance, foam}, .side = side};
}

static vec3 seen_from(float degrees, float side)
{
    float a = degrees * (PI / 180.0f);
    return vec3(sin(a) * 0.8f, cos(a) * side, sin(a) * 0.6f);
}

/* ---- the surface that the path tracer is given ---- */

static bsdf_sample sampled(const water_path *w, const path_surface_point *p, vec3 V, float u_lobe, vec2 u)
{
    path_surface s = water_path_surface(w);
    bsdf_sample out = {.weight = vec3(0.0f)};
    (void)s.sample(s.self, p, V, u_lobe, u, &out);
    return out;
}

static vec3 eval(const water_path *w, const path_surface_point *p, vec3 V, vec3 L, float *pdf)
{
    path_surface s = water_path_surface(w);
    return s.eval(s.self, p, V, L, pdf);
}

static vec3 emission(const water_path *w, vec3 P, vec3 D, float distance_m)
{
    path_surface s = water_path_surface(w);
    return s.emission(s.self, P, D, distance_m, false);
}

static vec3 transmittance(const water_path *w, float distance_m)
{
    path_surface s = water_path_surface(w);
    return s.transmittance(s.self, distance_m);
}

static vec3 sun_sample(const water_path *w, vec2 u)
{
    path_surface s = water_path_surface(w);
    return s.sun_sample(s.self, u);
}

static float sun_pdf(const water_path *w, vec3 L)
{
    path_surface s = water_path_surface(w);
    return s.sun_pdf(s.self, L);
}

/* ---- tests ---- */

/* Points of a lattice in four dimensions: i times the powers of a root. */
static float lattice(uint32_t i, int dimension)
{
    static const double steps[4] = {0.8566748838545029, 0.733891856627126, 0.6287067210378087,
                                    0.5385972572236101};
    double x = ((double)i + 0.5) * steps[dimension];
    return (float)(x - (double)(uint64_t)x);
}

/* Radiance 1 from above and n^2 from below: the surface shows 1 to an eye above, n^2 to one below. */
static void a_closed_box_conserves_energy(void **state)
{
    (void)state;
    water_path s = bright_water();
    uint32_t count = IS_SLOW ? 4000 : 40000;
    for (int k = 0; k < 48; k++) {
        float side = k % 2 ? -1.0f : 1.0f, degrees = 28.0f * (float)(k / 2 % 4);
        static const float variances[] = {1e-6f, 0.01f, 0.04f}, foams[] = {0.0f, 0.7f};
        path_surface_point p = point_of(variances[k / 8 % 3], foams[k / 24], side);
        vec3 V = seen_from(degrees, side);
        p.N = water_faced(p.N, V * side);
        double sum = 0.0;
        for (uint32_t i = 0; i < count; i++) {
            bsdf_sample d = sampled(&s, &p, V, lattice(i, 2), vec2(lattice(i, 0), lattice(i, 1)));
            bool is_below = (side < 0.0f) != d.is_transmission;
            assert_true(d.weight[0] >= 0.0f && d.weight[0] < 2.0f);
            assert_true(d.L[1] * (is_below ? -1.0f : 1.0f) > 0.0f);
            sum += (double)d.weight[0] * (is_below ? (double)(IOR * IOR) : 1.0);
        }
        double shown = sum / count / (side < 0.0f ? (double)(IOR * IOR) : 1.0);
        if (!(fabsf((float)shown - 1.0f) < 2e-4f))
            fail_msg("side %g, %g degrees, variance %g, foam %g: %g", (double)side, (double)degrees,
                     (double)p.values[0], (double)p.values[3], shown);
    }
}

/* Between equal indices there is no surface: the ray goes on, with all its light, but for foam. */
static void equal_indices_transmit_all(void **state)
{
    (void)state;
    water_path s = bright_water();
    s.water.ior = 1.0f;
    for (int k = 0; k < 8; k++) {
        float side = k % 2 ? -1.0f : 1.0f, pdf;
        path_surface_point p = point_of(0.03f, k / 4 ? 0.3f : 0.0f, side);
        vec3 V = seen_from(20.0f * (float)(k / 2), side);
        for (uint32_t i = 0; i < 200; i++) {
            float u = lattice(i, 2);
            bsdf_sample d = sampled(&s, &p, V, u, vec2(lattice(i, 0), lattice(i, 1)));
            if (u < p.values[3])
                continue;
            assert_true(d.is_specular && d.is_transmission && !d.excludes_sun && d.weight[0] == 1.0f);
            assert_true(dot(d.L, V) < -0.999999f);
        }
        assert_true((eval(&s, &p, V, -V, &pdf)[0] == 0.0f) == (p.values[3] == 0.0f));
    }
}

/* Means of a function of the direction, by sampling and by quadrature over directions: both agree, but for
 * second facets, whose share is counted. */
static void samples_follow_the_bsdf(void **state)
{
    (void)state;
    water_path s = bright_water();
    const uint32_t count = IS_SLOW ? 20000 : 200000, rows = 700;
    for (int k = 0; k < 12; k++) {
        float side = k % 2 ? -1.0f : 1.0f;
        path_surface_point p = point_of(0.03f, k / 6 ? 0.4f : 0.0f, side);
        vec3 V = seen_from(15.0f + 28.0f * (float)(k / 2 % 3), side);
        double estimated[2] = {0.0, 0.0}, integrated[2] = {0.0, 0.0}, pdf_sum = 0.0, first = 0.0;
        for (uint32_t i = 0; i < count; i++) {
            bsdf_sample d = sampled(&s, &p, V, lattice(i, 2), vec2(lattice(i, 0), lattice(i, 1)));
            if (d.excludes_sun)
                continue;
            first += 1.0 / count;
            estimated[d.L[1] < 0.0f] +=
                (double)(d.weight[0] * (1.0f + d.L[0] * d.L[0] + 0.5f * d.L[2])) / count;
        }
        for (uint32_t y = 0; y < rows; y++)
            for (uint32_t x = 0; x < 2 * rows; x++) {
                float c = 1.0f - 2.0f * ((float)y + 0.5f) / (float)rows, r = sqrt(1.0f - c * c);
                float phi = PI * ((float)x + 0.5f) / (float)rows, pdf;
                vec3 L = vec3(r * cos(phi), c, r * sin(phi));
                vec3 f = eval(&s, &p, V, L, &pdf);
                double solid_angle = 4.0 * 3.14159265358979 / (2.0 * rows * (double)rows);
                integrated[c < 0.0f] += (double)(f[0] * (1.0f + L[0] * L[0] + 0.5f * L[2])) * solid_angle;
                pdf_sum += (double)pdf * solid_angle;
            }
        for (int half = 0; half < 2; half++)
            if (!(fabsf((float)(estimated[half] - integrated[half])) < 6e-3f))
                fail_msg("case %d, half %d: %g sampled, %g integrated", k, half, estimated[half],
                         integrated[half]);
        assert_true(fabsf((float)(pdf_sum - first)) < 4e-3f);
    }
}

/* f(V, L) |N.L| / |N.V| / n^2 is symmetric, n being that of the side that it is seen from. */
static void the_bsdf_is_reciprocal(void **state)
{
    (void)state;
    water_path s = bright_water();
    uint32_t compared = 0;
    for (uint32_t i = 0; i < 4000; i++) {
        vec3 A = seen_from(80.0f * lattice(i, 0), 1.0f);
        float side = i % 2 ? -1.0f : 1.0f, phi = 6.2831853f * lattice(i, 1), r = 0.7f * lattice(i, 2), pdf;
        vec3 B = vec3(r * cos(phi), sqrt(1.0f - r * r) * side, r * sin(phi));
        path_surface_point a = point_of(0.05f, 0.0f, 1.0f), b = point_of(0.05f, 0.0f, side);
        float n = side < 0.0f ? IOR * IOR : 1.0f;
        float there = eval(&s, &a, A, B, &pdf)[0] / abs(B[1]);
        float back = eval(&s, &b, B, A, &pdf)[0] / A[1] / n;
        if (there > 1e-3f) {
            assert_true(abs(there / back - 1.0f) < 1e-3f);
            compared++;
        }
    }
    assert_true(compared > 400);
}

/* Water that is endless shines as water_from_deep() has it, whatever the direction; what is at its end
 * takes the place of the rest. */
static void deep_water_has_its_reflectance(void **state)
{
    (void)state;
    water_path s = bright_water();
    vec3 deep = water_from_deep(s.water, s.downwelling), P = vec3(3.0f, 0.0f, 4.0f);
    s.fall = 0.1f;
    P[1] = -2.5f; /* on the level there */
    s.beam = vec3(0.0f);
    for (int i = 0; i < 5; i++) {
        vec3 D = seen_from(12.0f * (float)i, -1.0f), all = emission(&s, P, D, INFINITY);
        vec3 part = emission(&s, P, D, 7.0f);
        for (int c = 0; c < 3; c++) {
            assert_true(abs(all[c] / deep[c] - 1.0f) < 1e-4f);
            assert_true(part[c] > 0.0f && part[c] < all[c]);
        }
    }
    assert_true(water_path_depth(&s, P) < 1e-6f &&
                abs(water_path_depth(&s, P - vec3(0.0f, 2.0f, 0.0f)) - 2.0f) < 1e-5f);
    vec3 left = transmittance(&s, 3.0f);
    assert_true(abs(left[0] - exp(-0.302f * 3.0f)) < 1e-6f);
    assert_true(max3(transmittance(&s, INFINITY)) == 0.0f);
}

/* The density of directions towards the sun is that with which they are drawn. */
static void samples_follow_the_pdf_of_the_refracted_sun(void **state)
{
    (void)state;
    water_path s = bright_water();
    double mean = 0.0, expected = 0.0, all = 0.0;
    const uint32_t count = 20000, rings = 400;
    for (uint32_t i = 0; i < count; i++) {
        vec3 L = sun_sample(&s, vec2(lattice(i, 0), lattice(i, 1)));
        mean += (double)(1.0f - dot(L, s.sunward)) / count;
    }
    mat3 frame = basis_from_normal(s.sunward);
    for (uint32_t i = 0; i < rings; i++) {
        float angle = 0.5f * ((float)i + 0.5f) / (float)rings;
        vec3 L = mul(frame, vec3(sin(angle), 0.0f, cos(angle)));
        double ring = 2.0 * 3.14159265358979 * (double)sin(angle) * 0.5 / rings;
        double pdf = (double)sun_pdf(&s, L) * ring;
        all += pdf;
        expected += pdf * (double)(1.0f - cos(angle));
    }
    assert_true(fabsf((float)all - 1.0f) < 1e-3f);
    assert_true(fabsf((float)(mean / expected) - 1.0f) < 2e-2f);
    assert_true(sun_pdf(&s, -s.sunward) == 0.0f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_closed_box_conserves_energy),
                                       cmocka_unit_test(equal_indices_transmit_all),
                                       cmocka_unit_test(samples_follow_the_bsdf),
                                       cmocka_unit_test(the_bsdf_is_reciprocal),
                                       cmocka_unit_test(deep_water_has_its_reflectance),
                                       cmocka_unit_test(samples_follow_the_pdf_of_the_refracted_sun)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
