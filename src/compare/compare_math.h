/* compare_math.h - powers for loops over pixels, free of branches and library calls so that the loops
 * vectorise, with the same bits on every machine, which libm does not guarantee. */
#ifndef COMPARE_MATH_H
#define COMPARE_MATH_H

#include <stdbool.h>

#include "image/half.h"

/* is_first ? first : second by a mask; compilers turn the operator into branches, which keep loops from
 * vectorising. */
static inline float compare_pick(bool is_first, float first, float second)
{
    uint32_t mask = 0u - (uint32_t)is_first;
    return float_from_bits((float_bits(first) & mask) | (float_bits(second) & ~mask));
}

static inline float compare_clamp(float x, float least, float most)
{
    x = compare_pick(x > least, x, least); /* NaN becomes least */
    return compare_pick(x < most, x, most);
}

/* log2(x) of a normal x > 0 to 2e-7 absolute, by log(m) = 2 artanh((m - 1) / (m + 1)) with m in
 * [sqrt(1/2), sqrt(2)). */
static inline float compare_log2(float x)
{
    uint32_t bits = float_bits(x);
    int32_t exponent = (int32_t)(bits - 0x3f3504f3u) >> 23; /* 0x3f3504f3: sqrt(1/2) */
    float m = float_from_bits(bits - ((uint32_t)exponent << 23));
    float t = (m - 1.0f) / (m + 1.0f);
    float t2 = t * t;
    float series = 0.32059890f + t2 * 0.26230819f; /* 2 / (ln 2 (2 k + 1)) for k = 4, 5 */
    series = 0.41219859f + t2 * series;
    series = 0.57707802f + t2 * series;
    series = 0.96179669f + t2 * series;
    series = 2.88539008f + t2 * series;
    return (float)exponent + t * series;
}

/* 2^x to 1e-7 relative; x in [-126, 127]. The series of e^(f ln 2) with f in [-1/2, 1/2]. */
static inline float compare_exp2(float x)
{
    x = compare_clamp(x, -126.0f, 127.0f);
    int32_t whole = (int32_t)(x + 126.5f) - 126; /* to nearest; the operand of the cast is not negative */
    float f = x - (float)whole;
    float series = 1.5403530e-4f + f * 1.5252734e-5f; /* ln(2)^k / k! for k = 6, 7 */
    series = 1.3333558e-3f + f * series;
    series = 9.6181291e-3f + f * series;
    series = 5.5504109e-2f + f * series;
    series = 0.24022651f + f * series;
    series = 0.69314718f + f * series;
    series = 1.0f + f * series;
    return series * float_from_bits((uint32_t)(whole + 127) << 23);
}

/* x^y for 0 < y < 10, to 1e-6 relative for x from 1e-6 to 1e6; 0 where x is below 1e-30 or negative. */
static inline float compare_pow(float x, float y)
{
    float power = compare_exp2(y * compare_log2(compare_pick(x > 1e-30f, x, 1e-30f)));
    return compare_pick(x > 1e-30f, power, 0.0f);
}

/* The sRGB transfer function on [0, 1], and its inverse. IEC 61966-2-1. */
static inline float compare_srgb_encode(float c)
{
    float curve = 1.055f * compare_pow(c, 1.0f / 2.4f) - 0.055f;
    return compare_pick(c <= 0.0031308f, 12.92f * c, curve);
}
static inline float compare_srgb_decode(float c)
{
    float curve = compare_pow((c + 0.055f) * (1.0f / 1.055f), 2.4f);
    return compare_pick(c <= 0.04045f, c * (1.0f / 12.92f), curve);
}

#endif
