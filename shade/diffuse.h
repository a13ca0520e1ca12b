/* diffuse.h - rough diffuse reflection (KHR_materials_diffuse_roughness): the energy-preserving Oren-Nayar model, EON, of
 * Portsmouth, Kutz and Hill 2025, "EON: A practical energy-preserving rough diffuse BRDF" (JCGT 14(1)).
 *
 * With A = 1 / (1 + c1 r) of the diffuse roughness r in [0, 1], and an albedo rho:
 *   f = rho / pi A (1 + r s / t) + rho_ms / pi (1 - E(V)) (1 - E(L)) / (1 - E_avg)
 *   s = L.V - N.L N.V,  t = max(N.L, N.V) where s > 0, else 1           Fujii 2012: single scattering
 *   E = A (1 + r g),  E_avg = A (1 + c2 r)                              albedo of the first term for rho = 1
 *   rho_ms = rho^2 E_avg / (1 - rho (1 - E_avg))
 * so that 1 - E = A r (c1 - g) and 1 - E_avg = A r (c1 - c2). Reciprocal; a white surface returns exactly 1; r = 0 is
 * Lambert's. */
#ifndef SHADE_DIFFUSE_H
#define SHADE_DIFFUSE_H

#define EON_C1 0.287793409f  /* 1/2 - 2 / (3 pi) */
#define EON_C2 0.0724882127f /* 2/3 - 28 / (15 pi) */

/* A. */
FN float eon_scale(float roughness)
{
    return 1.0f / (1.0f + EON_C1 * roughness);
}

/* g at N.X, by the authors' polynomial: within 4.6e-4. */
FN float eon_shape(float NdotX)
{
    float x = 1.0f - NdotX;
    return x * (0.0571085289f + x * (0.491881867f + x * (-0.332181442f + x * 0.0714429953f)));
}

/* c1 - g, at least 0. */
FN float eon_lost(float NdotX)
{
    return max(EON_C1 - eon_shape(NdotX), 0.0f);
}

/* Albedo of single scattering for rho = 1; 1 minus it is that of multiple scattering for rho_ms = 1. */
FN float eon_albedo(float NdotV, float roughness)
{
    return 1.0f - eon_scale(roughness) * roughness * eon_lost(NdotV);
}

/* rho_ms. rho in [0, 1]. */
FN vec3 eon_multiple(vec3 rho, float roughness)
{
    float lost = eon_scale(roughness) * roughness * (EON_C1 - EON_C2);
    return rho * rho * (1.0f - lost) / (vec3(1.0f) - rho * lost);
}

/* The BRDF, in 1/sr. NdotL, NdotV above 0. */
FN vec3 brdf_eon(vec3 rho, float roughness, float NdotL, float NdotV, float LdotV)
{
    float s = LdotV - NdotL * NdotV;
    float A = eon_scale(roughness) * INV_PI;
    float shape = 1.0f + roughness * s / sel(s > 0.0f, max(NdotL, NdotV), 1.0f);
    float single = A * max(shape, 0.0f); /* s is below -1 where V is behind a mapped normal */
    float multiple = A * roughness * eon_lost(NdotL) * eon_lost(NdotV) * (1.0f / (EON_C1 - EON_C2));
    return rho * single + eon_multiple(rho, roughness) * multiple;
}

/* ---- image-based lighting ----
 *
 * Of an environment given up to degree 2 of spherical harmonics, L(w) = l0 + a.w + w.Q w with Q symmetric and of trace
 * 0, reflected radiance is exact: the sum of l0, a and Q times the moments of f N.L. Irradiance over pi, which is
 * l0 + 2/3 a.d + 1/4 d.Q d in direction d, gives l0, a and Q. */

/* The environment in the frame (X, N): X is the unit horizontal part of V, any direction across N where V = N. */
STRUCT(DiffuseLight)
{
    vec3 mean;             /* l0 */
    vec3 along_X, along_N; /* a.X, a.N */
    vec3 XX, NN, XN;       /* X.Q X, N.Q N, X.Q N */
};

/* From irradiance over pi around N, -N, X, -X, Y, -Y with Y = cross(N, X), and the two of (X + N) / sqrt(2). */
FN DiffuseLight diffuse_light(vec3 N, vec3 minus_N, vec3 X, vec3 minus_X, vec3 Y, vec3 minus_Y, vec3 XN,
                              vec3 minus_XN)
{
    DiffuseLight d;
    vec3 even_N = 0.5f * (N + minus_N);
    vec3 even_X = 0.5f * (X + minus_X);
    d.mean = (even_N + even_X + 0.5f * (Y + minus_Y)) * (1.0f / 3.0f);
    d.along_N = 0.75f * (N - minus_N);
    d.along_X = 0.75f * (X - minus_X);
    d.NN = 4.0f * (even_N - d.mean);
    d.XX = 4.0f * (even_X - d.mean);
    d.XN = 2.0f * (XN + minus_XN) - 4.0f * d.mean - 0.5f * (d.NN + d.XX);
    return d;
}

/* Mean radiance of the environment weighted with f N.L of single scattering (f N.L / (rho E)); at least 0. The lobe
 * s / t adds roughness sin(N, V) times polynomials of N.V to Lambert's moments z = 2/3, z^2 = 1/2: that of x is exact,
 * the others are fits within 2e-4. */
FN vec3 eon_single_light(DiffuseLight d, float NdotV, float roughness)
{
    float m = NdotV;
    float scale = 1.0f / (1.0f + roughness * eon_shape(m));
    float w = scale * roughness * sqrt(max(1.0f - m * m, 0.0f));
    float x = w * (0.4583333f + m * (-0.25f + m * m * 0.0416667f));
    float z = scale * (2.0f / 3.0f) + w * (0.08707f + m * (0.00462f + m * (-0.12987f + m * 0.03716f)));
    float zz = scale * 0.5f + w * (0.03994f + m * (0.00551f + m * (-0.02576f - m * 0.021f)));
    float xz = w * (0.19155f + m * (0.00434f + m * (-0.10814f + m * 0.04481f)));
    float xx_minus_yy = w * (0.0826f + m * (-0.10728f + m * (0.00565f + m * 0.0193f)));
    float zz_minus_yy = 1.5f * zz - 0.5f + 0.5f * xx_minus_yy;
    return max(d.mean + d.along_X * x + d.along_N * z + d.XX * xx_minus_yy + d.NN * zz_minus_yy +
                   d.XN * (2.0f * xz),
               vec3(0.0f));
}

/* The same for multiple scattering, whose lobe c1 - g depends neither on V nor on the roughness. */
FN vec3 eon_multiple_light(DiffuseLight d)
{
    return max(d.mean + d.along_N * 0.7400516f + d.NN * (1.5f * 0.5856706f - 0.5f), vec3(0.0f));
}

/* Radiance reflected to V. single, multiple: of the two functions above; in uniform light the albedo times it. */
FN vec3 eon_reflected(vec3 rho, float NdotV, float roughness, vec3 single, vec3 multiple)
{
    float E = eon_albedo(NdotV, roughness);
    return rho * E * single + eon_multiple(rho, roughness) * (1.0f - E) * multiple;
}

#endif
