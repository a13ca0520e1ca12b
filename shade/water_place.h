/* water_place.h - local properties of the sea for one view ray: footprint, normal, foam cover,
 * self-shadowing, and the bed below. The caller evaluates the waves, by summing tiles.
 *
 * V to the eye, unit; C: xx, zz, xz of a slope covariance (water_surface.h). */
#ifndef SHADE_WATER_PLACE_H
#define SHADE_WATER_PLACE_H

/* ---- waves ---- */

/* Blend weights of the patches of a tile without repetition, at a position in the rhombus of their triangles,
 * [0, 1)^2: of the corner (0, 0), or (1, 1) if place.x + place.y > 1, then (0, 1) and (1, 0). Each is the
 * square of its barycentric coordinate above a quarter; the squares of all sum to 1. Heitz and Neyret 2018. */
FN vec3 wave_patch_weights(vec2 place)
{
    float sum = place[0] + place[1];
    bool is_upper = sum > 1.0f;
    vec3 barycentric = vec3(sel(is_upper, sum - 1.0f, 1.0f - sum), sel(is_upper, 1.0f - place[0], place[1]),
                            sel(is_upper, 1.0f - place[1], place[0]));
    vec3 over = max(barycentric - 0.25f, 0.0f);
    vec3 squares = over * over;
    return squares * (1.0f / length(squares));
}

/* Weights of four samples in a row for a position between the middle two, f in [0, 1): the first three;
 * all sum to 1. Catmull and Rom 1974. */
FN vec3 wave_cubic_weights(float f)
{
    return vec3(f * (-0.5f + f * (1.0f - 0.5f * f)), 1.0f + f * f * (-2.5f + 1.5f * f),
                f * (0.5f + f * (2.0f - 1.5f * f)));
}

/* The displaced surface is (x + D_x, eta, z + D_z) over (x, z); D: xx, zz, xz of D's derivatives. Its
 * Jacobian, and its unit normal: the cross product of its derivatives. Where it folds or nearly so, its
 * Jacobian is clamped to 0.02: the normal points up. */
FN float wave_jacobian(vec3 D)
{
    return (1.0f + D[1]) * (1.0f + D[0]) - D[2] * D[2];
}
FN vec3 wave_normal(vec2 slope, vec3 D)
{
    return normalize(vec3(D[2] * slope[1] - (1.0f + D[1]) * slope[0], max(wave_jacobian(D), 0.02f),
                          D[2] * slope[0] - (1.0f + D[0]) * slope[1]));
}

/* ---- how wide ---- */

/* Filter width (m) of the surface for a ray `width` wide that meets it at the slope `rise`: the same, until
 * waves of the standard deviation `deviation` (m) are lower than a width. From then on only their slopes are
 * visible, over a footprint stretched by the grazing ray: up to the ray's length on still water. */
FN float water_footprint(float width, float rise, float deviation)
{
    float flat_share = 2.75f * width / max(deviation, 1e-6f);
    return width * min(1.0f + flat_share * flat_share, 1.0f / max(abs(rise), 1e-4f));
}

/* Typical cosine between waves and a ray towards V, bounded below by the slopes C at grazing angles. The mean
 * slope towards the eye of Gaussian slopes of standard deviation sigma on a grazing ray is 1.25 sigma. */
FN float water_seen_cosine(vec3 V, vec3 C)
{
    float level2 = max(V[0] * V[0] + V[2] * V[2], 1e-8f);
    float variance = max(slope_variance(C, vec2(V[0], V[2])), 0.0f) / level2;
    return clamp(sqrt(V[1] * V[1] + 1.5708f * variance * level2), 1e-3f, 1.0f);
}

/* N bent towards V until it is visible, as unresolved facets are. */
FN vec3 water_faced(vec3 N, vec3 V)
{
    float least = 1e-3f;
    float NdotV = dot(N, V);
    vec3 n = sel(NdotV < least, normalize(N + V * (least - NdotV)), N);
    return sel(n[1] > least, n, normalize(vec3(n[0], least, n[2])));
}

/* Visible normal for V where the position is less precise than the waves it reads, of the slopes C: the slope
 * is sampled by area rather than by visibility, and may face away. Visible tilts c are the length of a
 * three-dimensional vector (slopes_seen()): with N as one component, the root of c^2 + 2 V_h^T C V_h on
 * average. Where these slopes hardly matter beside c, the position is precise, and so is N. */
FN vec3 water_tilted(vec3 N, vec3 C, vec3 V)
{
    float variance = max(slope_variance(C, vec2(V[0], V[2])), 1e-14f);
    float c = dot(N, V) / N[1];
    float seen = sqrt(c * c + 2.0f * variance * exp(-0.25f * c * c / variance));
    float change = (c - seen) / max(V[0] * V[0] + V[2] * V[2], 1e-8f);
    return normal_from_slope(slope_from_normal(N) + vec2(V[0], V[2]) * change);
}

/* Visibility along X from a point of normal N past waves of the slopes C, which include N; Gaussian slopes
 * around the level. Masking accounts for the waves not in N: the product is the visibility past all. */
FN float water_visibility(vec3 C, vec3 N, vec3 X)
{
    bool is_up = X[1] > 0.0f && dot(N, X) > 0.0f;
    return sel(is_up, slopes_seen(C, vec3(0.0f, 1.0f, 0.0f), N, X), 0.0f);
}

/* Visibility of a reflection past waves of the slopes C, which include N. Elevations in it are normally
 * distributed around that of R: those below the horizon hit waves, and the rest, whose mean is higher by the
 * deviation times phi / Phi, is hidden by them accordingly. Phi is approximated by 1 / (1 + exp(-1.702 z)),
 * within 0.01 (Haley 1952), and phi by its derivative. */
FN WaterSpecular water_specular_masked(WaterSpecular m, vec3 C, vec3 N)
{
    float level = max(sqrt(m.R[0] * m.R[0] + m.R[2] * m.R[2]), 1e-6f);
    vec3 up = vec3(-m.R[0] * m.R[1] / level, level, -m.R[2] * m.R[1] / level);
    float above = 1.0f / (1.0f + exp(-1.702f * max(m.R[1] / max(m.deviation, 1e-4f), -40.0f)));
    vec3 R = m.R + up * (1.702f * m.deviation * (1.0f - above));
    WaterSpecular r = m;
    r.R = normalize(vec3(R[0], max(R[1], 0.0f), R[2]));
    r.escape = m.escape * above * water_visibility(C, N, r.R);
    return r;
}

/* Normal of the mean slope of the facets visible from V (unit, V.y > 0; slopes_seen()), whose slopes have
 * the covariance C around that of N. Tilts to the eye, in deviations sigma = sqrt(u^T C u), u along V's
 * horizontal part of the length l, start at
 *   a = (V.y / l - s_N.u) / sigma
 * and are lengths of a three-dimensional vector, longer by
 *   (2 Phi(a) - 1) / a - 2 a Phi(-a) + 2 phi(a)
 * on average; across u slopes follow by C u / sigma^2. A grazing ray sees tilts of 1.6 sigma, and never a
 * back side. */
FN vec3 water_seen_normal(vec3 C, vec3 N, vec3 V)
{
    float level = max(sqrt(V[0] * V[0] + V[2] * V[2]), 1e-4f);
    vec2 u = vec2(V[0], V[2]) * (1.0f / level);
    vec2 mean = slope_from_normal(N);
    float sigma = sqrt(max(slope_variance(C, u), SLOPE_VARIANCE_MIN));
    float first = (V[1] / level - mean[0] * u[0] - mean[1] * u[1]) / sigma;
    float a = clamp(first, 0.01f, 1e4f); /* N may face away */
    float hidden = 2.0f * normal_below(-a);
    float longer = (1.0f - hidden) / a - a * hidden + 0.797884561f * exp(-0.5f * a * a);
    vec2 towards = vec2(C[0] * u[0] + C[2] * u[1], C[2] * u[0] + C[1] * u[1]);
    return normal_from_slope(mean - towards * ((longer + max(a - first, 0.0f)) / sigma));
}

/* ---- foam ---- */

/* Breaking fraction of a footprint whose water converges by `mean` with this variance: where q is above the
 * threshold. Areas are seen from above, where converging water covers less: the mean Jacobian at q is 1 - q +
 * (q^2 - sigma^2) / 4. */
FN float foam_share(float mean, float variance, float threshold)
{
    float sigma = sqrt(max(variance, 0.0f));
    if (sigma < 1e-4f)
        return sel(mean > threshold, 1.0f, 0.0f);
    float area = max(1.0f - mean, 0.02f); /* of the footprint's water */
    float z = (threshold - mean) / sigma;
    float density = exp(-0.5f * z * z);
    float covered = area * normal_below(-z) - sigma * 0.398942280f * density * (1.0f - 0.25f * sigma * z);
    return clamp(covered / area, 0.0f, 1.0f);
}

/* Foam of the fraction `share`, (0, 1), covers the points where a Gaussian field of variance 1 exceeds its
 * quantile. Returns the covered fraction of a footprint with that mean and variance of the field. Most
 * foam has sharp edges; the rest is a veil that thins out around them: a field of larger variance,
 * thresholded at its own quantile, has the same mean. */
FN float foam_lace(float share, float mean, float variance)
{
    float sharp = 0.015f; /* added variances */
    float veil = 0.4f;
    float z = inverse_normal(share);
    float rest = max(variance, 0.0f);
    return mix(normal_below((mean + z * sqrt(1.0f + sharp)) * inversesqrt(rest + sharp)),
               normal_below((mean + z * sqrt(1.0f + veil)) * inversesqrt(rest + veil)), 0.3f);
}

/* Opaque fraction of a footprint of which `share` is foam. Foam thins out: water is visible between its
 * bubbles, so that a patch reflects 0.22 over its life and 0.55 in the beginning, when its amount is 1.
 * Koepke
 * 1984. */
FN float water_foam_cover(float share, float amount)
{
    return share * mix(0.4f, 1.0f, amount);
}

/* ---- the bed ---- */

/* A distance (m) beyond the visibility in any water. */
#define WATER_FAR_M 1e4f

/* Distance (m) along `down` to a planar bed, `depth` m below the point and rising by `rise` m per m along it. */
FN float water_distance_to_bed(float depth, float rise, vec3 down)
{
    float closing = rise - down[1];
    return max(sel(closing > 1e-6f, min(depth / closing, 1e6f), 1e6f), 0.0f);
}

/* Depth (m) of that bed after a path of `distance` m along it, below the same level. */
FN float water_bed_depth(float depth, float rise, float distance)
{
    return clamp(depth - distance * rise, 0.0f, distance);
}

/* That bed seen through the water: of the albedo `albedo`, and `mean_albedo` around, both with their
 * lighting; light: water_interreflected(). See water_from_bed(). */
FN vec3 water_over_bed(Water w, vec3 light, vec3 albedo, vec3 mean_albedo, float depth, float rise, vec3 down)
{
    WaterBed b;
    b.albedo = albedo;
    b.mean_albedo = mean_albedo;
    b.path_length = water_distance_to_bed(depth, rise, down);
    b.depth = water_bed_depth(depth, rise, b.path_length);
    return water_from_bed(w, light, b);
}

/* Radiance (cd/m^2) of dry ground of normal N. */
FN vec3 water_land(WaterLight light, vec3 albedo, vec3 N)
{
    vec3 E = light.sun_irradiance * max(dot(N, light.L), 0.0f) + light.sky_irradiance;
    return albedo * E * INV_PI;
}

/* ---- through water ---- */

/* Radiance behind x m of water, seen from a depth z (m) along the unit direction d: attenuated by absorption
 * and all scattering, with in-scattering of downwelling light and of the sun's beam (lx across it, unit
 * direction to the sun there). */
FN vec3 water_through(Water w, vec3 downwelling, vec3 beam, vec3 sunward, vec3 behind, float z, vec3 d,
                      float x)
{
    vec3 inscatter =
        water_inscatter(w, downwelling, z, d, x) + water_sun_inscatter(w, beam, sunward, z, d, x);
    return behind * water_transmittance(water_beam(w), x) + inscatter;
}

/* The surface from below, x m away: `wide`, light from many directions, is hardly attenuated by forward
 * scattering, which brings as much from around; the sun's scattered light is added by water_through(). Waves
 * and the rim of Snell's window stay sharp. */
FN vec3 water_surface_through(Water w, vec3 downwelling, vec3 beam, vec3 sunward, vec3 wide, vec3 sun,
                              float z, vec3 d, float x)
{
    return wide * water_transmittance(water_diffuse(w), x) +
           water_through(w, downwelling, beam, sunward, sun, z, d, x);
}

/* The bed's radiance below a depth (m); light: water_interreflected(). */
FN vec3 water_bed_below(Water w, vec3 light, vec3 albedo, float depth)
{
    return albedo * light * INV_PI * water_transmittance(water_K_d(w), depth);
}

/* A wide bed behind x m of water; forward scattered light shows its mean, as in water_from_bed(). */
FN vec3 water_bed_through(Water w, vec3 bed, vec3 mean, float x)
{
    vec3 sharp = water_transmittance(water_beam(w), x);
    return bed * sharp + mean * (water_transmittance(water_diffuse(w), x) - sharp);
}

#endif
