/* water_shade.h - radiance of a sea, composed from the functions of shade.h and from look-ups that the host,
 * a renderer, supplies. It is no part of shade.h: a host defines the types and functions below, and includes
 * this text after them. src/water/water_shade.c is the host on the CPU, src/gl/shaders/sea_*.glsl on the GPU.
 *
 *     SeaHost                  whatever its look-ups need
 *     SeaPosition              a point, in coordinates of the host
 *     SeaPlace                 a point of the surface as the eye sees it: V (unit, to the eye), point
 *                              (WaterPoint), height_m, cosine, footprint_m; see src/water/water_place.h
 *
 *     Water host_water(host), WaterLight host_light(host), WaterCrest host_crest(host)
 *     vec3 host_sunbeam(host)  irradiance (lx) across the sun's beam just below the surface
 *     vec3 host_sunward(host)  unit direction to the sun below the surface
 *     SeaPosition host_position(place)
 *     SeaPosition host_along(P, d, x)             the point x m from P along d
 *     float host_depth(P)                         depth (m) below still water, >= 0
 *
 *     bool host_has_bed(host), host_has_light_on_bed(host): whether the light on the bed varies
 *     vec3 host_bed_albedo(host)
 *     float host_bed_rise(host, d)                m per m along d
 *     float host_bed_depth(host, P)               depth (m) of the bed there below still water
 *     float host_over_bed(host, P)                height (m) of P over the bed
 *     float host_distance_to_bed(host, P, d)      m, at most WATER_FAR_M: no bed is hit
 *     vec2 host_bed_visibility(host, P)           transmittance of a model for light that reaches the bed: of the
 *                                                 sun's beam, of all other light
 *     vec2 host_caustics(host, P, width)          irradiance of the beam relative to its mean over a footprint
 *                                                 (m), weighted by coverage; the share that it does not cover */
#ifndef SHADE_COMPOSE_WATER_SHADE_H
#define SHADE_COMPOSE_WATER_SHADE_H
#include "shade/lang/lang_c_begin.h"

/* ---- light on the bed ---- */

/* Irradiance (lx, horizontal) just below the surface, `depth` m above the bed, with interreflections between
 * both. */
FN vec3 sea_light_over_bed(SeaHost host, float depth)
{
    Water w = host_water(host);
    return water_interreflected(w, host_light(host).downwelling,
                                water_bed_reflectance(w, host_bed_albedo(host), depth));
}

/* Irradiance of the bed relative to its mean, `distance` m from P along the unit direction d, over a footprint
 * (m). */
FN vec3 sea_bed_lit(SeaHost host, SeaPosition P, vec3 d, float distance, float width)
{
    SeaPosition at = host_along(P, d, distance);
    vec3 focused =
        water_focused(host_water(host), host_bed_albedo(host), host_light(host).downwelling,
                      host_sunbeam(host), host_sunward(host)[1], max(host_bed_depth(host, at), 0.0f));
    vec2 visibility = host_bed_visibility(host, at);
    vec2 caustics = host_caustics(host, at, width);
    return water_bed_lit(focused, caustics[0] + caustics[1] * visibility[0], visibility[1]);
}

/* ---- light from below ---- */

/* Radiance (cd/m^2) just below the surface along the refracted ray `down`, of a bed `depth` m below. lit,
 * mean_lit: relative irradiance of the bed where the ray hits it, and around. */
FN vec3 sea_over_bed(SeaHost host, float depth, vec3 down, vec3 lit, vec3 mean_lit)
{
    float rise = host_bed_rise(host, down);
    float distance = water_way_to_bed(depth, rise, down);
    vec3 light = sea_light_over_bed(host, water_bed_depth(depth, rise, distance));
    vec3 albedo = host_bed_albedo(host);
    return water_over_bed(host_water(host), light, albedo * lit, albedo * mean_lit, depth, rise, down);
}

/* Upwelling radiance just below the surface, towards the eye: of deep water, or of the bed through it. */
FN vec3 sea_from_below(SeaHost host, SeaPlace p)
{
    Water w = host_water(host);
    WaterLight light = host_light(host);
    vec3 down = water_refracted(w, -p.V, p.point.N);
    vec3 crest = water_crest(w, light, host_crest(host), p.point.N, p.V, down, p.height_m);
    if (!host_has_bed(host))
        return water_from_deep(w, light.downwelling) + crest;
    SeaPosition P = host_position(p);
    float depth = host_over_bed(host, P);
    vec3 lit = vec3(1.0f);
    vec3 mean_lit = vec3(1.0f);
    if (host_has_light_on_bed(host)) {
        float distance = water_way_to_bed(depth, host_bed_rise(host, down), down);
        float width = water_bed_footprint(w, p.point.N, p.V, down, p.point.covariance,
                                          p.footprint_m * inversesqrt(p.cosine), distance);
        lit = sea_bed_lit(host, P, down, distance, width);
        mean_lit = sea_bed_lit(host, P, down, distance, max(width, 0.25f * distance));
    }
    return sea_over_bed(host, depth, down, lit, mean_lit) + crest;
}

/* ---- through water ---- */

/* Radiance (cd/m^2) at P from the unit direction d through water that ends only at the bed, if there is one.
 * The ray is `width` m wide at P and widens by `spread` m per m. */
FN vec3 sea_seen_through_water(SeaHost host, SeaPosition P, vec3 d, float width, float spread)
{
    Water w = host_water(host);
    float x = host_distance_to_bed(host, P, d);
    float z = host_depth(P);
    vec3 ground = vec3(0.0f);
    if (x < WATER_FAR_M) {
        float depth = max(z - x * d[1], 0.0f);
        vec3 mean = water_bed_below(w, sea_light_over_bed(host, depth), host_bed_albedo(host), depth);
        vec3 bed = mean;
        if (host_has_light_on_bed(host)) {
            float footprint = (width + spread * x) * inversesqrt(clamp(-d[1], 0.05f, 1.0f));
            bed = mean * sea_bed_lit(host, P, d, x, footprint);
            mean = mean * sea_bed_lit(host, P, d, x, max(footprint, 0.25f * x));
        }
        ground = water_bed_through(w, bed, mean, x);
    }
    /* an endless upward ray leaves water as bright as near the surface */
    float reach = sel(d[1] > 1e-4f, min(x, z / d[1]), x);
    return ground + water_through(w, host_light(host).downwelling, host_sunbeam(host), host_sunward(host),
                                  vec3(0.0f), z, d, reach);
}

#include "shade/lang/lang_c_end.h"
#endif
