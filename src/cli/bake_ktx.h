/* bake_ktx.h - KTX2 files of cube maps, as facet writes them uncompressed, changed for engines that want them otherwise. */
#ifndef CLI_BAKE_KTX_H
#define CLI_BAKE_KTX_H

#include "facet/facet.h"

/* The same as KTX 1, the only files of light that Filament's loaders read. ktx2: texels B10G11R11. text: the value of the key
 * "sh"; NULL: none. bytes are malloc()'s. FACET_ERROR_MEMORY. */
facet_result bake_ktx1_from_ktx2(const unsigned char *ktx2, size_t ktx2_size, const char *text,
                                 unsigned char **bytes, size_t *size, facet_error *error);

/* Turns the x axis around, in place: what is at (x, y, z) goes to (-x, y, z), where three.js looks it up. texel_size: bytes. */
facet_result bake_ktx2_mirror(unsigned char *ktx2, size_t ktx2_size, size_t texel_size, facet_error *error);

#endif
