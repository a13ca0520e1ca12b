/* sampler.h - the random numbers of one sample of one pixel: dimension after dimension, each a padded pair of an
 * Owen-scrambled Sobol sequence over the pixel's samples. Numbers depend on seed, pixel, sample and dimension alone, so
 * a picture does not depend on threads, tiles or where it was interrupted. Holds shared shading text: include it last. */
#ifndef PATH_SAMPLER_H
#define PATH_SAMPLER_H

#include <math.h>
#include <stdint.h>
#include <string.h>

#include "shade/shade.h"

typedef struct path_sampler {
    uint32_t index;     /* of the sample in its pixel */
    uint32_t pixel;     /* hash of seed and place */
    uint32_t vertex;    /* hash of that and of the vertex */
    uint32_t dimension; /* of the next pair, counted from the vertex's first */
} path_sampler;

/* Goes to the first dimension of vertex number `vertex` of the path, so that what an earlier vertex drew or did not
 * draw leaves its numbers the same. Vertex 0: lens, time, filter. A vertex has as many pairs as it asks for. */
static inline void path_sampler_begin(path_sampler *s, uint32_t vertex)
{
    s->vertex = hash_uint(s->pixel + vertex);
    s->dimension = 0;
}

/* Of sample number index of pixel (x, y) of the whole picture, at vertex 0. */
static inline path_sampler path_sampler_start(uint32_t seed, uint32_t x, uint32_t y, uint32_t index)
{
    path_sampler s = {.index = index, .pixel = hash_uint(x + hash_uint(y + hash_uint(seed)))};
    path_sampler_begin(&s, 0);
    return s;
}

/* A pair in [0, 1)^2, stratified with those of the pixel's other samples at this vertex and place; independent of all
 * other pairs. */
static inline vec2 path_sampler_pair(path_sampler *s)
{
    return sobol_point(s->index, s->vertex + s->dimension++);
}

/* One number in [0, 1); uses up a pair. */
static inline float path_sampler_number(path_sampler *s)
{
    return path_sampler_pair(s)[0];
}

#endif
