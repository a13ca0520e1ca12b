/* waves_query.c - lookups of tiles: sums over all of them at a rest position, and the water above or below a
 * world position; patches, the shape of the surface, velocity.
 *
 * A tile is filtered to the square of the footprint: two adjacent mip levels are blended, each
 * interpolated linearly between four texels. Level l is used alone where a texel is as wide as the
 * footprint. Where samples are wider than the footprint, Catmull-Rom cubics through sixteen of them take
 * over: slopes without kinks. Marching reads linearly there, too. slope_filter.c models the resulting
 * variance. */
#include "ocean/waves_reading.h"

#include <math.h>

#include "ocean/wave_patches.h"
#include "ocean/foam_plane.h"
#include "ocean/waves.h"
#include "ocean/wave_amplitudes.h"

#include "shade/shade.h"

/* Half of a texel: displacement, height and one slope; or the other slope and the derivatives. */
typedef float float4 __attribute__((vector_size(16), may_alias));

/* In samples, wrapped to [0, size]. In double, so that it is exact a thousand kilometres away. */
static inline float wrapped(double samples, uint32_t size)
{
    if (!(fabs(samples) < 0x1p52))
        return 0.0f;
    int64_t whole = (int64_t)samples;
    whole -= samples < (double)whole;
    return (float)(whole & (int64_t)(size - 1)) + (float)(samples - (double)whole);
}

/* The blend factor is linear in the footprint: without a logarithm and continuous. False: the tile is
 * filtered out. */
static inline bool read_at(wave_tile_reading *r, const wave_tile *t, double x, double z, float footprint_m)
{
    float texels = footprint_m * (float)t->samples_per_m;
    uint32_t level = 0;
    while (texels >= 2.0f && level < t->level_count) {
        texels *= 0.5f;
        level++;
    }
    if (level + 1 >= t->level_count) /* the last level is the mean, 0 */
        return false;
    *r = (wave_tile_reading){.tile = t,
                             .level = level,
                             .mix = texels > 1.0f ? texels - 1.0f : 0.0f,
                             .cubic = texels > 1.0f   ? 0.0f
                                      : texels > 0.5f ? 2.0f - 2.0f * texels
                                                      : 1.0f,
                             .weight = 1.0f,
                             .u = wrapped(x * t->cos_per_m + z * t->sin_per_m, t->size),
                             .v = wrapped(z * t->cos_per_m - x * t->sin_per_m, t->size)};
    return true;
}

waves_reading waves_reading_of(const waves *w, double x, double z, float footprint_m)
{
    waves_reading r;
    r.w = w;
    r.count = r.tile_count = 0;
    for (uint32_t i = 0; i < w->tile_count; i++) {
        wave_tile_reading one;
        if (!read_at(&one, &w->tiles[i], x, z, footprint_m))
            continue;
        wave_patch patches[WAVES_MAX_PATCHES];
        uint32_t patch_count = wave_patches_at(w, i, x, z, patches);
        for (uint32_t p = 0; p < patch_count; p++) {
            wave_tile_reading *to = &r.tiles[r.count++];
            *to = one;
            to->weight = patches[p].weight;
            to->u += (float)patches[p].u;
            to->v += (float)patches[p].v;
        }
        r.ends[r.tile_count++] = r.count;
    }
    return r;
}

/* Four texels of a level and their weights. Texel i of level l is the mean of samples 2^l i to 2^l (i + 1)
 * - 1. */
typedef struct taps {
    const float *texels[4];
    float weights[4];
} taps;

static inline int32_t rounded_down(float a)
{
    int32_t i = (int32_t)a;
    return i - (a < (float)i);
}

static inline taps taps_at(const wave_tile *t, uint32_t level, float u, float v)
{
    static const float scales[WAVES_MAX_LEVELS] = {0x1p0f,  0x1p-1f, 0x1p-2f, 0x1p-3f, 0x1p-4f, 0x1p-5f,
                                                   0x1p-6f, 0x1p-7f, 0x1p-8f, 0x1p-9f, 0x1p-10f};
    float scale = scales[level], offset = 0.5f * scale - 0.5f;
    float px = u * scale + offset, pz = v * scale + offset;
    int32_t ix = rounded_down(px), iz = rounded_down(pz);
    float fx = px - (float)ix, fz = pz - (float)iz;
    uint32_t mask = (t->size >> level) - 1u;
    uint32_t x0 = (uint32_t)ix & mask, x1 = (x0 + 1u) & mask, z0 = (uint32_t)iz & mask, z1 = (z0 + 1u) & mask;
    const float *row0 = t->levels[level] + (size_t)z0 * (mask + 1u) * WAVE_FIELDS;
    const float *row1 = t->levels[level] + (size_t)z1 * (mask + 1u) * WAVE_FIELDS;
    return (taps){
        {row0 + x0 * WAVE_FIELDS, row0 + x1 * WAVE_FIELDS, row1 + x0 * WAVE_FIELDS, row1 + x1 * WAVE_FIELDS},
        {(1.0f - fx) * (1.0f - fz), fx * (1.0f - fz), (1.0f - fx) * fz, fx * fz}};
}

static inline float4 weighted(const taps *p, size_t first)
{
    return p->weights[0] * *(const float4 *)(p->texels[0] + first) +
           p->weights[1] * *(const float4 *)(p->texels[1] + first) +
           p->weights[2] * *(const float4 *)(p->texels[2] + first) +
           p->weights[3] * *(const float4 *)(p->texels[3] + first);
}

/* Half of a texel's fields, or all. */
typedef struct half_texels {
    float4 low, high;
} half_texels;

static inline void cubic_weights(float f, float weights[4])
{
    weights[0] = f * (-0.5f + f * (1.0f - 0.5f * f));
    weights[1] = 1.0f + f * f * (-2.5f + 1.5f * f);
    weights[2] = f * (0.5f + f * (2.0f - 1.5f * f));
    weights[3] = f * f * (-0.5f + 0.5f * f);
}

/* Of level 0. */
static half_texels read_cubic(const wave_tile *t, float u, float v)
{
    int32_t ix = rounded_down(u), iz = rounded_down(v);
    float wx[4], wz[4];
    cubic_weights(u - (float)ix, wx);
    cubic_weights(v - (float)iz, wz);
    uint32_t mask = t->size - 1u;
    half_texels sum = {{0.0f}, {0.0f}};
    for (uint32_t j = 0; j < 4; j++) {
        const float *row = t->levels[0] + (size_t)(((uint32_t)iz + j - 1u) & mask) * t->size * WAVE_FIELDS;
        half_texels across = {{0.0f}, {0.0f}};
        for (uint32_t i = 0; i < 4; i++) {
            const float *texel = row + (((uint32_t)ix + i - 1u) & mask) * WAVE_FIELDS;
            across.low += wx[i] * *(const float4 *)texel;
            across.high += wx[i] * *(const float4 *)(texel + 4);
        }
        sum.low += wz[j] * across.low;
        sum.high += wz[j] * across.high;
    }
    return sum;
}

/* Rest position of the water at the place of r with this displacement (m, world), in samples. */
static inline void place_before(const wave_tile_reading *r, const float displacement[2], float *u, float *v)
{
    const wave_tile *t = r->tile;
    float per_m = (float)t->samples_per_m;
    *u = r->u - per_m * (t->cos_turn * displacement[0] + t->sin_turn * displacement[1]);
    *v = r->v - per_m * (t->cos_turn * displacement[1] - t->sin_turn * displacement[0]);
}

/* DX, ETA, DZ, ETA_X of one tile, linearly interpolated. */
static inline float4 read_low(const wave_tile_reading *r, const float displacement[2])
{
    float u, v;
    place_before(r, displacement, &u, &v);
    taps p = taps_at(r->tile, r->level, u, v);
    float4 low = weighted(&p, 0);
    if (r->mix > 0.0f) {
        taps q = taps_at(r->tile, r->level + 1, u, v);
        low += r->mix * (weighted(&q, 0) - low);
    }
    return low * r->weight;
}

static half_texels read_all(const wave_tile_reading *r, const float displacement[2])
{
    float u, v;
    place_before(r, displacement, &u, &v);
    half_texels all = {{0.0f}, {0.0f}};
    if (r->cubic < 1.0f) {
        taps p = taps_at(r->tile, r->level, u, v);
        all = (half_texels){weighted(&p, 0), weighted(&p, 4)};
    }
    if (r->mix > 0.0f) {
        taps q = taps_at(r->tile, r->level + 1, u, v);
        all.low += r->mix * (weighted(&q, 0) - all.low);
        all.high += r->mix * (weighted(&q, 4) - all.high);
    }
    if (r->cubic > 0.0f) {
        half_texels smooth = read_cubic(r->tile, u, v);
        all.low += r->cubic * (smooth.low - all.low);
        all.high += r->cubic * (smooth.high - all.high);
    }
    all.low *= r->weight;
    all.high *= r->weight;
    return all;
}

static void add_tile(wave_point *p, const wave_tile_reading *r, const float displacement[2])
{
    float c = r->tile->cos_turn, s = r->tile->sin_turn;
    half_texels all = read_all(r, displacement);
    float4 low = all.low, high = all.high;
    float slope_x = low[WAVE_ETA_X], slope_z = high[WAVE_ETA_Z - 4];
    float Dxx = high[WAVE_DXX - 4], Dzz = high[WAVE_DZZ - 4], Dxz = high[WAVE_DXZ - 4];
    p->displacement[0] += c * low[WAVE_DX] - s * low[WAVE_DZ];
    p->displacement[1] += s * low[WAVE_DX] + c * low[WAVE_DZ];
    p->height_m += low[WAVE_ETA];
    p->slope[0] += c * slope_x - s * slope_z;
    p->slope[1] += s * slope_x + c * slope_z;
    p->Dxx += c * c * Dxx - 2.0f * c * s * Dxz + s * s * Dzz;
    p->Dzz += s * s * Dxx + 2.0f * c * s * Dxz + c * c * Dzz;
    p->Dxz += c * s * (Dxx - Dzz) + (c * c - s * s) * Dxz;
}

wave_point waves_reading_point(const waves_reading *r, const float displacement[2])
{
    wave_point p = {.height_m = r->w->level_m};
    for (uint32_t i = 0; i < r->count; i++)
        add_tile(&p, &r->tiles[i], displacement);
    return p;
}

wave_point waves_at(const waves *w, double x, double z, float footprint_m)
{
    waves_reading r = waves_reading_of(w, x, z, footprint_m);
    return waves_reading_point(&r, (const float[2]){0.0f, 0.0f});
}

/* ---- above a place ---- */

/* Displacement in world axes, and height. */
typedef struct heave {
    float x, z, height;
} heave;

static inline heave heave_from(const waves_reading *r, uint32_t count, const float displacement[2])
{
    heave sum = {0.0f, 0.0f, 0.0f};
    for (uint32_t i = 0; i < count; i++) {
        const wave_tile *t = r->tiles[i].tile;
        float4 low = read_low(&r->tiles[i], displacement);
        sum.x += t->cos_turn * low[WAVE_DX] - t->sin_turn * low[WAVE_DZ];
        sum.z += t->sin_turn * low[WAVE_DX] + t->cos_turn * low[WAVE_DZ];
        sum.height += low[WAVE_ETA];
    }
    return sum;
}

float waves_reading_height(const waves_reading *r, const float offset[2], float displacement[2])
{
    enum { STEPS = 2 };
    heave h = {0.0f, 0.0f, 0.0f};
    for (int i = 0; i < STEPS; i++) {
        h = heave_from(r, r->count,
                       (const float[2]){displacement[0] - offset[0], displacement[1] - offset[1]});
        displacement[0] = h.x;
        displacement[1] = h.z;
    }
    return h.height + r->w->level_m;
}

/* Without an estimate, the long waves come first: they move water farthest, and are the fastest to read. */
static inline void guess_rest(const waves_reading *r, float displacement[2])
{
    for (uint32_t i = 0; i + 1 < r->tile_count; i++) {
        heave h = heave_from(r, r->ends[i], displacement);
        displacement[0] = h.x;
        displacement[1] = h.z;
    }
}

/* Fixed-point iteration x <- X - D(x): each step reduces the error by about the root of the slope
 * variance, by less in steep places. It ends where water moves by less than a fiftieth of the footprint or
 * 0.2 mm. In folded water it cycles; halved steps end that. */
static inline float find_rest(const waves_reading *r, float footprint_m, float displacement[2])
{
    enum { FULL_STEPS = 6, MAX_STEPS = 12 };
    float close = fmaxf(0.02f * footprint_m, 2e-4f);
    heave h = {0.0f, 0.0f, 0.0f};
    for (int i = 0; i < MAX_STEPS; i++) {
        h = heave_from(r, r->count, displacement);
        float dx = h.x - displacement[0], dz = h.z - displacement[1];
        float share = i < FULL_STEPS ? 1.0f : 0.5f;
        displacement[0] += share * dx;
        displacement[1] += share * dz;
        if (dx * dx + dz * dz <= close * close)
            break;
    }
    return h.height;
}

float waves_height_near(const waves *w, double X, double Z, float footprint_m, float displacement[2])
{
    waves_reading r = waves_reading_of(w, X, Z, footprint_m);
    return find_rest(&r, footprint_m, displacement) + w->level_m;
}

float waves_height(const waves *w, double X, double Z, float footprint_m)
{
    waves_reading r = waves_reading_of(w, X, Z, footprint_m);
    float displacement[2] = {0.0f, 0.0f};
    guess_rest(&r, displacement);
    return find_rest(&r, footprint_m, displacement) + w->level_m;
}

wave_point waves_above(const waves *w, double X, double Z, float footprint_m, double rest[2])
{
    waves_reading r = waves_reading_of(w, X, Z, footprint_m);
    float displacement[2] = {0.0f, 0.0f};
    guess_rest(&r, displacement);
    find_rest(&r, footprint_m, displacement);
    wave_point p = waves_reading_point(&r, displacement);
    for (int i = 0; i < 8 && r.count && r.tiles[0].cubic > 0.0f; i++) { /* the difference that cubics make */
        float dx = p.displacement[0] - displacement[0], dz = p.displacement[1] - displacement[1];
        if (dx * dx + dz * dz < 1e-8f)
            break;
        displacement[0] = p.displacement[0];
        displacement[1] = p.displacement[1];
        p = waves_reading_point(&r, displacement);
    }
    rest[0] = X - (double)displacement[0];
    rest[1] = Z - (double)displacement[1];
    return p;
}

/* ---- bounds ---- */

static void add_bounds(wave_bounds *sum, const wave_bounds *b, float scale)
{
    sum->highest += scale * b->highest;
    sum->lowest += scale * b->lowest;
    sum->steepest += scale * b->steepest;
    sum->farthest += scale * b->farthest;
}

/* A blend of two levels is bounded by the finer one; one of patches, whose squared weights sum to 1, by
 * sqrt(3) times the tile. */
wave_bounds waves_bounds(const waves *w, float footprint_m)
{
    wave_bounds sum = {w->level_m, w->level_m, 0.0f, 0.0f};
    wave_tile_reading r;
    for (uint32_t i = 0; i < w->tile_count; i++)
        if (read_at(&r, &w->tiles[i], 0.0, 0.0, footprint_m))
            add_bounds(&sum, &w->tiles[i].bounds[r.level], w->tiles[i].is_patched ? 1.7320508f : 1.0f);
    return sum;
}

/* ---- patches ---- */

uint32_t wave_patches_at(const waves *w, uint32_t tile, double x, double z, wave_patch out[WAVES_MAX_PATCHES])
{
    const wave_tile *t = &w->tiles[tile];
    if (!t->is_patched) {
        out[0] = (wave_patch){1.0f, 0, 0};
        return 1;
    }
    wave_rhombus at = wave_rhombus_at(t, x, z);
    vec3 weights = wave_patch_weights(vec2(at.a, at.b));
    int64_t upper = at.a + at.b > 1.0f; /* of the two triangles of a rhombus */
    int64_t corners[WAVES_MAX_PATCHES][2] = {
        {at.i + upper, at.j + upper}, {at.i, at.j + 1}, {at.i + 1, at.j}};
    uint32_t count = 0;
    for (int c = 0; c < WAVES_MAX_PATCHES; c++) {
        if (weights[c] <= 0.0f)
            continue;
        uint64_t hash = wave_patch_hash(w->seed + tile, corners[c][0], corners[c][1]);
        out[count++] = (wave_patch){weights[c], (uint32_t)hash & (t->size - 1u),
                                    (uint32_t)(hash >> 32) & (t->size - 1u)};
    }
    return count;
}

/* ---- the shape of the surface ---- */

wave_shape wave_shape_of(const wave_point *p)
{
    vec3 D = vec3(p->Dxx, p->Dzz, p->Dxz);
    vec3 N = wave_normal(vec2(p->slope[0], p->slope[1]), D);
    return (wave_shape){{N[0], N[1], N[2]}, wave_jacobian(D), -(p->Dxx + p->Dzz)};
}

float foam_coverage(const foam_rule *r, float mean, float variance, float threshold)
{
    (void)r;
    return threshold < INFINITY ? foam_share(mean, variance, threshold) : 0.0f;
}

float wave_foam_lace(float share, float mean, float variance)
{
    return foam_lace(share, mean, variance);
}

float wave_inverse_normal(float u)
{
    return inverse_normal(u);
}

/* ---- velocity ---- */

static const double FARTHEST = 0x1p40; /* m */

enum { MAX_REACH = 1 << (WAVES_MAX_LEVELS - 2) };

/* e^(i n phase), n from 0 to reach. */
static void powers_of(double phase, int32_t reach, double out[][2])
{
    for (int32_t n = 0; n <= reach; n++) {
        out[n][0] = cos(n * phase);
        out[n][1] = sin(n * phase);
    }
}

/* Twice the real part of the sum over half of the plane; (u, v): position in tile lengths. */
static double tile_velocity(const wave_amplitudes *a, double u, double v)
{
    double x[MAX_REACH + 1][2], z[MAX_REACH + 1][2], sum = 0.0;
    powers_of(6.28318530717958647693 * (u - floor(u)), a->reach, x);
    powers_of(6.28318530717958647693 * (v - floor(v)), a->reach, z);
    for (size_t i = 0; i < a->count; i++) {
        const wave_mode *m = &a->modes[i];
        const double *ex = x[m->n_x < 0 ? -m->n_x : m->n_x], *ez = z[m->n_z];
        double sx = m->n_x < 0 ? -ex[1] : ex[1];
        double c = ex[0] * ez[0] - sx * ez[1], s = ex[0] * ez[1] + sx * ez[0];
        sum += (double)a->rate[i][0] * c - (double)a->rate[i][1] * s;
    }
    return 2.0 * sum;
}

double waves_velocity(const waves *w, double x, double z)
{
    double sum = 0.0;
    if (!(fabs(x) < FARTHEST && fabs(z) < FARTHEST))
        x = z = 0.0;
    for (uint32_t i = 0; i < w->tile_count; i++) {
        const wave_tile *t = &w->tiles[i];
        double u = (x * t->cos_per_m + z * t->sin_per_m) / t->size;
        double v = (z * t->cos_per_m - x * t->sin_per_m) / t->size;
        wave_patch patches[WAVES_MAX_PATCHES];
        uint32_t patch_count = wave_patches_at(w, i, x, z, patches);
        for (uint32_t p = 0; p < patch_count; p++)
            sum += (double)patches[p].weight * tile_velocity(w->amplitudes[i],
                                                             u + (double)patches[p].u / t->size,
                                                             v + (double)patches[p].v / t->size);
    }
    return sum;
}
