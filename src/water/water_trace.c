/* water_trace.c - see water_trace.h. */
#include <math.h>
#include <stddef.h>

#include "water/water_trace.h"

#include "water/water_below.h"
#include "water/water_look.h"

static const double FAR_M = 1e7;
static const float FACETS_PER_PIXEL = 64.0f;
static const float LEAST_FACETS = 1e-3f; /* a share of them that is not worth a ray */
static const float SMOOTH = 1e-3f;       /* slopes that turn a reflection by less than a pixel */

water_sample water_sample_begin(const water_setup *s, float x, float y, float footprint, uint32_t random)
{
    float o[3], d[3];
    camera_rays_at(&s->camera, x, y, o, d);
    double length =
        (sqrt)((double)d[0] * (double)d[0] + (double)d[1] * (double)d[1] + (double)d[2] * (double)d[2]);
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
static bool find_below(const water_sample *p, const water_place *place, water_findings *found)
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

/* What a facet shows of the model. What it sends down meets another wave and goes up. */
static void look_into(const water_sample *p, const water_place *place, Facet f, const double P[3],
                      water_findings *found)
{
    const water_setup *s = p->s;
    model_hit hit;
    vec3 R = reflect(-place->V, f.m);
    R[1] = max(abs(R[1]), 1e-4f);
    if (!water_model_find(&s->model, P, R, FAR_M, p->random, &hit))
        return;
    float weight = f.weight * water_fresnel(s->water, clamp(dot(f.m, place->V), 0.0f, 1.0f));
    found->covered += weight;
    found->mirrored = found->mirrored + water_model_radiance(&s->model, &hit, s->light.L) * weight;
}

/* Looks into as many facets of a pixel, whatever its number of samples. */
static void find_mirrored(const water_sample *p, const water_place *place, const double P[3],
                          water_findings *found)
{
    const water_setup *s = p->s;
    const float *low = s->model.prepared.pose.bounds_min, *high = s->model.prepared.pose.bounds_max;
    vec3 from = vec3((float)P[0], (float)P[1], (float)P[2]);
    FacetRange r =
        facets_that_mirror(place->point.covariance, place->point.N, place->V,
                           vec3(low[0], low[1], low[2]) - from, vec3(high[0], high[1], high[2]) - from);
    if (facets_share(r) < LEAST_FACETS)
        return;
    if (max(r.along, r.across) < SMOOTH) {
        look_into(p, place, (Facet){place->point.N, 1.0f}, P, found);
        return;
    }
    float count = clamp(FACETS_PER_PIXEL * s->footprint * s->footprint, 4.0f, 16.0f);
    for (uint i = 0; i < (uint)count; i++) {
        Facet f = facet_drawn(r, place->point.N, sobol_scrambled(i, p->random));
        f.weight *= 1.0f / (float)(uint)count;
        look_into(p, place, f, P, found);
    }
}

static water_findings find_model(const water_sample *p, const water_place *place)
{
    const water_setup *s = p->s;
    water_findings found = {.has_below = false};
    if (!s->model.is_there)
        return found;
    double P[3];
    start_of(place, 1e-3f, P);
    find_mirrored(p, place, P, &found);
    if (s->light.L[1] > 0.0f) {
        found.sun = water_model_opening(&s->model, P, s->light.L, HUGE_VAL);
        found.has_shadow = found.sun < 1.0f;
    }
    find_below(p, place, &found);
    return found;
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
    if (s->desc->look.stage == 3)
        return water_look_painted(s, &place);
    water_findings found = find_model(p, &place);
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
    if (!water_model_find_seen(&s->model, p->x, p->y, p->footprint, far_m, p->random, &hit))
        return water_shade_from_below(s, &p->ray, is_met ? sea : NULL);
    vec3 down = water_transmittance(water_K_d(s->water), max(-hit.P[1], 0.0f));
    vec3 L = water_model_radiance(&s->model, &hit, s->light.L) * down;
    return water_behind_water(s, L, p->ray.origin, p->d, (float)hit.distance_m);
}

/* ---- all ---- */

static vec3 exposed(const water_setup *s, vec3 L)
{
    float most = s->desc->look.clamp;
    L = L * s->exposure;
    return most > 0.0f ? min(L, most) : L;
}

vec3 water_sample_shade(const water_sample *p, bool is_met, const march_hit *sea)
{
    const water_setup *s = p->s;
    if (!water_look_is_before(&s->desc->look))
        return exposed(s, (p->ray.is_below ? from_below : from_above)(p, is_met, sea));
    if (!is_met)
        return water_look_sky(p->d);
    water_place place = place_of(p, sea);
    return water_look_shade(s, &place, p->d);
}
