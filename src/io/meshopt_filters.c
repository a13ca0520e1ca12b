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

/* ---- unit vectors ---- */

/* Octahedral (x, y) with 1 as a whole number beside them, to a vector of length scale. */
static inline void decode_octahedral(float in_x, float in_y, float one, float scale, float out[3])
{
    float x = in_x / one;
    float y = in_y / one;
    const float z = 1.0f - fabsf(x) - fabsf(y);
    const float t = z < 0.0f ? z : 0.0f; /* the lower half is folded outwards */
    x += x < 0.0f ? t : -t;
    y += y < 0.0f ? t : -t;
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

static void filter_octahedral_16(int16_t *elements, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        int16_t *e = elements + 4 * i;
        float v[3];
        decode_octahedral((float)e[0], (float)e[1], (float)e[2], 32767.0f, v);
        for (int k = 0; k < 3; k++)
            e[k] = (int16_t)v[k];
    }
}

/* ---- rotations ---- */

/* Three components of a unit quaternion, scaled by sqrt(2) since the largest is left out; the fourth element has 1 as a
 * whole number, but for its lowest two bits, which say which one that is. */
static void filter_quaternion(int16_t *elements, size_t count)
{
    const float range = 0.70710678f * 32767.0f;
    for (size_t i = 0; i < count; i++) {
        int16_t *e = elements + 4 * i;
        const float scale = range / (float)(e[3] | 3);
        const float x = (float)e[0] * scale;
        const float y = (float)e[1] * scale;
        const float z = (float)e[2] * scale;
        const float rest = 32767.0f * 32767.0f - x * x - y * y - z * z;
        const float w = sqrtf(rest > 0.0f ? rest : 0.0f);
        const int largest = e[3] & 3;
        e[(largest + 1) & 3] = (int16_t)round_within(x, 32767.0f);
        e[(largest + 2) & 3] = (int16_t)round_within(y, 32767.0f);
        e[(largest + 3) & 3] = (int16_t)round_within(z, 32767.0f);
        e[largest] = (int16_t)round_within(w, 32767.0f);
    }
}

/* ---- floats ---- */

/* 8 bits of exponent over 24 of mantissa, both signed: 2^e m. Exponents that no encoder may write (beyond 100) stay
 * within those of floats. */
static void filter_exponential(uint32_t *words, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const int32_t e = (int32_t)words[i] >> 24;
        const int32_t m = (int32_t)(words[i] << 8) >> 8;
        const uint32_t power_bits = (uint32_t)((e < -126 ? -126 : e) + 127) << 23;
        float power;
        memcpy(&power, &power_bits, sizeof power);
        const float value = power * (float)m;
        memcpy(&words[i], &value, sizeof value);
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
        decode_color(e[0], (int16_t)e[1], (int16_t)e[2], e[3], 65535.0f, rgba);
        for (int k = 0; k < 4; k++)
            e[k] = (uint16_t)rgba[k];
    }
}
