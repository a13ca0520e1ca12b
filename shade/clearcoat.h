/* clearcoat.h - a clear lacquer over all other layers (KHR_materials_clearcoat): ior 1.5, its own
 * roughness and normal. */
#ifndef SHADE_CLEARCOAT_H
#define SHADE_CLEARCOAT_H

/* Reflectance of the coat towards V: 0.04 + 0.96 (1 - N.V)^5. N.V rather than V.H, so that one number weights
 * lobe and base and their mix conserves energy. KHR_materials_clearcoat, "Implementation". */
FN float F_clearcoat(float NdotV)
{
    return F_Schlick1(0.04f, 1.0f, NdotV);
}

/* The coat's lobe D V times N.L, in 1/sr, without Fresnel; N is the coat's normal, NdotV clamped by the
 * caller. 0 for light from below it. */
FN float clearcoat_lobe_cos(vec3 N, float NdotV, vec3 V, vec3 L, float alpha)
{
    float NdotL = min(dot(N, L), 1.0f);
    vec3 sum = V + L;
    float sum2 = dot(sum, sum);
    if (NdotL <= 0.0f || sum2 < 1e-12f)
        return 0.0f;
    vec3 H = sum * inversesqrt(sum2);
    float a = max(alpha, ALPHA_DELTA);
    return D_GGX_stable(clamp(dot(N, H), 0.0f, 1.0f), cross(N, H), a) * V_SmithGGX(NdotL, NdotV, a) * NdotL;
}

#endif
