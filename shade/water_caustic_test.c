/* water_caustic_test.c - sunlight on a bed: fractions and their limits, footprints on the bed, lookups in
 * layers. */
#include "testing/test_support.h"

static Water some_water(void)
{
    return (Water){.ior = 1.34f,
                   .absorption = vec3(0.33f, 0.06f, 0.02f),
                   .scattering = vec3(0.09f, 0.11f, 0.14f),
                   .backscattering = vec3(0.002f, 0.003f, 0.005f)};
}

/* The fraction is the beam's light over all light, each attenuated by itself; it decreases with depth. */
static void test_share(void **state)
{
    (void)state;
    Water w = some_water();
    vec3 down = vec3(9.0f, 8.0f, 7.0f), beam = vec3(8.0f, 6.0f, 4.0f);
    const float mu = 0.8f;
    vec3 last = vec3(1.0f);
    for (int i = 0; i < 40; i++) {
        float depth = 0.5f * (float)i;
        vec3 share = water_focused(w, vec3(0.0f), down, beam, mu, depth);
        for (int k = 0; k < 3; k++) {
            double c = (double)(w.absorption[k] + w.scattering[k]), a = (double)w.absorption[k];
            double K = (a + (double)w.backscattering[k]) / 0.86;
            double all = (double)down[k] * exp(-K * (double)depth);
            double straight = (double)(beam[k] * mu) * exp(-c * (double)depth / (double)mu);
            expect_near((double)share[k], straight / all, 1e-5, "channel %d at %g m", k, (double)depth);
            assert_true(share[k] <= last[k] && share[k] >= 0.0f);
        }
        last = share;
    }
    vec3 night = water_focused(w, vec3(0.0f), vec3(0.0f), vec3(0.0f), 0.7f, 3.0f),
         abyss = water_focused(w, vec3(0.0f), down, beam, mu, 1e6f);
    for (int k = 0; k < 3; k++) {
        expect_near((double)night[k], 0.0, 1e-9, "without light");
        expect_near((double)abyss[k], 0.0, 1e-9, "deep down");
    }
    vec3 pure = water_focused(w, vec3(0.0f), beam, beam, 1.0f, 0.0f);
    expect_near((double)pure[0], 1.0, 1e-6, "nothing but sun, just below the surface");
}

/* Unfocused light is unchanged; none is lost on average. */
static void test_lit(void **state)
{
    (void)state;
    vec3 share = vec3(0.0f, 0.4f, 1.0f);
    vec3 bright = water_bed_lit(share, 3.0f, 1.0f), dark = water_bed_lit(share, 0.0f, 1.0f);
    expect_near((double)bright[0], 1.0, 1e-6, "all of it diffuse");
    expect_near((double)bright[1], 1.8, 1e-6, "some of it");
    expect_near((double)dark[2], 0.0, 1e-6, "all of it focused");
    for (int k = 0; k < 3; k++)
        expect_near((double)(0.25f * bright[k] + 0.75f * water_bed_lit(share, 1.0f / 3.0f, 1.0f)[k]), 1.0,
                    1e-6, "mean");
}

/* Against refracted rays of tilted surfaces, by finite differences. */
static void test_footprint(void **state)
{
    (void)state;
    Water w = some_water();
    vec3 up = vec3(0.0f, 1.0f, 0.0f);
    const float path = 4.0f, variance = 1e-6f;
    for (int i = 0; i < 8; i++) {
        float angle = 0.18f * (float)i;
        vec3 V = vec3(sin(angle), cos(angle), 0.0f), down = water_refracted(w, -V, up);
        double depth = (double)(-path * down[1]), areas[2];
        for (int k = 0; k < 2; k++) {
            vec3 tilted = k ? vec3(0.0f, 1.0f, 1e-3f) : vec3(1e-3f, 1.0f, 0.0f);
            vec3 turned = water_refracted(w, -V, normalize(tilted));
            double x = depth * (double)(turned[0] / -turned[1] - down[0] / -down[1]) * 1e3;
            double z = depth * (double)(turned[2] / -turned[1] - down[2] / -down[1]) * 1e3;
            areas[k] = sqrt(x * x + z * z);
        }
        double expected = sqrt(12.0 * (double)variance * areas[0] * areas[1]);
        float width = water_bed_footprint(w, up, V, down, vec3(variance, variance, 0.0f), 0.0f, path);
        expect_near((double)width / expected, 1.0, 0.02, "at %g", (double)angle);
    }
    float width = water_bed_footprint(w, up, up, -up, vec3(0.0f), 0.3f, path);
    expect_near((double)width, 0.3, 1e-6, "flat water");
}

static void test_layers(void **state)
{
    (void)state;
    expect_near((double)caustic_cover(vec2(0.0f)), 1.0, 0.0, "the middle");
    expect_near((double)caustic_cover(vec2(0.79f, -0.7f)), 1.0, 0.0, "before the border");
    expect_near((double)caustic_cover(vec2(0.2f, -0.9f)), 0.5, 1e-5, "half way");
    expect_near((double)caustic_cover(vec2(0.2f, 1.0f)), 0.0, 0.0, "the border");
    expect_near((double)caustic_cover(vec2(1e6f, 0.0f)), 0.0, 0.0, "outside");
    expect_near((double)caustic_lod(0.1f), 0.0, 0.0, "within a texel");
    expect_near((double)caustic_lod(8.0f), 3.0, 1e-6, "eight texels");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_share),
        cmocka_unit_test(test_lit),
        cmocka_unit_test(test_footprint),
        cmocka_unit_test(test_layers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
