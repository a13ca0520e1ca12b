/* water_shade.c - see water_shade.h. The look-ups of shade/compose/sea_radiance.h on the CPU, and the functions that
 * it composes from them. */
#include "water/water_shade.h"

#include <math.h>

static const float FACETS_PER_PIXEL = 64.0f;

/* ---- the host of shade/compose/sea_radiance.h ---- */

typedef struct SeaHost {
    const water_setup *s;
    float footprint; /* of a sample, relative to its pixel */
    uint32_t random; /* selects the sampled microfacets */
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

static WaterMeans host_means(SeaHost host, float mu, float sigma)
{
    float means[4];
    water_table_at(&host.s->table, mu, sigma, means);
    return (WaterMeans){.fresnel = means[0], .escape = means[1], .lift = means[2], .spread = means[3]};
}

static vec3 host_sky(SeaHost host, vec3 R, float perceptual_roughness)
{
    return water_sky_reflected(&host.s->sky, R, perceptual_roughness);
}

static bool host_is_below(SeaHost host)
{
    return host.s->is_below;
}

/* ---- style and glints ---- */

static bool host_has_glints(SeaHost host)
{
    const facet_sea_shading *shading = &host.s->desc->sea_shading;
    return !shading->omits_glints && shading->stage != 4;
}

static float host_shutter_s(SeaHost host)
{
    return host.s->shutter_s;
}

static float host_glint_time(SeaHost host)
{
    return waves_glint_time(&host.s->sea->waves);
}

static vec2 host_rest_from_eye(SeaHost host, SeaPlace p)
{
    return vec2((float)(p.rest[0] - (double)host.s->camera.origin[0]),
                (float)(p.rest[1] - (double)host.s->camera.origin[2]));
}

static vec2 host_rest(SeaHost host, SeaPlace p)
{
    (void)host;
    return vec2((float)p.rest[0], (float)p.rest[1]);
}

static WaterStyle host_style(SeaHost host)
{
    return sea_water_style(&host.s->desc->sea_shading);
}

/* ---- positions ---- */

static SeaPosition position_at(const double P[3])
{
    return (SeaPosition){{P[0], P[1], P[2]}};
}

static SeaPosition host_position(SeaPlace p)
{
    return position_at(p.P);
}

static float host_height(SeaPlace p)
{
    return (float)p.P[1];
}

static SeaPosition host_along(SeaPosition P, vec3 d, float x)
{
    for (int i = 0; i < 3; i++)
        P.at[i] += (double)x * (double)d[i];
    return P;
}

static SeaPosition host_sunk(SeaPosition P)
{
    P.at[1] = fmin(P.at[1], 0.0);
    return P;
}

static float host_depth(SeaPosition P)
{
    return (float)fmax(-P.at[1], 0.0);
}

/* ---- the bed ---- */

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

/* ---- a model ---- */

static bool host_has_model(SeaHost host)
{
    return host.s->model.is_there;
}

static vec3 from_point(SeaPlace p, const float corner[3])
{
    return vec3(corner[0], corner[1], corner[2]) - vec3((float)p.P[0], (float)p.P[1], (float)p.P[2]);
}

static vec3 host_model_low(SeaHost host, SeaPlace p)
{
    return from_point(p, host.s->model.bounds_min);
}

static vec3 host_model_high(SeaHost host, SeaPlace p)
{
    return from_point(p, host.s->model.bounds_max);
}

/* The point, offset from the surface so that rays from it do not hit floating parts from the wrong side. */
static SeaPosition start_of(SeaPlace p, float up_m)
{
    SeaPosition P = host_position(p);
    P.at[1] += (double)up_m;
    return P;
}

static float host_sun_visibility(SeaHost host, SeaPlace p)
{
    SeaPosition P = start_of(p, 1e-3f);
    return water_model_visibility(&host.s->model, P.at, host.s->light.L, HUGE_VAL);
}

static FacetHit host_model_hit(SeaHost host, SeaPlace p, vec3 d, bool is_transmitted, bool is_alone)
{
    const water_setup *s = host.s;
    SeaPosition P = start_of(p, s->is_below == is_transmitted ? 1e-3f : -1e-3f);
    model_hit hit;
    (void)is_alone;
    if (!water_model_find(&s->model, P.at, d, HUGE_VAL, host.random, &hit))
        return (FacetHit){.opacity = 0.0f};
    return (FacetHit){.opacity = 1.0f,
                      .radiance = water_model_radiance(&s->model, &hit, s->light.L),
                      .distance = (float)hit.distance_m,
                      .height = hit.P[1],
                      .depth = host_depth(P)};
}

static int host_facet_count(SeaHost host)
{
    return (int)clamp(FACETS_PER_PIXEL * host.footprint * host.footprint, 4.0f, 16.0f);
}

static uint32_t host_random(SeaHost host)
{
    return host.random;
}

#include "shade/compose/sea_radiance.h"

/* ---- parts ---- */

vec3 water_light_over_bed(const water_setup *s, float depth_m)
{
    return sea_light_over_bed((SeaHost){.s = s}, depth_m);
}

vec3 water_bed_lit_at(const water_setup *s, const double P[3], vec3 d, float distance, float width_m)
{
    return sea_bed_lit((SeaHost){.s = s}, position_at(P), d, distance, width_m);
}

vec3 water_from_still(const water_setup *s, float depth_m, vec3 down)
{
    return water_has_bed(s) ? sea_over_bed((SeaHost){.s = s}, depth_m, down, vec3(1.0f), vec3(1.0f))
                            : water_from_deep(s->water, s->light.downwelling);
}

vec3 water_shade_land(const water_setup *s)
{
    const facet_sea_bed *bed = &s->sea->desc.bed;
    return water_land(s->light, water_bed_albedo(bed), water_bed_normal(bed));
}

vec3 water_model_behind_water(const water_setup *s, const model_hit *hit, const double P[3], vec3 d)
{
    return sea_model_behind_water((SeaHost){.s = s}, water_model_radiance(&s->model, hit, s->light.L),
                                  hit->P[1], host_depth(position_at(P)), d, (float)hit->distance_m);
}

float water_distance_below(const water_setup *s, const double P[3], vec3 d)
{
    return host_distance_to_bed((SeaHost){.s = s}, position_at(P), d);
}

vec3 water_seen_through_water(const water_setup *s, const double P[3], vec3 d, float width_m, float spread)
{
    return sea_seen_through_water((SeaHost){.s = s}, position_at(P), d, width_m, spread);
}

/* ---- the surface ---- */

vec3 water_shade(const water_setup *s, const water_place *p, float footprint, uint32_t random)
{
    return sea_shade((SeaHost){s, footprint, random}, *p);
}

vec3 water_shade_from_below(const water_setup *s, const water_place *p, float footprint, uint32_t random,
                            const double E[3], vec3 d, float x)
{
    return sea_shade_below((SeaHost){s, footprint, random}, *p, d, x, host_depth(position_at(E)));
}

vec3 water_shade_painted(const water_setup *s, const water_place *p)
{
    return sea_painted((SeaHost){.s = s}, *p);
}

vec3 water_shade_legacy(const water_setup *s, const water_place *p, vec3 d)
{
    return sea_legacy((SeaHost){.s = s}, *p, d);
}

vec3 water_shade_legacy_sky(vec3 d)
{
    return water_legacy_linear(water_legacy_sky(d));
}
