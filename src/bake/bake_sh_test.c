/* bake_sh_test.c - environments as nine harmonics: the sum of each form, rotation, exposure, clamp,
 * window. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "tests/support/support.h"
#include "facet/facet.h"
#include "ibl/light_fixture.h"
#include "ibl/sh.h"

static const double pi = 3.14159265358979323846;

enum { WIDTH = 512, HEIGHT = 256 };

static void project(const facet_environment *e, facet_sh_desc desc, float c[9][3])
{
    facet_error error = {0};
    if (facet_environment_project_sh(e, &desc, c, &error) != FACET_OK)
        fail_msg("%s", error.message);
}

static void constant(const float d[3], float out[3])
{
    (void)d;
    out[0] = 1.0f;
    out[1] = 2.0f;
    out[2] = 0.5f;
}

static void cosine_lobe(const float d[3], float out[3]) /* around +Z */
{
    out[0] = out[1] = out[2] = d[2] > 0.0f ? d[2] : 0.0f;
}

/* Bands 0 to 2, whole: L = 2 + x - y/2 + z/4 + xy - yz. */
static void polynomial(const float d[3], float out[3])
{
    out[0] = 2.0f + d[0] - 0.5f * d[1] + 0.25f * d[2] + d[0] * d[1] - d[1] * d[2];
    out[1] = out[2] = out[0];
}

static void room(const float d[3], float out[3])
{
    out[0] = 1.0f + d[0] * d[2] + (d[1] > 0.8f ? 20.0f : 0.0f);
    out[1] = 1.0f + 0.5f * d[0];
    out[2] = d[2] > 0.6f && d[0] > 0.0f ? 50.0f : 0.1f;
}

static void sun(const float d[3], float out[3])
{
    out[0] = out[1] = out[2] = d[0] * 0.6f + d[1] * 0.64f + d[2] * 0.48f > 0.9998f ? 1e5f : 0.3f;
}

static void uniform_light_has_one_coefficient(void **state)
{
    (void)state;
    static const float L[3] = {1.0f, 2.0f, 0.5f};
    static const double whole[3] = {3.5449077018, 11.1366559937, 1.0}; /* sqrt(4 pi), times pi, 1 */
    facet_environment *e = make_environment(WIDTH, HEIGHT, constant);
    for (int form = 0; form < 3; form++) {
        float c[9][3];
        project(e, (facet_sh_desc){.form = (facet_sh_form)form}, c);
        for (int i = 0; i < 3; i++) {
            assert_near(c[0][i], whole[form] * (double)L[i], 2e-6);
            for (int k = 1; k < 9; k++)
                assert_near(c[k][i], 0.0, 2e-6);
        }
    }
    facet_environment_destroy(e);
}

/* Golden numbers by independent quadrature. */
static void a_cosine_lobe_gives_golden_values(void **state)
{
    (void)state;
    facet_environment *e = make_environment(WIDTH, HEIGHT, cosine_lobe);
    float c[9][3], E[9][3];
    project(e, (facet_sh_desc){.form = FACET_SH_FORM_FOLDED}, c);
    project(e, (facet_sh_desc){.form = FACET_SH_FORM_IRRADIANCE}, E);
    static const double golden[5][2] = {{1.0, 2.0780326407},
                                        {0.5, 1.2783173232},
                                        {0.0, 0.6626797004},
                                        {-0.5, 0.2311197720},
                                        {-1.0, -0.0163624617}};
    for (int n = 0; n < 5; n++) {
        double z = golden[n][0];
        double folded = (double)c[0][1] + (double)c[2][1] * z + (double)c[6][1] * (3.0 * z * z - 1.0);
        double r = sqrt(1.0 - z * z); /* x^2 - y^2 and the like are not in it */
        double basis[9];
        sh_basis((double[3]){r, 0.0, z}, basis);
        double irradiance = 0.0;
        for (int k = 0; k < 9; k++)
            irradiance += (double)E[k][1] * basis[k];
        assert_near(folded * pi, golden[n][1], 1e-4);
        assert_near(irradiance, golden[n][1], 1e-4);
    }
    /* the window lifts the last one and changes nothing else than bands */
    float windowed[9][3];
    project(e, (facet_sh_desc){.form = FACET_SH_FORM_FOLDED, .is_windowed = true}, windowed);
    assert_true(windowed[0][0] == c[0][0]);
    double band = (double)windowed[2][0] / (double)c[2][0];
    assert_true(band < 1.0 && band > 0.9);
    assert_true(windowed[0][0] - windowed[2][0] + 2.0f * windowed[6][0] >= 0.0f);
    facet_environment_destroy(e);
}

/* The coefficients of a polynomial of bands 0 to 2 are the ones it was made of: +Y up, signs and order. */
static void coefficients_are_those_of_the_basis(void **state)
{
    (void)state;
    facet_environment *e = make_environment(WIDTH, HEIGHT, polynomial);
    float c[9][3];
    project(e, (facet_sh_desc){.form = FACET_SH_FORM_RADIANCE}, c);
    const double want[9] = {2.0 / 0.2820947918,
                            -0.5 / 0.4886025119,
                            0.25 / 0.4886025119,
                            1.0 / 0.4886025119,
                            1.0 / 1.0925484306,
                            -1.0 / 1.0925484306,
                            0.0,
                            0.0,
                            0.0};
    for (int k = 0; k < 9; k++)
        assert_near(c[k][0], want[k], 2e-4);
    /* folded: a band over its share of the cosine, 1, 2/3, 1/4 */
    project(e, (facet_sh_desc){.form = FACET_SH_FORM_FOLDED}, c);
    static const double folded[9] = {2.0, -0.5 * 2 / 3, 0.25 * 2 / 3, 2.0 / 3, 0.25, -0.25, 0, 0, 0};
    for (int k = 0; k < 9; k++)
        assert_near(c[k][0], folded[k], 2e-4);
    facet_environment_destroy(e);
}

/* By whole texels, rotating the image is moving its columns: positive turns from +Z towards +X. */
static void rotation_moves_columns(void **state)
{
    (void)state;
    facet_environment *e = make_environment(WIDTH, HEIGHT, room);
    facet_environment *moved = make_environment(WIDTH, HEIGHT, room);
    static const uint32_t steps[4] = {1, 100, 256, 511};
    for (int n = 0; n < 4; n++) {
        for (uint32_t y = 0; y < HEIGHT; y++)
            for (uint32_t x = 0; x < WIDTH; x++) /* +Z is right of +X, so columns go to the left */
                memcpy((float *)moved->panorama.pixels + 3 * (y * WIDTH + x),
                       (float *)e->panorama.pixels + 3 * (y * WIDTH + (x + steps[n]) % WIDTH),
                       3 * sizeof(float));
        float a[9][3], b[9][3];
        project(moved, (facet_sh_desc){0}, a);
        project(e, (facet_sh_desc){.rotation_rad = (float)(2.0 * pi * steps[n] / WIDTH)}, b);
        for (int k = 0; k < 9; k++)
            for (int i = 0; i < 3; i++)
                assert_near(a[k][i], b[k][i], 2e-5 * (double)a[0][i]);
    }
    facet_environment_destroy(e);
    facet_environment_destroy(moved);
}

static void exposure_and_clamp_are_applied(void **state)
{
    (void)state;
    facet_environment *e = make_environment(WIDTH, HEIGHT, room);
    facet_environment *cut = make_environment(WIDTH, HEIGHT, room);
    float *p = cut->panorama.pixels;
    for (size_t k = 0; k < (size_t)WIDTH * HEIGHT * 3; k++)
        p[k] = fminf(p[k], 3.0f);
    float a[9][3], b[9][3];
    project(cut, (facet_sh_desc){0}, a);
    project(e, (facet_sh_desc){.clamp = 3.0f, .ev = -2.0f}, b);
    for (int k = 0; k < 9; k++)
        for (int i = 0; i < 3; i++)
            assert_true(b[k][i] == 0.25f * a[k][i]);
    facet_environment_destroy(e);
    facet_environment_destroy(cut);
}

/* Nine bands of a sun go below 0 on its far side; windowed nowhere, and its mean stays. */
static void windows_remove_negative_irradiance_and_keep_the_mean(void **state)
{
    (void)state;
    facet_environment *e = make_environment(WIDTH, HEIGHT, sun);
    float plain[9][3], c[9][3];
    project(e, (facet_sh_desc){.form = FACET_SH_FORM_FOLDED}, plain);
    project(e, (facet_sh_desc){.form = FACET_SH_FORM_FOLDED, .is_windowed = true}, c);
    float least = INFINITY;
    float least_plain = INFINITY;
    for (uint32_t y = 0; y < HEIGHT; y++)
        for (uint32_t x = 0; x < WIDTH; x++) {
            float d[3];
            equirect_direction(WIDTH, HEIGHT, x, y, d);
            const float p[9] = {1.0f,
                                d[1],
                                d[2],
                                d[0],
                                d[0] * d[1],
                                d[1] * d[2],
                                3.0f * d[2] * d[2] - 1.0f,
                                d[0] * d[2],
                                d[0] * d[0] - d[1] * d[1]};
            float value = 0.0f;
            float value_plain = 0.0f;
            for (int k = 0; k < 9; k++) {
                value += c[k][0] * p[k];
                value_plain += plain[k][0] * p[k];
            }
            least = fminf(least, value);
            least_plain = fminf(least_plain, value_plain);
        }
    print_message("least irradiance / pi: %g, windowed %g, mean %g\n", (double)least_plain, (double)least,
                  (double)c[0][0]);
    assert_true(least_plain < -0.05f * c[0][0]);
    assert_true(least >= 0.0f && least < 1e-2f * c[0][0]);
    assert_true(c[0][0] == plain[0][0]);
    facet_environment_destroy(e);
}

static void invalid_arguments_are_refused(void **state)
{
    (void)state;
    facet_environment *e = make_environment(WIDTH, HEIGHT, constant);
    float c[9][3];
    facet_error error = {0};
    assert_int_equal(facet_environment_project_sh(e, NULL, c, NULL), FACET_OK);
    assert_int_equal(facet_environment_project_sh(e, &(facet_sh_desc){.ev = NAN}, c, &error),
                     FACET_ERROR_ARGUMENT);
    assert_int_equal(facet_environment_project_sh(e, &(facet_sh_desc){.clamp = -1.0f}, c, &error),
                     FACET_ERROR_ARGUMENT);
    assert_int_equal(facet_environment_project_sh(e, &(facet_sh_desc){.form = (facet_sh_form)3}, c, &error),
                     FACET_ERROR_ARGUMENT);
    assert_string_equal(error.message, "harmonics: form 3: 0 to 2 were expected");
    facet_environment_destroy(e);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(uniform_light_has_one_coefficient),
        cmocka_unit_test(a_cosine_lobe_gives_golden_values),
        cmocka_unit_test(coefficients_are_those_of_the_basis),
        cmocka_unit_test(rotation_moves_columns),
        cmocka_unit_test(exposure_and_clamp_are_applied),
        cmocka_unit_test(windows_remove_negative_irradiance_and_keep_the_mean),
        cmocka_unit_test(invalid_arguments_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
