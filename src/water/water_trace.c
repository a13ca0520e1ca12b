/* water_trace.c - see water_trace.h. */
#include "water/water_trace.h"

#include <math.h>
#include <stddef.h>

#include "shade/lang/lang_c_load.h"
#include "water/water_objects.h"
#include "water/water_shade.h"

static const double FAR_M = 1e7;

/* A sample that is being traced. */
typedef struct water_sample {
    const water_setup *s;
    float x, y;      /* pixels */
    float footprint; /* relative to a pixel */
    uint32_t random;
    march_ray ray;
    vec3 d;                   /* direction of ray */
    double length;            /* m along it per metre along the camera's axis */
    const water_place *place; /* the visible point of the sea; NULL: not known yet */
} water_sample;

static water_sample begin_sample(const water_setup *s, float x, float y, float footprint, uint32_t random)
{
    float o[3], d[3];
    camera_rays_at(&s->camera, x, y, o, d);
    double length =
        sqrt((double)d[0] * (double)d[0] + (double)d[1] * (double)d[1] + (double)d[2] * (double)d[2]);
    water_sample p = {.s = s, .x = x, .y = y, .footprint = footprint, .random = random, .length = length};
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

/* ---- what is nearest ---- */

enum { NOTHING = WATER_OBJECTS };

/* The nearest surface along a sample's ray, the model left out. */
typedef struct backdrop {
    uint32_t object;      /* WATER_OBJECT_..; NOTHING: sky, or water without end */
    double distance_m;    /* to the object */
    double model_range_m; /* within which the model hides it; 0: there is no model */
} backdrop;

/* Within which the model hides the water at t, or, if there is none, the sky: any distance where a hull displaces it. */
static double model_range(const water_sample *p, bool is_met, const march_hit *sea, double t)
{
    const double P[3] = {sea->X, p->ray.origin[1] + t * p->ray.direction[1], sea->Z};
    return is_met && p->s->model.is_there && water_model_is_dry(&p->s->model, P) ? FAR_M : t;
}

static backdrop backdrop_above(const water_sample *p, bool is_met, const march_hit *sea)
{
    double t = is_met ? sea->t : p->ray.far_m, land = land_before(p->s, &p->ray, p->d, t);
    double range = model_range(p, is_met, sea, t);
    if (land < HUGE_VAL)
        return (backdrop){WATER_OBJECT_BED, land, range == FAR_M ? range : land};
    return (backdrop){is_met ? WATER_OBJECT_WATER : NOTHING, t, range};
}

/* Water or sky. */
static backdrop backdrop_of_legacy(const water_sample *p, bool is_met, const march_hit *sea)
{
    double t = is_met ? sea->t : p->ray.far_m;
    return (backdrop){is_met ? WATER_OBJECT_WATER : NOTHING, t, model_range(p, is_met, sea, t)};
}

static backdrop backdrop_below(const water_sample *p, bool is_met, const march_hit *sea)
{
    double bed = (double)water_distance_below(p->s, p->ray.origin, p->d), range = is_met ? sea->t : FAR_M;
    if (is_met && sea->t < bed)
        return (backdrop){WATER_OBJECT_WATER, sea->t, range};
    return (backdrop){bed < (double)WATER_FAR_M ? WATER_OBJECT_BED : NOTHING, bed, range};
}

/* sea: the hit on the water, if is_met. */
static backdrop backdrop_of(const water_sample *p, bool is_met, const march_hit *sea)
{
    if (sea_shading_is_legacy(&p->s->desc->sea_shading))
        return backdrop_of_legacy(p, is_met, sea);
    return p->ray.is_below ? backdrop_below(p, is_met, sea) : backdrop_above(p, is_met, sea);
}

/* ---- above ---- */

static vec3 through_air(const water_sample *p, vec3 L, double t, double height)
{
    water_air air = water_sky_air(&p->s->sky, p->d, (float)t, (float)height);
    return L * air.transmittance + air.light;
}

static water_place place_of(const water_sample *p, const march_hit *hit)
{
    return p->place ? *p->place : water_place_of(p->s, &p->ray, hit, p->footprint);
}

static vec3 shade_sea(const water_sample *p, const march_hit *hit)
{
    const water_setup *s = p->s;
    water_place place = place_of(p, hit);
    place.pixel_m = place.footprint_m / p->footprint;
    if (s->desc->sea_shading.stage == 3)
        return water_shade_painted(s, &place);
    return water_shade(s, &place, p->footprint, p->random);
}

/* model: the hit on the model where it is nearest, else NULL. */
static vec3 from_above(const water_sample *p, const backdrop *b, const march_hit *sea, const model_hit *model)
{
    const water_setup *s = p->s;
    if (model)
        return through_air(p, water_model_radiance(&s->model, model, s->light.L), model->distance_m,
                           (double)model->P[1]);
    if (b->object == WATER_OBJECT_BED)
        return through_air(p, water_shade_land(s), b->distance_m,
                           p->ray.origin[1] + b->distance_m * p->ray.direction[1]);
    return b->object == WATER_OBJECT_WATER ? through_air(p, shade_sea(p, sea), sea->t, 0.0)
                                           : water_sky_seen(&s->sky, p->d);
}

/* ---- below ---- */

static vec3 from_below(const water_sample *p, const backdrop *b, const march_hit *sea, const model_hit *model)
{
    const water_setup *s = p->s;
    if (model)
        return water_model_behind_water(s, model, p->ray.origin, p->d);
    if (b->object != WATER_OBJECT_WATER)
        return water_seen_through_water(s, p->ray.origin, p->d, (float)p->ray.width, (float)p->ray.spread);
    water_place place = place_of(p, sea);
    return water_shade_from_below(s, &place, p->footprint, p->random, p->ray.origin, p->d, (float)sea->t);
}

/* ---- all ---- */

static vec3 exposed(const water_setup *s, vec3 L)
{
    float most = s->desc->sea_shading.clamp;
    L = L * s->exposure;
    return most > 0.0f ? min(L, most) : L;
}

static vec3 shade_nearest(const water_sample *p, const backdrop *b, const march_hit *sea,
                          const model_hit *model)
{
    const water_setup *s = p->s;
    if (!sea_shading_is_legacy(&s->desc->sea_shading))
        return exposed(s, (p->ray.is_below ? from_below : from_above)(p, b, sea, model));
    if (model) /* by its own light, in front of colors */
        return exposed(s, water_model_radiance(&s->model, model, s->light.L));
    if (b->object == NOTHING)
        return water_shade_legacy_sky(p->d);
    water_place place = place_of(p, sea);
    return water_shade_legacy(s, &place, p->d);
}

/* Radiance (cd/m^2) times the exposure, or the legacy style's value; *seen: the identity of what is seen, if
 * some layer needs it, else NULL. */
static vec3 shade_sample(const water_sample *p, bool is_met, const march_hit *sea,
                         const scene_identity **seen)
{
    const water_setup *s = p->s;
    backdrop b = backdrop_of(p, is_met, sea);
    model_hit hit;
    bool is_model = b.model_range_m > 0.0 && water_model_find_seen(&s->model, p->x, p->y, p->footprint,
                                                                   b.model_range_m, p->random, &hit);
    *seen = NULL;
    if (s->identities && is_model)
        *seen = water_model_identity(&s->model, hit.hit.geometry);
    else if (s->identities && b.object != NOTHING)
        *seen = &s->identities[b.object];
    return shade_nearest(p, &b, sea, is_model ? &hit : NULL);
}

/* ---- samples of a pixel ---- */

static void add_matte(const water_pixel *p, const scene_identity *seen, uint32_t samples)
{
    if (p->mattes && seen)
        matte_add(p->mattes, p->number, seen->hashes, (float)samples);
}

static vec3 trace(const water_setup *s, const water_pixel *pixel, uint32_t i)
{
    uint32_t random = hash_uint(hash_uint(pixel->y * 65536u + pixel->x) + i);
    const float *at = pixel->pattern + 2 * (size_t)i;
    water_sample p = begin_sample(s, (float)pixel->x + at[0], (float)pixel->y + at[1], s->footprint, random);
    march_hit sea = {.t = 0.0};
    const scene_identity *seen;
    bool is_met = water_profile_find(&s->profile, &p.ray, &sea);
    vec3 L = shade_sample(&p, is_met, &sea, &seen);
    add_matte(pixel, seen, 1);
    return L;
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
    const water_pixel *pixel;
    uint32_t group_count;
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
    water_sample one = begin_sample(s, g->x / n, g->y / n, sqrt(n / (float)p->pixel->count), 0);
    march_hit sea = {.t = 0.0};
    water_place place;
    if (g->is_met) {
        place = water_place_of_samples(s, &one.ray, g->sights, g->count, &sea);
        one.place = &place;
    }
    const scene_identity *seen;
    vec3 L = shade_sample(&one, g->is_met, &sea, &seen);
    add_matte(p->pixel, seen, g->count);
    return L;
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

static vec3 trace_grouped(const water_setup *s, const water_pixel *pixel)
{
    grouping p;
    p.s = s;
    p.pixel = pixel;
    p.group_count = 0;
    profile_nearby nearby = {.row = 0};
    vec3 sum = vec3(0.0f);
    for (uint32_t i = 0; i < pixel->count; i++) {
        float x = (float)pixel->x + pixel->pattern[2 * i], y = (float)pixel->y + pixel->pattern[2 * i + 1];
        water_sample one = begin_sample(s, x, y, s->footprint, 0);
        water_sight *sight = &p.sights[i];
        sight->place = (profile_place){.closing = 1.0};
        for (int k = 0; k < 3; k++)
            sight->direction[k] = one.ray.direction[k];
        bool is_met = water_profile_look(&s->profile, &one.ray, &nearby, &sight->place);
        if (!is_met && is_near_sun(s, one.d)) {
            const march_hit none = {.t = 0.0};
            const scene_identity *sky;
            sum = sum + shade_sample(&one, false, &none, &sky);
        } else {
            add(&p, x, y, is_met, sight);
        }
    }
    for (uint32_t k = 0; k < p.group_count; k++)
        sum = sum + shade_group(&p, &p.groups[k]) * (float)p.groups[k].count;
    return sum * (1.0f / (float)pixel->count);
}

vec3 water_pixel_trace(const water_setup *s, const water_pixel *p)
{
    vec3 L = vec3(0.0f);
    if (can_group(s, p->count)) {
        L = trace_grouped(s, p);
    } else {
        for (uint32_t i = 0; i < p->count; i++)
            L = L + trace(s, p, i);
        L = L * (1.0f / (float)p->count);
    }
    if (p->mattes)
        matte_finish(p->mattes, p->number, 1.0f / (float)p->count);
    return L;
}

/* ---- the surface at a pixel's center ---- */

static void describe(vec3 N, vec3 color, shading_description *out)
{
    *out = (shading_description){.occlusion = 1.0f};
    store3(N, out->normal);
    store3(color, out->base_color);
}

static void describe_water(const water_sample *p, const march_hit *sea, shading_description *out)
{
    const water_setup *s = p->s;
    water_place place = water_place_of(s, &p->ray, sea, p->footprint);
    float side = p->ray.is_below ? -1.0f : 1.0f;
    vec3 N = water_faced(place.point.N, place.V * side);
    float albedo = water_albedo(s->water, dot(N, place.V * side), place.point.foam, p->ray.is_below);
    describe(N * side, vec3(albedo), out);
}

bool water_pixel_describe(const water_setup *s, uint32_t x, uint32_t y, water_description *out)
{
    water_sample p = begin_sample(s, (float)x + 0.5f, (float)y + 0.5f, 1.0f, 0);
    march_hit sea = {.t = 0.0};
    bool is_met = water_profile_find(&s->profile, &p.ray, &sea);
    backdrop b = backdrop_of(&p, is_met, &sea);
    uint32_t geometry;
    if (b.model_range_m > 0.0 &&
        water_model_describe(&s->model, p.x, p.y, b.model_range_m, &out->surface, &out->depth_m, &geometry)) {
        out->identity = s->identities ? water_model_identity(&s->model, geometry) : NULL;
        return true;
    }
    if (b.object == NOTHING)
        return false;
    out->depth_m = (float)(b.distance_m / p.length);
    out->identity = s->identities ? &s->identities[b.object] : NULL;
    vec3 bed = water_bed_normal(&s->sea->desc.bed);
    if (b.object == WATER_OBJECT_WATER)
        describe_water(&p, &sea, &out->surface);
    else
        describe(dot(bed, p.d) > 0.0f ? -bed : bed, water_bed_albedo(&s->sea->desc.bed), &out->surface);
    return true;
}
