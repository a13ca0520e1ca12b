/* astc_shim.h - libastcenc, which has a C++ header, for C. */
#ifndef IMAGE_ASTC_SHIM_H
#define IMAGE_ASTC_SHIM_H

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { ASTC_SHIM_OK, ASTC_SHIM_MEMORY, ASTC_SHIM_FAILED };

typedef struct astc_shim astc_shim;

/* Prepares for blocks of that size and so many threads, which takes milliseconds. is_srgb: texels come as a sampler
 * reads them that decodes sRGB afterwards. */
int astc_shim_create(unsigned block_width, unsigned block_height, bool is_srgb, unsigned thread_count,
                     astc_shim **out);
void astc_shim_destroy(astc_shim *s); /* NULL is allowed */

/* Decodes blocks, which cover width x height texels, to RGBA of 8 bits. Called once for each thread, number thread,
 * with the same image: they share the work, and it is done when all calls have returned. */
int astc_shim_decode(astc_shim *s, const unsigned char *blocks, size_t size, unsigned width, unsigned height,
                     unsigned char *rgba, unsigned thread);

#ifdef __cplusplus
}
#endif

#endif
