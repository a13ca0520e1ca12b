/* Tests of sea_state.h: heights and periods, slopes and curvatures against tables that were computed
 * independently from the same papers; norms of directions; dispersion; limits. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "tests/support/support.h"
#include "ocean/sea.h"
#include "ocean/sea_state.h"

static const double TWO_PI = 6.28318530717958647693;

static sea_state state_of(facet_sea_desc d)
{
    sea_state s;
    facet_error error = {.message = ""};
    if (sea_state_create(&d, &s, &error) != FACET_OK)
        fail_msg("%s", error.message);
    return s;
}

static sea_state wind_state(float wind_mps, float fetch_m)
{
    facet_sea_desc d = sea_default();
    d.wind_mps = wind_mps;
    d.fetch_m = fetch_m;
    return state_of(d);
}

/* Before slopes of light airs are limited. */
static sea_state bare_state(facet_sea_desc d)
{
    sea_state s = state_of(d);
    s.taper = 1.0;
    s.taper_k = ENDLESS;
    return s;
}

/* 4 sqrt(integral of S over omega). */
static double height_of(const sea_state *s)
{
    const wave_system *w = &s->systems[0];
    double sum = 0.0, step = 0.002;
    for (double x = log(0.3); x < log(100.0); x += step) {
        double omega = w->peak_omega * exp(x + 0.5 * step);
        sum += wave_spectrum(w, omega, s->depth_m) * omega * step;
    }
    return 4.0 * sqrt(sum);
}

/* ---- heights ---- */

static void jonswap_has_the_heights_of_the_table(void **state)
{
    (void)state;
    static const float winds[9] = {2.0f, 3.0f, 5.0f, 7.5f, 10.0f, 12.5f, 15.0f, 20.0f, 25.0f};
    static const double fetches[7] = {5e3, 20e3, 50e3, 100e3, 200e3, 500e3, ENDLESS};
    static const double expected[7][9][2] = {{{0.090, 1.28},
                                              {0.139, 1.54},
                                              {0.218, 1.82},
                                              {0.313, 2.09},
                                              {0.404, 2.30},
                                              {0.492, 2.47},
                                              {0.578, 2.63},
                                              {0.746, 2.89},
                                              {0.909, 3.12}},
                                             {{0.090, 1.28},
                                              {0.202, 1.92},
                                              {0.472, 2.89},
                                              {0.676, 3.31},
                                              {0.873, 3.64},
                                              {1.064, 3.93},
                                              {1.251, 4.17},
                                              {1.614, 4.59},
                                              {1.967, 4.95}},
                                             {{0.090, 1.28},
                                              {0.202, 1.92},
                                              {0.561, 3.21},
                                              {1.127, 4.49},
                                              {1.454, 4.95},
                                              {1.772, 5.33},
                                              {2.083, 5.66},
                                              {2.688, 6.23},
                                              {3.276, 6.71}},
                                             {{0.090, 1.28},
                                              {0.202, 1.92},
                                              {0.561, 3.21},
                                              {1.263, 4.81},
                                              {2.139, 6.23},
                                              {2.606, 6.71},
                                              {3.064, 7.13},
                                              {3.954, 7.85},
                                              {4.819, 8.46}},
                                             {{0.090, 1.28},
                                              {0.202, 1.92},
                                              {0.561, 3.21},
                                              {1.263, 4.81},
                                              {2.244, 6.42},
                                              {3.507, 8.02},
                                              {4.506, 8.99},
                                              {5.816, 9.89},
                                              {7.088, 10.66}},
                                             {{0.090, 1.28},
                                              {0.202, 1.92},
                                              {0.561, 3.21},
                                              {1.263, 4.81},
                                              {2.244, 6.42},
                                              {3.507, 8.02},
                                              {5.050, 9.62},
                                              {8.978, 12.83},
                                              {11.805, 14.46}},
                                             {{0.090, 1.28},
                                              {0.202, 1.92},
                                              {0.561, 3.21},
                                              {1.263, 4.81},
                                              {2.244, 6.42},
                                              {3.507, 8.02},
                                              {5.050, 9.62},
                                              {8.978, 12.83},
                                              {14.028, 16.04}}};
    for (int f = 0; f < 7; f++)
        for (int u = 0; u < 9; u++) {
            sea_state s = wind_state(winds[u], (float)fetches[f]);
            double height = expected[f][u][0], period = expected[f][u][1]; /* rounded as printed */
            assert_near(height_of(&s), height, 0.001 * height + 0.0005);
            assert_near(TWO_PI / s.systems[0].peak_omega, period, 0.001 * period + 0.005);
        }
}

static void growth_ends_without_a_step(void **state)
{
    (void)state;
    float full = (float)(1.07e4 * 10.0 * 10.0 / GRAVITY);
    sea_state before = wind_state(10.0f, 0.9999f * full), at = wind_state(10.0f, full);
    sea_state after = wind_state(10.0f, 2.0f * full);
    assert_near(height_of(&before), height_of(&at), 2e-4);
    assert_near(height_of(&after), height_of(&at), 1e-6);
    facet_sea_desc d = sea_default();
    d.spectrum = FACET_SEA_SPECTRUM_PIERSON_MOSKOWITZ;
    sea_state developed = state_of(d);
    assert_near(height_of(&after), height_of(&developed), 0.002); /* that is where it ends */
}

static void depth_lowers_waves(void **state)
{
    (void)state;
    static const double expected[6][2] = {{3.0, 1.030},  {5.0, 1.285},  {10.0, 1.670},
                                          {20.0, 2.003}, {50.0, 2.136}, {4000.0, 2.139}};
    for (int i = 0; i < 6; i++) {
        facet_sea_desc d = sea_default();
        d.fetch_m = 100e3f;
        d.bed.depth_m = (float)expected[i][0];
        sea_state s = state_of(d);
        assert_near(height_of(&s), expected[i][1], 0.001 * expected[i][1] + 0.0005);
        sea_moments m = sea_state_moments(&s, 0.0, ENDLESS); /* the same by wave vectors */
        assert_near(4.0 * sqrt(m.height), height_of(&s), 0.002 * expected[i][1]);
    }
}

static void waves_break_where_the_bed_is_near(void **state)
{
    (void)state;
    static const float depths[4] = {0.01f, 0.1f, 0.5f, 1.0f};
    for (int i = 0; i < 4; i++) {
        facet_sea_desc d = sea_default();
        d.wind_mps = 20.0f;
        d.bed.depth_m = depths[i];
        d.swell = (facet_swell){.height_m = 3.0f, .period_s = 10.0f};
        sea_state s = state_of(d);
        double height = 4.0 * sqrt(sea_state_moments(&s, 0.0, ENDLESS).height);
        assert_true(height > 0.0);
        assert_true(height <= 0.6 * (double)depths[i]);
    }
}

static void other_spectra_have_their_heights(void **state)
{
    (void)state;
    static const float winds[5] = {3.0f, 5.0f, 10.0f, 15.0f, 20.0f};
    static const double heights[2][5] = {{0.0, 0.561, 2.245, 5.051, 8.980}, {0.23, 0.64, 2.60, 5.84, 10.37}};
    static const double periods[5] = {0.0, 3.75, 7.49, 11.24, 14.98};
    static const facet_sea_spectrum spectra[2] = {FACET_SEA_SPECTRUM_PIERSON_MOSKOWITZ,
                                                  FACET_SEA_SPECTRUM_ELFOUHAILY};
    for (int k = 0; k < 2; k++)
        for (int i = 1 - k; i < 5; i++) {
            facet_sea_desc d = sea_default();
            d.wind_mps = winds[i];
            d.spectrum = spectra[k];
            sea_state s = bare_state(d);
            double height = 4.0 * sqrt(sea_state_moments(&s, 0.0, ENDLESS).height);
            assert_near(height, heights[k][i], 0.001 * heights[k][i] + (k ? 0.005 : 0.0015));
            if (k == 0)
                assert_near(TWO_PI / s.systems[0].peak_omega, periods[i], 0.006);
        }
}

static void swell_is_as_high_as_asked(void **state)
{
    (void)state;
    static const float depths[3] = {0.0f, 20.0f, 8.0f};
    for (int i = 0; i < 3; i++) {
        facet_sea_desc d = sea_default();
        d.wind_mps = 0.0f;
        d.swell =
            (facet_swell){.height_m = 2.5f, .period_s = 12.0f, .direction_rad = 1.0f, .elongation = 1.0f};
        d.bed.depth_m = depths[i];
        sea_state s = state_of(d);
        assert_near(4.0 * sqrt(sea_state_moments(&s, 0.0, ENDLESS).height), 2.5, 0.002);
    }
    facet_sea_desc d = sea_default(); /* and adds its variance to the wind's */
    sea_state alone = state_of(d);
    d.swell = (facet_swell){.height_m = 1.0f, .period_s = 10.0f};
    sea_state both = state_of(d);
    double height = sea_state_moments(&alone, 0.0, ENDLESS).height;
    assert_near(sea_state_moments(&both, 0.0, ENDLESS).height, height + 1.0 / 16.0, 2e-3 * height);
}

/* ---- directions ---- */

static double integral_of(const wave_system *w, double omega, double from, double to)
{
    enum { STEPS = 2000 };
    wave_directions d = wave_directions_at(w, omega);
    double sum = 0.0;
    for (int i = 0; i < STEPS; i++)
        sum += wave_directions_density(&d, from + (to - from) * (i + 0.5) / STEPS);
    return sum * (to - from) / STEPS;
}

static void directions_sum_to_one(void **state)
{
    (void)state;
    for (int kind = FACET_SEA_SPREADING_HASSELMANN; kind <= FACET_SEA_SPREADING_COSINE; kind++)
        for (double x = 0.4; x < 60.0; x *= 1.3)
            for (double elongation = 0.0; elongation <= 1.0; elongation += 0.5) {
                wave_system w = {.spreading = (facet_sea_spreading)kind,
                                 .peak_omega = 0.9,
                                 .inverse_age = 1.0,
                                 .elongation = elongation};
                assert_near(integral_of(&w, 0.9 * x, -0.5 * TWO_PI, 0.5 * TWO_PI), 1.0, 1e-4);
                double half = integral_of(&w, 0.9 * x, -0.25 * TWO_PI, 0.25 * TWO_PI);
                assert_true(half > 0.5); /* most go down the wind */
                assert_near(wave_spreading(&w, 0.9 * x, 0.7), wave_spreading(&w, 0.9 * x, -0.7), 1e-12);
            }
}

static void elongation_is_for_long_waves(void **state)
{
    (void)state;
    wave_system round_ = {.peak_omega = 0.5, .inverse_age = 1.17};
    wave_system longer = round_;
    longer.elongation = 1.0;
    double slow = wave_spreading(&longer, 0.25, 0.0) / wave_spreading(&round_, 0.25, 0.0);
    double fast = wave_spreading(&longer, 4.0, 0.0) / wave_spreading(&round_, 4.0, 0.0);
    assert_near(wave_directions_at(&longer, 0.5).power, 9.77 * 0.0 + 6.97 + 16.0 * tanh(1.0), 1e-12);
    assert_true(slow > 2.0);
    assert_true(wave_directions_at(&longer, 0.25).power - wave_directions_at(&round_, 0.25).power > 15.0);
    assert_true(wave_directions_at(&longer, 4.0).power - wave_directions_at(&round_, 4.0).power < 2.0);
    assert_true(fast > 1.0);
}

/* ---- dispersion ---- */

static void dispersion_is_inverted_and_derived(void **state)
{
    (void)state;
    static const double depths[4] = {0.05, 1.0, 30.0, ENDLESS};
    for (int i = 0; i < 4; i++)
        for (double k = 1e-3; k < 3000.0; k *= 1.7) {
            double omega = wave_omega(k, depths[i]);
            assert_near(wave_k(omega, depths[i]) / k, 1.0, 1e-11);
            double slope =
                (wave_omega(k * 1.00001, depths[i]) - wave_omega(k * 0.99999, depths[i])) / (2e-5 * k);
            assert_near(wave_domega_dk(k, depths[i]) / slope, 1.0, 1e-7);
        }
    assert_near(wave_omega(0.1, ENDLESS), sqrt(0.981), 1e-6); /* gravity */
    assert_near(wave_omega(1e-3, 2.0), 1e-3 * sqrt(2.0 * 9.81),
                1e-8); /* long over a shallow bed: sqrt(g H) */
    double slowest = pow(4.0 * GRAVITY * SURFACE_TENSION_OVER_DENSITY, 0.25),
           k = sqrt(GRAVITY / SURFACE_TENSION_OVER_DENSITY);
    assert_near(wave_omega(k, ENDLESS) / k, slowest, 1e-12); /* 0.23 m/s */
    assert_near(wave_stretch(0.1, 10.0), 1.0 / tanh(1.0), 1e-12);
    assert_near(wave_stretch(100.0, 10.0), 1.0, 0.0);
}

/* ---- slopes ---- */

static double slopes_below(const sea_state *s, double k)
{
    sea_moments m = sea_state_moments(s, 0.0, k);
    return m.slope[0] + m.slope[1];
}

static void slopes_are_those_of_the_table(void **state)
{
    (void)state;
    static const double expected[7][3] = {
        {3.0, 0.0079, 0.0202},  {5.0, 0.0129, 0.0253},  {7.5, 0.0169, 0.0293}, {10.0, 0.0198, 0.0325},
        {12.5, 0.0226, 0.0366}, {15.0, 0.0253, 0.0404}, {20.0, 0.0300, 0.0472}};
    for (int i = 0; i < 7; i++) {
        facet_sea_desc d = sea_default();
        d.wind_mps = (float)expected[i][0];
        d.fetch_m = 100e3f;
        sea_state s = bare_state(d);
        assert_near(slopes_below(&s, TWO_PI), expected[i][1], 0.00011); /* waves above 1 m */
        assert_near(slopes_below(&s, 78.0), expected[i][2], 0.01 * expected[i][2]);
        if (expected[i][0] == 10.0) {
            sea_moments m = sea_state_moments(&s, 0.0, 78.0);
            assert_near(m.slope[0], 0.01744, 0.0001); /* along the wind */
            assert_near(m.k, 0.049, 0.0005);          /* what crests that narrow take off the level */
            assert_near(m.slope[2], 0.0, 1e-9);
            assert_near(m.convergence, slopes_below(&s, 78.0), 1e-9); /* deep */
        }
    }
}

static void elfouhaily_has_capillary_waves(void **state)
{
    (void)state;
    static const double curvature[7][2] = {{3.0, 385.0},   {5.0, 1810.0},   {7.5, 3990.0},  {10.0, 6540.0},
                                           {12.5, 8530.0}, {15.0, 10160.0}, {20.0, 12770.0}};
    static const double slopes[3][3] = {
        {5.0, 0.0289, 0.0321}, {10.0, 0.0504, 0.0620}, {15.0, 0.0671, 0.0851}};
    facet_sea_desc d = sea_default();
    d.spectrum = FACET_SEA_SPECTRUM_ELFOUHAILY;
    for (int i = 0; i < 7; i++) {
        d.wind_mps = (float)curvature[i][0];
        sea_state s = bare_state(d);
        assert_near(sea_state_moments(&s, 0.0, 3000.0).k4, curvature[i][1], 0.005 * curvature[i][1]);
    }
    for (int i = 0; i < 3; i++) {
        d.wind_mps = (float)slopes[i][0];
        sea_state s = bare_state(d);
        assert_near(slopes_below(&s, 370.0), slopes[i][1], 0.0001);
        assert_near(slopes_below(&s, 2000.0), slopes[i][2], 0.0001);
    }
}

static void seas_turn_with_their_wind(void **state)
{
    (void)state;
    facet_sea_desc d = sea_default();
    sea_state along_x = state_of(d);
    d.wind_direction_rad = 0.7f;
    sea_state turned = state_of(d);
    assert_near(sea_density(&turned, cos(0.9), sin(0.9)), sea_density(&along_x, cos(0.2), sin(0.2)), 1e-7);
    sea_moments a = sea_state_moments(&along_x, 0.0, 78.0), b = sea_state_moments(&turned, 0.0, 78.0);
    double c = cos(0.7), s = sin(0.7);
    assert_near(b.slope[0], c * c * a.slope[0] + s * s * a.slope[1], 1e-7);
    assert_near(b.slope[2], c * s * (a.slope[0] - a.slope[1]), 1e-7);
}

static void light_airs_are_no_steeper_than_seen(void **state)
{
    (void)state;
    static const float winds[6] = {0.5f, 1.0f, 2.0f, 2.5f, 3.0f, 5.0f};
    for (int i = 0; i < 6; i++) {
        facet_sea_desc d = sea_default();
        d.wind_mps = winds[i];
        sea_state s = state_of(d), bare = bare_state(d);
        double seen[2];
        cox_munk_slopes((double)winds[i], seen);
        double end = s.bands.k_to[s.bands.count - 1];
        assert_near(slopes_below(&s, end), 0.9 * (seen[0] + seen[1]), 1e-5);
        double height = sqrt(sea_state_moments(&s, 0.0, ENDLESS).height);
        double all = sqrt(sea_state_moments(&bare, 0.0, ENDLESS).height);
        assert_true(height > (winds[i] < 1.0f ? 0.9 : winds[i] < 2.0f ? 0.97 : 0.995) * all);
    }
    assert_true(wind_state(10.0f, 100e3f).taper == 1.0);
}

static void measured_laws_have_their_numbers(void **state)
{
    (void)state;
    static const double slopes[6][3] = {{2.0, 0.0063, 0.0068},  {5.0, 0.0158, 0.0126},
                                        {7.5, 0.0237, 0.0174},  {10.0, 0.0316, 0.0222},
                                        {15.0, 0.0474, 0.0318}, {20.0, 0.0632, 0.0414}};
    for (int i = 0; i < 6; i++) {
        double out[2];
        cox_munk_slopes(slopes[i][0], out);
        assert_near(out[0] + out[1], 0.003 + 5.12e-3 * slopes[i][0], 1e-12);
        assert_near(out[0], slopes[i][1],
                    0.01 * slopes[i][1] + 5e-5); /* the pair is scaled to the sum; rounded */
        assert_near(out[1], slopes[i][2], 0.01 * slopes[i][2] + 5e-5);
    }
    double calm[2];
    cox_munk_slopes(0.0, calm);
    assert_true(calm[0] == 0.0 && calm[1] == 0.0);
    static const double coverage[6][2] = {{5.0, 9.3e-4},  {7.5, 3.7e-3},  {10.0, 9.9e-3},
                                          {12.5, 2.1e-2}, {15.0, 3.9e-2}, {20.0, 0.105}};
    for (int i = 0; i < 6; i++)
        assert_near(whitecap_coverage(coverage[i][0]), coverage[i][1], 0.02 * coverage[i][1]);
    assert_true(whitecap_coverage(3.7) == 0.0 &&
                whitecap_coverage(3.8) > 0.0); /* onset: Callaghan et al. 2008 */
    assert_true(whitecap_coverage(3.8) < whitecap_coverage(4.0) && whitecap_coverage(4.0) < 1e-4);
    assert_true(whitecap_coverage(0.0) == 0.0 && whitecap_coverage(40.0) == 0.9);
}

/* ---- bands ---- */

static void bands_are_disjoint_and_complete(void **state)
{
    (void)state;
    sea_bands b = sea_bands_make(TWO_PI / 60.64, 256, 3); /* 10 m/s over 100 km */
    assert_int_equal(b.count, 3);
    assert_near(b.length_m[0], 485.1, 0.1);
    assert_near(b.length_m[1], 49.8, 0.05);
    assert_near(b.length_m[2], 5.11, 0.005);
    assert_near(b.k_to[0], 0.757, 0.0005);
    assert_near(b.k_to[2], 78.7, 0.05);
    for (uint32_t size = 32; size <= 1024; size *= 2)
        for (uint32_t count = 1; count <= 4; count++) {
            b = sea_bands_make(0.1, size, count);
            assert_true(b.k_from[0] == 0.0);
            for (uint32_t i = 0; i < b.count; i++) {
                assert_true(b.k_from[i] < b.k_to[i]);
                assert_true(b.k_to[i] <= TWO_PI * size / (4.0 * b.length_m[i]) * (1.0 + 1e-12));
                if (i)
                    assert_true(b.k_from[i] == b.k_to[i - 1]);
            }
        }
    assert_int_equal(sea_bands_make(0.0, 256, 3).count, 0);
}

/* ---- what is refused ---- */

static void numbers_out_of_range_are_named(void **state)
{
    (void)state;
    struct {
        const char *word;
        facet_sea_desc d;
    } cases[18];
    for (int i = 0; i < 18; i++)
        cases[i].d = sea_default();
    int n = 0;
    cases[n].word = "wind", cases[n++].d.wind_mps = 41.0f;
    cases[n].word = "wind", cases[n++].d.wind_mps = NAN;
    cases[n].word = "wind", cases[n++].d.wind_direction_rad = INFINITY;
    cases[n].word = "fetch", cases[n++].d.fetch_m = 99.0f;
    cases[n].word = "peakedness", cases[n++].d.peakedness = 0.0f;
    cases[n].word = "spectrum", cases[n++].d.spectrum = (facet_sea_spectrum)7;
    cases[n].word = "choppiness", cases[n++].d.choppiness = -0.1f;
    cases[n].word = "loop", cases[n++].d.loop_s = -1.0;
    cases[n].word = "loop", cases[n++].d.loop_s = 0.09;
    cases[n].word = "loop", cases[n++].d.loop_s = 1e-300;
    cases[n].word = "loop", cases[n++].d.loop_s = 2e6;
    cases[n].word = "resolution", cases[n++].d.resolution = 100;
    cases[n].word = "cascades", cases[n++].d.cascade_count = 5;
    cases[n].word = "bed", cases[n++].d.bed.depth_m = -1.0f;
    cases[n].word = "bed", cases[n].d.bed.depth_m = 1.0f, cases[n++].d.bed.slope = 2.0f;
    cases[n].word = "swell", cases[n++].d.swell.height_m = 31.0f;
    cases[n].word = "swell", cases[n++].d.swell.height_m = 1.0f; /* without a period */
    cases[n].word = "at most 2 m", cases[n++].d.swell = (facet_swell){.height_m = 2.1f, .period_s = 3.0f};
    for (int i = 0; i < n; i++) {
        sea_state s;
        facet_error error;
        assert_int_equal(sea_state_create(&cases[i].d, &s, &error), FACET_ERROR_ARGUMENT);
        assert_non_null(strstr(error.message, cases[i].word));
    }
}

static void presets_are_seas(void **state)
{
    (void)state;
    static const double expected[][2] = {{1, 0.561}, {2, 2.244}, {3, 8.978}}; /* breeze, trade wind, gale */
    for (uint32_t i = 0; i < sea_preset_count(); i++) {
        facet_sea_desc d;
        assert_int_equal(sea_preset(sea_preset_name(i), &d, NULL), FACET_OK);
        state_of(d);
    }
    for (size_t i = 0; i < 3; i++) {
        facet_sea_desc d;
        assert_int_equal(sea_preset(sea_preset_name((uint32_t)expected[i][0]), &d, NULL), FACET_OK);
        sea_state s = state_of(d);
        assert_near(height_of(&s), expected[i][1], 0.002 * expected[i][1]);
    }
    assert_null(sea_preset_name(sea_preset_count()));
    facet_sea_desc d;
    facet_error error;
    assert_int_equal(sea_preset("storm", &d, &error), FACET_ERROR_ARGUMENT);
    assert_non_null(strstr(error.message, "trade-wind"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(jonswap_has_the_heights_of_the_table),
                                       cmocka_unit_test(growth_ends_without_a_step),
                                       cmocka_unit_test(depth_lowers_waves),
                                       cmocka_unit_test(waves_break_where_the_bed_is_near),
                                       cmocka_unit_test(other_spectra_have_their_heights),
                                       cmocka_unit_test(swell_is_as_high_as_asked),
                                       cmocka_unit_test(directions_sum_to_one),
                                       cmocka_unit_test(elongation_is_for_long_waves),
                                       cmocka_unit_test(dispersion_is_inverted_and_derived),
                                       cmocka_unit_test(slopes_are_those_of_the_table),
                                       cmocka_unit_test(elfouhaily_has_capillary_waves),
                                       cmocka_unit_test(seas_turn_with_their_wind),
                                       cmocka_unit_test(light_airs_are_no_steeper_than_seen),
                                       cmocka_unit_test(measured_laws_have_their_numbers),
                                       cmocka_unit_test(bands_are_disjoint_and_complete),
                                       cmocka_unit_test(numbers_out_of_range_are_named),
                                       cmocka_unit_test(presets_are_seas)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
