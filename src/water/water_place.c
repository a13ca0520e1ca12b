/* water_place.c - see water_place.h. In order: footprint, unresolved slopes, waves at the samples, their
 * normal, foam. */
#include "water/water_place.h"

#include <math.h>

#include "ocean/waves_reading.h"

float water_march_footprint(const water_march *m, float width_m, double rise)
{
    return water_footprint(width_m, (float)rise, m->deviation_m);
}

float water_foam_at(const water_setup *s, const double rest[2], float footprint_m)
{
    foam_seen foam = waves_foam_at(&s->foam, rest[0], rest[1], footprint_m);
    return water_foam_cover(foam.share, foam.amount);
}

/* ---- slopes that samples see ---- */

/* Sums over samples, weighted by water area rather than by image area: a slope that is turned away from
 * the eye has more water per pixel than one that faces it, by N.y V.y / (V.N). */
typedef struct sums {
    float weight;
    vec2 slope;
    vec3 square; /* products of slopes: xx, zz, xz */
    float height_m;
} sums;

static vec3 normal_of(const wave_point *at)
{
    wave_shape shape = wave_shape_of(at);
    return vec3(shape.normal[0], shape.normal[1], shape.normal[2]);
}

static void add(sums *sum, const wave_point *at, vec3 facing)
{
    const float most = 4.0f; /* the visible part of a crest is not all of its water */
    vec3 N = water_faced(normal_of(at), facing);
    float weight = clamp(N[1] * abs(facing[1]) / max(dot(N, facing), 1e-6f), 1e-3f, most);
    vec2 slope = slope_from_normal(N);
    sum->weight += weight;
    sum->slope = sum->slope + slope * weight;
    sum->square = sum->square + vec3(slope[0] * slope[0], slope[1] * slope[1], slope[0] * slope[1]) * weight;
    sum->height_m += at->height_m * weight;
}

static sums mean_of(sums sum)
{
    float share = 1.0f / sum.weight;
    return (sums){.weight = 1.0f,
                  .slope = sum.slope * share,
                  .square = sum.square * share,
                  .height_m = sum.height_m * share};
}

/* Their variance adds to the roughness of the whole place, beside that of waves that no sample resolves (LEAN
 * mapping, Olano and Baker 2010; Dupuy et al. 2013). */
static void spread(water_slopes *slopes, const sums *mean)
{
    vec2 m = mean->slope;
    vec3 C = mean->square - vec3(m[0] * m[0], m[1] * m[1], m[0] * m[1]);
    slopes->covariance = slopes->covariance + vec3(max(C[0], 0.0f), max(C[1], 0.0f), C[2]);
}

/* ---- a place ---- */

/* View vector and width; returns the footprint of each of `count` samples. They are 1 / count of the place
 * apart along either axis and 1 / sqrt(count) as wide across the ray: a value in between. */
static float begin(const water_setup *s, const march_ray *ray, double t, float width_m, uint32_t count,
                   water_place *p)
{
    const double *d = ray->direction;
    double rise = march_rise(&s->march, ray, t);
    float n = (float)count, width = count > 1 ? width_m * inversesqrt(n * sqrt(n)) : width_m;
    float seen = water_march_footprint(&s->march, width, rise);
    p->V = normalize(vec3((float)-d[0], (float)-rise, (float)-d[2]));
    p->footprint_m = p->pixel_m = width_m;
    p->cosine = water_seen_cosine(p->V * (ray->is_below ? -1.0f : 1.0f), water_slopes_at(s, seen).resolved);
    return max(seen, width * inversesqrt(p->cosine));
}

/* Position of the ray at a hit, and rest position of the water there. */
static void locate(const water_setup *s, const march_ray *ray, const march_hit *hit, water_place *p)
{
    p->P[0] = hit->X;
    p->P[1] = march_height(&s->march, ray, hit->t);
    p->P[2] = hit->Z;
    for (int i = 0; i < 2; i++)
        p->rest[i] = p->P[2 * i] - (double)hit->displacement[i];
}

static void finish(const water_setup *s, vec3 N, float height_m, float footprint_m, water_place *p)
{
    p->height_m = height_m;
    p->point.N = N;
    p->point.covariance = p->slopes.covariance;
    p->point.foam = water_foam_at(s, p->rest, footprint_m);
}

/* A profile resolves waves of a pixel and more: finer slopes are those of nearby water. */
static vec3 faced(const water_setup *s, const water_place *p, vec3 N, float footprint_m)
{
    if (s->profile.tangents && p->pixel_m > footprint_m)
        N = water_tilted(N, water_slopes_at(s, p->pixel_m).covariance - p->slopes.covariance, p->V);
    return water_faced(N, p->V);
}

water_place water_place_of(const water_setup *s, const march_ray *ray, const march_hit *hit, float footprint)
{
    water_place p;
    float read_m = begin(s, ray, hit->t, hit->width_m, 1, &p);
    p.pixel_m = p.footprint_m / footprint;
    p.slopes = water_slopes_at(s, read_m);
    locate(s, ray, hit, &p);
    wave_point at = waves_at(&s->sea->waves, p.rest[0], p.rest[1], read_m);
    vec3 N = normal_of(&at);
    finish(s, ray->is_below ? N : faced(s, &p, N, read_m), at.height_m, read_m, &p);
    return p;
}

/* ---- of samples ---- */

/* Origin of the lookups: mean of the estimated hits. */
static march_hit middle_of(const march_ray *ray, const water_sight *const *sights, uint32_t count)
{
    march_hit m = {.t = 0.0};
    for (uint32_t i = 0; i < count; i++) {
        double t = sights[i]->place.t;
        m.t += t / count;
        m.X += (ray->origin[0] + t * sights[i]->direction[0]) / count;
        m.Z += (ray->origin[2] + t * sights[i]->direction[2]) / count;
    }
    m.width_m = ray->width + (float)m.t * ray->spread;
    return m;
}

/* One sample: refines its hit by one step, and reads the water there. */
static wave_point find(const water_setup *s, const waves_reading *r, const march_ray *from,
                       const water_sight *one, const march_hit *middle, double place[3],
                       float displacement[2])
{
    const double *d = one->direction;
    march_ray ray = *from;
    for (int i = 0; i < 3; i++)
        ray.direction[i] = d[i];
    double t = one->place.t, X = ray.origin[0] + t * d[0], Z = ray.origin[2] + t * d[2];
    float offset[2] = {(float)(X - middle->X), (float)(Z - middle->Z)};
    displacement[0] = one->place.displacement[0];
    displacement[1] = one->place.displacement[1];
    float eta = waves_reading_height(r, offset, displacement);
    if (one->place.slack_m > 0.0) {
        double clearance = march_height(&s->march, &ray, t) - (double)eta;
        double more = clearance / (one->place.closing * hypot(d[0], d[2]));
        more = fmin(fmax(more, -one->place.slack_m), one->place.slack_m);
        t += more;
        offset[0] += (float)(more * d[0]);
        offset[1] += (float)(more * d[2]);
    }
    place[0] = t;
    place[1] = middle->X + (double)offset[0];
    place[2] = middle->Z + (double)offset[1];
    return waves_reading_point(r, (const float[2]){displacement[0] - offset[0], displacement[1] - offset[1]});
}

water_place water_place_of_samples(const water_setup *s, const march_ray *ray,
                                   const water_sight *const *sights, uint32_t count, march_hit *hit)
{
    water_place p;
    march_hit middle = middle_of(ray, sights, count);
    float footprint = begin(s, ray, middle.t, middle.width_m, count, &p);
    waves_reading r = waves_reading_of(&s->sea->waves, middle.X, middle.Z, footprint);
    *hit = (march_hit){.width_m = middle.width_m};
    sums sum = {.weight = 0.0f};
    for (uint32_t i = 0; i < count; i++) {
        double place[3];
        float displacement[2];
        wave_point at = find(s, &r, ray, sights[i], &middle, place, displacement);
        add(&sum, &at, p.V);
        hit->t += place[0] / count;
        hit->X += place[1] / count;
        hit->Z += place[2] / count;
        for (int k = 0; k < 2; k++)
            hit->displacement[k] += displacement[k] / (float)count;
    }
    sum = mean_of(sum);
    p.slopes = water_slopes_at(s, footprint);
    if (count > 1)
        spread(&p.slopes, &sum);
    locate(s, ray, hit, &p);
    float n = (float)count; /* foam is read once for all of them: see begin() */
    finish(s, water_faced(normal_from_slope(sum.slope), p.V), sum.height_m, footprint * sqrt(n * sqrt(n)),
           &p);
    return p;
}
