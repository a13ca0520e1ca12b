/* sky_test.c - Preetham's model against the reference, and the parts of the atmosphere against integrals in
 * double. Their result as a whole: src/ibl/sky_test.c. */
#include "testing/test_support.h"

static const double degree = 0.017453292519943295;

/* ---- Preetham ---- */

/* Preetham et al. 1999: turbidity 2.5, sun 45 degrees from the zenith. */
static void test_preetham_values(void **state)
{
    (void)state;
    PreethamSky s = preetham_sky(2.5f, (float)(45.0 * degree));
    vec3 at = preetham_Yxy(s, (float)cos(60.0 * degree), (float)cos(30.0 * degree));
    expect_relative(at[0], 13621.81244, 2e-5, "Y");
    expect_relative(at[1], 0.26527729, 1e-5, "x");
    expect_relative(at[2], 0.27215950, 1e-5, "y");
    vec3 zenith = preetham_zenith(2.5f, (float)(45.0 * degree));
    expect_relative(zenith[0], 5916.11348, 1e-5, "Y of the zenith");
    expect_relative(zenith[1], 0.24328199, 1e-5, "x of the zenith");
    expect_relative(zenith[2], 0.24758447, 1e-5, "y of the zenith");
    vec3 same = preetham_Yxy(s, 1.0f, (float)cos(45.0 * degree));
    for (int i = 0; i < 3; i++)
        expect_relative(same[i], (double)zenith[i], 1e-6, "the formula at the zenith");
}

static void test_preetham_color(void **state)
{
    (void)state;
    vec3 white = rec709_from_Yxy(vec3(100.0f, 0.3127f, 0.3290f)); /* D65 */
    for (int i = 0; i < 3; i++)
        expect_near((double)white[i], 100.0, 0.05, "white");
    PreethamSky s = preetham_sky(2.5f, (float)(45.0 * degree));
    vec3 at = preetham_radiance(s, 0.5f, 0.8660254f);
    expect_relative(luminance(at), 13621.81244, 1e-4, "luminance survives");
    assert_true(at[2] > at[1] && at[1] > at[0]); /* blue */
    for (int t = 0; t <= 10; t++)                /* no color is below 0, no number lost */
        for (int sun = 0; sun <= 90; sun += 10)
            for (int d = 0; d < 50; d++) {
                PreethamSky any = preetham_sky(1.7f + 0.83f * (float)t, (float)(sun * degree));
                vec3 L = preetham_radiance(any, (float)d / 49.0f, 2.0f * fract((float)d * 0.618f) - 1.0f);
                assert_true(is_finite3(L) && L[0] >= 0.0f && L[1] >= 0.0f && L[2] >= 0.0f);
            }
}

/* The formulas of the paper, evaluated in double by another program. */
static void test_preetham_sun(void **state)
{
    (void)state;
    static const double golden[3][5] = {
        {2.5, 45, 0.7672922543339866, 0.6832989195894323, 0.5763290493766111},
        {6, 80, 0.0739894199353317, 0.034833101672848525, 0.009918869574987041},
        {1.7, 90, 0.010874976122710576, 8.435962866181779e-4, 2.47139608369994e-05}};
    Atmosphere a = atmosphere_earth(SKY_BANDS_FIRST);
    for (int i = 0; i < 3; i++) {
        vec3 T = preetham_sun(a, (float)golden[i][0], (float)(golden[i][1] * degree));
        for (int c = 0; c < 3; c++)
            expect_relative(T[c], golden[i][2 + c], 5e-5, "%d, channel %d", i, c);
    }
}

/* ---- optical properties of air ---- */

/* Constants of Bruneton and Hillaire: 5.802, 13.558, 33.1 e-3 / km at 680, 550, 440 nm. */
static void test_constants(void **state)
{
    (void)state;
    for (int bands = 0; bands < 3; bands++) {
        Atmosphere a = atmosphere_earth(bands);
        for (int c = 0; c < 3; c++) {
            double um = (double)a.wavelength_nm[c] * 1e-3;
            expect_relative(a.rayleigh[c], 13.558e-3 * pow(0.55 / um, 4.0), 1e-3, "Rayleigh");
            expect_relative(a.haze_extinction[c], 0.06 / 1.2 * pow(um / 0.55, -0.6), 1e-5, "haze");
            expect_relative(a.haze_scattering[c] / a.haze_extinction[c], 0.98, 1e-5, "its albedo");
        }
    }
    vec3 three = atmosphere_color(atmosphere_earth(SKY_BANDS_THREE), vec3(1.0f));
    vec3 six = atmosphere_color(atmosphere_earth(SKY_BANDS_FIRST), vec3(1.0f)) +
               atmosphere_color(atmosphere_earth(SKY_BANDS_SECOND), vec3(1.0f));
    /* 132.6 klx of (1.092, 0.977, 0.959) outside the air */
    static const double sun[3] = {1.092, 0.977, 0.958};
    for (int c = 0; c < 3; c++)
        expect_relative(six[c], 132600.0 * sun[c], 1e-3, "sunlight, channel %d", c);
    expect_relative(luminance(six), 132600.0, 1e-3, "sunlight");
    expect_relative(luminance(three), 132600.0, 1e-2, "by three wavelengths");
    expect_near((double)haze_depth_from_turbidity(1.0f), 0.0, 0.0, "no haze");
    expect_near((double)haze_depth_from_turbidity(2.0f), 8.0 * 13.558e-3, 1e-4, "as much as molecules");
}

static void test_phase(void **state)
{
    (void)state;
    double sum = 0.0, P2 = 0.0;
    for (int i = 0; i < 1000; i++) {
        double c = -1.0 + (i + 0.5) / 500.0;
        double share = (double)phase_rayleigh((float)c) * 2.0 * 3.14159265358979 / 500.0;
        sum += share;
        P2 += share * (double)legendre_P2((float)c);
    }
    expect_near(sum, 1.0, 1e-5, "integral");
    expect_near(P2, 0.1, 1e-5, "the moment that air_field_rayleigh() builds on");
}

/* Columns by 400 000 steps in double. */
static void test_columns(void **state)
{
    (void)state;
    static const double golden[5][5] = {
        {0, 1, 7.999970186448793, 1.1999999978294802, 14.999999999999996},
        {0, 0.1, 72.46848951472147, 11.787477475255148, 113.12342014454534},
        {0, 0, 282.838135072932, 109.49892230577143, 173.95456569836716},
        {2, -0.02, 368.5708546845355, 110.76939528465066, 176.84044844720833},
        {30, 0.3, 0.6194225601092522, 5.544694731519544e-11, 11.053257648443198}};
    for (int i = 0; i < 5; i++) {
        vec3 fine = air_column((float)golden[i][0], (float)golden[i][1], 400);
        vec3 table = air_column((float)golden[i][0], (float)golden[i][1], 64); /* as tables have it */
        for (int c = 0; c < 3; c++) {
            expect_near((double)fine[c], golden[i][2 + c], 2e-4 * golden[i][2 + c] + 1e-6, "%d, column %d", i,
                        c);
            expect_near((double)table[c], golden[i][2 + c], 4e-3 * golden[i][2 + c] + 1e-6, "%d, column %d",
                        i, c);
        }
    }
}

static void test_rays(void **state)
{
    (void)state;
    const double R = 6360.0;
    test_rng rng = {7};
    for (int i = 0; i < 20000; ++i) {
        float h = 100.0f * rng_float(&rng) * rng_float(&rng), mu = 2.0f * rng_float(&rng) - 1.0f;
        double r = R + (double)h, t = 500.0 * (double)rng_float(&rng);
        double there = sqrt(r * r + 2.0 * r * (double)mu * t + t * t);
        if (there > R)
            expect_near((double)ray_height(h, mu, (float)t), there - R, 2e-4 + 1e-5 * there * 0.1, "height");
        double to_top = (double)ray_to_top(h, mu);
        expect_near(sqrt(r * r + 2.0 * r * (double)mu * to_top + to_top * to_top), R + 100.0, 2e-2, "top");
        double to_ground = (double)ray_to_ground(h, mu);
        if (to_ground >= 0.0)
            expect_near(sqrt(r * r + 2.0 * r * (double)mu * to_ground + to_ground * to_ground), R, 2e-2,
                        "ground");
        bool is_below = mu < horizon_mu(h);
        if (fabsf(mu - horizon_mu(h)) > 1e-6f)
            assert_true(is_below == (to_ground >= 0.0));
    }
    /* the disc of the sun sets within its diameter, at any height */
    for (int h = 0; h <= 50; h += 10) {
        double horizon = asin((double)horizon_mu((float)h)), radius = (double)SUN_RADIUS;
        assert_true(sun_visibility((float)h, (float)sin(horizon + 1.1 * radius)) == 1.0f);
        assert_true(sun_visibility((float)h, (float)sin(horizon - 1.1 * radius)) == 0.0f);
        expect_near((double)sun_visibility((float)h, (float)sin(horizon)), 0.5, 0.01, "half of it");
    }
    expect_near((double)SUN_SOLID_ANGLE, 2.0 * 3.14159265358979 * (1.0 - cos((double)SUN_RADIUS)), 2e-9,
                "sr");
}

/* LUT coordinates are inverted exactly, and texels reach the ends. */
static void test_tables(void **state)
{
    (void)state;
    test_rng rng = {9};
    for (int i = 0; i < 10000; ++i) {
        float h = 100.0f * rng_float(&rng) * rng_float(&rng);
        float mu = horizon_mu(h) + (1.0f - horizon_mu(h)) * rng_float(&rng);
        vec2 back = column_table_ray(column_table_place(h, mu));
        expect_near((double)back[0], (double)h, 1e-3 + 1e-4 * (double)h, "height");
        expect_near((double)back[1], (double)mu, 1e-3, "mu");
        float mu_sun = 2.0f * rng_float(&rng) - 1.0f;
        back = bounce_table_ray(bounce_table_place(h, mu_sun));
        expect_near((double)back[0], (double)h, 1e-4, "height");
        expect_near((double)back[1], (double)mu_sun, 1e-5, "sun");
        float v = 2.0f * rng_float(&rng) - 1.0f;
        expect_near((double)sky_view_row(0.5f * h, sky_view_zenith_angle(0.5f * h, v)), (double)v, 2e-3,
                    "row");
    }
    vec2 corner = column_table_place(0.0f, 1.0f);
    expect_near((double)corner[0] * 256.0, 0.5, 1e-3, "straight up is in the middle of the first texel");
    expect_near((double)corner[1] * 64.0, 0.5, 1e-3, "and the ground");
    corner = column_table_place(0.0f, -0.5f); /* below the horizon: the horizon's */
    expect_near((double)corner[0] * 256.0, 255.5, 1e-3, "the horizon in that of the last");
}

/* ---- light along a ray ---- */

/* A step through air of any density attenuates and scatters like the integral; many thin steps equal one
 * thick one. */
static void test_steps(void **state)
{
    (void)state;
    for (int i = -8; i <= 4; i++) {
        double x = pow(10.0, i);
        expect_relative(air_path1((float)x, 1.0f), (1.0 - exp(-x)) / x, i < -5 ? 1e-6 + x : 2e-5, "depth %g",
                        x);
    }
    Atmosphere a = atmosphere_earth(SKY_BANDS_THREE);
    AirField field = air_field(vec3(0.02f), vec3(-0.004f), vec3(0.003f), vec3(0.006f));
    vec3 density = air_density(0.5f), sun = vec3(0.8f, 0.7f, 0.6f);
    AirLight once = air_light_step(a, air_light_none(), density, 50.0f, sun, field, 0.2f, 0.7f);
    AirLight often = air_light_none();
    for (int i = 0; i < 100; i++)
        often = air_light_step(a, often, density, 0.5f, sun, field, 0.2f, 0.7f);
    for (int c = 0; c < 3; c++) {
        expect_relative(often.rayleigh[c], (double)once.rayleigh[c], 1e-4, "molecules");
        expect_relative(often.haze[c], (double)once.haze[c], 1e-4, "haze");
        expect_relative(often.multiple[c], (double)once.multiple[c], 1e-4, "multiple");
        expect_relative(often.transmittance[c], (double)once.transmittance[c], 1e-4, "transmittance");
    }
}

/* Columns and rows of maps are inverted exactly; both are monotonic, and angles between neighbors stay small. */
static void test_maps(void **state)
{
    (void)state;
    const int n = 512;
    double widest = 0.0, tallest = 0.0, last_angle = -1.0;
    for (int i = 0; i < n; i++) {
        float turn = ((float)i + 0.5f) / (float)n;
        vec2 d = sky_turned(turn), next = sky_turned(((float)((i + 1) % n) + 0.5f) / (float)n);
        expect_near((double)(d[0] * d[0] + d[1] * d[1]), 1.0, 1e-6, "unit");
        expect_near((double)sky_turn(3.0f * d[0], 3.0f * d[1]), (double)turn, 1e-6, "column %d", i);
        double angle = (atan2)((double)d[1], (double)d[0]);
        angle += angle < 0.0 ? 6.283185307179586 : 0.0;
        assert_true(angle > last_angle);
        last_angle = angle;
        widest = fmax(widest, acos(fmin((double)dot(d, next), 1.0)));
    }
    assert_true(widest < 1.28 * 6.283185307179586 / n);
    double last = 0.0;
    for (int i = 1; i <= 128; i++) {
        float row = (float)i / 128.0f, h = sky_rise(row);
        double angle = asin(fmin((double)h, 1.0));
        expect_near((double)sky_row(h), (double)row, i < 128 ? 2e-5 : 1e-3, "row %d", i);
        tallest = fmax(tallest, angle - last);
        assert_true(angle > last);
        last = angle;
    }
    assert_true(tallest < 0.03); /* of evenly spaced squares: 0.025, at the zenith */
    expect_near((double)sky_rise(0.0f), 0.0, 0.0, "the horizon");
    expect_near((double)sky_rise(1.0f), 1.0, 0.0, "the zenith");
    expect_near((double)sky_row(-0.1f), 0.0, 0.0, "below");
    assert_true(sky_turn(0.0f, 0.0f) >= 0.0f && sky_turn(0.0f, 0.0f) <= 1.0f);
}

/* Without absorption and in uniform light, the sky has the radiance of that light. */
static void test_closed_box(void **state)
{
    (void)state;
    Atmosphere a = atmosphere_with_haze(atmosphere_earth(SKY_BANDS_THREE), 0.3f, 1.0f, 1.0f, 0.76f);
    a.ozone = vec3(0.0f);
    AirField field = air_field_even(vec3(1.0f));
    AirLight s = air_light_none();
    for (int i = 0; i < 50; i++)
        s = air_light_step(a, s, air_density(0.1f * (float)i), 3.0f, vec3(0.0f), field, 0.5f, 0.5f);
    for (int c = 0; c < 3; c++)
        expect_near((double)(s.multiple[c] + s.transmittance[c]), 1.0, 1e-5, "channel %d", c);
    AirBounce b = air_bounce_none();
    b.again = vec3(0.5f);
    b.once = air_field_even(vec3(1.0f));
    assert_true(air_bounce_field(b).mean[0] == 2.0f); /* 1 + 1/2 + 1/4 .. */
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_preetham_values),
                                       cmocka_unit_test(test_preetham_color),
                                       cmocka_unit_test(test_preetham_sun),
                                       cmocka_unit_test(test_constants),
                                       cmocka_unit_test(test_phase),
                                       cmocka_unit_test(test_columns),
                                       cmocka_unit_test(test_rays),
                                       cmocka_unit_test(test_tables),
                                       cmocka_unit_test(test_steps),
                                       cmocka_unit_test(test_maps),
                                       cmocka_unit_test(test_closed_box)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
