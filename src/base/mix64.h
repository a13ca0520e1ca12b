/* mix64.h - random numbers of what is counted: seeds, places of a lattice, indices. */
#ifndef BASE_MIX64_H
#define BASE_MIX64_H

#include <stdint.h>

/* 2^64 over the golden ratio, odd: what splitmix64 counts in. Multiples of it are spread over the numbers of 64 bits. */
#define MIX64_STEP UINT64_C(0x9e3779b97f4a7c15)

/* Finaliser of splitmix64: one to one, and each bit of x changes half of the bits that come back. Steele, Lea and Flood 2014, "Fast
 * splittable pseudorandom number generators", with the constants of Stafford's variant 13. */
static inline uint64_t mix64(uint64_t x)
{
    x = (x ^ (x >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    x = (x ^ (x >> 27)) * UINT64_C(0x94d049bb133111eb);
    return x ^ (x >> 31);
}

#endif
