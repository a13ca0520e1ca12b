/* Truth tests of stretched highlights (KHR_materials_anisotropy) under an environment: the path tracer equals a
 * quadrature in double, and the preview's few lookups are near it. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

#include "path/path_fixture.h"

/* A lamp of radiance about 9 and a smaller one, on a gradient. */
static void sky_of_lamps(const double d[3], float rgb[3])
{
    double a = 0.48 * d[0] + 0.8 * d[1] + 0.36 * d[2], b = -0.6 * d[0] + 0.64 * d[1] - 0.48 * d[2];
    rgb[0] = (float)(0.4 + 0.3 * d[1] + 9.0 * exp(40.0 * (a - 1.0)));
    rgb[1] = (float)(0.6 + 0.3 * d[0] + 20.0 * exp(150.0 * (b - 1.0)));
    rgb[2] = (float)(0.5 + 0.4 * sin(3.0 * d[2]));
}

/* ---- the reference ---- */

/* Lambda of Smith's masking. Heitz 2014, equations 72 and 86. */
static double lambda(const double v[3], const double alpha[2])
{
    double x = alpha[0] * v[0] / v[2], y = alpha[1] * v[1] / v[2];
    return 0.5 * (sqrt(1.0 + x * x + y * y) - 1.0);
}

/* Light that a floor of F = 1 reflects to V (in the frame x = T, y = B, z = N), over its albedo: midpoints of
 * microfacets' slopes (ax q cos p, ay q sin p), where q^2 / (1 + q^2) and p are uniform for GGX. The frame is
 * turned by `turn` from T = +X, B = +Z. */
static void reflected(const double V[3], const double alpha[2], double turn, double out[3], double *albedo)
{
    enum { STEPS = 512 };
    double view = lambda(V, alpha);
    out[0] = out[1] = out[2] = *albedo = 0.0;
    for (int i = 0; i < STEPS * STEPS; i++) {
        double t = (i / STEPS + 0.5) / STEPS, p = 2.0 * TRUTH_PI * (i % STEPS + 0.5) / STEPS;
        double q = sqrt(t / (1.0 - t)), x = alpha[0] * q * cos(p), y = alpha[1] * q * sin(p);
        double seen = V[0] * x + V[1] * y + V[2], scale = 2.0 * seen / (1.0 + x * x + y * y);
        double L[3] = {scale * x - V[0], scale * y - V[1], scale - V[2]};
        if (seen <= 0.0 || L[2] <= 0.0)
            continue;
        double weight = seen / V[2] / (1.0 + view + lambda(L, alpha)) / (STEPS * STEPS);
        double world[3] = {cos(turn) * L[0] - sin(turn) * L[1], L[2], sin(turn) * L[0] + cos(turn) * L[1]};
        float radiance[3];
        sky_of_lamps(world, radiance);
        *albedo += weight;
        for (int c = 0; c < 3; c++)
            out[c] += weight * (double)radiance[c];
    }
}

/* ---- images of a floor ---- */

typedef struct floor_case {
    double roughness, strength, rotation, polar;
} floor_case;

static fixture floor_of(const floor_case *at, facet_energy energy)
{
    fixture f = truth_create();
    f.desc.energy = energy;
    f.desc.width = f.desc.height = 32;
    f.desc.samples = 256;
    truth_set_sky(&f, 256, sky_of_lamps);
    scene_material m = truth_metal(1.0f, 1.0f, 1.0f, (float)at->roughness);
    m.extensions |= SCENE_ANISOTROPY;
    m.anisotropy = (float)at->strength;
    m.anisotropy_rotation = (float)at->rotation;
    truth_add_floor(&f, fixture_add_material(&f, m), 0.0f, 5.0f);
    truth_set_camera(&f, at->polar, 0.0f, 0.0f, 1.0f);
    return f;
}

/* The reference for a floor, whose texture coordinates have u along +X and v along -Z: T is +X, B is +Z. */
static void reference(const floor_case *at, double out[3], double *albedo)
{
    double a = at->roughness * at->roughness, s = at->strength * at->strength;
    double alpha[2] = {a + (1.0 - a) * s, a}, polar = truth_radians(at->polar);
    double V[3] = {sin(polar) * cos(at->rotation), -sin(polar) * sin(at->rotation), cos(polar)};
    reflected(V, alpha, at->rotation, out, albedo);
}

static const floor_case cases[] = {
    {0.2, 0.5, 0.0, 25.0}, {0.2, 0.5, 0.8, 60.0}, {0.2, 1.0, 1.5707963, 25.0}, {0.2, 1.0, 2.5, 60.0},
    {0.4, 0.6, 0.0, 60.0}, {0.4, 0.6, 0.8, 25.0}, {0.4, 1.0, 1.5707963, 60.0}, {0.4, 1.0, 0.0, 25.0},
    {0.7, 0.5, 0.8, 60.0}, {0.7, 1.0, 0.0, 60.0}, {0.7, 1.0, 2.5, 25.0},       {0.1, 0.7, 0.3, 40.0},
};
enum { CASES = sizeof cases / sizeof *cases };

/* Up to one factor for all directions of light, which compensates multiple scattering: 1 over a bound of the albedo
 * (anisotropic_table_bound()), which is at most 0.1 above it. */
static void paths_equal_the_quadrature(void **state)
{
    (void)state;
    for (int i = 0; i < CASES; i++) {
        fixture f = floor_of(&cases[i], FACET_ENERGY_CONSERVING);
        truth_value v = truth_measure_pixels(&f);
        double expected[3], albedo;
        reference(&cases[i], expected, &albedo);
        double bound = (expected[0] + expected[1] + expected[2]) / (v.mean[0] + v.mean[1] + v.mean[2]);
        print_message("case %d: albedo %.4f, bound %.4f\n", i, albedo, bound);
        assert_true(bound > albedo - 0.002 && bound < albedo + 0.1);
        for (int c = 0; c < 3; c++) {
            double off = v.mean[c] * bound - expected[c];
            print_message("case %d, channel %d: path %.4f +- %.4f, quadrature %.4f\n", i, c,
                          v.mean[c] * bound, v.error[c] * bound, expected[c]);
            assert_true(v.error[c] < 0.01 * expected[c]);
            assert_true(fabs(off) < 4.0 * v.error[c] + 0.002 * expected[c]);
        }
        fixture_destroy(&f);
    }
}

/* The preview over its own sum of weights: light of albedo 1. */
static double preview_error(facet_energy energy)
{
    double square = 0.0;
    for (int i = 0; i < CASES; i++) {
        fixture f = floor_of(&cases[i], energy);
        f.desc.renderer = FACET_RENDERER_KIND_PREVIEW;
        f.desc.width = f.desc.height = 4;
        f.desc.samples = 1;
        film rendered = truth_render(&f, NULL);
        double expected[3], albedo;
        reference(&cases[i], expected, &albedo);
        for (int c = 0; c < 3; c++) {
            double found = (double)fixture_pixel(&rendered, "", 2, 2)[c];
            double off = found * albedo / expected[c] - 1.0;
            print_message("case %d, channel %d: preview %.4f, quadrature %.4f\n", i, c, found,
                          expected[c] / albedo);
            square += off * off / (3.0 * CASES);
        }
        film_destroy(&rendered);
        fixture_destroy(&f);
    }
    return sqrt(square);
}

/* The conserving mode, whose lookups follow the lobe, is to be several times as near as glTF's single lookup. */
static void the_preview_is_near_the_quadrature(void **state)
{
    (void)state;
    double one = preview_error(FACET_ENERGY_GLTF), many = preview_error(FACET_ENERGY_CONSERVING);
    print_message("RMS error: %.3f with one lookup, %.3f with several\n", one, many);
    assert_true(many < 0.15 && many < 0.35 * one);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(paths_equal_the_quadrature),
        cmocka_unit_test(the_preview_is_near_the_quadrature),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
