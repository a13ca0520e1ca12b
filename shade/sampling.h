/* sampling.h - points, directions and their densities for Monte Carlo integration.
 *
 * Directions are unit vectors in tangent space: x tangent, y bitangent, z normal. u is uniform in [0, 1)^2.
 * Densities are per sr. */
#ifndef SHADE_SAMPLING_H
#define SHADE_SAMPLING_H

/* ---- points ---- */

FN uint reverse_bits(uint x)
{
    uint b = (x << 16u) | (x >> 16u);
    b = ((b & 0x00FF00FFu) << 8u) | ((b & 0xFF00FF00u) >> 8u);
    b = ((b & 0x0F0F0F0Fu) << 4u) | ((b & 0xF0F0F0F0u) >> 4u);
    b = ((b & 0x33333333u) << 2u) | ((b & 0xCCCCCCCCu) >> 2u);
    return ((b & 0x55555555u) << 1u) | ((b & 0xAAAAAAAAu) >> 1u);
}

/* Van der Corput sequence in base 2: the bits of i mirrored behind the binary point. Result in [0, 1). */
FN float radical_inverse(uint i)
{
    return float(reverse_bits(i) >> 8u) * (1.0f / 16777216.0f); /* 24 bits: exact, never 1 */
}

/* Point i of the n-point Hammersley set in [0, 1)^2: (i / n, radical_inverse(i)). */
FN vec2 hammersley(uint i, uint n)
{
    return vec2(float(i) / float(n), radical_inverse(i));
}

/* ---- frames ---- */

/* Orthonormal, right-handed basis whose third column is the unit vector N: mul(basis, v) brings v from
 * tangent space to N's. Duff et al. 2017, "Building an Orthonormal Basis, Revisited". */
FN mat3 basis_from_normal(vec3 N)
{
    float s = sel(N[2] < 0.0f, -1.0f, 1.0f);
    float a = -1.0f / (s + N[2]);
    float b = N[0] * N[1] * a;
    return mat3(vec3(1.0f + s * N[0] * N[0] * a, s * b, -s * N[0]), vec3(b, s + N[1] * N[1] * a, -N[1]), N);
}

/* The same with V in the plane of the first and third column, on the side of the first. V unit. */
FN mat3 basis_from_view(vec3 N, vec3 V)
{
    vec3 across = V - N * dot(N, V);
    float length2 = dot(across, across);
    if (length2 < 1e-12f)
        return basis_from_normal(N);
    vec3 X = across * inversesqrt(length2);
    return mat3(X, cross(N, X), N);
}

/* ---- cosine-weighted hemisphere ---- */

/* Direction with density z / pi. Malley's method: a uniform point of the disk, projected up. */
FN vec3 sample_cosine(vec2 u)
{
    float r = sqrt(u[1]);
    float phi = 2.0f * PI * u[0];
    return vec3(r * cos(phi), r * sin(phi), sqrt(max(1.0f - u[1], 0.0f)));
}
FN float pdf_cosine(float NdotL)
{
    return max(NdotL, 0.0f) * INV_PI;
}

/* ---- GGX normals ---- */

/* Microfacet normal H with density D_GGX(z, alpha) z. Walter et al. 2007, equation 35, as sin^2 = a^2 u /
 * (1 - u + a^2 u), which does not cancel. */
FN vec3 sample_D_GGX(vec2 u, float alpha)
{
    float phi = 2.0f * PI * u[0];
    float a2 = alpha * alpha;
    float d = 1.0f / (1.0f - u[1] + a2 * u[1]);
    float sin_theta = sqrt(a2 * u[1] * d);
    return vec3(sin_theta * cos(phi), sin_theta * sin(phi), sqrt((1.0f - u[1]) * d));
}

/* Density of H; that of L = reflect(-V, H) is pdf / (4 V.H). */
FN float pdf_D_GGX(float NdotH, float alpha)
{
    return D_GGX(NdotH, alpha) * NdotH;
}

/* Visible microfacet normal H of V (z > 0): density G1(V) max(0, V.H) D(H) / V.z. Stretches the hemisphere to
 * alpha = 1, where visible normals form a spherical cap around V, and back. Dupuy and Benyoub 2023, "Sampling
 * Visible GGX Normals with Spherical Caps". */
FN vec3 sample_VNDF_GGX(vec2 u, vec3 V, float alpha_x, float alpha_y)
{
    vec3 V_hemi = normalize(vec3(alpha_x * V[0], alpha_y * V[1], V[2]));
    float phi = 2.0f * PI * u[0];
    float z = (1.0f - u[1]) * (1.0f + V_hemi[2]) - V_hemi[2];
    float sin_theta = sqrt(clamp(1.0f - z * z, 0.0f, 1.0f));
    vec3 h = vec3(sin_theta * cos(phi), sin_theta * sin(phi), z) + V_hemi;
    return normalize(vec3(alpha_x * h[0], alpha_y * h[1], max(h[2], 1e-7f)));
}

/* Density of H; that of L = reflect(-V, H) is pdf / (4 V.H). */
FN float pdf_VNDF_GGX(vec3 V, vec3 H, float alpha_x, float alpha_y)
{
    return G1_SmithGGX_anisotropic(V, alpha_x, alpha_y) * max(dot(V, H), 0.0f) *
           D_GGX_anisotropic(H, alpha_x, alpha_y) / V[2];
}

/* The same for reflection only: a smaller cap leaves out most normals that reflect V below the surface, so
 * fewer samples are lost and the variance is lower. The cap of the stretched hemisphere, z > -V.z, is cut
 * at -k V.z:
 *   k = (1 - a^2) s^2 / (s^2 + a^2 V.z^2),  s = 1 + sqrt(1 - V.z^2),  a = min(alpha_x, alpha_y)
 * Eto and Tokuyoshi 2023, "Bounded VNDF Sampling for Smith-GGX Reflections". V.z > 0. */
FN float bounded_VNDF_k(float NdotV, float alpha_x, float alpha_y)
{
    float a = min(alpha_x, alpha_y);
    float a2 = a * a;
    float s = 1.0f + sqrt(max((1.0f - NdotV) * (1.0f + NdotV), 0.0f));
    float s2 = s * s;
    return (1.0f - a2) * s2 / (s2 + a2 * NdotV * NdotV);
}
FN vec3 sample_bounded_VNDF_GGX(vec2 u, vec3 V, float alpha_x, float alpha_y)
{
    vec3 V_hemi = normalize(vec3(alpha_x * V[0], alpha_y * V[1], V[2]));
    float phi = 2.0f * PI * u[0];
    float b = bounded_VNDF_k(V[2], alpha_x, alpha_y) * V_hemi[2];
    float z = (1.0f - u[1]) * (1.0f + b) - b;
    float sin_theta = sqrt(clamp(1.0f - z * z, 0.0f, 1.0f));
    vec3 h = vec3(sin_theta * cos(phi), sin_theta * sin(phi), z) + V_hemi;
    return normalize(vec3(alpha_x * h[0], alpha_y * h[1], max(h[2], 1e-7f)));
}

/* Density of L = reflect(-V, H) with such an H: D(H) / (2 (k V.z + |(ax V.x, ay V.y, V.z)|)). */
FN float pdf_bounded_reflection(vec3 V, vec3 H, float alpha_x, float alpha_y)
{
    float root = length(vec3(alpha_x * V[0], alpha_y * V[1], V[2]));
    return D_GGX_anisotropic(H, alpha_x, alpha_y) /
           (2.0f * (bounded_VNDF_k(V[2], alpha_x, alpha_y) * V[2] + root));
}

#endif
