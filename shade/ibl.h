/* ibl.h - image-based lighting. Texture lookups stay outside: the *_sample functions return directions and
 * weights, and the integral is a loop over them that reads a texture.
 *
 *   reference    specular_ibl_sample()   Monte Carlo over the BRDF itself, "SpecularIBL" of Karis 2013
 *   prefilter    prefilter_sample()      one radiance per direction and roughness, "PrefilterEnvMap"
 *   split sum    dfg_sample()            the BRDF's own integral (A, B), "IntegrateBRDF"
 *   direction    surface_reflection(), of the lookup of prefiltered radiance
 *   use          approximate_specular_ibl(), multiscatter_ibl(), surface_ibl() */
#ifndef SHADE_IBL_H
#define SHADE_IBL_H

/* ---- the reference: sample i of n of the specular integral ---- */

STRUCT(SpecularSample)
{
    vec3 L;      /* unit, direction of the environment lookup */
    vec3 weight; /* f N.L / pdf; 0 below the horizon */
    float pdf;   /* of L, per sr */
};

/* H in the frame of N with density D N.H, and L = reflect(-V, H) of density D N.H / (4 V.H); then
 *   f N.L / pdf = 4 F V_Smith N.L V.H / N.H = F G2 V.H / (N.H N.V).
 * The mean over i of weight times radiance(L) is the reflected radiance. Karis 2013, "SpecularIBL", with
 * height-correlated Smith. */
FN SpecularSample specular_ibl_sample(uint i, uint n, vec3 F0, vec3 F90, float perceptual_roughness, vec3 N,
                                      vec3 V)
{
    float alpha = max(alpha_from_roughness(perceptual_roughness), ALPHA_DELTA);
    vec3 H_local = sample_D_GGX(hammersley(i, n), alpha);
    vec3 H = mul(basis_from_normal(N), H_local);
    float NdotH = H_local[2];
    float VdotH = clamp(dot(V, H), 0.0f, 1.0f);
    SpecularSample r;
    r.L = reflect(-V, H);
    float NdotL = clamp(dot(N, r.L), 0.0f, 1.0f);
    float NdotV = clamp(dot(N, V), NDOTV_MIN, 1.0f);
    float Vis = sel(NdotL > 0.0f, V_SmithGGX(NdotL, NdotV, alpha), 0.0f);
    r.weight = F_Schlick(F0, F90, VdotH) * (4.0f * Vis * NdotL * VdotH / max(NdotH, 1e-6f));
    r.pdf = pdf_D_GGX(NdotH, alpha) / max(4.0f * VdotH, 1e-6f);
    return r;
}

/* ---- prefiltered radiance ---- */

STRUCT(PrefilterSample)
{
    vec3 L;       /* unit, direction of the environment lookup */
    float weight; /* N.L; 0 below the horizon: no lookup */
    float pdf;    /* of L, per sr */
};

/* Sample i of n for the lobe around R, with N = V = R (a surface seen head-on). Prefiltered radiance is
 * the sum of weight times radiance(L, prefilter_lod()) over the sum of weight. alpha 0 copies the
 * environment: every sample is R. Karis 2013, "PrefilterEnvMap". */
FN PrefilterSample prefilter_sample(uint i, uint n, float alpha, vec3 R)
{
    float a = max(alpha, ALPHA_DELTA);
    vec3 H = sample_D_GGX(hammersley(i, n), a);
    float NdotL = 2.0f * H[2] * H[2] - 1.0f; /* L = reflect(-z, H) */
    PrefilterSample r;
    r.L = mul(basis_from_normal(R), vec3(2.0f * H[2] * H[0], 2.0f * H[2] * H[1], NdotL));
    r.weight = max(NdotL, 0.0f);
    r.pdf = 0.25f * D_GGX(H[2], a); /* D N.H / (4 V.H) with V.H = N.H */
    return r;
}

/* Mip at which the texels match a sample of density pdf, one of n: 1/2 log2(omega_s / omega_p) + 1, at
 * least 0. omega_s = 1 / (n pdf); texel_solid_angle = omega_p, 4 pi / (6 size^2) for a cube. The 1 makes
 * the footprints overlap. Krivanek and Colbert 2008, "Real-time Shading with Filtered Importance
 * Sampling"; GPU Gems 3, chapter 20. */
FN float prefilter_lod(float pdf, uint n, float texel_solid_angle)
{
    float sample_solid_angle = 1.0f / max(float(n) * pdf, 1e-20f);
    return max(0.5f * log2(sample_solid_angle / texel_solid_angle) + 1.0f, 0.0f);
}

/* ---- the split sum ---- */

/* Sample i of n of (A, B) with int f N.L dL = F0 A + F90 B: A has the weight 1 - (1 - V.H)^5, B has (1 -
 * V.H)^5, both times 4 Vis N.L V.H / N.H. N = z, V in the plane y = 0. NdotV in [0, 1]. k < 0:
 * height-correlated Smith; otherwise Schlick-GGX with that k. Karis 2013, "IntegrateBRDF". */
FN vec2 dfg_sample_k(uint i, uint n, float perceptual_roughness, float NdotV, float k)
{
    float alpha = max(alpha_from_roughness(perceptual_roughness), ALPHA_DELTA);
    float mu = max(NdotV, NDOTV_MIN);
    vec3 V = vec3(sqrt(max(1.0f - mu * mu, 0.0f)), 0.0f, mu);
    vec3 H = sample_D_GGX(hammersley(i, n), alpha);
    float VdotH = clamp(dot(V, H), 0.0f, 1.0f);
    float NdotL = clamp(2.0f * VdotH * H[2] - mu, 0.0f, 1.0f);
    float Vis = sel(k < 0.0f, V_SmithGGX(NdotL, mu, alpha), V_SchlickGGX(NdotL, mu, max(k, 0.0f)));
    float w = 4.0f * Vis * NdotL * VdotH / max(H[2], 1e-6f);
    float Fc = schlick_weight(VdotH);
    return vec2((1.0f - Fc) * w, Fc * w);
}

/* With height-correlated Smith, facet's default. */
FN vec2 dfg_sample(uint i, uint n, float perceptual_roughness, float NdotV)
{
    return dfg_sample_k(i, n, perceptual_roughness, NdotV, -1.0f);
}

/* With Karis' Schlick-GGX, k = alpha / 2. */
FN vec2 dfg_sample_karis(uint i, uint n, float perceptual_roughness, float NdotV)
{
    return dfg_sample_k(i, n, perceptual_roughness, NdotV, k_ibl(alpha_from_roughness(perceptual_roughness)));
}

/* The mean of n samples: (A, B), each in [0, 1]. */
FN vec2 integrate_dfg(float perceptual_roughness, float NdotV, uint n)
{
    vec2 sum = vec2(0.0f);
    for (uint i = 0u; i < n; ++i)
        sum += dfg_sample(i, n, perceptual_roughness, NdotV);
    return sum * (1.0f / float(n));
}
FN vec2 integrate_dfg_karis(float perceptual_roughness, float NdotV, uint n)
{
    vec2 sum = vec2(0.0f);
    for (uint i = 0u; i < n; ++i)
        sum += dfg_sample_karis(i, n, perceptual_roughness, NdotV);
    return sum * (1.0f / float(n));
}

/* ---- direction of the lookup ---- */

/* Light that a rough surface reflects comes from around a direction between R = reflect(-V, N) and N: masking and
 * the horizon take away what arrives at grazing angles. The share b of the way from R to N, in [0, 1]; the lookup is
 * along mix(R, N, b):
 *   b = a max(1 + (1 - a)^2 (1/2 - 5/2 N.V) - 0.74 (1 - F0)^6 (1 - N.V), 0)
 * 0 for a mirror, whose N and R stay apart; 1 for a = 1 and F0 = 1, where D G2 / (4 N.V) is N.L / (2 pi (N.L + N.V)),
 * the same all around N. Schlick's term adds light from far away from V, most for a small F0, the reflectance facing
 * (over that at grazing).
 *
 * A fit to quadrature in four photographs and three synthetic environments, by RMS error over N.V from 0.05 to 0.97:
 * for F0 = 1 and perceptual roughness 0.5, 0.75 and 1 it is 0.62, 0.41 and 0.29 times that of lookups along R, and at
 * most 0.02 more than with the best b for each N.V. The idea is the dominant direction of Lagarde and de Rousiers
 * 2014, "Moving Frostbite to Physically Based Rendering". */
FN float reflection_bend(float alpha, float NdotV, float F0)
{
    float sharp = 1.0f - alpha;
    float dark = 1.0f - F0;
    float dark2 = dark * dark;
    float grazing = 0.74f * dark2 * dark2 * dark2 * (1.0f - NdotV);
    return alpha * max(1.0f + sharp * sharp * (0.5f - 2.5f * NdotV) - grazing, 0.0f);
}

/* Unit direction of the lookup for a lobe of width alpha. ENERGY_GLTF: R, as in Khronos' renderer. */
FN vec3 specular_reflection(vec3 N, vec3 V, float alpha, float F0, int energy)
{
    vec3 R = reflect(-V, N);
    if (energy == ENERGY_GLTF)
        return normalize(R);
    vec3 bent = mix(R, N, reflection_bend(alpha, clamp(dot(N, V), 0.0f, 1.0f), F0));
    float length2 = dot(bent, bent); /* 0 only for an eye straight behind the surface */
    return sel(length2 > 1e-12f, bent * inversesqrt(max(length2, 1e-12f)), N);
}

/* The mean over the channels of a surface's reflectance facing, over that at grazing, for reflection_bend(). */
FN float surface_facing_reflectance(Surface s)
{
    float F0 = dot(mix(s.F0, s.base_color, s.metallic), vec3(1.0f / 3.0f));
    return min(F0 / max(mix(s.F90, 1.0f, s.metallic), 1e-4f), 1.0f);
}

/* specular_reflection() of a surface. */
FN vec3 surface_reflection(Surface s, vec3 V, int energy)
{
    return specular_reflection(s.N, V, alpha_from_roughness(s.perceptual_roughness),
                               surface_facing_reflectance(s), energy);
}

/* ---- lighting ---- */

/* Reflected radiance by the split sum: prefiltered (F0 A + F90 B); prefiltered in the direction
 * reflect(-V, N), or nearer to the integral, specular_reflection(). Karis 2013, "ApproximateSpecularIBL". */
FN vec3 approximate_specular_ibl(vec3 F0, vec3 F90, vec3 prefiltered, vec2 dfg)
{
    return prefiltered * (F0 * dfg[0] + F90 * dfg[1]);
}

/* Reflectance of the specular layer after a single bounce, and after more. */
STRUCT(MultiScatter)
{
    vec3 single;   /* FssEss, to be multiplied with prefiltered radiance */
    vec3 multiple; /* FmsEms, to be multiplied with irradiance / pi */
};

/* Single and multiple scattering from the split sum:
 *   FssEss = k_S A + F90 B,  Ems = 1 - A - B,  FmsEms = Ems FssEss Favg / (1 - Favg Ems)
 * k_S is F0, or F_Schlick_roughness(). With k_S = F0 = F90 = 1 the two add up to 1; with k_S = F0 to
 * specular_albedo(). Fdez-Aguera 2019, "A Multiple-Scattering Microfacet Model for Real-Time Image-based
 * Lighting". */
FN MultiScatter multiscatter_ibl(vec3 k_S, vec3 F0, vec3 F90, vec2 dfg)
{
    MultiScatter r;
    float Ems = 1.0f - dfg[0] - dfg[1];
    vec3 F_mean = F_avg(F0, F90);
    r.single = k_S * dfg[0] + F90 * dfg[1];
    r.multiple = r.single * F_mean * Ems / (1.0f - F_mean * Ems);
    return r;
}

/* Irradiance in a concave place relative to that in the open, per channel: openness is the cosine-weighted share of the
 * hemisphere in which the environment is visible, and what hides the rest is taken to be as bright as the place itself.
 * Light of the environment then fills it as it fills an integrating sphere with an opening of that share, for which
 *   E / E0 = A / (1 - albedo (1 - A))
 * is exact: a white place is as bright as one in the open, a black one as dark as the light that reaches it directly. */
FN vec3 ambient_interreflection(float openness, vec3 albedo)
{
    return vec3(openness) / max(1.0f - albedo * (1.0f - openness), vec3(1e-6f));
}

/* Radiance (cd/m^2) of the environment reflected by a surface, with occlusion, without emission.
 * specular_radiance is prefiltered for the surface's roughness along surface_reflection(); dfg is (A, B) at NdotV.
 *
 * ENERGY_GLTF is Khronos' renderer: k_S by F_Schlick_roughness, the sum of single and multiple scattering
 * times the specular radiance, the base under a dielectric weighted with one minus that sum (its largest
 * channel, as required by KHR_materials_specular; Khronos' renderer does it per channel, which differs for
 * a colored F0 only), and the whole sum times occlusion. ENERGY_CONSERVING: k_S = F0, and multiple
 * scattering takes the irradiance, as in Fdez-Aguera. In either mode a white surface in a uniform
 * environment returns its radiance. */
FN vec3 surface_ibl(Surface s, float NdotV, vec2 dfg, vec3 specular_radiance, vec3 irradiance_over_pi,
                    int energy)
{
    vec3 F90 = vec3(s.F90);
    vec3 one = vec3(1.0f);
    vec3 k_base = s.F0;
    vec3 k_metal = s.base_color;
    vec3 multiple_radiance = irradiance_over_pi;
    if (energy == ENERGY_GLTF) {
        k_base = F_Schlick_roughness(s.F0, F90, s.perceptual_roughness, NdotV);
        k_metal = F_Schlick_roughness(s.base_color, one, s.perceptual_roughness, NdotV);
        multiple_radiance = specular_radiance;
    }
    MultiScatter base = multiscatter_ibl(k_base, s.F0, F90, dfg);
    MultiScatter metal = multiscatter_ibl(k_metal, s.base_color, one, dfg);

    float base_weight = 1.0f - max3(base.single + base.multiple);
    vec3 dielectric_radiance = base.single * specular_radiance + base.multiple * multiple_radiance +
                               s.base_color * irradiance_over_pi * base_weight;
    vec3 metal_radiance = metal.single * specular_radiance + metal.multiple * multiple_radiance;
    return mix(dielectric_radiance, metal_radiance, s.metallic) * s.occlusion;
}

#endif
