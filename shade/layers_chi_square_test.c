/* layers_chi_square_test.c - layers_sample() against layers_pdf(), for every lobe alone and for all together. */
#include "testing/chi_square.h"
#include "testing/layer_albedo.h"

typedef struct drawn {
    Layers from, m; /* of which it is drawn, and whose density it should have: the same */
    LayersLobes p;
    LayerTables t;
    vec3 V;
    int energy;
    test_rng *rng; /* chooses the lobe */
} drawn;

static bool draw(const void *context, vec2 u, vec3 *d)
{
    const drawn *w = (const drawn *)context;
    LayersSample s = layers_sample(w->from, w->p, w->V, rng_float(w->rng), u, w->energy, w->t);
    if (!s.is_valid)
        return false;
    assert_false(s.is_delta);
    assert_true(s.is_through == (dot(w->m.base.N, s.L) < 0.0f));
    expect_near((double)length(s.L), 1.0, 1e-5, "unit");
    assert_true(s.pdf == layers_pdf(w->from, w->p, w->V, s.L));
    *d = s.L;
    return true;
}
static float density(const void *context, vec3 d)
{
    const drawn *w = (const drawn *)context;
    return layers_pdf(w->m, w->p, w->V, d);
}

/* ---- surfaces ---- */

/* N is tilted, so that no axis is special. */
static mat3 tilted(void)
{
    return basis_from_normal(normalize(vec3(0.3f, -0.2f, 0.9f)));
}
static vec3 seen_at(float NdotV, float phi)
{
    float across = sqrt(1.0f - NdotV * NdotV);
    return mul(tilted(), vec3(across * cosf(phi), across * sinf(phi), NdotV));
}

/* Only the lobes added by the caller: black, without a reflecting boundary. */
static Layers black(uint layers, float roughness)
{
    mat3 frame = tilted();
    Layers m = layers_from_surface(surface_from_gltf(COL(frame, 2), vec3(0.0f), 0.0f, roughness, 1.5f, 0.0f,
                                                     vec3(1.0f), 1.0f, vec3(0.0f)));
    m.layers = layers;
    m.anisotropy_T = COL(frame, 0);
    m.anisotropy_B = COL(frame, 1);
    return m;
}
static Layers diffuse(void)
{
    Layers m = black(0u, 0.5f);
    m.base.base_color = vec3(0.8f, 0.5f, 0.3f);
    return m;
}
static Layers conductor(float roughness, float anisotropy)
{
    Layers m = black(anisotropy > 0.0f ? LAYER_ANISOTROPY : 0u, roughness);
    m.base.base_color = vec3(0.9f, 0.7f, 0.4f);
    m.base.metallic = 1.0f;
    m.anisotropy = anisotropy;
    return m;
}
static Layers film(float roughness)
{
    Layers m = conductor(roughness, 0.0f);
    m.layers = LAYER_IRIDESCENCE;
    m.iridescence = 1.0f;
    m.iridescence_thickness_nm = 400.0f;
    return m;
}
static Layers coat(float roughness)
{
    Layers m = black(LAYER_CLEARCOAT, 0.5f);
    m.clearcoat = 1.0f;
    m.clearcoat_roughness = roughness;
    m.clearcoat_N = normalize(m.base.N + vec3(0.1f, 0.05f, 0.0f));
    return m;
}
static Layers sheen(float roughness)
{
    Layers m = black(LAYER_SHEEN, 0.5f);
    m.sheen_color = vec3(0.9f, 0.6f, 0.3f);
    m.sheen_roughness = roughness;
    return m;
}
static Layers glass(float roughness, float ior, bool is_inside, float anisotropy)
{
    uint layers = LAYER_TRANSMISSION | LAYER_VOLUME;
    if (anisotropy > 0.0f)
        layers |= LAYER_ANISOTROPY;
    Layers m = black(layers, roughness);
    m.base.base_color = vec3(1.0f, 0.9f, 0.8f);
    m.base.F0 = dielectric_F0(ior, 1.0f, vec3(1.0f));
    m.base.F90 = 1.0f;
    m.ior = ior;
    m.eta = is_inside ? 1.0f / ior : ior;
    m.transmission = 1.0f;
    m.anisotropy = anisotropy;
    return m;
}
static Layers wall(float roughness, float anisotropy)
{
    Layers m = glass(roughness, 1.4f, false, anisotropy);
    m.layers &= ~LAYER_VOLUME;
    return m;
}
static Layers leaf(void)
{
    Layers m = diffuse();
    m.layers = LAYER_DIFFUSE_TRANSMISSION;
    m.diffuse_transmission = 0.6f;
    m.diffuse_transmission_color = vec3(0.5f, 0.9f, 0.2f);
    return m;
}

/* Rough diffuse reflection, and both with diffuse transmission. */
static Layers clay(float roughness, uint layers)
{
    Layers m = layers ? leaf() : diffuse();
    m.layers = LAYER_DIFFUSE_ROUGHNESS | layers;
    m.diffuse_roughness = roughness;
    return m;
}

/* ---- tests ---- */

enum { TESTS = 90 };

static double p_value(Layers from, Layers m, vec3 V, int energy, uint64_t seed)
{
    test_rng rng = {seed * 77u};
    drawn d = {.from = from, .m = m, .V = V, .energy = energy, .t = exact_tables(m, V, energy), .rng = &rng};
    d.p = layers_lobes(m, V, energy, d.t);
    return chi2_over_sphere(&(sphere_sampler){draw, density, &d}, seed);
}

static void expect_density(Layers m, vec3 V, const char *what)
{
    static uint64_t seed = 1;
    assert_true(++seed <= TESTS);
    if (seed % CASE_STEP != 0)
        return;
    double p = p_value(m, m, V, seed % 2u ? ENERGY_CONSERVING : ENERGY_GLTF, seed);
    if (p < sidak_level(TESTS))
        fail_msg("%s, N.V %g: p = %g", what, (double)dot(m.base.N, V), p);
}

static const float views[] = {0.05f, 0.4f, 0.9f};

static void test_reflection(void **state)
{
    (void)state;
    const float roughness[] = {0.15f, 0.5f, 1.0f};
    for (size_t v = 0; v < COUNT_OF(views); ++v) {
        vec3 V = seen_at(views[v], 2.0f * (float)v + 0.3f);
        expect_density(diffuse(), V, "diffuse");
        expect_density(clay(0.4f, 0u), V, "rough diffuse");
        expect_density(clay(1.0f, 0u), V, "rough diffuse");
        for (size_t r = 0; r < COUNT_OF(roughness); ++r)
            expect_density(conductor(roughness[r], 0.0f), V, "conductor");
        expect_density(conductor(0.4f, 0.5f), V, "brushed conductor");
        expect_density(conductor(0.3f, 1.0f), V, "brushed conductor");
        expect_density(film(0.5f), V, "film");
        expect_density(coat(0.2f), V, "coat");
        expect_density(coat(0.7f), V, "coat");
        expect_density(sheen(0.1f), V, "sheen");
        expect_density(sheen(0.6f), V, "sheen");
    }
}

static void test_transmission(void **state)
{
    (void)state;
    for (size_t v = 0; v < COUNT_OF(views); ++v) {
        vec3 V = seen_at(views[v], 2.0f * (float)v + 0.3f);
        for (int inside = 0; inside < 2; ++inside) {
            expect_density(glass(0.5f, 1.5f, inside != 0, 0.0f), V, "rough glass");
            expect_density(glass(0.9f, 2.42f, inside != 0, 0.0f), V, "rough diamond");
        }
        expect_density(glass(0.5f, 1.33f, false, 0.6f), V, "brushed ice");
        expect_density(glass(0.6f, 1.33f, true, 0.6f), V, "brushed ice");
        expect_density(wall(0.6f, 0.0f), V, "thin wall");
        expect_density(wall(0.5f, 0.5f), V, "brushed thin wall");
        expect_density(leaf(), V, "leaf");
        expect_density(clay(0.8f, LAYER_DIFFUSE_TRANSMISSION), V, "rough leaf");
    }
}

/* Any mixture, and V below a mapped normal. */
static void test_mixtures(void **state)
{
    (void)state;
    test_rng rng = {9};
    for (int i = 0; i < 16; ++i) {
        vec3 V = view_at(i % 4 ? 0.1f + 0.8f * rng_float(&rng) : -0.2f);
        Layers m = random_layers(&rng, rng_uint(&rng) % 1024u & ~LAYER_DISPERSION, V, false);
        if (layers_scattering_lobes(m) == LOBES_ALL || !has_layer(m, LAYER_TRANSMISSION) ||
            !layers_transmission_is_delta(m))
            expect_density(m, V, "mixture");
    }
}

/* The test detects errors: 3 % of alpha, of the ior, or one lobe for another. */
static void test_slips_are_seen(void **state)
{
    (void)state;
    vec3 V = seen_at(0.6f, 1.0f);
    Layers m = glass(0.6f, 1.5f, false, 0.0f), other = m;
    other.base.alpha *= 1.03f;
    assert_true(p_value(other, m, V, ENERGY_CONSERVING, 3) < 1e-4);
    other = glass(0.6f, 1.545f, false, 0.0f);
    assert_true(p_value(other, m, V, ENERGY_CONSERVING, 4) < 1e-4);
    other = m = coat(0.5f);
    other.clearcoat_N = m.base.N;
    assert_true(p_value(other, m, V, ENERGY_CONSERVING, 5) < 1e-4);
    other = m = sheen(0.5f);
    other.sheen_roughness = 0.6f;
    assert_true(p_value(other, m, V, ENERGY_CONSERVING, 6) < 1e-4);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_reflection),
        cmocka_unit_test(test_transmission),
        cmocka_unit_test(test_mixtures),
        cmocka_unit_test(test_slips_are_seen),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
