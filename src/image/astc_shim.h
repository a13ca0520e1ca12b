/* astc_shim.h - libastcenc, which has a C++ header, for C. */
#ifndef IMAGE_ASTC_SHIM_H
#define IMAGE_ASTC_SHIM_H

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { ASTC_SHIM_OK, ASTC_SHIM_MEMORY, ASTC_SHIM_FAILED };

/* Decodes blocks, which cover width x height texels, to RGBA of 8 bits. is_srgb: as a sampler reads them that decodes
 * sRGB afterwards. */
int astc_shim_decode(const unsigned char *blocks, size_t size, unsigned block_width, unsigned block_height,
                     bool is_srgb, unsigned width, unsigned height, unsigned char *rgba);

#ifdef __cplusplus
}
#endif

#endif
