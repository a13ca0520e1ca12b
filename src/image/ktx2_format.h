/* ktx2_format.h - the texel formats of KTX2 files that facet decodes: VkFormat numbers, sizes, decoded types. */
#ifndef IMAGE_KTX2_FORMAT_H
#define IMAGE_KTX2_FORMAT_H

#include "image/block.h"
#include "image/image.h"

/* Unpacks uncompressed texels to RGBA of the format's type; missing channels are 0, alpha 1. */
typedef void texel_unpack(const unsigned char *bytes, size_t count, unsigned component_count, void *rgba);

typedef enum ktx2_kind {
    KTX2_TEXELS, /* unpack */
    KTX2_BLOCKS, /* decode, or decode_srgb for sRGB images if not NULL; 4 x 4 texels */
    KTX2_ASTC,   /* through a library */
    KTX2_ETC1S
} ktx2_kind;

typedef struct ktx2_format {
    const char *name; /* for messages, "BC7" */
    ktx2_kind kind;
    image_type type;                                     /* of the decoded image */
    unsigned char channel_count;                         /* of the decoded image: 3 or 4 */
    unsigned char block_width, block_height, block_size; /* texels, texels, bytes */
    unsigned char component_count;                       /* KTX2_TEXELS: in the file */
    texel_unpack *unpack;
    block_decode *decode, *decode_srgb;
    unsigned char from[4]; /* source channel of each of RGBA in the decoded RGBA; 4: 0, 5: 1 */
} ktx2_format;

/* The format of a VkFormat; NULL: unknown. *is_srgb: an sRGB format. *is_missing: known, but this build lacks
 * the library. */
const ktx2_format *ktx2_find_format(uint32_t number, bool *is_srgb, bool *is_missing);

/* The format behind VK_FORMAT_UNDEFINED (0), ETC1S or UASTC, by color model and channels of the file's format
 * descriptor (KDF section 5); NULL: another. second: channel of the second sample, -1: there is one sample. */
enum {
    KDF_MODEL_ETC1S = 163,
    KDF_MODEL_UASTC = 166,
    KDF_MODEL_UASTC_HDR = 167,
    KDF_MODEL_UASTC_HDR_6X6 = 168
};
const ktx2_format *ktx2_find_basis_format(unsigned model, int first, int second);

/* The variant of unpack that keeps values that are not finite. */
texel_unpack *unpack_nonfinite(texel_unpack *unpack);

#endif
