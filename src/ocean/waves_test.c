/* Tests of waves.h: that a sea drawn from a spectrum has its statistics, moves as waves do, and is read as
 * it was drawn. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "tests/support/support.h"
#include "ocean/wave_amplitudes.h"
#include "ocean/wave_patches.h"
#include "ocean/waves_fixture.h"

static const double TWO_PI = 6.28318530717958647693;

static size_t texel_count(const wave_tile *t)
{
    return (size_t)t->size * t->size;
}

static double mean_square(const wave_tile *t, wave_field f)
{
    double sum = 0.0;
    for (size_t i = 0; i < texel_count(t); i++)
        sum += (double)t->levels[0][i * WAVE_FIELDS + f] * (double)t->levels[0][i * WAVE_FIELDS + f];
    return sum / (double)texel_count(t);
}

static double variance(const waves *w, wave_field f)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < w->tile_count; i++)
        sum += mean_square(&w->tiles[i], f);
    return sum;
}

/* ---- the transform ---- */

/* Every field of a few texels against the sum over waves, in double. */
static void fields_are_sums_of_waves(void **state)
{
    (void)state;
    facet_sea_desc d = desc_of(32, 2, 7);
    d.bed.depth_m = 20.0f;
    d.choppiness = 0.8f;
    waves w = waves_of(d);
    waves_set_time(&w, 3.7);
    for (uint32_t tile = 0; tile < w.tile_count; tile++) {
        const wave_tile *t = &w.tiles[tile];
        const wave_amplitudes *a = w.amplitudes[tile];
        for (uint32_t texel = 5; texel < 1024; texel += 131) {
            double x = (texel % 32) * t->length_m / 32.0, z = (texel / 32) * t->length_m / 32.0;
            double expected[WAVE_FIELDS] = {0.0}, scale[WAVE_FIELDS] = {0.0};
            for (size_t i = 0; i < a->count; i++) {
                const wave_mode *m = &a->modes[i];
                double kx = TWO_PI * m->n_x / t->length_m, kz = TWO_PI * m->n_z / t->length_m,
                       k = hypot(kx, kz);
                double omega = wave_omega(k, 20.0), c = 0.8 / tanh(k * 20.0) / k;
                /* 2 |h0| cos(k.x -+ omega t + phase) in both directions */
                double there = kx * x + kz * z - omega * 3.7, back = -kx * x - kz * z - omega * 3.7;
                double h = 2.0 * ((double)m->there[0] * cos(there) - (double)m->there[1] * sin(there) +
                                  (double)m->back[0] * cos(back) - (double)m->back[1] * sin(back));
                /* its quarter of a wave before: minus the derivative along k, over k */
                double q = 2.0 * ((double)m->there[0] * sin(there) + (double)m->there[1] * cos(there) -
                                  (double)m->back[0] * sin(back) - (double)m->back[1] * cos(back));
                const double all[WAVE_FIELDS] = {
                    [WAVE_DX] = -c * kx * q,       [WAVE_ETA] = h,
                    [WAVE_DZ] = -c * kz * q,       [WAVE_ETA_X] = -kx * q,
                    [WAVE_ETA_Z] = -kz * q,        [WAVE_DXX] = -c * kx * kx * h,
                    [WAVE_DZZ] = -c * kz * kz * h, [WAVE_DXZ] = -c * kx * kz * h};
                for (int f = 0; f < WAVE_FIELDS; f++) {
                    expected[f] += all[f];
                    scale[f] += all[f] * all[f];
                }
            }
            for (int f = 0; f < WAVE_FIELDS; f++)
                assert_near(t->levels[0][(size_t)texel * WAVE_FIELDS + (size_t)f], expected[f],
                            2e-6 * sqrt(scale[f]) + 1e-9);
        }
    }
    waves_destroy(&w);
}

/* All modes but one are taken out. */
static wave_mode leave_one(waves *w, int32_t n_x, int32_t n_z, float amplitude_m)
{
    wave_amplitudes *a = w->amplitudes[0];
    wave_mode left = {0};
    for (size_t i = 0; i < a->count; i++) {
        wave_mode *m = &a->modes[i];
        bool is_it = m->n_x == n_x && m->n_z == n_z;
        m->there[0] = is_it ? 0.5f * amplitude_m : 0.0f;
        m->there[1] = m->back[0] = m->back[1] = 0.0f;
        if (is_it)
            left = *m;
    }
    return left;
}

static void one_wave_runs_along_its_vector(void **state)
{
    (void)state;
    waves w = waves_of(desc_of(64, 1, 1));
    wave_mode m = leave_one(&w, 5, 0, 0.5f);
    double k = 5.0 * TWO_PI / w.tiles[0].length_m, speed = sqrt(GRAVITY / k);
    assert_near(m.omega / k / speed, 1.0, 1e-3); /* tension is 1e-5 of it */
    double quarter = 0.25 * TWO_PI / k;
    waves_set_time(&w, 0.0); /* a cos kx: crest at 0 */
    const float *texels = w.tiles[0].levels[0];
    assert_near(texels[WAVE_ETA], 0.5, 1e-5);
    double x = 3.0 * w.tiles[0].length_m / 64.0; /* water before the crest is drawn to it: D = -a sin kx */
    assert_near(texels[3 * WAVE_FIELDS + WAVE_DX], -0.5 * sin(k * x), 1e-5);
    assert_near(texels[3 * WAVE_FIELDS + WAVE_ETA_X], -0.5 * k * sin(k * x), 1e-6);
    assert_near(texels[WAVE_DXX], -0.5 * k, 1e-6);
    waves_set_time(&w, 40.0 * quarter / speed); /* ten lengths on */
    assert_near(w.tiles[0].levels[0][WAVE_ETA], 0.5, 1e-3);
    waves_set_time(&w, 1.0); /* goes towards +x: where it was at 0 it is at c t */
    double place = speed * 1.0 / w.tiles[0].length_m * 64.0;
    size_t i = (size_t)place;
    double between = place - (double)i;
    const float *row = w.tiles[0].levels[0];
    double eta = (1.0 - between) * (double)row[i * WAVE_FIELDS + WAVE_ETA] +
                 between * (double)row[(i + 1) * WAVE_FIELDS + WAVE_ETA];
    assert_near(eta, 0.5, 0.015); /* interpolated linearly */
    waves_destroy(&w);
}

static void waves_go_down_the_wind(void **state)
{
    (void)state;
    for (int turn = 0; turn < 4; turn++) {
        facet_sea_desc d = desc_of(64, 2, 3);
        d.spreading = FACET_SEA_SPREADING_COSINE;
        d.wind_direction_rad = (float)(0.3 + 1.7 * turn);
        waves w = waves_of(d);
        for (uint32_t tile = 0; tile < 2; tile++) {
            const wave_amplitudes *a = w.amplitudes[tile];
            double direction = (double)d.wind_direction_rad - w.tiles[tile].turn;
            for (size_t i = 0; i < a->count; i++) { /* none of them against it */
                const wave_mode *m = &a->modes[i];
                double along = m->n_x * cos(direction) + m->n_z * sin(direction);
                const float *against = along > 0.0 ? m->back : m->there;
                assert_true(against[0] == 0.0f && against[1] == 0.0f);
            }
        }
        waves_destroy(&w);
    }
}

static void loops_close(void **state)
{
    (void)state;
    facet_sea_desc d = desc_of(32, 2, 5);
    d.loop_s = 60.0;
    waves w = waves_of(d);
    size_t size = texel_count(&w.tiles[1]) * WAVE_FIELDS * sizeof(float);
    float *before = malloc(size);
    assert_non_null(before);
    for (int repeat = 1; repeat < 2000; repeat *= 37) {
        waves_set_time(&w, 12.25);
        memcpy(before, w.tiles[1].levels[0], size);
        double rms = sqrt(mean_square(&w.tiles[1], WAVE_ETA));
        waves_set_time(&w, 12.25 + 60.0 * repeat);
        for (size_t i = 0; i < size / sizeof(float); i += WAVE_FIELDS)
            assert_near(before[i + WAVE_ETA], w.tiles[1].levels[0][i + WAVE_ETA], 1e-5 * rms);
        waves_set_time(&w, 12.25 + 30.0); /* and not before */
        double difference = 0.0;
        for (size_t i = 0; i < size / sizeof(float); i += WAVE_FIELDS)
            difference =
                fmax(difference, fabs((double)(before[i + WAVE_ETA] - w.tiles[1].levels[0][i + WAVE_ETA])));
        assert_true(difference > 0.5 * rms);
    }
    free(before);
    const wave_amplitudes *a = w.amplitudes[0];
    for (size_t i = 0; i < a->count; i++) { /* within half a turn per loop of what they should be */
        double k = a->k_step * hypot(a->modes[i].n_x, a->modes[i].n_z);
        assert_true(fabs(a->modes[i].omega - wave_omega(k, ENDLESS)) <= 0.51 * TWO_PI / 60.0);
    }
    waves_destroy(&w);
}

/* ---- numbers ---- */

static void long_waves_do_not_depend_on_resolution(void **state)
{
    (void)state;
    waves coarse = waves_of(desc_of(64, 1, 11)), fine = waves_of(desc_of(128, 3, 11));
    const wave_amplitudes *a = coarse.amplitudes[0], *b = fine.amplitudes[0];
    size_t same = 0;
    for (size_t i = 0; i < a->count; i++)
        for (size_t j = 0; j < b->count; j++)
            if (a->modes[i].n_x == b->modes[j].n_x && a->modes[i].n_z == b->modes[j].n_z) {
                assert_memory_equal(&a->modes[i], &b->modes[j], sizeof(wave_mode));
                same++;
            }
    assert_true(same > 300);
    waves_destroy(&coarse);
    waves_destroy(&fine);
}

static void threads_change_nothing(void **state)
{
    (void)state;
    facet_sea_desc d = desc_of(64, 3, 2);
    waves all[3];
    for (uint32_t i = 0; i < 3; i++) {
        d.thread_count = i ? 2 * i + 1 : 1;
        all[i] = waves_of(d);
        waves_set_time(&all[i], 100.0);
    }
    for (uint32_t i = 1; i < 3; i++)
        for (uint32_t tile = 0; tile < 3; tile++) {
            for (uint32_t l = 0; l < all[0].tiles[tile].level_count; l++)
                assert_memory_equal(all[0].tiles[tile].levels[l], all[i].tiles[tile].levels[l],
                                    (texel_count(&all[0].tiles[tile]) >> 2 * l) * WAVE_FIELDS *
                                        sizeof(float));
            assert_memory_equal(all[0].tiles[tile].bounds, all[i].tiles[tile].bounds,
                                sizeof all[0].tiles[tile].bounds);
        }
    for (uint32_t i = 0; i < 3; i++)
        waves_destroy(&all[i]);
}

static void another_seed_is_another_sea(void **state)
{
    (void)state;
    waves a = waves_of(desc_of(32, 1, 1)), b = waves_of(desc_of(32, 1, 2));
    double product = 0.0;
    for (size_t i = 0; i < texel_count(&a.tiles[0]); i++)
        product += (double)a.tiles[0].levels[0][i * WAVE_FIELDS + WAVE_ETA] *
                   (double)b.tiles[0].levels[0][i * WAVE_FIELDS + WAVE_ETA];
    double scale = sqrt(variance(&a, WAVE_ETA) * variance(&b, WAVE_ETA)) * (double)texel_count(&a.tiles[0]);
    assert_true(fabs(product / scale) < 0.3);
    waves_destroy(&a);
    waves_destroy(&b);
}

/* ---- statistics ---- */

static void heights_and_slopes_are_those_of_the_spectrum(void **state)
{
    (void)state;
    enum { SEEDS = 16 };
    for (uint32_t cascades = 1; cascades <= 3; cascades++) {
        double height = 0.0, slopes = 0.0, across = 0.0, expected_height = 0.0, expected_slopes = 0.0,
               expected_z = 0.0;
        for (uint64_t seed = 0; seed < SEEDS; seed++) {
            waves w = waves_of(desc_of(512u >> cascades, cascades, seed)); /* all reach as far */
            double here = 4.0 * sqrt(variance(&w, WAVE_ETA));
            sea_moments m = sea_state_moments(&w.state, 0.0, w.tiles[cascades - 1].k_to);
            expected_height = 4.0 * sqrt(m.height);
            expected_slopes = m.slope[0] + m.slope[1];
            expected_z = m.slope[1];
            assert_near(here, expected_height, 0.15 * expected_height);
            height += here / SEEDS;
            slopes += (variance(&w, WAVE_ETA_X) + variance(&w, WAVE_ETA_Z)) / SEEDS;
            for (uint32_t i = 0; i < cascades; i++) { /* across the wind, in the tile's axes */
                double c = cos(w.tiles[i].turn), s = sin(w.tiles[i].turn);
                for (size_t t = 0; t < texel_count(&w.tiles[i]); t++) {
                    const float *texel = w.tiles[i].levels[0] + t * WAVE_FIELDS;
                    double z = s * (double)texel[WAVE_ETA_X] + c * (double)texel[WAVE_ETA_Z];
                    across += z * z / (double)texel_count(&w.tiles[i]) / SEEDS;
                }
            }
            waves_destroy(&w);
        }
        assert_near(expected_height, 2.1386, 0.01 * 2.1386); /* whatever the cascades */
        assert_near(height, expected_height, 0.04 * expected_height);
        assert_near(slopes, expected_slopes, 0.02 * expected_slopes);
        assert_near(across, expected_z, 0.03 * expected_z);
    }
}

/* E[J] = 1 whatever the spectrum: D_xx D_zz and D_xz^2 have the same mean. */
static void area_is_kept(void **state)
{
    (void)state;
    waves w = waves_of(desc_of(128, 3, 4));
    for (uint32_t i = 0; i < w.tile_count; i++) {
        const wave_tile *t = &w.tiles[i];
        double sum = 0.0, squares = 0.0, count = (double)texel_count(t);
        for (size_t j = 0; j < texel_count(t); j++) {
            const float *texel = t->levels[0] + j * WAVE_FIELDS;
            wave_point p = {.Dxx = texel[WAVE_DXX], .Dzz = texel[WAVE_DZZ], .Dxz = texel[WAVE_DXZ]};
            double J = (double)wave_shape_of(&p).jacobian;
            sum += J;
            squares += J * J;
        }
        double mean = sum / count, deviation = sqrt(squares / count - mean * mean);
        double slopes = mean_square(t, WAVE_ETA_X) + mean_square(t, WAVE_ETA_Z);
        assert_near(mean, 1.0, 1e-3);
        assert_near(deviation / sqrt(slopes), 1.0, 0.02);
    }
    waves_destroy(&w);
}

/* Seen from above, where crests are narrow: without level_m it would be 2 % of the height lower. */
static void mean_level_is_zero(void **state)
{
    (void)state;
    facet_sea_desc d = desc_of(64, 2, 6);
    waves w = waves_of(d);
    enum { EDGE = 160 };
    double sum = 0.0, height = 4.0 * sqrt(variance(&w, WAVE_ETA)), spacing = 4.0 * w.tiles[0].length_m / EDGE;
    for (int i = 0; i < EDGE * EDGE; i++)
        sum += (double)waves_height(&w, i % EDGE * spacing, i / EDGE * spacing, 0.0f);
    assert_true((double)w.level_m > 0.015 * height);
    assert_near(sum / (EDGE * EDGE), 0.0, 0.01 * height);
    waves_destroy(&w);
}

/* ---- reading ---- */

static void levels_are_means(void **state)
{
    (void)state;
    waves w = waves_of(desc_of(64, 2, 8));
    for (uint32_t i = 0; i < 2; i++) {
        const wave_tile *t = &w.tiles[i];
        assert_int_equal(t->level_count, 7);
        for (uint32_t l = 1; l < t->level_count; l++) {
            size_t edge = t->size >> l, x = edge / 3, z = edge / 2;
            for (size_t f = 0; f < WAVE_FIELDS; f++) {
                double sum = 0.0;
                for (size_t j = 0; j < 4; j++)
                    sum +=
                        (double)
                            t->levels[l - 1][((2 * z + j / 2) * 2 * edge + 2 * x + j % 2) * WAVE_FIELDS + f];
                assert_near(t->levels[l][(z * edge + x) * WAVE_FIELDS + f], 0.25 * sum, 1e-6);
            }
        }
        assert_near(t->levels[6][WAVE_ETA], 0.0, 1e-4);
        for (uint32_t l = 0; l < t->level_count; l++)
            for (size_t j = 0; j < texel_count(t) >> 2 * l; j++) {
                float eta = t->levels[l][j * WAVE_FIELDS + WAVE_ETA];
                assert_true(eta <= t->bounds[l].highest && eta >= t->bounds[l].lowest);
            }
    }
    waves_destroy(&w);
}

/* Without patches: a place on a sample of a tile that is not the longest. */
static void samples_are_read_where_they_lie(void **state)
{
    (void)state;
    waves w = waves_of(desc_of(64, 2, 9));
    const wave_tile *t = &w.tiles[1];
    assert_false(t->is_patched);
    double c = cos(t->turn), s = sin(t->turn);
    for (uint32_t i = 0; i < 4096; i += 149) {
        const float *texel = t->levels[0] + (size_t)i * WAVE_FIELDS;
        for (int far = -1; far <= 1; far++) { /* three hundred kilometres away, too */
            double u = (i % 64 / 64.0 + 3000.0 * far) * t->length_m,
                   v = (i / 64 / 64.0 - 1000.0 * far) * t->length_m;
            double x = c * u - s * v, z = s * u + c * v;
            wave_point all = waves_at(&w, x, z, 0.0f);
            wave_tile hidden = w.tiles[1];
            w.tile_count = 1;
            wave_point longest = waves_at(&w, x, z, 0.0f);
            w.tile_count = 2;
            w.tiles[1] = hidden;
            assert_near(all.height_m - longest.height_m, texel[WAVE_ETA], 1e-4);
            assert_near(all.displacement[0] - longest.displacement[0],
                        c * (double)texel[WAVE_DX] - s * (double)texel[WAVE_DZ], 1e-4);
            assert_near(all.slope[1] - longest.slope[1],
                        s * (double)texel[WAVE_ETA_X] + c * (double)texel[WAVE_ETA_Z], 1e-4);
            assert_near(all.Dxx + all.Dzz - longest.Dxx - longest.Dzz, texel[WAVE_DXX] + texel[WAVE_DZZ],
                        1e-4);
            double Dxz = c * s * (double)(texel[WAVE_DXX] - texel[WAVE_DZZ]) +
                         (c * c - s * s) * (double)texel[WAVE_DXZ];
            assert_near(all.Dxz - longest.Dxz, Dxz, 1e-4);
        }
    }
    waves_destroy(&w);
}

static void water_above_a_place_is_displaced_to_it(void **state)
{
    (void)state;
    uint64_t random = 1;
    double apart = 0.0;
    waves w = waves_of(desc_of(128, 3, 10));
    for (int i = 0; i < 2000; i++) {
        double X = 2e5 * (lcg64_double(&random) - 0.5), Z = 2e5 * (lcg64_double(&random) - 0.5), rest[2];
        float footprint = i % 4 ? (float)pow(10.0, -3.0 + 4.0 * lcg64_double(&random)) : 0.0f;
        wave_point p = waves_above(&w, X, Z, footprint, rest);
        double close = fmax(0.02 * (double)footprint, 2e-4);
        assert_near(rest[0] + (double)p.displacement[0], X, 2.0 * close + 3e-4);
        assert_near(rest[1] + (double)p.displacement[1], Z, 2.0 * close + 3e-4);
        float near_[2] = {p.displacement[0] + 0.3f, p.displacement[1]};
        float height = waves_height(&w, X, Z, footprint);
        apart += (double)(height - p.height_m) * (double)(height - p.height_m);
        assert_near(waves_height_near(&w, X, Z, footprint, near_), height, close + 3e-4);
        wave_bounds b = waves_bounds(&w, footprint);
        assert_true(p.height_m <= b.highest && p.height_m >= b.lowest);
        assert_true(hypotf(p.displacement[0], p.displacement[1]) <= b.farthest);
    }
    assert_true(sqrt(apart / 2000.0) < 0.01 * 2.14); /* linear and cubic */
    waves_destroy(&w);
}

static void reading_has_no_jumps(void **state)
{
    (void)state;
    waves w = waves_of(desc_of(64, 2, 12));
    float last = waves_height(&w, 12.3, 45.6, 1e-3f);
    for (float footprint = 1e-3f; footprint < 2000.0f; footprint *= 1.002f) {
        float now = waves_height(&w, 12.3, 45.6, footprint);
        assert_near(now, last, 0.02);
        last = now;
    }
    assert_near(last, w.level_m, 1e-6); /* and ends as a plane */
    waves_destroy(&w);
}

/* The normal of (x + D_x, eta, z + D_z), by the cross product of its derivatives. */
static void normals_are_those_of_the_displaced_surface(void **state)
{
    (void)state;
    uint64_t random = 5;
    for (int i = 0; i < 100; i++) {
        wave_point p = {.slope = {(float)lcg64_double(&random) - 0.5f, (float)lcg64_double(&random) - 0.5f},
                        .Dxx = 0.8f * (float)lcg64_double(&random) - 0.4f,
                        .Dzz = 0.8f * (float)lcg64_double(&random) - 0.4f,
                        .Dxz = 0.4f * (float)lcg64_double(&random) - 0.2f};
        double a[3] = {1.0 + (double)p.Dxx, (double)p.slope[0], (double)p.Dxz};
        double b[3] = {(double)p.Dxz, (double)p.slope[1], 1.0 + (double)p.Dzz};
        double n[3] = {b[1] * a[2] - b[2] * a[1], b[2] * a[0] - b[0] * a[2], b[0] * a[1] - b[1] * a[0]};
        double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        wave_shape s = wave_shape_of(&p);
        for (int j = 0; j < 3; j++)
            assert_near(s.normal[j], n[j] / length, 1e-6);
        assert_near(s.jacobian, n[1], 1e-6);
        assert_near(s.convergence, -(p.Dxx + p.Dzz), 0.0);
    }
    wave_point folded = {.slope = {0.3f, 0.0f}, .Dxx = -1.5f};
    assert_true(wave_shape_of(&folded).normal[1] > 0.0f);
    assert_true(wave_shape_of(&folded).jacobian < 0.0f);
}

static void velocity_is_the_change_of_height(void **state)
{
    (void)state;
    waves w = waves_of(desc_of(32, 2, 13));
    uint64_t random = 2;
    for (int i = 0; i < 10; i++) { /* the longest tile: interpolation is nearly exact there */
        double t = 10.0 * lcg64_double(&random), x = 500.0 * lcg64_double(&random),
               z = 500.0 * lcg64_double(&random), h = 0.01;
        w.tile_count = 1;
        waves_set_time(&w, t + h);
        double after = (double)waves_at(&w, x, z, 0.0f).height_m;
        waves_set_time(&w, t - h);
        double before = (double)waves_at(&w, x, z, 0.0f).height_m;
        waves_set_time(&w, t);
        assert_near(waves_velocity(&w, x, z), (after - before) / (2.0 * h),
                    0.12); /* of 0.5 m/s: linear interpolation */
    }
    w.tile_count = 2;
    waves_destroy(&w);
}

/* ---- repetition ---- */

static void a_lag_of_a_tile_is_as_any_other(void **state)
{
    (void)state;
    waves w = waves_of(desc_of(128, 2, 14));
    enum { EDGE = 120 };
    double spacing = 4000.0 / EDGE, squares = 0.0;
    for (int tile = 0; tile < 2; tile++)
        for (int axis = 0; axis < 2; axis++) {
            double turn = w.tiles[tile].turn + axis * TWO_PI / 4.0, L = w.tiles[tile].length_m, product = 0.0;
            squares = 0.0;
            for (int i = 0; i < EDGE * EDGE; i++) {
                double x = i % EDGE * spacing, z = i / EDGE * spacing;
                double h = (double)waves_height(&w, x, z, 0.0f);
                squares += h * h;
                product += h * (double)waves_height(&w, x + L * cos(turn), z + L * sin(turn), 0.0f);
            }
            assert_true(fabs(product / squares) < 0.3);
        }
    /* and as high as one tile */
    assert_near(squares / (EDGE * EDGE), variance(&w, WAVE_ETA), 0.1 * variance(&w, WAVE_ETA));
    waves_destroy(&w);
}

/* Over a swell the wind's waves are in a tile of a few metres, which must not show either. */
static void ripples_on_a_swell_do_not_repeat(void **state)
{
    (void)state;
    facet_sea_desc d = desc_of(128, 4, 16);
    d.wind_mps = 2.0f;
    d.swell = (facet_swell){.height_m = 0.5f, .period_s = 9.0f, .direction_rad = 0.4f};
    waves w = waves_of(d);
    double k = wave_k(w.state.systems[0].peak_omega, ENDLESS);
    uint32_t tile = 0;
    while (tile + 1 < w.tile_count && !(k < w.tiles[tile].k_to))
        tile++;
    assert_true(tile > 0 && w.tiles[tile].is_patched);
    double product = 0.0, squares = 0.0, L = w.tiles[tile].length_m;
    double turn = w.tiles[tile].turn;
    for (int i = 0; i < 10000; i++) {
        double x = 0.37 * L * (i % 100), z = 0.37 * L * (i / 100);
        double a = (double)waves_at(&w, x, z, 0.0f).slope[0];
        squares += a * a;
        product += a * (double)waves_at(&w, x + L * cos(turn), z + L * sin(turn), 0.0f).slope[0];
    }
    assert_true(fabs(product / squares) < 0.3);
    waves_destroy(&w);
}

static void patches_keep_the_variance(void **state)
{
    (void)state;
    waves w = waves_of(desc_of(32, 1, 15));
    uint64_t random = 3;
    uint32_t counts[4] = {0};
    for (int i = 0; i < 20000; i++) {
        wave_patch patches[WAVES_MAX_PATCHES];
        double x = 1e5 * (lcg64_double(&random) - 0.5), z = 1e5 * (lcg64_double(&random) - 0.5), sum = 0.0;
        uint32_t count = wave_patches_at(&w, 0, x, z, patches);
        assert_in_range(count, 1, 3);
        counts[count]++;
        for (uint32_t j = 0; j < count; j++)
            sum += (double)patches[j].weight * (double)patches[j].weight;
        assert_near(sum, 1.0, 1e-5);
    }
    assert_near(counts[1] / 20000.0, 0.375, 0.02);
    assert_near(counts[3] / 20000.0, 0.0625, 0.01);
    for (double z = 0.0; z < 3000.0; z += 0.5) { /* no edges */
        double before = (double)waves_at(&w, 100.0 + 0.3 * z, z, 0.0f).height_m;
        double after = (double)waves_at(&w, 100.0 + 0.3 * z + 1e-3, z + 1e-3, 0.0f).height_m;
        assert_near(after, before, 5e-3);
    }
    waves_destroy(&w);
}

/* ---- ends ---- */

static void assert_finite_sea(facet_sea_desc d)
{
    waves w = waves_of(d);
    uint64_t random = 9;
    for (int i = 0; i < 300; i++) {
        double rest[2];
        wave_point p = waves_above(&w, 1e3 * lcg64_double(&random), 1e3 * lcg64_double(&random), 0.01f, rest);
        wave_shape s = wave_shape_of(&p);
        assert_true(isfinite(p.height_m) && isfinite(rest[0]) && isfinite(rest[1]));
        assert_true(isfinite(s.normal[0]) && s.normal[1] > 0.0f && isfinite(s.normal[2]));
    }
    waves_destroy(&w);
}

static void extremes_are_finite(void **state)
{
    (void)state;
    facet_sea_desc d = desc_of(64, 3, 1);
    d.wind_mps = 0.0f; /* a plane */
    waves flat = waves_of(d);
    assert_int_equal(flat.tile_count, 0);
    wave_point p = waves_at(&flat, 3.0, 4.0, 0.1f);
    assert_true(p.height_m == 0.0f && p.slope[0] == 0.0f && p.displacement[0] == 0.0f);
    assert_true(waves_bounds(&flat, 1.0f).highest == 0.0f);
    assert_true(waves_velocity(&flat, 1.0, 2.0) == 0.0);
    waves_set_time(&flat, 5.0);
    waves_destroy(&flat);
    assert_finite_sea(d);
    d.swell = (facet_swell){.height_m = 3.0f, .period_s = 14.0f, .elongation = 1.0f};
    assert_finite_sea(d);
    static const float winds[4] = {0.3f, 1.0f, 30.0f, 40.0f};
    for (int i = 0; i < 4; i++) {
        d = desc_of(64, 3, 1);
        d.wind_mps = winds[i];
        d.fetch_m = INFINITY;
        assert_finite_sea(d);
        d.choppiness = 2.0f;
        d.bed.depth_m = 0.5f; /* less than waves are high */
        assert_finite_sea(d);
    }
    d = desc_of(64, 2, 1);
    d.choppiness = 0.0f; /* nothing goes to and fro */
    waves w = waves_of(d);
    double rest[2];
    p = waves_above(&w, 12.0, 34.0, 0.0f, rest);
    assert_near(p.displacement[0], 0.0, 1e-6); /* two fields share a transform, and its rounding */
    assert_near(rest[0], 12.0, 1e-6);
    assert_near(p.Dxx, 0.0, 1e-6);
    assert_true(w.level_m == 0.0f);
    wave_point far = waves_at(&w, 1e300, -ENDLESS, 0.0f);
    assert_true(isfinite(far.height_m));
    waves_set_time(&w, 1e300);
    assert_true(isfinite(waves_height(&w, 0.0, 0.0, 0.0f)));
    waves_destroy(&w);
}

static void running_out_of_memory_leaks_nothing(void **state)
{
    (void)state;
    facet_sea_desc d = desc_of(32, 2, 1);
    sea_state s;
    assert_int_equal(sea_state_create(&d, &s, NULL), FACET_OK);
    for (long fail_at = 0;; fail_at++) {
        failing_allocator f = {.fail_at = fail_at};
        d.allocator = failing_allocator_get(&f);
        waves w;
        facet_error error;
        facet_result result = waves_create(&d, &s, &w, &error);
        waves_destroy(&w);
        assert_int_equal(atomic_load(&f.blocks), 0);
        if (result == FACET_OK)
            break;
        assert_int_equal(result, FACET_ERROR_MEMORY);
        assert_in_range(fail_at, 0, 200);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(fields_are_sums_of_waves),
                                       cmocka_unit_test(one_wave_runs_along_its_vector),
                                       cmocka_unit_test(waves_go_down_the_wind),
                                       cmocka_unit_test(loops_close),
                                       cmocka_unit_test(long_waves_do_not_depend_on_resolution),
                                       cmocka_unit_test(threads_change_nothing),
                                       cmocka_unit_test(another_seed_is_another_sea),
                                       cmocka_unit_test(heights_and_slopes_are_those_of_the_spectrum),
                                       cmocka_unit_test(area_is_kept),
                                       cmocka_unit_test(mean_level_is_zero),
                                       cmocka_unit_test(levels_are_means),
                                       cmocka_unit_test(samples_are_read_where_they_lie),
                                       cmocka_unit_test(water_above_a_place_is_displaced_to_it),
                                       cmocka_unit_test(reading_has_no_jumps),
                                       cmocka_unit_test(normals_are_those_of_the_displaced_surface),
                                       cmocka_unit_test(velocity_is_the_change_of_height),
                                       cmocka_unit_test(a_lag_of_a_tile_is_as_any_other),
                                       cmocka_unit_test(ripples_on_a_swell_do_not_repeat),
                                       cmocka_unit_test(patches_keep_the_variance),
                                       cmocka_unit_test(extremes_are_finite),
                                       cmocka_unit_test(running_out_of_memory_leaks_nothing)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
