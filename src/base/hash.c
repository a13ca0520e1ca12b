/* hash.c - MurmurHash3; see hash.h. */
#include "base/hash.h"

static uint32_t rotate_left(uint32_t x, int bits)
{
    return x << bits | x >> (32 - bits);
}

/* Scrambles one block of four bytes. */
static uint32_t scramble(uint32_t block)
{
    return rotate_left(block * 0xcc9e2d51u, 15) * 0x1b873593u;
}

uint32_t murmur3(const void *bytes, size_t size, uint32_t seed)
{
    const unsigned char *b = bytes;
    uint32_t hash = seed;
    size_t whole = size & ~(size_t)3;
    for (size_t i = 0; i < whole; i += 4) {
        uint32_t block = b[i] | (uint32_t)b[i + 1] << 8 | (uint32_t)b[i + 2] << 16 | (uint32_t)b[i + 3] << 24;
        hash = rotate_left(hash ^ scramble(block), 13) * 5 + 0xe6546b64u;
    }
    uint32_t rest = 0;
    for (size_t i = size; i > whole; i--)
        rest = rest << 8 | b[i - 1];
    hash ^= scramble(rest); /* 0 if there is no rest */
    hash ^= (uint32_t)size;
    hash = (hash ^ hash >> 16) * 0x85ebca6bu;
    hash = (hash ^ hash >> 13) * 0xc2b2ae35u;
    return hash ^ hash >> 16;
}
