/* layers_test.c - the layered surface: a layer of factor 0 has no effect, and each layer agrees with the text
 * of its extension. */
#include "testing/layer_albedo.h"
#include "testing/nasty_layers.h"

static const vec3 up = {0.0f, 0.0f, 1.0f};

enum { ALL_LAYERS = 512 };

static vec3 upper(test_rng *rng, float lowest)
{
    vec3 d = rng_direction(rng);
    d[2] = max(fabsf(d[2]), lowest);
    return normalize(d);
}
static LayerLight random_light(test_rng *rng)
{
    LayerLight light;
    light.specular = rng_color(rng);
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
static void expect_same(vec3 a, vec3 b, double tolerance, const char *what)
{
    for (int c = 0; c < 3; ++c)
        expect_near((double)a[c], (double)b[c], tolerance * (1.0 + fabs((double)b[c])), "%s, channel %d",
                    what, c);
}
static void expect_bits(vec3 a, vec3 b)
{
    assert_true(a[0] == b[0] && a[1] == b[1] && a[2] == b[2]);
}

/* ---- no layers ---- */

/* Without layers: the functions of surface.h, light.h and ibl.h, bit for bit. */
static void test_no_layers_is_the_surface(void **state)
{
    (void)state;
    test_rng rng = {1};
    for (int i = 0; i < 20000; ++i) {
        int energy = i % 2 ? ENERGY_GLTF : ENERGY_CONSERVING;
        vec3 V = upper(&rng, 0.0f), L = rng_direction(&rng);
        Layers m = random_layers(&rng, 0u, V, false);
        m.base.emissive = rng_color(&rng);
        LayerTables t = some_tables(m, V, energy);
        expect_bits(layers_brdf_cos(m, V, L, energy, t, 0.5f),
                    surface_brdf_cos_energy(m.base, V, L, energy, t.dfg));
        LayerLight light = random_light(&rng);
        expect_bits(layers_ibl(m, V, t, light, energy),
                    surface_ibl(m.base, surface_NdotV(m.base, V), t.dfg, light.specular,
                                light.irradiance_over_pi, energy));
        Light punctual = light_point(L * 2.0f, vec3(5.0f), 0.0f);
        expect_bits(layers_punctual(m, vec3(0.0f), V, punctual, energy, t, 0.5f),
                    shade_punctual(m.base, vec3(0.0f), V, punctual, energy, t.dfg));
        expect_bits(layers_emission(m, V), m.base.emissive);
        expect_bits(layers_reflection(m, V, energy), surface_reflection(m.base, V, energy));
        vec2 p = layers_dfg_point(m, V, energy);
        assert_true(p[0] == surface_NdotV(m.base, V) && p[1] == m.base.perceptual_roughness);
    }
}

/* Every set of layers with factors of 0 is the base, for punctual lights on either side and for
 * environments. Except for transmission in ENERGY_CONSERVING: a transmissive dielectric reflects by
 * Fresnel's equations, not Schlick's. */
static void test_factor_zero_is_the_base(void **state)
{
    (void)state;
    for (uint layers = 1; layers < ALL_LAYERS; ++layers) {
        test_rng rng = {layers};
        for (int i = 0; i < 40; ++i) {
            int energy = i % 2 ? ENERGY_GLTF : ENERGY_CONSERVING;
            vec3 V = upper(&rng, 0.02f), L = upper(&rng, 0.02f) * (i % 5 ? 1.0f : -1.0f);
            uint kept = ~(energy == ENERGY_CONSERVING ? LAYER_VOLUME | LAYER_TRANSMISSION : LAYER_VOLUME);
            Layers m = random_layers(&rng, layers & kept, V, false);
            m.clearcoat = m.anisotropy = m.iridescence = m.transmission = m.diffuse_transmission = 0.0f;
            m.dispersion = 0.0f;
            m.sheen_color = m.multiscatter_color = vec3(0.0f);
            LayerTables t = some_tables(m, V, energy);
            vec3 f = layers_brdf_cos(m, V, L, energy, t, 0.4f);
            t.dfg = vec2(0.7f, 0.1f); /* without the margin of anisotropic tables, which is 0 as well */
            expect_same(f, surface_brdf_cos_energy(m.base, V, L, energy, t.dfg), 1e-5, "punctual");
            LayerLight light = random_light(&rng);
            expect_same(layers_ibl(m, V, t, light, energy),
                        surface_ibl(m.base, surface_NdotV(m.base, V), t.dfg, light.specular,
                                    light.irradiance_over_pi, energy),
                        2e-6, "surroundings");
        }
    }
}

/* Limits other than a factor of 0: a film without thickness, dispersion 0 in a volume, no absorption. */
static void test_limits_of_parameters(void **state)
{
    (void)state;
    test_rng rng = {3};
    for (int i = 0; i < 5000; ++i) {
        int energy = i % 2 ? ENERGY_GLTF : ENERGY_CONSERVING;
        vec3 V = upper(&rng, 0.02f), L = rng_direction(&rng);
        Layers film = random_layers(&rng, LAYER_IRIDESCENCE, V, false);
        film.iridescence = 1.0f;
        film.iridescence_thickness_nm = 0.0f;
        LayerTables t = some_tables(film, V, energy);
        expect_same(layers_brdf_cos(film, V, L, energy, t, 0.0f),
                    surface_brdf_cos_energy(film.base, V, L, energy, t.dfg), 1e-6, "film without thickness");

        Layers glass =
            random_layers(&rng, LAYER_TRANSMISSION | LAYER_VOLUME | LAYER_DIFFUSE_TRANSMISSION, V, false);
        t = some_tables(glass, V, energy);
        vec3 plain = layers_brdf_cos(glass, V, L, energy, t, 0.0f);
        Layers dispersed = glass;
        dispersed.layers |= LAYER_DISPERSION;
        dispersed.dispersion = 0.0f;
        expect_bits(layers_brdf_cos(dispersed, V, L, energy, t, 0.0f), plain);
        Layers clear = glass;
        clear.attenuation_distance = INFINITY;
        Layers thin = glass;
        thin.thickness = 0.0f;
        expect_bits(layers_brdf_cos(clear, V, L, energy, t, 0.0f),
                    layers_brdf_cos(thin, V, L, energy, t, 0.0f));
    }
    Layers m = layers_from_surface(surface_from_metallic_roughness(up, vec3(1.0f), 0.0f, 0.0f));
    assert_true(m.layers == 0u && layers_eta(m, 0) == m.eta && !layers_is_inside(m));
}

/* ---- coat ---- */

/* Over black: only the coat's reflection; mix(black, coat, w F). The lobe's albedo is w F(N.V) E, of which
 * the conserving mode omits E. */
static void test_clearcoat_over_black(void **state)
{
    (void)state;
    Surface black = surface_from_gltf(up, vec3(0.0f), 0.0f, 0.5f, 1.5f, 0.0f, vec3(0.0f), 1.0f, vec3(0.0f));
    for (int r = 0; r < GOLDEN_ROUGHNESS_COUNT; ++r)
        for (int c = 0; c < GOLDEN_NDOTV_COUNT; ++c) {
            Layers m = layers_from_surface(black);
            m.layers = LAYER_CLEARCOAT;
            m.clearcoat = 0.75f;
            m.clearcoat_roughness = golden_roughness[r];
            double F = 0.75 * (0.04 + 0.96 * pow(1.0 - (double)golden_NdotV[c], 5.0)), rgb[3];
            layered_albedo(m, view_at(golden_NdotV[c]), ENERGY_GLTF, 1u << 12u, rgb);
            expect_near(rgb[1], F * (golden_A[r][c] + golden_B[r][c]), 3e-3, "glTF");
            layered_albedo(m, view_at(golden_NdotV[c]), ENERGY_CONSERVING, 1u << 12u, rgb);
            expect_near(rgb[1], F, 3e-3, "conserving");
            LayerLight light = {.clearcoat = vec3(2.0f, 1.0f, 0.5f)};
            vec3 L =
                layers_ibl(m, view_at(golden_NdotV[c]), some_tables(m, up, ENERGY_GLTF), light, ENERGY_GLTF);
            expect_near((double)L[0], 2.0 * F, 1e-5, "surroundings");
        }
}

/* The base, its emission and everything else are dimmed by one minus the weight of the coat, for any
 * normal of the coat. */
static void test_clearcoat_dims_what_is_below(void **state)
{
    (void)state;
    test_rng rng = {9};
    for (int i = 0; i < 2000; ++i) {
        vec3 V = upper(&rng, 0.1f);
        Layers m = random_layers(&rng, LAYER_CLEARCOAT | LAYER_DIFFUSE_TRANSMISSION, V, false), bare = m;
        bare.layers = LAYER_DIFFUSE_TRANSMISSION;
        m.base.emissive = bare.base.emissive = rng_color(&rng);
        float share = m.clearcoat * (0.04f + 0.96f * powf(1.0f - dot(m.clearcoat_N, V), 5.0f));
        expect_same(layers_emission(m, V), m.base.emissive * (1.0f - share), 1e-5, "emission");
        LayerTables t = some_tables(m, V, ENERGY_GLTF);
        vec3 L = vec3(-m.clearcoat_N[0], -m.clearcoat_N[1], -1.0f); /* from behind: no light on the coat */
        L = normalize(L);
        expect_same(layers_brdf_cos(m, V, L, ENERGY_GLTF, t, 0.0f),
                    layers_brdf_cos(bare, V, L, ENERGY_GLTF, t, 0.0f) * (1.0f - share), 1e-5,
                    "light from behind");
    }
}

/* ---- sheen ---- */

/* The definition: color D V N.L + base min(1 - max3 E(V), 1 - max3 E(L)). KHR_materials_sheen. */
static void test_sheen_formula(void **state)
{
    (void)state;
    test_rng rng = {12};
    for (int i = 0; i < 5000; ++i) {
        vec3 V = upper(&rng, 0.05f), L = upper(&rng, 0.05f), H = normalize(V + L);
        Layers m = random_layers(&rng, LAYER_SHEEN, V, false);
        LayerTables t = some_tables(m, V, ENERGY_GLTF);
        t.sheen_E = rng_float(&rng);
        float E_L = rng_float(&rng), alpha = m.sheen_roughness * m.sheen_roughness;
        float scale = min(1.0f - max3(m.sheen_color) * t.sheen_E, 1.0f - max3(m.sheen_color) * E_L);
        vec3 expected = m.sheen_color * (D_Charlie(H[2], alpha) * V_Charlie(L[2], V[2], alpha) * L[2]) +
                        surface_brdf_cos(m.base, V, L) * scale;
        expect_same(layers_brdf_cos(m, V, L, ENERGY_GLTF, t, E_L), expected, 1e-3, "sheen");
    }
}

/* Sheen over black returns color E, over white what is missing to 1 as well: the sheen's furnace. */
static void test_sheen_furnace(void **state)
{
    (void)state;
    const double E[3] = {0.3668602622, 0.4815967431, 0.5342260461}; /* N.V .25, roughness .5 .75 1 */
    for (int r = 0; r < 3; ++r) {
        Layers m = layers_from_surface(
            surface_from_gltf(up, vec3(0.0f), 0.0f, 0.5f, 1.5f, 0.0f, vec3(1.0f), 1.0f, vec3(0.0f)));
        m.layers = LAYER_SHEEN;
        m.sheen_color = vec3(1.0f, 0.5f, 0.0f);
        m.sheen_roughness = golden_roughness[r + 2];
        double rgb[3];
        layered_albedo(m, view_at(0.25f), ENERGY_GLTF, 1u << 13u, rgb);
        expect_near(rgb[0], E[r], 2e-3, "white sheen over black");
        expect_near(rgb[1], 0.5 * E[r], 1e-3, "half of it");
        m.base.base_color = vec3(1.0f);
        layered_albedo(m, view_at(0.25f), ENERGY_CONSERVING, 1u << 13u, rgb);
        expect_near(rgb[0], 1.0, 2e-3, "over white");
        expect_near(rgb[2], 1.0 - E[r], 2e-3,
                    "a color without blue dims white in blue by its largest channel");
    }
}

/* At grazing views of low roughness the lobe's own albedo is above 1; the conserving mode normalises it. */
static void test_sheen_above_one(void **state)
{
    (void)state;
    Layers m = layers_from_surface(surface_from_metallic_roughness(up, vec3(1.0f), 0.0f, 0.5f));
    m.layers = LAYER_SHEEN;
    m.sheen_color = vec3(1.0f, 0.9f, 0.2f);
    m.sheen_roughness = 0.14f;
    double rgb[3];
    assert_true(integrate_sheen_albedo(0.14f, 0.02f, 4096u) > 1.3f);
    layered_albedo(m, view_at(0.02f), ENERGY_GLTF, 1u << 15u, rgb);
    assert_true(rgb[0] > 1.25); /* glTF's lobe is unchanged */
    layered_albedo(m, view_at(0.02f), ENERGY_CONSERVING, 1u << 15u, rgb);
    expect_near(rgb[0], 1.0, 1e-2, "conserving");
    assert_true(rgb[1] < 1.0 && rgb[2] < 1.0);
}

/* ---- film ---- */

/* Reflection, and transmission to the base, by the film's reflectance at N.V: mix(plain, film, factor). */
static void test_iridescence_formula(void **state)
{
    (void)state;
    test_rng rng = {15};
    for (int i = 0; i < 3000; ++i) {
        vec3 V = upper(&rng, 0.1f), L = upper(&rng, 0.1f), H = normalize(V + L);
        Layers m = random_layers(&rng, LAYER_IRIDESCENCE, V, false);
        m.base.metallic = i % 2 ? 1.0f : 0.0f;
        vec3 F0 = i % 2 ? m.base.base_color : m.base.F0;
        vec3 film = F_iridescent(m.iridescence_ior, m.iridescence_thickness_nm, F0, V[2]);
        vec3 F = mix(F_Schlick(F0, vec3(1.0f), dot(V, H)), film, m.iridescence);
        float below =
            mix(1.0f - max3(F_Schlick(F0, vec3(1.0f), dot(V, H))), 1.0f - max3(film), m.iridescence);
        float DV = D_GGX(H[2], m.base.alpha) * V_SmithGGX(L[2], V[2], m.base.alpha);
        vec3 expected = F * (DV * L[2]);
        if (i % 2 == 0)
            expected += m.base.base_color * (INV_PI * below * L[2]);
        expect_same(layers_brdf_cos(m, V, L, ENERGY_GLTF, some_tables(m, V, ENERGY_GLTF), 0.0f), expected,
                    1e-3, "film");
    }
}

/* ---- transmission ---- */

/* Opaque surfaces have no light from behind. */
static void test_opaque(void **state)
{
    (void)state;
    test_rng rng = {17};
    uint opaque = LAYER_CLEARCOAT | LAYER_SHEEN | LAYER_ANISOTROPY | LAYER_IRIDESCENCE;
    for (int i = 0; i < 2000; ++i) {
        vec3 V = upper(&rng, 0.05f);
        Layers m = random_layers(&rng, rng_uint(&rng) & opaque, V, false);
        m.clearcoat_N = up;
        vec3 f = layers_brdf_cos(m, V, -upper(&rng, 0.01f), i % 2, some_tables(m, V, i % 2), 0.0f);
        assert_true(f[0] == 0.0f && f[1] == 0.0f && f[2] == 0.0f);
    }
}

/* transmission replaces diffuse light, entirely at 1; diffuse transmission moves it to the other side; metals
 * transmit nothing. */
static void test_shares(void **state)
{
    (void)state;
    test_rng rng = {19};
    for (int i = 0; i < 2000; ++i) {
        vec3 V = upper(&rng, 0.1f), L = upper(&rng, 0.1f), L_back = mirror_through(L, up);
        Layers m = random_layers(&rng, LAYER_TRANSMISSION | LAYER_DIFFUSE_TRANSMISSION, V, false);
        m.base.metallic = 0.0f;
        m.diffuse_transmission_color = m.base.base_color;
        LayerTables t = some_tables(m, V, ENERGY_GLTF);
        vec3 H = normalize(V + L);
        vec3 specular = F_Schlick(m.base.F0, vec3(1.0f), dot(V, H)) *
                        (D_GGX(H[2], m.base.alpha) * V_SmithGGX(L[2], V[2], m.base.alpha) * L[2]);
        Layers glass = m, leaf = m, metal = m;
        glass.transmission = 1.0f;
        expect_same(layers_brdf_cos(glass, V, L, ENERGY_GLTF, t, 0.0f), specular, 1e-3,
                    "glass reflects only");
        leaf.transmission = 0.0f;
        leaf.diffuse_transmission = 1.0f;
        vec3 plain = surface_brdf_cos(m.base, V, L);
        expect_same(layers_brdf_cos(leaf, V, L_back, ENERGY_GLTF, t, 0.0f) + specular, plain, 1e-3,
                    "what a leaf lets through is what paper reflects");
        metal.base.metallic = 1.0f;
        vec3 f = layers_brdf_cos(metal, V, L_back, ENERGY_GLTF, t, 0.0f);
        assert_true(f[0] == 0.0f && f[1] == 0.0f && f[2] == 0.0f);
    }
}

/* Thin wall and volume agree in a limit: with ior 1 both transmit straight on at any roughness; with ior 1.5
 * the wall still does and the volume refracts. */
static void test_thin_wall_and_volume(void **state)
{
    (void)state;
    vec3 V = view_at(0.6f);
    Layers m = layers_from_surface(
        surface_from_gltf(up, vec3(1.0f), 0.0f, 0.5f, 1.0f, 1.0f, vec3(1.0f), 1.0f, vec3(0.0f)));
    m.layers = LAYER_TRANSMISSION;
    m.transmission = 1.0f;
    m.ior = m.eta = 1.0f;
    vec2 wall = layers_alpha(m, layers_transmission_alpha(m));
    assert_true(wall[0] <= ALPHA_DELTA);
    for (uint i = 0; i < 64; ++i) {
        vec2 u = hammersley(i, 64u);
        TransmissionSample thin = sample_thin_wall(u, V, wall[0], wall[1]);
        TransmissionSample volume = sample_transmission(u, V, m.base.alpha, m.base.alpha, m.eta);
        expect_near((double)length(volume.L + V), 0.0, 1e-5, "volume of air");
        expect_near((double)length(thin.L + V), 0.0, 2e-2, "wall of air");
    }
    TransmissionSample bent = sample_transmission(vec2(0.0f, 0.0f), V, 1e-4f, 1e-4f, 1.5f);
    expect_near((double)bent.L[0], (double)(-V[0] / 1.5f), 1e-3, "Snell");
    TransmissionSample straight = sample_thin_wall(vec2(0.0f, 0.0f), V, 1e-4f, 1e-4f);
    expect_near((double)straight.L[0], (double)-V[0], 1e-3, "straight on");
    /* in a uniform light both are the same glass: all that is not reflected is transmitted */
    LayerLight light = {.transmitted = vec3(1.0f)};
    Layers body = m;
    body.layers |= LAYER_VOLUME;
    for (int energy = 0; energy < 2; ++energy)
        expect_bits(layers_ibl(m, V, exact_tables(m, V, energy), light, energy),
                    layers_ibl(body, V, exact_tables(body, V, energy), light, energy));
}

/* From inside a volume, beyond the critical angle, reflection is total. */
static void test_total_reflection(void **state)
{
    (void)state;
    Layers m = layers_from_surface(surface_from_metallic_roughness(up, vec3(1.0f), 0.0f, 0.0f));
    m.layers = LAYER_TRANSMISSION | LAYER_VOLUME;
    m.transmission = 1.0f;
    m.eta = 1.0f / 1.5f;
    assert_true(layers_is_inside(m));
    LayerLight light = {.specular = vec3(1.0f), .transmitted = vec3(10.0f)};
    for (int energy = 0; energy < 2; ++energy) {
        vec3 V = view_at(0.7f); /* the critical cosine is 0.745 */
        expect_same(layers_ibl(m, V, exact_tables(m, V, energy), light, energy), vec3(1.0f), 1e-6,
                    "all reflected");
        V = view_at(1.0f);
        expect_same(layers_ibl(m, V, exact_tables(m, V, energy), light, energy), vec3(9.64f), 1e-5,
                    "head on");
    }
    vec3 V = view_at(0.7f);
    vec3 f =
        layers_brdf_cos(m, V, vec3(0.0f, 0.0f, -1.0f), ENERGY_GLTF, some_tables(m, V, ENERGY_GLTF), 0.0f);
    assert_true(f[0] < 1e-3f);
}

/* Blue is refracted more: each channel of a dispersive boundary has its own lobe. */
static void test_dispersion(void **state)
{
    (void)state;
    Layers m = layers_from_surface(surface_from_metallic_roughness(up, vec3(1.0f), 0.0f, 0.2f));
    m.layers = LAYER_TRANSMISSION | LAYER_VOLUME | LAYER_DISPERSION;
    m.transmission = 1.0f;
    m.dispersion = 2.0f;
    for (int c = 0; c < 3; ++c) {
        m.eta = 1.5f;
        assert_true(layers_eta(m, c) == dispersed_ior(1.5f, 2.0f, c));
        m.eta = 1.0f / 1.5f;
        expect_near((double)layers_eta(m, c), 1.0 / (double)dispersed_ior(1.5f, 2.0f, c), 1e-6,
                    "from inside");
    }
    m.eta = 1.5f;
    vec3 V = view_at(0.5f);
    LayerTables t = some_tables(m, V, ENERGY_GLTF);
    for (int c = 0; c < 3; ++c) { /* each is brightest for the light that it refracts */
        vec3 L = refract_or_zero(-V, up, layers_eta(m, c));
        vec3 f = layers_brdf_cos(m, V, L, ENERGY_GLTF, t, 0.0f);
        Layers single = m;
        single.layers &= ~LAYER_DISPERSION;
        single.eta = layers_eta(m, c);
        expect_relative(f[c], layers_brdf_cos(single, V, L, ENERGY_GLTF, t, 0.0f)[c], 1e-5, "its own ior");
    }
}

/* Diffusely transmitted light crosses the thickness; occlusion applies on the side of the eye. */
static void test_volume_and_occlusion(void **state)
{
    (void)state;
    Layers m = layers_from_surface(surface_from_metallic_roughness(up, vec3(0.8f), 0.0f, 0.5f));
    m.layers = LAYER_DIFFUSE_TRANSMISSION;
    m.diffuse_transmission = 0.5f;
    vec3 V = view_at(0.8f), L = vec3(0.0f, 0.6f, -0.8f);
    LayerTables t = some_tables(m, V, ENERGY_GLTF);
    vec3 thin = layers_brdf_cos(m, V, L, ENERGY_GLTF, t, 0.0f);
    m.layers |= LAYER_VOLUME;
    m.thickness = 0.3f;
    m.attenuation_color = vec3(0.5f, 0.8f, 0.9f);
    m.attenuation_distance = 0.2f; /* 1.5 distances: color^1.5 */
    vec3 thick = layers_brdf_cos(m, V, L, ENERGY_GLTF, t, 0.0f);
    expect_relative(thick[0], thin[0] * 0.353553390593f, 1e-5, "red");
    expect_relative(thick[2], thin[2] * 0.853814968245f, 1e-5, "blue");

    LayerLight light = {.irradiance_back_over_pi = vec3(1.0f)};
    m.base.occlusion = 0.0f;
    assert_true(layers_ibl(m, V, t, light, ENERGY_GLTF)[0] > 0.1f);
    light = (LayerLight){.specular = vec3(1.0f), .irradiance_over_pi = vec3(1.0f)};
    assert_true(layers_ibl(m, V, t, light, ENERGY_GLTF)[0] == 0.0f);
}

/* ---- reciprocity ---- */

/* f(V, L) = f(L, V) in glTF's mode for the reciprocal layers: base, sheen, anisotropy, thin walls and leaves.
 * Not the coat (N.V), the film (N.V), nor anything in conserving mode (albedo at V). */
static void test_reciprocity(void **state)
{
    (void)state;
    uint reciprocal = LAYER_SHEEN | LAYER_ANISOTROPY | LAYER_TRANSMISSION | LAYER_DIFFUSE_TRANSMISSION;
    test_rng rng = {23};
    for (int i = 0; i < 20000; ++i) {
        vec3 V = upper(&rng, 0.05f), L = upper(&rng, 0.05f);
        Layers m = random_layers(&rng, rng_uint(&rng) & reciprocal, V, false);
        LayerTables at_V = some_tables(m, V, ENERGY_GLTF), at_L = at_V;
        at_V.sheen_E = rng_float(&rng);
        at_L.sheen_E = rng_float(&rng);
        vec3 there = layers_brdf_cos(m, V, L, ENERGY_GLTF, at_V, at_L.sheen_E) / L[2];
        vec3 back = layers_brdf_cos(m, L, V, ENERGY_GLTF, at_L, at_V.sheen_E) / V[2];
        expect_same(there, back, 2e-5, "reflection");
        if (has_layer(m, LAYER_SHEEN))
            continue; /* fibers are on one side only: no symmetry */
        /* the other side's N is -N; a leaf's color is the same from there */
        Layers turned = m;
        turned.base.N = -m.base.N;
        vec3 below = -L;
        there = layers_brdf_cos(m, V, below, ENERGY_GLTF, at_V, 0.0f) / L[2];
        back = layers_brdf_cos(turned, below, V, ENERGY_GLTF, at_L, 0.0f) / V[2];
        expect_same(there, back, 1e-4, "through");
    }
}

/* ---- robustness ---- */

static void test_positive_and_finite(void **state)
{
    (void)state;
    test_rng rng = {31};
    for (int i = 0; i < 400000; ++i) {
        vec3 N = nasty_direction(&rng), V = nasty_direction(&rng), L = nasty_direction(&rng);
        Layers m = nasty_layers(&rng, N);
        int energy = i % 2;
        float A = rng_float(&rng), B = (1.0f - A) * rng_float(&rng);
        float coat_E = nasty_unit(&rng), wall_E = nasty_unit(&rng), sheen_E = 1.5f * nasty_unit(&rng);
        vec3 glass = rng_color(&rng);
        LayerTables t = layer_tables(m, V, energy, vec2(A, B), coat_E, wall_E, sheen_E, glass);
        vec3 f = layers_brdf_cos(m, V, L, energy, t, nasty_unit(&rng));
        vec3 g = layers_ibl(m, V, t, random_light(&rng), energy);
        if (!is_finite3(f) || !is_finite3(g) || !is_finite3(layers_reflection(m, V, energy)))
            fail_msg("layers 0x%x: %g %g", m.layers, (double)f[0], (double)g[0]);
        for (int c = 0; c < 3; ++c)
            if (f[c] < -1e-6f || g[c] < -1e-5f)
                fail_msg("layers 0x%x, energy %d: %g %g", m.layers, energy, (double)f[c], (double)g[c]);
        vec2 p = layers_dfg_point(m, V, energy), q = layers_transmission_point(m, V, energy);
        assert_true(p[0] > 0.0f && p[0] <= 1.0f && p[1] >= 0.0f && p[1] <= 1.0f);
        assert_true(q[0] > 0.0f && q[0] <= 1.0f && q[1] >= 0.0f && q[1] <= 1.0f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_no_layers_is_the_surface),
        cmocka_unit_test(test_factor_zero_is_the_base),
        cmocka_unit_test(test_limits_of_parameters),
        cmocka_unit_test(test_clearcoat_over_black),
        cmocka_unit_test(test_clearcoat_dims_what_is_below),
        cmocka_unit_test(test_sheen_formula),
        cmocka_unit_test(test_sheen_furnace),
        cmocka_unit_test(test_sheen_above_one),
        cmocka_unit_test(test_iridescence_formula),
        cmocka_unit_test(test_opaque),
        cmocka_unit_test(test_shares),
        cmocka_unit_test(test_thin_wall_and_volume),
        cmocka_unit_test(test_total_reflection),
        cmocka_unit_test(test_dispersion),
        cmocka_unit_test(test_volume_and_occlusion),
        cmocka_unit_test(test_reciprocity),
        cmocka_unit_test(test_positive_and_finite),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
