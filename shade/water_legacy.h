/* water_legacy.h - the legacy shading style of water, kept for comparison: Blinn-Phong highlights on a mix
 * of hand-picked colors. It exceeds 1 at reflections of the sun and glows in the dark; nothing else
 * depends on it.
 *
 *   f = (1 - max(w.N, 0))^5,  W = shallow to deep by the height of the surface,  c = mix(W, sky(R), f)
 *   c = 0.5 c + 0.3 ambient + 0.1 s N.L + 1.5 s (N.H)^64 + sparkle (N.H)^256,  c = mix(c, 1, 0.7 foam)
 *
 * Displayed as c^0.95, without tone mapping or a transfer function. */
#ifndef SHADE_WATER_LEGACY_H
#define SHADE_WATER_LEGACY_H

/* w points from the eye to the surface: f is 1, and the sky lookup is below the horizon; or to the eye, as
 * intended. */
#define WATER_LEGACY_WRITTEN 0
#define WATER_LEGACY_INTENDED 1

/* Stages of this style on the way to the current one: Schlick's formula with the reflectance of an ior; then
 * also a GGX highlight, F D V N.L, with the sun's color as irradiance. */
#define WATER_LEGACY_STAGE_NONE 0
#define WATER_LEGACY_STAGE_FRESNEL 1
#define WATER_LEGACY_STAGE_COOK_TORRANCE 2
/* Perceptual roughness by default: the widest of the original plan. */
#define WATER_LEGACY_ROUGHNESS 0.1f

/* Unit direction to the sun, along (0.8, 1, 0.6), and its color. */
#define WATER_LEGACY_SUN_DIRECTION vec3(0.565685425f, 0.707106781f, 0.424264069f)
#define WATER_LEGACY_SUN_COLOR vec3(1.2f, 1.0f, 0.8f)

FN vec3 water_legacy_sky(vec3 d)
{
    return mix(vec3(0.6f, 0.7f, 0.9f), vec3(0.1f, 0.3f, 0.6f), 0.5f * d[1] + 0.5f);
}

/* Foam amount in [0, 1] for slopes from 0.5 to 1. */
FN float water_legacy_foam(float slope)
{
    return smoothstep(0.5f, 1.0f, slope);
}

/* The highlight of stages 0 and 1, and of 2. */
FN vec3 water_legacy_highlight(int stage, vec3 N, vec3 V, vec3 L, float ior, float perceptual_roughness)
{
    vec3 H = normalize(V + L);
    float NdotH = max(dot(N, H), 0.0f);
    if (stage < WATER_LEGACY_STAGE_COOK_TORRANCE)
        return WATER_LEGACY_SUN_COLOR * (1.5f * pow(NdotH, 64.0f));
    float NdotL = clamp(dot(N, L), 0.0f, 1.0f);
    float NdotV = clamp(dot(N, V), NDOTV_MIN, 1.0f);
    float alpha = max(alpha_from_roughness(perceptual_roughness), ALPHA_MIN);
    float F = F_Schlick1(F0_from_ior(ior), 1.0f, clamp(dot(V, H), 0.0f, 1.0f));
    float D = D_GGX_stable(NdotH, cross(N, H), alpha);
    return WATER_LEGACY_SUN_COLOR * (F * D * V_SmithGGX(NdotL, NdotV, alpha) * NdotL);
}

/* Linear color of the surface of normal N hit by the ray d (unit, from the eye) at the height y (m). sparkle
 * and foam in [0, 1]. stage: WATER_LEGACY_STAGE_*; ior and perceptual_roughness apply to stages above 0, which are
 * WATER_LEGACY_INTENDED. L: the sun. */
FN vec3 water_legacy_shade(int variant, int stage, vec3 d, vec3 N, vec3 L, float y, float sparkle, float foam,
                           float ior, float perceptual_roughness)
{
    vec3 V = -d;
    vec3 w = sel(variant == WATER_LEGACY_WRITTEN && stage == WATER_LEGACY_STAGE_NONE, d, V);
    vec3 R = reflect(-w, N);
    float cosine = clamp(dot(w, N), 0.0f, 1.0f);
    float f = sel(stage >= WATER_LEGACY_STAGE_FRESNEL, F_Schlick1(F0_from_ior(ior), 1.0f, cosine),
                  schlick_weight(cosine));
    vec3 water = mix(vec3(0.0f, 0.5f, 0.7f), vec3(0.0f, 0.3f, 0.5f), smoothstep(0.0f, 2.0f, y));
    vec3 c = mix(water, water_legacy_sky(R), f);
    c = c * 0.5f + vec3(0.05f, 0.1f, 0.2f) * 0.3f + WATER_LEGACY_SUN_COLOR * (0.1f * max(dot(N, L), 0.0f));
    float NdotH = max(dot(N, normalize(V + L)), 0.0f);
    c = c + water_legacy_highlight(stage, N, V, L, ior, perceptual_roughness);
    c = c + vec3(1.5f, 1.4f, 1.3f) * (pow(NdotH, 256.0f) * sparkle);
    return mix(c, vec3(1.0f), 0.7f * foam);
}

/* Display value. */
FN vec3 water_legacy_display(vec3 c)
{
    return pow(max(c, 0.0f), vec3(0.95f));
}

/* Linear value whose sRGB encoding is that display value. */
FN vec3 water_legacy_linear(vec3 c)
{
    return linear_from_srgb(water_legacy_display(c));
}

/* Parameters of an image. */
STRUCT(WaterStyle)
{
    int variant;                /* WATER_LEGACY_WRITTEN or WATER_LEGACY_INTENDED */
    int stage;                  /* WATER_LEGACY_STAGE_* */
    float perceptual_roughness; /* of WATER_LEGACY_STAGE_COOK_TORRANCE and of painted water */
    bool has_foam;
    bool has_sparkles;
};

/* ---- an intermediate stage ---- */

/* Direction of the sky lookup; not below the horizon. */
FN vec3 painted_reflection(vec3 N, vec3 V)
{
    vec3 R = reflect(-V, N);
    return normalize(vec3(R[0], max(R[1], 0.0f), R[2]));
}

/* The sky (radiance in the mirror direction) by Schlick's reflectance, the sun by GGX of one roughness,
 * over a diffuse base color:
 *   F L_sky + F D V N.L E + (1 - F) albedo / pi (E N.L + E_sky) */
FN vec3 painted_water(WaterLight light, vec3 N, vec3 V, float ior, float perceptual_roughness, vec3 sky)
{
    vec3 albedo = vec3(0.0f, 0.3f, 0.5f);
    vec3 L = light.L;
    vec3 H = normalize(V + L);
    float NdotV = clamp(dot(N, V), NDOTV_MIN, 1.0f);
    float NdotL = clamp(dot(N, L), 0.0f, 1.0f);
    float F0 = F0_from_ior(ior);
    float F = F_Schlick1(F0, 1.0f, NdotV);
    float alpha = max(alpha_from_roughness(perceptual_roughness), ALPHA_MIN);
    float FH = F_Schlick1(F0, 1.0f, clamp(dot(V, H), 0.0f, 1.0f));
    float specular =
        FH * D_GGX_stable(max(dot(N, H), 0.0f), cross(N, H), alpha) * V_SmithGGX(NdotL, NdotV, alpha) * NdotL;
    vec3 E = light.sun_irradiance * NdotL + light.sky_irradiance;
    return sky * F + light.sun_irradiance * specular + albedo * E * (INV_PI * (1.0f - F));
}

#endif
