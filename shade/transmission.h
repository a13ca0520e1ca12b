/* transmission.h - specular transmission (KHR_materials_transmission, KHR_materials_volume).
 *
 * Two cases. A thin wall (no volume) refracts at both of its sides, so light goes straight on, blurred by
 * the roughness; the lobe is that of the reflection, mirrored to the other side. The boundary of a volume
 * refracts once.
 *
 * eta is the ior beyond the boundary over that on the side of V. Tangent space: z is the normal on V's
 * side, so V.z > 0 and transmitted L.z < 0. These functions contain neither Fresnel's 1 - F nor the tint
 * by base_color: the caller chooses cosines and colors. Radiance is L / n^2, which refraction preserves;
 * for plain radiance divide by eta^2. */
#ifndef SHADE_TRANSMISSION_H
#define SHADE_TRANSMISSION_H

/* ---- directions ---- */

/* Direction of propagation behind the boundary, from that before it, I (both unit, N against I); the zero
 * vector for total internal reflection. Snell's law. */
FN vec3 refract_or_zero(vec3 I, vec3 N, float eta)
{
    return refract(I, N, 1.0f / eta);
}

/* L mirrored to the other side of the surface. */
FN vec3 mirror_through(vec3 L, vec3 N)
{
    return L - N * (2.0f * dot(N, L));
}

/* GGX width of a thin wall's lobe: alpha clamp(2 ior - 2, 0, 1). A wall of ior 1 does not refract, so it does
 * not blur; from ior 1.5 on it is alpha. ior 0 (infinite) transmits nothing; 1. Khronos' renderer; the
 * extension's text has alpha for every ior. */
FN float thin_wall_alpha(float alpha, float ior)
{
    return alpha * sel(ior < 1.0f, 1.0f, clamp(2.0f * ior - 2.0f, 0.0f, 1.0f));
}

/* ---- a volume's boundary ---- */

/* Half vector of transmission, on V's side: parallel to V + eta L; the zero vector if there is none (both on
 * one side, or equal iors and L straight on). Walter et al. 2007, equation 16. */
FN vec3 half_vector_transmission(vec3 V, vec3 L, float eta)
{
    vec3 h = V + L * eta;
    float length2 = dot(h, h);
    if (L[2] >= 0.0f || length2 < 1e-14f)
        return vec3(0.0f);
    return h * (sel(h[2] < 0.0f, -1.0f, 1.0f) * inversesqrt(length2));
}

/* Jacobian from microfacet normals to refracted directions, eta^2 |L.H| / (V.H + eta L.H)^2; cosines signed.
 * Walter et al. 2007, equation 17. */
FN float transmission_jacobian(float VdotH, float LdotH, float eta)
{
    float d = VdotH + eta * LdotH;
    return eta * eta * abs(LdotH) / max(d * d, 1e-20f);
}

/* BTDF times |N.L| in 1/sr:
 *   |L.H| |V.H| / |N.V| * eta^2 G2 D / (V.H + eta L.H)^2
 * with G2 the height-correlated Smith term of both sides' angles. Its integral over the far side is at
 * most 1. Walter et al. 2007, equation 21; KHR_materials_volume. */
FN float btdf_GGX_cos(vec3 V, vec3 L, float alpha_x, float alpha_y, float eta)
{
    vec3 H = half_vector_transmission(V, L, eta);
    float VdotH = dot(V, H);
    float LdotH = dot(L, H);
    if (VdotH <= 0.0f || LdotH >= 0.0f) /* no such microfacet, or it faces away */
        return 0.0f;
    vec3 below = vec3(L[0], L[1], -L[2]);
    float Vis = V_SmithGGX_anisotropic(below, V, alpha_x, alpha_y);
    return D_GGX_anisotropic(H, alpha_x, alpha_y) * Vis * 4.0f * below[2] * VdotH *
           transmission_jacobian(VdotH, LdotH, eta);
}

/* Density per sr of L in sample_transmission(). */
FN float pdf_transmission(vec3 V, vec3 L, float alpha_x, float alpha_y, float eta)
{
    vec3 H = half_vector_transmission(V, L, eta);
    float VdotH = dot(V, H);
    float LdotH = dot(L, H);
    if (VdotH <= 0.0f || LdotH >= 0.0f)
        return 0.0f;
    return pdf_VNDF_GGX(V, H, alpha_x, alpha_y) * transmission_jacobian(VdotH, LdotH, eta);
}

/* A direction of transmitted light. */
STRUCT(TransmissionSample)
{
    vec3 L;      /* unit, z < 0; towards the light, the direction in which a ray from V continues */
    float VdotH; /* of the microfacet, for 1 - F */
    /* BTDF |N.L| / pdf = G2 / G1(V), in [0, 1]; 0: no direction (total internal reflection, or not below) */
    float weight;
    float pdf; /* of L, per sr */
};

/* G2 / G1(V) for a direction L on either side: the BSDF over the density of visible normals. */
FN float weight_VNDF_GGX(vec3 V, vec3 L, float alpha_x, float alpha_y)
{
    vec3 above = vec3(L[0], L[1], abs(L[2]));
    return 4.0f * V_SmithGGX_anisotropic(above, V, alpha_x, alpha_y) * above[2] * V[2] /
           G1_SmithGGX_anisotropic(V, alpha_x, alpha_y);
}

/* Through a volume's boundary: a visible normal, then Snell's law. */
FN TransmissionSample sample_transmission(vec2 u, vec3 V, float alpha_x, float alpha_y, float eta)
{
    vec3 H = sample_VNDF_GGX(u, V, alpha_x, alpha_y);
    TransmissionSample s;
    s.VdotH = dot(V, H);
    s.L = refract_or_zero(-V, H, eta);
    s.weight = 0.0f;
    s.pdf = 0.0f;
    float LdotH = dot(s.L, H);
    if (s.VdotH <= 0.0f || LdotH >= 0.0f || s.L[2] >= 0.0f)
        return s;
    s.weight = weight_VNDF_GGX(V, s.L, alpha_x, alpha_y);
    s.pdf = pdf_VNDF_GGX(V, H, alpha_x, alpha_y) * transmission_jacobian(s.VdotH, LdotH, eta);
    return s;
}

/* ---- a thin wall ---- */

/* The lobe times |N.L| in 1/sr: D V of the reflection, L mirrored to V's side. KHR_materials_transmission;
 * its text has the separable Smith term, facet the height-correlated one, like Khronos' renderer and like
 * its own reflection. */
FN float thin_wall_cos(vec3 V, vec3 L, float alpha_x, float alpha_y)
{
    vec3 above = vec3(L[0], L[1], -L[2]);
    vec3 sum = V + above;
    float sum2 = dot(sum, sum);
    if (L[2] >= 0.0f || sum2 < 1e-12f)
        return 0.0f;
    return D_GGX_anisotropic(sum * inversesqrt(sum2), alpha_x, alpha_y) *
           V_SmithGGX_anisotropic(above, V, alpha_x, alpha_y) * above[2];
}

/* Density per sr of L in sample_thin_wall(). */
FN float pdf_thin_wall(vec3 V, vec3 L, float alpha_x, float alpha_y)
{
    vec3 sum = V + vec3(L[0], L[1], -L[2]);
    float sum2 = dot(sum, sum);
    if (L[2] >= 0.0f || sum2 < 1e-12f)
        return 0.0f;
    vec3 H = sum * inversesqrt(sum2);
    return pdf_VNDF_GGX(V, H, alpha_x, alpha_y) / (4.0f * dot(V, H));
}

/* Through a thin wall: a visible normal, the reflection at it, mirrored. */
FN TransmissionSample sample_thin_wall(vec2 u, vec3 V, float alpha_x, float alpha_y)
{
    vec3 H = sample_VNDF_GGX(u, V, alpha_x, alpha_y);
    vec3 R = reflect(-V, H);
    TransmissionSample s;
    s.VdotH = dot(V, H);
    s.L = vec3(R[0], R[1], -R[2]);
    s.weight = 0.0f;
    s.pdf = 0.0f;
    if (s.VdotH <= 0.0f || R[2] <= 0.0f)
        return s;
    s.weight = weight_VNDF_GGX(V, R, alpha_x, alpha_y);
    s.pdf = pdf_VNDF_GGX(V, H, alpha_x, alpha_y) / (4.0f * s.VdotH);
    return s;
}

/* ---- the environment behind a surface ---- */

/* Squared GGX width up to which a lobe shows the environment sharp: about a degree. */
#define SHARP_ALPHA2 1e-5f

/* Whether a transmitted lobe shows the sharp background. A blurred one stays blurred behind glass. */
FN bool environment_is_sharp(float alpha2, float background_blur)
{
    return alpha2 <= SHARP_ALPHA2 && !(background_blur > 0.0f);
}

/* Perceptual roughness at which a transmitted lobe of this squared GGX width shows the environment. */
FN float environment_blur(float alpha2, float background_blur)
{
    return min(max(sqrt(sqrt(alpha2)), background_blur), 1.0f);
}

/* GGX width of the lobe in L behind a boundary of width alpha: a microfacet turned by d turns a refracted
 * direction by |1 - eta| d, and a reflected one, for which widths are defined, by 2 d. */
FN float refracted_alpha(float alpha, float eta)
{
    return 0.5f * abs(1.0f - eta) * alpha;
}

/* Light that a scattering medium sends along a ray: of the irradiance / pi ahead of it and behind it. */
FN vec3 scattered_ambient(vec3 ahead, vec3 behind, float scatter_anisotropy)
{
    return mix(behind, ahead, 0.5f + 0.5f * scatter_anisotropy);
}

/* ---- the background of an image ---- */

/* Light from the background, of which a transmittance T arrives through glass. What passes in all channels alike is a
 * lack of opacity of the image, in [0, 1]. */
FN float backdrop_passes(vec3 T)
{
    return clamp(min(T[0], min(T[1], T[2])), 0.0f, 1.0f);
}

/* The radiance of the rest, to which the color of the glass leads: against a background of color (cd/m^2), or, where
 * that is unknown, against the environment, whose radiance through the glass is unseen. */
FN vec3 backdrop_radiance(vec3 T, vec3 unseen, vec3 color, bool has_color)
{
    vec3 colored = max(T - backdrop_passes(T), 0.0f);
    return sel(has_color, colored * color, unseen * colored / max(T, 1e-6f));
}

#endif
