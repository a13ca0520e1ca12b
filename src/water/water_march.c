/* water_march.c - see water_march.h. */
#include "water/water_march.h"

#include <math.h>

#include "base/memory.h"
#include "base/result.h"

static const double EARTH_RADIUS_M = 6360000.0;
enum { MOST_STEPS = 1000, BISECTIONS = 24 };

facet_result water_march_create(const waves *w, const slope_filter *slopes, const float eye[3], bool is_round,
                                const facet_allocator *allocator, water_march *m, facet_error *error)
{
    sea_moments all = sea_state_moments(&w->state, 0.0, SHORTEST_WAVE_K);
    *m = (water_march){.waves = w,
                       .slopes = slopes,
                       .fall = is_round ? 0.5 / EARTH_RADIUS_M : 0.0,
                       .deviation_m = (float)sqrt(all.height)};
    return water_crests_create(w, (double)eye[0], (double)eye[2], allocator, &m->crests, error);
}

void water_march_destroy(water_march *m)
{
    water_crests_destroy(&m->crests);
    *m = (water_march){.waves = NULL};
}

/* ---- one ray ---- */

/* A ray on its way, and what is known of the waves as its footprint there sees them. */
typedef struct march {
    const water_march *m;
    const march_ray *ray;
    double level; /* length of the level part of the direction */
    double sign;  /* 1: from above, -1: from below */
    crests_ray crests;
    float looked_m;     /* footprint for which the following were found */
    wave_bounds bounds; /* of this footprint, and all wider ones */
    double
        steepest; /* slope that no wave exceeds: six standard deviations where all tiles at once could have more */
    float others_highest; /* of all tiles but the longest, with level_m */
    uint32_t finest;      /* level of crests that may be used; CRESTS_LEVELS: none */
    float displacement[2];
} march;

static float width_at(const march_ray *ray, double t)
{
    return ray->width + (float)t * ray->spread;
}

/* How wide the surface is read: as the ray is, until waves are not even a pixel high. Then no longer they but their slopes are seen, and as much
 * more of them at once as rays are flat: up to the ray's length on still water. */
static float footprint_at(const march *s, double t)
{
    float width = width_at(s->ray, t), high = fmaxf(s->m->deviation_m, 1e-6f);
    float flat = 2.75f * width / high, wider = 1.0f + flat * flat;
    float along = 1.0f / fmaxf(fabsf((float)march_rise(s->m, s->ray, t)), 1e-4f);
    return width * fminf(wider, along);
}

/* Standard deviation of the steeper component of the slopes that a footprint resolves. */
static double resolved_deviation(const slope_filter *f, float footprint_m)
{
    uint32_t i = (uint32_t)slope_filter_place(footprint_m);
    double xx = (double)f->total.xx - (double)f->residual[i].xx,
           zz = (double)f->total.zz - (double)f->residual[i].zz;
    double xz = (double)f->total.xz - (double)f->residual[i].xz;
    double mean = 0.5 * (xx + zz), half = 0.5 * (xx - zz);
    return sqrt(fmax(mean + sqrt(half * half + xz * xz), 0.0));
}

/* What was found serves until the footprint has doubled. */
static void look_around(march *s, float footprint)
{
    const waves *w = s->m->waves;
    s->looked_m = fmaxf(footprint, 1e-6f);
    s->bounds = waves_bounds(w, footprint);
    s->steepest = fmin((double)s->bounds.steepest, 6.0 * resolved_deviation(s->m->slopes, footprint) + 1e-4);
    float others = w->level_m, farthest = 0.0f;
    for (uint32_t i = 1; i < w->tile_count; i++) {
        others += w->tiles[i].bounds[0].highest;
        farthest += w->tiles[i].bounds[0].farthest;
    }
    s->others_highest = others;
    s->finest =
        s->ray->is_below ? CRESTS_LEVELS : water_crests_level(&s->m->crests, 2.0f * footprint, farthest);
}

/* Height of the ray over the surface, positive on the side that it comes from. */
static double clearance(march *s, double t, double y)
{
    const march_ray *r = s->ray;
    double X = r->origin[0] + t * r->direction[0], Z = r->origin[2] + t * r->direction[2];
    float eta = waves_height_near(s->m->waves, X, Z, footprint_at(s, t), s->displacement);
    return s->sign * (y - (double)eta);
}

/* Where within [a, b] the ray goes through, which is clear at a. */
static double refine(march *s, double a, double fa, double b, double fb)
{
    for (int i = 0; i < BISECTIONS; i++) {
        double share = fa / (fa - fb); /* regula falsi, kept off the ends so that both come closer */
        share = i % 3 == 2 ? 0.5 : fmin(fmax(share, 0.1), 0.9);
        double t = a + (b - a) * share;
        double f = clearance(s, t, march_height(s->m, s->ray, t));
        if (f > 0.0) {
            a = t;
            fa = f;
        } else {
            b = t;
            fb = f;
        }
        double tolerance = 0.02 * (double)width_at(s->ray, t) + 1e-4;
        if (b - a < tolerance || fabs(f) < 0.02 * tolerance)
            return f > 0.0 ? t : a;
    }
    return a;
}

/* Smallest t >= from at which the ray's height is `height`, coming from above (sign 1) or from below (-1); HUGE_VAL: never. */
static double reaches(const march *s, double height, double from)
{
    const march_ray *r = s->ray;
    double a = s->level * s->level * s->m->fall, b = r->direction[1], c = r->origin[1] - height;
    if (s->sign * (march_height(s->m, r, from) - height) <= 0.0)
        return from;
    double roots[2] = {HUGE_VAL, HUGE_VAL}, d = b * b - 4.0 * a * c;
    if (a == 0.0)
        roots[0] = b != 0.0 ? -c / b : HUGE_VAL;
    else if (d >= 0.0) {
        double q = -0.5 * (b + copysign(sqrt(d), b));
        roots[0] = q / a;
        roots[1] = q != 0.0 ? c / q : HUGE_VAL;
    }
    double first = HUGE_VAL;
    for (int i = 0; i < 2; i++)
        if (roots[i] >= from && roots[i] < first)
            first = roots[i];
    return first;
}

static bool found(march *s, double t, march_hit *hit)
{
    const march_ray *r = s->ray;
    if (!(t <= r->far_m))
        return false;
    *hit = (march_hit){.t = t,
                       .X = r->origin[0] + t * r->direction[0],
                       .Z = r->origin[2] + t * r->direction[2],
                       .width_m = width_at(r, t),
                       .footprint_m = footprint_at(s, t),
                       .displacement = {s->displacement[0], s->displacement[1]}};
    return true;
}

static bool march_flat(march *s, march_hit *hit)
{
    double t = reaches(s, (double)s->m->waves->level_m, s->ray->near_m);
    return t < HUGE_VAL && found(s, t, hit);
}

/* Whether the ray has left the waves for good: it goes up above all of them, or down below. */
static bool is_away(const march *s, double t, double y)
{
    double rise = march_rise(s->m, s->ray, t);
    if (s->sign > 0.0)
        return rise >= 0.0 && y > (double)s->bounds.highest;
    return rise < 0.0 && y < (double)s->bounds.lowest && s->m->fall == 0.0;
}

static bool march_waves(march *s, march_hit *hit)
{
    const march_ray *r = s->ray;
    wave_bounds all = waves_bounds(s->m->waves, width_at(r, r->near_m));
    double t = reaches(s, (double)(s->sign > 0.0 ? all.highest : all.lowest), r->near_m);
    if (!(t < HUGE_VAL))
        return false;
    double before = t, f_before = 0.0,
           reach = 0.0; /* the last place, its clearance, and how far that was sure to go */
    const double relaxation = 1.6;
    for (int step = 0; step < MOST_STEPS && t <= r->far_m; step++) {
        float footprint = footprint_at(s, t);
        if (footprint > 2.0f * s->looked_m)
            look_around(s, footprint);
        double y = march_height(s->m, r, t);
        if (is_away(s, t, y))
            return false;
        double rise = march_rise(s->m, r, t), way = 0.0;
        if (s->finest < CRESTS_LEVELS)
            way = water_crests_pass(&s->m->crests, &s->crests, t, y, rise, s->others_highest, s->finest);
        double least = 0.05 * (double)width_at(r, t) + 1e-4;
        if (way > least) {
            t += way + 1e-6 * t + 1e-6;
            f_before = reach = 0.0;
            continue;
        }
        double f = clearance(s, t, y);
        double speed = fmax(-s->sign * rise, 0.0) + s->steepest * s->level;
        double sure = fmax(f, 0.0) / fmax(speed, 1e-6);
        if (reach > 0.0 && (f <= 0.0 || t - before > reach + sure) && t - before > reach * 1.0001) {
            t = before + reach; /* the longer step may have gone past a wave */
            reach = 0.0;
            continue;
        }
        if (f <= 0.0)
            return found(s, f_before > 0.0 ? refine(s, before, f_before, t, f) : t, hit);
        before = t;
        f_before = f;
        reach = fmax(sure, least);
        t += fmax(sure * relaxation, least);
    }
    return t <= r->far_m && f_before > 0.0 && !is_away(s, t, march_height(s->m, r, t)) &&
           found(s, before, hit);
}

bool water_march_find(const water_march *m, const march_ray *ray, march_hit *hit)
{
    const double *d = ray->direction;
    march s = {.m = m,
               .ray = ray,
               .level = sqrt(fmax(1.0 - d[1] * d[1], 0.0)),
               .sign = ray->is_below ? -1.0 : 1.0,
               .looked_m = -1.0f};
    if (m->waves->tile_count == 0)
        return march_flat(&s, hit);
    if (m->crests.highest)
        s.crests = water_crests_ray(&m->crests, ray->origin, d);
    return march_waves(&s, hit);
}
