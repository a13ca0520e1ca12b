/* water_table_test.c - the table against the integrals that it is made of, between its places; and what a
 * sea reflects of all of the sky. */
#include "shade/testing/test_support.h"

#include "ocean/water_table.h"

static water_table table; /* of a sea, ior 1.34 */

static int create(void **state)
{
    (void)state;
    water_table_create(WATER_BECKMANN, WATER_SCALES, 1.34f, 1, &table);
    return 0;
}

/* Reflectance within 1 % (and 0.001) of a finer integral, for all eyes and winds of 1 to 40 m/s. */
static void interpolated_reflectance_is_within_a_percent(void **state)
{
    (void)state;
    for (float wind = 0.7f; wind < 40.0f; wind *= 1.9f)
        for (float mu = 0.004f; mu < 1.0f; mu = mu * 1.3f + 0.01f) {
            float sigma = sqrt(0.5f * (0.003f + 0.00512f * wind)), texel[4];
            WaterMeans m = integrate_water_means(WATER_BECKMANN, WATER_SCALES, mu, sigma, 1.34f, 96);
            water_table_at(&table, mu, sigma, texel);
            double F = (double)F_dielectric(mu, 1.34f);
            expect_near((double)texel[0] * F, (double)m.fresnel * F, 0.01 * (double)m.fresnel * F + 0.001,
                        "reflectance at %g, %g m/s", (double)mu, (double)wind);
            assert_true(water_table_fresnel(&table, mu, sigma) == texel[0] * F_dielectric(mu, 1.34f));
            expect_near((double)texel[1], (double)m.escape, 0.012, "escape at %g, %g m/s", (double)mu,
                        (double)wind);
            expect_near((double)texel[2], (double)m.lift, 0.012, "lift at %g, %g m/s", (double)mu,
                        (double)wind);
            expect_near((double)texel[3], (double)m.spread, 0.006, "spread at %g, %g m/s", (double)mu,
                        (double)wind);
        }
}

/* Flat water is flat between the places, too: the mirror itself. */
static void flat_water_is_exact_between_nodes(void **state)
{
    (void)state;
    for (float mu = 0.03f; mu <= 1.0f; mu += 0.0211f) {
        float texel[4];
        water_table_at(&table, mu, 1e-4f, texel);
        expect_near((double)texel[0], 1.0, 2e-3, "reflectance at %g", (double)mu);
        expect_near((double)texel[1], 1.0, 1e-3, "escape at %g", (double)mu);
        expect_near((double)texel[2], 0.0, 1e-3, "lift at %g", (double)mu);
    }
    float corner[4], outside[4];
    water_table_at(&table, 1.0f, WATER_TABLE_SIGMA, corner);
    water_table_at(&table, 2.0f, 10.0f, outside);
    for (int c = 0; c < 4; c++) {
        assert_true(corner[c] == outside[c]);
        expect_near((double)corner[c], (double)table.texels[WATER_TABLE_HEIGHT - 1][WATER_TABLE_WIDTH - 1][c],
                    1e-6, "corner");
    }
}

/* Reflectance for light from all of the sky: golden numbers of Smith's masking, as oceanography's 0.06.
 * Waves of all lengths reflect a little less at grazing angles. */
static void sky_reflectance_is_that_of_the_literature(void **state)
{
    (void)state;
    const double mss[4] = {0.0, 0.0286, 0.0542, 0.0798}, expected[4] = {0.0675, 0.0620, 0.0598, 0.0582};
    static water_table smith;
    water_table_create(WATER_BECKMANN, WATER_SMITH, 1.34f, 2, &smith);
    for (int i = 0; i < 4; i++) {
        float sigma = sqrt((float)(0.5 * mss[i]));
        double scales = (double)water_table_sky_reflectance(&table, sigma);
        expect_relative(water_table_sky_reflectance(&smith, sigma), expected[i], 0.005, "mss %g", mss[i]);
        assert_true(scales <= expected[i] * 1.005 && scales > expected[i] * 0.94);
    }
}

/* The same bytes with more threads; GGX has longer tails, which reflect more of what stands high. */
static void threads_change_no_byte(void **state)
{
    (void)state;
    static water_table again, tails;
    water_table_create(WATER_BECKMANN, WATER_SCALES, 1.34f, 3, &again);
    assert_memory_equal(&again, &table, sizeof table);
    water_table_create(WATER_GGX, WATER_SCALES, 1.34f, 0, &tails);
    for (int y = 0; y < WATER_TABLE_HEIGHT; y++)
        for (int x = 0; x < WATER_TABLE_WIDTH; x++)
            for (int c = 0; c < 4; c++)
                assert_true(isfinite(tails.texels[y][x][c]) && isfinite(table.texels[y][x][c]));
    assert_true(water_table_fresnel(&tails, 0.02f, 0.1f) < water_table_fresnel(&table, 0.02f, 0.1f));
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(interpolated_reflectance_is_within_a_percent),
                                       cmocka_unit_test(flat_water_is_exact_between_nodes),
                                       cmocka_unit_test(sky_reflectance_is_that_of_the_literature),
                                       cmocka_unit_test(threads_change_no_byte)};
    return cmocka_run_group_tests(tests, create, NULL);
}
