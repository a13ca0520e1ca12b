/* water_profile.c - see water_profile.h. */
#include "water/water_profile.h"

#include <math.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"

/* Horizontal part of the steepest rays that use the profile: 78 degrees. */
static const double STEEPEST_LEVEL = 0.2;
static const double FINE_PIXELS = 1.0, COARSE_PIXELS = 4.0; /* between columns; between samples */
static const double LONGEST_M = 1e5, SHORTEST_M = 0.02;
static const double MAX_SAMPLES = 4e6;
static const double PI_D = 3.14159265358979323846;
enum { PROBES = 33 };

typedef struct filling {
    water_profile *p;
    uint32_t coarse_count; /* columns of samples */
    double coarse_per_rad;
    double pixel_rad;
} filling;

static double distance_of(const water_profile *p, double row)
{
    return p->first_m * exp(row / p->rows_per_log);
}

/* ---- where ---- */

static double turned(double azimuth, double from)
{
    double a = azimuth - from;
    return a - 2.0 * PI_D * floor(a / (2.0 * PI_D) + 0.5);
}

bool water_profile_azimuths(const camera_rays *rays, const uint32_t part[4], double *middle, double *half)
{
    float o[3], d[3];
    camera_rays_at(rays, (float)part[0] + 0.5f * (float)part[2], (float)part[1] + 0.5f * (float)part[3], o,
                   d);
    double level = hypot((double)d[0], (double)d[2]), length = hypot(level, (double)d[1]);
    *middle = atan2((double)d[2], (double)d[0]);
    *half = 0.0;
    bool is_any = false;
    for (int i = 0; i < PROBES * PROBES; i++) {
        float x = (float)part[0] + (float)part[2] * (float)(i % PROBES) / (PROBES - 1);
        float y = (float)part[1] + (float)part[3] * (float)(i / PROBES) / (PROBES - 1);
        camera_rays_at(rays, x, y, o, d);
        double flat = hypot((double)d[0], (double)d[2]);
        if (flat < STEEPEST_LEVEL * hypot(flat, (double)d[1]))
            continue;
        is_any = true;
        *half = fmax(*half, fabs(turned(atan2((double)d[2], (double)d[0]), *middle)));
    }
    *half = level < 0.5 * length ? PI_D : fmin(*half * 1.1 + 0.02, PI_D);
    return is_any;
}

/* From the first possible hit to where waves are no longer visible. */
static void distances_of(const water_march *m, double eye_y, double pixel_rad, bool is_below, double out[2])
{
    wave_bounds all = waves_bounds(m->waves, 0.0f);
    double clear = is_below ? (double)all.lowest - eye_y : eye_y - (double)all.highest;
    out[0] = fmax(clear * STEEPEST_LEVEL, SHORTEST_M);
    out[1] = out[0] * 2.0;
    while (out[1] < LONGEST_M) {
        double rise = (eye_y - out[1] * out[1] * m->fall) / out[1];
        float footprint = water_march_footprint(m, (float)(pixel_rad * out[1]), rise);
        wave_bounds there = waves_bounds(m->waves, footprint);
        if ((double)(there.highest - there.lowest) < 0.1 * pixel_rad * out[1])
            break;
        out[1] *= 1.3;
    }
}

/* ---- filling ---- */

static void fill_samples(void *context, size_t begin, size_t end)
{
    const filling *f = context;
    const water_profile *p = f->p;
    for (size_t c = begin; c < end; c++) {
        double azimuth = p->first_azimuth + (double)c / f->coarse_per_rad;
        double dx = cos(azimuth), dz = sin(azimuth);
        float displacement[2] = {0.0f, 0.0f};
        for (uint32_t row = 0; row < p->row_count; row++) {
            double r = distance_of(p, row);
            float footprint = (float)(0.5 * COARSE_PIXELS * f->pixel_rad * hypot(r, p->origin[1]));
            profile_sample *to = &p->samples[c * p->row_count + row];
            to->height_m = waves_height_near(p->march->waves, p->origin[0] + r * dx, p->origin[2] + r * dz,
                                             footprint, displacement);
            to->displacement[0] = displacement[0];
            to->displacement[1] = displacement[1];
        }
    }
}

static void fill_columns(void *context, size_t begin, size_t end)
{
    const filling *f = context;
    const water_profile *p = f->p;
    float sign = p->is_below ? -1.0f : 1.0f;
    for (size_t c = begin; c < end; c++) {
        double x = (double)c / p->columns_per_rad * f->coarse_per_rad;
        size_t left = (size_t)x < f->coarse_count - 1 ? (size_t)x : f->coarse_count - 2;
        float share = (float)(x - (double)left), greatest = -HUGE_VALF;
        const profile_sample *a = p->samples + left * p->row_count, *b = a + p->row_count;
        float *out = p->tangents + c * p->row_count;
        for (uint32_t row = 0; row < p->row_count; row++) {
            double r = distance_of(p, row);
            double eta = (double)(a[row].height_m + (b[row].height_m - a[row].height_m) * share);
            float e = sign * (float)((eta - p->origin[1] - r * r * p->march->fall) / r);
            greatest = e > greatest ? e : greatest;
            out[row] = greatest;
        }
    }
}

/* ---- making ---- */

/* Chooses the numbers of columns and rows, fewer where a large image would need too many samples. */
static void lay_out(filling *f, double half, const double distances[2])
{
    water_profile *p = f->p;
    double ratio = log(distances[1] / distances[0]), coarse = COARSE_PIXELS * f->pixel_rad;
    double samples = 2.0 * half / coarse * ratio / coarse;
    coarse *= samples > MAX_SAMPLES ? sqrt(samples / MAX_SAMPLES) : 1.0;
    coarse = fmin(coarse, 0.05);
    f->coarse_count = (uint32_t)(2.0 * half / coarse) + 3;
    f->coarse_per_rad = (f->coarse_count - 2) / (2.0 * half);
    p->finer = (uint32_t)ceil(COARSE_PIXELS / FINE_PIXELS);
    p->column_count = (f->coarse_count - 1) * p->finer;
    p->columns_per_rad = f->coarse_per_rad * p->finer;
    p->first_m = distances[0];
    p->rows_per_log = 1.0 / coarse;
    p->row_count = (uint32_t)(ratio / coarse) + 2;
}

facet_result water_profile_create(const water_march *m, const camera_rays *rays, const uint32_t part[4],
                                  bool is_below, uint32_t thread_count, const facet_allocator *allocator,
                                  water_profile *p, facet_error *error)
{
    *p = (water_profile){.march = m, .is_below = is_below};
    double middle, half, distances[2];
    if (rays->is_orthographic || m->waves->tile_count == 0 ||
        !water_profile_azimuths(rays, part, &middle, &half))
        return FACET_OK;
    for (int i = 0; i < 3; i++)
        p->origin[i] = (double)rays->origin[i];
    filling f = {.p = p, .pixel_rad = (double)rays->pixel_size};
    distances_of(m, p->origin[1], f.pixel_rad, is_below, distances);
    p->first_azimuth = middle - half;
    lay_out(&f, half, distances);
    size_t samples = (size_t)f.coarse_count * p->row_count, all = (size_t)p->column_count * p->row_count;
    p->samples = mem_alloc(allocator, samples, sizeof *p->samples);
    p->tangents = mem_alloc(allocator, all, sizeof *p->tangents);
    if (!p->samples || !p->tangents) {
        water_profile_destroy(p);
        return fail_memory(error, "the sea's profile",
                           samples * sizeof *p->samples + all * sizeof *p->tangents);
    }
    parallel_for(thread_count, f.coarse_count, 4, fill_samples, &f);
    parallel_for(thread_count, p->column_count, 16, fill_columns, &f);
    return FACET_OK;
}

void water_profile_destroy(water_profile *p)
{
    mem_free(p->tangents);
    mem_free(p->samples);
    *p = (water_profile){.march = NULL};
}

/* ---- asking ---- */

/* First row between low and high with at least that tangent; high: none. */
static uint32_t first_row(const float *tangents, uint32_t low, uint32_t high, float tangent)
{
    uint32_t count = high - low;
    while (count > 0) {
        uint32_t half = count / 2;
        bool is_less = tangents[low + half] < tangent;
        low += is_less ? half + 1 : 0;
        count = is_less ? count - half - 1 : half;
    }
    return low;
}

/* The same over all rows, by doubling steps from an estimate. */
static uint32_t first_row_near(const float *tangents, uint32_t row_count, uint32_t near_row, float tangent)
{
    uint32_t low = near_row < row_count ? near_row : row_count - 1, high = low, step = 4;
    if (tangents[low] < tangent) {
        do {
            low = high + 1;
            high = step < row_count - low ? low + step : row_count;
            step *= 4;
        } while (high < row_count && tangents[high] < tangent);
    } else {
        do {
            high = low;
            low = step < high ? high - step : 0;
            step *= 4;
        } while (low > 0 && !(tangents[low] < tangent));
    }
    return first_row(tangents, low, high, tangent);
}

/* Azimuth of a direction near the previous one. */
static double azimuth_of(const double d[3], const profile_nearby *last)
{
    double dot = d[0] * last->x + d[2] * last->z, cross = d[2] * last->x - d[0] * last->z;
    if (!(fabs(cross) < 0.01 * dot)) /* beyond, a third power would be visible */
        return atan2(d[2], d[0]);
    return last->azimuth + cross / dot;
}

/* Rate at which a ray approaches still water. */
static double level_closing(const water_profile *p, const march_ray *ray, double t)
{
    double level = sqrt(ray->direction[0] * ray->direction[0] + ray->direction[2] * ray->direction[2]);
    return fmax(fabs(march_rise(p->march, ray, t)) / fmax(level, 1e-6), 1e-3);
}

static bool march_there(const water_profile *p, const march_ray *ray, profile_place *out)
{
    march_hit hit;
    bool is_met = water_march_find(p->march, ray, &hit);
    *out = (profile_place){.t = hit.t,
                           .closing = is_met ? level_closing(p, ray, hit.t) : 1.0,
                           .displacement = {hit.displacement[0], hit.displacement[1]}};
    return is_met;
}

/* There are no waves beyond the last row. */
static bool look_flat(const water_profile *p, const march_ray *ray, double from, profile_place *out)
{
    *out =
        (profile_place){.t = water_march_reach(p->march, ray, 0.0, fmax(from, ray->near_m)), .closing = 1.0};
    bool is_cut = ray->near_m > from && water_march_is_cut(p->march, ray, 0.0);
    return out->t <= ray->far_m && out->t < HUGE_VAL && !is_cut;
}

bool water_profile_look(const water_profile *p, const march_ray *ray, profile_nearby *nearby,
                        profile_place *out)
{
    const double *d = ray->direction;
    double level = sqrt(d[0] * d[0] + d[2] * d[2]), azimuth = azimuth_of(d, nearby);
    double column = turned(azimuth, p->first_azimuth) * p->columns_per_rad + 0.5;
    column = column < 0.0 ? column + 2.0 * PI_D * p->columns_per_rad : column;
    if (!p->tangents || level < STEEPEST_LEVEL || !(column < (double)p->column_count))
        return march_there(p, ray, out);
    const float *tangents = p->tangents + (size_t)column * p->row_count;
    double slope = d[1] / level * (p->is_below ? -1.0 : 1.0);
    uint32_t row = nearby->row ? first_row_near(tangents, p->row_count, nearby->row, (float)slope)
                               : first_row(tangents, 0, p->row_count, (float)slope);
    *nearby = (profile_nearby){row, azimuth, d[0], d[2]};
    if (row == 0)
        return march_there(p, ray, out);
    if (row == p->row_count)
        return look_flat(p, ray, distance_of(p, row - 1.0) / level, out);
    double near_r = distance_of(p, row - 1.0), far_r = distance_of(p, row);
    double near_f = near_r * (slope - (double)tangents[row - 1]);
    double far_f = far_r * (slope - (double)tangents[row]);
    double share = near_f / fmax(near_f - far_f, 1e-12);
    const profile_sample *known = &p->samples[(size_t)column / p->finer * p->row_count + row];
    *out = (profile_place){.t = (near_r + (far_r - near_r) * share) / level,
                           .closing = fmax((near_f - far_f) / (far_r - near_r), 1e-3),
                           .slack_m = (far_r - near_r) / level,
                           .displacement = {known->displacement[0], known->displacement[1]}};
    if (out->t < ray->near_m)
        return march_there(p, ray, out);
    return out->t <= ray->far_m;
}

static march_hit correct(const water_profile *p, const march_ray *ray, const profile_place *place)
{
    double f, level = hypot(ray->direction[0], ray->direction[2]);
    march_hit hit = water_march_hit_at(p->march, ray, place->t, place->displacement, &f);
    if (place->slack_m > 0.0) {
        double more = fmin(fmax(f / (place->closing * level), -place->slack_m), place->slack_m);
        hit.t += more;
        hit.X += more * ray->direction[0];
        hit.Z += more * ray->direction[2];
    }
    return hit;
}

bool water_profile_find(const water_profile *p, const march_ray *ray, march_hit *hit)
{
    profile_place place;
    profile_nearby nowhere = {.row = 0};
    if (!water_profile_look(p, ray, &nowhere, &place))
        return false;
    *hit = correct(p, ray, &place);
    return true;
}
