/* water_below.c - see water_below.h. Light of a place that is seen through water is weakened by absorption and by all scattering; what
 * is scattered into the ray comes from the light that goes down, and from the sun's beam. */
#include <math.h>

#include "water/water_below.h"

static const float FAR_M = 1e4f; /* farther than any water lets see */

static float depth_of(const double P[3])
{
    return (float)fmax(-P[1], 0.0);
}

vec3 water_behind_water(const water_setup *s, vec3 radiance, const double P[3], vec3 d, float x)
{
    return water_through(s->water, s->light.downwelling, s->beam, s->sunward, radiance, depth_of(P), d, x);
}

/* m to the bed; FAR_M: it is not met. */
static float way_to_bed(const water_setup *s, const double P[3], vec3 d)
{
    const facet_sea_bed *bed = &s->sea->desc.bed;
    if (!water_has_bed(s))
        return FAR_M;
    double closing = water_bed_rise(bed, d) - (double)d[1];
    double above = P[1] - water_bed_height(bed, P[0], P[2]);
    if (above <= 0.0)
        return 0.0f;
    return closing > 1e-9 ? (float)fmin(above / closing, (double)FAR_M) : FAR_M;
}

vec3 water_seen_through_water(const water_setup *s, const double P[3], vec3 d, float width_m, float spread)
{
    float x = way_to_bed(s, P, d), z = depth_of(P);
    vec3 ground = vec3(0.0f);
    if (x < FAR_M) {
        float depth = max(z - x * d[1], 0.0f);
        vec3 light = water_light_over_bed(s, depth);
        vec3 mean = water_bed_below(s->water, light, water_bed_albedo(&s->sea->desc.bed), depth);
        float width = (width_m + spread * x) * inversesqrt(clamp(-d[1], 0.05f, 1.0f));
        vec3 bed = mean;
        if (water_has_light_on_bed(s)) {
            bed = mean * water_bed_lit_at(s, P, d, x, width);
            mean = mean * water_bed_lit_at(s, P, d, x, max(width, 0.25f * x));
        }
        ground = water_bed_through(s->water, bed, mean, x);
    }
    /* a ray that goes up for ever leaves water that would shine as it does near the surface */
    float reach = d[1] > 1e-4f ? min(x, z / d[1]) : x;
    return ground +
           water_through(s->water, s->light.downwelling, s->beam, s->sunward, vec3(0.0f), z, d, reach);
}

/* lx on a horizontal plane that looks down, just below the surface. */
static vec3 upwelling(const water_setup *s, const double P[3])
{
    const facet_sea_bed *bed = &s->sea->desc.bed;
    float depth = (float)fmax(P[1] - water_bed_height(bed, P[0], P[2]), 0.0);
    vec3 R = water_has_bed(s) ? water_bed_reflectance(s->water, water_bed_albedo(bed), depth)
                              : water_deep_reflectance(s->water);
    return R * water_interreflected(s->water, s->light.downwelling, R);
}

/* The surface as it is seen x m along d from the depth z. */
static vec3 surface_from_below(const water_setup *s, const water_place *p, vec3 d, float z, float x)
{
    WaterWindow window = water_window(s->water, d, water_seen_normal(p->point.covariance, p->point.N, d));
    vec3 mirrored = window.mirrored;
    if (mirrored[1] > -1e-3f)
        mirrored = normalize(vec3(mirrored[0], -1e-3f, mirrored[2]));
    const double below[3] = {p->P[0], fmin(p->P[1], 0.0), p->P[2]};
    vec3 L = vec3(0.0f), sun = vec3(0.0f);
    if (window.fresnel > 0.0f)
        L = water_seen_through_water(s, below, mirrored, p->footprint_m,
                                     water_mirrored_spread(p->point.covariance)) *
            window.fresnel;
    if (window.fresnel < 1.0f) {
        float perceptual_roughness = roughness_from_slopes(p->point.covariance * 0.1f);
        L = L + water_sky_reflected(&s->sky, window.outside, perceptual_roughness) * window.gain;
        sun = water_sun_through(s->water, p->point.covariance, s->light, window.outside, window.gain);
    }
    if (p->point.foam > 0.0f)
        L = mix(L, water_foam_below(s->water, s->light, upwelling(s, p->P)), p->point.foam);
    return water_surface_through(s->water, s->light.downwelling, s->beam, s->sunward, L,
                                 sun * (1.0f - p->point.foam), z, d, x);
}

vec3 water_shade_from_below(const water_setup *s, const march_ray *ray, const march_hit *hit)
{
    const double *o = ray->origin, *e = ray->direction;
    vec3 d = vec3((float)e[0], (float)e[1], (float)e[2]);
    float to_bed = way_to_bed(s, o, d);
    if (!hit || (float)hit->t >= to_bed)
        return water_seen_through_water(s, o, d, (float)ray->width, (float)ray->spread);
    water_place p = water_place_of(s, ray, hit);
    return surface_from_below(s, &p, d, depth_of(o), (float)hit->t);
}
