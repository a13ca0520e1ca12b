/* water_shade.c - see water_shade.h. In order: reflected sky, sun with its glints, light from below;
 * composed, then foam on top. */
#include "water/water_shade.h"

#include <math.h>

/* ---- the host of shade/compose/water_shade.h ---- */

typedef struct SeaHost {
    const water_setup *s;
} SeaHost;

typedef struct SeaPosition {
    double at[3];
} SeaPosition;

typedef water_place SeaPlace;

static Water host_water(SeaHost host)
{
    return host.s->water;
}

static WaterLight host_light(SeaHost host)
{
    return host.s->light;
}

static WaterCrest host_crest(SeaHost host)
{
    return host.s->crest;
}

static vec3 host_sunbeam(SeaHost host)
{
    return host.s->beam;
}

static vec3 host_sunward(SeaHost host)
{
    return host.s->sunward;
}

static SeaPosition position_at(const double P[3])
{
    return (SeaPosition){{P[0], P[1], P[2]}};
}

static SeaPosition host_position(SeaPlace p)
{
    return position_at(p.P);
}

static SeaPosition host_along(SeaPosition P, vec3 d, float x)
{
    for (int i = 0; i < 3; i++)
        P.at[i] += (double)x * (double)d[i];
    return P;
}

static float host_depth(SeaPosition P)
{
    return (float)fmax(-P.at[1], 0.0);
}

static bool host_has_bed(SeaHost host)
{
    return water_has_bed(host.s);
}

static bool host_has_light_on_bed(SeaHost host)
{
    return water_has_light_on_bed(host.s);
}

static vec3 host_bed_albedo(SeaHost host)
{
    return water_bed_albedo(&host.s->sea->desc.bed);
}

static float host_bed_rise(SeaHost host, vec3 d)
{
    return (float)water_bed_rise(&host.s->sea->desc.bed, d);
}

static float host_bed_depth(SeaHost host, SeaPosition P)
{
    return (float)-water_bed_height(&host.s->sea->desc.bed, P.at[0], P.at[2]);
}

static double over_bed(SeaHost host, SeaPosition P)
{
    return P.at[1] - water_bed_height(&host.s->sea->desc.bed, P.at[0], P.at[2]);
}

static float host_over_bed(SeaHost host, SeaPosition P)
{
    return (float)over_bed(host, P);
}

static float host_distance_to_bed(SeaHost host, SeaPosition P, vec3 d)
{
    double closing = water_bed_rise(&host.s->sea->desc.bed, d) - (double)d[1];
    double above = over_bed(host, P);
    if (!water_has_bed(host.s))
        return WATER_FAR_M;
    if (above <= 0.0)
        return 0.0f;
    return closing > 1e-9 ? (float)fmin(above / closing, (double)WATER_FAR_M) : WATER_FAR_M;
}

static vec2 host_bed_visibility(SeaHost host, SeaPosition P)
{
    bed_shadow_texel open = bed_shadow_at(&host.s->shadow, P.at[0], P.at[2]);
    return vec2(open.sun, open.rest);
}

static vec2 host_caustics(SeaHost host, SeaPosition P, float width)
{
    float beyond, factor = caustic_map_within(&host.s->caustics, P.at[0], P.at[2], width, &beyond);
    return vec2(factor, beyond);
}

#include "shade/compose/water_shade.h"

/* ---- the bed ---- */

vec3 water_light_over_bed(const water_setup *s, float depth_m)
{
    return sea_light_over_bed((SeaHost){s}, depth_m);
}

vec3 water_bed_lit_at(const water_setup *s, const double P[3], vec3 d, float way, float width_m)
{
    return sea_bed_lit((SeaHost){s}, position_at(P), d, way, width_m);
}

vec3 water_from_still(const water_setup *s, float depth_m, vec3 down)
{
    return water_has_bed(s) ? sea_over_bed((SeaHost){s}, depth_m, down, vec3(1.0f), vec3(1.0f))
                            : water_from_deep(s->water, s->light.downwelling);
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
    vec3 below = found->has_below ? found->below : sea_from_below((SeaHost){s}, *p);
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
    return host_distance_to_bed((SeaHost){s}, position_at(P), d);
}

vec3 water_seen_through_water(const water_setup *s, const double P[3], vec3 d, float width_m, float spread)
{
    return sea_seen_through_water((SeaHost){s}, position_at(P), d, width_m, spread);
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
