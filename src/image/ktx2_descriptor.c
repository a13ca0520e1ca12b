/* ktx2_descriptor.c - see ktx2_descriptor.h. */
#include "image/ktx2_descriptor.h"

#include "image/codec.h"
#include "image/ktx2_pack.h"

static void put_u32(unsigned char **out, uint32_t x)
{
    store_u32_le(*out, x);
    *out += 4;
}

enum {
    KDF_HEADER = 28, /* total size and the block before its samples */
    KDF_SAMPLE = 16,
    KDF_VERSION = 2, /* 1.3 */
    KDF_MODEL_RGBSDA = 1,
    KDF_PRIMARIES_BT709 = 1,
    KDF_TRANSFER_LINEAR = 1,
    KDF_ALPHA = 15, /* channels: R 0, G 1, B 2 */
    KDF_EXPONENT = 0x20,
    KDF_SIGNED = 0x40,
    KDF_FLOAT = 0x80
};

static const uint32_t one_bits = 0x3f800000, minus_one_bits = 0xbf800000;

static uint32_t count_samples(facet_texel_format format)
{
    return format == FACET_TEXEL_FORMAT_RGB9E5 ? 6 : ktx2_find_texel(format)->component_count;
}

static void put_sample(unsigned char **o, uint32_t first_bit, uint32_t bit_count, uint32_t channel,
                       uint32_t lower, uint32_t upper)
{
    put_u32(o, first_bit | (bit_count - 1) << 16 | channel << 24);
    put_u32(o, 0); /* position in the texel block */
    put_u32(o, lower);
    put_u32(o, upper);
}

/* lower and upper are the codes of the least and the largest number of a nominal range: of floats -1 and 1, or 0 and 1
 * where there is no sign. RGB9E5 has a sample of digits and one of the exponent for each channel; 1 is the digits
 * 256 with the exponent 16 before them, and an exponent's lower is its bias (KDF section 5, "R9G9B9E5"). */
static void put_samples(unsigned char **o, facet_texel_format format)
{
    const ktx2_texel *t = ktx2_find_texel(format);
    if (format == FACET_TEXEL_FORMAT_RGB9E5) {
        for (uint32_t c = 0; c < 3; c++) {
            put_sample(o, 9 * c, 9, c, 0, 16 << 9 | 256);
            put_sample(o, 27, 5, c | KDF_EXPONENT, 15, 31);
        }
    } else if (format == FACET_TEXEL_FORMAT_B10G11R11) {
        put_sample(o, 0, 11, 0 | KDF_FLOAT, 0, one_bits);
        put_sample(o, 11, 11, 1 | KDF_FLOAT, 0, one_bits);
        put_sample(o, 22, 10, 2 | KDF_FLOAT, 0, one_bits);
    } else {
        const uint32_t bits = 8 * t->type_size;
        for (uint32_t c = 0; c < t->component_count; c++)
            put_sample(o, bits * c, bits, (c == 3 ? KDF_ALPHA : c) | KDF_FLOAT | KDF_SIGNED, minus_one_bits,
                       one_bits);
    }
}

size_t ktx2_descriptor_size(facet_texel_format format)
{
    return KDF_HEADER + KDF_SAMPLE * (size_t)count_samples(format);
}

void ktx2_put_descriptor(facet_texel_format format, unsigned char *out)
{
    const uint32_t size = (uint32_t)ktx2_descriptor_size(format);
    unsigned char **o = &out;
    put_u32(o, size);
    put_u32(o, 0); /* Khronos' basic block */
    put_u32(o, KDF_VERSION | (size - 4) << 16);
    put_u32(o, KDF_MODEL_RGBSDA | KDF_PRIMARIES_BT709 << 8 | KDF_TRANSFER_LINEAR << 16); /* alpha straight */
    put_u32(o, 0);                             /* a block is 1 x 1 x 1 x 1 texels */
    put_u32(o, ktx2_find_texel(format)->size); /* in one plane */
    put_u32(o, 0);
    put_samples(o, format);
}
