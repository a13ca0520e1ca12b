/* water_trace.c - see water_trace.h. */
#include <math.h>
#include <stddef.h>

#include "water/water_trace.h"

#include "water/water_below.h"
#include "water/water_find.h"
#include "water/water_look.h"

static const double FAR_M = 1e7;

water_sample water_sample_begin(const water_setup *s, float x, float y, float footprint, uint32_t random)
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

vec3 water_sample_shade(const water_sample *p, bool is_met, const march_hit *sea)
{
    const water_setup *s = p->s;
    if (!sea_shading_is_legacy(&s->desc->sea_shading))
        return exposed(s, (p->ray.is_below ? from_below : from_above)(p, is_met, sea));
    if (!is_met)
        return water_look_sky(p->d);
    water_place place = place_of(p, sea);
    return water_look_shade(s, &place, p->d);
}
