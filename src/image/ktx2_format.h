/* ktx2_format.h - the texel formats of KTX2 files that facet decodes: Vulkan's numbers for them, their sizes, and what
 * they become. */
#ifndef IMAGE_KTX2_FORMAT_H
#define IMAGE_KTX2_FORMAT_H

#include "image/block.h"
#include "image/image.h"

/* Texels without compression to RGBA of the format's type; absent channels are 0, alpha 1. */
typedef void texel_unpack(const unsigned char *bytes, size_t count, unsigned component_count, void *rgba);

typedef enum ktx2_kind {
    KTX2_TEXELS, /* unpack */
    KTX2_BLOCKS, /* decode, or decode_srgb for images in sRGB where there is one; 4 x 4 texels */
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
    unsigned char from[4]; /* RGBA of the image from RGBA as decoded, as numbers of channels; 4: 0, 5: 1 */
} ktx2_format;

/* What VkFormat number is; NULL: unknown. *is_srgb: it is a format in sRGB. *is_missing: known, but this build lacks
 * the library. */
const ktx2_format *ktx2_find_format(uint32_t number, bool *is_srgb, bool *is_missing);

/* Formats of VK_FORMAT_UNDEFINED (0), told by the color model and the channels of the file's format descriptor (KDF
 * section 5): ETC1S and UASTC. NULL: another. second: the channel of the second sample, -1: there is one sample. */
enum {
    KDF_MODEL_ETC1S = 163,
    KDF_MODEL_UASTC = 166,
    KDF_MODEL_UASTC_HDR = 167,
    KDF_MODEL_UASTC_HDR_6X6 = 168
};
const ktx2_format *ktx2_find_basis_format(unsigned model, int first, int second);

/* unpack as it is but for what is not finite, which stays. */
texel_unpack *unpack_nonfinite(texel_unpack *unpack);

#endif
