/* Tests of slope_filter.c and foam_rule_create(): what is read of waves and what is said to be hidden is
 * all there is; foam covers what it should at every footprint. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "tests/support/support.h"
#include "ocean/waves_fixture.h"

static facet_sea_desc windy(float wind_mps, uint32_t resolution, uint32_t cascade_count, uint64_t seed)
{
    facet_sea_desc d = desc_of(resolution, cascade_count, seed);
    d.wind_mps = wind_mps;
    return d;
}

static uint32_t nearest_entry(float footprint_m)
{
    return (uint32_t)lroundf(slope_filter_place(footprint_m));
}

static void footprints_are_geometric(void **state)
{
    (void)state;
    assert_near(slope_filter_footprint(0), 1e-3, 1e-9);
    assert_near(slope_filter_footprint(63), 1e5, 0.1);
    for (uint32_t i = 0; i < 64; i++)
        assert_near(slope_filter_place(slope_filter_footprint(i)), i, 2e-3);
    assert_true(slope_filter_place(0.0f) == 0.0f && slope_filter_place(1e9f) == 63.0f);
}

/* Total less residual is what waves_at() reads, mean over seeds and places, for footprints from a fraction
 * of a sample to more than the longest waves. Directions of tiles and wind are all different. */
static void hidden_and_read_slopes_are_all_there_are(void **state)
{
    (void)state;
    static const float wanted[6] = {0.02f, 0.5f, 1.1f, 5.5f, 13.0f, 40.0f};
    enum { SEEDS = 8, PLACES = IS_SLOW ? 4000 : 30000 };
    double sums[6][4] = {{0.0}};
    slope_filter f;
    double choppiness = 0.0;
    float footprints[6];
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        facet_sea_desc d = windy(10.0f, 64, 2, seed);
        d.wind_direction_rad = 0.5f;
        d.swell =
            (facet_swell){.height_m = 1.0f, .period_s = 5.0f, .direction_rad = 2.0f, .elongation = 0.5f};
        waves w = waves_of(d);
        slope_filter_create(&w, &f);
        choppiness = w.choppiness;
        for (int k = 0; k < 6; k++) {
            uint64_t random = 77 + seed;
            footprints[k] = slope_filter_footprint(nearest_entry(wanted[k]));
            for (int i = 0; i < PLACES; i++) {
                wave_point p =
                    waves_at(&w, 1e4 * lcg64_double(&random), 1e4 * lcg64_double(&random), footprints[k]);
                double x = (double)p.slope[0], z = (double)p.slope[1], q = (double)(p.Dxx + p.Dzz);
                const double all[4] = {x * x, z * z, x * z, q * q};
                for (int j = 0; j < 4; j++)
                    sums[k][j] += all[j] / (PLACES * (double)SEEDS);
            }
        }
        waves_destroy(&w);
    }
    double scale = (double)(f.total.xx + f.total.zz);
    double tolerance = (IS_SLOW ? 0.01 : 0.006) * scale;
    for (int k = 0; k < 6; k++) {
        uint32_t i = nearest_entry(footprints[k]);
        assert_near(sums[k][0], f.total.xx - f.residual[i].xx, tolerance);
        assert_near(sums[k][1], f.total.zz - f.residual[i].zz, tolerance);
        assert_near(sums[k][2], f.total.xz - f.residual[i].xz, tolerance);
        double all = (double)f.convergence_variance[63]; /* that hides everything */
        assert_near(sums[k][3], all - (double)f.convergence_variance[i], tolerance * choppiness);
    }
}

static void totals_are_those_that_were_seen(void **state)
{
    (void)state;
    static const float winds[5] = {3.0f, 5.0f, 10.0f, 15.0f, 30.0f};
    for (int i = 0; i < 5; i++) {
        facet_sea_desc d = windy(winds[i], 32, 3, 1);
        d.wind_direction_rad = 2.0f;
        waves w = waves_of(d);
        slope_filter f;
        slope_filter_create(&w, &f);
        assert_near(f.total.xx + f.total.zz, 0.003 + 0.00512 * (double)winds[i], 1e-6);
        double c = cos(2.0), s = sin(2.0), seen[2];
        cox_munk_slopes((double)winds[i], seen);
        assert_near(c * c * (double)f.total.xx + s * s * (double)f.total.zz +
                        2.0 * c * s * (double)f.total.xz,
                    seen[0], 1e-6);
        for (uint32_t j = 0; j < 64;
             j++) { /* grows with the footprint, and never has a direction without variance */
            const slope_covariance *r = &f.residual[j];
            assert_true(r->xx >= 0.0f && r->zz >= 0.0f && r->xx * r->zz >= r->xz * r->xz - 1e-9f);
            if (j) {
                assert_true(r->xx + r->zz >= f.residual[j - 1].xx + f.residual[j - 1].zz - 1e-7f);
                assert_true(f.curvature[j] >= f.curvature[j - 1] * 0.999f);
                assert_true(f.rate[j] <= f.rate[j - 1] * 1.001f);
            }
        }
        assert_near(f.residual[63].xx, f.total.xx, 1e-6);
        assert_true(f.residual[0].xx + f.residual[0].zz > 0.05f * (f.total.xx + f.total.zz));
        waves_destroy(&w);
    }
}

/* 15 to 30 ms, 6540 per m^2. */
static void glints_have_curvature(void **state)
{
    (void)state;
    waves w = waves_of(windy(10.0f, 64, 3, 1));
    slope_filter f;
    slope_filter_create(&w, &f);
    assert_near(f.curvature[63], 6540.0, 100.0);
    waves_destroy(&w);
}

static void calm_is_a_mirror(void **state)
{
    (void)state;
    waves w = waves_of(windy(0.0f, 64, 3, 1));
    slope_filter f;
    slope_filter_create(&w, &f);
    for (uint32_t i = 0; i < 64; i += 7) {
        assert_true(f.residual[i].xx == 0.0f && f.residual[i].zz == 0.0f && f.residual[i].xz == 0.0f);
        assert_true(f.curvature[i] == 0.0f && f.rate[i] == 0.0f && f.convergence_variance[i] == 0.0f);
    }
    foam_rule r = foam_rule_create(&w);
    assert_true(isinf(r.threshold) && r.coverage == 0.0f);
    assert_true(foam_coverage(&r, 0.0f, 0.0f, r.threshold) == 0.0f);
    waves_destroy(&w);
}

/* ---- foam ---- */

static void thresholds_are_those_of_the_table(void **state)
{
    (void)state;
    static const double expected[6][6] = {
        {5.0, 0.1590, 2.930, 0.466, 3.550, 0.564},  {7.5, 0.1711, 2.484, 0.425, 3.173, 0.543},
        {10.0, 0.1801, 2.130, 0.384, 2.884, 0.519}, {12.5, 0.1914, 1.819, 0.348, 2.638, 0.505},
        {15.0, 0.2010, 1.538, 0.309, 2.425, 0.487}, {20.0, 0.2172, 1.022, 0.222, 2.060, 0.447}};
    for (int i = 0; i < 6; i++) {
        facet_sea_desc d = windy((float)expected[i][0], 256, 3, 1);
        waves w = {.choppiness = 1.0, .tile_count = 1};
        assert_int_equal(sea_state_create(&d, &w.state, NULL), FACET_OK);
        w.state.taper_k = ENDLESS; /* as the table has it: all waves up to 78 rad/m */
        w.state.bands = (sea_bands){.count = 1, .k_to = {78.0}};
        foam_rule r = foam_rule_create(&w);
        assert_near(r.sigma, expected[i][1], 0.005 * expected[i][1]);
        assert_near(r.threshold, expected[i][3], 0.004);
        assert_near(r.active_threshold, expected[i][5], 0.004);
        assert_near(r.threshold / r.sigma, expected[i][2], 0.01);
        assert_near(r.active_threshold / r.sigma, expected[i][4], 0.01);
    }
}

/* Share of the area, seen from above, of texels of all tiles that lie one above the other by chance. */
static double covered(const waves *w, float threshold, uint64_t *random, int count)
{
    double area = 0.0, sum = 0.0;
    for (int i = 0; i < count; i++) {
        wave_point p = {.height_m = 0.0f};
        for (uint32_t t = 0; t < w->tile_count; t++) { /* turned: all derivatives, not their sum alone */
            const wave_tile *tile = &w->tiles[t];
            size_t texel = (size_t)(lcg64_double(random) * tile->size * tile->size) * WAVE_FIELDS;
            float c = tile->cos_turn, s = tile->sin_turn;
            const float *f = tile->levels[0] + texel;
            p.Dxx += c * c * f[WAVE_DXX] - 2.0f * c * s * f[WAVE_DXZ] + s * s * f[WAVE_DZZ];
            p.Dzz += s * s * f[WAVE_DXX] + 2.0f * c * s * f[WAVE_DXZ] + c * c * f[WAVE_DZZ];
            p.Dxz += c * s * (f[WAVE_DXX] - f[WAVE_DZZ]) + (c * c - s * s) * f[WAVE_DXZ];
        }
        wave_shape shape = wave_shape_of(&p);
        area += (double)shape.jacobian;
        sum += shape.convergence > threshold ? (double)shape.jacobian : 0.0;
    }
    return sum / area;
}

static void foam_covers_what_was_seen(void **state)
{
    (void)state;
    static const float winds[3] = {7.5f, 10.0f, 15.0f};
    enum { SEEDS = 8, PLACES = IS_SLOW ? 20000 : 60000 };
    for (uint32_t size = 64; size <= 128; size *= 2)
        for (int u = 0; u < 3; u++) {
            double sum = 0.0;
            for (uint64_t seed = 0; seed < SEEDS; seed++) {
                waves w = waves_of(windy(winds[u], size, 3, seed));
                foam_rule r = foam_rule_create(&w);
                uint64_t random = seed;
                sum += covered(&w, r.threshold, &random, PLACES) / SEEDS;
                waves_destroy(&w);
            }
            double wanted = whitecap_coverage((double)winds[u]);
            assert_near(sum, wanted, 0.10 * wanted);
        }
}

static void foam_is_the_same_from_afar(void **state)
{
    (void)state;
    enum { SEEDS = 8, PLACES = IS_SLOW ? 3000 : 10000 };
    static const float footprints[4] = {0.1f, 1.0f, 8.0f, 5000.0f};
    double wanted = whitecap_coverage(12.0), sums[4] = {0.0};
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        waves w = waves_of(windy(12.0f, 64, 3, seed));
        foam_rule r = foam_rule_create(&w);
        slope_filter f;
        slope_filter_create(&w, &f);
        for (int k = 0; k < 4; k++) {
            uint64_t random = seed;
            uint32_t entry = nearest_entry(footprints[k]);
            double area = 0.0, sum = 0.0;
            for (int i = 0; i < PLACES; i++) {
                wave_point p = waves_at(&w, 1e5 * lcg64_double(&random), 1e5 * lcg64_double(&random),
                                        slope_filter_footprint(entry));
                wave_shape s = wave_shape_of(&p);
                area += (double)s.jacobian;
                sum += (double)s.jacobian *
                       (double)foam_coverage(&r, s.convergence, f.convergence_variance[entry], r.threshold);
            }
            sums[k] += sum / area / SEEDS;
        }
        waves_destroy(&w);
    }
    for (int k = 0; k < 4; k++)
        assert_near(sums[k], wanted, 0.15 * wanted);
}

static void foam_is_found_by_any_sea(void **state)
{
    (void)state;
    static const float winds[4] = {1.0f, 3.0f, 30.0f, 40.0f};
    for (int i = 0; i < 4; i++)
        for (float choppiness = 0.0f; choppiness <= 2.0f; choppiness += 1.0f) {
            facet_sea_desc d = windy(winds[i], 32, 2, 1);
            d.choppiness = choppiness;
            waves w = waves_of(d);
            foam_rule r = foam_rule_create(&w);
            assert_false(isnan(r.threshold) || isnan(r.active_threshold));
            assert_true(r.active_threshold >= r.threshold);
            assert_true(isinf(r.threshold) == (choppiness == 0.0f || winds[i] < 3.3f));
            assert_true((r.coverage == 0.0f) == (winds[i] < 3.3f));
            for (float mean = -3.0f; mean <= 3.0f; mean += 0.37f) {
                float few = foam_coverage(&r, mean, 0.01f, r.active_threshold);
                float all = foam_coverage(&r, mean, 0.01f, r.threshold);
                assert_true(few >= 0.0f && all <= 1.0f && few <= all + 1e-6f);
            }
            waves_destroy(&w);
        }
    foam_rule r = {.threshold = 0.4f};
    assert_true(foam_coverage(&r, 0.41f, 0.0f, 0.4f) == 1.0f && foam_coverage(&r, 0.39f, 0.0f, 0.4f) == 0.0f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(footprints_are_geometric),
                                       cmocka_unit_test(hidden_and_read_slopes_are_all_there_are),
                                       cmocka_unit_test(totals_are_those_that_were_seen),
                                       cmocka_unit_test(glints_have_curvature),
                                       cmocka_unit_test(calm_is_a_mirror),
                                       cmocka_unit_test(thresholds_are_those_of_the_table),
                                       cmocka_unit_test(foam_covers_what_was_seen),
                                       cmocka_unit_test(foam_is_the_same_from_afar),
                                       cmocka_unit_test(foam_is_found_by_any_sea)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
