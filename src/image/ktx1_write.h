/* ktx1_write.h - writing KTX 1 files: cube maps of light, for programs that read no KTX2 (Filament's loaders of light).
 * Khronos, "KTX File Format Specification", version 1. */
#ifndef IMAGE_KTX1_WRITE_H
#define IMAGE_KTX1_WRITE_H

#include "facet/facet.h"

typedef struct ktx1_write_desc {
    facet_allocator allocator;
    uint32_t thread_count; /* 0: facet_thread_count(); the bytes do not depend on it */
    uint32_t level_count;
    /* Six square pictures of 1 to 4 channels per level, +X -X +Y -Y +Z -Z, the faces of level 0 first; the edges of a level
     * are half as long as those of the one before. */
    const facet_image_view *pictures;
    const char *key, *value; /* one entry of metadata; the value is written without a final 0. NULL: none */
} ktx1_write_desc;

/* Texels are R11F_G11F_B10F. The bytes are a block of mem_alloc(). FACET_ERROR_ARGUMENT: sizes that are no cube map; _MEMORY. */
facet_result ktx1_write_cube(const ktx1_write_desc *desc, unsigned char **bytes, size_t *size,
                             facet_error *error);

#endif
