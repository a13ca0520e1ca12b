/* half.h - conversion of IEEE 754 binary16 numbers, as in textures and EXR files. */
#ifndef IMAGE_HALF_H
#define IMAGE_HALF_H

#include <stdint.h>
#include <string.h>

static inline uint32_t float_bits(float x)
{
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

static inline float float_from_bits(uint32_t bits)
{
    float x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

/* Exact for all 65536 codes; NaN keeps its payload. Multiplication by 2^112 rebases the exponent from 15 to
 * 127 and normalises subnormals. Branch-free, so that loops vectorise. */
static inline float half_to_float(uint16_t half)
{
    uint32_t magnitude = (uint32_t)(half & 0x7fffu) << 13;
    uint32_t finite = float_bits(float_from_bits(magnitude) * 0x1p112f);
    uint32_t special = magnitude | 0x7f800000u;
    uint32_t is_special = 0u - (uint32_t)(magnitude >= 0x0f800000u);
    uint32_t bits = (special & is_special) | (finite & ~is_special);
    return float_from_bits(bits | (uint32_t)(half & 0x8000u) << 16);
}

/* Rounds to nearest, ties to even, as in IEEE 754: values of at least 65520 become infinity, of at most 2^-25
 * zero; NaN becomes the quiet NaN. For normal results the carry of rounding may propagate into the exponent,
 * as it should; for subnormal ones, adding 0.5 moves the unit of 2^-24 to the end of the float's significand,
 * so that the addition rounds. */
static inline uint16_t half_from_float(float x)
{
    uint32_t bits = float_bits(x);
    uint32_t sign = bits >> 16 & 0x8000u;
    uint32_t magnitude = bits & 0x7fffffffu;
    uint32_t normal = (magnitude - 0x38000000u + 0xfffu + (magnitude >> 13 & 1u)) >> 13;
    uint32_t subnormal = float_bits(float_from_bits(magnitude) + 0.5f) - 0x3f000000u;
    uint32_t special = magnitude > 0x7f800000u ? 0x7e00u : 0x7c00u;
    uint32_t half = magnitude >= 0x477ff000u ? special : magnitude < 0x38800000u ? subnormal : normal;
    return (uint16_t)(sign | half);
}

#endif
