/* layers_direct.h - the layered surface under punctual lights: the BSDF of all lobes, for light from either
 * side. */
#ifndef SHADE_LAYERS_DIRECT_H
#define SHADE_LAYERS_DIRECT_H

/* Lobes that may be excluded from a sum: those that are specular (deltas) where they are narrow. */
#define LOBE_CLEARCOAT 1u
#define LOBE_SPECULAR 2u
#define LOBE_TRANSMISSION 4u
#define LOBES_ALL 7u

/* Weights of a boundary: of the lobe D V with metallic mixed in, of the layers below the dielectric, and
 * of the lobe transmitted through it. */
STRUCT(BoundaryWeights)
{
    vec3 specular;
    float below;
    float through;
};

/* Reflectance of the dielectric for the microfacet's cosine. */
FN vec3 layers_F_base(Layers m, float VdotH)
{
    vec3 F90 = vec3(m.base.F90);
    if (has_layer(m, LAYER_VOLUME))
        return F_Schlick_boundary(m.base.F0, F90, VdotH, m.eta);
    return F_Schlick(m.base.F0, F90, VdotH);
}

/* glTF's weights: the base receives 1 - F of the microfacet at V.H. The film's reflectance is that of N.V,
 * as in Khronos' renderer, and is mixed with the plain one rather than its thickness
 * (KHR_materials_iridescence). */
FN BoundaryWeights boundary_weights_gltf(Layers m, float VdotH, LayerTables t)
{
    vec3 F_base = layers_F_base(m, VdotH);
    vec3 F_metal = F_Schlick(m.base.base_color, vec3(1.0f), VdotH);
    float below = 1.0f - max3(F_base);
    if (has_layer(m, LAYER_IRIDESCENCE)) {
        F_base = mix(F_base, t.film_F_base, t.film_weight);
        F_metal = mix(F_metal, t.film_F_metal, t.film_weight);
        below = mix(below, 1.0f - max3(t.film_F_base), t.film_weight);
    }
    BoundaryWeights w;
    w.specular = mix(F_base, F_metal, m.base.metallic);
    w.below = (1.0f - m.base.metallic) * max(below, 0.0f); /* rounding of total internal reflection */
    w.through = w.below;
    return w;
}

/* Factor on D V that compensates multiple scattering, and the albedo of the lobe with it, for F0 and F90. */
FN vec3 compensation(vec3 F0, vec3 F90, vec2 dfg)
{
    return multiscatter_scale(F_avg(F0, F90), dfg[0] + dfg[1]);
}

/* A dielectric by Fresnel's equations, without film and metal. */
STRUCT(ExactBoundary)
{
    vec3 R;        /* albedo towards V, multiple scattering included */
    vec3 scale;    /* the factor on F D V for it */
    float through; /* factor on the transmitted lobe beside 1 - F; a volume's boundary alone */
};

/* F of layers_is_exact() for the microfacet's cosine. */
FN vec3 layers_F_exact(Layers m, float VdotH)
{
    return F_boundary(m.base.F0, vec3(m.base.F90), VdotH, layers_fresnel_eta(m));
}

/* Both lobes of a volume's boundary share one compensation. A thin wall transmits 1 - R, and its
 * reflection is compensated as for opaque surfaces. */
FN ExactBoundary exact_boundary(Layers m, LayerTables t)
{
    float eta = layers_fresnel_eta(m);
    float E = t.dfg[0] + t.dfg[1];
    vec3 F90 = vec3(m.base.F90);
    ExactBoundary b;
    if (has_layer(m, LAYER_VOLUME)) {
        b.through = glass_compensation(glass_albedo(max3(m.base.F0), m.base.F90, eta, E, t.glass));
        b.scale = vec3(b.through);
        F90 = vec3(sel(eta < 1.0f, 1.0f, m.base.F90)); /* as in glass_albedo() */
    } else {
        float f0 = F0_from_ior(eta);
        vec3 F_mean = m.base.F0 + (F90 - m.base.F0) * ((F_dielectric_avg(eta) - f0) / (1.0f - f0));
        b.through = 1.0f;
        b.scale = multiscatter_scale(F_mean, E);
    }
    b.R = min((m.base.F0 + (F90 - m.base.F0) * t.glass[0]) * b.scale * E, 1.0f);
    return b;
}

/* Energy-conserving weights: the base receives one minus the albedo of the specular lobe towards V, so the
 * sum over all L is at most 1. Transmissive surfaces use Fresnel's equations, and each microfacet of a
 * volume's boundary transmits what it does not reflect. Inside an opaque volume the LUTs do not apply, as
 * F is that of the rarer side; there F(N.V) replaces the albedo, and the lobe is scaled to it. */
FN BoundaryWeights boundary_weights_conserving(Layers m, float NdotV, float VdotH, LayerTables t)
{
    vec3 F90 = vec3(m.base.F90);
    vec3 one = vec3(1.0f);
    float E = t.dfg[0] + t.dfg[1];
    bool is_exact = layers_is_exact(m, ENERGY_CONSERVING);
    vec3 F_base = F_Schlick(m.base.F0, F90, VdotH) * compensation(m.base.F0, F90, t.dfg);
    vec3 F_metal = F_Schlick(m.base.base_color, one, VdotH) * compensation(m.base.base_color, one, t.dfg);
    float below = 1.0f - max3(specular_albedo(m.base.F0, F90, t.dfg));
    float through = below;
    if (is_exact) {
        ExactBoundary b = exact_boundary(m, t);
        vec3 F = layers_F_exact(m, VdotH);
        F_base = F * b.scale;
        below = 1.0f - max3(b.R);
        through = sel(has_layer(m, LAYER_VOLUME), (1.0f - max3(F)) * b.through, below);
    } else if (layers_is_inside(m)) {
        F_base = layers_F_base(m, NdotV);
        below = 1.0f - max3(F_base);
        through = below;
        F_base *= multiscatter_scale(one, E);
    }
    if (has_layer(m, LAYER_IRIDESCENCE)) {
        vec3 film_base = t.film_F_base * multiscatter_scale(t.film_F_base, E);
        vec3 film_metal = t.film_F_metal * multiscatter_scale(t.film_F_metal, E);
        float film_below = 1.0f - max3(film_base) * E;
        float film_through = film_below;
        if (is_exact && has_layer(m, LAYER_VOLUME))
            film_through /= max(t.glass[2], 1.0f / 3.0f); /* the bound of glass_compensation() */
        F_base = mix(F_base, film_base, t.film_weight);
        F_metal = mix(F_metal, film_metal, t.film_weight);
        below = mix(below, film_below, t.film_weight);
        through = mix(through, film_through, t.film_weight);
    }
    BoundaryWeights w;
    w.specular = mix(F_base, F_metal, m.base.metallic);
    w.below = (1.0f - m.base.metallic) * max(below, 0.0f);
    w.through = (1.0f - m.base.metallic) * max(through, 0.0f);
    return w;
}

FN BoundaryWeights boundary_weights(Layers m, float NdotV, float VdotH, int energy, LayerTables t)
{
    if (energy == ENERGY_CONSERVING)
        return boundary_weights_conserving(m, NdotV, VdotH, t);
    return boundary_weights_gltf(m, VdotH, t);
}

/* Distribution of the light below the boundary, per channel; together at most 1. */
STRUCT(BelowShares)
{
    vec3 diffuse;      /* scattered back to the eye's side */
    vec3 diffuse_back; /* scattered through, without a volume's attenuation */
    vec3 specular;     /* transmitted by the boundary, tinted */
    /* Weights of the lobes with the diffuse roughness: of reflection with base_color, and of transmission with
     * diffuse_transmission_color. plain, plain_back: the rest of diffuse, diffuse_back, which is Lambert's. */
    float lobe;
    float lobe_back;
    vec3 plain;
    vec3 plain_back;
};

/* mix(mix(diffuse, diffuse transmission), specular transmission); transmission is applied first, the rest is
 * divided again. In a scattering volume, light that enters diffusely returns as from a deep and dense volume,
 * in the fraction of its multiscatter color: the limit of a mean free path of 0, which ray marching or
 * diffusion resolve better. */
FN BelowShares below_shares(Layers m)
{
    BelowShares s;
    s.diffuse = m.base.base_color;
    s.diffuse_back = vec3(0.0f);
    s.specular = vec3(0.0f);
    s.lobe = 1.0f;
    s.lobe_back = 0.0f;
    s.plain = vec3(0.0f);
    s.plain_back = vec3(0.0f);
    if (has_layer(m, LAYER_DIFFUSE_TRANSMISSION)) {
        s.lobe = 1.0f - m.diffuse_transmission;
        s.lobe_back = m.diffuse_transmission;
        vec3 through = m.diffuse_transmission_color * m.diffuse_transmission;
        s.diffuse *= 1.0f - m.diffuse_transmission;
        s.diffuse_back = through;
        if (has_layer(m, LAYER_SCATTER)) {
            s.diffuse += through * m.multiscatter_color;
            s.diffuse_back = through * (1.0f - m.multiscatter_color);
            s.plain = through * m.multiscatter_color;
            s.plain_back = s.diffuse_back;
            s.lobe_back = 0.0f;
        }
    }
    if (has_layer(m, LAYER_TRANSMISSION)) {
        s.diffuse *= 1.0f - m.transmission;
        s.diffuse_back *= 1.0f - m.transmission;
        s.specular = m.base.base_color * m.transmission;
        s.lobe *= 1.0f - m.transmission;
        s.lobe_back *= 1.0f - m.transmission;
        s.plain *= 1.0f - m.transmission;
        s.plain_back *= 1.0f - m.transmission;
    }
    return s;
}

/* D V of the base's reflection, L on the side of the eye; H and cosines given. */
FN float layers_DV(Layers m, vec3 V, vec3 L, vec3 H, float NdotL, float NdotV)
{
    if (has_layer(m, LAYER_ANISOTROPY)) {
        vec2 a = layers_alpha(m, m.base.alpha);
        vec3 V_local = layers_to_frame(m, V);
        V_local[2] = NdotV;
        return D_GGX_anisotropic(layers_to_frame(m, H), a[0], a[1]) *
               V_SmithGGX_anisotropic(layers_to_frame(m, L), V_local, a[0], a[1]);
    }
    float alpha = max(m.base.alpha, ALPHA_DELTA);
    return D_GGX_stable(clamp(dot(m.base.N, H), 0.0f, 1.0f), cross(m.base.N, H), alpha) *
           V_SmithGGX(NdotL, NdotV, alpha);
}

/* The base for light from the eye's side. */
FN vec3 layers_base_front_cos(Layers m, vec3 V, vec3 L, int energy, LayerTables t, uint lobes)
{
    float NdotL = min(dot(m.base.N, L), 1.0f);
    float NdotV = surface_NdotV(m.base, V);
    vec3 sum = V + L;
    float sum2 = dot(sum, sum);
    if (sum2 < 1e-12f)
        return vec3(0.0f);
    float inverse = inversesqrt(sum2);
    float VdotH = min(0.5f * sum2 * inverse, 1.0f);
    BoundaryWeights w = boundary_weights(m, NdotV, VdotH, energy, t);
    vec3 specular = vec3(0.0f);
    if ((lobes & LOBE_SPECULAR) != 0u)
        specular = w.specular * layers_DV(m, V, L, sum * inverse, NdotL, NdotV);
    BelowShares share = below_shares(m);
    vec3 diffuse = brdf_lambert(share.diffuse);
    if (has_layer(m, LAYER_DIFFUSE_ROUGHNESS))
        diffuse = brdf_lambert(share.plain) +
                  brdf_eon(m.base.base_color, m.diffuse_roughness, NdotL, NdotV, dot(L, V)) * share.lobe;
    return (specular + diffuse * w.below) * NdotL;
}

/* v in a frame of N: with the tangents of the base, or any without anisotropy. */
FN vec3 layers_to_any_frame(Layers m, vec3 v)
{
    if (has_layer(m, LAYER_ANISOTROPY))
        return layers_to_frame(m, v);
    return mul(transpose(basis_from_normal(m.base.N)), v);
}

/* Specular transmission through a thin wall, without boundary_weights() and tint. */
FN float layers_thin_wall_cos(Layers m, vec3 V, vec3 L, int energy, LayerTables t)
{
    vec2 a = layers_alpha(m, layers_transmission_alpha(m));
    float f = thin_wall_cos(V, L, a[0], a[1]);
    return sel(energy == ENERGY_CONSERVING, f / max(t.transmission_E, 1e-3f), f);
}

/* Cosine at the microfacet that transmits L through a volume's boundary; N.V if there is none. */
FN float transmission_VdotH(vec3 V, vec3 L, float eta)
{
    float VdotH = dot(V, half_vector_transmission(V, L, eta));
    return sel(VdotH > 0.0f, min(VdotH, 1.0f), V[2]);
}

/* The same through a volume's boundary of one ior, weighted. V and L in the base's frame. */
FN float layers_volume_cos1(Layers m, vec3 V, vec3 L, float eta, int energy, LayerTables t)
{
    vec2 a = layers_alpha(m, m.base.alpha);
    float VdotH = transmission_VdotH(V, L, eta);
    return btdf_GGX_cos(V, L, a[0], a[1], eta) * boundary_weights(m, V[2], VdotH, energy, t).through;
}

/* Per channel, each with its own ior if the volume disperses. */
FN vec3 layers_volume_cos(Layers m, vec3 V, vec3 L, int energy, LayerTables t)
{
    int last = sel(has_layer(m, LAYER_DISPERSION), 2, 0);
    vec3 f = vec3(0.0f);
    for (int channel = 0; channel <= last; ++channel)
        f[channel] = layers_volume_cos1(m, V, L, layers_eta(m, channel), energy, t);
    return sel(last == 0, vec3(f[0]), f);
}

/* The base for light from behind. The microfacet of straight transmission is that of L mirrored to V's side. */
FN vec3 layers_base_back_cos(Layers m, vec3 V_world, vec3 L_world, int energy, LayerTables t, uint lobes)
{
    vec3 V = layers_to_any_frame(m, V_world);
    vec3 L = layers_to_any_frame(m, L_world);
    V[2] = surface_NdotV(m.base, V_world);
    vec3 sum = V + vec3(L[0], L[1], -L[2]);
    float VdotH = min(0.5f * length(sum), 1.0f);
    BelowShares share = below_shares(m);
    BoundaryWeights w = boundary_weights(m, V[2], VdotH, energy, t);
    vec3 diffuse = brdf_lambert(share.diffuse_back);
    if (has_layer(m, LAYER_DIFFUSE_ROUGHNESS)) {
        float LdotV = V[0] * L[0] + V[1] * L[1] - V[2] * L[2]; /* of L mirrored to the side of V */
        diffuse = brdf_lambert(share.plain_back) +
                  brdf_eon(m.diffuse_transmission_color, m.diffuse_roughness, min(-L[2], 1.0f), V[2], LdotV) *
                      share.lobe_back;
    }
    vec3 f = diffuse * (w.below * -L[2]);
    bool is_volume = has_layer(m, LAYER_VOLUME);
    if (is_volume)
        f *= volume_transmittance(m.attenuation_color, m.attenuation_distance, m.thickness);
    if ((lobes & LOBE_TRANSMISSION) == 0u)
        return f;
    if (is_volume)
        return f + share.specular * layers_volume_cos(m, V, L, energy, t);
    return f + share.specular * (w.through * layers_thin_wall_cos(m, V, L, energy, t));
}

/* The base, below sheen and coat. */
FN vec3 layers_base_cos(Layers m, vec3 V, vec3 L, int energy, LayerTables t, uint lobes)
{
    float NdotL = dot(m.base.N, L);
    if ((m.layers & ~(LAYER_CLEARCOAT | LAYER_SHEEN)) == 0u) {
        SurfaceLobes plain = surface_lobes_cos(m.base, V, L, energy, t.dfg);
        if ((lobes & LOBE_SPECULAR) == 0u)
            return plain.diffuse;
        return plain.specular + plain.diffuse;
    }
    if (NdotL > 0.0f)
        return layers_base_front_cos(m, V, L, energy, t, lobes);
    if (NdotL < 0.0f && (has_layer(m, LAYER_TRANSMISSION) || has_layer(m, LAYER_DIFFUSE_TRANSMISSION)))
        return layers_base_back_cos(m, V, L, energy, t, lobes);
    return vec3(0.0f);
}

/* Sheen over f, the layers below. glTF dims by the larger albedo of both directions, which is reciprocal;
 * ENERGY_CONSERVING by that at V, with which lobe and base add up, and limits the lobe's own albedo to 1.
 * Light from behind has no direction on the fibers' side. KHR_materials_sheen. */
FN vec3 layers_sheen_cos(Layers m, vec3 V, vec3 L, int energy, LayerTables t, float sheen_E_L, vec3 f)
{
    float NdotL = min(dot(m.base.N, L), 1.0f);
    vec3 sum = V + L;
    float sum2 = dot(sum, sum);
    float E = t.sheen_E;
    if (NdotL <= 0.0f || sum2 < 1e-12f)
        return f * sheen_scaling(m.sheen_color, E);
    float lobe = 1.0f;
    if (energy == ENERGY_CONSERVING)
        lobe = 1.0f / max(max3(m.sheen_color) * E, 1.0f);
    else
        E = max(E, sheen_E_L);
    float NdotH = clamp(dot(m.base.N, sum) * inversesqrt(sum2), 0.0f, 1.0f);
    lobe *= brdf_sheen(NdotL, surface_NdotV(m.base, V), NdotH, sheen_alpha(m.sheen_roughness)) * NdotL;
    return m.sheen_color * lobe + f * sheen_scaling(m.sheen_color, E);
}

/* The coat over f: mix(f, coat, clearcoat F(N.V)). glTF's lobe loses multiple scattering; ENERGY_CONSERVING's
 * does not. KHR_materials_clearcoat. */
FN vec3 layers_clearcoat_cos(Layers m, vec3 V, vec3 L, int energy, LayerTables t, vec3 f, uint lobes)
{
    float NdotV = layers_clearcoat_NdotV(m, V);
    float coat = 0.0f;
    if ((lobes & LOBE_CLEARCOAT) != 0u)
        coat = clearcoat_lobe_cos(m.clearcoat_N, NdotV, V, L, alpha_from_roughness(m.clearcoat_roughness));
    if (energy == ENERGY_CONSERVING)
        coat /= max(t.clearcoat_E, 1e-3f);
    return mix(f, vec3(coat), m.clearcoat * F_clearcoat(NdotV));
}

/* BSDF times |N.L|, in 1/sr, of light from either side. energy is one of ENERGY_*; sheen_E_L is the
 * directional albedo of the sheen at N.L, read by LAYER_SHEEN for light from the eye's side. */
FN vec3 layers_brdf_cos(Layers m, vec3 V, vec3 L, int energy, LayerTables t, float sheen_E_L)
{
    vec3 f = layers_base_cos(m, V, L, energy, t, LOBES_ALL);
    if (has_layer(m, LAYER_SHEEN))
        f = layers_sheen_cos(m, V, L, energy, t, sheen_E_L, f);
    if (has_layer(m, LAYER_CLEARCOAT))
        f = layers_clearcoat_cos(m, V, L, energy, t, f, LOBES_ALL);
    return f;
}

/* Radiance (cd/m^2 per channel) reflected at P (m) towards the unit vector V from one unshadowed light. */
FN vec3 layers_punctual(Layers m, vec3 P, vec3 V, Light l, int energy, LayerTables t, float sheen_E_L)
{
    LightSample light = light_illuminate(l, P);
    m.base.alpha = max(m.base.alpha, ALPHA_MIN);
    m.clearcoat_roughness = max(m.clearcoat_roughness, ROUGHNESS_MIN);
    return layers_brdf_cos(m, V, light.L, energy, t, sheen_E_L) * light.E;
}

#endif
