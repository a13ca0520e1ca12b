/* ktx2.h - KTX 2.0 texture containers: contents, validated against the bytes, and images: levels (0: full
 * size), layers of arrays, faces of cubes (+X -X +Y -Y +Z -Z). Khronos, "KTX File Format Specification 2.0". */
#ifndef IMAGE_KTX2_H
#define IMAGE_KTX2_H

#include "image/block.h"
#include "image/image.h"

/* ---- texel formats: VkFormat numbers, sizes, decoded types (ktx2_format.c) ---- */

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

/* Whether this build decodes ASTC. */
bool ktx2_is_astc_built(void);

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

/* ---- files ---- */

enum { KTX2_MAX_LEVELS = 32 };

typedef enum ktx2_scheme { KTX2_NONE, KTX2_BASISLZ, KTX2_ZSTD, KTX2_ZLIB } ktx2_scheme; /* as in files */

/* An open file; points into its bytes and owns no memory. */
typedef struct ktx2 {
    const char *name; /* for messages */
    const ktx2_format *format;
    uint32_t width, height;
    uint32_t level_count, layer_count, face_count; /* 1 or more */
    bool is_array, is_cube, has_all_mips;          /* has_all_mips: mips are to be generated from level 0 */
    bool is_srgb, is_premultiplied;
    bool is_right_to_left, is_bottom_up; /* order of texels, rows; decoded images are from top left */
    char swizzle[4]; /* of "rgba01": sources of the channels; decoded images are swizzled */
    ktx2_scheme scheme;
    const unsigned char *global; /* of BasisLZ */
    size_t global_size;
    struct {
        const unsigned char *bytes;
        size_t size;
    } levels[KTX2_MAX_LEVELS];
} ktx2;

/* Reads header, descriptors and metadata. bytes and name must outlive out. FACET_ERROR_INVALID for files that
 * are malformed or larger than their bytes, FACET_ERROR_UNSUPPORTED for formats, 3D textures and compression
 * that this build does not read. */
facet_result ktx2_open(const void *bytes, size_t size, const char *name, ktx2 *out, facet_error *error);

/* Edge of a level: halved per level, rounded down, at least 1. */
uint32_t ktx2_level_edge(uint32_t edge, uint32_t level);

/* The bytes of a level without supercompression (BasisLZ: as they are). */
typedef struct ktx2_data {
    const unsigned char *bytes;
    size_t size;
    void *block; /* of mem_alloc(), NULL: bytes are the file's */
} ktx2_data;

/* FACET_ERROR_INVALID for damaged data, FACET_ERROR_MEMORY. */
facet_result ktx2_load_level(const ktx2 *k, uint32_t level, const facet_allocator *allocator, ktx2_data *out,
                             facet_error *error);
void ktx2_data_destroy(ktx2_data *d); /* {0} is allowed */

enum { KTX2_REASON = 200 };
/* Inflates a frame of Zstandard, which must give out_size bytes. *reason, a text beforehand, is replaced where
 * something else than damage is known. */
facet_result ktx2_inflate_zstd(const unsigned char *in, size_t in_size, unsigned char *out, size_t out_size,
                               char reason[KTX2_REASON]);

/* Decodes one image of a loaded level: type and channels of k->format (RGBA if a swizzle needs alpha), or
 * desc->channel_count channels for U8. Blocks are decoded in parallel. Of desc only allocator, thread_count,
 * max_size, channel_count, keeps_nonfinite and largest are used. */
facet_result ktx2_decode(const ktx2 *k, const ktx2_data *data, uint32_t level, uint32_t layer, uint32_t face,
                         const image_decode_desc *desc, image *out, facet_error *error);
/* Loads a level and decodes one image of it. */
facet_result ktx2_read(const ktx2 *k, uint32_t level, uint32_t layer, uint32_t face,
                       const image_decode_desc *desc, image *out, facet_error *error);

/* Type, channels and transfer function of decoded images; no pixels. */
image ktx2_header(const ktx2 *k);

#endif
