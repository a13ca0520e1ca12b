/* sampler.c - see sampler.h: the pairs of a vertex together, in lanes. */
#include "base/simd.h"

#include "path/sampler.h"

enum { PAIRS = PATH_SAMPLER_PAIRS };

/* sobol_scrambled() of four points in as many orders, the first of which has number first. No branches, and
 * one function a loop: it vectorises. */
DISPATCH_AVX2 static void scramble_pairs(uint32_t index, uint32_t first, uint32_t group, float *restrict x,
                                         float *restrict y)
{
    uint32_t seeds[PAIRS];
    uint32_t indices[PAIRS];
    for (uint32_t i = 0; i < PAIRS; i++)
        seeds[i] = hash_uint(group + first + i + 1);
    for (uint32_t i = 0; i < PAIRS; i++)
        indices[i] = sobol_order(index, path_sampler_orders[first + i]);
    for (uint32_t i = 0; i < PAIRS; i++)
        x[i] = sobol_scrambled_first(indices[i], seeds[i]);
    for (uint32_t i = 0; i < PAIRS; i++)
        y[i] = sobol_scrambled_second(indices[i], seeds[i]);
}

void path_sampler_vertex_pairs(path_sampler *s, vec2 pairs[PATH_SAMPLER_PAIRS])
{
    float x[PAIRS];
    float y[PAIRS];
    scramble_pairs(s->shuffled, s->vertex % PATH_SAMPLER_VERTICES * PAIRS, s->group, x, y);
    for (int i = 0; i < PAIRS; i++)
        pairs[i] = vec2(x[i], y[i]);
    s->dimension = PAIRS;
}
