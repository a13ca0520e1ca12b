/* glass.h - the energy-conserving boundary of a transmissive dielectric: Fresnel's equations, and multiple
 * scattering between microfacets distributed to both sides.
 *
 * eta is the ior of the far side over that of the near one. */
#ifndef SHADE_GLASS_H
#define SHADE_GLASS_H

/* ---- Fresnel's equations in the terms of glTF ---- */

/* Weight of F90 in F_dielectric, from 0 at normal incidence to 1 at grazing:
 *   w = (F - f0) / (1 - f0),  f0 = ((eta - 1) / (eta + 1))^2
 * It replaces schlick_weight(). 1 for total internal reflection. eta > 0, finite. */
FN float dielectric_weight(float cos_i, float eta)
{
    float f0 = F0_from_ior(eta);
    return clamp((F_dielectric(cos_i, eta) - f0) / (1.0f - f0), 0.0f, 1.0f);
}

/* Whether a microfacet at cos_i reflects totally. */
FN bool is_total_reflection(float cos_i, float eta)
{
    return (eta - 1.0f) * (eta + 1.0f) + cos_i * cos_i <= 0.0f;
}

/* F_dielectric with the strength and color of KHR_materials_specular: F0 + (F90 - F0) w; total internal
 * reflection is neither weakened nor colored (KHR_materials_volume). F0 = F0_from_ior(eta) and F90 = 1 give
 * F_dielectric itself. */
FN vec3 F_boundary(vec3 F0, vec3 F90, float cos_i, float eta)
{
    return sel(is_total_reflection(cos_i, eta), vec3(1.0f), F0 + (F90 - F0) * dielectric_weight(cos_i, eta));
}

/* ---- albedos ---- */

/* Directional albedos of a rough boundary towards V for single scattering. */
STRUCT(GlassAlbedo)
{
    float E;       /* reflected if F were 1: A + B of the split sum */
    float R;       /* reflected */
    float T;       /* transmitted */
    float through; /* transmitted if F were 0 where it is below 1 */
};

/* Term i of n: a visible normal, with reflection and transmission at it. */
FN GlassAlbedo glass_albedo_sample(uint i, uint n, float alpha, float NdotV, float eta)
{
    vec3 V = vec3(sqrt((1.0f - NdotV) * (1.0f + NdotV)), 0.0f, NdotV);
    vec2 u = hammersley(i, n) + 0.5f / float(n);
    vec3 H = sample_VNDF_GGX(u, V, alpha, alpha);
    float VdotH = clamp(dot(V, H), 0.0f, 1.0f);
    float F = F_dielectric(VdotH, eta);
    vec3 reflected = reflect(-V, H);
    vec3 refracted = refract_or_zero(-V, H, eta);
    GlassAlbedo a;
    a.E = 0.0f;
    a.through = 0.0f;
    if (reflected[2] > 0.0f)
        a.E = weight_VNDF_GGX(V, reflected, alpha, alpha);
    if (refracted[2] < 0.0f)
        a.through = weight_VNDF_GGX(V, refracted, alpha, alpha);
    a.R = F * a.E;
    a.T = (1.0f - F) * a.through;
    return a;
}

/* integrate_glass() of a smooth boundary. */
FN vec3 smooth_glass(float NdotV, float eta)
{
    return vec3(dielectric_weight(NdotV, eta), 1.0f, sel(is_total_reflection(NdotV, eta), 0.0f, 1.0f));
}

/* The LUT values of a boundary for layer_tables(), by n terms: (w, R + T, through), where w is the mean of
 * dielectric_weight() over the reflection: R = E (f0 + (1 - f0) w). All three vary slowly with eta, unlike R
 * and T. */
FN vec3 integrate_glass(float perceptual_roughness, float NdotV, float eta, uint n)
{
    float mu = clamp(NdotV, NDOTV_MIN, 1.0f);
    float alpha = alpha_from_roughness(perceptual_roughness);
    if (alpha <= ALPHA_DELTA)
        return smooth_glass(mu, eta);
    float E = 0.0f;
    float R = 0.0f;
    float T = 0.0f;
    float through = 0.0f;
    for (uint i = 0u; i < n; ++i) {
        GlassAlbedo a = glass_albedo_sample(i, n, alpha, mu, eta);
        E += a.E;
        R += a.R;
        T += a.T;
        through += a.through;
    }
    float f0 = F0_from_ior(eta);
    float w = (R / max(E, 1e-6f * float(n)) - f0) / (1.0f - f0);
    return vec3(clamp(w, 0.0f, 1.0f), (R + T) / float(n), through / float(n));
}

/* ---- compensation ---- */

/* Albedos of a boundary whose F is F_boundary() of F0 and F90, from E of the split sum and (w, R + T,
 * through) of integrate_glass(). Where total internal reflection is possible F90 is taken as 1: an upper
 * bound of R. */
FN GlassAlbedo glass_albedo(float F0, float F90, float eta, float E, vec3 glass)
{
    float f0 = F0_from_ior(eta);
    float R_plain = E * (f0 + (1.0f - f0) * glass[0]);
    float T_plain = max(glass[1] - R_plain, 0.0f);
    float w_through = clamp((1.0f - T_plain / max(glass[2], 1e-6f) - f0) / (1.0f - f0), 0.0f, 1.0f);
    GlassAlbedo a;
    a.E = E;
    a.through = glass[2];
    a.R = E * (F0 + (sel(eta < 1.0f, 1.0f, F90) - F0) * glass[0]);
    a.T = glass[2] * (1.0f - F0 - (F90 - F0) * w_through);
    return a;
}

/* Factor on both lobes with which they add up to 1: multiply scattered light is assumed to be distributed
 * like singly scattered light. At most 3: seen from inside at grazing angles, boundaries of nearly equal
 * ior scatter up to six times more than their single scattering. */
FN float glass_compensation(GlassAlbedo a)
{
    return clamp(1.0f / max(a.R + a.T, 1e-3f), 1.0f, 3.0f);
}

#endif
