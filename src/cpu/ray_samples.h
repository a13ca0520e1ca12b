/* ray_samples.h - random numbers in [0, 1) for the rays into which one shade splits: stratified over the
 * rays of a pixel and over neighboring pixels, so that the remaining error is high-frequency. */
#ifndef CPU_RAY_SAMPLES_H
#define CPU_RAY_SAMPLES_H

#include "shade/shade.h"

/* A hash: each bit depends on all bits of x. Jarzynski and Olano 2020, "Hash Functions for GPU Rendering",
 * pcg. */
static inline uint32_t ray_samples_hash(uint32_t x)
{
    uint32_t state = x * 747796405u + 2891336453u;
    uint32_t word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

static inline uint32_t ray_samples_reverse_bits(uint32_t b)
{
    b = (b << 16) | (b >> 16);
    b = ((b & 0x00FF00FFu) << 8) | ((b & 0xFF00FF00u) >> 8);
    b = ((b & 0x0F0F0F0Fu) << 4) | ((b & 0xF0F0F0F0u) >> 4);
    b = ((b & 0x33333333u) << 2) | ((b & 0xCCCCCCCCu) >> 2);
    return ((b & 0x55555555u) << 1) | ((b & 0xAAAAAAAAu) >> 1);
}

/* Flips each bit depending on those below it only: on mirrored digits, Owen's scrambling. Laine and Karras
 * 2011, "Stratified Sampling for Stochastic Transparency". */
static inline uint32_t ray_samples_scramble(uint32_t x, uint32_t seed)
{
    x += seed;
    x ^= x * 0x6c50b47cu;
    x ^= x * 0xb82f1e52u;
    x ^= x * 0xc7afe638u;
    return x ^ x * 0x8d22f6e6u;
}

/* Second coordinate of Sobol's sequence, its digits mirrored: first digit in bit 0. With those of i as the
 * first coordinate it is a (0, 2)-sequence: 2^k points starting at a multiple of 2^k are one in each cell
 * of every 2^a x 2^(k - a) grid. The matrix is Pascal's triangle modulo 2, a product of five of one band
 * each. */
static inline uint32_t ray_samples_sobol2(uint32_t i)
{
    i ^= (i & 0xAAAAAAAAu) >> 1;
    i ^= (i & 0xCCCCCCCCu) >> 2;
    i ^= (i & 0xF0F0F0F0u) >> 4;
    i ^= (i & 0xFF00FF00u) >> 8;
    return i ^ i >> 16;
}

/* Index of a pixel on a curve that fills squares of 2^k pixels one after the other, in a random order at
 * every level: pixels take blocks of the sequence such that all squares are well stratified together as
 * well. Ahmed and Wonka 2020, "Screen-Space Blue-Noise Diffusion of Monte Carlo Sampling Error via
 * Hierarchical Ordering of Pixels". */
static inline uint32_t ray_samples_place(uint32_t x, uint32_t y)
{
    enum { LEVELS = 12 };
    uint32_t place = 1;
    for (int level = LEVELS - 1; level >= 0; level--) {
        uint32_t quarter = (x >> level & 1) | (y >> level & 1) << 1;
        place = place << 2 | (quarter ^ (ray_samples_hash(place) >> 30));
    }
    return place & ((1u << 2 * LEVELS) - 1);
}

/* Two random numbers for ray `index` of all (ray_samples_place() times the rays per pixel, plus the ray's
 * number in it) at its bounce-th surface. */
static inline vec2 ray_samples_at(uint32_t index, uint32_t bounce)
{
    uint32_t seed = ray_samples_hash(bounce);
    /* Another order per bounce, of the numbers in a block and of the blocks: digits are permuted depending
     * on those above them. */
    uint32_t i = ray_samples_reverse_bits(ray_samples_scramble(ray_samples_reverse_bits(index), seed));
    uint32_t u = ray_samples_reverse_bits(ray_samples_scramble(i, ray_samples_hash(seed + 1)));
    uint32_t v =
        ray_samples_reverse_bits(ray_samples_scramble(ray_samples_sobol2(i), ray_samples_hash(seed + 2)));
    return vec2((float)(u >> 8) * 0x1p-24f, (float)(v >> 8) * 0x1p-24f);
}

#endif
