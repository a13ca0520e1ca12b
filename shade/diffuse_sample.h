/* diffuse_sample.h - sampling of the energy-preserving Oren-Nayar model (diffuse.h) for path tracing.
 *
 * A cosine lobe is transformed by M = ((a, 0, b), (0, c, 0), (d, 0, 1)), fitted to f N.L, and clipped to the upper
 * hemisphere. Since the clipped lobe leaves out directions that f does not, it is mixed with a uniform hemisphere.
 * Directions are in the frame of basis_from_view(): V in the plane y = 0, x >= 0. Portsmouth, Kutz and Hill 2025,
 * "EON", section 4 and listing 4, whose fits these are. */
#ifndef SHADE_DIFFUSE_SAMPLE_H
#define SHADE_DIFFUSE_SAMPLE_H

/* (a, b, c) and d of M. */
STRUCT(EonTransform)
{
    float a, b, c, d;
};

FN EonTransform eon_transform(float NdotV, float r)
{
    float m = NdotV;
    EonTransform t;
    t.a = 1.0f + r * (0.303392f + (-0.518982f + 0.111709f * m) * m + (-0.276266f + 0.335918f * m) * r);
    t.b = r * (-1.16407f + 1.15859f * m + (0.150815f - 0.150105f * m) * r) / (m * m * m - 1.43545f);
    t.c = 1.0f + (0.20013f + (-0.506373f + 0.261777f * m) * m) * r;
    t.d = r * (0.540852f + (-1.01625f + 0.475392f * m) * m) / (-1.0743f + m * (0.0725628f + m));
    return t;
}

/* Probability of the uniform hemisphere. */
FN float eon_uniform_probability(float NdotV, float r)
{
    float m = NdotV;
    return pow(max(r, 1e-20f), 0.1f) * (0.162925f + m * (-0.372058f + (0.538233f - 0.290822f * m) * m));
}

/* Part of the disk below the cosine lobe whose directions M leaves above the horizon. */
FN float eon_clipped_share(EonTransform t)
{
    return 0.5f * (1.0f + inversesqrt(t.d * t.d + 1.0f));
}

/* Density per sr of sample_eon(). */
FN float pdf_eon(vec3 L, float NdotV, float r)
{
    if (L[2] <= 0.0f)
        return 0.0f;
    EonTransform t = eon_transform(NdotV, r);
    float determinant = t.c * (t.a - t.b * t.d);
    vec3 w = vec3(t.c * (L[0] - t.b * L[2]), (t.a - t.b * t.d) * L[1], t.c * (t.a * L[2] - t.d * L[0]));
    float k = determinant / dot(w, w);
    float lobe = k * k * max(w[2], 0.0f) * INV_PI / eon_clipped_share(t);
    float uniform_part = eon_uniform_probability(NdotV, r);
    return mix(lobe, 0.5f * INV_PI, uniform_part);
}

FN vec3 sample_eon(vec2 u, float NdotV, float r)
{
    float uniform_part = eon_uniform_probability(NdotV, r);
    float phi = 2.0f * PI * u[1];
    if (u[0] < uniform_part) {
        float z = 1.0f - u[0] / uniform_part;
        float across = sqrt(max((1.0f - z) * (1.0f + z), 0.0f));
        return vec3(across * cos(phi), across * sin(phi), z);
    }
    EonTransform t = eon_transform(NdotV, r);
    float radius = sqrt(min((u[0] - uniform_part) / (1.0f - uniform_part), 1.0f));
    float y = radius * sin(phi);
    float x = -mix(sqrt(max(1.0f - y * y, 0.0f)), radius * cos(phi), eon_clipped_share(t));
    float z = sqrt(max(1.0f - x * x - y * y, 0.0f));
    return normalize(vec3(t.a * x + t.b * z, t.c * y, t.d * x + z));
}

#endif
