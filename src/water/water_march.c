/* water_march.c - see water_march.h. */
#include "water/water_march.h"

#include <math.h>

static const double EARTH_RADIUS_M = 6360000.0;
enum { MAX_STEPS = 1000, REFINEMENTS = 24 };

water_march water_march_of(const waves *w, const slope_filter *slopes, bool is_round)
{
    sea_moments all = sea_state_moments(&w->state, 0.0, SHORTEST_WAVE_K);
    return (water_march){.waves = w,
                         .slopes = slopes,
                         .fall = is_round ? 0.5 / EARTH_RADIUS_M : 0.0,
                         .deviation_m = (float)sqrt(all.height)};
}

static double level_of(const march_ray *ray)
{
    return sqrt(fmax(1.0 - ray->direction[1] * ray->direction[1], 0.0));
}

static float width_at(const march_ray *ray, double t)
{
    return ray->width + (float)t * ray->spread;
}

march_hit water_march_hit_at(const water_march *m, const march_ray *ray, double t,
                             const float displacement[2], double *clearance)
{
    float width = width_at(ray, t);
    march_hit hit = {.t = t,
                     .X = ray->origin[0] + t * ray->direction[0],
                     .Z = ray->origin[2] + t * ray->direction[2],
                     .width_m = width,
                     .footprint_m = water_march_footprint(m, width, march_rise(m, ray, t)),
                     .displacement = {displacement[0], displacement[1]}};
    float eta = waves_height_near(m->waves, hit.X, hit.Z, hit.footprint_m, hit.displacement);
    *clearance = (march_height(m, ray, t) - (double)eta) * (ray->is_below ? -1.0 : 1.0);
    return hit;
}

double water_march_reach(const water_march *m, const march_ray *ray, double height_m, double from)
{
    double level = level_of(ray), a = level * level * m->fall, b = ray->direction[1];
    double c = ray->origin[1] - height_m, sign = ray->is_below ? -1.0 : 1.0;
    if (sign * (march_height(m, ray, from) - height_m) <= 0.0)
        return from;
    double roots[2] = {HUGE_VAL, HUGE_VAL}, d = b * b - 4.0 * a * c;
    if (a == 0.0) {
        roots[0] = b != 0.0 ? -c / b : HUGE_VAL;
    } else if (d >= 0.0) {
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

bool water_march_is_cut(const water_march *m, const march_ray *ray, double height_m)
{
    double above = march_height(m, ray, ray->near_m) - height_m;
    return (ray->is_below ? -above : above) < 0.0;
}

/* ---- one ray ---- */

/* State of a ray, and bounds of the waves for its current footprint. */
typedef struct march {
    const water_march *m;
    const march_ray *ray;
    double level;       /* length of the direction's horizontal part */
    float bounded_m;    /* footprint of the following bounds */
    wave_bounds bounds; /* valid for this footprint and all wider ones */
    /* maximum slope: five standard deviations where the sum over tiles could exceed that */
    double steepest;
    march_hit last;
} march;

/* Standard deviation of the steeper component of the slopes that a footprint resolves. */
static double resolved_deviation(const slope_filter *f, float footprint_m)
{
    uint32_t i = (uint32_t)slope_filter_place(footprint_m);
    double xx = (double)f->total.xx - (double)f->residual[i].xx;
    double zz = (double)f->total.zz - (double)f->residual[i].zz;
    double xz = (double)f->total.xz - (double)f->residual[i].xz;
    double mean = 0.5 * (xx + zz), half = 0.5 * (xx - zz);
    return sqrt(fmax(mean + sqrt(half * half + xz * xz), 0.0));
}

/* The bounds are reused until the footprint has doubled. */
static void update_bounds(march *s, double t)
{
    float footprint = water_march_footprint(s->m, width_at(s->ray, t), march_rise(s->m, s->ray, t));
    if (footprint <= 2.0f * s->bounded_m)
        return;
    s->bounded_m = fmaxf(footprint, 1e-6f);
    s->bounds = waves_bounds(s->m->waves, footprint);
    s->steepest = fmin((double)s->bounds.steepest, 5.0 * resolved_deviation(s->m->slopes, footprint) + 1e-4);
}

static double clearance(march *s, double t)
{
    double f;
    s->last = water_march_hit_at(s->m, s->ray, t, s->last.displacement, &f);
    return f;
}

/* Root within [a, b], above the surface at a, by false position; the retained end has its weight halved each
 * time (the Illinois method). */
static void refine(march *s, double a, double fa, double b, double fb)
{
    for (int i = 0, side = 0; i < REFINEMENTS; i++) {
        double t = a + (b - a) * (fa / (fa - fb));
        double f = clearance(s, t), close = 0.03 * (double)s->last.width_m + 1e-5;
        if (fabs(f) < close || b - a < close)
            return;
        if (f > 0.0) {
            a = t;
            fa = f;
            fb = side > 0 ? 0.5 * fb : fb;
            side = 1;
        } else {
            b = t;
            fb = f;
            fa = side < 0 ? 0.5 * fa : fa;
            side = -1;
        }
    }
}

/* Whether the ray has left the waves for good: upwards above all of them, or downwards below. */
static bool is_away(const march *s, double t)
{
    double y = march_height(s->m, s->ray, t), rise = march_rise(s->m, s->ray, t);
    if (s->ray->is_below)
        return rise < 0.0 && y < (double)s->bounds.lowest && s->m->fall * t < 1e-3;
    return rise >= 0.0 && y > (double)s->bounds.highest;
}

/* Where a ray that starts at t, maybe behind the surface, is in front of it; HUGE_VAL: nowhere. */
static double leave_waves(march *s, double t)
{
    const double sign = s->ray->is_below ? -1.0 : 1.0;
    for (int step = 0; step < MAX_STEPS && t <= s->ray->far_m; step++) {
        update_bounds(s, t);
        double y = march_height(s->m, s->ray, t), rise = sign * march_rise(s->m, s->ray, t);
        double all = (double)(s->ray->is_below ? s->bounds.highest : s->bounds.lowest);
        if (rise <= 0.0 && sign * (y - all) < 0.0)
            return HUGE_VAL;
        double f = clearance(s, t), least = 0.7 * (double)s->last.width_m + 1e-4;
        if (f >= 0.0)
            return t;
        t += fmax(-f / fmax(fmax(rise, 0.0) + s->steepest * s->level, 1e-6), least);
    }
    return HUGE_VAL;
}

/* Steps exceed the safe length by a factor; one that may have passed a wave is repeated. Waves shorter
 * than 0.7 of the width are filtered out. */
static bool march_waves(march *s)
{
    const march_ray *r = s->ray;
    const double relaxation = 1.6, sign = r->is_below ? -1.0 : 1.0;
    wave_bounds all = waves_bounds(s->m->waves, width_at(r, r->near_m));
    double t = water_march_reach(s->m, r, (double)(r->is_below ? all.lowest : all.highest), r->near_m);
    if (t <= r->near_m)
        t = leave_waves(s, t);
    double before = t, f_before = 0.0, reach = 0.0; /* previous position, its clearance, its safe step */
    for (int step = 0; step < MAX_STEPS && t <= r->far_m && t < HUGE_VAL; step++) {
        update_bounds(s, t);
        if (is_away(s, t))
            return false;
        double f = clearance(s, t), least = 0.7 * (double)s->last.width_m + 1e-4;
        double speed = fmax(-sign * march_rise(s->m, r, t), 0.0) + s->steepest * s->level;
        double sure = fmax(f, 0.0) / fmax(speed, 1e-6);
        if (reach > 0.0 && (f <= 0.0 || t - before > reach + sure) && t - before > reach * 1.0001) {
            t = before + reach;
            reach = 0.0;
            continue;
        }
        if (f <= 0.0) {
            if (f_before > 0.0)
                refine(s, before, f_before, t, f);
            return true;
        }
        before = t;
        f_before = f;
        reach = fmax(sure, least);
        t += fmax(sure * relaxation, least);
    }
    return false;
}

static bool march_flat(march *s)
{
    const march_ray *r = s->ray;
    double f, level_m = (double)s->m->waves->level_m, t = water_march_reach(s->m, r, level_m, r->near_m);
    const float still[2] = {0.0f, 0.0f};
    if (water_march_is_cut(s->m, r, level_m) || !(t <= r->far_m && t < HUGE_VAL))
        return false;
    s->last = water_march_hit_at(s->m, s->ray, t, still, &f);
    return true;
}

bool water_march_find(const water_march *m, const march_ray *ray, march_hit *hit)
{
    march s = {.m = m, .ray = ray, .level = level_of(ray), .bounded_m = -1.0f};
    bool is_met = m->waves->tile_count ? march_waves(&s) : march_flat(&s);
    *hit = s.last;
    return is_met;
}
