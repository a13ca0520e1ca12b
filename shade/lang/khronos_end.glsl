/* khronos_end.glsl - the functions of the shader library with the names and arguments of Khronos' Sample
 * Viewer, both of its current brdf.glsl and of that before 2025, for shaders that call these. alphaRoughness is
 * alpha, the square of the perceptual roughness; sheenRoughness is perceptual. */
#undef D_Charlie
#undef max3

/* ---- Fresnel ---- */

float F_Schlick(float f0, float f90, float VdotH) { return F_Schlick1(f0, f90, VdotH); }
float F_Schlick(float f0, float VdotH) { return F_Schlick1(f0, 1.0, VdotH); }
vec3 F_Schlick(vec3 f0, float f90, float VdotH) { return F_Schlick(f0, vec3(f90), VdotH); }
vec3 F_Schlick(vec3 f0, float VdotH) { return F_Schlick(f0, vec3(1.0), VdotH); }

/* F0 from the reflectance f at an angle: the inverse of F_Schlick, clamped at grazing angles. */
vec3 Schlick_to_F0(vec3 f, vec3 f90, float VdotH)
{
    float w = min(schlick_weight(VdotH), 0.9999);
    return (f - f90 * w) / (1.0 - w);
}
float Schlick_to_F0(float f, float f90, float VdotH) { return Schlick_to_F0(vec3(f), vec3(f90), VdotH).x; }
vec3 Schlick_to_F0(vec3 f, float VdotH) { return Schlick_to_F0(f, vec3(1.0), VdotH); }
float Schlick_to_F0(float f, float VdotH) { return Schlick_to_F0(vec3(f), vec3(1.0), VdotH).x; }

/* ---- GGX; D_GGX(NdotH, alphaRoughness) has its name already ---- */

float V_GGX(float NdotL, float NdotV, float alphaRoughness) { return V_SmithGGX(NdotL, NdotV, alphaRoughness); }

vec3 BRDF_specularGGX(float alphaRoughness, float NdotL, float NdotV, float NdotH)
{
    return vec3(V_SmithGGX(NdotL, NdotV, alphaRoughness) * D_GGX(NdotH, alphaRoughness));
}
vec3 BRDF_specularGGX(vec3 f0, vec3 f90, float alphaRoughness, float specularWeight, float VdotH, float NdotL,
                      float NdotV, float NdotH)
{
    return F_Schlick(f0, f90, VdotH) * BRDF_specularGGX(alphaRoughness, NdotL, NdotV, NdotH) * specularWeight;
}

/* ---- anisotropic GGX: at along the tangent, ab along the bitangent ---- */

float D_GGX_anisotropic(float NdotH, float TdotH, float BdotH, float anisotropy, float at, float ab)
{
    return D_GGX_anisotropic(vec3(TdotH, BdotH, NdotH), at, ab);
}
float V_GGX_anisotropic(float NdotL, float NdotV, float BdotV, float TdotV, float TdotL, float BdotL, float at,
                        float ab)
{
    return V_SmithGGX_anisotropic(vec3(TdotL, BdotL, NdotL), vec3(TdotV, BdotV, NdotV), at, ab);
}
vec3 BRDF_specularGGXAnisotropy(float alphaRoughness, float anisotropy, vec3 n, vec3 v, vec3 l, vec3 h, vec3 t, vec3 b)
{
    vec2 a = anisotropic_alpha(max(alphaRoughness, ALPHA_DELTA), anisotropy);
    vec3 L = vec3(dot(t, l), dot(b, l), max(dot(n, l), 0.0));
    vec3 V = vec3(dot(t, v), dot(b, v), max(dot(n, v), 0.0));
    return vec3(V_SmithGGX_anisotropic(L, V, a.x, a.y) * D_GGX_anisotropic(to_frame(h, t, b, n), a.x, a.y));
}
vec3 BRDF_specularGGXAnisotropy(vec3 f0, vec3 f90, float alphaRoughness, float anisotropy, vec3 n, vec3 v, vec3 l,
                                vec3 h, vec3 t, vec3 b)
{
    return F_Schlick(f0, f90, clamp(dot(v, h), 0.0, 1.0)) *
           BRDF_specularGGXAnisotropy(alphaRoughness, anisotropy, n, v, l, h, t, b);
}

/* ---- sheen ---- */

float lambdaSheenNumericHelper(float x, float alphaG) { return sheen_lambda_curve(x, alphaG); }
float lambdaSheen(float cosTheta, float alphaG) { return Lambda_Charlie(cosTheta, alphaG); }
float D_Charlie(float sheenRoughness, float NdotH) { return facet_D_Charlie(NdotH, sheen_alpha(sheenRoughness)); }
float V_Sheen(float NdotL, float NdotV, float sheenRoughness)
{
    return V_Charlie(NdotL, NdotV, sheen_alpha(sheenRoughness));
}
vec3 BRDF_specularSheen(vec3 sheenColor, float sheenRoughness, float NdotL, float NdotV, float NdotH)
{
    return sheenColor * (D_Charlie(sheenRoughness, NdotH) * V_Sheen(NdotL, NdotV, sheenRoughness));
}

/* ---- diffuse and films ---- */

vec3 BRDF_lambertian(vec3 diffuseColor) { return brdf_lambert(diffuseColor); }
vec3 BRDF_lambertian(vec3 f0, vec3 f90, vec3 diffuseColor, float specularWeight, float VdotH)
{
    return (1.0 - F_Schlick(f0, f90, VdotH) * specularWeight) * brdf_lambert(diffuseColor);
}
vec3 BRDF_lambertianIridescence(vec3 f0, vec3 f90, vec3 iridescenceFresnel, float iridescenceFactor, vec3 diffuseColor,
                                float specularWeight, float VdotH)
{
    float most = max(iridescenceFresnel.r, max(iridescenceFresnel.g, iridescenceFresnel.b));
    vec3 F = mix(F_Schlick(f0, f90, VdotH), vec3(most), iridescenceFactor);
    return (1.0 - F * specularWeight) * brdf_lambert(diffuseColor);
}
vec3 BRDF_specularGGXIridescence(vec3 f0, vec3 f90, vec3 iridescenceFresnel, float alphaRoughness,
                                 float iridescenceFactor, float specularWeight, float VdotH, float NdotL, float NdotV,
                                 float NdotH)
{
    vec3 F = mix(F_Schlick(f0, f90, VdotH), iridescenceFresnel, iridescenceFactor);
    return F * BRDF_specularGGX(alphaRoughness, NdotL, NdotV, NdotH) * specularWeight;
}

/* The viewer defines these itself. */
#undef FN
#undef STRUCT
#undef sel
#undef mul
#undef COL
#undef CONST_ARRAY3
#undef PI
#undef INV_PI
