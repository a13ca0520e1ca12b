/* hash.h - hashes: of integers to random bits, and of bytes. */
#ifndef BASE_HASH_H
#define BASE_HASH_H

#include <stddef.h>
#include <stdint.h>

/* The increment of splitmix64: 2^64 over the golden ratio, made odd, whose multiples are spread over 64 bits. */
#define MIX64_STEP UINT64_C(0x9e3779b97f4a7c15)

/* The finalizer of splitmix64, a bijection in which each bit of x flips half of the bits of the result,
 * for random numbers from counters, seeds and lattice points. Steele, Lea and Flood 2014, "Fast splittable
 * pseudorandom number generators", with the constants of Stafford's variant 13. */
static inline uint64_t mix64(uint64_t x)
{
    x = (x ^ (x >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    x = (x ^ (x >> 27)) * UINT64_C(0x94d049bb133111eb);
    return x ^ (x >> 31);
}

/* MurmurHash3_x86_32 (Austin Appleby, 2011), which Cryptomatte uses for names; equal on every machine. */
uint32_t murmur3(const void *bytes, size_t size, uint32_t seed);

#endif
