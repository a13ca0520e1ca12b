/* water_air_test.c - aerial perspective in front of the sea: the compact tables against the view that they
 * are computed from. */
#include "water/water_fixture.h"

#include "water/water_sky.h"

static void make_sky(float elevation_rad, float azimuth_rad, float lux, float eye_m, water_sky *sky)
{
    facet_render_desc d = {
        .sky = {.sun_elevation_rad = elevation_rad, .sun_azimuth_rad = azimuth_rad, .illuminance_lux = lux}};
    d.thread_count = 2;
    facet_error error;
    if (water_sky_create(&d, eye_m, 1000.0f, sky, &error) != FACET_OK)
        fail_msg("%s", error.message);
}

static vec3 downwards(double angle, double longitude)
{
    double level = sin(angle);
    return vec3((float)(level * cos(longitude)), (float)cos(angle), (float)(level * sin(longitude)));
}

/* The sky's radiance over black ground, by ray marching. */
static void march_view(const water_sky *sky, float elevation_rad, sky_view *view)
{
    sky_luts dark = sky->tables;
    for (int half = 0; half < SKY_HALVES; half++)
        dark.air[half].ground_albedo = vec3(0.0f);
    const facet_allocator allocator = {0};
    assert_int_equal(sky_view_create(&dark, sky->eye_km, elevation_rad, &allocator, 2, view, NULL), FACET_OK);
}

/* Over the whole distance to sea level it equals ray marching, within 1 %: from the waves' height to
 * that of airliners, sun from the horizon to the zenith. The first row is the horizon itself, whose distance
 * exceeds the precision of floats. */
static void in_scattering_matches_ray_marching(void **state)
{
    (void)state;
    const float elevations[] = {0.02f, 0.35f, 1.2f}, eyes_m[] = {3.0f, 300.0f, 10000.0f};
    for (int k = 0; k < 9; k++) {
        water_sky sky;
        sky_view view;
        make_sky(elevations[k % 3], 2.0f, k == 4 ? 1000.0f : 0.0f, eyes_m[k / 3], &sky);
        march_view(&sky, elevations[k % 3], &view);
        for (int i = 1; i < SKY_VIEW_DOWN - 1; i++)
            for (int a = 0; a < 40; a++) {
                float angle = sky_view_zenith_angle(sky.eye_km, -(float)i / (SKY_VIEW_DOWN - 1));
                vec3 d = downwards((double)angle, 0.1 + 0.157 * a);
                vec3 marched = water_sky_view(&sky, &view, d, 0.0f, PI);
                float way_m = 1000.0f * ray_to_ground(sky.eye_km, d[1]);
                assert_true(way_m > 0.0f);
                water_air air = water_sky_air(&sky, d, way_m, 0.0f);
                for (int c = 0; c < 3; c++)
                    if (fabs((double)(air.light[c] - marched[c])) > 0.01 * (double)marched[c])
                        fail_msg("%g m high, sun at %g, row %d, column %d, channel %d: %g, not %g",
                                 (double)eyes_m[k / 3], (double)elevations[k % 3], i, a, c,
                                 (double)air.light[c], (double)marched[c]);
            }
        sky_view_destroy(&view);
        water_sky_destroy(&sky);
    }
}

/* Over half of the distance the in-scattered share equals the attenuated one; over none both are 0. */
static void air_in_scatters_in_proportion_to_its_opacity(void **state)
{
    (void)state;
    water_sky sky;
    make_sky(0.5f, 1.0f, 0.0f, 20.0f, &sky);
    vec3 d = downwards(1.6, 0.4);
    water_air all = water_sky_air(&sky, d, 2000.0f, 0.0f), half = water_sky_air(&sky, d, 1000.0f, 0.0f),
              none = water_sky_air(&sky, d, 0.0f, 0.0f);
    for (int c = 0; c < 3; c++) {
        double lost = 1.0 - (double)all.transmittance[c], first = 1.0 - (double)half.transmittance[c];
        assert_true(lost > 0.0 && fabs((double)(half.light[c] / all.light[c]) - first / lost) < 1e-3);
        assert_true(none.light[c] == 0.0f && none.transmittance[c] == 1.0f);
    }
    /* What is left is looked up for the sea and computed for what is above it, be it by a micrometre. */
    for (float way_m = 1.0f; way_m < 1e6f; way_m *= 1.37f) {
        vec3 sea = water_sky_air(&sky, d, way_m, 0.0f).transmittance,
             above = water_sky_air(&sky, d, way_m, 1e-6f).transmittance;
        for (int c = 0; c < 3; c++) {
            double lost = 1.0 - (double)above[c];
            if (fabs((double)(above[c] - sea[c])) > 2e-3 * lost + 2e-7)
                fail_msg("%g m, channel %d: %g, not %g", (double)way_m, c, (double)sea[c], (double)above[c]);
        }
    }
    water_sky_destroy(&sky);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(in_scattering_matches_ray_marching),
                                       cmocka_unit_test(air_in_scatters_in_proportion_to_its_opacity)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
