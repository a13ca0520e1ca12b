/* layers_sample_test.c - sampling of the layered surface: weights against albedos, lossless glass, specular
 * beside narrow lobes, reciprocity. That samples follow their density is tested in layers_chi_square_test.c. */
#include "testing/layer_albedo.h"
#include "testing/nasty_layers.h"

/* A surface seen from V. */
typedef struct seen {
    Layers m;
    LayersLobes p;
    LayerTables t;
    vec3 V;
    int energy;
    sheen_curve curve;
} seen;

static seen seen_by(Layers m, vec3 V, int energy, uint terms)
{
    seen s = {.m = m, .V = V, .energy = energy, .t = tables_by(m, V, energy, terms)};
    s.p = layers_lobes(m, V, energy, s.t);
    if (energy == ENERGY_GLTF)
        s.curve = sheen_curve_of(m);
    return s;
}

static seen seen_from(Layers m, vec3 V, int energy)
{
    return seen_by(m, V, energy, 8192u);
}

/* One sample; its weight, 0 if there is none. */
static LayersSample sample_of(const seen *s, test_rng *rng, vec3 *weight)
{
    float u_lobe = rng_float(rng);
    LayersSample d = layers_sample(s->m, s->p, s->V, u_lobe, rng_vec2(rng), s->energy, s->t);
    *weight = d.weight;
    if (d.is_valid && !d.is_delta)
        *weight = layers_scatter_cos(s->m, s->V, d.L, s->energy, s->t,
                                     sheen_curve_at(&s->curve, dot(s->m.base.N, d.L))) *
                  (1.0f / d.pdf);
    if (!d.is_valid)
        *weight = vec3(0.0f);
    return d;
}

/* Mean of n samples, its standard error, and the largest weight. */
typedef struct moments {
    double mean[3], error[3];
    double through; /* mean transmittance, green */
    float largest;
} moments;

static moments moments_of(const seen *s, uint n, uint64_t seed)
{
    test_rng rng = {seed};
    moments r = {.largest = 0.0f};
    double square[3] = {0.0, 0.0, 0.0};
    for (uint i = 0; i < n; ++i) {
        vec3 w;
        LayersSample d = sample_of(s, &rng, &w);
        assert_true(is_finite3(w) && w[0] >= -1e-6f && w[1] >= -1e-6f && w[2] >= -1e-6f);
        r.largest = fmaxf(r.largest, max3(w));
        r.through += d.is_through ? (double)w[1] / n : 0.0;
        for (int c = 0; c < 3; ++c) {
            r.mean[c] += (double)w[c] / n;
            square[c] += (double)w[c] * (double)w[c] / n;
        }
    }
    for (int c = 0; c < 3; ++c)
        r.error[c] = sqrt(fmax(square[c] - r.mean[c] * r.mean[c], 0.0) / n);
    return r;
}

static vec3 random_view(test_rng *rng, float least)
{
    float NdotV = least + (1.0f - least) * rng_float(rng), phi = 2.0f * PI * rng_float(rng);
    float across = sqrt(1.0f - NdotV * NdotV);
    return vec3(across * cosf(phi), across * sinf(phi), NdotV);
}

/* ---- means ---- */

/* The mean of weights is the albedo that layered_albedo() integrates with other densities, and conserving
 * surfaces never exceed 1. 0.4 % for LUTs and sums of this size. */
static void test_mean_weight_is_albedo(void **state)
{
    (void)state;
    for (uint layers = 0; layers < 512u; layers += CASE_STEP)
        for (int energy = 0; energy < 2; ++energy) {
            test_rng rng = {layers + 11u};
            rng_uint(&rng);
            vec3 V = random_view(&rng, 0.05f);
            Layers m = random_layers(&rng, layers & ~LAYER_DISPERSION, V, layers % 5u == 0);
            seen s = seen_by(m, V, energy, 2048u);
            moments r = moments_of(&s, 6000u, layers);
            double expected[3];
            layered_albedo_of(m, V, energy, s.t, 1024u, expected);
            for (int c = 0; c < 3; ++c) {
                expect_near(r.mean[c], expected[c], 4.0 * r.error[c] + 4e-3, "energy %d, layers 0x%x", energy,
                            layers);
                if (energy == ENERGY_CONSERVING)
                    assert_true(r.mean[c] <= 1.0 + 4.0 * r.error[c] + 4e-3);
            }
        }
}

/* ---- glass ---- */

static Layers glass(float roughness, float eta)
{
    float ior = fmaxf(eta, 1.0f / eta);
    Layers m = layers_from_surface(surface_from_gltf(vec3(0.0f, 0.0f, 1.0f), vec3(1.0f), 0.0f, roughness, ior,
                                                     1.0f, vec3(1.0f), 1.0f, vec3(0.0f)));
    m.layers = LAYER_TRANSMISSION | LAYER_VOLUME;
    m.transmission = 1.0f;
    m.ior = ior;
    m.eta = eta;
    return m;
}

/* R + T = 1 at every roughness, from either side; at the most grazing views from inside, where single
 * scattering of a rough boundary is below a third, some energy is lost. */
static void test_glass_loses_nothing(void **state)
{
    (void)state;
    const float iors[] = {1.0f, 1.1f, 1.33f, 1.5f, 2.42f}, roughness[] = {0.0f, 0.1f, 0.25f, 0.5f, 1.0f};
    const float views[] = {0.05f, 0.25f, 0.5f, 0.8f, 1.0f};
    float largest = 0.0f;
    for (size_t i = 0; i < COUNT_OF(iors); ++i)
        for (size_t r = 0; r < COUNT_OF(roughness); ++r)
            for (size_t v = (i + r) % CASE_STEP; v < COUNT_OF(views); v += CASE_STEP)
                for (int side = 0; side < 3; ++side) {
                    Layers m = glass(roughness[r], side == 1 ? 1.0f / iors[i] : iors[i]);
                    if (side == 2)
                        m.layers = LAYER_TRANSMISSION;
                    seen s = seen_from(m, view_at(views[v]), ENERGY_CONSERVING);
                    moments w = moments_of(&s, 8000u, 5u);
                    largest = fmaxf(largest, w.largest);
                    bool is_bounded = side == 1 && s.t.glass[1] < 1.0f / 3.0f;
                    if (is_bounded)
                        assert_true(w.mean[1] <= 1.0 + 4.0 * w.error[1]);
                    else
                        expect_near(w.mean[1], 1.0, 4.0 * w.error[1] + 1e-3,
                                    "ior %g, roughness %g, N.V %g, side %d", (double)iors[i],
                                    (double)roughness[r], (double)views[v], side);
                }
    print_message("largest weight of glass %.2f\n", (double)largest);
    assert_true(largest < 10.0f);
}

/* A smooth boundary is Fresnel's equations, from outside and from inside. */
static void test_smooth_glass_is_fresnel(void **state)
{
    (void)state;
    static const struct {
        float eta, cosine;
        double F;
    } rows[] = {{1.33f, 0.50f, 0.0591255992},        {1.33f, 0.10f, 0.5389897579},
                {1.5f, 1.00f, 0.0400000000},         {1.5f, 0.75f, 0.0467807474},
                {1.5f, 0.25f, 0.2641903734},         {2.42f, 0.05f, 0.7495985191},
                {1.0f / 1.33f, 0.95f, 0.0204920717}, {1.0f / 1.5f, 0.80f, 0.1141411002},
                {1.0f / 2.42f, 0.80f, 1.0},          {1.0f, 0.30f, 0.0}};
    for (size_t i = 0; i < COUNT_OF(rows); ++i) {
        seen s = seen_from(glass(0.0f, rows[i].eta), view_at(rows[i].cosine), ENERGY_CONSERVING);
        double sum = 0.0;
        for (int way = 0; way < 2; ++way) {
            float p = way ? s.p.transmission : s.p.specular;
            if (p <= 0.0f)
                continue;
            float u_lobe = way ? s.p.specular + 0.5f * p : 0.5f * p;
            LayersSample d = layers_sample(s.m, s.p, s.V, u_lobe, vec2(0.3f, 0.8f), s.energy, s.t);
            assert_true(d.is_valid && d.is_delta && d.is_through == (way == 1) && d.pdf == 0.0f);
            expect_near((double)(d.weight[0] * p), way ? 1.0 - rows[i].F : rows[i].F, 2e-6, "row %zu", i);
            float sine = sqrt(1.0f - rows[i].cosine * rows[i].cosine);
            expect_near((double)d.L[0], (double)(way ? -sine / rows[i].eta : -sine), 1e-6, "Snell");
            sum += (double)(d.weight[0] * p);
        }
        expect_near(sum, 1.0, 1e-6, "R + T");
    }
}

/* KHR_materials_specular: a factor of 0 leaves no reflection but total reflection. */
static void test_specular_factor(void **state)
{
    (void)state;
    Layers m = glass(0.0f, 1.5f);
    m.base.F0 = vec3(0.0f);
    m.base.F90 = 0.0f;
    seen s = seen_from(m, view_at(0.3f), ENERGY_CONSERVING);
    assert_true(s.p.specular == 0.0f && s.p.transmission == 1.0f);
    m.eta = 1.0f / 1.5f;
    s = seen_from(m, view_at(0.3f), ENERGY_CONSERVING);
    assert_true(s.p.specular == 1.0f && s.p.transmission == 0.0f);
    m = glass(0.4f, 1.5f);
    m.base.F0 *= 0.5f;
    m.base.F90 = 0.5f;
    s = seen_from(m, view_at(0.3f), ENERGY_CONSERVING);
    moments w = moments_of(&s, 40000u, 3u);
    expect_near(w.mean[1], 1.0, 4.0 * w.error[1] + 2e-3, "half the reflection, all the energy");
}

/* ---- specular lobes ---- */

/* Where a lobe becomes specular, nothing jumps: albedo, transmittance, and direction. */
static void expect_continuous(Layers wide, Layers narrow, double step, const char *what)
{
    const float views[] = {0.1f, 0.5f, 0.95f};
    for (size_t v = 0; v < COUNT_OF(views); ++v)
        for (int energy = 0; energy < 2; ++energy) {
            seen a = seen_from(wide, view_at(views[v]), energy),
                 b = seen_from(narrow, view_at(views[v]), energy);
            moments x = moments_of(&a, 20000u, 1u), y = moments_of(&b, 20000u, 1u);
            double tolerance = 4.0 * (x.error[1] + y.error[1]) + step;
            expect_near(x.mean[1], y.mean[1], tolerance, "%s, N.V %g", what, (double)views[v]);
            expect_near(x.through, y.through, tolerance, "%s, through, N.V %g", what, (double)views[v]);
            test_rng rng = {8}, same = {8};
            for (int i = 0; i < 200; ++i) {
                vec3 w;
                LayersSample c = sample_of(&a, &rng, &w), d = sample_of(&b, &same, &w);
                if (c.is_valid && d.is_valid && c.is_through == d.is_through)
                    expect_near((double)length(c.L - d.L), 0.0, 0.05, "%s, direction", what);
            }
        }
}
static void test_delta_lobes_continue_narrow_ones(void **state)
{
    (void)state;
    const float iors[] = {1.5f, 1.0f / 1.5f};
    for (size_t i = 0; i < COUNT_OF(iors); ++i) {
        Layers a = glass(0.0f, iors[i]), b = a;
        a.base.perceptual_roughness = 0.0102f;
        a.base.alpha = 1.04e-4f;
        b.base.perceptual_roughness = 0.0098f;
        b.base.alpha = 0.96e-4f;
        assert_true(!layers_specular_is_delta(a) && layers_specular_is_delta(b));
        expect_continuous(a, b, 2e-3, "reflection");
        float limit = 2.0f * ALPHA_DELTA * iors[i] / fabsf(iors[i] - 1.0f);
        a.base.alpha = 1.01f * limit;
        b.base.alpha = 0.99f * limit;
        a.base.perceptual_roughness = sqrt(a.base.alpha);
        b.base.perceptual_roughness = sqrt(b.base.alpha);
        assert_true(!layers_transmission_is_delta(a) && layers_transmission_is_delta(b));
        expect_continuous(a, b, 2e-3, "refraction");
    }
    /* rough, and the ior of both sides nearly equal: straight on. glTF's term there is an estimate, 0.02
     * too large. */
    Layers a = glass(0.5f, 1.0f + 0.82e-3f), b = glass(0.5f, 1.0f + 0.78e-3f);
    assert_true(!layers_transmission_is_delta(a) && layers_transmission_is_delta(b));
    expect_continuous(a, b, 0.025, "nearly air");
    a = glass(0.5f, 1.0f / (1.0f + 0.82e-3f));
    b = glass(0.5f, 1.0f / (1.0f + 0.78e-3f));
    expect_continuous(a, b, 0.025, "nearly air, from inside");
    b = glass(0.5f, 1.0f);
    seen s = seen_from(b, view_at(0.4f), ENERGY_CONSERVING);
    moments w = moments_of(&s, 100u, 1u);
    expect_near(w.mean[1], 1.0, 2e-3, "air lets all through");
    expect_near(w.through, 1.0, 2e-3, "air lets all through");

    Layers coated =
        layers_from_surface(surface_from_metallic_roughness(vec3(0.0f, 0.0f, 1.0f), vec3(0.5f), 0.0f, 0.5f));
    coated.layers = LAYER_CLEARCOAT;
    coated.clearcoat = 1.0f;
    Layers smooth = coated;
    coated.clearcoat_roughness = 0.0102f;
    smooth.clearcoat_roughness = 0.0098f;
    assert_true(!layers_clearcoat_is_delta(coated) && layers_clearcoat_is_delta(smooth));
    expect_continuous(coated, smooth, 2e-3, "coat");
}

/* The non-specular lobes are the whole surface if there is no specular lobe, bit for bit; otherwise they
 * differ from it only near the specular directions, where the narrow lobes are hundreds high. */
static void test_scattering_excludes_delta_lobes(void **state)
{
    (void)state;
    test_rng rng = {3};
    int rough = 0, high = 0;
    for (int i = 0; i < 6000; ++i) {
        int energy = i % 2;
        vec3 V = random_view(&rng, 0.1f), L = rng_direction(&rng);
        Layers m = random_layers(&rng, rng_uint(&rng) % 512u & ~LAYER_DISPERSION, V, false);
        LayerTables t =
            layer_tables(m, V, energy, vec2(0.7f, 0.2f), 0.9f, 0.8f, 0.3f, vec3(0.2f, 0.9f, 0.8f));
        vec3 whole = layers_brdf_cos(m, V, L, energy, t, 0.2f);
        vec3 scattered = layers_scatter_cos(m, V, L, energy, t, 0.2f);
        uint lobes = LOBE_SPECULAR;
        lobes |= has_layer(m, LAYER_TRANSMISSION) ? LOBE_TRANSMISSION : 0u;
        lobes |= has_layer(m, LAYER_CLEARCOAT) ? LOBE_CLEARCOAT : 0u;
        if (layers_scattering_lobes(m) == lobes) {
            assert_memory_equal(&whole, &scattered, 3 * sizeof(float));
            ++rough;
        }
        m.base.alpha = m.anisotropy = m.clearcoat_roughness = 0.0f;
        assert_true(layers_scattering_lobes(m) == 0u);
        vec3 N = m.base.N, through = has_layer(m, LAYER_VOLUME) ? refract_or_zero(-V, N, m.eta) : -V;
        vec3 mirrors[3] = {reflect(-V, N), through, reflect(-V, m.clearcoat_N)};
        bool is_near = false;
        for (int k = 0; k < 3; ++k)
            is_near = is_near || length(L - mirrors[k]) < 0.1f;
        whole = layers_brdf_cos(m, V, L, energy, t, 0.2f);
        scattered = layers_scatter_cos(m, V, L, energy, t, 0.2f);
        for (int c = 0; c < 3 && !is_near; ++c)
            expect_near((double)scattered[c], (double)whole[c], 1e-3, "layers 0x%x", m.layers);
        float there = max3(layers_brdf_cos(m, V, mirrors[0], energy, t, 0.2f));
        float left = max3(layers_scatter_cos(m, V, mirrors[0], energy, t, 0.2f));
        high += there > 100.0f;
        assert_true(left < 20.0f); /* of what is left, sheen is the highest */
    }
    assert_true(rough > 4000 && high > 5000);
}

/* ---- reciprocity ---- */

/* f(V, L) / n_V^2 = f(L, V) / n_L^2 for a rough boundary under glTF's weights: radiance is counted as L /
 * n^2, so that f(V, L) = f(L, V) eta^2. In ENERGY_CONSERVING the compensation is of V. */
static void test_boundary_is_reciprocal(void **state)
{
    (void)state;
    test_rng rng = {6};
    int compared = 0;
    for (int i = 0; i < 40000; ++i) {
        float eta = 1.1f + rng_float(&rng);
        vec3 V = random_view(&rng, 0.05f), L = -random_view(&rng, 0.05f);
        Layers m = glass(0.3f + 0.7f * rng_float(&rng), eta), turned = m;
        turned.base.N = -m.base.N;
        turned.eta = 1.0f / eta;
        LayerTables t = {.dfg = vec2(0.7f, 0.2f)};
        float there = layers_scatter_cos(m, V, L, ENERGY_GLTF, t, 0.0f)[0] / -L[2];
        float back = layers_scatter_cos(turned, L, V, ENERGY_GLTF, t, 0.0f)[0] / V[2];
        if (there > 1e-3f) {
            expect_relative(there, back * eta * eta, 3e-3, "eta %g", (double)eta);
            ++compared;
        }
    }
    assert_true(compared > 5000);
}

/* Lobes that are reciprocal by themselves, F or tables given: coat, film, compensated reflection. As
 * layers they are not: the coat is weighted with F(N.V), the film with that of N.V, compensation with
 * E(N.V); neither is the transformed cosine of sheen.h. */
static void test_lobes_are_reciprocal(void **state)
{
    (void)state;
    test_rng rng = {16};
    for (int i = 0; i < 20000; ++i) {
        vec3 V = random_view(&rng, 0.05f), L = random_view(&rng, 0.05f), N = vec3(0.0f, 0.0f, 1.0f);
        float alpha = 0.02f + 0.98f * rng_float(&rng);
        expect_relative(clearcoat_lobe_cos(N, V[2], V, L, alpha) / L[2],
                        clearcoat_lobe_cos(N, L[2], L, V, alpha) / V[2], 1e-4, "coat");
        Layers m = random_layers(&rng, LAYER_IRIDESCENCE | LAYER_ANISOTROPY | LAYER_SHEEN, V, false);
        LayerTables t = layer_tables(m, V, i % 2, vec2(0.7f, 0.2f), 0.9f, 0.8f, 0.3f, vec3(0.2f, 0.9f, 0.8f));
        m.base.base_color = vec3(m.base.base_color[0]);
        m.base.metallic = 1.0f;
        vec3 there = layers_scatter_cos(m, V, L, i % 2, t, t.sheen_E) / L[2];
        vec3 back = layers_scatter_cos(m, L, V, i % 2, t, t.sheen_E) / V[2];
        for (int c = 0; c < 3; ++c)
            expect_relative(there[c], back[c], 2e-4, "conductor under film and sheen, tables given");
    }
}

/* ---- weights ---- */

/* Over random materials, smooth and grazing ones included, no weight is a firefly. The mean of weights is
 * at most 1 where energy is conserved; the excess is the variation of a lobe's Fresnel term over its
 * narrow part, or of sheen over its rim. */
static void test_weights_are_bounded(void **state)
{
    (void)state;
    float worst[2] = {0.0f, 0.0f};
    int over[2][3] = {{0, 0, 0}, {0, 0, 0}};
    enum { MATERIALS = 1500 / CASE_STEP, EACH = 400 };
    for (int i = 0; i < MATERIALS; ++i)
        for (int energy = 0; energy < 2; ++energy) {
            test_rng rng = {(uint64_t)i + 1u};
            rng_uint(&rng);
            vec3 V = random_view(&rng, i % 3 ? 0.02f : 0.3f);
            Layers m = random_layers(&rng, rng_uint(&rng) % 512u & ~LAYER_DISPERSION, V, false);
            m.base.perceptual_roughness = rng_float(&rng);
            m.base.alpha = alpha_from_roughness(m.base.perceptual_roughness);
            m.clearcoat_roughness = rng_float(&rng);
            m.sheen_roughness = 0.03f + 0.97f * rng_float(&rng);
            seen s = seen_by(m, V, energy, 512u);
            for (int k = 0; k < EACH; ++k) {
                vec3 w;
                sample_of(&s, &rng, &w);
                worst[energy] = fmaxf(worst[energy], max3(w));
                over[energy][0] += max3(w) > 2.0f;
                over[energy][1] += max3(w) > 4.0f;
                over[energy][2] += max3(w) > 8.0f;
            }
        }
    for (int energy = 0; energy < 2; ++energy)
        print_message("energy %d: largest weight %.2f; above 2, 4, 8: %d, %d, %d of %d\n", energy,
                      (double)worst[energy], over[energy][0], over[energy][1], over[energy][2],
                      MATERIALS * EACH);
    assert_true(worst[ENERGY_CONSERVING] < 6.0f && worst[ENERGY_GLTF] < 10.0f);
    assert_true(over[ENERGY_CONSERVING][1] < MATERIALS * EACH / 10000);
    assert_true(over[ENERGY_GLTF][1] < MATERIALS * EACH / 1000);
}

/* ---- robustness ---- */

static void test_fuzz(void **state)
{
    (void)state;
    test_rng rng = {31};
    for (int i = 0; i < 1000000 / CASE_STEP; ++i) {
        static Layers m;
        static LayersLobes p;
        static LayerTables t;
        static vec3 V;
        int energy = i / 4 % 2;
        if (i % 4 == 0) {
            V = nasty_direction(&rng);
            m = nasty_layers(&rng, nasty_direction(&rng));
            m = layers_with_wavelength(m, 380.0f + 350.0f * rng_float(&rng));
            float A = rng_float(&rng), B = (1.0f - A) * rng_float(&rng);
            float coat_E = nasty_unit(&rng), wall_E = nasty_unit(&rng), sheen_E = 1.5f * nasty_unit(&rng);
            vec3 glass_terms = vec3(nasty_unit(&rng), nasty_unit(&rng), nasty_unit(&rng));
            t = layer_tables(m, V, energy, vec2(A, B), coat_E, wall_E, sheen_E, glass_terms);
            p = layers_lobes(m, V, energy, t);
            const float each[] = {p.clearcoat, p.sheen,        p.specular,
                                  p.diffuse,   p.transmission, p.diffuse_back};
            float sum = 0.0f;
            for (size_t k = 0; k < COUNT_OF(each); ++k) {
                assert_true(each[k] == 0.0f || (each[k] >= 0.0499f && each[k] <= 1.00001f));
                sum += each[k];
            }
            assert_true(sum == 0.0f || fabsf(sum - 1.0f) < 1e-5f);
        }
        vec2 u = vec2(nasty_unit(&rng), nasty_unit(&rng)) * 0.99999994f;
        LayersSample s = layers_sample(m, p, V, nasty_unit(&rng) * 0.99999994f, u, energy, t);
        if (!is_finite3(s.L) || !is_finite3(s.weight) || !isfinite(s.pdf) || s.pdf < 0.0f)
            fail_msg("layers 0x%x: L %g %g %g, pdf %g", m.layers, (double)s.L[0], (double)s.L[1],
                     (double)s.L[2], (double)s.pdf);
        assert_true(!s.is_valid || fabsf(length(s.L) - 1.0f) < 1e-4f);
        vec3 f = layers_scatter_cos(m, V, i % 2 ? s.L : nasty_direction(&rng), energy, t, nasty_unit(&rng));
        float pdf = layers_pdf(m, p, V, nasty_direction(&rng));
        if (!is_finite3(f) || !isfinite(pdf) || pdf < 0.0f || f[0] < -1e-6f || f[1] < -1e-6f || f[2] < -1e-6f)
            fail_msg("layers 0x%x: f %g %g %g, pdf %g", m.layers, (double)f[0], (double)f[1], (double)f[2],
                     (double)pdf);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_mean_weight_is_albedo),
        cmocka_unit_test(test_glass_loses_nothing),
        cmocka_unit_test(test_smooth_glass_is_fresnel),
        cmocka_unit_test(test_specular_factor),
        cmocka_unit_test(test_delta_lobes_continue_narrow_ones),
        cmocka_unit_test(test_scattering_excludes_delta_lobes),
        cmocka_unit_test(test_boundary_is_reciprocal),
        cmocka_unit_test(test_lobes_are_reciprocal),
        cmocka_unit_test(test_weights_are_bounded),
        cmocka_unit_test(test_fuzz),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
