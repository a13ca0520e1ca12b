/* sea_place.glsl - the place of the surface that a fragment shows, as in water_place.c. */
uniform highp sampler2DArray u_sea_foam; /* one value per texel: amount of foam, patterns */

/* water_slopes of water_setup.h. */
struct SeaSlopes
{
    vec3 covariance;
    vec3 resolved;
    float curvature;
    float rate;
};

struct SeaPlace
{
    vec3 d;           /* unit, from the eye */
    vec2 rest;        /* resting position of the water, from the eye, m */
    float t;          /* m */
    vec3 V;           /* unit, to the eye, against the level of the sea there */
    vec3 at;          /* x, z from the eye; y over still water; m */
    float footprint_m; /* across the ray */
    float cosine;     /* water_seen_cosine() */
    float height_m;   /* of waves */
    float pixel_m;    /* footprint of the whole pixel, for glints */
    SeaSlopes slopes; /* that the footprint does not resolve */
    WaterPoint point;
};

float host_height(SeaPlace p)
{
    return p.at.y;
}

vec2 host_rest_from_eye(SeaHost host, SeaPlace p)
{
    return p.rest;
}

vec2 host_rest(SeaHost host, SeaPlace p)
{
    return p.rest + eye.xz;
}

vec3 host_position(SeaPlace p)
{
    return p.at;
}

/* ---- slopes ---- */

/* Index of a footprint, with fraction: from 1 mm to 100 km, 63 steps. */
float sea_footprint_place(float footprint)
{
    return clamp(log2(max(footprint * 1000.0, 1.0)) * (63.0 / 26.575425), 0.0, 63.0);
}

/* Slope variances that a footprint does not resolve, and those that it does. */
SeaSlopes sea_slopes(float footprint)
{
    float place = sea_footprint_place(footprint);
    int i = min(int(place), SEA_FOOTPRINTS - 2);
    vec3 hidden = mix(sea_residual[i], sea_residual[i + 1], place - float(i)).xyz;
    vec2 moments = mix(sea_moments[i], sea_moments[i + 1], place - float(i)).xy;
    vec3 resolved = sea_total.xyz - hidden.xyz;
    if (sea_total.w > 0.0)
        hidden += sea_rough.xyz - sea_residual[0].xyz;
    vec3 least = vec3(SLOPE_VARIANCE_MIN, SLOPE_VARIANCE_MIN, 0.0);
    return SeaSlopes(vec3(max(hidden.xy, 0.0), hidden.z) + least, vec3(max(resolved.xy, 0.0), resolved.z) + least, moments.x, moments.y);
}

/* ---- foam ---- */

#ifdef HAS_FOAM
/* foam_plane_read(): level of planes for a footprint as wide as 2^octave texels. */
float sea_plane_level(float octave)
{
    return clamp(floor(octave + 0.5), 0.0, float(sea_counts.y - 1));
}

/* Mean of a plane; at: in samples. */
float sea_plane_mean(int layer, vec2 at, float level)
{
    return textureLod(u_sea_foam, vec3((at + 0.5) / float(sea_counts.z), layer), level).x;
}

/* read_pattern(): mean, and the unresolved variance. */
vec2 sea_pattern(int reading, int layer, vec2 rest, float octave)
{
    vec4 axes = sea_foam_axes[reading];
    vec4 eye = sea_foam_places[reading];
    float level = sea_plane_level(octave + eye.z);
    vec2 at = eye.xy + vec2(dot(rest, axes.xy), dot(rest, axes.zw));
    return vec2(sea_plane_mean(layer, at, level), sea_foam_hidden[int(level)][layer]);
}

/* waves_foam_at(): share, amount. */
vec2 sea_foam(vec2 rest, float footprint)
{
    SeaPatches p = sea_patches(0, rest);
    float octave = log2(max(footprint, 1e-9));
    float level = sea_plane_level(octave + log2(sea_axes[0].z));
    float share = 0.0;
    do {
        share += p.weights.x * p.weights.x * sea_plane_mean(0, sea_first(0, p), level);
        p = sea_rest(p);
    } while (p.weights.x > 0.0);
    share = clamp(share, 0.0, 1.0);
    bool is_even = share <= 1e-4 || share >= 0.999;
    vec2 field = vec2(0.0);
    int i = 0;
    do { /* most of the sea needs no iteration, and does one */
        float weight = sea_foam_places[i].w;
        field += sea_pattern(i, i > 0 ? 1 : 2, rest, octave) * vec2(weight, weight * weight);
        i++;
    } while (i < SEA_FOAM_READINGS && !is_even);
    return vec2(is_even ? share : foam_lace(share, field.x, field.y), share);
}
#endif

/* ---- all ---- */

/* The mesh's place (sea_surface.frag) corrected to the exact surface, by at most a cell: t, then the resting
 * position of the water there. */
vec3 sea_corrected(vec3 d, vec4 seen, float side)
{
    float t = seen.z;
    float level = length(d.xz);
    if (level < 0.1)
        return vec3(t, seen.xy);
    float y = d.y * t + sea_eye.x + t * t * level * level * sea_eye.y;
    float width = sea_ray.x * sea_ray.y * t * dot(d, forward.xyz);
    float footprint = water_footprint(width, d.y + 2.0 * t * level * level * sea_eye.y, sea_eye.z);
    vec2 D = d.xz * t - seen.xy;
    D = sea_heave(d.xz * t - D, footprint).xz;
    vec3 there = sea_heave(d.xz * t - D, footprint);
    float cell = min(sea_fan.w * max(1.0, t * level / sea_fan_level.y), 0.05) * t * level;
    float more = clamp((y - there.y) * side / seen.w, -cell, cell) / level;
    return vec3(t + more, d.xz * (t + more) - there.xz);
}

/* The place seen along d. */
SeaPlace sea_place(vec3 d, vec4 seen)
{
    SeaPlace p;
#ifdef IS_BELOW
    float side = -1.0;
#else
    float side = 1.0;
#endif
    vec3 corrected = sea_corrected(d, seen, side);
    float t = corrected.x;
    vec2 rest = corrected.yz;
    p.t = t;
    p.d = d;
    p.rest = rest;
    float level2 = 1.0 - p.d.y * p.d.y;
    float rise = p.d.y + 2.0 * p.t * level2 * sea_eye.y;
    p.V = normalize(vec3(-p.d.x, -rise, -p.d.z));
    p.at = d * t + vec3(0.0, sea_eye.x + t * t * level2 * sea_eye.y, 0.0);
    p.footprint_m = sea_ray.x * sea_ray.y * p.t * dot(p.d, forward.xyz);
    p.pixel_m = p.footprint_m / sea_ray.y;
    float footprint = water_footprint(p.footprint_m, rise, sea_eye.z);
    p.cosine = water_seen_cosine(p.V * side, sea_slopes(footprint).resolved);
    footprint = max(footprint, p.footprint_m * inversesqrt(p.cosine));
    p.slopes = sea_slopes(footprint);
    SeaWaves waves = sea_waves(rest, footprint);
    p.height_m = waves.displacement.y;
    p.point.N = wave_normal(waves.slope, waves.D);
#ifndef IS_BELOW
    p.point.N = water_faced(p.point.N, p.V);
#endif
    p.point.covariance = p.slopes.covariance;
    p.point.foam = 0.0;
#ifdef HAS_FOAM
    vec2 foam = sea_foam(rest, footprint);
    p.point.foam = water_foam_cover(foam.x, foam.y);
#endif
    return p;
}
