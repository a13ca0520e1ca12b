/* ktx2_pack.c - packs float texels for KTX files; see ktx_write.h. ktx2_format.c unpacks. */
#include "image/ktx_write.h"

#include "image/codec.h"
#include "image/half.h"

static const ktx2_texel texels_of_formats[] = {
    [FACET_TEXEL_FORMAT_RGBA16F] = {97, 8, 2, 4}, [FACET_TEXEL_FORMAT_RGBA32F] = {109, 16, 4, 4},
    [FACET_TEXEL_FORMAT_RGB9E5] = {123, 4, 4, 3}, [FACET_TEXEL_FORMAT_B10G11R11] = {122, 4, 4, 3},
    [FACET_TEXEL_FORMAT_RG16F] = {83, 4, 2, 2},   [FACET_TEXEL_FORMAT_RG32F] = {103, 8, 4, 2},
    [FACET_TEXEL_FORMAT_R16F] = {76, 2, 2, 1},    [FACET_TEXEL_FORMAT_R32F] = {100, 4, 4, 1},
};

const ktx2_texel *ktx2_find_texel(facet_texel_format format)
{
    return &texels_of_formats[format];
}

/* Clamps to [low, high]; NaN becomes 0, and so does -0 if low is 0. */
static float limit(float x, float low, float high)
{
    x = x > low ? x : x <= low ? low : 0.0f;
    return x <= high ? x : high;
}

static uint32_t pack_f32(float x)
{
    return float_bits(limit(x, -0x1.fffffep127f, 0x1.fffffep127f));
}

static uint16_t pack_f16(float x)
{
    return half_from_float(limit(x, -65504.0f, 65504.0f));
}

/* Packs an unsigned float with the exponent of half (5 bits, bias 15) and fewer digits. As in
 * half_from_float(), the carry of rounding may propagate into the exponent of normal numbers; subnormal ones
 * are rounded by adding the power of two whose last digit is theirs. */
static uint32_t pack_small(float x, unsigned digits)
{
    const uint32_t largest = 0x477fffffu & ~((1u << (23 - digits)) - 1u); /* 2^15 (2 - 2^-digits) */
    const uint32_t bits = float_bits(limit(x, 0.0f, float_from_bits(largest)));
    const unsigned shift = 23 - digits;
    if (bits >= 0x38800000u) /* 2^-14 */
        return (bits - 0x38000000u + ((1u << (shift - 1)) - 1u) + (bits >> shift & 1u)) >> shift;
    const uint32_t unit = (127u + 9u - digits)
                          << 23; /* 2^(9 - digits), whose last digit is 2^(-14 - digits) */
    return float_bits(float_from_bits(bits) + float_from_bits(unit)) - unit;
}

/* Packs three 9-bit mantissas with the exponent of the largest: mantissa 2^(exponent - 24). OpenGL,
 * EXT_texture_shared_exponent, except for ties. */
static uint32_t pack_shared(const float rgb[3])
{
    float c[3];
    float largest = 0.0f;
    for (int i = 0; i < 3; i++) {
        c[i] = limit(rgb[i], 0.0f, 65408.0f); /* 511 2^7 */
        largest = c[i] > largest ? c[i] : largest;
    }
    const uint32_t octave = float_bits(largest) >> 23;                   /* with its bias of 127 */
    uint32_t exponent = octave > 127u - 16u ? octave - (127u - 16u) : 0; /* 1 at 2^-15 */
    const float round = 0x1p23f;                                         /* its unit is 1 */
    const float scale = float_from_bits((127u + 24u - exponent) << 23);
    const bool is_carried = largest * scale + round == round + 512.0f;
    exponent += is_carried;
    uint32_t word = exponent << 27;
    for (int i = 0; i < 3; i++) {
        const float digits = c[i] * (is_carried ? 0.5f * scale : scale) + round;
        word |= (float_bits(digits) & 511u) << (9 * i);
    }
    return word;
}

static void pack_halfs(const float *x, int count, unsigned char *out)
{
    for (int c = 0; c < count; c++) {
        const uint16_t half = pack_f16(x[c]);
        out[2 * c] = (unsigned char)half;
        out[2 * c + 1] = (unsigned char)(half >> 8);
    }
}

static void pack_floats(const float *x, int count, unsigned char *out)
{
    for (int c = 0; c < count; c++)
        store_u32_le(out + 4 * c, pack_f32(x[c]));
}

static void pack_texel(facet_texel_format format, const float rgba[4], unsigned char *out)
{
    switch (format) {
    case FACET_TEXEL_FORMAT_RGB9E5:
        store_u32_le(out, pack_shared(rgba));
        break;
    case FACET_TEXEL_FORMAT_B10G11R11:
        store_u32_le(out,
                     pack_small(rgba[0], 6) | pack_small(rgba[1], 6) << 11 | pack_small(rgba[2], 5) << 22);
        break;
    case FACET_TEXEL_FORMAT_RGBA16F:
        pack_halfs(rgba, 4, out);
        break;
    case FACET_TEXEL_FORMAT_RG16F:
        pack_halfs(rgba, 2, out);
        break;
    case FACET_TEXEL_FORMAT_R16F:
        pack_halfs(rgba, 1, out);
        break;
    case FACET_TEXEL_FORMAT_RGBA32F:
        pack_floats(rgba, 4, out);
        break;
    case FACET_TEXEL_FORMAT_RG32F:
        pack_floats(rgba, 2, out);
        break;
    case FACET_TEXEL_FORMAT_R32F:
        pack_floats(rgba, 1, out);
        break;
    }
}

void ktx2_pack(facet_texel_format format, const float *texels, uint32_t channel_count, size_t count,
               bool is_opaque, unsigned char *out)
{
    const uint32_t size = texels_of_formats[format].size;
    for (size_t i = 0; i < count; i++, texels += channel_count, out += size) {
        float rgba[4];
        for (uint32_t c = 0; c < 4; c++)
            rgba[c] = c < channel_count && !(c == 3 && is_opaque) ? texels[c] : c == 3 ? 1.0f : 0.0f;
        pack_texel(format, rgba, out);
    }
}
