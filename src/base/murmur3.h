/* murmur3.h - MurmurHash3 (Austin Appleby, 2011), the variant for 32-bit values: the hash of names in Cryptomatte. */
#ifndef BASE_MURMUR3_H
#define BASE_MURMUR3_H

#include <stddef.h>
#include <stdint.h>

/* MurmurHash3_x86_32 of the bytes, which is the same number on every machine. */
uint32_t murmur3(const void *bytes, size_t size, uint32_t seed);

#endif
