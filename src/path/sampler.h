/* sampler.h - the random numbers of one sample of one pixel, in pairs, each from an Owen-scrambled Sobol
 * sequence over the pixel's samples. They depend on seed, pixel, sample and dimension alone, so an image does
 * not depend on threads, tiles or interruptions.
 *
 * Sequences in one order would put all samples of a pixel on lines through its dimensions; in orders
 * shuffled at random, pairs are independent, and their product is as noisy as random numbers or worse. So
 * related pairs, the four of each of four vertices, traverse the sequence in 16 orders that were chosen
 * to make well distributed points of 32 dimensions: those of the first vertices most, each two of them,
 * for 16 samples and more. Further pairs are shuffled. */
#ifndef PATH_SAMPLER_H
#define PATH_SAMPLER_H

#include <math.h>
#include <stdint.h>
#include <string.h>

#include "shade/shade.h"

enum {
    PATH_SAMPLER_PAIRS = 4,    /* of a vertex, in the chosen orders; more are shuffled */
    PATH_SAMPLER_VERTICES = 4, /* that share a shuffle */
    PATH_SAMPLER_ORDERS = PATH_SAMPLER_PAIRS * PATH_SAMPLER_VERTICES
};

/* The parameters t of sobol_order(). Found by search over all with t < 10: for each two orders the
 * variance of products of functions of the four dimensions, each 1 and half a linear one, summed over 16,
 * 32, .. 1024 samples with a penalty on large ones; pairs weighted 4, 1, 1, 0.3 for the first vertex
 * (pixel, lens, ..), 4, 4, 4, 1 for the second, half and a quarter of that for the next. Where random
 * points have 4.06 / n, shuffled ones have 2.0 / n and these, averaged over all pairs of the 16, 1.9 / n
 * for 16 samples, 0.8 / n for 64, 0.24 / n for 256. */
static const uint32_t path_sampler_orders[PATH_SAMPLER_ORDERS] = {
    0x1f040302u, 0x07060401u, 0x05040201u, 0x09050301u, 0x1f1f1f09u, 0x1f1f0503u, 0x1f090402u, 0x05030201u,
    0x08050403u, 0x09060302u, 0x1f070602u, 0x07060201u, 0x1f1f0704u, 0x08040301u, 0x07060501u, 0x04030201u};

typedef struct path_sampler {
    uint32_t index;     /* of the sample in its pixel */
    uint32_t pixel;     /* hash of seed and place */
    uint32_t vertex;    /* of the path */
    uint32_t dimension; /* of its next pair */
    uint32_t group;     /* hash of the pixel and of the dimensions that share a shuffle */
    uint32_t shuffled;  /* index in the order of the group */
} path_sampler;

/* Switches to dimensions that are independent of those of any other number. */
static inline void path_sampler_shuffle(path_sampler *s, uint32_t number)
{
    s->group = hash_uint(s->pixel + number);
    s->shuffled = sobol_shuffle(s->index, s->group);
}

/* Goes to the first dimension of vertex number `vertex` of the path, so that its random numbers do not
 * depend on how many an earlier vertex took. Vertex 0: filter, lens, time. A vertex may take any number of
 * pairs. */
static inline void path_sampler_begin(path_sampler *s, uint32_t vertex)
{
    if (vertex / PATH_SAMPLER_VERTICES != s->vertex / PATH_SAMPLER_VERTICES ||
        s->dimension > PATH_SAMPLER_PAIRS)
        path_sampler_shuffle(s, vertex / PATH_SAMPLER_VERTICES);
    s->vertex = vertex;
    s->dimension = 0;
}

/* For sample number index of pixel (x, y) of the whole image, at vertex 0. */
static inline path_sampler path_sampler_start(uint32_t seed, uint32_t x, uint32_t y, uint32_t index)
{
    path_sampler s = {.index = index, .pixel = hash_uint(x + hash_uint(y + hash_uint(seed)))};
    path_sampler_shuffle(&s, 0);
    return s;
}

/* The pairs of one vertex that are in the chosen orders, the same as those of as many calls of
 * path_sampler_pair() after path_sampler_begin(), in a third of the time. */
void path_sampler_vertex_pairs(path_sampler *s, vec2 pairs[PATH_SAMPLER_PAIRS]);

/* A pair in [0, 1)^2, stratified with those of the pixel's other samples at this vertex and dimension. */
static inline vec2 path_sampler_pair(path_sampler *s)
{
    uint32_t order =
        s->vertex % PATH_SAMPLER_VERTICES * PATH_SAMPLER_PAIRS + s->dimension % PATH_SAMPLER_PAIRS;
    if (s->dimension > 0 && s->dimension % PATH_SAMPLER_PAIRS == 0)
        path_sampler_shuffle(s, ~(s->dimension << 16 | s->vertex));
    s->dimension++;
    return sobol_scrambled(sobol_order(s->shuffled, path_sampler_orders[order]),
                           hash_uint(s->group + order + 1));
}

/* One random number in [0, 1); uses up a pair. */
static inline float path_sampler_number(path_sampler *s)
{
    return path_sampler_pair(s)[0];
}

#endif
