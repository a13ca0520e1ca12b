/* anisotropy.h - brushed metal, hair, records (KHR_materials_anisotropy): a lobe stretched along one tangent.
 * Its D and V are in brdf.h. */
#ifndef SHADE_ANISOTROPY_H
#define SHADE_ANISOTROPY_H

/* GGX widths along the tangent in which highlights are stretched and along the bitangent:
 * (mix(alpha, 1, strength^2), alpha). KHR_materials_anisotropy. */
FN vec2 anisotropic_alpha(float alpha, float strength)
{
    return vec2(mix(alpha, 1.0f, strength * strength), alpha);
}

/* Unit direction of stretching in tangent space: the texture's direction, or (1, 0), rotated
 * counter-clockwise by rotation (rad). direction is the texel's (2 r - 1, 2 g - 1), not 0. */
FN vec2 anisotropy_direction(vec2 direction, float rotation)
{
    float c = cos(rotation);
    float s = sin(rotation);
    float scale = inversesqrt(max(dot(direction, direction), 1e-20f));
    return vec2(c * direction[0] - s * direction[1], s * direction[0] + c * direction[1]) * scale;
}

/* v in the orthonormal frame T, B, N, as the anisotropic terms require. */
FN vec3 to_frame(vec3 v, vec3 T, vec3 B, vec3 N)
{
    return vec3(dot(T, v), dot(B, v), dot(N, v));
}

/* Direction of a single lookup of light prefiltered with an isotropic lobe, as the extension has it; ENERGY_GLTF's.
 * The normal is bent in the plane of B and
 * V, the more so the more anisotropic and smooth the surface is, and the reflection is bent back for rough
 * ones. B is the bitangent, across the stretching. KHR_materials_anisotropy, "Image based lighting", with
 * its last line, which Khronos' renderer omits:
 *   a = (1 - strength (1 - r))^4,  N' = mix((B x V) x B, N, a),  R = mix(reflect(-V, N'), N', r^2) */
FN vec3 anisotropic_reflection(vec3 N, vec3 B, vec3 V, float strength, float perceptual_roughness)
{
    vec3 grain_N = cross(cross(B, V), B); /* the component of V across B; 0 where V = B */
    float bend = 1.0f - strength * (1.0f - perceptual_roughness);
    float bend2 = bend * bend;
    vec3 bent = mix(grain_N, N, bend2 * bend2);
    float length2 = dot(bent, bent);
    bent = sel(length2 > 1e-12f, bent * inversesqrt(max(length2, 1e-12f)), N);
    vec3 R = reflect(-V, bent);
    return normalize(mix(R, bent, perceptual_roughness * perceptual_roughness));
}

/* One of ANISOTROPY_LOOKUPS lookups whose mean by weight is the light that an anisotropic lobe reflects. */
#define ANISOTROPY_LOOKUPS 16
STRUCT(AnisotropicLookup)
{
    vec3 L;                     /* unit, in the frame of the lobe */
    float perceptual_roughness; /* of the prefiltered radiance */
    float weight;               /* above 0 */
};

/* Lookup k. With the slopes (x, y) of microfacets, of distribution P, the reflected light is
 *   int f N.l L(l) dl = int P(x, y) (V.z + V.x x + V.y y) G2(V, l) L(l) dx dy / V.z,   l = reflect(-V, h)
 * The lobe is one of width ay in all directions, spread along T until its width is ax: by facets of y = 0 and
 *   x = w u / sqrt(1 - u^2),   w^2 = ax^2 - ay^2
 * which have GGX's slopes for uniform u in [-1, 1]. They reflect light from above the horizon for x between
 * (V.x - r) / V.z and (V.x + r) / V.z, r^2 = V.x^2 + V.z^2, where all of them are seen: u is uniform between those.
 * Half the angle between lookups is added to the width. Each lookup is bent towards N as that of an isotropic lobe of
 * width ay is, reflection_bend() with F0, at the angle at which the facets are seen; without anisotropy all are that one.
 *
 * In the studio, Leadenhall market and studio_small_03 the error is .05 to .6 of the mean (RMS) where that of one
 * lookup at anisotropic_reflection() is .15 to 4. V and alpha in the frame of the lobe; ax >= ay. */
FN AnisotropicLookup anisotropic_lookup(int k, vec3 V, vec2 alpha, float F0)
{
    float z = max(V[2], NDOTV_MIN);
    float r = sqrt(V[0] * V[0] + z * z);
    float steep = (abs(V[0]) + r) / z; /* the bound on the side of V; that on the other side is -1 / steep */
    float w2 = max(alpha[0] * alpha[0] - alpha[1] * alpha[1], 1e-8f);
    float near_u = steep * inversesqrt(steep * steep + w2);
    float far_u = -inversesqrt(1.0f + steep * steep * w2);
    float du = (near_u - far_u) * (1.0f / float(ANISOTROPY_LOOKUPS));
    float u = (far_u + (float(k) + 0.5f) * du) * sel(V[0] < 0.0f, -1.0f, 1.0f);
    float cos2 = 1.0f - u * u;
    float x = u * sqrt(w2 / cos2);
    float spacing = du * sqrt(w2 / cos2) / (cos2 + w2 * u * u); /* rad: dx / (1 + x^2) */

    AnisotropicLookup s;
    vec3 H = vec3(x, 0.0f, 1.0f) * inversesqrt(1.0f + x * x);
    s.L = reflect(-V, H);
    s.L[2] = max(s.L[2], NDOTV_MIN);
    s.weight = (z + V[0] * x) * s.L[2] * V_SmithGGX_anisotropic(s.L, vec3(V[0], V[1], z), alpha[0], alpha[1]);
    s.perceptual_roughness = sqrt(min(sqrt(alpha[1] * alpha[1] + 0.25f * spacing * spacing), 1.0f));
    float bend = reflection_bend(alpha[1], clamp(dot(V, H), 0.0f, 1.0f), F0);
    s.L = normalize(mix(s.L, vec3(0.0f, 0.0f, 1.0f), bend));
    return s;
}

/* The isotropic lobe with the directional albedo of an anisotropic one: (N.V, perceptual roughness) of the
 * lookup in a LUT of split-sum terms. Its width is the root mean square of both, and V is tilted until slopes
 * appear as steep as they do here:
 *   a^2 = (ax^2 + ay^2) / 2,   a tan' = |(ax V.x, ay V.y)| / V.z
 * V in the frame of the lobe. Found by comparing quadratures: within 0.04 of E over all strengths,
 * azimuths and elevations down to N.V = 0.05, 0.012 on average; a lookup at (N.V, r) itself has errors of
 * up to 0.35. */
FN vec2 anisotropic_table_point(vec3 V, vec2 alpha)
{
    float a2 = 0.5f * dot(alpha, alpha);
    float x = alpha[0] * V[0];
    float y = alpha[1] * V[1];
    float slope2 = (x * x + y * y) / max(a2, 1e-12f);
    float z = max(V[2], NDOTV_MIN);
    return vec2(clamp(z * inversesqrt(z * z + slope2), NDOTV_MIN, 1.0f), sqrt(sqrt(a2)));
}

/* Mean of Schlick's weight (1 - V.H)^5 over an anisotropic lobe, B / (A + B) of the split sum, in [0, 1]:
 * unlike E, it depends on the width in the plane of V, a = |(ax V.x, ay V.y)| / |(V.x, V.y)|:
 *   (1 - N.V)^(2.7 + 2.3 exp(-8.5 a)) / (1 + 22.7 a^1.36)
 * A fit to quadrature, within 0.07, 0.01 in the mean. V in the frame of the lobe. */
FN float anisotropic_grazing_share(vec3 V, vec2 alpha)
{
    float x = alpha[0] * V[0];
    float y = alpha[1] * V[1];
    float across2 = V[0] * V[0] + V[1] * V[1];
    float a = sel(across2 > 1e-12f, sqrt((x * x + y * y) / max(across2, 1e-12f)), alpha[0]);
    float power = 2.7f + 2.3f * exp(-8.5f * a);
    return pow(clamp(1.0f - V[2], 0.0f, 1.0f) + 1e-6f, power) / (1.0f + 22.7f * pow(a, 1.36f));
}

/* Upper bound of the split-sum terms of the anisotropic lobe seen from V, from those at
 * anisotropic_table_point(): an albedo that is too small would overcompensate and gain energy. E is moved
 * towards 1 by 0.2 (1 - E) k, B is 1 + k (0.3 + 0.6 max(ax, ay)^2) times its fit; k = |ax^2 - ay^2| / (ax^2 +
 * ay^2) measures the anisotropy. */
FN vec2 anisotropic_table_bound(vec2 dfg, vec3 V, vec2 alpha)
{
    vec2 a2 = alpha * alpha;
    float k = abs(a2[0] - a2[1]) / max(a2[0] + a2[1], 1e-12f);
    float E = dfg[0] + dfg[1];
    float bound = E + 0.2f * k * max(1.0f - E, 0.0f);
    float margin = 1.0f + k * (0.3f + 0.6f * max(a2[0], a2[1]));
    float fit = min(anisotropic_grazing_share(V, alpha) * margin, 1.0f);
    float share = mix(dfg[1] / max(E, 1e-6f), fit, min(10.0f * k, 1.0f));
    return vec2(bound * (1.0f - share), bound * share);
}

#endif
