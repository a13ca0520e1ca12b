/* sea_radiance.h - radiance of a sea, composed from the functions of shade.h and from look-ups that the host,
 * a renderer, supplies. It is no part of shade.h: a host defines the types and functions below, and includes
 * this text after them. src/water/water_shade.c is the host on the CPU, src/gl/shaders/sea_*.glsl on the GPU.
 *
 *     SeaHost                  whatever its look-ups need
 *     SeaPosition              a point, in coordinates of the host
 *     SeaPlace                 a point of the surface as the eye sees it: V, point, footprint_m, pixel_m, height_m,
 *                              cosine; slopes: resolved, curvature, rate; as in src/water/water_place.h
 *
 *     Water host_water(host), WaterLight host_light(host), WaterCrest host_crest(host)
 *     vec3 host_sunbeam(host)               irradiance (lx) across the sun's beam just below the surface
 *     vec3 host_sunward(host)               unit direction to the sun below the surface
 *     WaterMeans host_means(host, mu, sigma)         the LUT of means: fresnel, escape, lift, spread
 *     vec3 host_sky(host, R, perceptual_roughness)   prefiltered radiance without the sun
 *     bool host_is_below(host)              whether the eye is in the water
 *
 *     bool host_has_glints(host)            else the mean of the sun's glints is shown
 *     float host_shutter_s(host), float host_glint_time(host)   exposure time, time of the image; s
 *     vec2 host_rest_from_eye(host, p)      x, z of the water's resting position, m
 *     vec2 host_rest(host, p)               the same from the origin
 *     WaterStyle host_style(host)
 *
 *     SeaPosition host_position(p)
 *     float host_height(p)                  height (m) of the point over still water
 *     SeaPosition host_along(P, d, x)       the point x m from P along d
 *     SeaPosition host_sunk(P)              P, or the point of still water below it
 *     float host_depth(P)                   depth (m) below still water, >= 0
 *
 *     bool host_has_bed(host), host_has_light_on_bed(host)      the latter: the light on it varies
 *     vec3 host_bed_albedo(host)
 *     float host_bed_rise(host, d)          m per m along d
 *     float host_bed_depth(host, P)         depth (m) of the bed there below still water
 *     float host_over_bed(host, P)          height (m) of P over the bed
 *     float host_distance_to_bed(host, P, d)         m; WATER_FAR_M: no bed is hit
 *     vec2 host_bed_visibility(host, P)     transmittance of a model for light that reaches the bed: the sun's beam,
 *                                           all other light
 *     vec2 host_caustics(host, P, width)    irradiance of the beam relative to its mean over a footprint (m), weighted
 *                                           by coverage; the share that is not covered
 *
 *     bool host_has_model(host)
 *     vec3 host_model_low(host, p), host_model_high(host, p)    corners of its box, m from the point
 *     float host_sun_visibility(host, p)    share of the sun's light that passes the model
 *     FacetHit host_model_hit(host, p, d, is_transmitted, is_alone)   along d from the point: on the eye's side of the
 *                                           surface, or, transmitted, on the other; is_alone: the pixel's only ray
 *     int host_facet_count(host), uint host_random(host)        of the pixel: rays for microfacets; a hash */
#ifndef SHADE_COMPOSE_SEA_RADIANCE_H
#define SHADE_COMPOSE_SEA_RADIANCE_H
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
    float distance = water_distance_to_bed(depth, rise, down);
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
        float distance = water_distance_to_bed(depth, host_bed_rise(host, down), down);
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

/* Radiance of a model in the water, `distance` m along d from a depth (m); height: of the model over still water. */
FN vec3 sea_model_behind_water(SeaHost host, vec3 radiance, float height, float depth, vec3 d, float distance)
{
    Water w = host_water(host);
    vec3 L = radiance * water_transmittance(water_K_d(w), max(-height, 0.0f));
    return water_through(w, host_light(host).downwelling, host_sunbeam(host), host_sunward(host), L, depth, d,
                         distance);
}

/* ---- a model in the microfacets ---- */

#define SEA_FACETS_MIN_SHARE 1e-3f /* a share of microfacets that is not worth a ray */
#define SEA_FACETS_SMOOTH 1e-3f    /* slopes that deflect a reflection by less than a pixel */

/* What microfacets reflect and refract of a model, as shares of all light. */
STRUCT(SeaFound)
{
    float covered;  /* share of the reflection, whatever its radiance, by microfacets that show the model */
    vec3 reflected; /* its radiance */
    vec3 through;   /* from below: transmitted radiance of the model */
    vec3 hidden;    /* from below: that of the sky behind it */
    float sun;      /* share of the sun's light that arrives */
};

/* Light that a microfacet reflects away from the eye's side hits another wave and returns to it. */
FN SeaFound sea_add_reflection(SeaHost host, SeaPlace p, vec3 d, Facet f, bool is_alone, SeaFound found)
{
    Water w = host_water(host);
    bool is_below = host_is_below(host);
    float side = sel(is_below, -1.0f, 1.0f);
    vec3 R = reflect(d, f.m);
    R[1] = side * max(abs(R[1]), 1e-4f);
    float c = clamp(-side * dot(f.m, d), 0.0f, 1.0f);
    float weight = f.weight * sel(is_below, water_fresnel_inside(w, c), water_fresnel(w, c));
    if (weight <= 0.0f)
        return found;
    FacetHit hit = host_model_hit(host, p, R, false, is_alone);
    if (hit.opacity <= 0.0f)
        return found;
    vec3 L = hit.radiance;
    if (is_below)
        L = sea_model_behind_water(host, L, hit.height, hit.depth, R, hit.distance);
    found.covered += weight * hit.opacity;
    found.reflected += L * (weight * hit.opacity);
    return found;
}

/* From below, in place of the sky, past waves. roughness: of the sky, as microfacets refract it. */
FN SeaFound sea_add_transmission(SeaHost host, SeaPlace p, vec3 d, Facet f, bool is_alone, float roughness,
                                 SeaFound found)
{
    WaterWindow window = water_window(host_water(host), d, f.m);
    float passing = water_visibility(p.slopes.resolved, p.point.N, window.outside);
    if (f.weight * passing <= 0.0f || window.fresnel >= 1.0f)
        return found;
    FacetHit hit = host_model_hit(host, p, window.outside, true, is_alone);
    float weight = f.weight * window.gain * passing * hit.opacity;
    if (weight <= 0.0f)
        return found;
    found.through += hit.radiance * weight;
    found.hidden += host_sky(host, window.outside, roughness) * weight;
    return found;
}

/* With host_facet_count() microfacets: on the CPU 64 per pixel, with 4 to 16 per sample; by OpenGL 16. N: mean normal;
 * smooth_N: normal without the unresolved waves. */
FN SeaFound sea_sample_facets(SeaHost host, SeaPlace p, vec3 d, FacetRange r, vec3 N, vec3 smooth_N,
                              bool is_transmitted, float roughness, SeaFound found)
{
    if (facets_share(r) < SEA_FACETS_MIN_SHARE)
        return found;
    bool is_smooth = max(r.along, r.across) < SEA_FACETS_SMOOTH;
    int count = host_facet_count(host);
    int i = 0;
    do {
        Facet f;
        f.m = smooth_N;
        f.weight = 1.0f;
        if (!is_smooth) {
            f = facet_drawn(r, N, sobol_scrambled(uint(i), host_random(host)));
            f.weight *= 1.0f / float(count);
        }
        if (is_transmitted)
            found = sea_add_transmission(host, p, d, f, is_smooth, roughness, found);
        else
            found = sea_add_reflection(host, p, d, f, is_smooth, found);
        ++i;
    } while (i < count && !is_smooth);
    return found;
}

FN SeaFound sea_found_nothing(SeaHost host, SeaPlace p)
{
    SeaFound found;
    found.covered = 0.0f;
    found.reflected = vec3(0.0f);
    found.through = vec3(0.0f);
    found.hidden = vec3(0.0f);
    found.sun = sel(host_light(host).L[1] > 0.0f, host_sun_visibility(host, p), 1.0f);
    return found;
}

FN SeaFound sea_find_above(SeaHost host, SeaPlace p)
{
    vec3 N = p.point.N;
    FacetRange r =
        facets_that_reflect(p.point.covariance, N, p.V, host_model_low(host, p), host_model_high(host, p));
    return sea_sample_facets(host, p, -p.V, r, N, N, false, 0.0f, sea_found_nothing(host, p));
}

/* d: unit, from the eye in the water. The part of the model's box below the surface is reflected, the part above it is
 * refracted. */
FN SeaFound sea_find_below(SeaHost host, SeaPlace p, vec3 d)
{
    vec3 C = p.point.covariance;
    vec3 N = water_faced(p.point.N, d);
    vec3 smooth_N = water_seen_normal(C, p.point.N, d);
    vec3 low = host_model_low(host, p);
    vec3 high = host_model_high(host, p);
    float roughness = window_roughness(facets_seen(C, p.point.N, d), C);
    SeaFound found = sea_found_nothing(host, p);
    if (low[1] < 0.0f) {
        FacetRange r = facets_that_reflect(C, N, d, -vec3(high[0], min(high[1], 0.0f), high[2]), -low);
        found = sea_sample_facets(host, p, d, r, N, smooth_N, false, 0.0f, found);
    }
    if (high[1] > 0.0f) {
        FacetRange r =
            facets_that_refract(C, N, d, vec3(low[0], max(low[1], 0.0f), low[2]), high, host_water(host).ior);
        found = sea_sample_facets(host, p, d, r, N, smooth_N, true, roughness, found);
    }
    return found;
}

/* Radiance just below the surface of a hit along the refracted ray: lit by the light that reaches it, and attenuated
 * by the water. */
FN vec3 sea_model_from_below(SeaHost host, SeaPlace p, FacetHit hit)
{
    Water w = host_water(host);
    float depth = max(host_height(p) - hit.height, 0.0f);
    vec3 down = water_transmittance(water_K_d(w), depth);
    vec3 lit = hit.radiance * down;
    vec3 gone = down * water_transmittance(water_diffuse(w), hit.distance);
    return lit * water_transmittance(water_beam(w), hit.distance) +
           water_from_deep(w, host_light(host).downwelling) * (1.0f - gone);
}

/* ---- the sun ---- */

/* Factor of the sun's reflection by the glints of a pixel, 1 on average. */
FN float sea_glints(SeaHost host, SeaPlace p)
{
    vec3 L = host_light(host).L;
    vec3 H = normalize(p.V + L);
    if (!host_has_glints(host) || H[1] <= 0.0f || p.slopes.rate <= 0.0f)
        return 1.0f;
    float area = p.pixel_m * p.pixel_m / p.cosine;
    float lifetime = 1.0f / p.slopes.rate;
    float count = glint_count(host_water(host).normals, p.point.covariance, sun_slopes(L, p.V), p.point.N, H,
                              p.slopes.curvature, area, host_shutter_s(host) / lifetime);
    return glint_seen(host_rest_from_eye(host, p), p.pixel_m, p.cosine, count, host_glint_time(host),
                      lifetime);
}

/* Radiance of the sun in the microfacets. */
FN vec3 sea_sun_reflected(SeaHost host, SeaPlace p, WaterLight light)
{
    if (light.L[1] <= 0.0f || light.sun_irradiance[1] <= 0.0f)
        return vec3(0.0f);
    vec3 sun = water_sun(host_water(host), p.point, light, p.V);
    if (!(sun[1] > 0.0f))
        return vec3(0.0f);
    return sun * (water_visibility(p.slopes.resolved, p.point.N, light.L) * sea_glints(host, p));
}

/* ---- from above ---- */

/* The sky's reflection, its mean over the microfacets. */
FN WaterSpecular sea_specular(SeaHost host, SeaPlace p)
{
    WaterMeans means;
    means.fresnel = 1.0f; /* of flat water; the LUT's first row has slopes of 1e-4 */
    means.escape = 1.0f;
    means.lift = 0.0f;
    means.spread = 0.0f;
    float NdotV = clamp(dot(p.point.N, p.V), 1e-4f, 1.0f);
    vec3 least = vec3(SLOPE_VARIANCE_MIN, SLOPE_VARIANCE_MIN, 0.0f);
    float sigma = sigma_towards(p.point.covariance - least, p.point.N, p.V);
    if (sigma > 1e-6f)
        means = host_means(host, NdotV, sigma);
    WaterSpecular m =
        water_specular(host_water(host), p.point, p.V, means.fresnel, means.escape, means.lift, means.spread);
    return water_specular_masked(m, p.slopes.resolved, p.point.N);
}

/* Radiance (cd/m^2) towards an eye above the water: reflected sky, sun with its glints, light from below; then foam
 * on top. */
FN vec3 sea_shade(SeaHost host, SeaPlace p)
{
    Water w = host_water(host);
    WaterLight light = host_light(host);
    WaterSpecular m = sea_specular(host, p);
    vec3 sky = host_sky(host, m.R, m.perceptual_roughness);
    vec3 below = vec3(0.0f);
    float opacity = 0.0f;
    if (host_has_model(host)) {
        SeaFound found = sea_find_above(host, p);
        if (found.covered > 0.0f) {
            float share = min(found.covered / m.fresnel, 1.0f);
            sky = sky * (1.0f - share) + found.reflected * (share / found.covered);
        }
        light.sun_irradiance = light.sun_irradiance * found.sun;
        FacetHit hit = host_model_hit(host, p, water_refracted(w, -p.V, p.point.N), true, true);
        opacity = hit.opacity;
        if (opacity > 0.0f)
            below = sea_model_from_below(host, p, hit);
    }
    if (opacity < 1.0f)
        below = mix(sea_from_below(host, p), below, opacity);
    return water_radiance(water_parts(w, p.point, light, m, sky, sea_sun_reflected(host, p, light), below));
}

/* ---- from below ---- */

/* Radiance by way of the microfacets. */
STRUCT(SeaMicrofacets)
{
    vec3 window;    /* of the sky, through Snell's window */
    float fresnel;  /* reflectance */
    vec3 reflected; /* radiance of the reflected water */
};

/* Reflected water for microfacets with the mean normal m. */
FN vec3 sea_reflected_below(SeaHost host, SeaPlace p, vec3 d, vec3 m)
{
    vec3 R = reflect(d, m);
    if (R[1] > -1e-3f)
        R = normalize(vec3(R[0], -1e-3f, R[2]));
    return sea_seen_through_water(host, host_sunk(host_position(p)), R, p.footprint_m,
                                  water_reflection_spread(p.point.covariance));
}

/* upwards: upward radiance below the surface. Snell's window has an edge, so each microfacet has its own sky;
 * reflected water varies little. */
FN SeaMicrofacets sea_microfacets_below(SeaHost host, SeaPlace p, vec3 d, vec3 upwards)
{
    Water w = host_water(host);
    vec3 C = p.point.covariance;
    vec3 N = p.point.N;
    FacetRange all = facets_seen(C, N, d);
    float critical = water_critical_cosine(w);
    float roughness = window_roughness(all, C);
    SeaMicrofacets L;
    L.window = vec3(0.0f);
    L.fresnel = 0.0f;
    L.reflected = vec3(0.0f);
    vec3 reflecting = vec3(0.0f);
    float share = 0.0f;
    int k = 0;
    do {
        Facet f = facet_of_window(all, C, N, d, critical, k);
        WaterWindow window = water_window(w, d, f.m);
        share += f.weight;
        L.fresnel += f.weight * window.fresnel;
        reflecting += f.m * (f.weight * window.fresnel);
        if (f.weight > 0.0f && window.fresnel < 1.0f) {
            vec3 sky = host_sky(host, window.outside, roughness);
            L.window += window_light(w, window, p.slopes.resolved, N, sky, upwards) * f.weight;
        }
        ++k;
    } while (k < WINDOW_FACETS && !is_window_sharp(all));
    if (L.fresnel > 0.0f)
        L.reflected = sea_reflected_below(host, p, d, normalize(reflecting));
    L.window *= 1.0f / share;
    L.fresnel *= 1.0f / share;
    return L;
}

/* Upward irradiance just below the surface, lx. */
FN vec3 sea_upwelling(SeaHost host, SeaPlace p)
{
    Water w = host_water(host);
    vec3 R = water_deep_reflectance(w);
    if (host_has_bed(host))
        R = water_bed_reflectance(w, host_bed_albedo(host), max(host_over_bed(host, host_position(p)), 0.0f));
    return R * water_interreflected(w, host_light(host).downwelling, R);
}

/* Radiance (cd/m^2) of the surface x m along the unit direction d from an eye in the water, at a depth (m). What the
 * model sends is as sharp as without a surface. */
FN vec3 sea_shade_below(SeaHost host, SeaPlace p, vec3 d, float x, float depth)
{
    Water w = host_water(host);
    WaterLight light = host_light(host);
    vec3 upwelling = sea_upwelling(host, p);
    SeaMicrofacets facets = sea_microfacets_below(host, p, d, upwelling * INV_PI);
    vec3 L = facets.window + facets.reflected * facets.fresnel;
    vec3 sharp =
        water_sun_below(w, p.point, light, d) * water_visibility(p.slopes.resolved, p.point.N, light.L);
    if (host_has_model(host)) {
        SeaFound found = sea_find_below(host, p, d);
        /* both shares are random */
        float share = sel(found.covered > facets.fresnel, facets.fresnel / found.covered, 1.0f);
        L = max(facets.window - found.hidden, 0.0f) +
            facets.reflected * (facets.fresnel - share * found.covered);
        sharp = sharp * found.sun + (found.through + found.reflected * share);
    }
    if (p.point.foam > 0.0f)
        L = mix(L, water_foam_below(w, light, upwelling), p.point.foam);
    return water_surface_through(w, light.downwelling, host_sunbeam(host), host_sunward(host), L,
                                 sharp * (1.0f - p.point.foam), depth, d, x);
}

/* ---- the legacy style, and painted water ---- */

/* Linear values whose sRGB encoding is the legacy program's display output. d: unit, from the eye. */
FN vec3 sea_legacy(SeaHost host, SeaPlace p, vec3 d)
{
    WaterStyle style = host_style(host);
    float sparkle = 0.0f;
    if (style.has_sparkles) { /* white noise fixed to the water, about one cell in ten */
        GlintCell cell = glint_cell(host_rest(host, p), vec2(p.footprint_m), 1.0f);
        sparkle = sel(glint_uniform(cell.key) > 0.9f, 1.0f, 0.0f);
    }
    float foam = sel(style.has_foam, water_legacy_foam(length(slope_from_normal(p.point.N))), 0.0f);
    return water_legacy_linear(water_legacy_shade(style.variant, style.stage, d, p.point.N,
                                                  host_light(host).L, host_height(p), sparkle, foam,
                                                  host_water(host).ior, style.perceptual_roughness));
}

/* Stage 3 of facet_sea_shading: radiance (cd/m^2) of an opaque reflecting surface with a base color under the sky. */
FN vec3 sea_painted(SeaHost host, SeaPlace p)
{
    float perceptual_roughness = host_style(host).perceptual_roughness;
    vec3 sky = host_sky(host, painted_reflection(p.point.N, p.V), perceptual_roughness);
    return painted_water(host_light(host), p.point.N, p.V, host_water(host).ior, perceptual_roughness, sky);
}

#include "shade/lang/lang_c_end.h"
#endif
