/* water_shade.c - see water_shade.h. The order is: footprint, slopes that it hides, normal; the sky in them, the sun in them with its
 * glints, what comes from below; all composed, foam over it. */
#include <math.h>

#include "water/water_shade.h"

static const float OLD_FOAM = 0.4f; /* albedo over that of fresh foam */

/* ---- the place ---- */

/* About the cosine at which waves are seen that a ray at the cosine mu meets: no less than the slopes make of grazing rays. The mean slope
 * towards the eye, of Gaussian ones of a standard deviation sigma that a grazing ray meets, is 1.25 sigma. */
static float seen_cosine(vec3 V, vec3 C)
{
    float level2 = max(V[0] * V[0] + V[2] * V[2], 1e-8f);
    float variance = max(slope_variance(C, vec2(V[0], V[2])), 0.0f) / level2;
    return clamp(sqrt(V[1] * V[1] + 1.5708f * variance * level2), 1e-3f, 1.0f);
}

/* N turned to V as far as it takes to see it: facets that are not resolved do so. */
static vec3 faced(vec3 N, vec3 V)
{
    const float least = 1e-3f;
    float NdotV = dot(N, V);
    vec3 n = NdotV < least ? normalize(N + V * (least - NdotV)) : N;
    return n[1] > least ? n : normalize(vec3(n[0], least, n[2]));
}

/* Share of the footprint under foam, and *albedo: of that, over that of fresh foam. Old foam gets thin. Koepke 1984: 0.22 is the mean of
 * a patch's life, 0.55 its begin. */
static float foam_at(const water_setup *s, const water_place *p, float convergence, float footprint_m,
                     float *albedo)
{
    const facet_sea_look *look = &s->desc->look;
    const foam_rule *rule = &s->sea->foam;
    *albedo = 1.0f;
    if (look->no_foam || look->stage == 4 || !(rule->threshold < INFINITY))
        return 0.0f;
    float fresh = foam_coverage(rule, convergence, p->slopes.convergence_variance, rule->active_threshold);
    float old = waves_foam_at(&s->foam, p->rest[0], p->rest[1], footprint_m);
    float both = 1.0f - (1.0f - fresh) * (1.0f - old);
    *albedo = both > 0.0f ? mix(OLD_FOAM, 1.0f, clamp(fresh / both + old * old, 0.0f, 1.0f)) : 1.0f;
    return both;
}

water_place water_place_of(const water_setup *s, const march_ray *ray, const march_hit *hit)
{
    water_place p;
    const double *d = ray->direction;
    double rise = march_rise(&s->march, ray, hit->t);
    float side = ray->is_below ? -1.0f : 1.0f;
    p.V = normalize(vec3((float)-d[0], (float)-rise, (float)-d[2]));
    p.footprint_m = hit->width_m;
    vec3 facing = p.V * side;
    p.cosine = seen_cosine(facing, water_slopes_at(s, hit->footprint_m).resolved);
    float footprint = max(hit->footprint_m, hit->width_m * inversesqrt(p.cosine));
    p.slopes = water_slopes_at(s, footprint);
    double X = hit->X - (double)hit->displacement[0], Z = hit->Z - (double)hit->displacement[1];
    p.waves = waves_at(&s->sea->waves, X, Z, footprint);
    wave_shape shape = wave_shape_of(&p.waves);
    p.rest[0] = X;
    p.rest[1] = Z;
    p.P[0] = hit->X;
    p.P[1] = march_height(&s->march, ray, hit->t);
    p.P[2] = hit->Z;
    p.point.N = vec3(shape.normal[0], shape.normal[1], shape.normal[2]);
    p.point.N = side > 0.0f ? faced(p.point.N, facing) : p.point.N;
    p.point.covariance = p.slopes.covariance;
    p.point.foam = foam_at(s, &p, shape.convergence, footprint, &p.foam_albedo);
    return p;
}

/* ---- below ---- */

/* Sunlight that comes through the crest from behind. */
static vec3 backlight(const water_setup *s, const water_place *p, vec3 down)
{
    vec3 L = s->light.L;
    float level = sqrt(L[0] * L[0] + L[2] * L[2]);
    float above = p->waves.height_m - s->trough_m;
    vec2 slope = slope_from_normal(p->point.N);
    float rise = (slope[0] * L[0] + slope[1] * L[2]) / max(level, 1e-4f);
    if (!(above > 0.0f) || !(rise > 0.0f) || level < 1e-4f)
        return vec3(0.0f);
    float before = above / max(-down[1], 0.3f);
    return water_backlight(s->water, s->light, p->V, water_crest_way(above, rise), before);
}

vec3 water_from_below(const water_setup *s, const water_place *p)
{
    vec3 down = water_refracted(s->water, -p->V, p->point.N);
    vec3 crest = backlight(s, p, down);
    if (!water_has_bed(s))
        return water_from_deep(s->water, s->light.downwelling) + crest;
    const facet_sea_bed *bed = &s->sea->desc.bed;
    double depth = p->P[1] - water_bed_height(bed, p->P[0], p->P[2]);
    double closing = water_bed_rise(bed, down) - (double)down[1];
    WaterBed b;
    b.albedo = b.mean_albedo = vec3(bed->albedo[0], bed->albedo[1], bed->albedo[2]);
    b.way = closing > 1e-6 ? min((float)(depth / closing), 1e6f) : 1e6f;
    b.way = max(b.way, 0.0f);
    /* what lies over the place that is seen, whose height over the water here is that of the bed there */
    b.depth = clamp((float)depth - b.way * (float)water_bed_rise(bed, down), 0.0f, b.way);
    return water_from_bed(s->water, s->light.downwelling, b) + crest;
}

/* ---- the sun ---- */

/* Share of light along X that waves larger than the footprint let pass: Smith's, about the mean level. */
static float passing(const water_place *p, vec3 X)
{
    vec3 up = vec3(0.0f, 1.0f, 0.0f);
    if (X[1] <= 0.0f)
        return 0.0f;
    return 1.0f / (1.0f + Lambda_slopes(WATER_BECKMANN, smith_a(p->slopes.resolved, up, X)));
}

/* Extent of the footprint on the water along x and z. */
static vec2 footprint_extent(const water_place *p)
{
    float w = p->footprint_m;
    float level2 = max(p->V[0] * p->V[0] + p->V[2] * p->V[2], 1e-8f);
    float longer = 1.0f / (p->cosine * p->cosine) - 1.0f;
    return vec2(w * sqrt(1.0f + longer * p->V[0] * p->V[0] / level2),
                w * sqrt(1.0f + longer * p->V[2] * p->V[2] / level2));
}

static float glints(const water_setup *s, const water_place *p)
{
    vec3 H = normalize(p->V + s->light.L);
    const facet_sea_look *look = &s->desc->look;
    if (look->no_glints || look->stage == 4 || H[1] <= 0.0f || p->slopes.rate <= 0.0f)
        return 1.0f;
    float area = p->footprint_m * p->footprint_m / p->cosine, lifetime = 1.0f / p->slopes.rate;
    float count = glint_count(s->water.normals, p->point.covariance, p->point.N, H, p->slopes.curvature, area,
                              s->shutter_s / lifetime);
    uint cell = glint_cell(vec2((float)p->rest[0], (float)p->rest[1]), footprint_extent(p));
    return glint_variate(cell, count, (float)s->sea->waves.time_s, lifetime);
}

static vec3 sun_in_water(const water_setup *s, const water_place *p, WaterLight light)
{
    if (light.L[1] <= 0.0f || light.sun_irradiance[1] <= 0.0f)
        return vec3(0.0f);
    vec3 sun = water_sun(s->water, p->point, light, p->V) * passing(p, s->light.L);
    return sun[1] > 0.0f ? sun * glints(s, p) : sun;
}

/* ---- all ---- */

vec3 water_shade(const water_setup *s, const water_place *p, const water_findings *found)
{
    float means[4] = {1.0f, 1.0f, 0.0f, 0.0f}; /* of flat water; the table's first row has slopes of 1e-4 */
    float NdotV = clamp(dot(p->point.N, p->V), 1e-4f, 1.0f);
    const vec3 least = vec3(SLOPE_VARIANCE_MIN, SLOPE_VARIANCE_MIN, 0.0f);
    float sigma = sigma_towards(p->point.covariance - least, p->point.N, p->V);
    if (sigma > 1e-6f)
        water_table_at(&s->table, NdotV, sigma, means);
    Water w = s->water;
    w.foam_albedo *= p->foam_albedo;
    WaterMirror m = water_mirror(w, p->point, p->V, means[0], means[1], means[2], means[3]);
    m.escape *= passing(p, normalize(m.R + vec3(0.0f, 1e-4f, 0.0f)));
    vec3 sky =
        found->has_mirrored ? found->mirrored : water_sky_reflected(&s->sky, m.R, m.perceptual_roughness);
    vec3 below = found->has_below ? found->below : water_from_below(s, p);
    WaterLight light = s->light;
    if (found->has_shadow)
        light.sun_irradiance = light.sun_irradiance * found->sun;
    vec3 sun = sun_in_water(s, p, light);
    return water_radiance(water_parts(w, p->point, light, m, sky, sun, below));
}

vec3 water_shade_land(const water_setup *s)
{
    const facet_sea_bed *bed = &s->sea->desc.bed;
    vec3 N =
        normalize(vec3(-bed->slope * cos(bed->direction_rad), 1.0f, -bed->slope * sin(bed->direction_rad)));
    vec3 E = s->light.sun_irradiance * max(dot(N, s->light.L), 0.0f) + s->light.sky_irradiance;
    return vec3(bed->albedo[0], bed->albedo[1], bed->albedo[2]) * E * INV_PI;
}
