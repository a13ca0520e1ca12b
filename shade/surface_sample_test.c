/* surface_sample_test.c - the surface without layers beside layers_sample.h: the same values, densities and
 * directions. */
#include "testing/layer_albedo.h"

enum { COUNT = 20000 };

/* A material without layers; every fifth one with a specular lobe, every sixth one without a diffuse one. */
static Layers plain_layers(test_rng *rng)
{
    float roughness = rng_uint(rng) % 5u ? rng_float(rng) : 0.0f;
    float metallic = rng_uint(rng) % 6u ? rng_float(rng) : 1.0f;
    vec3 color = rng_color(rng);
    float specular = rng_float(rng);
    return layers_from_surface(surface_from_gltf(rng_direction(rng), color, metallic, roughness, 1.5f,
                                                 specular, vec3(1.0f), 1.0f, vec3(0.0f)));
}

static void assert_same_value(float x, float y)
{
    if (!(fabsf(x - y) <= 2e-5f * fmaxf(fabsf(y), 1e-3f)))
        fail_msg("%g, expected %g", (double)x, (double)y);
}

static void values_and_densities_are_those_of_layers(void **state)
{
    (void)state;
    test_rng rng = {3};
    for (int i = 0; i < COUNT; i++) {
        Layers m = plain_layers(&rng);
        vec3 V = rng_direction(&rng), L = rng_direction(&rng);
        int energy = i % 2 ? ENERGY_GLTF : ENERGY_CONSERVING;
        vec2 dfg = vec2(0.9f * rng_float(&rng), 0.1f * rng_float(&rng));
        LayerTables t = layer_tables(m, V, energy, dfg, 1.0f, 1.0f, 1.0f, vec3(0.0f));
        LayersLobes p = layers_lobes(m, V, energy, t);
        SurfaceLobesAtV at = surface_lobes_at(m.base, V, p.specular, p.diffuse, energy, dfg);
        SurfaceValue x = surface_value(m.base, at, L, energy);
        vec3 f = layers_scatter_cos(m, V, L, energy, t, 0.0f);
        for (int c = 0; c < 3; c++)
            assert_same_value(x.f[c], f[c]);
        assert_same_value(x.pdf, layers_pdf(m, p, V, L));
    }
}

static void directions_are_those_of_layers(void **state)
{
    (void)state;
    test_rng rng = {4};
    int drawn = 0;
    for (int i = 0; i < COUNT; i++) {
        Layers m = plain_layers(&rng);
        vec3 V = rng_direction(&rng);
        int energy = i % 2 ? ENERGY_GLTF : ENERGY_CONSERVING;
        LayerTables t = layer_tables(m, V, energy, vec2(0.9f, 0.05f), 1.0f, 1.0f, 1.0f, vec3(0.0f));
        LayersLobes p = layers_lobes(m, V, energy, t);
        SurfaceLobesAtV at = surface_lobes_at(m.base, V, p.specular, p.diffuse, energy, t.dfg);
        float u_lobe = rng_float(&rng);
        vec2 u = rng_vec2(&rng);
        LayersSample s = layers_sample(m, p, V, u_lobe, u, energy, t);
        vec3 L = surface_draw(m.base, at, u_lobe, u);
        assert_true((dot(L, L) > 0.5f) == (dot(s.L, s.L) > 0.5f && !s.is_delta));
        if (!(dot(L, L) > 0.5f))
            continue;
        drawn++;
        for (int c = 0; c < 3; c++)
            assert_same_value(L[c], s.L[c]);
    }
    assert_true(drawn > COUNT / 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(values_and_densities_are_those_of_layers),
        cmocka_unit_test(directions_are_those_of_layers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
