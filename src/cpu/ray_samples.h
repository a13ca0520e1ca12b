/* ray_samples.h - numbers in [0, 1) for the rays that one shade splits into: well spread over the rays, unlike from one
 * pixel to the next, the same for every order in which pixels are drawn. Holds shared shading text: include it last. */
#ifndef CPU_RAY_SAMPLES_H
#define CPU_RAY_SAMPLES_H

#include "shade/shade.h"

/* Which of the rays of which shade. */
typedef struct ray_sample {
    uint32_t x, y;  /* pixel */
    uint32_t index; /* of the ray in the pixel */
} ray_sample;

/* Bits of every input bit (Jarzynski and Olano 2020, "Hash Functions for GPU Rendering", pcg). */
static inline uint32_t ray_samples_hash(uint32_t x)
{
    uint32_t state = x * 747796405u + 2891336453u;
    uint32_t word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

/* Second coordinate of Sobol's sequence, as 32 bits behind the binary point; with the mirrored bits of i as the first one
 * it is a (0, 2)-sequence: every 2^k points from a multiple of 2^k on are a stratum each of every 2^a x 2^(k - a) grid. */
static inline uint32_t ray_samples_sobol2(uint32_t i)
{
    uint32_t r = 0;
    for (uint32_t v = 1u << 31; i; i >>= 1, v ^= v >> 1)
        if (i & 1)
            r ^= v;
    return r;
}

/* Two numbers for the bounce-th surface on the ray's way. The digits are exchanged at random per pixel and bounce, which
 * keeps the strata, and the points are taken in another order at each bounce (Kollig and Keller 2002). */
static inline vec2 ray_samples_at(ray_sample s, uint32_t bounce)
{
    uint32_t seed = ray_samples_hash(s.x ^ ray_samples_hash(s.y ^ ray_samples_hash(bounce)));
    uint32_t i = bounce ? s.index ^ (ray_samples_hash(seed) & 63u) : s.index;
    uint32_t bits = i;
    bits = (bits << 16) | (bits >> 16);
    bits = ((bits & 0x00FF00FFu) << 8) | ((bits & 0xFF00FF00u) >> 8);
    bits = ((bits & 0x0F0F0F0Fu) << 4) | ((bits & 0xF0F0F0F0u) >> 4);
    bits = ((bits & 0x33333333u) << 2) | ((bits & 0xCCCCCCCCu) >> 2);
    bits = ((bits & 0x55555555u) << 1) | ((bits & 0xAAAAAAAAu) >> 1);
    uint32_t u = bits ^ seed;
    uint32_t v = ray_samples_sobol2(i) ^ ray_samples_hash(seed + 1);
    return vec2((float)(u >> 8) * 0x1p-24f, (float)(v >> 8) * 0x1p-24f);
}

#endif
