/* water_caustic.h - caustics on the bed below waves: the fraction of light focused by waves, the footprint
 * of the bed seen through waves, and lookups in caustic maps. The maps, made by the caller, hold the
 * irradiance of the sun's beam relative to its mean. Light scattered on its way down, and sky light, come
 * from too many directions to be focused.
 *
 * Watt 1990, "Light-water interaction using backward beam tracing"; Yuksel and Keyser 2009, "Fast real-time
 * caustics from height fields". */
#ifndef SHADE_WATER_CAUSTIC_H
#define SHADE_WATER_CAUSTIC_H

/* Fraction of the light on a bed of that albedo, `depth` m below, that was reflected by it and then by the
 * surface: R_int R. It comes from beyond 2 tan(48 degrees) of the depth, where reflection is total, and is
 * uniform. */
FN vec3 water_bed_returned(Water w, vec3 albedo, float depth)
{
    return water_internal_reflectance(w) * water_bed_reflectance(w, albedo, depth);
}

/* Fraction of the light on the bed in the unscattered sunbeam, [0, 1]:
 *   (1 - R_int R) E_beam mu e^(-c H / mu) / (E_d e^(-K_d H))
 * beam: lx across it just below the surface, at the cosine mu; downwelling: the transmitted light.
 * Scattering by particles turns light by 23 degrees on average, over a metre of depth farther than waves
 * focus it: singly scattered light counts as diffuse, as in water_from_bed() (Mobley 1994, section 3.9).
 * Bounded by the fraction at the surface, as K_d is that of all directions together. */
FN vec3 water_focused(Water w, vec3 albedo, vec3 downwelling, vec3 beam, float mu, float depth)
{
    vec3 faster = max(water_beam(w) * (1.0f / mu) - water_K_d(w), 0.0f);
    vec3 at_surface = beam * mu / max(downwelling, 1e-20f);
    return (1.0f - water_bed_returned(w, albedo, depth)) * min(at_surface, 1.0f) *
           water_transmittance(faster, depth);
}

/* Irradiance of the bed relative to its mean, where that of the beam is `factor` times and all other light
 * `rest` times its mean. */
FN vec3 water_bed_lit(vec3 focused, float factor, float rest)
{
    return focused * (factor - rest) + rest;
}

/* Footprint (m) on the bed of a ray `width` m wide at the surface, after `distance` m along `down`: unresolved
 * slopes C turn the refracted ray by gamma times their angle across the plane of incidence, and by gamma /
 * cos' within it, where
 *   gamma = cos' - cos / n
 * and the ray meets the bed at the cosine -down.y. The width of a box with the same variance, of the
 * geometric mean of both axes. */
FN float water_bed_footprint(Water w, vec3 N, vec3 V, vec3 down, vec3 C, float width, float distance)
{
    float inside = max(-dot(N, down), 0.1f);
    float gamma = inside - clamp(dot(N, V), 0.0f, 1.0f) / w.ior;
    float reach = distance * gamma;
    float variance = 0.5f * (C[0] + C[1]) * reach * reach / (inside * max(-down[1], 0.1f));
    return sqrt(width * width + 12.0f * variance);
}

/* Widening per m of a ray reflected by a surface of slopes C, whose tilts it doubles. A box's width. */
FN float water_reflection_spread(vec3 C)
{
    return 2.0f * sqrt(6.0f * max(C[0] + C[1], 0.0f));
}

/* Weight of a layer of the map at a position relative to its center, (-1, 1)^2 inside: 1, fading to 0 at its
 * border, where the next, wider one takes over. */
FN float caustic_cover(vec2 place)
{
    float inside = 1.0f - max(abs(place[0]), abs(place[1]));
    float t = clamp(inside * (1.0f / 0.2f), 0.0f, 1.0f);
    return t * t * (3.0f - 2.0f * t);
}

/* Mip of a layer for a footprint as wide as `texels` of its own. */
FN float caustic_lod(float texels)
{
    return log2(max(texels, 1.0f));
}

#endif
