/* sh_test.c - irradiance as nine spherical harmonics. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "tests/support/support.h"

#include "base/memory.h"
#include "ibl/equirect.h"
#include "ibl/sh.h"

static const double pi = 3.14159265358979323846;

static image make_image(uint32_t width, uint32_t height)
{
    image i;
    assert_int_equal(image_create(NULL, width, height, 3, IMAGE_F32, &i, NULL), FACET_OK);
    memset(i.pixels, 0, image_row_size(&i) * height);
    return i;
}

static void project(const image *i, double radiance[SH_COUNT][3])
{
    assert_int_equal(sh_project(i, NULL, 2, radiance, NULL), FACET_OK);
}

static void fold(double radiance[SH_COUNT][3], float c[SH_COUNT][3])
{
    double irradiance[SH_COUNT][3];
    sh_irradiance((const double(*)[3])radiance, irradiance);
    sh_fold_over_pi((const double(*)[3])irradiance, c);
}

static void uniform_radiance_gives_irradiance_pi(void **state)
{
    (void)state;
    image i = make_image(173, 91);
    for (size_t k = 0; k < 173 * 91 * 3; k++)
        ((float *)i.pixels)[k] = 1.0f;
    double radiance[SH_COUNT][3];
    float c[SH_COUNT][3];
    project(&i, radiance);
    fold(radiance, c);
    for (int k = 0; k < 50; k++) {
        float N[3], e[3];
        equirect_direction(10, 5, k % 10, k / 10, N);
        sh_evaluate((const float(*)[3])c, N, e);
        for (int j = 0; j < 3; j++)
            assert_near(e[j], 1.0f, 1e-6f);
    }
    image_destroy(&i);
}

/* Clamped cosine around z, by independent quadrature. */
static void a_clamped_cosine_gives_golden_values(void **state)
{
    (void)state;
    const uint32_t width = 1024;
    const uint32_t height = 512;
    image i = make_image(width, height);
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++) {
            float d[3];
            equirect_direction(width, height, x, y, d);
            for (int k = 0; k < 3; k++)
                ((float *)i.pixels)[3 * (y * width + x) + (uint32_t)k] = d[2] > 0.0f ? d[2] : 0.0f;
        }
    double radiance[SH_COUNT][3];
    float c[SH_COUNT][3];
    project(&i, radiance);
    fold(radiance, c);
    static const double golden[5][2] = {{1.0, 2.0780326407},
                                        {0.5, 1.2783173232},
                                        {0.0, 0.6626797004},
                                        {-0.5, 0.2311197720},
                                        {-1.0, 0.0}}; /* -0.0163624617, clamped */
    for (int k = 0; k < 5; k++) {
        float z = (float)golden[k][0];
        float N[3] = {sqrtf(1.0f - z * z) * 0.6f, sqrtf(1.0f - z * z) * 0.8f, z};
        float e[3];
        sh_evaluate((const float(*)[3])c, N, e);
        assert_near((double)e[1] * pi, golden[k][1], 2e-5);
    }
    image_destroy(&i);
}

/* One texel of radiance 1: coefficients are the basis there times its solid angle. */
static void a_single_texel_gives_the_basis(void **state)
{
    (void)state;
    const uint32_t width = 2048;
    const uint32_t height = 1024;
    static const uint32_t places[4][2] = {{0, 40}, {1999, 300}, {512, 512}, {77, 980}};
    image i = make_image(width, height);
    for (int k = 0; k < 4; k++) {
        float *p = (float *)i.pixels + 3 * (places[k][1] * width + places[k][0]);
        p[0] = p[1] = p[2] = 1e5f;
        double radiance[SH_COUNT][3], basis[SH_COUNT], d[3];
        float f[3];
        project(&i, radiance);
        equirect_direction(width, height, places[k][0], places[k][1], f);
        for (int j = 0; j < 3; j++)
            d[j] = (double)f[j];
        sh_basis(d, basis);
        double energy = 1e5 * equirect_texel_solid_angle(width, height, places[k][1]);
        for (int j = 0; j < SH_COUNT; j++)
            assert_near(radiance[j][2] / energy, basis[j], 1e-5);
        p[0] = p[1] = p[2] = 0.0f;
    }
    image_destroy(&i);
}

static void coefficients_do_not_depend_on_threads(void **state)
{
    (void)state;
    image i = make_image(331, 120);
    for (uint32_t k = 0; k < 331 * 120 * 3; k++)
        ((float *)i.pixels)[k] = (float)(k * 2654435761u >> 8) * 1e-6f;
    double a[SH_COUNT][3], b[SH_COUNT][3];
    assert_int_equal(sh_project(&i, NULL, 1, a, NULL), FACET_OK);
    assert_int_equal(sh_project(&i, NULL, 7, b, NULL), FACET_OK);
    assert_memory_equal(a, b, sizeof a);
    image_destroy(&i);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(uniform_radiance_gives_irradiance_pi),
        cmocka_unit_test(a_clamped_cosine_gives_golden_values),
        cmocka_unit_test(a_single_texel_gives_the_basis),
        cmocka_unit_test(coefficients_do_not_depend_on_threads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
