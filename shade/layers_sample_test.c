/* layers_sample_test.c - the layered surface as paths use it: draws against densities, weights against albedos. */
#include "testing/chi_square.h"
#include "testing/layer_albedo.h"

typedef struct drawn {
    Layers m;
    LayersLobes p;
    LayerTables t;
    vec3 V;
    int energy;
} drawn;

static drawn drawn_of(Layers m, vec3 V, int energy)
{
    drawn d = {.m = m, .V = V, .energy = energy, .t = exact_tables(m, V, energy)};
    d.p = layers_lobes(m, V, energy, d.t);
    return d;
}

/* The mean of weights is the albedo that layered_albedo() integrates with other densities. */
static void mean_weight(const drawn *d, uint n, uint64_t seed, double mean[3], double sigma[3],
                        float *largest)
{
    test_rng rng = {seed};
    sheen_curve curve = {{0.0f}};
    if (d->energy == ENERGY_GLTF)
        curve = sheen_curve_of(d->m);
    double sum[3] = {0}, square[3] = {0};
    for (uint i = 0; i < n; ++i) {
        float u_lobe = rng_float(&rng);
        LayersSample s = layers_sample(d->m, d->p, d->V, u_lobe, rng_vec2(&rng), d->energy, d->t);
        if (!s.is_valid)
            continue;
        vec3 w = s.weight;
        if (!s.is_mirror)
            w = layers_scatter_cos(d->m, d->V, s.L, d->energy, d->t,
                                   sheen_curve_at(&curve, dot(d->m.base.N, s.L))) *
                (1.0f / s.pdf);
        *largest = fmaxf(*largest, max3(w));
        for (int c = 0; c < 3; ++c) {
            sum[c] += (double)w[c];
            square[c] += (double)w[c] * (double)w[c];
        }
    }
    for (int c = 0; c < 3; ++c) {
        mean[c] = sum[c] / n;
        sigma[c] = (sqrt)(fmax(square[c] / n - mean[c] * mean[c], 0.0) / n);
    }
}

static void test_mean_weight_is_albedo(void **state)
{
    (void)state;
    float worst = 0.0f;
    for (int energy = 0; energy < 2; ++energy)
        for (uint layers = 0; layers < 512u; layers += 1u) {
            test_rng rng = {layers + 11u};
            rng_uint(&rng);
            float NdotV = 0.05f + 0.95f * rng_float(&rng), phi = 2.0f * PI * rng_float(&rng);
            float across = sqrt(1.0f - NdotV * NdotV);
            vec3 V = vec3(across * cosf(phi), across * sinf(phi), NdotV);
            Layers m = random_layers(&rng, layers & ~LAYER_DISPERSION, V, false);
            drawn d = drawn_of(m, V, energy);
            double mean[3], sigma[3], expected[3];
            float largest = 0.0f;
            mean_weight(&d, 20000u, layers, mean, sigma, &largest);
            layered_albedo(m, V, energy, 2048u, expected);
            for (int c = 0; c < 3; ++c)
                expect_near(mean[c], expected[c], 4.0 * sigma[c] + 3e-3, "energy %d, layers 0x%x", energy,
                            layers);
            worst = fmaxf(worst, largest);
        }
    print_message("largest weight %.2f\n", (double)worst);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_mean_weight_is_albedo),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
