/* foam_plane.c - see foam_plane.h. */
#include "ocean/foam_plane.h"

#include <math.h>

#include "base/memory.h"

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

/* Of what lies between texels, interpolated linearly: products of neighbours are in it. */
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
