/* water_shade.c - see water_shade.h. The order is: the sky in the slopes, the sun in them with its glints, what comes from below;
 * all composed, foam over it. */
#include <math.h>

#include "water/water_shade.h"

/* ---- below ---- */

vec3 water_light_over_bed(const water_setup *s, float depth_m)
{
    return water_interreflected(
        s->water, s->light.downwelling,
        water_bed_reflectance(s->water, water_bed_albedo(&s->sea->desc.bed), depth_m));
}

vec3 water_bed_lit_at(const water_setup *s, const double P[3], vec3 d, float way, float width_m)
{
    double X = P[0] + (double)way * (double)d[0], Z = P[2] + (double)way * (double)d[2];
    float depth = max((float)-water_bed_height(&s->sea->desc.bed, X, Z), 0.0f);
    vec3 focused = water_focused(s->water, water_bed_albedo(&s->sea->desc.bed), s->light.downwelling, s->beam,
                                 s->sunward[1], depth);
    bed_shadow_texel open = bed_shadow_at(&s->shadow, X, Z);
    float beyond, factor = caustic_map_within(&s->caustics, X, Z, width_m, &beyond);
    return water_bed_lit(focused, factor + beyond * open.sun, open.rest);
}

/* lit, mean_lit: light on the bed over its mean where the ray meets it, and around. */
static vec3 over_bed(const water_setup *s, float depth, vec3 down, vec3 lit, vec3 mean_lit)
{
    const facet_sea_bed *bed = &s->sea->desc.bed;
    float rise = (float)water_bed_rise(bed, down), way = water_way_to_bed(depth, rise, down);
    vec3 light = water_light_over_bed(s, water_bed_depth(depth, rise, way)), albedo = water_bed_albedo(bed);
    return water_over_bed(s->water, light, albedo * lit, albedo * mean_lit, depth, rise, down);
}

vec3 water_from_still(const water_setup *s, float depth_m, vec3 down)
{
    return water_has_bed(s) ? over_bed(s, depth_m, down, vec3(1.0f), vec3(1.0f))
                            : water_from_deep(s->water, s->light.downwelling);
}

vec3 water_from_below(const water_setup *s, const water_place *p)
{
    vec3 down = water_refracted(s->water, -p->V, p->point.N), lit = vec3(1.0f), mean_lit = lit;
    vec3 crest = water_crest(s->water, s->light, s->crest, p->point.N, p->V, down, p->height_m);
    if (!water_has_bed(s))
        return water_from_deep(s->water, s->light.downwelling) + crest;
    const facet_sea_bed *bed = &s->sea->desc.bed;
    float depth = (float)(p->P[1] - water_bed_height(bed, p->P[0], p->P[2]));
    if (water_has_light_on_bed(s)) {
        float way = water_way_to_bed(depth, (float)water_bed_rise(bed, down), down);
        float width = p->footprint_m * inversesqrt(p->cosine);
        width = water_bed_footprint(s->water, p->point.N, p->V, down, p->point.covariance, width, way);
        lit = water_bed_lit_at(s, p->P, down, way, width);
        mean_lit = water_bed_lit_at(s, p->P, down, way, max(width, 0.25f * way));
    }
    return over_bed(s, depth, down, lit, mean_lit) + crest;
}

/* ---- the sun ---- */

static float glints(const water_setup *s, const water_place *p)
{
    vec3 H = normalize(p->V + s->light.L);
    const facet_sea_shading *look = &s->desc->sea_shading;
    if (look->omits_glints || look->stage == 4 || H[1] <= 0.0f || p->slopes.rate <= 0.0f)
        return 1.0f;
    float area = p->pixel_m * p->pixel_m / p->cosine, lifetime = 1.0f / p->slopes.rate;
    float count = glint_count(s->water.normals, p->point.covariance, sun_slopes(s->light.L, p->V), p->point.N,
                              H, p->slopes.curvature, area, s->shutter_s / lifetime);
    vec2 rest = vec2((float)(p->rest[0] - (double)s->camera.origin[0]),
                     (float)(p->rest[1] - (double)s->camera.origin[2]));
    return glint_seen(rest, p->pixel_m, p->cosine, count, waves_glint_time(&s->sea->waves), lifetime);
}

static vec3 sun_in_water(const water_setup *s, const water_place *p, WaterLight light)
{
    if (light.L[1] <= 0.0f || light.sun_irradiance[1] <= 0.0f)
        return vec3(0.0f);
    vec3 sun = water_sun(s->water, p->point, light, p->V);
    if (!(sun[1] > 0.0f))
        return vec3(0.0f);
    return sun * (water_passing(p->slopes.resolved, p->point.N, s->light.L) * glints(s, p));
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
    WaterMirror m = water_mirror(w, p->point, p->V, means[0], means[1], means[2], means[3]);
    m = water_mirror_passing(m, p->slopes.resolved, p->point.N);
    vec3 sky = water_sky_reflected(&s->sky, m.R, m.perceptual_roughness);
    if (found->covered > 0.0f) {
        float share = min(found->covered / m.fresnel, 1.0f);
        sky = sky * (1.0f - share) + found->mirrored * (share / found->covered);
    }
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
    return water_land(s->light, water_bed_albedo(bed), water_bed_normal(bed));
}
