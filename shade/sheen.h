/* sheen.h - the soft rim of cloth (KHR_materials_sheen): fibers that stand up from the surface.
 *
 * Two models. Charlie is glTF's; its directional albedo E has no closed form, so a LUT is made from
 * sheen_albedo_sample(). The linearly transformed cosine has a fitted albedo and is sampled exactly. Names
 * are those of brdf.h; alpha here is sheen roughness squared. */
#ifndef SHADE_SHEEN_H
#define SHADE_SHEEN_H

/* Below sheen roughness 0.01 the rim is narrower than cosines in single precision can resolve. */
#define SHEEN_ALPHA_MIN 1e-4f

FN float sheen_alpha(float perceptual_roughness)
{
    return max(alpha_from_roughness(perceptual_roughness), SHEEN_ALPHA_MIN);
}

/* ---- Charlie ---- */

/* Distribution of fiber normals in 1/sr, largest at the horizon, 0 at N:
 *   D = (2 + 1 / a) sin^(1 / a) / (2 pi)
 * Normalised so that the integral of D (N.H) over the hemisphere is 1. Estevez and Kulla 2017, equation 2. */
FN float D_Charlie(float NdotH, float alpha)
{
    float exponent = 1.0f / alpha;
    float sin2 = max((1.0f - NdotH) * (1.0f + NdotH), 1e-7f);
    return (2.0f + exponent) * pow(sin2, 0.5f * exponent) * (0.5f * INV_PI);
}

/* The curve L of Lambda: a / (1 + b x^c) + d x + e, its five numbers mixed by (1 - alpha)^2.
 * Estevez and Kulla 2017, table 1. */
FN float sheen_lambda_curve(float x, float alpha)
{
    float q = (1.0f - alpha) * (1.0f - alpha);
    float a = mix(21.5473f, 25.3245f, q);
    float b = mix(3.82987f, 3.32435f, q);
    float c = mix(0.19823f, 0.16801f, q);
    float d = mix(-1.97760f, -1.27393f, q);
    float e = mix(-4.32054f, -4.85967f, q);
    return a / (1.0f + b * pow(max(x, 1e-20f), c)) + d * x + e;
}

/* Smith's auxiliary function of Charlie, in [0, inf): exp(L(x)) below x = 1/2, above it exp(2 L(1/2) - L(1
 * - x)), so that the logarithm is odd around 1/2. NdotX is the cosine of either direction. Estevez and
 * Kulla 2017, equation 3; glTF takes it without their softening of the terminator. */
FN float Lambda_Charlie(float NdotX, float alpha)
{
    if (NdotX < 0.5f)
        return exp(sheen_lambda_curve(NdotX, alpha));
    return exp(2.0f * sheen_lambda_curve(0.5f, alpha) - sheen_lambda_curve(1.0f - NdotX, alpha));
}

/* V = 1 / ((1 + Lambda(V) + Lambda(L)) 4 (N.L) (N.V)). Unbounded at grazing angles, not to be clamped.
 * KHR_materials_sheen. */
FN float V_Charlie(float NdotL, float NdotV, float alpha)
{
    float shadowing = 1.0f + Lambda_Charlie(NdotL, alpha) + Lambda_Charlie(NdotV, alpha);
    return 1.0f / max(shadowing * 4.0f * NdotL * NdotV, 1e-20f);
}

/* The cheaper V = 1 / (4 (N.L + N.V - (N.L) (N.V))): Filament's. Its albedo is up to twice Charlie's and
 * above 1 at grazing views of low roughness: a LUT of E holds for one visibility only. Neubelt and
 * Pettineo 2013. */
FN float V_Neubelt(float NdotL, float NdotV)
{
    return 0.25f / max(NdotL + NdotV - NdotL * NdotV, 1e-20f);
}

/* The lobe in 1/sr for a white sheen: D V. Reciprocal; no Fresnel term. */
FN float brdf_sheen(float NdotL, float NdotV, float NdotH, float alpha)
{
    return D_Charlie(NdotH, alpha) * V_Charlie(NdotL, NdotV, alpha);
}

/* Fiber normal H with density D_Charlie (N.H): sin = u^(a / (2 a + 1)). For prefiltering; few of these
 * normals are visible from one view, so a path tracer should use sample_sheen_rim(). */
FN vec3 sample_D_Charlie(vec2 u, float alpha)
{
    float phi = 2.0f * PI * u[0];
    float sin_theta = pow(max(1.0f - u[1], 1e-20f), alpha / (2.0f * alpha + 1.0f));
    return vec3(sin_theta * cos(phi), sin_theta * sin(phi),
                sqrt(max((1.0f - sin_theta) * (1.0f + sin_theta), 0.0f)));
}
FN float pdf_D_Charlie(float NdotH, float alpha)
{
    return D_Charlie(NdotH, alpha) * NdotH;
}

/* Direction L for the lobe, denser towards the horizon the narrower the rim is, azimuth uniform: N.L = z with
 *   p(z) = (1 + s) s / (s + z)^2 in [0, 1],   s = 1 / (N.V / (4 a) + 1 / sqrt(8 a))
 * after D = exp(-(N.H)^2 / (2 a)) with N.H from (N.V + z) / 2 on: s is where that has fallen by a factor
 * e, by either the linear or the square term. Covers the hemisphere; uniform in the limit of large s. */
FN float sheen_rim_width(float NdotV, float alpha)
{
    return 1.0f / (0.25f * NdotV / alpha + inversesqrt(8.0f * alpha));
}
FN vec3 sample_sheen_rim(vec2 u, float NdotV, float alpha)
{
    float s = sheen_rim_width(NdotV, alpha);
    float z = min(s * u[1] / (1.0f + s - u[1]), 1.0f);
    float r = sqrt(max((1.0f - z) * (1.0f + z), 0.0f));
    float phi = 2.0f * PI * u[0];
    return vec3(r * cos(phi), r * sin(phi), z);
}
FN float pdf_sheen_rim(float NdotL, float NdotV, float alpha)
{
    float s = sheen_rim_width(NdotV, alpha);
    float d = s + NdotL;
    return sel(NdotL > 0.0f, (1.0f + s) * s / (d * d) * (0.5f * INV_PI), 0.0f);
}

/* Term i of n of Charlie's directional albedo E(N.V) = int D V N.L dL; the mean of all n is E, accurate to
 * 1e-3 from about n = 4096 on. E exceeds 1 at grazing views of low roughness (1.033 at roughness 0.1, N.V
 * 0.05): a LUT stores it as is, its reader clamps.
 *
 * Normals of density D N.H leave a factor 1 / N.H of unbounded variance. Their random number is therefore w^2
 * of a uniform w, which moves normals to the horizon, N.H ~ w, and weights them with 2 w:
 *   term = 4 V N.L V.H / N.H * 2 w,   cos^2 = 1 - (1 - w^2)^(2 a / (2 a + 1)) */
FN float sheen_albedo_sample(uint i, uint n, float perceptual_roughness, float NdotV)
{
    float alpha = sheen_alpha(perceptual_roughness);
    vec2 u = hammersley(i, n);
    float w = u[0] + 0.5f / float(n);
    float phi = 2.0f * PI * u[1];
    float q = 2.0f * alpha / (2.0f * alpha + 1.0f);
    float v = w * w;
    /* 1 - (1 - v)^power by its series where the difference would cancel */
    float series =
        q * v *
        (1.0f + (1.0f - q) * v * (0.5f + (2.0f - q) * v * (1.0f / 6.0f + (3.0f - q) * v * (1.0f / 24.0f))));
    float cos2 = sel(v < 0.05f, series, 1.0f - pow(1.0f - v, q));
    float NdotH = sqrt(clamp(cos2, 0.0f, 1.0f));
    float sin_theta = sqrt(max(1.0f - cos2, 0.0f));
    float VdotH = sin_theta * cos(phi) * sqrt(max(1.0f - NdotV * NdotV, 0.0f)) + NdotH * NdotV;
    float NdotL = 2.0f * VdotH * NdotH - NdotV;
    if (NdotL <= 0.0f || VdotH <= 0.0f)
        return 0.0f;
    return 8.0f * V_Charlie(NdotL, NdotV, alpha) * NdotL * VdotH * w / max(NdotH, 1e-12f);
}

/* The mean of n terms. */
FN float integrate_sheen_albedo(float perceptual_roughness, float NdotV, uint n)
{
    float sum = 0.0f;
    for (uint i = 0u; i < n; ++i)
        sum += sheen_albedo_sample(i, n, perceptual_roughness, NdotV);
    return sum / float(n);
}

/* prefilter_sample() of ibl.h for this lobe: sample i of n around R with N = V = R; divide by the sum of the
 * weights N.L. D is 0 at N, so the lobe is a ring, most of which is below the horizon at low roughness;
 * Khronos' renderer accepts that. KHR_materials_sheen, "Image-Based Lighting". */
FN PrefilterSample prefilter_sheen_sample(uint i, uint n, float alpha, vec3 R)
{
    vec3 H = sample_D_Charlie(hammersley(i, n), alpha);
    float NdotL = 2.0f * H[2] * H[2] - 1.0f; /* L = reflect(-z, H) */
    PrefilterSample r;
    r.L = mul(basis_from_normal(R), vec3(2.0f * H[2] * H[0], 2.0f * H[2] * H[1], NdotL));
    r.weight = max(NdotL, 0.0f);
    r.pdf = 0.25f * D_Charlie(H[2], alpha);
    return r;
}

/* Transmittance of the sheen: 1 - max3(color) E, in [0, 1]. The clamp is for E above 1. KHR_materials_sheen,
 * "Albedo scaling technique". */
FN float sheen_scaling(vec3 sheen_color, float E)
{
    return clamp(1.0f - max3(sheen_color) * E, 0.0f, 1.0f);
}

/* ---- a linearly transformed cosine ----
 *
 * Zeltner, Burley and Chiang 2022, "Practical Multiple-Scattering Sheen Using Linearly Transformed Cosines": a
 * volume of fibers, seen from V in the plane y = 0 of a frame with z = N, reflects R(N.V) times a cosine lobe
 * transformed by the inverse of M = ((A, 0, B), (0, A, 0), (0, 0, 1)). A, B, R by the rational fits of
 * MaterialX; roughness is perceptual, at least 0.01. */

/* (A, B) of the transform. */
FN vec2 sheen_ltc_transform(float NdotV, float perceptual_roughness)
{
    float x = NdotV;
    float y = max(perceptual_roughness, 0.01f);
    float A = (2.58126f * x + 0.813703f * y) * y / (1.0f + 0.310327f * x * x + 2.60994f * x * y);
    float B = sqrt(max(1.0f - x, 0.0f)) * (y - 1.0f) * y * y * y /
              (0.0000254053f + 1.71228f * x - 1.71506f * x * y + 1.34174f * y * y);
    return vec2(A, B);
}

/* Directional albedo R of a white sheen, in [0, 1]. */
FN float sheen_ltc_albedo(float NdotV, float perceptual_roughness)
{
    float y = max(perceptual_roughness, 0.01f);
    float s = y * (0.0206607f + 1.58491f * y) / (0.0379424f + y * (1.32227f + y));
    float m = y * (-0.193854f + y * (-1.14885f + y * (1.7932f - 0.95943f * y * y))) / (0.046391f + y);
    float o = y * (0.000654023f + (-0.0207818f + 0.119681f * y) * y) / (1.26264f + y * (-1.92021f + y));
    float t = (NdotV - m) / s;
    return clamp(exp(-0.5f * t * t) / (s * 2.50662827f) + o, 0.0f, 1.0f);
}

/* Density per sr of L, which is also the lobe times N.L over R: the integral over the hemisphere is 1. V
 * in the plane y = 0, x >= 0. */
FN float pdf_sheen_ltc(vec3 V, vec3 L, float perceptual_roughness)
{
    vec2 t = sheen_ltc_transform(V[2], perceptual_roughness);
    vec3 wrapped = vec3(t[0] * L[0] + t[1] * L[2], t[0] * L[1], L[2]);
    float s = t[0] / dot(wrapped, wrapped);
    return max(L[2], 0.0f) * INV_PI * s * s;
}

/* Samples L with that density. */
FN vec3 sample_sheen_ltc(vec2 u, vec3 V, float perceptual_roughness)
{
    vec2 t = sheen_ltc_transform(V[2], perceptual_roughness);
    vec3 d = sample_cosine(u);
    return normalize(vec3(d[0] - d[2] * t[1], d[1], d[2] * t[0]));
}

#endif
