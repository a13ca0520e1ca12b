/* water_crests.c - see water_crests.h. A level is made of samples of the tile at rest (of squares of them, the highest of each), which go to the cell
 * that their water has moved to. */
#include "water/water_crests.h"

#include <math.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "ocean/wave_patches.h"

enum { SAMPLES_PER_CELL = 4, CELLS = CRESTS_SIZE * CRESTS_SIZE, FINEST_TILE = 256, LEAST_TILE = 64 };

/* How far, in squares of samples, what is read at a place may lie from where its water goes: neighbours at rest are as far apart
 * as that, and their displacements differ by less than 0.7 of their distance, or the sea would be folded everywhere. */
static const double STRAIN = 1.7;
/* Patches of the tile blend: over a square of samples of level 0 their weights change by as much. */
static const float BLEND_PER_SQUARE = 0.02f;

typedef struct filling {
    const waves *w;
    water_crests *crests;
    float *squares[CRESTS_LEVELS]; /* highest ETA of squares of samples of the tile */
    uint32_t base;                 /* log2 of the samples along an edge of a square of level 0 */
    float *own;                    /* as crests->highest, without neighbours */
} filling;

/* ---- squares of the tile ---- */

static inline float higher(float a, float b)
{
    return a > b ? a : b;
}

static void fill_squares(const filling *f)
{
    const wave_tile *t = &f->w->tiles[0];
    uint32_t size = t->size >> f->base, step = 1u << f->base;
    for (uint32_t z = 0; z < size; z++)
        for (uint32_t x = 0; x < size; x++) {
            float highest = -INFINITY;
            for (uint32_t j = 0; j < step; j++)
                for (uint32_t i = 0; i < step; i++) {
                    size_t sample = (size_t)(z * step + j) * t->size + (x * step + i);
                    highest = higher(highest, t->levels[0][sample * WAVE_FIELDS + WAVE_ETA]);
                }
            f->squares[0][z * size + x] = highest;
        }
    for (uint32_t l = 1; l < CRESTS_LEVELS; l++) {
        uint32_t half = size / 2;
        for (uint32_t z = 0; z < half; z++)
            for (uint32_t x = 0; x < half; x++) {
                const float *p = f->squares[l - 1] + (size_t)2 * z * size + 2 * x;
                f->squares[l][z * half + x] = higher(higher(p[0], p[1]), higher(p[size], p[size + 1]));
            }
        size = half;
    }
}

/* ---- a level ---- */

/* Highest of the squares that a patch lays over the one at (x, z): its own squares need not lie on the same lines. */
static float square_at(const filling *f, uint32_t level, int64_t x, int64_t z, const wave_patch *p)
{
    uint32_t shift = f->base + level, size = f->w->tiles[0].size >> shift, mask = size - 1;
    uint32_t odd = ((1u << shift) - 1u);
    const float *squares = f->squares[level];
    uint32_t x0 = (uint32_t)(x + (p->u >> shift)) & mask, z0 = (uint32_t)(z + (p->v >> shift)) & mask;
    uint32_t x1 = p->u & odd ? (x0 + 1) & mask : x0, z1 = p->v & odd ? (z0 + 1) & mask : z0;
    return higher(higher(squares[z0 * size + x0], squares[z0 * size + x1]),
                  higher(squares[z1 * size + x0], squares[z1 * size + x1]));
}

/* Puts a square's height into the cell that the water in its middle has moved to. */
static void place_square(const filling *f, uint32_t level, int64_t x, int64_t z)
{
    const wave_tile *t = &f->w->tiles[0];
    double samples = (double)(1u << (f->base + level)), u = (double)x * samples, v = (double)z * samples;
    double scale = t->length_m / t->size, c = (double)t->cos_turn, s = (double)t->sin_turn;
    double middle = 0.5 * (samples - 1.0);
    double X = (c * (u + middle) - s * (v + middle)) * scale,
           Z = (s * (u + middle) + c * (v + middle)) * scale;
    wave_patch patches[WAVES_MAX_PATCHES];
    uint32_t count = wave_patches_at(f->w, X, Z, patches), mask = t->size - 1;
    float height = 0.0f, dx = 0.0f, dz = 0.0f;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t column = (uint32_t)((int64_t)(u + middle) + patches[i].u) & mask;
        uint32_t row = (uint32_t)((int64_t)(v + middle) + patches[i].v) & mask;
        const float *texel = t->levels[0] + ((size_t)row * t->size + column) * WAVE_FIELDS;
        height += patches[i].weight * square_at(f, level, x, z, &patches[i]);
        dx += patches[i].weight * texel[WAVE_DX];
        dz += patches[i].weight * texel[WAVE_DZ];
    }
    height += fabsf(height) * BLEND_PER_SQUARE * (float)(1u << level);
    double per_cell = 1.0 / (SAMPLES_PER_CELL * samples);
    int64_t cu = (int64_t)floor((u + middle + (double)dx / scale) * per_cell) - f->crests->first[level][0];
    int64_t cv = (int64_t)floor((v + middle + (double)dz / scale) * per_cell) - f->crests->first[level][1];
    if (cu < 0 || cv < 0 || cu >= CRESTS_SIZE || cv >= CRESTS_SIZE)
        return;
    float *cell = f->own + (size_t)level * CELLS + (size_t)cv * CRESTS_SIZE + (size_t)cu;
    *cell = higher(*cell, height);
}

/* Cells of the border have no neighbours, and are as if anything might be there. */
static void spread(const float *own, float *out)
{
    for (int z = 0; z < CRESTS_SIZE; z++)
        for (int x = 0; x < CRESTS_SIZE; x++) {
            bool is_border = x < 2 || z < 2 || x >= CRESTS_SIZE - 2 || z >= CRESTS_SIZE - 2;
            float highest = is_border ? INFINITY : -INFINITY;
            for (int i = 0; i < 9 && !is_border; i++)
                highest = higher(highest, own[(z + i / 3 - 1) * CRESTS_SIZE + (x + i % 3 - 1)]);
            out[z * CRESTS_SIZE + x] = highest;
        }
}

static void fill_levels(void *context, size_t begin, size_t end)
{
    const filling *f = context;
    for (size_t l = begin; l < end; l++) {
        uint32_t level = (uint32_t)l;
        float *own = f->own + l * CELLS;
        for (int i = 0; i < CELLS; i++)
            own[i] = -INFINITY;
        const int64_t *first = f->crests->first[level];
        for (int64_t z = 0; z < SAMPLES_PER_CELL * CRESTS_SIZE; z++)
            for (int64_t x = 0; x < SAMPLES_PER_CELL * CRESTS_SIZE; x++)
                place_square(f, level, first[0] * SAMPLES_PER_CELL + x, first[1] * SAMPLES_PER_CELL + z);
        spread(own, f->crests->highest + l * CELLS);
    }
}

/* ---- making ---- */

static void place_levels(const waves *w, double X, double Z, uint32_t base, water_crests *c)
{
    const wave_tile *t = &w->tiles[0];
    c->cell_m = t->length_m / t->size * SAMPLES_PER_CELL * (double)(1u << base);
    c->cells_per_m[0] = (double)t->cos_turn / c->cell_m;
    c->cells_per_m[1] = (double)t->sin_turn / c->cell_m;
    double u = X * c->cells_per_m[0] + Z * c->cells_per_m[1],
           v = Z * c->cells_per_m[0] - X * c->cells_per_m[1];
    for (int l = 0; l < CRESTS_LEVELS; l++) {
        double cell = (double)(1u << l);
        c->first[l][0] = (int64_t)floor(u / cell) - CRESTS_SIZE / 2;
        c->first[l][1] = (int64_t)floor(v / cell) - CRESTS_SIZE / 2;
    }
}

facet_result water_crests_create(const waves *w, double X, double Z, const facet_allocator *allocator,
                                 water_crests *c, facet_error *error)
{
    *c = (water_crests){.highest = NULL};
    if (w->tile_count == 0 || w->tiles[0].size < LEAST_TILE || !(fabs(X) < 1e9 && fabs(Z) < 1e9))
        return FACET_OK;
    filling f = {.w = w, .crests = c};
    while ((w->tiles[0].size >> f.base) > FINEST_TILE)
        f.base++;
    size_t edge = w->tiles[0].size >> f.base, squares = 0;
    for (int l = 0; l < CRESTS_LEVELS; l++)
        squares += (edge >> l) * (edge >> l);
    float *all = mem_alloc(allocator, squares + (size_t)CRESTS_LEVELS * CELLS, sizeof *all);
    c->highest = mem_alloc(allocator, (size_t)CRESTS_LEVELS * CELLS, sizeof *c->highest);
    if (!all || !c->highest) {
        mem_free(all);
        water_crests_destroy(c);
        return fail_memory(error, "crests of a sea", (squares + (size_t)CRESTS_LEVELS * CELLS) * sizeof *all);
    }
    f.own = all;
    f.squares[0] = all + (size_t)CRESTS_LEVELS * CELLS;
    for (int l = 1; l < CRESTS_LEVELS; l++)
        f.squares[l] = f.squares[l - 1] + (edge >> (l - 1)) * (edge >> (l - 1));
    place_levels(w, X, Z, f.base, c);
    fill_squares(&f);
    parallel_for(w->thread_count, CRESTS_LEVELS, 1, fill_levels, &f);
    mem_free(all);
    return FACET_OK;
}

void water_crests_destroy(water_crests *c)
{
    mem_free(c->highest);
    *c = (water_crests){.highest = NULL};
}

/* ---- asking ---- */

/* A reading with texels of up to `texels` squares reaches 1.5 of them less a half to either side; and a square's own extent. */
uint32_t water_crests_level(const water_crests *c, float footprint_m, float farthest_m)
{
    if (!c->highest)
        return CRESTS_LEVELS;
    double square = c->cell_m / SAMPLES_PER_CELL, texels = 1.0;
    while (texels * square < (double)footprint_m && texels < 1024.0)
        texels *= 2.0;
    double reach = STRAIN * (1.5 * texels - 0.5) + (double)farthest_m / square;
    for (uint32_t l = 0; l < CRESTS_LEVELS; l++) {
        double extent = 0.5 * STRAIN * ((double)(1u << l) - 1.0);
        if (reach + extent <= SAMPLES_PER_CELL * (double)(1u << l))
            return l;
    }
    return CRESTS_LEVELS;
}

crests_ray water_crests_ray(const water_crests *c, const double o[3], const double d[3])
{
    const double *m = c->cells_per_m;
    return (crests_ray){o[0] * m[0] + o[2] * m[1], o[2] * m[0] - o[0] * m[1], d[0] * m[0] + d[2] * m[1],
                        d[2] * m[0] - d[0] * m[1]};
}

static inline double to_edge(double at, double cell, double speed)
{
    if (speed == 0.0)
        return INFINITY;
    return ((speed > 0.0 ? cell + 1.0 : cell) - at) / speed;
}

double water_crests_pass(const water_crests *c, const crests_ray *ray, double t, double y, double rise,
                         float others_m, uint32_t first_level)
{
    double u = ray->u + t * ray->du, v = ray->v + t * ray->dv, way = 0.0;
    for (uint32_t l = first_level; l < CRESTS_LEVELS; l++) {
        double scale = 1.0 / (double)(1u << l);
        double cu = floor(u * scale), cv = floor(v * scale);
        int64_t x = (int64_t)cu - c->first[l][0], z = (int64_t)cv - c->first[l][1];
        if (x < 0 || z < 0 || x >= CRESTS_SIZE || z >= CRESTS_SIZE)
            continue;
        float highest = c->highest[(size_t)l * CELLS + (size_t)z * CRESTS_SIZE + (size_t)x] + others_m;
        double above = y - (double)highest;
        if (!(above > 0.0))
            break;
        double edge = fmin(to_edge(u * scale, cu, ray->du * scale), to_edge(v * scale, cv, ray->dv * scale));
        way = fmax(way, rise < 0.0 ? fmin(edge, above / -rise) : edge);
    }
    return way;
}
