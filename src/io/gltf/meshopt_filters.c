/* meshopt_filters.c - what is done to elements after mode ATTRIBUTES. Elements of four components are taken apart into
 * one array for each component, a batch at a time, so that the arithmetic is loops that the compiler vectorises. */
#include <math.h>
#include <string.h>

#include "io/gltf/meshopt.h"

enum { BATCH = 64 };

/* Component k of element i of a batch is [k][i]. */
typedef float components[4][BATCH];

static void load_components(const uint8_t *in, size_t count, size_t stride, bool is_signed, components out)
{
    if (stride == 4)
        for (size_t i = 0; i < count; i++)
            for (size_t k = 0; k < 4; k++)
                out[k][i] = (float)(is_signed ? (int8_t)in[4 * i + k] : in[4 * i + k]);
    else
        for (size_t i = 0; i < count; i++)
            for (size_t k = 0; k < 4; k++) {
                const unsigned value = in[8 * i + 2 * k] | (unsigned)in[8 * i + 2 * k + 1] << 8;
                out[k][i] = (float)(is_signed ? (int16_t)value : (int)value);
            }
}

static inline void store_u32(uint8_t *p, uint32_t value)
{
    for (int i = 0; i < 4; i++)
        p[i] = (uint8_t)(value >> (8 * i));
}

/* Whole numbers of either sign. */
static void store_components(components c, size_t count, size_t stride, uint8_t *out)
{
    uint32_t words[2][BATCH];
    const uint32_t mask = stride == 4 ? 0xff : 0xffff;
    for (size_t i = 0; i < count; i++) {
        const uint32_t x = (uint32_t)(int)c[0][i] & mask;
        const uint32_t y = (uint32_t)(int)c[1][i] & mask;
        const uint32_t z = (uint32_t)(int)c[2][i] & mask;
        const uint32_t w = (uint32_t)(int)c[3][i] & mask;
        words[0][i] = stride == 4 ? x | y << 8 | z << 16 | w << 24 : x | y << 16;
        words[1][i] = z | w << 16;
    }
    if (stride == 4)
        for (size_t i = 0; i < count; i++)
            store_u32(out + 4 * i, words[0][i]);
    else
        for (size_t i = 0; i < count; i++) {
            store_u32(out + 8 * i, words[0][i]);
            store_u32(out + 8 * i + 4, words[1][i]);
        }
}

/* To the nearest whole number, halves away from zero, in [-limit, limit]; what is no number, which only damaged
 * elements give, is -limit. */
static inline float round_within(float value, float limit)
{
    value += value < 0.0f ? -0.5f : 0.5f;
    value = value > -limit ? value : -limit;
    value = value < limit ? value : limit;
    return (float)(int)value;
}

/* Unit vectors, octahedral: x and y, and 1 as a whole number; what is fourth stays. scale: 1 in the result. */
static void decode_octahedral(components c, size_t count, float scale)
{
    for (size_t i = 0; i < count; i++) {
        float x = c[0][i] / c[2][i];
        float y = c[1][i] / c[2][i];
        const float z = 1.0f - fabsf(x) - fabsf(y);
        const float t = z < 0.0f ? z : 0.0f; /* the corners are the lower half, folded outwards */
        x += x < 0.0f ? -t : t;
        y += y < 0.0f ? -t : t;
        const float to_scale = scale / sqrtf(x * x + y * y + z * z);
        c[0][i] = round_within(x * to_scale, scale);
        c[1][i] = round_within(y * to_scale, scale);
        c[2][i] = round_within(z * to_scale, scale);
    }
}

/* Unit quaternions: three components, scaled by sqrt(2) since the largest is left out; the fourth has 1 as a whole
 * number, but for its lowest two bits, which say which one that is. */
static void decode_quaternion(components c, size_t count, float scale)
{
    const float range = 0.70710678f * scale;
    for (size_t i = 0; i < count; i++) {
        const int one = (int)c[3][i];
        const int largest = one & 3;
        const float to_scale = range / (float)(one | 3);
        const float x = c[0][i] * to_scale;
        const float y = c[1][i] * to_scale;
        const float z = c[2][i] * to_scale;
        const float rest = scale * scale - x * x - y * y - z * z;
        const float w = sqrtf(rest > 0.0f ? rest : 0.0f);
        for (int k = 0; k < 4; k++) {
            const int after = (k - largest) & 3; /* how far behind the largest */
            const float value = after == 0 ? w : after == 1 ? x : after == 2 ? y : z;
            c[k][i] = round_within(value, scale);
        }
    }
}

/* YCoCg and alpha of K bits, alpha one bit less under a leading 1 that tells K, to RGBA of limit. */
static void decode_color(components c, size_t count, float limit)
{
    for (size_t i = 0; i < count; i++) {
        const float alpha = c[3][i] > 1.0f ? c[3][i] : 1.0f; /* 0 has no leading 1 */
        uint32_t bits;
        memcpy(&bits, &alpha, sizeof bits);
        bits &= 0x7f800000;
        float leading;
        memcpy(&leading, &bits, sizeof leading);
        const float scale = limit / (2.0f * leading - 1.0f); /* K ones */
        const int low = (int)(alpha - leading);
        const float y = c[0][i];
        const float orange = c[1][i];
        const float green = c[2][i];
        const float rgba[4] = {y + orange - green, y + green, y - orange - green,
                               (float)(low << 1 | (low & 1))};
        for (int k = 0; k < 4; k++)
            c[k][i] = round_within(rgba[k] > 0.0f ? rgba[k] * scale : 0.0f, limit);
    }
}

/* Elements are little-endian: a word as the machine has it, and back. */
static inline uint32_t native_32(uint32_t v)
{
    return __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__ ? v : __builtin_bswap32(v);
}

/* 8 bits of exponent over 24 of mantissa, both signed: 2^e m. Exponents that no encoder may write (beyond 100) stay
 * within those of floats. */
static void filter_exponential(uint32_t *words, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const uint32_t word = native_32(words[i]);
        const int32_t e = (int32_t)word >> 24;
        const int32_t m = (int32_t)(word << 8) >> 8;
        const uint32_t power_bits = (uint32_t)((e < -126 ? -126 : e) + 127) << 23;
        float power;
        memcpy(&power, &power_bits, sizeof power);
        const float value = power * (float)m;
        uint32_t bits;
        memcpy(&bits, &value, sizeof bits);
        words[i] = native_32(bits);
    }
}

void meshopt_apply_filter(meshopt_filter filter, uint8_t *elements, size_t count, size_t stride)
{
    if (filter == MESHOPT_NONE)
        return;
    if (filter == MESHOPT_EXPONENTIAL) {
        void *words = elements;
        filter_exponential(words, count * (stride / 4));
        return;
    }
    const float signed_limit = stride == 4 ? 127.0f : 32767.0f;
    components c;
    for (size_t i = 0; i < count; i += BATCH) {
        const size_t n = count - i < BATCH ? count - i : BATCH;
        uint8_t *at = elements + i * stride;
        load_components(at, n, stride, true, c);
        if (filter == MESHOPT_OCTAHEDRAL) {
            decode_octahedral(c, n, signed_limit);
        } else if (filter == MESHOPT_QUATERNION) {
            decode_quaternion(c, n, signed_limit);
        } else {
            components plain; /* luma and alpha have no sign */
            load_components(at, n, stride, false, plain);
            memcpy(c[0], plain[0], sizeof c[0]);
            memcpy(c[3], plain[3], sizeof c[3]);
            decode_color(c, n, stride == 4 ? 255.0f : 65535.0f);
        }
        store_components(c, n, stride, at);
    }
}
