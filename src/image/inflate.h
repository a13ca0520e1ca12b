/* inflate.h - zlib streams (RFC 1950) to bytes. */
#ifndef IMAGE_INFLATE_H
#define IMAGE_INFLATE_H

#include "facet/facet.h"

/* Fills out with the size bytes that packed, a whole zlib stream, stands for; out_size must be exactly what it
 * holds. Fails, without a message, with FACET_ERROR_INVALID, FACET_ERROR_MEMORY. */
facet_result zlib_inflate(const facet_allocator *allocator, const unsigned char *packed, size_t packed_size,
                          unsigned char *out, size_t out_size);

#endif
