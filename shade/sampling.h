/* sampling.h - points, directions and their densities for Monte Carlo integration. */
#ifndef SHADE_SAMPLING_H
#define SHADE_SAMPLING_H

/* Van der Corput sequence in base 2: the bits of i mirrored behind the binary
 * point. Result in [0, 1). */
FN float radical_inverse(uint i)
{
    uint b = i;
    b = (b << 16u) | (b >> 16u);
    b = ((b & 0x00FF00FFu) << 8u) | ((b & 0xFF00FF00u) >> 8u);
    b = ((b & 0x0F0F0F0Fu) << 4u) | ((b & 0xF0F0F0F0u) >> 4u);
    b = ((b & 0x33333333u) << 2u) | ((b & 0xCCCCCCCCu) >> 2u);
    b = ((b & 0x55555555u) << 1u) | ((b & 0xAAAAAAAAu) >> 1u);
    return float(b >> 8u) * (1.0f / 16777216.0f); /* 24 bits: exact, never 1 */
}

/* Point i of the n-point Hammersley set in [0, 1)^2. */
FN vec2 hammersley(uint i, uint n)
{
    return vec2(float(i) / float(n), radical_inverse(i));
}

/* Half vector in tangent space (z is the normal), with density D_GGX(z, alpha) z per sr.
 * u uniform in [0, 1)^2. Walter et al. 2007, equation 35. */
FN vec3 sample_D_GGX(vec2 u, float alpha)
{
    float phi = 2.0f * PI * u[0];
    float cos2 = (1.0f - u[1]) / (1.0f + (alpha * alpha - 1.0f) * u[1]);
    float sin_theta = sqrt(max(1.0f - cos2, 0.0f));
    return vec3(sin_theta * cos(phi), sin_theta * sin(phi), sqrt(cos2));
}

/* Orthonormal, right-handed basis whose third column is the unit vector N.
 * Duff et al. 2017, "Building an Orthonormal Basis, Revisited". */
FN mat3 basis_from_normal(vec3 N)
{
    float s = sel(N[2] < 0.0f, -1.0f, 1.0f);
    float a = -1.0f / (s + N[2]);
    float b = N[0] * N[1] * a;
    return mat3(vec3(1.0f + s * N[0] * N[0] * a, s * b, -s * N[0]), vec3(b, s + N[1] * N[1] * a, -N[1]), N);
}

#endif
