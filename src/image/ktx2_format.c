/* ktx2_format.c - the texel formats of KTX2 files that facet decodes; see ktx2.h. */
#include "image/ktx2.h"

#include "image/codec.h"
#include "image/half.h"

/* ---- texels ---- */

static unsigned load_u16(const unsigned char *p)
{
    return p[0] | (unsigned)p[1] << 8;
}

typedef uint16_t half_take(unsigned half);

static uint16_t half_as_is(unsigned half)
{
    return (uint16_t)half;
}

static uint16_t half_finite(unsigned half)
{
    if ((half & 0x7c00) != 0x7c00)
        return (uint16_t)half;
    return half == 0x7c00 ? 0x7bff : 0;
}

/* Component of channel c of RGBA in BGRA. */
static unsigned reverse_rgb(unsigned c)
{
    return c < 3 ? 2 - c : c;
}

static void unpack_u8(const unsigned char *bytes, size_t count, unsigned component_count, void *rgba)
{
    unsigned char *to = rgba;
    for (size_t i = 0; i < count; i++, bytes += component_count, to += 4)
        for (unsigned c = 0; c < 4; c++)
            to[c] = c < component_count ? bytes[c] : c < 3 ? 0 : 255;
}

static void unpack_u8_bgr(const unsigned char *bytes, size_t count, unsigned component_count, void *rgba)
{
    unsigned char *to = rgba;
    for (size_t i = 0; i < count; i++, bytes += component_count, to += 4)
        for (unsigned c = 0; c < 4; c++)
            to[c] = c < component_count ? bytes[reverse_rgb(c)] : 255;
}

static void unpack_s8(const unsigned char *bytes, size_t count, unsigned component_count, void *rgba)
{
    float *to = rgba;
    for (size_t i = 0; i < count; i++, bytes += component_count, to += 4)
        for (unsigned c = 0; c < 4; c++) {
            float x = c < component_count ? (float)(signed char)bytes[c] / 127.0f : c < 3 ? 0.0f : 1.0f;
            to[c] = x < -1.0f ? -1.0f : x;
        }
}

static void unpack_u16(const unsigned char *bytes, size_t count, unsigned component_count, void *rgba)
{
    uint16_t *to = rgba;
    for (size_t i = 0; i < count; i++, bytes += 2 * (size_t)component_count, to += 4)
        for (unsigned c = 0; c < 4; c++)
            to[c] = (uint16_t)(c < component_count ? load_u16(bytes + 2 * (size_t)c) : c < 3 ? 0 : 65535);
}

static void unpack_s16(const unsigned char *bytes, size_t count, unsigned component_count, void *rgba)
{
    float *to = rgba;
    for (size_t i = 0; i < count; i++, bytes += 2 * (size_t)component_count, to += 4)
        for (unsigned c = 0; c < 4; c++) {
            float x = c < 3 ? 0.0f : 1.0f;
            if (c < component_count)
                x = (float)(int16_t)load_u16(bytes + 2 * (size_t)c) / 32767.0f;
            to[c] = x < -1.0f ? -1.0f : x;
        }
}

static inline void unpack_halfs(const unsigned char *bytes, size_t count, unsigned component_count,
                                half_take *take, uint16_t *to)
{
    for (size_t i = 0; i < count; i++, bytes += 2 * (size_t)component_count, to += 4)
        for (unsigned c = 0; c < 4; c++)
            to[c] = c < component_count ? take(load_u16(bytes + 2 * (size_t)c)) : c < 3 ? 0 : 0x3c00;
}

static void unpack_f16(const unsigned char *bytes, size_t count, unsigned component_count, void *rgba)
{
    unpack_halfs(bytes, count, component_count, half_finite, rgba);
}

static void unpack_f16_as_is(const unsigned char *bytes, size_t count, unsigned component_count, void *rgba)
{
    unpack_halfs(bytes, count, component_count, half_as_is, rgba);
}

static void unpack_f32_as_is(const unsigned char *bytes, size_t count, unsigned component_count, void *rgba)
{
    float *to = rgba;
    for (size_t i = 0; i < count; i++, bytes += 4 * (size_t)component_count, to += 4)
        for (unsigned c = 0; c < 4; c++) {
            float x = c < 3 ? 0.0f : 1.0f;
            if (c < component_count)
                x = float_from_bits(load_u32_le(bytes + 4 * (size_t)c));
            to[c] = x;
        }
}

static void unpack_f32(const unsigned char *bytes, size_t count, unsigned component_count, void *rgba)
{
    float *to = rgba;
    unpack_f32_as_is(bytes, count, component_count, rgba);
    for (size_t i = 0; i < 4 * count; i++)
        to[i] = codec_finite(to[i]);
}

/* Three 9-bit mantissas with a shared exponent: value * 2^(exponent - 24). */
static void unpack_e5b9g9r9(const unsigned char *bytes, size_t count, unsigned component_count, void *rgba)
{
    (void)component_count;
    uint16_t *to = rgba;
    for (size_t i = 0; i < count; i++, bytes += 4, to += 4) {
        const uint32_t word = load_u32_le(bytes);
        const float scale = float_from_bits(((word >> 27) + 127 - 24) << 23);
        for (unsigned c = 0; c < 3; c++)
            to[c] = half_from_float((float)(word >> 9 * c & 511) * scale);
        to[3] = 0x3c00;
    }
}

/* Unsigned floats of 11, 11 and 10 bits with the exponent of half. */
static inline void unpack_111110(const unsigned char *bytes, size_t count, half_take *take, uint16_t *to)
{
    for (size_t i = 0; i < count; i++, bytes += 4, to += 4) {
        const uint32_t word = load_u32_le(bytes);
        to[0] = take((word & 0x7ff) << 4);
        to[1] = take((word >> 11 & 0x7ff) << 4);
        to[2] = take(word >> 22 << 5);
        to[3] = 0x3c00;
    }
}

static void unpack_b10g11r11(const unsigned char *bytes, size_t count, unsigned component_count, void *rgba)
{
    (void)component_count;
    unpack_111110(bytes, count, half_finite, rgba);
}

static void unpack_b10g11r11_as_is(const unsigned char *bytes, size_t count, unsigned component_count,
                                   void *rgba)
{
    (void)component_count;
    unpack_111110(bytes, count, half_as_is, rgba);
}

static void unpack_1010102(uint32_t word, unsigned red_shift, unsigned blue_shift, uint16_t *to)
{
    const uint32_t rgb[3] = {word >> red_shift & 1023, word >> 10 & 1023, word >> blue_shift & 1023};
    for (unsigned c = 0; c < 3; c++)
        to[c] = (uint16_t)(rgb[c] << 6 | rgb[c] >> 4);
    to[3] = (uint16_t)((word >> 30) * 21845);
}

static void unpack_a2b10g10r10(const unsigned char *bytes, size_t count, unsigned component_count, void *rgba)
{
    (void)component_count;
    for (size_t i = 0; i < count; i++)
        unpack_1010102(load_u32_le(bytes + 4 * i), 0, 20, (uint16_t *)rgba + 4 * i);
}

static void unpack_a2r10g10b10(const unsigned char *bytes, size_t count, unsigned component_count, void *rgba)
{
    (void)component_count;
    for (size_t i = 0; i < count; i++)
        unpack_1010102(load_u32_le(bytes + 4 * i), 20, 0, (uint16_t *)rgba + 4 * i);
}

texel_unpack *unpack_nonfinite(texel_unpack *unpack)
{
    return unpack == unpack_f16         ? unpack_f16_as_is
           : unpack == unpack_f32       ? unpack_f32_as_is
           : unpack == unpack_b10g11r11 ? unpack_b10g11r11_as_is
                                        : unpack;
}

#define RGBA                                                                                                 \
    {                                                                                                        \
        0, 1, 2, 3                                                                                           \
    }

/* Formats in the order of their numbers; sRGB variants share an entry with their linear ones. */
typedef struct vk_format {
    uint16_t linear, srgb; /* VkFormat; 0: none */
    ktx2_format format;
} vk_format;

static const vk_format vk_formats[] = {
    {9, 15, {"R8", KTX2_TEXELS, IMAGE_U8, 3, 1, 1, 1, 1, unpack_u8, NULL, NULL, RGBA}},
    {10, 0, {"signed R8", KTX2_TEXELS, IMAGE_F32, 3, 1, 1, 1, 1, unpack_s8, NULL, NULL, RGBA}},
    {16, 22, {"RG8", KTX2_TEXELS, IMAGE_U8, 3, 1, 1, 2, 2, unpack_u8, NULL, NULL, RGBA}},
    {17, 0, {"signed RG8", KTX2_TEXELS, IMAGE_F32, 3, 1, 1, 2, 2, unpack_s8, NULL, NULL, RGBA}},
    {23, 29, {"RGB8", KTX2_TEXELS, IMAGE_U8, 3, 1, 1, 3, 3, unpack_u8, NULL, NULL, RGBA}},
    {24, 0, {"signed RGB8", KTX2_TEXELS, IMAGE_F32, 3, 1, 1, 3, 3, unpack_s8, NULL, NULL, RGBA}},
    {30, 36, {"BGR8", KTX2_TEXELS, IMAGE_U8, 3, 1, 1, 3, 3, unpack_u8_bgr, NULL, NULL, RGBA}},
    {37, 43, {"RGBA8", KTX2_TEXELS, IMAGE_U8, 4, 1, 1, 4, 4, unpack_u8, NULL, NULL, RGBA}},
    {38, 0, {"signed RGBA8", KTX2_TEXELS, IMAGE_F32, 4, 1, 1, 4, 4, unpack_s8, NULL, NULL, RGBA}},
    {44, 50, {"BGRA8", KTX2_TEXELS, IMAGE_U8, 4, 1, 1, 4, 4, unpack_u8_bgr, NULL, NULL, RGBA}},
    {58, 0, {"A2R10G10B10", KTX2_TEXELS, IMAGE_U16, 4, 1, 1, 4, 4, unpack_a2r10g10b10, NULL, NULL, RGBA}},
    {64, 0, {"A2B10G10R10", KTX2_TEXELS, IMAGE_U16, 4, 1, 1, 4, 4, unpack_a2b10g10r10, NULL, NULL, RGBA}},
    {70, 0, {"R16", KTX2_TEXELS, IMAGE_U16, 3, 1, 1, 2, 1, unpack_u16, NULL, NULL, RGBA}},
    {71, 0, {"signed R16", KTX2_TEXELS, IMAGE_F32, 3, 1, 1, 2, 1, unpack_s16, NULL, NULL, RGBA}},
    {76, 0, {"half R16", KTX2_TEXELS, IMAGE_F16, 3, 1, 1, 2, 1, unpack_f16, NULL, NULL, RGBA}},
    {77, 0, {"RG16", KTX2_TEXELS, IMAGE_U16, 3, 1, 1, 4, 2, unpack_u16, NULL, NULL, RGBA}},
    {78, 0, {"signed RG16", KTX2_TEXELS, IMAGE_F32, 3, 1, 1, 4, 2, unpack_s16, NULL, NULL, RGBA}},
    {83, 0, {"half RG16", KTX2_TEXELS, IMAGE_F16, 3, 1, 1, 4, 2, unpack_f16, NULL, NULL, RGBA}},
    {84, 0, {"RGB16", KTX2_TEXELS, IMAGE_U16, 3, 1, 1, 6, 3, unpack_u16, NULL, NULL, RGBA}},
    {85, 0, {"signed RGB16", KTX2_TEXELS, IMAGE_F32, 3, 1, 1, 6, 3, unpack_s16, NULL, NULL, RGBA}},
    {90, 0, {"half RGB16", KTX2_TEXELS, IMAGE_F16, 3, 1, 1, 6, 3, unpack_f16, NULL, NULL, RGBA}},
    {91, 0, {"RGBA16", KTX2_TEXELS, IMAGE_U16, 4, 1, 1, 8, 4, unpack_u16, NULL, NULL, RGBA}},
    {92, 0, {"signed RGBA16", KTX2_TEXELS, IMAGE_F32, 4, 1, 1, 8, 4, unpack_s16, NULL, NULL, RGBA}},
    {97, 0, {"half RGBA16", KTX2_TEXELS, IMAGE_F16, 4, 1, 1, 8, 4, unpack_f16, NULL, NULL, RGBA}},
    {100, 0, {"float R32", KTX2_TEXELS, IMAGE_F32, 3, 1, 1, 4, 1, unpack_f32, NULL, NULL, RGBA}},
    {103, 0, {"float RG32", KTX2_TEXELS, IMAGE_F32, 3, 1, 1, 8, 2, unpack_f32, NULL, NULL, RGBA}},
    {106, 0, {"float RGB32", KTX2_TEXELS, IMAGE_F32, 3, 1, 1, 12, 3, unpack_f32, NULL, NULL, RGBA}},
    {109, 0, {"float RGBA32", KTX2_TEXELS, IMAGE_F32, 4, 1, 1, 16, 4, unpack_f32, NULL, NULL, RGBA}},
    {122, 0, {"B10G11R11", KTX2_TEXELS, IMAGE_F16, 3, 1, 1, 4, 3, unpack_b10g11r11, NULL, NULL, RGBA}},
    {123, 0, {"E5B9G9R9", KTX2_TEXELS, IMAGE_F16, 3, 1, 1, 4, 3, unpack_e5b9g9r9, NULL, NULL, RGBA}},
    {131, 132, {"BC1", KTX2_BLOCKS, IMAGE_U8, 3, 4, 4, 8, 0, NULL, bc1_rgb_decode, NULL, RGBA}},
    {133, 134, {"BC1 with alpha", KTX2_BLOCKS, IMAGE_U8, 4, 4, 4, 8, 0, NULL, bc1_rgba_decode, NULL, RGBA}},
    {135, 136, {"BC2", KTX2_BLOCKS, IMAGE_U8, 4, 4, 4, 16, 0, NULL, bc2_decode, NULL, RGBA}},
    {137, 138, {"BC3", KTX2_BLOCKS, IMAGE_U8, 4, 4, 4, 16, 0, NULL, bc3_decode, NULL, RGBA}},
    {139, 0, {"BC4", KTX2_BLOCKS, IMAGE_U8, 3, 4, 4, 8, 0, NULL, bc4_decode, NULL, RGBA}},
    {140, 0, {"signed BC4", KTX2_BLOCKS, IMAGE_F32, 3, 4, 4, 8, 0, NULL, bc4_signed_decode, NULL, RGBA}},
    {141, 0, {"BC5", KTX2_BLOCKS, IMAGE_U8, 3, 4, 4, 16, 0, NULL, bc5_decode, NULL, RGBA}},
    {142, 0, {"signed BC5", KTX2_BLOCKS, IMAGE_F32, 3, 4, 4, 16, 0, NULL, bc5_signed_decode, NULL, RGBA}},
    {143, 0, {"BC6H", KTX2_BLOCKS, IMAGE_F16, 3, 4, 4, 16, 0, NULL, bc6h_decode, NULL, RGBA}},
    {144, 0, {"signed BC6H", KTX2_BLOCKS, IMAGE_F16, 3, 4, 4, 16, 0, NULL, bc6h_signed_decode, NULL, RGBA}},
    {145, 146, {"BC7", KTX2_BLOCKS, IMAGE_U8, 4, 4, 4, 16, 0, NULL, bc7_decode, NULL, RGBA}},
    {147, 148, {"ETC2", KTX2_BLOCKS, IMAGE_U8, 3, 4, 4, 8, 0, NULL, etc2_rgb_decode, NULL, RGBA}},
    {149,
     150,
     {"ETC2 with 1-bit alpha", KTX2_BLOCKS, IMAGE_U8, 4, 4, 4, 8, 0, NULL, etc2_rgb_a1_decode, NULL, RGBA}},
    {151,
     152,
     {"ETC2 with alpha", KTX2_BLOCKS, IMAGE_U8, 4, 4, 4, 16, 0, NULL, etc2_rgba_decode, NULL, RGBA}},
    {153, 0, {"EAC R11", KTX2_BLOCKS, IMAGE_U16, 3, 4, 4, 8, 0, NULL, eac_r11_decode, NULL, RGBA}},
    {154,
     0,
     {"signed EAC R11", KTX2_BLOCKS, IMAGE_F32, 3, 4, 4, 8, 0, NULL, eac_r11_signed_decode, NULL, RGBA}},
    {155, 0, {"EAC RG11", KTX2_BLOCKS, IMAGE_U16, 3, 4, 4, 16, 0, NULL, eac_rg11_decode, NULL, RGBA}},
    {156,
     0,
     {"signed EAC RG11", KTX2_BLOCKS, IMAGE_F32, 3, 4, 4, 16, 0, NULL, eac_rg11_signed_decode, NULL, RGBA}},
    {157, 158, {"ASTC 4x4", KTX2_ASTC, IMAGE_U8, 4, 4, 4, 16, 0, NULL, NULL, NULL, RGBA}},
    {159, 160, {"ASTC 5x4", KTX2_ASTC, IMAGE_U8, 4, 5, 4, 16, 0, NULL, NULL, NULL, RGBA}},
    {161, 162, {"ASTC 5x5", KTX2_ASTC, IMAGE_U8, 4, 5, 5, 16, 0, NULL, NULL, NULL, RGBA}},
    {163, 164, {"ASTC 6x5", KTX2_ASTC, IMAGE_U8, 4, 6, 5, 16, 0, NULL, NULL, NULL, RGBA}},
    {165, 166, {"ASTC 6x6", KTX2_ASTC, IMAGE_U8, 4, 6, 6, 16, 0, NULL, NULL, NULL, RGBA}},
    {167, 168, {"ASTC 8x5", KTX2_ASTC, IMAGE_U8, 4, 8, 5, 16, 0, NULL, NULL, NULL, RGBA}},
    {169, 170, {"ASTC 8x6", KTX2_ASTC, IMAGE_U8, 4, 8, 6, 16, 0, NULL, NULL, NULL, RGBA}},
    {171, 172, {"ASTC 8x8", KTX2_ASTC, IMAGE_U8, 4, 8, 8, 16, 0, NULL, NULL, NULL, RGBA}},
    {173, 174, {"ASTC 10x5", KTX2_ASTC, IMAGE_U8, 4, 10, 5, 16, 0, NULL, NULL, NULL, RGBA}},
    {175, 176, {"ASTC 10x6", KTX2_ASTC, IMAGE_U8, 4, 10, 6, 16, 0, NULL, NULL, NULL, RGBA}},
    {177, 178, {"ASTC 10x8", KTX2_ASTC, IMAGE_U8, 4, 10, 8, 16, 0, NULL, NULL, NULL, RGBA}},
    {179, 180, {"ASTC 10x10", KTX2_ASTC, IMAGE_U8, 4, 10, 10, 16, 0, NULL, NULL, NULL, RGBA}},
    {181, 182, {"ASTC 12x10", KTX2_ASTC, IMAGE_U8, 4, 12, 10, 16, 0, NULL, NULL, NULL, RGBA}},
    {183, 184, {"ASTC 12x12", KTX2_ASTC, IMAGE_U8, 4, 12, 12, 16, 0, NULL, NULL, NULL, RGBA}},
};

bool ktx2_is_astc_built(void)
{
#ifdef HAVE_ASTC
    return true;
#else
    return false;
#endif
}

const ktx2_format *ktx2_find_format(uint32_t number, bool *is_srgb, bool *is_missing)
{
    *is_srgb = *is_missing = false;
    for (size_t i = 0; i < sizeof vk_formats / sizeof *vk_formats; i++) {
        const vk_format *f = &vk_formats[i];
        if (number == 0 || (number != f->linear && number != f->srgb))
            continue;
        *is_srgb = number == f->srgb;
        *is_missing = f->format.kind == KTX2_ASTC && !ktx2_is_astc_built();
        return &f->format;
    }
    return NULL;
}

/* Formats identified by color model and channels. second: any, unless the model requires two samples. */
typedef struct basis_format {
    unsigned char model;
    signed char first, second;
    ktx2_format format;
} basis_format;

#define ETC1S KTX2_ETC1S, IMAGE_U8
#define UASTC KTX2_BLOCKS, IMAGE_U8

static const basis_format basis_formats[] = {
    {KDF_MODEL_ETC1S, 0, -1, {"ETC1S", ETC1S, 3, 4, 4, 0, 0, NULL, NULL, NULL, RGBA}},
    {KDF_MODEL_ETC1S, 0, 15, {"ETC1S", ETC1S, 4, 4, 4, 0, 0, NULL, NULL, NULL, RGBA}},
    {KDF_MODEL_ETC1S, 3, -1, {"ETC1S of red", ETC1S, 3, 4, 4, 0, 0, NULL, NULL, NULL, RGBA}},
    {KDF_MODEL_ETC1S, 3, 4, {"ETC1S of red and green", ETC1S, 3, 4, 4, 0, 0, NULL, NULL, NULL, {0, 3, 4, 5}}},
    {KDF_MODEL_UASTC, 0, -1, {"UASTC", UASTC, 3, 4, 4, 16, 0, NULL, uastc_decode, uastc_srgb_decode, RGBA}},
    {KDF_MODEL_UASTC, 3, -1, {"UASTC", UASTC, 4, 4, 4, 16, 0, NULL, uastc_decode, uastc_srgb_decode, RGBA}},
    {KDF_MODEL_UASTC,
     4,
     -1,
     {"UASTC of red", UASTC, 3, 4, 4, 16, 0, NULL, uastc_decode, uastc_srgb_decode, RGBA}},
    {KDF_MODEL_UASTC,
     5,
     -1,
     {"UASTC of red and green", UASTC, 3, 4, 4, 16, 0, NULL, uastc_decode, uastc_srgb_decode, {0, 3, 4, 5}}},
    {KDF_MODEL_UASTC,
     6,
     -1,
     {"UASTC of red and green", UASTC, 3, 4, 4, 16, 0, NULL, uastc_decode, uastc_srgb_decode, {0, 1, 4, 5}}},
};

const ktx2_format *ktx2_find_basis_format(unsigned model, int first, int second)
{
    for (size_t i = 0; i < sizeof basis_formats / sizeof *basis_formats; i++) {
        const basis_format *f = &basis_formats[i];
        if (f->model == model && f->first == first && f->second == second)
            return &f->format;
    }
    return NULL;
}
