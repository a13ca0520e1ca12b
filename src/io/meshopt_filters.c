/* meshopt_filters.c - what is done to elements after mode ATTRIBUTES. Each filter is a loop over whole elements. */
#include <math.h>
#include <string.h>

#include "io/meshopt.h"

/* To the nearest whole number, halves away from zero, in [-limit, limit]; what is no number, which only damaged
 * elements give, is -limit. */
static inline float round_within(float value, float limit)
{
    value += value < 0.0f ? -0.5f : 0.5f;
    return value > -limit ? value < limit ? value : limit : -limit;
}

/* Elements are little-endian: a half or a word as the machine has it, and back. */
static inline uint16_t native_16(uint16_t v)
{
    return __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__ ? v : __builtin_bswap16(v);
}

static inline uint32_t native_32(uint32_t v)
{
    return __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__ ? v : __builtin_bswap32(v);
}

static inline int signed_16(uint16_t v)
{
    return (int16_t)native_16(v);
}

/* A rounded number, perhaps negative. */
static inline uint16_t little_16(float v)
{
    return native_16((uint16_t)(int)v);
}

/* ---- unit vectors ---- */

/* Octahedral (x, y) with 1 as a whole number beside them, to a vector of length scale. */
static inline void decode_octahedral(float in_x, float in_y, float one, float scale, float out[3])
{
    float x = in_x / one;
    float y = in_y / one;
    const float z = 1.0f - fabsf(x) - fabsf(y);
    const float t = z < 0.0f ? z : 0.0f; /* the corners are the lower half, folded outwards */
    x += x < 0.0f ? -t : t;
    y += y < 0.0f ? -t : t;
    const float to_scale = scale / sqrtf(x * x + y * y + z * z);
    out[0] = round_within(x * to_scale, scale);
    out[1] = round_within(y * to_scale, scale);
    out[2] = round_within(z * to_scale, scale);
}

static void filter_octahedral_8(int8_t *elements, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        int8_t *e = elements + 4 * i;
        float v[3];
        decode_octahedral((float)e[0], (float)e[1], (float)e[2], 127.0f, v);
        for (int k = 0; k < 3; k++)
            e[k] = (int8_t)v[k];
    }
}

static void filter_octahedral_16(uint16_t *elements, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        uint16_t *e = elements + 4 * i;
        float v[3];
        decode_octahedral((float)signed_16(e[0]), (float)signed_16(e[1]), (float)signed_16(e[2]), 32767.0f,
                          v);
        for (int k = 0; k < 3; k++)
            e[k] = little_16(v[k]);
    }
}

/* ---- rotations ---- */

/* Three components of a unit quaternion, scaled by sqrt(2) since the largest is left out; the fourth element has 1 as a
 * whole number, but for its lowest two bits, which say which one that is. */
static void filter_quaternion(uint16_t *elements, size_t count)
{
    const float range = 0.70710678f * 32767.0f;
    for (size_t i = 0; i < count; i++) {
        uint16_t *e = elements + 4 * i;
        const int largest = signed_16(e[3]) & 3;
        const float scale = range / (float)(signed_16(e[3]) | 3);
        const float x = (float)signed_16(e[0]) * scale;
        const float y = (float)signed_16(e[1]) * scale;
        const float z = (float)signed_16(e[2]) * scale;
        const float rest = 32767.0f * 32767.0f - x * x - y * y - z * z;
        e[(largest + 1) & 3] = little_16(round_within(x, 32767.0f));
        e[(largest + 2) & 3] = little_16(round_within(y, 32767.0f));
        e[(largest + 3) & 3] = little_16(round_within(z, 32767.0f));
        e[largest] = little_16(round_within(sqrtf(rest > 0.0f ? rest : 0.0f), 32767.0f));
    }
}

/* ---- floats ---- */

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

/* ---- colors ---- */

/* YCoCg and alpha of K bits, alpha one bit less under a leading 1 that tells K; to RGBA of limit. */
static inline void decode_color(int y, int co, int cg, unsigned a, float limit, float out[4])
{
    const unsigned all = a ? (2u << (31 - __builtin_clz(a))) - 1 : 1; /* K ones */
    const float scale = limit / (float)all;
    const unsigned low = a & all >> 1;
    const float rgba[4] = {(float)(y + co - cg), (float)(y + cg), (float)(y - co - cg),
                           (float)(low << 1 | (low & 1))};
    for (int k = 0; k < 4; k++) {
        const float value = rgba[k] * scale;
        out[k] = round_within(value > 0.0f ? value : 0.0f, limit);
    }
}

static void filter_color_8(uint8_t *elements, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        uint8_t *e = elements + 4 * i;
        float rgba[4];
        decode_color(e[0], (int8_t)e[1], (int8_t)e[2], e[3], 255.0f, rgba);
        for (int k = 0; k < 4; k++)
            e[k] = (uint8_t)rgba[k];
    }
}

static void filter_color_16(uint16_t *elements, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        uint16_t *e = elements + 4 * i;
        float rgba[4];
        decode_color(native_16(e[0]), signed_16(e[1]), signed_16(e[2]), native_16(e[3]), 65535.0f, rgba);
        for (int k = 0; k < 4; k++)
            e[k] = little_16(rgba[k]);
    }
}

void meshopt_apply_filter(meshopt_filter filter, uint8_t *elements, size_t count, size_t stride)
{
    void *of_any_type = elements;
    switch (filter) {
    case MESHOPT_OCTAHEDRAL:
        if (stride == 4)
            filter_octahedral_8(of_any_type, count);
        else
            filter_octahedral_16(of_any_type, count);
        break;
    case MESHOPT_QUATERNION:
        filter_quaternion(of_any_type, count);
        break;
    case MESHOPT_EXPONENTIAL:
        filter_exponential(of_any_type, count * (stride / 4));
        break;
    case MESHOPT_COLOR:
        if (stride == 4)
            filter_color_8(of_any_type, count);
        else
            filter_color_16(of_any_type, count);
        break;
    case MESHOPT_NONE:
        break;
    }
}
