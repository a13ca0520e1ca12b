/* ktx_write.h - writing KTX files. ktx2.h reads those of version 2. */
#ifndef IMAGE_KTX_WRITE_H
#define IMAGE_KTX_WRITE_H

#include "facet/facet.h"

/* ---- KTX 2.0: textures of floats, 2D or cube maps, with any number of levels ----
 *
 * Khronos, "KTX File Format Specification 2.0"; "Khronos Data Format Specification 1.3" (KDF), section 5. */

typedef struct ktx2_write_desc {
    facet_allocator allocator;
    uint32_t thread_count; /* 0: facet_thread_count(); the bytes do not depend on it */
    facet_texel_format format;
    uint32_t zstd_level; /* each level a frame of Zstandard: 1 to 19; 0: none */
    uint32_t level_count;
    uint32_t face_count; /* 1, or 6: +X -X +Y -Y +Z -Z */
    /* level_count * face_count images of 1 to 4 channels, faces of level 0 first; edges are halved per level,
     * rounded down, at least 1. */
    const facet_image_view *images;
    bool is_opaque;     /* alpha is 1 in any case */
    const char *writer; /* KTXwriter: name and version of the program */
} ktx2_write_desc;

/* The bytes are a block of mem_alloc(). FACET_ERROR_ARGUMENT: sizes and counts that are not a texture;
 * _UNSUPPORTED: a build without Zstandard; _MEMORY. */
facet_result ktx2_write(const ktx2_write_desc *desc, unsigned char **bytes, size_t *size, facet_error *error);

/* ---- KTX 1: cube maps of light for programs that do not read KTX 2 (Filament's loaders of light) ----
 *
 * Khronos, "KTX File Format Specification", version 1. */

typedef struct ktx1_write_desc {
    facet_allocator allocator;
    uint32_t thread_count; /* 0: facet_thread_count(); the bytes do not depend on it */
    uint32_t level_count;
    /* Six square images of 1 to 4 channels per level, +X -X +Y -Y +Z -Z, faces of level 0 first; edges are
     * halved per level. */
    const facet_image_view *images;
    const char *key, *value; /* one metadata entry; the value is written without a final 0. NULL: none */
} ktx1_write_desc;

/* Texels are R11F_G11F_B10F. The bytes are a block of mem_alloc(). FACET_ERROR_ARGUMENT: sizes that are not a
 * cube map; _MEMORY. */
facet_result ktx1_write_cube(const ktx1_write_desc *desc, unsigned char **bytes, size_t *size,
                             facet_error *error);

/* ---- texels of both, from floats (ktx2_pack.c) ---- */

/* Properties of a format, from the Vulkan specification ("Formats"). */
typedef struct ktx2_texel {
    uint32_t vk_format;
    uint32_t size; /* bytes of a texel */
    /* unit of byte swapping: a number or a packed word */
    uint32_t type_size;
    uint32_t component_count; /* stored components: R, RG, RGB or RGBA */
} ktx2_texel;

const ktx2_texel *ktx2_find_texel(facet_texel_format format);

/* Packs count texels of channel_count (1 to 4) floats each. Missing channels are 0, alpha 1; is_opaque: alpha
 * is 1 in any case. Numbers are rounded to nearest, ties to even; those beyond the largest of the format
 * become that (infinity too in signed formats), NaN 0. */
void ktx2_pack(facet_texel_format format, const float *texels, uint32_t channel_count, size_t count,
               bool is_opaque, unsigned char *out);

#endif
