/* layers.h - the glTF surface with its material extensions: parameters and lookup coordinates of its lobes.
 * Evaluation is in layers_direct.h (punctual lights) and layers_ibl.h (environment). Outermost first:
 *
 *   clearcoat > sheen > mix(metallic) of
 *     metal:      specular                                iridescence replaces F, anisotropy D and V
 *     dielectric: specular over mix(transmission) of
 *       specular transmission                             a thin wall, or the boundary of a volume
 *       mix(diffuse transmission) of diffuse reflection and diffuse transmission
 *
 * Values are passed in; no texture is read here. Both energy modes are those of surface.h: ENERGY_GLTF
 * mixes as specified by the extensions, ENERGY_CONSERVING never gains energy. */
#ifndef SHADE_LAYERS_H
#define SHADE_LAYERS_H

#define LAYER_CLEARCOAT 1u
#define LAYER_SHEEN 2u
#define LAYER_ANISOTROPY 4u
#define LAYER_IRIDESCENCE 8u
#define LAYER_TRANSMISSION 16u
#define LAYER_DIFFUSE_TRANSMISSION 32u
#define LAYER_VOLUME 64u
#define LAYER_DISPERSION 128u
#define LAYER_SCATTER 256u
#define LAYER_DIFFUSE_ROUGHNESS 512u

/* A shaded point. Members of a layer whose bit is not in `layers` are ignored. Start from
 * layers_from_surface(). */
STRUCT(Layers)
{
    Surface base;
    uint layers; /* LAYER_* that are active: their factor, after textures, is above 0 */
    float ior;   /* of the dielectric, >= 1; 0: infinite, F = 1 */
    /* ior beyond the surface / ior on the eye's side: ior seen from outside, 1 / ior from inside */
    float eta;
    /* LAYER_CLEARCOAT */
    float clearcoat;           /* [0, 1] */
    float clearcoat_roughness; /* [0, 1], perceptual */
    vec3 clearcoat_N;          /* unit, on the side of the eye */
    /* LAYER_SHEEN */
    vec3 sheen_color;      /* [0, 1] */
    float sheen_roughness; /* [0, 1], perceptual */
    /* LAYER_ANISOTROPY */
    float anisotropy;  /* strength, [0, 1] */
    vec3 anisotropy_T; /* unit, perpendicular to N: the direction in which highlights are stretched */
    vec3 anisotropy_B; /* unit, cross(N, T) or its opposite */
    /* LAYER_IRIDESCENCE */
    float iridescence;              /* [0, 1] */
    float iridescence_ior;          /* of the film, >= 1 */
    float iridescence_thickness_nm; /* >= 0 */
    /* LAYER_TRANSMISSION */
    float transmission; /* [0, 1]: fraction of the light that enters the dielectric */
    /* LAYER_DIFFUSE_TRANSMISSION */
    float diffuse_transmission;      /* [0, 1]: fraction of the light neither reflected nor transmitted */
    vec3 diffuse_transmission_color; /* [0, 1] */
    /* LAYER_VOLUME: set where the thickness is above 0; without it a wall is thin */
    float thickness;        /* m, in world scale: for diffuse transmission; rays use the traced distance */
    vec3 attenuation_color; /* [0, 1] */
    float attenuation_distance; /* m; infinity: no absorption */
    /* LAYER_DISPERSION */
    float dispersion; /* 20 / Abbe number; not read by the lobes here */
    /* LAYER_SCATTER */
    vec3 multiscatter_color;  /* [0, 1]: albedo of a deep volume */
    float scatter_anisotropy; /* g of Henyey and Greenstein, (-1, 1) */
    /* LAYER_DIFFUSE_ROUGHNESS: of diffuse reflection and transmission; without it both are Lambert's */
    float diffuse_roughness; /* [0, 1] */
};

/* View-dependent terms, computed once per point for all lights by layer_tables(). */
STRUCT(LayerTables)
{
    vec2 dfg;             /* (A, B) of the split sum at layers_dfg_point() */
    float clearcoat_E;    /* A + B at layers_clearcoat_NdotV() and clearcoat_roughness */
    float transmission_E; /* A + B at layers_transmission_point() */
    vec3 glass;           /* integrate_glass() at layers_glass_point(), where layers_is_exact() */
    float sheen_E;     /* Charlie's directional albedo at surface_NdotV() and sheen_roughness; not clamped */
    float film_weight; /* iridescence, faded out for a film of no thickness */
    vec3 film_F_base;  /* reflectance of the film over the dielectric and over the metal, at N.V */
    vec3 film_F_metal;
};

/* Radiance of the environment for a rough diffuse lobe: eon_single_light(), eon_multiple_light(). */
STRUCT(RoughLight)
{
    vec3 single;
    vec3 multiple;
};

/* Radiance of the environment, cd/m^2. Members of inactive layers are ignored. */
STRUCT(LayerLight)
{
    vec3 specular;                /* prefiltered for layers_reflection() and the base's roughness */
    vec3 irradiance_over_pi;      /* around N */
    vec3 irradiance_back_over_pi; /* around -N */
    vec3 clearcoat;               /* prefiltered for layers_clearcoat_reflection() and its roughness */
    vec3 sheen;                   /* prefiltered around N with the mean of Charlie's lobe over views */
    vec3 transmitted; /* along the refracted rays, with attenuation, without the boundary's tint and 1 - F */
    RoughLight rough, rough_back; /* around N, and around -N for the mirrored V */
};

/* The surface without layers, every member neutral. */
FN Layers layers_from_surface(Surface s)
{
    Layers m;
    m.base = s;
    m.layers = 0u;
    m.ior = 1.5f;
    m.eta = 1.5f;
    m.clearcoat = 0.0f;
    m.clearcoat_roughness = 0.0f;
    m.clearcoat_N = s.N;
    m.sheen_color = vec3(0.0f);
    m.sheen_roughness = 0.0f;
    m.anisotropy = 0.0f;
    m.anisotropy_T = vec3(1.0f, 0.0f, 0.0f);
    m.anisotropy_B = vec3(0.0f, 1.0f, 0.0f);
    m.iridescence = 0.0f;
    m.iridescence_ior = 1.3f;
    m.iridescence_thickness_nm = 0.0f;
    m.transmission = 0.0f;
    m.diffuse_transmission = 0.0f;
    m.diffuse_transmission_color = vec3(1.0f);
    m.thickness = 0.0f;
    m.attenuation_color = vec3(1.0f);
    m.attenuation_distance = 1e30f;
    m.dispersion = 0.0f;
    m.multiscatter_color = vec3(0.0f);
    m.scatter_anisotropy = 0.0f;
    m.diffuse_roughness = 0.0f;
    return m;
}

FN bool has_layer(Layers m, uint layer)
{
    return (m.layers & layer) != 0u;
}

/* ---- the base's lobe ---- */

/* V or L in the frame in which the base's lobe is axis-aligned; without anisotropy any tangent serves. */
FN vec3 layers_to_frame(Layers m, vec3 v)
{
    return to_frame(v, m.anisotropy_T, m.anisotropy_B, m.base.N);
}

/* GGX widths (along T, along B) of reflection at the base, from the width without anisotropy. */
FN vec2 layers_alpha(Layers m, float alpha)
{
    float strength = sel(has_layer(m, LAYER_ANISOTROPY), m.anisotropy, 0.0f);
    return max(anisotropic_alpha(alpha, strength), ALPHA_DELTA);
}

/* Width of the specular transmission without anisotropy: a volume's boundary has the roughness of its
 * reflection, a thin wall blurs by its ior. */
FN float layers_transmission_alpha(Layers m)
{
    return sel(has_layer(m, LAYER_VOLUME), m.base.alpha, thin_wall_alpha(m.base.alpha, m.ior));
}

/* ior beyond the surface over that on the eye's side, at the center of a channel (0 red, 1 green, 2 blue). */
FN float layers_eta(Layers m, int channel)
{
    if (!has_layer(m, LAYER_DISPERSION))
        return m.eta;
    float far_ior = dispersed_ior(m.eta, m.dispersion, channel);
    float near_ior = dispersed_ior(1.0f / m.eta, m.dispersion, channel);
    return sel(m.eta < 1.0f, 1.0f / near_ior, far_ior);
}

/* Whether the eye is in the denser medium of a volume. */
FN bool layers_is_inside(Layers m)
{
    return has_layer(m, LAYER_VOLUME) && m.eta < 1.0f;
}

/* Whether the dielectric reflects by Fresnel's equations (F_boundary()): where it transmits and energy is
 * conserved, so that both reflection and transmission are exact. Otherwise, and for an infinite ior, by
 * Schlick's approximation. */
FN bool layers_is_exact(Layers m, int energy)
{
    return energy == ENERGY_CONSERVING && has_layer(m, LAYER_TRANSMISSION) && m.ior >= 1.0f;
}

/* eta of F_boundary(). The two sides of a thin wall are one boundary, seen from outside. */
FN float layers_fresnel_eta(Layers m)
{
    return sel(has_layer(m, LAYER_VOLUME), m.eta, m.ior);
}

/* ---- lookups: directions and LUT coordinates ---- */

/* Whether LUT lookups account for anisotropy. Khronos' renderer ignores it. */
FN bool layers_reads_anisotropic(Layers m, int energy)
{
    return energy == ENERGY_CONSERVING && has_layer(m, LAYER_ANISOTROPY);
}

/* (N.V, perceptual roughness) of the lookup of LayerTables.dfg. */
FN vec2 layers_dfg_point(Layers m, vec3 V, int energy)
{
    if (layers_reads_anisotropic(m, energy))
        return anisotropic_table_point(layers_to_frame(m, V), layers_alpha(m, m.base.alpha));
    return vec2(surface_NdotV(m.base, V), m.base.perceptual_roughness);
}

/* (N.V, perceptual roughness, eta) of LayerTables.glass. */
FN vec3 layers_glass_point(Layers m, vec3 V, int energy)
{
    vec2 p = layers_dfg_point(m, V, energy);
    return vec3(p[0], p[1], layers_fresnel_eta(m));
}

/* The same for LayerTables.transmission_E. */
FN vec2 layers_transmission_point(Layers m, vec3 V, int energy)
{
    float alpha = layers_transmission_alpha(m);
    if (layers_reads_anisotropic(m, energy))
        return anisotropic_table_point(layers_to_frame(m, V), layers_alpha(m, alpha));
    return vec2(surface_NdotV(m.base, V), sqrt(alpha));
}

/* N.V of the coat. */
FN float layers_clearcoat_NdotV(Layers m, vec3 V)
{
    return clamp(dot(m.clearcoat_N, V), NDOTV_MIN, 1.0f);
}

/* Unit direction of the lookup of LayerLight.specular, where that is a single one: not layers_reads_anisotropic(). */
FN vec3 layers_reflection(Layers m, vec3 V, int energy)
{
    if (has_layer(m, LAYER_ANISOTROPY))
        return anisotropic_reflection(m.base.N, m.anisotropy_B, V, m.anisotropy, m.base.perceptual_roughness);
    return surface_reflection(m.base, V, energy);
}

/* Lookup k of ANISOTROPY_LOOKUPS of LayerLight.specular where layers_reads_anisotropic(), L in world space. */
FN AnisotropicLookup layers_anisotropic_lookup(Layers m, vec3 V, int k)
{
    AnisotropicLookup s = anisotropic_lookup(k, layers_to_frame(m, V), layers_alpha(m, m.base.alpha),
                                             surface_facing_reflectance(m.base));
    s.L = m.anisotropy_T * s.L[0] + m.anisotropy_B * s.L[1] + m.base.N * s.L[2];
    return s;
}

/* Of the lookup of LayerLight.clearcoat. The lobe has no Fresnel term of its own (F_clearcoat()): F0 = 1. */
FN vec3 layers_clearcoat_reflection(Layers m, vec3 V, int energy)
{
    return specular_reflection(m.clearcoat_N, V, alpha_from_roughness(m.clearcoat_roughness), 1.0f, energy);
}

/* Terms of a boundary for an anisotropic lobe, from those of the isotropic one and the split sums of both:
 * the mean weight scales with that of Schlick's, losses are underestimated as those of E are. Seen from
 * inside, where total internal reflection depends on the width, both are bounds found by comparing
 * quadratures. */
FN vec3 layers_glass_bound(vec3 glass, vec2 dfg, vec2 bound, vec2 alpha, float eta)
{
    float share = dfg[1] * (bound[0] + bound[1]);
    float w = clamp(glass[0] * bound[1] * (dfg[0] + dfg[1]) / max(share, 1e-6f), 0.0f, 1.0f);
    float lost = clamp((1.0f - bound[0] - bound[1]) / max(1.0f - dfg[0] - dfg[1], 1e-6f), 0.0f, 1.0f);
    if (eta < 1.0f) {
        vec2 a2 = alpha * alpha;
        float k = abs(a2[0] - a2[1]) / max(a2[0] + a2[1], 1e-12f);
        w = glass[0] + (1.0f - glass[0]) * min(1.2f * k, 1.0f);
        lost = 1.0f - k;
    }
    return vec3(w, 1.0f - (1.0f - glass[1]) * lost, 1.0f - (1.0f - glass[2]) * lost);
}

/* dfg, clearcoat_E, transmission_E, sheen_E, glass as described in LayerTables; those after the first are
 * ignored where their layer is off. */
FN LayerTables layer_tables(Layers m, vec3 V, int energy, vec2 dfg, float clearcoat_E, float transmission_E,
                            float sheen_E, vec3 glass)
{
    LayerTables t;
    t.dfg = dfg;
    t.glass = glass;
    vec2 alpha = layers_alpha(m, m.base.alpha);
    t.clearcoat_E = clearcoat_E;
    t.transmission_E = transmission_E;
    t.sheen_E = sheen_E;
    t.film_weight = 0.0f;
    t.film_F_base = m.base.F0;
    t.film_F_metal = m.base.base_color;
    if (layers_reads_anisotropic(m, energy)) {
        vec3 V_local = layers_to_frame(m, V);
        t.dfg = anisotropic_table_bound(dfg, V_local, alpha);
        vec2 wall = layers_alpha(m, layers_transmission_alpha(m));
        vec2 E = anisotropic_table_bound(vec2(transmission_E, 0.0f), V_local, wall);
        t.transmission_E = E[0] + E[1];
        t.glass = layers_glass_bound(glass, dfg, t.dfg, alpha, layers_fresnel_eta(m));
    }
    if (layers_is_exact(m, energy) && max(alpha[0], alpha[1]) <= ALPHA_DELTA) {
        t.dfg = t.dfg / (t.dfg[0] + t.dfg[1]); /* 1 except for LUT interpolation */
        t.glass = smooth_glass(surface_NdotV(m.base, V), layers_fresnel_eta(m));
    }
    if (has_layer(m, LAYER_IRIDESCENCE)) {
        float NdotV = surface_NdotV(m.base, V);
        t.film_weight = m.iridescence * film_fade(m.iridescence_thickness_nm);
        t.film_F_base = F_iridescent(m.iridescence_ior, m.iridescence_thickness_nm, m.base.F0, NdotV);
        t.film_F_metal =
            F_iridescent(m.iridescence_ior, m.iridescence_thickness_nm, m.base.base_color, NdotV);
    }
    return t;
}

/* Emission in cd/m^2, attenuated by the coat. Sheen does not dim it, as in Khronos' renderer. */
FN vec3 layers_emission(Layers m, vec3 V)
{
    if (!has_layer(m, LAYER_CLEARCOAT))
        return m.base.emissive;
    return m.base.emissive * (1.0f - m.clearcoat * F_clearcoat(layers_clearcoat_NdotV(m, V)));
}

#endif
