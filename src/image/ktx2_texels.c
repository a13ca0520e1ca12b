/* ktx2_texels.c - see ktx2_texels.h. Light has to be finite: NaN and negative infinity become 0, infinity the largest
 * value, unless the names end in _as_is. */
#include "image/ktx2_texels.h"

#include "image/codec.h"
#include "image/half.h"

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

/* The component that channel c of RGBA comes from; bgr: of BGRA. */
static unsigned reverse_rgb(unsigned c)
{
    return c < 3 ? 2 - c : c;
}

void unpack_u8(const unsigned char *bytes, size_t count, unsigned component_count, void *rgba)
{
    unsigned char *to = rgba;
    for (size_t i = 0; i < count; i++, bytes += component_count, to += 4)
        for (unsigned c = 0; c < 4; c++)
            to[c] = c < component_count ? bytes[c] : c < 3 ? 0 : 255;
}

void unpack_u8_bgr(const unsigned char *bytes, size_t count, unsigned component_count, void *rgba)
{
    unsigned char *to = rgba;
    for (size_t i = 0; i < count; i++, bytes += component_count, to += 4)
        for (unsigned c = 0; c < 4; c++)
            to[c] = c < component_count ? bytes[reverse_rgb(c)] : 255;
}

void unpack_s8(const unsigned char *bytes, size_t count, unsigned component_count, void *rgba)
{
    float *to = rgba;
    for (size_t i = 0; i < count; i++, bytes += component_count, to += 4)
        for (unsigned c = 0; c < 4; c++) {
            float x = c < component_count ? (float)(signed char)bytes[c] / 127.0f : c < 3 ? 0.0f : 1.0f;
            to[c] = x < -1.0f ? -1.0f : x;
        }
}

void unpack_u16(const unsigned char *bytes, size_t count, unsigned component_count, void *rgba)
{
    uint16_t *to = rgba;
    for (size_t i = 0; i < count; i++, bytes += 2 * (size_t)component_count, to += 4)
        for (unsigned c = 0; c < 4; c++)
            to[c] = (uint16_t)(c < component_count ? load_u16(bytes + 2 * (size_t)c) : c < 3 ? 0 : 65535);
}

void unpack_s16(const unsigned char *bytes, size_t count, unsigned component_count, void *rgba)
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

void unpack_f16(const unsigned char *bytes, size_t count, unsigned component_count, void *rgba)
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

void unpack_f32(const unsigned char *bytes, size_t count, unsigned component_count, void *rgba)
{
    float *to = rgba;
    unpack_f32_as_is(bytes, count, component_count, rgba);
    for (size_t i = 0; i < 4 * count; i++)
        to[i] = codec_finite(to[i]);
}

/* Three numbers of 9 bits with one exponent: value * 2^(exponent - 24). */
void unpack_e5b9g9r9(const unsigned char *bytes, size_t count, unsigned component_count, void *rgba)
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

/* Unsigned floats of 11, 11 and 10 bits with the exponents of halfs. */
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

void unpack_b10g11r11(const unsigned char *bytes, size_t count, unsigned component_count, void *rgba)
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

void unpack_a2b10g10r10(const unsigned char *bytes, size_t count, unsigned component_count, void *rgba)
{
    (void)component_count;
    for (size_t i = 0; i < count; i++)
        unpack_1010102(load_u32_le(bytes + 4 * i), 0, 20, (uint16_t *)rgba + 4 * i);
}

void unpack_a2r10g10b10(const unsigned char *bytes, size_t count, unsigned component_count, void *rgba)
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
