/* fresnel.h - Fresnel reflectance of an interface. All results are in [0, 1] for arguments in their domain.
 *
 * The caller chooses the cosine: V.H inside a microfacet lobe; N.V for a resolved smooth surface and for the
 * split sum of prefiltered light. */
#ifndef SHADE_FRESNEL_H
#define SHADE_FRESNEL_H

/* ---- Schlick's approximation ---- */

/* The weight w = (1 - V.H)^5 of Schlick's approximation. The clamp guards against cosines that rounding puts
 * outside [0, 1]. Schlick 1994, equation 15. */
FN float schlick_weight(float VdotH)
{
    float m = clamp(1.0f - VdotH, 0.0f, 1.0f);
    float m2 = m * m;
    return m2 * m2 * m;
}

/* F = F0 + (F90 - F0) (1 - V.H)^5. glTF: F90 = 1, or KHR_materials_specular's weight. Schlick 1994. */
FN vec3 F_Schlick(vec3 F0, vec3 F90, float VdotH)
{
    return F0 + (F90 - F0) * schlick_weight(VdotH);
}

/* The same from either side of a volume's boundary; eta is the ior of the far side over that of the near one.
 * From the denser side (eta < 1) the cosine is that of the rarer side, the larger angle; beyond the critical
 * angle there is total internal reflection: 1 for any F90. KHR_materials_volume, "Fresnel". */
FN vec3 F_Schlick_boundary(vec3 F0, vec3 F90, float VdotH, float eta)
{
    float sin2 = (1.0f - VdotH * VdotH) / (eta * eta);
    float cosine = sel(eta < 1.0f, sqrt(max(1.0f - sin2, 0.0f)), VdotH);
    return sel(eta < 1.0f && sin2 >= 1.0f, vec3(1.0f), F_Schlick(F0, F90, cosine));
}

/* F_Schlick for one channel. */
FN float F_Schlick1(float F0, float F90, float VdotH)
{
    return F0 + (F90 - F0) * schlick_weight(VdotH);
}

/* Schlick's approximation with a spherical Gaussian in place of the power:
 *   F = F0 + (1 - F0) 2^((-5.55473 V.H - 6.98316) V.H)
 * Within 0.004 of the power; 1.7e-4 too large at V.H = 1. Karis 2013, equation 5; Lagarde 2012. */
FN vec3 F_Schlick_SG(vec3 F0, float VdotH)
{
    return F0 + (1.0f - F0) * exp2((-5.55473f * VdotH - 6.98316f) * VdotH);
}

/* Roughness-dependent Fresnel for prefiltered light: at grazing angles a rough surface reaches 1 - roughness
 * only (never below F0).
 *   k_S = F0 + (max(F90 (1 - r), F0) - F0) (1 - N.V)^5
 * F90 is KHR_materials_specular's weight, already inside F0. Fdez-Aguera 2019; Khronos glTF-Sample-Renderer. */
FN vec3 F_Schlick_roughness(vec3 F0, vec3 F90, float perceptual_roughness, float NdotV)
{
    vec3 F_grazing = max(F90 * (1.0f - perceptual_roughness), F0);
    return F0 + (F_grazing - F0) * schlick_weight(NdotV);
}

/* Cosine-weighted mean of F_Schlick over the hemisphere: 2 int F mu dmu = F0 + (F90 - F0) / 21, exact. */
FN vec3 F_avg(vec3 F0, vec3 F90)
{
    return F0 + (F90 - F0) * (1.0f / 21.0f);
}

/* ---- refractive index and reflectance at normal incidence ---- */

/* F0 = ((ior - 1) / (ior + 1))^2 against air. ior >= 1; 0 means infinite (KHR_materials_ior) and gives 1 too. */
FN float F0_from_ior(float ior)
{
    float r = (ior - 1.0f) / (ior + 1.0f);
    return r * r;
}

/* The inverse, ior = (1 + sqrt F0) / (1 - sqrt F0), in [1, inf). F0 in [0, 1). */
FN float ior_from_F0(float F0)
{
    float root = sqrt(F0);
    return (1.0f + root) / (1.0f - root);
}

/* ---- Fresnel's equations, unpolarised light ---- */

/* Reflectance of a dielectric. cos_i in [0, 1] against the normal on the side of incidence; eta = ior of
 * the far side / ior of the near side; below 1 there is total internal reflection (1) beyond the critical
 * angle. Fresnel 1823 in the form of r_s and r_p with the refracted cosine, eta cos_t = sqrt(g2) with g2 =
 * eta^2 - 1 + cos_i^2, which does not cancel where eta is near 1. */
FN float F_dielectric(float cos_i, float eta)
{
    float g2 = (eta - 1.0f) * (eta + 1.0f) + cos_i * cos_i;
    float g = sqrt(max(g2, 0.0f));
    float r_s = (cos_i - g) / (cos_i + g);
    float r_p = (eta * eta * cos_i - g) / (eta * eta * cos_i + g);
    return sel(g2 <= 0.0f, 1.0f, 0.5f * (r_s * r_s + r_p * r_p));
}

/* Cosine-weighted mean of F_dielectric for eta >= 1, a fit (within 0.006 up to 2.5): Kulla and Conty 2017 as
 * refitted in Cycles. For light from the denser side: 1 - (1 - mean) / eta^2, exact. */
FN float F_dielectric_avg(float eta)
{
    return (eta - 1.0f) / (4.08567f + 1.00071f * eta);
}

/* Reflectance of a conductor of complex index eta + i k against the outside, one channel.
 * Born and Wolf 1999, section 14.2. */
FN float F_conductor1(float cos_i, float eta, float k)
{
    float c2 = cos_i * cos_i;
    float s2 = 1.0f - c2;
    float t0 = eta * eta - k * k - s2;
    float A = sqrt(t0 * t0 + 4.0f * eta * eta * k * k);
    float ac = 2.0f * cos_i * sqrt(max(0.5f * (A + t0), 0.0f));
    float R_s = (A + c2 - ac) / (A + c2 + ac);
    float R_p = R_s * (c2 * A + s2 * s2 - ac * s2) / (c2 * A + s2 * s2 + ac * s2);
    return 0.5f * (R_s + R_p);
}

/* The same per channel. */
FN vec3 F_conductor(float cos_i, vec3 eta, vec3 k)
{
    return vec3(F_conductor1(cos_i, eta[0], k[0]), F_conductor1(cos_i, eta[1], k[1]),
                F_conductor1(cos_i, eta[2], k[2]));
}

#endif
