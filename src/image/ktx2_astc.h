/* ktx2_astc.h - ASTC LDR blocks to a picture. */
#ifndef IMAGE_KTX2_ASTC_H
#define IMAGE_KTX2_ASTC_H

#include "image/ktx2.h"

/* Decodes size bytes of blocks of k->format into out, RGBA U8 of its size. The library's own memory comes from malloc.
 * Fails with FACET_ERROR_MEMORY, FACET_ERROR_UNSUPPORTED where this build has no libastcenc. */
facet_result ktx2_decode_astc(const ktx2 *k, const unsigned char *bytes, size_t size, uint32_t thread_count,
                              image *out, facet_error *error);

#endif
