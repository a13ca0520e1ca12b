/* deflate.h - compression for PNG and OpenEXR: pieces of a deflate stream (RFC 1951) made independently. */
#ifndef IMAGE_DEFLATE_H
#define IMAGE_DEFLATE_H

#include "facet/facet.h"

enum { DEFLATE_WINDOW = 32768, ZLIB_FRAME = 6 /* bytes that a zlib stream (RFC 1950) adds */ };
/* Up to this size one piece is better than several for several threads: libdeflate takes half of zlib's time. */
#ifdef HAVE_LIBDEFLATE
enum { DEFLATE_WHOLE = 5 << 18 };
#else
enum { DEFLATE_WHOLE = 1 };
#endif

/* Upper bound of the bytes that deflate_piece() writes for size bytes. */
size_t deflate_bound(size_t size);

/* Compresses bytes at level (1 to 9) of zlib, or of libdeflate where one piece is the whole stream, for a stream in which the history_size bytes before them (at
 * most DEFLATE_WINDOW) came first. Pieces but the last end at a byte boundary and can be concatenated.
 * Returns the bytes written to out, which has deflate_bound(size); 0: out of memory. */
size_t deflate_piece(const facet_allocator *allocator, uint32_t level, const unsigned char *bytes,
                     size_t size, size_t history_size, bool is_last, unsigned char *out);

/* Writes the two bytes that begin a zlib stream. */
void zlib_begin(unsigned char out[2]);
uint32_t zlib_checksum(const unsigned char *bytes, size_t size); /* Adler-32 */
/* Checksum of a concatenation, from those of both parts and the size of the second. */
uint32_t zlib_checksum_join(uint32_t first, uint32_t second, size_t second_size);

uint32_t crc32_checksum(const unsigned char *bytes, size_t size); /* of PNG's chunks and of zip archives */

#endif
