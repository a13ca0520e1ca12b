/* layers_lobes_test.c - single lobes add up to the whole, for punctual lights and for environments, and
 * each is 0 without its layer. */
#include "testing/layer_albedo.h"
#include "testing/nasty_layers.h"

enum { ALL_LAYERS = 512 };

static vec3 upper(test_rng *rng)
{
    vec3 d = rng_direction(rng);
    d[2] = max(fabsf(d[2]), 0.02f);
    return normalize(d);
}

static LayerLight random_light(test_rng *rng)
{
    LayerLight light = layer_light_of(rng_color(rng));
    light.irradiance_over_pi = rng_color(rng);
    light.irradiance_back_over_pi = rng_color(rng);
    light.clearcoat = rng_color(rng);
    light.sheen = rng_color(rng);
    light.transmitted = rng_color(rng);
    return light;
}

static LayerTables some_tables(Layers m, vec3 V, int energy)
{
    return layer_tables(m, V, energy, vec2(0.7f, 0.1f), 0.9f, 0.8f, 0.3f, vec3(0.2f, 0.95f, 0.9f));
}

static void expect_sum(vec3 sum, vec3 whole, float largest, const char *what)
{
    for (int c = 0; c < 3; ++c)
        expect_near((double)sum[c], (double)whole[c], 1e-5 * (1.0 + (double)largest), "%s, channel %d", what,
                    c);
}

static void test_lobes_add_up(void **state)
{
    (void)state;
    for (uint layers = 0; layers < ALL_LAYERS; layers += 1) {
        test_rng rng = {layers};
        for (int i = 0; i < 12; ++i) {
            int energy = i % 2 ? ENERGY_GLTF : ENERGY_CONSERVING;
            vec3 V = upper(&rng);
            vec3 L = upper(&rng) * (i % 3 ? 1.0f : -1.0f);
            Layers m = random_layers(&rng, layers, vec3(0.0f, 0.0f, 1.0f), false);
            LayerTables t = some_tables(m, V, energy);
            LayerLight light = random_light(&rng);
            Light punctual = light_point(L * 2.0f, vec3(5.0f), 0.0f);
            vec3 from_light = vec3(0.0f), from_punctual = vec3(0.0f);
            float largest = 0.0f;
            for (int lobe = ALONE_DIFFUSE; lobe <= ALONE_TRANSMISSION; ++lobe) {
                from_light += layers_ibl_alone(m, V, t, light, energy, lobe);
                vec3 alone = layers_punctual_alone(m, vec3(0.0f), V, punctual, energy, t, 0.4f, lobe);
                from_punctual += alone;
                largest = max(largest, max3(alone));
            }
            expect_sum(from_light, layers_ibl(m, V, t, light, energy), 1.0f, "surroundings");
            expect_sum(from_punctual, layers_punctual(m, vec3(0.0f), V, punctual, energy, t, 0.4f), largest,
                       "punctual");
        }
    }
}

static void expect_nothing(vec3 v)
{
    assert_true(v[0] == 0.0f && v[1] == 0.0f && v[2] == 0.0f);
}

/* Missing layers contribute nothing; a black base has no diffuse light, and the same highlight. */
static void test_absent_lobes_are_black(void **state)
{
    (void)state;
    test_rng rng = {7};
    for (int i = 0; i < 2000; ++i) {
        int energy = i % 2 ? ENERGY_GLTF : ENERGY_CONSERVING;
        vec3 V = upper(&rng), L = upper(&rng);
        Layers m = random_layers(&rng, 0u, vec3(0.0f, 0.0f, 1.0f), false);
        LayerTables t = some_tables(m, V, energy);
        LayerLight light = random_light(&rng);
        for (int lobe = ALONE_CLEARCOAT; lobe <= ALONE_TRANSMISSION; ++lobe) {
            expect_nothing(layers_ibl_alone(m, V, t, light, energy, lobe));
            expect_nothing(layers_brdf_cos_alone(m, V, L, energy, t, 0.4f, lobe));
        }
        SurfaceLobes lobes = surface_lobes_cos(m.base, V, L, energy, t.dfg);
        float largest = max3(lobes.specular);
        expect_sum(layers_brdf_cos_alone(m, V, L, energy, t, 0.4f, ALONE_SPECULAR), lobes.specular, largest,
                   "specular");
        expect_sum(layers_brdf_cos_alone(m, V, L, energy, t, 0.4f, ALONE_DIFFUSE), lobes.diffuse, largest,
                   "diffuse");
    }
}

/* Smooth surfaces mask nothing in either formula; Schlick's with k = alpha / 2 masks more at grazing
 * angles of rough ones. */
static void test_schlick_GGX(void **state)
{
    (void)state;
    expect_near((double)schlick_GGX_over_smith(0.5f, 0.7f, 1e-3f), 1.0, 1e-3, "smooth");
    for (int i = 1; i <= 10; ++i) {
        float alpha = 0.1f * (float)i;
        double k = 0.5 * (double)alpha, l = 0.3, v = 0.6, a2 = (double)alpha * (double)alpha;
        double schlick = 0.25 / ((l * (1.0 - k) + k) * (v * (1.0 - k) + k));
        double smith = 0.5 / (l * sqrt(v * v * (1.0 - a2) + a2) + v * sqrt(l * l * (1.0 - a2) + a2));
        expect_relative(schlick_GGX_over_smith(0.3f, 0.6f, alpha), schlick / smith, 1e-5, "alpha %g",
                        (double)alpha);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_lobes_add_up),
                                       cmocka_unit_test(test_absent_lobes_are_black),
                                       cmocka_unit_test(test_schlick_GGX)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
