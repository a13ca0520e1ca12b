/* waves_query.c - reads tiles: sums of all at a place at rest, and which water is above or below a place of the world.
 *
 * A tile is read as a square of the footprint's width sees it: from two neighbouring levels of means, mixed, each interpolated
 * linearly between four texels. Level l is as it is where a texel is as wide as the footprint. slope_filter.c knows
 * the variance that this leaves. */
#include "ocean/waves.h"

#include <math.h>

/* Half of a texel: displacement, height and one slope; or the other slope and the derivatives. */
typedef float float4 __attribute__((vector_size(16), may_alias));

/* How a footprint reads the tiles; levels beyond the last are those of nothing. */
typedef struct tile_reading {
    const wave_tile *tile;
    uint32_t level;
    float mix; /* of the next level, [0, 1) */
} tile_reading;

typedef struct reading {
    tile_reading tiles[WAVES_MAX_TILES];
    uint32_t count;
} reading;

/* The share of the next level is linear in the footprint: no logarithm, and no jump. */
static inline reading reading_of(const waves *w, float footprint_m)
{
    reading r;
    r.count = 0;
    for (uint32_t i = 0; i < w->tile_count; i++) {
        const wave_tile *t = &w->tiles[i];
        float texels = footprint_m * (float)t->samples_per_m;
        uint32_t level = 0;
        while (texels >= 2.0f && level < t->level_count) {
            texels *= 0.5f;
            level++;
        }
        if (level + 1 < t->level_count) /* the last level is the mean, 0 */
            r.tiles[r.count++] = (tile_reading){t, level, texels > 1.0f ? texels - 1.0f : 0.0f};
    }
    return r;
}

/* A place in samples of level 0, wrapped to [0, size]. In double, so that it is exact a thousand kilometres away. */
static inline float wrapped(double samples, uint32_t size)
{
    if (!(fabs(samples) < 0x1p52))
        return 0.0f;
    int64_t whole = (int64_t)samples;
    whole -= samples < (double)whole;
    return (float)(whole & (int64_t)(size - 1)) + (float)(samples - (double)whole);
}

/* Four texels of a level and their weights. Texel i of level l is the mean of samples 2^l i to 2^l (i + 1) - 1. */
typedef struct taps {
    const float *texels[4];
    float weights[4];
} taps;

static inline taps taps_at(const wave_tile *t, uint32_t level, float x, float z)
{
    float scale = 1.0f / (float)(1u << level);
    float offset = 0.5f * scale + 0.5f; /* -0.5 + 0.5 scale, and 1 so that truncation rounds down */
    float px = x * scale + offset, pz = z * scale + offset;
    uint32_t mask = (t->size >> level) - 1u;
    uint32_t ix = (uint32_t)px, iz = (uint32_t)pz;
    float fx = px - (float)ix, fz = pz - (float)iz;
    uint32_t x0 = (ix - 1u) & mask, x1 = ix & mask;
    const float *texels = t->levels[level];
    size_t edge = (size_t)mask + 1;
    const float *row0 = texels + ((iz - 1u) & mask) * edge * WAVE_FIELDS;
    const float *row1 = texels + (iz & mask) * edge * WAVE_FIELDS;
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

/* DX, ETA, DZ, ETA_X of one tile; rest (NULL: not wanted): the other four. */
static inline float4 read_tile(const tile_reading *r, double x, double z, float4 *rest)
{
    const wave_tile *t = r->tile;
    float u = wrapped(x * t->cos_per_m + z * t->sin_per_m, t->size);
    float v = wrapped(z * t->cos_per_m - x * t->sin_per_m, t->size);
    taps p = taps_at(t, r->level, u, v);
    float4 low = weighted(&p, 0);
    if (rest)
        *rest = weighted(&p, 4);
    if (r->mix > 0.0f) {
        taps q = taps_at(t, r->level + 1, u, v);
        low += r->mix * (weighted(&q, 0) - low);
        if (rest)
            *rest += r->mix * (weighted(&q, 4) - *rest);
    }
    return low;
}

/* Displacement in the world and height. */
typedef struct heave {
    float x, z, height;
} heave;

static inline heave heave_at(const reading *r, double x, double z)
{
    heave sum = {0.0f, 0.0f, 0.0f};
    for (uint32_t i = 0; i < r->count; i++) {
        const wave_tile *t = r->tiles[i].tile;
        float4 low = read_tile(&r->tiles[i], x, z, NULL);
        sum.x += t->cos_turn * low[WAVE_DX] - t->sin_turn * low[WAVE_DZ];
        sum.z += t->sin_turn * low[WAVE_DX] + t->cos_turn * low[WAVE_DZ];
        sum.height += low[WAVE_ETA];
    }
    return sum;
}

static void add_tile(wave_point *p, const tile_reading *r, double x, double z)
{
    float c = r->tile->cos_turn, s = r->tile->sin_turn;
    float4 high, low = read_tile(r, x, z, &high);
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

static wave_point point_at(const waves *w, const reading *r, double x, double z)
{
    wave_point p = {.height_m = w->level_m};
    for (uint32_t i = 0; i < r->count; i++)
        add_tile(&p, &r->tiles[i], x, z);
    return p;
}

wave_point waves_at(const waves *w, double x, double z, float footprint_m)
{
    reading r = reading_of(w, footprint_m);
    return point_at(w, &r, x, z);
}

/* ---- above a place ---- */

/* x <- X - D(x): the error shrinks by about the root of the slope variance with each step, by less in steep places. It ends where
 * water moves by less than a hundredth of the footprint or 0.1 mm. Folded water goes round in circles; halved steps end that. */
static heave find_rest(const reading *r, double X, double Z, float footprint_m, float displacement[2])
{
    enum { FULL_STEPS = 6, MOST_STEPS = 12 };
    float close = fmaxf(0.01f * footprint_m, 1e-4f);
    heave h = {0.0f, 0.0f, 0.0f};
    for (int i = 0; i < MOST_STEPS; i++) {
        h = heave_at(r, X - (double)displacement[0], Z - (double)displacement[1]);
        float dx = h.x - displacement[0], dz = h.z - displacement[1];
        float share = i < FULL_STEPS ? 1.0f : 0.5f;
        displacement[0] += share * dx;
        displacement[1] += share * dz;
        if (dx * dx + dz * dz <= close * close)
            break;
    }
    return h;
}

float waves_height_near(const waves *w, double X, double Z, float footprint_m, float displacement[2])
{
    reading r = reading_of(w, footprint_m);
    return find_rest(&r, X, Z, footprint_m, displacement).height + w->level_m;
}

float waves_height(const waves *w, double X, double Z, float footprint_m)
{
    float displacement[2] = {0.0f, 0.0f};
    return waves_height_near(w, X, Z, footprint_m, displacement);
}

wave_point waves_above(const waves *w, double X, double Z, float footprint_m, double rest[2])
{
    reading r = reading_of(w, footprint_m);
    float displacement[2] = {0.0f, 0.0f};
    find_rest(&r, X, Z, footprint_m, displacement);
    rest[0] = X - (double)displacement[0];
    rest[1] = Z - (double)displacement[1];
    return point_at(w, &r, rest[0], rest[1]);
}

/* ---- bounds ---- */

wave_bounds waves_bounds(const waves *w, float footprint_m)
{
    reading r = reading_of(w, footprint_m);
    wave_bounds sum = {w->level_m, w->level_m, 0.0f, 0.0f};
    for (uint32_t i = 0; i < r.count; i++) { /* a mix of two levels lies within the finer */
        const wave_bounds *b = &r.tiles[i].tile->bounds[r.tiles[i].level];
        sum.highest += b->highest;
        sum.lowest += b->lowest;
        sum.steepest += b->steepest;
        sum.farthest += b->farthest;
    }
    return sum;
}

/* ---- shape ---- */

/* The displaced surface is (x + D_x, eta, z + D_z) over (x, z); its normal is the cross product of its derivatives. Where it is
 * folded, or nearly, its Jacobian counts as 0.02: the normal points up. */
wave_shape wave_shape_of(const wave_point *p)
{
    float a = p->Dxz, b = 1.0f + p->Dzz, c = 1.0f + p->Dxx;
    float J = b * c - a * a;
    float x = a * p->slope[1] - b * p->slope[0], y = J > 0.02f ? J : 0.02f,
          z = a * p->slope[0] - c * p->slope[1];
    float scale = 1.0f / sqrtf(x * x + y * y + z * z);
    return (wave_shape){{x * scale, y * scale, z * scale}, J, -(p->Dxx + p->Dzz)};
}
