/* bake_ktx1.h - cube maps as KTX 1 files, the only ones that Filament's loaders of light read. */
#ifndef CLI_BAKE_KTX1_H
#define CLI_BAKE_KTX1_H

#include "facet/facet.h"

/* Rewraps a KTX2 file of a cube map, B10G11R11 and not compressed, that facet made. text: the value of the key "sh"; NULL:
 * none. bytes are malloc()'s. FACET_ERROR_MEMORY. */
facet_result bake_ktx1_from_ktx2(const unsigned char *ktx2, size_t ktx2_size, const char *text,
                                 unsigned char **bytes, size_t *size, facet_error *error);

#endif
