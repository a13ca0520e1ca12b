/* water_shade.c - see water_shade.h. In order: reflected sky, sun with its glints, light from below;
 * composed, then foam on top. */
#include "water/water_shade.h"

#include <math.h>

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

/* lit, mean_lit: relative irradiance of the bed where the ray hits it, and around. */
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

/* Upward radiance (cd/m^2) just below the surface, towards the eye: of deep water, or of the bed through it. */
static vec3 from_below(const water_setup *s, const water_place *p)
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
    float means[4] = {1.0f, 1.0f, 0.0f, 0.0f}; /* of flat water; the LUT's first row has slopes of 1e-4 */
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
    vec3 below = found->has_below ? found->below : from_below(s, p);
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

/* ---- seen from below ---- */

static const float FAR_M = 1e4f; /* beyond the visibility in any water */

static float depth_of(const double P[3])
{
    return (float)fmax(-P[1], 0.0);
}

vec3 water_model_behind_water(const water_setup *s, const model_hit *hit, const double P[3], vec3 d)
{
    vec3 down = water_transmittance(water_K_d(s->water), max(-hit->P[1], 0.0f));
    vec3 L = water_model_radiance(&s->model, hit, s->light.L) * down;
    return water_through(s->water, s->light.downwelling, s->beam, s->sunward, L, depth_of(P), d,
                         (float)hit->distance_m);
}

float water_way_to_bed_below(const water_setup *s, const double P[3], vec3 d)
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
    float x = water_way_to_bed_below(s, P, d), z = depth_of(P);
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
    /* an endless upward ray leaves water as bright as near the surface */
    float reach = d[1] > 1e-4f ? min(x, z / d[1]) : x;
    return ground +
           water_through(s->water, s->light.downwelling, s->beam, s->sunward, vec3(0.0f), z, d, reach);
}

/* Upward irradiance just below the surface, lx. */
static vec3 upwelling(const water_setup *s, const double P[3])
{
    const facet_sea_bed *bed = &s->sea->desc.bed;
    float depth = (float)fmax(P[1] - water_bed_height(bed, P[0], P[2]), 0.0);
    vec3 R = water_has_bed(s) ? water_bed_reflectance(s->water, water_bed_albedo(bed), depth)
                              : water_deep_reflectance(s->water);
    return R * water_interreflected(s->water, s->light.downwelling, R);
}

/* Reflected water radiance for microfacets with the mean normal m. */
static vec3 mirrored_from_below(const water_setup *s, const water_place *p, vec3 d, vec3 m)
{
    vec3 mirrored = reflect(d, m);
    if (mirrored[1] > -1e-3f)
        mirrored = normalize(vec3(mirrored[0], -1e-3f, mirrored[2]));
    const double below[3] = {p->P[0], fmin(p->P[1], 0.0), p->P[2]};
    return water_seen_through_water(s, below, mirrored, p->footprint_m,
                                    water_mirrored_spread(p->point.covariance));
}

/* Radiance by way of the microfacets. */
typedef struct facets_light {
    vec3 window;   /* radiance of the sky, through Snell's window */
    float fresnel; /* reflectance */
    vec3 mirrored; /* radiance of the reflected water */
} facets_light;

/* upwards: upward radiance below the surface. Snell's window has an edge, so each microfacet has its own sky;
 * reflected water varies little. */
static facets_light facets_from_below(const water_setup *s, const water_place *p, vec3 d, vec3 upwards)
{
    vec3 C = p->point.covariance, N = p->point.N, mirrors = vec3(0.0f);
    FacetRange all = facets_seen(C, N, d);
    bool is_sharp = all.along < WINDOW_SHARP;
    float critical = water_critical_cosine(s->water), share = 0.0f;
    float roughness = window_roughness(all, C);
    facets_light L = {.window = vec3(0.0f), .mirrored = vec3(0.0f)};
    for (int k = 0; k < (is_sharp ? 1 : WINDOW_FACETS); k++) {
        Facet f = {water_seen_normal(C, N, d), 1.0f};
        if (!is_sharp)
            f = facet_of_window(all, N, d, critical, k);
        WaterWindow window = water_window(s->water, d, f.m);
        share += f.weight;
        L.fresnel += f.weight * window.fresnel;
        mirrors = mirrors + f.m * (f.weight * window.fresnel);
        if (f.weight <= 0.0f || window.fresnel >= 1.0f)
            continue;
        vec3 sky = water_sky_reflected(&s->sky, window.outside, roughness);
        L.window = L.window + window_light(s->water, window, p->slopes.resolved, N, sky, upwards) * f.weight;
    }
    if (L.fresnel > 0.0f)
        L.mirrored = mirrored_from_below(s, p, d, normalize(mirrors));
    L.window = L.window * (1.0f / share);
    L.fresnel *= 1.0f / share;
    return L;
}

/* Radiance of something other than sky and water, as sharp as without a surface; *wide: remaining share of
 * both. */
static vec3 found_in(const facets_light *L, const water_findings_below *found, vec3 *wide)
{
    float share = found->covered > L->fresnel ? L->fresnel / found->covered : 1.0f; /* both are random */
    *wide = max(L->window - found->hidden, 0.0f) + L->mirrored * (L->fresnel - share * found->covered);
    return found->through + found->mirrored * share;
}

vec3 water_shade_from_below(const water_setup *s, const water_place *p, const water_findings_below *found,
                            const double E[3], vec3 d, float x)
{
    vec3 up = upwelling(s, p->P);
    facets_light facets = facets_from_below(s, p, d, up * INV_PI);
    vec3 L = facets.window + facets.mirrored * facets.fresnel;
    vec3 sharp = water_sun_below(s->water, p->point, s->light, d) *
                 water_passing(p->slopes.resolved, p->point.N, s->light.L);
    if (s->model.is_there)
        sharp = sharp * found->sun + found_in(&facets, found, &L);
    if (p->point.foam > 0.0f)
        L = mix(L, water_foam_below(s->water, s->light, up), p->point.foam);
    return water_surface_through(s->water, s->light.downwelling, s->beam, s->sunward, L,
                                 sharp * (1.0f - p->point.foam), depth_of(E), d, x);
}

/* ---- the legacy style, and painted water ---- */

/* The legacy program displayed c^0.95 directly; values here are encoded later. */
static vec3 shown(vec3 c)
{
    return linear_from_srgb(before_display(c));
}

vec3 water_look_sky(vec3 d)
{
    return shown(before_sky(d));
}

vec3 water_look_shade(const water_setup *s, const water_place *p, vec3 d)
{
    const facet_sea_shading *look = &s->desc->sea_shading;
    int variant = look->style == FACET_SEA_STYLE_LEGACY_WRITTEN ? BEFORE_WRITTEN : BEFORE_INTENDED;
    int stage = look->style != FACET_SEA_STYLE_PHYSICAL ? BEFORE_STAGE_NONE
                : look->stage == 1                      ? BEFORE_STAGE_FRESNEL
                                                        : BEFORE_STAGE_COOK_TORRANCE;
    float perceptual_roughness =
        look->perceptual_roughness > 0.0f ? look->perceptual_roughness : BEFORE_ROUGHNESS;
    vec2 slope = slope_from_normal(p->point.N);
    float sparkle = 0.0f;
    if (!look->omits_glints) { /* sparkle noise, about one cell in ten */
        GlintCell cell = glint_cell(vec2((float)p->rest[0], (float)p->rest[1]), vec2(p->footprint_m), 1.0f);
        sparkle = glint_uniform(cell.key) > 0.9f ? 1.0f : 0.0f;
    }
    float foam = look->omits_foam ? 0.0f : before_foam(length(slope));
    return shown(before_shade(variant, stage, d, p->point.N, s->light.L, (float)p->P[1], sparkle, foam,
                              s->water.ior, perceptual_roughness));
}

vec3 water_look_painted(const water_setup *s, const water_place *p)
{
    float given = s->desc->sea_shading.perceptual_roughness;
    float perceptual_roughness = given > 0.0f ? given : BEFORE_ROUGHNESS;
    vec3 sky = water_sky_reflected(&s->sky, painted_mirror(p->point.N, p->V), perceptual_roughness);
    return painted_water(s->light, p->point.N, p->V, s->water.ior, perceptual_roughness, sky);
}
