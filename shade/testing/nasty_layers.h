/* nasty_layers.h - surfaces and directions at the limits of their domains: zeros, ones, numbers that
 * underflow when squared, normals that face away. Includes test_support.h. */
#ifndef SHADE_NASTY_LAYERS_H
#define SHADE_NASTY_LAYERS_H

#include "test_support.h"

static inline __attribute__((unused)) vec3 nasty_direction(test_rng *rng)
{
    switch (rng_uint(rng) % 8u) {
    case 0:
        return vec3(0.0f, 0.0f, 1.0f);
    case 1:
        return vec3(0.0f, 0.0f, -1.0f);
    case 2:
        return vec3(1.0f, 0.0f, 0.0f);
    case 3:
        return normalize(vec3(-1.0f, 1e-20f, 1e-6f));
    default:
        return rng_direction(rng);
    }
}
static inline float nasty_unit(test_rng *rng)
{
    const float values[] = {0.0f, 1.0f, 1e-40f, 1e-20f};
    uint32_t k = rng_uint(rng) % 10u;
    return k < COUNT_OF(values) ? values[k] : rng_float(rng);
}
static inline __attribute__((unused)) Layers nasty_layers(test_rng *rng, vec3 N)
{
    vec3 base = rng_color(rng);
    float metallic = nasty_unit(rng), roughness = nasty_unit(rng), specular = nasty_unit(rng);
    float ior = rng_uint(rng) % 4u ? 1.0f + nasty_unit(rng) : 0.0f;
    Surface s = surface_from_gltf(N, base, metallic, roughness, ior, specular, vec3(1.0f), 1.0f, vec3(0.0f));
    uint layers = rng_uint(rng) % 1024u;
    Layers m = random_layers(rng, layers, N, false);
    mat3 basis = basis_from_normal(N);
    m.base = s;
    m.anisotropy_T = COL(basis, 0);
    m.anisotropy_B = COL(basis, 1);
    m.clearcoat_N = nasty_direction(rng);
    m.clearcoat_roughness = nasty_unit(rng);
    m.sheen_roughness = nasty_unit(rng);
    m.anisotropy = nasty_unit(rng);
    m.diffuse_roughness = nasty_unit(rng);
    m.iridescence_thickness_nm = 2000.0f * nasty_unit(rng);
    m.attenuation_distance = nasty_unit(rng);
    if (rng_uint(rng) % 8u == 0)
        m.eta = m.ior = 1.0f;
    if (rng_uint(rng) % 16u == 0)
        m.ior = 0.0f;
    return m;
}

#endif
