/* foam_pattern.c - see foam_pattern.h. Fields are made by what they look like; then each value gives way to the number of the normal
 * distribution that as large a share is below. */
#include "ocean/foam_pattern.h"

#include <math.h>

#include "base/hash.h"
#include "base/parallel.h"

enum { RANKS = 4096, OCTAVES = 6 };

/* ---- noise ---- */

/* Of a place of a lattice, [0, 1). */
static float random_at(uint32_t x, uint32_t z, uint32_t stream)
{
    uint64_t h = mix64(((uint64_t)x << 32 | z) + (uint64_t)(stream + 1) * MIX64_STEP);
    return (float)(h >> 40) * 0x1p-24f;
}

static float smooth(float f)
{
    return f * f * f * (f * (6.0f * f - 15.0f) + 10.0f);
}

/* Over [0, 1)^2, which it repeats: random numbers on `cells` squared places, smooth between. Mean 0. */
static float noise(float u, float v, uint32_t cells, uint32_t stream)
{
    float x = u * (float)cells, z = v * (float)cells;
    uint32_t ix = (uint32_t)x % cells, iz = (uint32_t)z % cells, jx = (ix + 1) % cells, jz = (iz + 1) % cells;
    float fx = smooth(x - floorf(x)), fz = smooth(z - floorf(z));
    float a = random_at(ix, iz, stream), b = random_at(jx, iz, stream);
    float c = random_at(ix, jz, stream), d = random_at(jx, jz, stream);
    return a + fx * (b - a) + fz * (c - a + fx * (a - b - c + d)) - 0.5f;
}

/* Octaves from `cells` on, each of `fall` times the amplitude of the one before. */
static float clouds(float u, float v, uint32_t cells, uint32_t octaves, float fall, uint32_t stream)
{
    float sum = 0.0f, amplitude = 1.0f;
    for (uint32_t i = 0; i < octaves; i++, cells *= 2, amplitude *= fall)
        sum += amplitude * noise(u, v, cells, stream + i);
    return sum;
}

/* ---- fields ---- */

/* Middles of cells: places in their square of the lattice, and by how much each counts as nearer. */
enum { MOST_CELLS = (1 << (WAVES_MAX_LEVELS - 1)) / FOAM_CELL_SAMPLES };
typedef struct middle {
    float x, z, nearer;
} middle;

typedef struct drawing {
    foam_plane *plane;
    bool is_cells;
    uint32_t cells; /* along an edge */
    middle middles[MOST_CELLS * MOST_CELLS];
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

/* By how much the second nearest middle is farther than the nearest, in cells: 0 on borders. What is larger counts as nearer: cells of many
 * sizes with round borders, as bubbles in a raft have. */
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
            /* Borders are no straight lines, and of no one width. */
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
