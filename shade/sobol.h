/* sobol.h - well distributed numbers for Monte Carlo integration: points of a (0, 2)-sequence, Owen-scrambled by a hash, so
 * that any count of them is even, they are random, and point i needs no other. */
#ifndef SHADE_SOBOL_H
#define SHADE_SOBOL_H

/* A well mixed number of 32 bits: every bit of the result depends on every bit of x. Wellons 2018, "lowbias32". */
FN uint hash_uint(uint x)
{
    uint h = x;
    h ^= h >> 16u;
    h *= 0x7feb352du;
    h ^= h >> 15u;
    h *= 0x846ca68bu;
    h ^= h >> 16u;
    return h;
}

/* Point index of the sequence that belongs to seed, in [0, 1)^2. */
FN vec2 sobol_point(uint index, uint seed)
{
    uint a = hash_uint(index * 2654435769u ^ hash_uint(seed));
    uint b = hash_uint(a + 0x9e3779b9u);
    return vec2(float(a >> 8u), float(b >> 8u)) * (1.0f / 16777216.0f);
}

#endif
