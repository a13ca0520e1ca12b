/* layer_albedo.h - the albedo of the layered surface in a uniform light of 1, integrated over the whole
 * sphere, and its LUT values, integrated on the spot. Includes test_support.h. */
#ifndef SHADE_LAYER_ALBEDO_H
#define SHADE_LAYER_ALBEDO_H

#include "test_support.h"

static inline vec2 table_dfg(vec2 point, uint n)
{
    return integrate_dfg(point[1], point[0], n);
}
/* By n terms each; sheen and glass, which are smoother, by half and a quarter of them. */
static inline LayerTables tables_by(Layers m, vec3 V, int energy, uint n)
{
    vec2 dfg = table_dfg(layers_dfg_point(m, V, energy), n);
    vec2 coat = vec2(1.0f, 0.0f), wall = vec2(1.0f, 0.0f);
    float sheen = 0.0f;
    if (has_layer(m, LAYER_CLEARCOAT))
        coat = table_dfg(vec2(layers_clearcoat_NdotV(m, V), m.clearcoat_roughness), n);
    if (has_layer(m, LAYER_TRANSMISSION))
        wall = table_dfg(layers_transmission_point(m, V, energy), n);
    if (has_layer(m, LAYER_SHEEN))
        sheen = integrate_sheen_albedo(m.sheen_roughness, surface_NdotV(m.base, V), n / 2u);
    vec3 glass = vec3(0.0f);
    if (layers_is_exact(m, energy)) {
        vec3 p = layers_glass_point(m, V, energy);
        glass = integrate_glass(p[1], p[0], p[2], n / 4u);
    }
    return layer_tables(m, V, energy, dfg, coat[0] + coat[1], wall[0] + wall[1], sheen, glass);
}
static inline LayerTables exact_tables(Layers m, vec3 V, int energy)
{
    return tables_by(m, V, energy, 8192u);
}

/* E of the sheen over N.L, interpolated over its square root. */
typedef struct sheen_curve {
    float E[65];
} sheen_curve;
static inline sheen_curve sheen_curve_of(Layers m)
{
    sheen_curve curve = {{0.0f}};
    for (int i = 0; has_layer(m, LAYER_SHEEN) && i <= 64; ++i) {
        float root = max((float)i, 0.5f) / 64.0f;
        curve.E[i] = integrate_sheen_albedo(m.sheen_roughness, root * root, 256u);
    }
    return curve;
}
static inline float sheen_curve_at(const sheen_curve *curve, float NdotL)
{
    float x = sqrt(clamp(NdotL, 0.0f, 1.0f)) * 64.0f;
    int i = (int)min(x, 63.0f);
    return mix(curve->E[i], curve->E[i + 1], x - (float)i);
}

/* Six strategies to sample L for one view (the zero vector: no direction); N is +z, T is +x. Their mean
 * density is that of all samples together. */
enum { STRATEGIES = 6 };
typedef struct layer_sampler {
    Layers m;
    vec3 V, V_coat;
    mat3 coat_basis;
    vec2 alpha, alpha_through;
    float coat_alpha;
} layer_sampler;

static inline layer_sampler layer_sampler_make(Layers m, vec3 V)
{
    layer_sampler s = {.m = m, .V = V};
    s.coat_basis = basis_from_normal(m.clearcoat_N);
    s.V_coat = mul(transpose(s.coat_basis), V);
    s.alpha = layers_alpha(m, m.base.alpha);
    s.alpha_through = layers_alpha(m, layers_transmission_alpha(m));
    s.coat_alpha = max(alpha_from_roughness(m.clearcoat_roughness), 1e-3f);
    return s;
}
static inline float pdf_reflected(vec3 V, vec3 L, float ax, float ay)
{
    vec3 H = normalize(V + L);
    return H[2] > 0.0f ? pdf_VNDF_GGX(V, H, ax, ay) / max(4.0f * dot(V, H), 1e-9f) : 0.0f;
}
static inline vec3 layer_draw(const layer_sampler *s, int strategy, vec2 u)
{
    vec3 d = sample_cosine(u);
    switch (strategy) {
    case 0:
        return d;
    case 1:
        return -d;
    case 2:
        return reflect(-s->V, sample_VNDF_GGX(u, s->V, s->alpha[0], s->alpha[1]));
    case 3:
        return mul(s->coat_basis,
                   reflect(-s->V_coat, sample_VNDF_GGX(u, s->V_coat, s->coat_alpha, s->coat_alpha)));
    case 4:
        return vec3(sqrt(1.0f - u[1] * u[1]) * cos(2.0f * PI * u[0]),
                    sqrt(1.0f - u[1] * u[1]) * sin(2.0f * PI * u[0]), u[1]);
    default:
        break;
    }
    TransmissionSample t = has_layer(s->m, LAYER_VOLUME)
                               ? sample_transmission(u, s->V, s->alpha[0], s->alpha[1], s->m.eta)
                               : sample_thin_wall(u, s->V, s->alpha_through[0], s->alpha_through[1]);
    return t.pdf > 0.0f ? t.L : vec3(0.0f);
}
static inline float layer_pdf(const layer_sampler *s, vec3 L)
{
    float through = has_layer(s->m, LAYER_VOLUME)
                        ? pdf_transmission(s->V, L, s->alpha[0], s->alpha[1], s->m.eta)
                        : pdf_thin_wall(s->V, L, s->alpha_through[0], s->alpha_through[1]);
    vec3 L_coat = mul(transpose(s->coat_basis), L);
    return (pdf_cosine(L[2]) + pdf_cosine(-L[2]) + pdf_reflected(s->V, L, s->alpha[0], s->alpha[1]) +
            pdf_reflected(s->V_coat, L_coat, s->coat_alpha, s->coat_alpha) +
            (L[2] > 0.0f ? 0.5f * INV_PI : 0.0f) + through) /
           (float)STRATEGIES;
}

/* The integral of layers_brdf_cos over the sphere, per channel, by n samples of each strategy. */
static inline void layered_albedo_of(Layers m, vec3 V, int energy, LayerTables t, uint n, double out[3])
{
    layer_sampler s = layer_sampler_make(m, V);
    sheen_curve curve = {{0.0f}};
    if (energy == ENERGY_GLTF)
        curve = sheen_curve_of(m);
    out[0] = out[1] = out[2] = 0.0;
    for (int strategy = 0; strategy < STRATEGIES; ++strategy)
        for (uint i = 0; i < n; ++i) {
            vec3 L = layer_draw(&s, strategy, hammersley(i, n) + 0.5f / (float)n);
            if (dot(L, L) < 0.5f)
                continue;
            float pdf = layer_pdf(&s, L);
            vec3 f = layers_brdf_cos(m, V, L, energy, t, sheen_curve_at(&curve, L[2]));
            assert_true(is_finite3(f) && f[0] >= -1e-6f && f[1] >= -1e-6f && f[2] >= -1e-6f);
            for (int c = 0; c < 3 && pdf > 0.0f; ++c)
                out[c] += (double)f[c] / ((double)pdf * STRATEGIES * n);
        }
}

static inline __attribute__((unused)) void layered_albedo(Layers m, vec3 V, int energy, uint n, double out[3])
{
    layered_albedo_of(m, V, energy, exact_tables(m, V, energy), n, out);
}

/* A surface of random parameters with these layers, seen from V; N is +z, and V is above the coat too.
 * Roughness from 0.15 on, so that the draws above suffice. */
static inline __attribute__((unused)) Layers random_layers(test_rng *rng, uint layers, vec3 V, bool is_white)
{
    vec3 up = vec3(0.0f, 0.0f, 1.0f);
    vec3 base = rng_color(rng), specular_color = rng_color(rng) * 2.0f;
    float metallic = rng_uint(rng) % 2u ? 0.0f : rng_float(rng), ior = 1.05f + rng_float(rng);
    if (is_white) {
        base = vec3(1.0f);
        specular_color = vec3(1.0f);
    }
    Surface s = surface_from_gltf(up, base, metallic, 0.15f + 0.85f * rng_float(rng), ior, 1.0f,
                                  specular_color, 1.0f, vec3(0.0f));
    Layers m = layers_from_surface(s);
    m.layers = layers;
    m.ior = ior;
    m.eta = rng_uint(rng) % 3u ? ior : 1.0f / ior;
    m.clearcoat = rng_float(rng);
    m.clearcoat_roughness = 0.15f + 0.85f * rng_float(rng);
    vec2 tilt = rng_vec2(rng) * 0.1f;
    m.clearcoat_N = normalize(vec3(tilt[0], tilt[1], 1.0f));
    if (dot(m.clearcoat_N, V) < 0.02f)
        m.clearcoat_N = up;
    m.sheen_color = is_white ? vec3(1.0f) : rng_color(rng);
    m.sheen_roughness = 0.1f + 0.9f * rng_float(rng);
    m.anisotropy = rng_float(rng);
    m.anisotropy_T = vec3(1.0f, 0.0f, 0.0f);
    m.anisotropy_B = vec3(0.0f, 1.0f, 0.0f);
    m.iridescence = rng_float(rng);
    m.iridescence_ior = 1.1f + rng_float(rng);
    m.iridescence_thickness_nm = 800.0f * rng_float(rng);
    m.transmission = rng_float(rng);
    m.diffuse_transmission = rng_float(rng);
    m.diffuse_transmission_color = is_white ? vec3(1.0f) : rng_color(rng);
    m.thickness = is_white ? 0.0f : 0.1f * rng_float(rng);
    m.attenuation_color = rng_color(rng);
    m.attenuation_distance = 0.1f;
    m.dispersion = rng_float(rng);
    m.multiscatter_color = rng_color(rng);
    m.diffuse_roughness = rng_float(rng);
    return m;
}

#endif
