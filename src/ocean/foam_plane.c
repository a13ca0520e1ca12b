/* foam_plane.c - see foam_plane.h. Fields are shaped for their look, then mapped to normally distributed
 * values by rank. */

#include <math.h>

#include "base/hash.h"
#include "base/parallel.h"
#include "ocean/foam_plane.h"
#include "base/memory.h"

enum { RANKS = 4096, OCTAVES = 6 };

/* ---- noise ---- */

/* Random value of a lattice point, [0, 1). */
static float random_at(uint32_t x, uint32_t z, uint32_t stream)
{
    uint64_t h = mix64(((uint64_t)x << 32 | z) + (uint64_t)(stream + 1) * MIX64_STEP);
    return (float)(h >> 40) * 0x1p-24f;
}

static float smooth(float f)
{
    return f * f * f * (f * (6.0f * f - 15.0f) + 10.0f);
}

/* Tiling value noise over [0, 1)^2 on cells^2 lattice points. Mean 0. */
static float noise(float u, float v, uint32_t cells, uint32_t stream)
{
    float x = u * (float)cells, z = v * (float)cells;
    uint32_t ix = (uint32_t)x % cells, iz = (uint32_t)z % cells, jx = (ix + 1) % cells, jz = (iz + 1) % cells;
    float fx = smooth(x - floorf(x)), fz = smooth(z - floorf(z));
    float a = random_at(ix, iz, stream), b = random_at(jx, iz, stream);
    float c = random_at(ix, jz, stream), d = random_at(jx, jz, stream);
    return a + fx * (b - a) + fz * (c - a + fx * (a - b - c + d)) - 0.5f;
}

/* Octaves from `cells` on, each with `fall` times the amplitude of the previous one. */
static float clouds(float u, float v, uint32_t cells, uint32_t octaves, float fall, uint32_t stream)
{
    float sum = 0.0f, amplitude = 1.0f;
    for (uint32_t i = 0; i < octaves; i++, cells *= 2, amplitude *= fall)
        sum += amplitude * noise(u, v, cells, stream + i);
    return sum;
}

/* ---- fields ---- */

/* Cell centers: positions in their lattice square, and an offset by which each counts as nearer. */
enum { MAX_CELLS = (1 << (WAVES_MAX_LEVELS - 1)) / FOAM_CELL_SAMPLES };
typedef struct middle {
    float x, z, nearer;
} middle;

typedef struct drawing {
    foam_plane *plane;
    bool is_cells;
    uint32_t cells; /* along an edge */
    middle middles[MAX_CELLS * MAX_CELLS];
} drawing;

static void place_middles(drawing *d)
{
    for (uint32_t j = 0; j < d->cells; j++)
        for (uint32_t i = 0; i < d->cells; i++) {
            float size = random_at(i, j, 102);
            d->middles[j * d->cells + i] =
                (middle){random_at(i, j, 100), random_at(i, j, 101), 0.75f * size * size};
        }
}

/* Distance to the second nearest center minus that to the nearest, in cells: 0 on borders. The offset makes
 * cells of many sizes with round borders, as of bubbles in a raft. */
static float cell_border(const drawing *d, float x, float z)
{
    int32_t ix = (int32_t)floorf(x), iz = (int32_t)floorf(z), n = (int32_t)d->cells;
    float least = 1e9f, second = 1e9f;
    for (int32_t j = iz - 2; j <= iz + 2; j++)
        for (int32_t i = ix - 2; i <= ix + 2; i++) {
            const middle *m = &d->middles[(j + 2 * n) % n * n + (i + 2 * n) % n];
            float dx = (float)i + m->x - x, dz = (float)j + m->z - z;
            float distance = sqrtf(dx * dx + dz * dz) - m->nearer;
            second = fminf(second, fmaxf(distance, least));
            least = fminf(least, distance);
        }
    return second - least;
}

static void draw(void *context, size_t begin, size_t end)
{
    const drawing *d = context;
    uint32_t size = d->plane->size, cells = d->cells;
    for (size_t row = begin; row < end; row++)
        for (size_t column = 0; column < size; column++) {
            float u = (float)column / (float)size, v = (float)row / (float)size;
            float *out = &d->plane->levels[0][row * size + column];
            if (!d->is_cells) {
                *out = clouds(u, v, 4, OCTAVES, 0.72f, 0);
                continue;
            }
            /* Distorts borders, and varies their width. */
            float x = u * (float)cells + 1.1f * clouds(u, v, cells, 3, 0.55f, 10),
                  z = v * (float)cells + 1.1f * clouds(u, v, cells, 3, 0.55f, 20);
            *out = 0.7f * clouds(u, v, cells / 2, 4, 0.7f, 30) - cell_border(d, x, z);
        }
}

/* ---- distribution ---- */

typedef struct ranking {
    float *values, from, scale, normal[RANKS + 1];
} ranking;

static void replace(void *context, size_t begin, size_t end)
{
    const ranking *r = context;
    for (size_t i = begin; i < end; i++) {
        float place = fminf(fmaxf((r->values[i] - r->from) * r->scale, 0.0f), (float)RANKS - 0.001f);
        uint32_t at = (uint32_t)place;
        r->values[i] = r->normal[at] + (place - (float)at) * (r->normal[at + 1] - r->normal[at]);
    }
}

static void make_normal(float *values, size_t count, uint32_t thread_count)
{
    ranking r = {.values = values};
    uint32_t counts[RANKS] = {0};
    float to = values[0];
    r.from = values[0];
    for (size_t i = 0; i < count; i++) {
        r.from = fminf(r.from, values[i]);
        to = fmaxf(to, values[i]);
    }
    r.scale = to > r.from ? (float)RANKS / (to - r.from) : 0.0f;
    for (size_t i = 0; i < count; i++)
        counts[(uint32_t)fminf((values[i] - r.from) * r.scale, (float)RANKS - 1.0f)]++;
    double below = 0.0, half = 0.5 / (double)count;
    for (uint32_t i = 0; i <= RANKS; i++) {
        r.normal[i] = wave_inverse_normal((float)fmin(fmax(below, half), 1.0 - half));
        below += i < RANKS ? (double)counts[i] / (double)count : 0.0;
    }
    parallel_for(thread_count, count, 16384, replace, &r);
}

static void make(foam_plane *p, bool is_cells, uint32_t thread_count)
{
    drawing d = {.plane = p, .is_cells = is_cells, .cells = p->size / FOAM_CELL_SAMPLES};
    d.cells = d.cells > 2 ? d.cells : 2;
    place_middles(&d);
    parallel_for(thread_count, p->size, 8, draw, &d);
    make_normal(p->levels[0], (size_t)p->size * p->size, thread_count);
    foam_plane_reduce(p);
}

void foam_pattern_cells(foam_plane *p, uint32_t thread_count)
{
    make(p, true, thread_count);
}

void foam_pattern_clouds(foam_plane *p, uint32_t thread_count)
{
    make(p, false, thread_count);
}

/* ---- planes ---- */

bool foam_plane_create(const facet_allocator *allocator, uint32_t size, foam_plane *p)
{
    p->size = size;
    while (size >> p->level_count) {
        size_t edge = size >> p->level_count;
        p->levels[p->level_count] = mem_zalloc(allocator, edge * edge, sizeof(float));
        if (!p->levels[p->level_count])
            return false;
        p->level_count++;
    }
    return true;
}

void foam_plane_destroy(foam_plane *p)
{
    for (uint32_t l = 0; l < WAVES_MAX_LEVELS; l++)
        mem_free(p->levels[l]);
}

static double mean_square(const float *values, size_t count)
{
    double sum = 0.0;
    for (size_t i = 0; i < count; i++)
        sum += (double)values[i] * (double)values[i];
    return sum / (double)count;
}

/* Variance between texels under linear interpolation: contains products of neighbors. */
static double mean_square_between(const float *values, size_t edge)
{
    double same = 0.0, beside = 0.0, across = 0.0;
    for (size_t z = 0; z < edge; z++) {
        const float *row = values + z * edge, *next = values + (z + 1) % edge * edge;
        for (size_t x = 0; x < edge; x++) {
            size_t right = x + 1 < edge ? x + 1 : 0;
            double here = (double)row[x];
            same += here * here;
            beside += here * (double)(row[right] + next[x]);
            across += here * (double)next[right] + (double)row[right] * (double)next[x];
        }
    }
    return (4.0 * same + 2.0 * beside + 0.5 * across) / (9.0 * (double)(edge * edge));
}

void foam_plane_reduce(foam_plane *p)
{
    double all = mean_square(p->levels[0], (size_t)p->size * p->size);
    for (uint32_t l = 1; l < p->level_count; l++) {
        size_t edge = p->size >> l;
        for (size_t z = 0; z < edge; z++)
            for (size_t x = 0; x < edge; x++) {
                const float *from = p->levels[l - 1] + 4 * z * edge + 2 * x;
                p->levels[l][z * edge + x] =
                    0.25f * (from[0] + from[1] + from[2 * edge] + from[2 * edge + 1]);
            }
    }
    for (uint32_t l = 0; l < p->level_count; l++)
        p->hidden[l] = (float)fmax(all - mean_square_between(p->levels[l], p->size >> l), 0.0);
}

static float plane_texel(const foam_plane *p, uint32_t level, double u, double v)
{
    double scale = 1.0 / (double)(1u << level), offset = 0.5 * scale - 0.5;
    double x = u * scale + offset, z = v * scale + offset;
    if (!(fabs(x) < 0x1p52 && fabs(z) < 0x1p52))
        return 0.0f;
    double x0 = floor(x), z0 = floor(z);
    float fx = (float)(x - x0), fz = (float)(z - z0);
    size_t edge = p->size >> level, mask = edge - 1;
    size_t ix = (size_t)(int64_t)x0 & mask, iz = (size_t)(int64_t)z0 & mask;
    const float *row0 = p->levels[level] + iz * edge, *row1 = p->levels[level] + ((iz + 1) & mask) * edge;
    float a = row0[ix] + fx * (row0[(ix + 1) & mask] - row0[ix]);
    float b = row1[ix] + fx * (row1[(ix + 1) & mask] - row1[ix]);
    return a + fz * (b - a);
}

foam_plane_value foam_plane_read(const foam_plane *p, double u, double v, float texels)
{
    uint32_t level = 0;
    while (texels >= 1.41421356f && level + 1 < p->level_count) {
        texels *= 0.5f;
        level++;
    }
    return (foam_plane_value){plane_texel(p, level, u, v), p->hidden[level]};
}
