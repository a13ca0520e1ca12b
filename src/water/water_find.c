/* water_find.c - see water_find.h. */
#include <math.h>

#include "water/water_find.h"

static const float FACETS_PER_PIXEL = 64.0f;
static const float MIN_FACETS = 1e-3f; /* a share of microfacets that is not worth a ray */
static const float SMOOTH = 1e-3f;     /* slopes that deflect a reflection by less than a pixel */

/* The shaded point of the surface. */
typedef struct looking {
    const water_setup *s;
    const water_place *place;
    float footprint;
    uint32_t random;
    vec3 low, high; /* distance of the model, m */
} looking;

static looking looking_at(const water_setup *s, const water_place *place, float footprint, uint32_t random)
{
    const float *low = s->model.prepared.pose.bounds_min, *high = s->model.prepared.pose.bounds_max;
    vec3 from = vec3((float)place->P[0], (float)place->P[1], (float)place->P[2]);
    return (looking){.s = s,
                     .place = place,
                     .footprint = footprint,
                     .random = random,
                     .low = vec3(low[0], low[1], low[2]) - from,
                     .high = vec3(high[0], high[1], high[2]) - from};
}

/* The point, offset from the surface so that rays from it do not hit floating parts from the wrong side. */
static void start_of(const water_place *p, float up_m, double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = p->P[i];
    out[1] += (double)up_m;
}

static float share_of_sun(const looking *l)
{
    double P[3];
    start_of(l->place, 1e-3f, P);
    return water_model_opening(&l->s->model, P, l->s->light.L, HUGE_VAL);
}

/* Traces the ray of one microfacet from P. */
typedef void (*look_into)(const looking *l, Facet f, const double P[3], void *found);

/* Samples a fixed number of microfacets per pixel, whatever its number of samples. N: mean normal; smooth:
 * normal without the unresolved waves. */
static void look_into_facets(const looking *l, FacetRange r, vec3 N, vec3 smooth, float up_m, look_into look,
                             void *found)
{
    double P[3];
    start_of(l->place, up_m, P);
    if (facets_share(r) < MIN_FACETS)
        return;
    if (max(r.along, r.across) < SMOOTH) {
        look(l, (Facet){smooth, 1.0f}, P, found);
        return;
    }
    float count = clamp(FACETS_PER_PIXEL * l->footprint * l->footprint, 4.0f, 16.0f);
    for (uint i = 0; i < (uint)count; i++) {
        Facet f = facet_drawn(r, N, sobol_scrambled(i, l->random));
        f.weight *= 1.0f / (float)(uint)count;
        look(l, f, P, found);
    }
}

/* ---- from above ---- */

/* The model below the surface along the refracted ray: lit by the light that reaches it, and attenuated by
 * the water. */
static bool find_refracted(const looking *l, water_findings *found)
{
    const water_setup *s = l->s;
    const water_place *place = l->place;
    Water w = s->water;
    vec3 down = water_refracted(w, -place->V, place->point.N);
    double P[3];
    model_hit hit;
    start_of(place, -1e-3f, P);
    if (!water_model_find(&s->model, P, down, HUGE_VAL, l->random, &hit))
        return false;
    float way = (float)hit.distance_m, depth = max((float)place->P[1] - hit.P[1], 0.0f);
    vec3 lit = water_model_radiance(&s->model, &hit, s->light.L) * water_transmittance(water_K_d(w), depth);
    vec3 gone = water_transmittance(water_K_d(w), depth) * water_transmittance(water_diffuse(w), way);
    found->below = lit * water_transmittance(water_beam(w), way) +
                   water_from_deep(w, s->light.downwelling) * (1.0f - gone);
    found->has_below = true;
    return true;
}

/* Light that a microfacet reflects downwards hits another wave and is reflected upwards. */
static void look_up(const looking *l, Facet f, const double P[3], void *out)
{
    const water_setup *s = l->s;
    water_findings *found = out;
    model_hit hit;
    vec3 V = l->place->V, R = reflect(-V, f.m);
    R[1] = max(abs(R[1]), 1e-4f);
    if (!water_model_find(&s->model, P, R, HUGE_VAL, l->random, &hit))
        return;
    float weight = f.weight * water_fresnel(s->water, clamp(dot(f.m, V), 0.0f, 1.0f));
    found->covered += weight;
    found->mirrored = found->mirrored + water_model_radiance(&s->model, &hit, s->light.L) * weight;
}

water_findings water_find(const water_setup *s, const water_place *place, float footprint, uint32_t random)
{
    water_findings found = {.has_below = false};
    if (!s->model.is_there)
        return found;
    looking l = looking_at(s, place, footprint, random);
    vec3 N = place->point.N;
    FacetRange r = facets_that_mirror(place->point.covariance, N, place->V, l.low, l.high);
    look_into_facets(&l, r, N, N, 1e-3f, look_up, &found);
    if (s->light.L[1] > 0.0f) {
        found.sun = share_of_sun(&l);
        found.has_shadow = found.sun < 1.0f;
    }
    find_refracted(&l, &found);
    return found;
}

/* ---- from below ---- */

/* An eye in the water that looks along d, and its results. */
typedef struct below {
    vec3 d;
    float roughness; /* of the sky, as microfacets refract it */
    water_findings_below found;
} below;

/* Light that a microfacet reflects upwards hits another wave and is reflected downwards. */
static void look_down(const looking *l, Facet f, const double P[3], void *out)
{
    const water_setup *s = l->s;
    below *b = out;
    model_hit hit;
    vec3 R = reflect(b->d, f.m);
    R[1] = -max(abs(R[1]), 1e-4f);
    if (f.weight <= 0.0f || !water_model_find(&s->model, P, R, HUGE_VAL, l->random, &hit))
        return;
    float weight = f.weight * water_fresnel_inside(s->water, clamp(dot(f.m, b->d), 0.0f, 1.0f));
    b->found.covered += weight;
    b->found.mirrored = b->found.mirrored + water_model_behind_water(s, &hit, P, R) * weight;
}

/* Instead of the sky, past waves. */
static void look_through(const looking *l, Facet f, const double P[3], void *out)
{
    const water_setup *s = l->s;
    below *b = out;
    model_hit hit;
    WaterWindow window = water_window(s->water, b->d, f.m);
    float passing = water_passing(l->place->slopes.resolved, l->place->point.N, window.outside);
    if (f.weight * passing <= 0.0f || window.fresnel >= 1.0f ||
        !water_model_find(&s->model, P, window.outside, HUGE_VAL, l->random, &hit))
        return;
    float weight = f.weight * window.gain * passing;
    b->found.through = b->found.through + water_model_radiance(&s->model, &hit, s->light.L) * weight;
    b->found.hidden = b->found.hidden + water_sky_reflected(&s->sky, window.outside, b->roughness) * weight;
}

/* The part of a box above the surface, or below it; false: none. */
static void find_mirrored_below(const looking *l, vec3 N, vec3 smooth, below *b)
{
    if (l->low[1] >= 0.0f)
        return;
    vec3 high = vec3(l->high[0], min(l->high[1], 0.0f), l->high[2]);
    FacetRange r = facets_that_mirror(l->place->point.covariance, N, b->d, -high, -l->low);
    look_into_facets(l, r, N, smooth, -1e-3f, look_down, b);
}

static void find_through_window(const looking *l, vec3 N, vec3 smooth, below *b)
{
    if (l->high[1] <= 0.0f)
        return;
    vec3 low = vec3(l->low[0], max(l->low[1], 0.0f), l->low[2]);
    FacetRange r = facets_that_bend(l->place->point.covariance, N, b->d, low, l->high, l->s->water.ior);
    look_into_facets(l, r, N, smooth, 1e-3f, look_through, b);
}

water_findings_below water_find_below(const water_setup *s, const water_place *place, vec3 d, float footprint,
                                      uint32_t random)
{
    below b = {.d = d, .found = {.sun = 1.0f}};
    if (!s->model.is_there)
        return b.found;
    looking l = looking_at(s, place, footprint, random);
    vec3 C = place->point.covariance;
    vec3 N = water_faced(place->point.N, d), smooth = water_seen_normal(C, place->point.N, d);
    b.roughness = window_roughness(facets_seen(C, place->point.N, d), C);
    find_mirrored_below(&l, N, smooth, &b);
    find_through_window(&l, N, smooth, &b);
    if (s->light.L[1] > 0.0f)
        b.found.sun = share_of_sun(&l);
    return b.found;
}
