/* water_trace.c - see water_trace.h. */
#include <math.h>
#include <stddef.h>

#include "water/water_trace.h"

#include "water/water_below.h"
#include "water/water_look.h"

static const double FAR_M = 1e7;
enum { MOST_GROUPED = 16 };

/* A sample on its way. */
typedef struct sample {
    const water_setup *s;
    float x, y;
    float footprint; /* over that of a pixel */
    uint32_t random;
    march_ray ray;
    vec3 d;
} sample;

static sample begin(const water_setup *s, float x, float y, float footprint, uint32_t random)
{
    float o[3], d[3];
    camera_rays_at(&s->camera, x, y, o, d);
    double length =
        (sqrt)((double)d[0] * (double)d[0] + (double)d[1] * (double)d[1] + (double)d[2] * (double)d[2]);
    sample p = {.s = s, .x = x, .y = y, .footprint = footprint, .random = random};
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

/* Where a ray from above meets ground that the water leaves dry; HUGE_VAL: nowhere before t. */
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

/* ---- a model in and over the water ---- */

/* A place of the surface, off it so that rays that leave it do not meet what floats there from the wrong side. */
static void start_of(const water_place *p, float up_m, double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = p->P[i];
    out[1] += (double)up_m;
}

/* The model below the surface, seen along the refracted ray: lit by what of the light comes down to it, and weakened on its way. */
static bool find_below(const sample *p, const water_place *place, water_findings *found)
{
    const water_setup *s = p->s;
    Water w = s->water;
    vec3 down = water_refracted(w, -place->V, place->point.N);
    double P[3];
    model_hit hit;
    start_of(place, -1e-3f, P);
    if (!water_model_find(&s->model, P, down, FAR_M, p->random, &hit))
        return false;
    float way = (float)hit.distance_m, depth = max((float)place->P[1] - hit.P[1], 0.0f);
    vec3 lit = water_model_radiance(&s->model, &hit, s->light.L) * water_transmittance(water_K_d(w), depth);
    vec3 gone = water_transmittance(water_K_d(w), depth) * water_transmittance(water_diffuse(w), way);
    found->below = lit * water_transmittance(water_beam(w), way) +
                   water_from_deep(w, s->light.downwelling) * (1.0f - gone);
    found->has_below = true;
    return true;
}

static water_findings find_model(const sample *p, const water_place *place)
{
    const water_setup *s = p->s;
    water_findings found = {.has_mirrored = false};
    if (!s->model.is_there)
        return found;
    double P[3];
    model_hit hit;
    vec3 R = reflect(-place->V, place->point.N);
    start_of(place, 1e-3f, P);
    if (R[1] > 0.0f && water_model_find(&s->model, P, R, FAR_M, p->random, &hit)) {
        found.has_mirrored = true;
        found.mirrored = water_model_radiance(&s->model, &hit, s->light.L);
    }
    if (s->light.L[1] > 0.0f) {
        found.sun = water_model_opening(&s->model, P, s->light.L);
        found.has_shadow = found.sun < 1.0f;
    }
    find_below(p, place, &found);
    return found;
}

/* ---- above ---- */

static vec3 through_air(const sample *p, vec3 L, double t, double height)
{
    water_air air = water_sky_air(&p->s->sky, p->d, (float)t, (float)height);
    return L * air.transmittance + air.light;
}

static vec3 shade_sea(const sample *p, const march_hit *hit)
{
    const water_setup *s = p->s;
    water_place place = water_place_of(s, &p->ray, hit);
    if (s->desc->look.stage == 3)
        return water_look_painted(s, &place);
    water_findings found = find_model(p, &place);
    return water_shade(s, &place, &found);
}

static vec3 from_above(const sample *p, bool is_met, const march_hit *sea)
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

static vec3 from_below(const sample *p, bool is_met, const march_hit *sea)
{
    const water_setup *s = p->s;
    model_hit hit;
    double far_m = is_met ? sea->t : FAR_M;
    if (!water_model_find_seen(&s->model, p->x, p->y, p->footprint, far_m, p->random, &hit))
        return water_shade_from_below(s, &p->ray, is_met ? sea : NULL);
    vec3 down = water_transmittance(water_K_d(s->water), max(-hit.P[1], 0.0f));
    vec3 L = water_model_radiance(&s->model, &hit, s->light.L) * down;
    return water_behind_water(s, L, p->ray.origin, p->d, (float)hit.distance_m);
}

/* ---- pixels ---- */

static vec3 exposed(const water_setup *s, vec3 L)
{
    float most = s->desc->look.clamp;
    L = L * s->exposure;
    return most > 0.0f ? min(L, most) : L;
}

static vec3 shade(const sample *p, bool is_met, const march_hit *sea)
{
    const water_setup *s = p->s;
    if (!water_look_is_before(&s->desc->look))
        return exposed(s, (p->ray.is_below ? from_below : from_above)(p, is_met, sea));
    if (!is_met)
        return water_look_sky(p->d);
    water_place place = water_place_of(s, &p->ray, sea);
    return water_look_shade(s, &place, p->d);
}

static vec3 trace(const water_setup *s, float x, float y, float footprint, uint32_t random)
{
    sample p = begin(s, x, y, footprint, random);
    march_hit sea;
    bool is_met = water_profile_find(&s->profile, &p.ray, &sea);
    return shade(&p, is_met, &sea);
}

/* Samples of a pixel that meet one piece of water, or nothing. */
typedef struct group {
    bool is_met;
    float x, y;          /* sums over the samples */
    profile_place place; /* of the first; t: sum */
    uint32_t count;
} group;

/* Whether t is in the piece of water that a pixel shows at the place of a group: within what it covers of a slope. */
static bool is_one_piece(const group *g, const profile_place *place, float pixel)
{
    double t = g->place.t / g->count, closing = fmin(g->place.closing, place->closing);
    return fabs(place->t - t) < t * (double)pixel * (1.5 + 1.5 / fmax(closing, 0.03));
}

static bool joins(const water_setup *s, const group *g, bool is_met, const profile_place *place)
{
    if (g->is_met != is_met)
        return false;
    return !is_met || is_one_piece(g, place, s->camera.pixel_size);
}

static vec3 shade_group(const water_setup *s, const group *g, uint32_t count)
{
    float n = (float)g->count;
    sample p = begin(s, g->x / n, g->y / n, sqrt(n / (float)count), 0);
    march_hit sea = {.t = 0.0};
    if (g->is_met) {
        profile_place place = g->place;
        place.t /= g->count;
        sea = water_profile_correct(&s->profile, &p.ray, &place);
    }
    return shade(&p, g->is_met, &sea);
}

/* A disc has an edge that a sample may show. */
static bool is_near_sun(const water_setup *s, vec3 d)
{
    vec3 off = d - s->sky.L;
    float reach = s->sky.disc_radius + 2.0f * s->camera.pixel_size;
    return s->sky.disc_radius > 0.0f && dot(off, off) < reach * reach;
}

static bool can_group(const water_setup *s, uint32_t count)
{
    bool has_land = water_has_bed(s) && s->sea->desc.bed.slope > 0.0f;
    return count > 1 && count <= MOST_GROUPED && s->desc->render.quality != FACET_QUALITY_FINAL &&
           !s->is_below && !s->model.is_there && !has_land && !s->camera.is_orthographic;
}

static vec3 trace_grouped(const water_setup *s, float x, float y, const float *pattern, uint32_t count)
{
    group groups[MOST_GROUPED];
    uint32_t group_count = 0;
    vec3 sum = vec3(0.0f);
    for (uint32_t i = 0; i < count; i++) {
        float px = x + pattern[2 * i], py = y + pattern[2 * i + 1];
        sample p = begin(s, px, py, s->footprint, 0);
        profile_place place = {.t = 0.0, .closing = 1.0};
        bool is_met = water_profile_look(&s->profile, &p.ray, &place);
        if (!is_met && is_near_sun(s, p.d)) {
            sum = sum + shade(&p, false, NULL);
            continue;
        }
        uint32_t k = 0;
        while (k < group_count && !joins(s, &groups[k], is_met, &place))
            k++;
        if (k == group_count)
            groups[group_count++] = (group){.is_met = is_met, .place = {.closing = place.closing}};
        group *g = &groups[k];
        g->x += px;
        g->y += py;
        g->place.t += place.t;
        g->place.slack_m = fmax(g->place.slack_m, place.slack_m);
        g->count++;
    }
    for (uint32_t k = 0; k < group_count; k++)
        sum = sum + shade_group(s, &groups[k], count) * (float)groups[k].count;
    return sum * (1.0f / (float)count);
}

vec3 water_trace_pixel(const water_setup *s, uint32_t x, uint32_t y, const float *pattern, uint32_t count)
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
