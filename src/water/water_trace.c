/* water_trace.c - see water_trace.h. */
#include "water/water_trace.h"

#include <math.h>
#include <stddef.h>

#include "water/water_shade.h"
#include "water/water_find.h"

static const double FAR_M = 1e7;

/* A sample that is being traced. */
typedef struct water_sample {
    const water_setup *s;
    float x, y;      /* pixels */
    float footprint; /* relative to a pixel */
    uint32_t random;
    march_ray ray;
    vec3 d;                   /* direction of ray */
    const water_place *place; /* the visible point of the sea; NULL: not known yet */
} water_sample;

static water_sample begin_sample(const water_setup *s, float x, float y, float footprint, uint32_t random)
{
    float o[3], d[3];
    camera_rays_at(&s->camera, x, y, o, d);
    double length =
        sqrt((double)d[0] * (double)d[0] + (double)d[1] * (double)d[1] + (double)d[2] * (double)d[2]);
    water_sample p = {.s = s, .x = x, .y = y, .footprint = footprint, .random = random};
    p.ray.near_m = (double)s->camera.near_m * length;
    p.ray.far_m = fmin((double)s->camera.far_m * length, FAR_M);
    p.ray.is_below = s->is_below;
    for (int i = 0; i < 3; i++) {
        p.ray.origin[i] = (double)o[i];
        p.ray.direction[i] = (double)d[i] / length;
        p.d[i] = (float)p.ray.direction[i];
    }
    if (s->camera.is_orthographic)
        p.ray.width = s->camera.pixel_size * footprint;
    else
        p.ray.spread = s->camera.pixel_size * footprint / (float)length;
    return p;
}

/* Distance at which a ray from above hits ground that the water leaves dry; HUGE_VAL: not before t. */
static double land_before(const water_setup *s, const march_ray *ray, vec3 d, double t)
{
    const facet_sea_bed *bed = &s->sea->desc.bed;
    if (!water_has_bed(s) || bed->slope <= 0.0f)
        return HUGE_VAL;
    double closing = water_bed_rise(bed, d) - ray->direction[1];
    double above = ray->origin[1] - water_bed_height(bed, ray->origin[0], ray->origin[2]);
    double land = closing > 0.0 ? above / closing : HUGE_VAL;
    return land > ray->near_m && land < t ? land : HUGE_VAL;
}

/* ---- above ---- */

static vec3 through_air(const water_sample *p, vec3 L, double t, double height)
{
    water_air air = water_sky_air(&p->s->sky, p->d, (float)t, (float)height);
    return L * air.transmittance + air.light;
}

static water_place place_of(const water_sample *p, const march_hit *hit)
{
    return p->place ? *p->place : water_place_of(p->s, &p->ray, hit);
}

static vec3 shade_sea(const water_sample *p, const march_hit *hit)
{
    const water_setup *s = p->s;
    water_place place = place_of(p, hit);
    place.pixel_m = place.footprint_m / p->footprint;
    if (s->desc->sea_shading.stage == 3)
        return water_look_painted(s, &place);
    water_findings found = water_find(s, &place, p->footprint, p->random);
    return water_shade(s, &place, &found);
}

static vec3 from_above(const water_sample *p, bool is_met, const march_hit *sea)
{
    const water_setup *s = p->s;
    double t = is_met ? sea->t : p->ray.far_m, land = land_before(s, &p->ray, p->d, t);
    model_hit hit;
    bool is_dry =
        is_met && s->model.is_there &&
        water_model_is_dry(&s->model,
                           (const double[3]){sea->X, p->ray.origin[1] + t * p->ray.direction[1], sea->Z});
    double far_m = is_dry ? FAR_M : fmin(land, t);
    if (water_model_find_seen(&s->model, p->x, p->y, p->footprint, far_m, p->random, &hit))
        return through_air(p, water_model_radiance(&s->model, &hit, s->light.L), hit.distance_m,
                           (double)hit.P[1]);
    if (land < HUGE_VAL)
        return through_air(p, water_shade_land(s), land, p->ray.origin[1] + land * p->ray.direction[1]);
    if (is_met)
        return through_air(p, shade_sea(p, sea), sea->t, 0.0);
    return water_sky_seen(&s->sky, p->d);
}

/* ---- below ---- */

static vec3 from_below(const water_sample *p, bool is_met, const march_hit *sea)
{
    const water_setup *s = p->s;
    model_hit hit;
    double far_m = is_met ? sea->t : FAR_M;
    if (water_model_find_seen(&s->model, p->x, p->y, p->footprint, far_m, p->random, &hit))
        return water_model_behind_water(s, &hit, p->ray.origin, p->d);
    if (!is_met || sea->t >= (double)water_way_to_bed_below(s, p->ray.origin, p->d))
        return water_seen_through_water(s, p->ray.origin, p->d, (float)p->ray.width, (float)p->ray.spread);
    water_place place = water_place_of(s, &p->ray, sea);
    water_findings_below found = water_find_below(s, &place, p->d, p->footprint, p->random);
    return water_shade_from_below(s, &place, &found, p->ray.origin, p->d, (float)sea->t);
}

/* ---- all ---- */

static vec3 exposed(const water_setup *s, vec3 L)
{
    float most = s->desc->sea_shading.clamp;
    L = L * s->exposure;
    return most > 0.0f ? min(L, most) : L;
}

/* Radiance (cd/m^2) times the exposure, or the legacy style's value; sea: the hit on the water, if any. */
static vec3 shade_sample(const water_sample *p, bool is_met, const march_hit *sea)
{
    const water_setup *s = p->s;
    if (!sea_shading_is_legacy(&s->desc->sea_shading))
        return exposed(s, (p->ray.is_below ? from_below : from_above)(p, is_met, sea));
    if (!is_met)
        return water_look_sky(p->d);
    water_place place = place_of(p, sea);
    return water_look_shade(s, &place, p->d);
}

/* ---- a pixel ---- */

static vec3 trace(const water_setup *s, float x, float y, float footprint, uint32_t random)
{
    water_sample p = begin_sample(s, x, y, footprint, random);
    march_hit sea;
    bool is_met = water_profile_find(&s->profile, &p.ray, &sea);
    return shade_sample(&p, is_met, &sea);
}

/* ---- groups of samples ---- */

enum { MAX_GROUPED = 16 };

/* Samples of a pixel that hit one patch of water, or nothing. */
typedef struct group {
    bool is_met;
    float x, y;        /* sums over the samples */
    double distance_m; /* sum */
    double closing;    /* of the first sample */
    uint32_t count;
    const water_sight *sights[MAX_GROUPED];
} group;

/* Groups of a pixel. */
typedef struct grouping {
    const water_setup *s;
    uint32_t sample_count, group_count;
    water_sight sights[MAX_GROUPED];
    group groups[MAX_GROUPED];
} grouping;

/* Whether t lies within the patch of water that a pixel covers around a group. */
static bool is_one_piece(const group *g, const profile_place *place, float pixel_size)
{
    double t = g->distance_m / g->count, closing = fmin(g->closing, place->closing);
    return fabs(place->t - t) < t * (double)pixel_size * (1.5 + 1.5 / fmax(closing, 0.03));
}

static bool joins(const water_setup *s, const group *g, bool is_met, const profile_place *place)
{
    if (g->is_met != is_met)
        return false;
    return !is_met || is_one_piece(g, place, s->camera.pixel_size);
}

static void add(grouping *p, float x, float y, bool is_met, const water_sight *sight)
{
    uint32_t k = 0;
    while (k < p->group_count && !joins(p->s, &p->groups[k], is_met, &sight->place))
        k++;
    group *g = &p->groups[k];
    if (k == p->group_count) {
        g->is_met = is_met;
        g->x = g->y = 0.0f;
        g->distance_m = 0.0;
        g->closing = sight->place.closing;
        g->count = 0;
        p->group_count++;
    }
    g->sights[g->count++] = sight;
    g->x += x;
    g->y += y;
    g->distance_m += sight->place.t;
}

static vec3 shade_group(const grouping *p, const group *g)
{
    const water_setup *s = p->s;
    float n = (float)g->count;
    water_sample one = begin_sample(s, g->x / n, g->y / n, sqrt(n / (float)p->sample_count), 0);
    march_hit sea = {.t = 0.0};
    water_place place;
    if (g->is_met) {
        place = water_place_of_samples(s, &one.ray, g->sights, g->count, &sea);
        one.place = &place;
    }
    return shade_sample(&one, g->is_met, &sea);
}

/* The disc has an edge that a sample may hit. */
static bool is_near_sun(const water_setup *s, vec3 d)
{
    vec3 off = d - s->sky.L;
    float reach = s->sky.disc_radius + 2.0f * s->camera.pixel_size;
    return s->sky.disc_radius > 0.0f && dot(off, off) < reach * reach;
}

static bool can_group(const water_setup *s, uint32_t count)
{
    bool has_land = water_has_bed(s) && s->sea->desc.bed.slope > 0.0f;
    return count > 1 && count <= MAX_GROUPED && s->desc->quality != FACET_QUALITY_FINAL && !s->is_below &&
           !s->model.is_there && !has_land && !s->camera.is_orthographic;
}

static vec3 trace_grouped(const water_setup *s, float x, float y, const float *pattern, uint32_t count)
{
    grouping p;
    p.s = s;
    p.sample_count = count;
    p.group_count = 0;
    profile_nearby nearby = {.row = 0};
    vec3 sum = vec3(0.0f);
    for (uint32_t i = 0; i < count; i++) {
        float px = x + pattern[2 * i], py = y + pattern[2 * i + 1];
        water_sample one = begin_sample(s, px, py, s->footprint, 0);
        water_sight *sight = &p.sights[i];
        sight->place = (profile_place){.closing = 1.0};
        for (int k = 0; k < 3; k++)
            sight->direction[k] = one.ray.direction[k];
        bool is_met = water_profile_look(&s->profile, &one.ray, &nearby, &sight->place);
        if (!is_met && is_near_sun(s, one.d))
            sum = sum + shade_sample(&one, false, NULL);
        else
            add(&p, px, py, is_met, sight);
    }
    for (uint32_t k = 0; k < p.group_count; k++)
        sum = sum + shade_group(&p, &p.groups[k]) * (float)p.groups[k].count;
    return sum * (1.0f / (float)count);
}

vec3 water_pixel_trace(const water_setup *s, uint32_t x, uint32_t y, const float *pattern, uint32_t count)
{
    if (can_group(s, count))
        return trace_grouped(s, (float)x, (float)y, pattern, count);
    vec3 sum = vec3(0.0f);
    for (uint32_t i = 0; i < count; i++) {
        uint32_t random = hash_uint(hash_uint(y * 65536u + x) + i);
        sum = sum + trace(s, (float)x + pattern[2 * i], (float)y + pattern[2 * i + 1], s->footprint, random);
    }
    return sum * (1.0f / (float)count);
}
