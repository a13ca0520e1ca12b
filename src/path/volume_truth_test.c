/* Truth tests of volumes that scatter: single scattering against quadrature, all orders against a random
 * walk in double that shares nothing with the path tracer, and media that absorb nothing in a furnace. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "path/path_fixture.h"

/* KHR_materials_volume_scatter: the single-scattering part of a deep layer's albedo. */
static double single_albedo(double multi)
{
    double s = 4.09712 + 4.20863 * multi - sqrt(9.59217 + 41.6808 * multi + 17.7126 * multi * multi);
    return 1.0 - s * s;
}

/* A medium of ior, optical depth tau over 1 m. */
static scene_material medium(float ior, double tau, float multi, float g)
{
    scene_material m = truth_glass(ior, 0.0f);
    m.extensions |= SCENE_VOLUME_SCATTER;
    m.attenuation_distance = 1.0f;
    for (int c = 0; c < 3; c++) {
        m.attenuation_color[c] = (float)exp(-tau);
        m.multiscatter_color[c] = multi;
    }
    m.scatter_anisotropy = g;
    return m;
}

/* A slab of 1 m, of half size s, under the sky of halves. */
static fixture slab(scene_material m, double polar, float s)
{
    fixture f = truth_create();
    truth_set_sky(&f, 256, truth_sky_halves);
    truth_add_box(&f, fixture_add_material(&f, m), 0.0f, s, 0.5f, s);
    truth_set_camera(&f, polar, 0.0f, 0.0f, 0.1f);
    f.desc.samples = 256;
    f.desc.path.max_depth = 1000;
    return f;
}

/* Henyey and Greenstein 1941; c: cosine between the directions before and after. */
static double phase(double c, double g)
{
    return (1.0 - g * g) / (4.0 * TRUTH_PI * pow(1.0 + g * g - 2.0 * g * c, 1.5));
}

/* ---- one event ---- */

/* Single scattering towards a camera at cosine mu above, of light 1 from above (R) or below (T): the
 * integral over depth and direction. */
static double scattered_once(double sigma, double albedo, double g, double mu, bool from_above)
{
    enum { DEPTHS = 100, COSINES = 200, TURNS = 32 };
    double sum = 0.0;
    double sine = sqrt(1.0 - mu * mu);
    for (int k = 0; k < COSINES; k++)
        for (int t = 0; t < TURNS; t++) {
            /* Squared: many small cosines, where exp(-sigma z / c) bends. */
            double q = (k + 0.5) / COSINES;
            double c = q * q;
            double weight = 2.0 * q / COSINES * 2.0 * TRUTH_PI / TURNS;
            double phi = 2.0 * TRUTH_PI * (t + 0.5) / TURNS;
            /* V goes up at mu; light comes from the direction L: it travels along -L and then along V. */
            double Ly = from_above ? c : -c;
            double VdotL = mu * Ly + sine * sqrt(1.0 - c * c) * cos(phi);
            double p = phase(-VdotL, g);
            for (int i = 0; i < DEPTHS; i++) {
                double z = (i + 0.5) / DEPTHS;
                double way = z / mu + (from_above ? z : 1.0 - z) / c;
                sum += weight * p * exp(-sigma * way) / (DEPTHS * mu);
            }
        }
    return sum * sigma * albedo;
}

static void single_scattering_is_that_of_quadrature(void **state)
{
    (void)state;
    static const float anisotropies[] = {0.0f, 0.6f, -0.5f};
    for (int i = 0; i < 3; i++)
        for (int polar = 0; polar <= 60; polar += 60) {
            double tau = 0.2;
            double g = (double)anisotropies[i];
            double albedo = single_albedo((double)0.7f);
            double mu = cos(truth_radians(polar));
            fixture f = slab(medium(1.0f, tau, 0.7f, anisotropies[i]), polar, 100.0f);
            f.desc.path.max_depth = 1; /* boundaries that do not refract are none */
            f.desc.samples = 1024;
            truth_value v = truth_measure(&f, 16);
            double R = scattered_once(tau, albedo, g, mu, true);
            double T = scattered_once(tau, albedo, g, mu, false);
            truth_assert_channel(&v, 0, R, "from above, g %g, %d degrees", g, polar);
            truth_assert_channel(&v, 1, T + exp(-tau / mu), "from below, g %g, %d degrees", g, polar);
            fixture_destroy(&f);
        }
}

/* A beam straight down with straight shadows, which a boundary without refraction makes exact: closed form
 *   L = E sigma_s p(Theta) (1 - exp(-sigma (1 + 1 / mu))) / (sigma (mu + 1)). */
static void single_scattering_of_a_beam(void **state)
{
    (void)state;
    for (int polar = 20; polar <= 70; polar += 25) {
        double tau = 0.8;
        double g = (double)0.5f;
        double mu = cos(truth_radians(polar));
        fixture f = slab(medium(1.0f, tau, 0.7f, 0.5f), polar, 5.0f);
        truth_set_constant_sky(&f, 0.0f, 0.0f, 0.0f);
        scene_light beam = {
            .name = "", .type = SCENE_LIGHT_DIRECTIONAL, .color = {1.0f, 1.0f, 1.0f}, .intensity = 10.0f};
        fixture_add_light(&f, beam, 0.0f, 5.0f, 0.0f);
        float *r = f.scene->nodes[f.scene->node_count - 1].rotation;
        r[0] = -0.70710678f;
        r[3] = 0.70710678f;
        f.desc.path.has_straight_shadows = true;
        f.desc.path.max_depth = 1;
        truth_value v = truth_measure(&f, 16);
        double L = 10.0 * single_albedo((double)0.7f) * phase(-mu, g) * (1.0 - exp(-tau * (1.0 + 1.0 / mu))) /
                   (mu + 1.0);
        truth_assert_grey(&v, L, "beam seen at %d degrees", polar);
        fixture_destroy(&f);
    }
}

/* ---- all events ---- */

/* xorshift64* (Vigna 2016): another generator than the renderer's. */
static double random_number(uint64_t *state)
{
    *state ^= *state >> 12;
    *state ^= *state << 25;
    *state ^= *state >> 27;
    return (double)((*state * 0x2545f4914f6cdd1dULL) >> 11) * 0x1p-53;
}

/* Where walks that enter from above at cosine mu end: above, below. Analog: a walk is absorbed, or it is
 * not; a boundary reflects it, or it does not. */
static void walk(double n, double sigma, double albedo, double g, double mu, uint32_t count, double share[2])
{
    uint64_t rng = 0x9e3779b97f4a7c15ULL;
    uint32_t ends[2] = {0};
    for (uint32_t i = 0; i < count; i++) {
        if (random_number(&rng) < truth_fresnel(mu, n)) {
            ends[0]++;
            continue;
        }
        double y = 0.0;                    /* depth */
        double c = truth_refracted(mu, n); /* cosine to down; the azimuth does not matter */
        for (;;) {
            double s = -log(1.0 - random_number(&rng)) / sigma;
            double edge = c > 0.0 ? (1.0 - y) / c : y / -c;
            if (s >= edge) {
                y = c > 0.0 ? 1.0 : 0.0;
                if (random_number(&rng) >= truth_fresnel(fabs(c), 1.0 / n)) {
                    ends[c > 0.0]++;
                    break;
                }
                c = -c;
                continue;
            }
            y += s * c;
            if (random_number(&rng) >= albedo)
                break;
            double u = random_number(&rng);
            double k = (1.0 - g * g) / (1.0 - g + 2.0 * g * u);
            double turn = fabs(g) < 1e-3 ? 2.0 * u - 1.0 : (1.0 + g * g - k * k) / (2.0 * g);
            double phi = 2.0 * TRUTH_PI * random_number(&rng);
            c = c * turn + sqrt(fmax((1.0 - c * c) * (1.0 - turn * turn), 0.0)) * cos(phi);
        }
    }
    share[0] = (double)ends[0] / count;
    share[1] = (double)ends[1] / count;
}

/* Radiance under a sky of 1, by a random walk from the camera (reciprocity). */
static void multiple_scattering_is_that_of_random_walks(void **state)
{
    (void)state;
    static const struct {
        float ior;
        double tau;
        float multi, g;
        int polar;
    } cases[] = {{1.0f, 2.0, 0.9f, 0.0f, 30},
                 {1.0f, 4.0, 0.8f, 0.7f, 60},
                 {1.4f, 1.5, 0.9f, -0.3f, 45},
                 {1.5f, 3.0, 1.0f, 0.5f, 0}};
    enum { WALKS = 1000000 };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        double share[2];
        walk((double)cases[i].ior, cases[i].tau, single_albedo((double)cases[i].multi), (double)cases[i].g,
             cos(truth_radians(cases[i].polar)), WALKS, share);
        fixture f =
            slab(medium(cases[i].ior, cases[i].tau, cases[i].multi, cases[i].g), cases[i].polar, 100.0f);
        truth_value v = truth_measure(&f, 16);
        for (int c = 0; c < 2; c++) { /* the walks have an error of their own */
            v.error[c] = hypot(v.error[c], sqrt(share[c] * (1.0 - share[c]) / WALKS));
            truth_assert_channel(&v, c, share[c], "ior %g, tau %g, g %g, %s", (double)cases[i].ior,
                                 cases[i].tau, (double)cases[i].g, c ? "through" : "back");
        }
        fixture_destroy(&f);
    }
}

/* A medium that scatters without absorption conserves energy, with a different coefficient per channel. */
static void a_white_medium_in_a_furnace(void **state)
{
    (void)state;
    static const float anisotropies[] = {0.0f, 0.8f, -0.8f};
    for (int i = 0; i < 6; i++) {
        scene_material m = medium(i < 3 ? 1.0f : 1.5f, 1.0, 1.0f, anisotropies[i % 3]);
        m.attenuation_color[0] = 0.7f;
        m.attenuation_color[1] = 0.2f;
        m.attenuation_color[2] = 0.05f;
        fixture f = truth_create();
        truth_set_constant_sky(&f, 1.0f, 1.0f, 1.0f);
        truth_add_flat_sphere(&f, fixture_add_material(&f, m), 32, 0.0f, 1.0f);
        truth_set_camera(&f, 60.0, 0.0f, 0.0f, 1.9f);
        f.desc.path.max_depth = 3000;
        f.desc.samples = 128;
        truth_value v = truth_measure(&f, 16);
        truth_assert_grey(&v, 1.0, "ior %g, g %g", (double)m.ior, (double)m.scatter_anisotropy);
        fixture_destroy(&f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(single_scattering_is_that_of_quadrature),
        cmocka_unit_test(single_scattering_of_a_beam),
        cmocka_unit_test(multiple_scattering_is_that_of_random_walks),
        cmocka_unit_test(a_white_medium_in_a_furnace),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
