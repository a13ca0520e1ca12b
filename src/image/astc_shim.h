/* astc_shim.h - C interface of libastcenc, which has a C++ header. */
#ifndef IMAGE_ASTC_SHIM_H
#define IMAGE_ASTC_SHIM_H

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { ASTC_SHIM_OK, ASTC_SHIM_MEMORY, ASTC_SHIM_FAILED };

typedef struct astc_shim astc_shim;

/* Creates a decoder for a block size and a number of threads; takes milliseconds. is_srgb: decode for
 * samplers that convert from sRGB afterwards. */
int astc_shim_create(unsigned block_width, unsigned block_height, bool is_srgb, unsigned thread_count,
                     astc_shim **out);
void astc_shim_destroy(astc_shim *s); /* NULL is allowed */

/* Decodes blocks of an image of width x height texels to 8-bit RGBA. Each thread calls it once with its own
 * index and the same image; they share the work, which is complete when all calls have returned. */
int astc_shim_decode(astc_shim *s, const unsigned char *blocks, size_t size, unsigned width, unsigned height,
                     unsigned char *rgba, unsigned thread);

#ifdef __cplusplus
}
#endif

#endif
