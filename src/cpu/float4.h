/* float4.h - four floats in a vector register: what the bounding volume hierarchy is built and traversed with. */
#ifndef CPU_FLOAT4_H
#define CPU_FLOAT4_H

#include <stdint.h>

typedef float float4 __attribute__((vector_size(16), may_alias));
typedef int32_t int4 __attribute__((vector_size(16), may_alias)); /* of a comparison: -1 true, 0 false */

static inline float4 float4_all(float x)
{
    return (float4){x, x, x, x};
}

static inline float4 float4_select(int4 mask, float4 yes, float4 no)
{
    return (float4)((mask & (int4)yes) | (~mask & (int4)no));
}

/* Lanes a < b ? a : b and a > b ? a : b (b where one is no number), and the sign bits of the lanes, lane 0 in bit 0. */
#if defined(__SSE__)
static inline float4 float4_min(float4 a, float4 b)
{
    return __builtin_ia32_minps(a, b);
}
static inline float4 float4_max(float4 a, float4 b)
{
    return __builtin_ia32_maxps(a, b);
}
static inline uint32_t int4_bits(int4 mask)
{
    return (uint32_t)__builtin_ia32_movmskps((float4)mask);
}
#else
static inline float4 float4_min(float4 a, float4 b)
{
    return float4_select(a < b, a, b);
}
static inline float4 float4_max(float4 a, float4 b)
{
    return float4_select(a > b, a, b);
}
static inline uint32_t int4_bits(int4 mask)
{
    return ((uint32_t)mask[0] & 1) | ((uint32_t)mask[1] & 2) | ((uint32_t)mask[2] & 4) |
           ((uint32_t)mask[3] & 8);
}
#endif

#endif
