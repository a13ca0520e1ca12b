/* simd.h - vector types of the bulk loops, and their dispatch at run time. */
#ifndef IBL_SIMD_H
#define IBL_SIMD_H

/* Radiance of a texel: R, G, B (cd/m^2) and a lane that nobody reads. Aligned to 16 bytes. */
typedef float rgbx __attribute__((vector_size(16)));
/* Eight values of a loop over an array. */
typedef float float8 __attribute__((vector_size(32), may_alias));

/* Compiles a function twice, for AVX2 and for plain x86-64. Without fused multiply-adds, so both give the same
 * bits. Sanitizers run before the choice between the two can be made. */
#if defined(__x86_64__) && defined(__linux__) && !defined(__SANITIZE_ADDRESS__) &&                           \
    !defined(__SANITIZE_THREAD__)
#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer)
#define IBL_DISPATCH
#endif
#endif
#ifndef IBL_DISPATCH
#define IBL_DISPATCH __attribute__((target_clones("avx2", "default")))
#endif
#else
#define IBL_DISPATCH
#endif

static inline rgbx rgbx_splat(float x)
{
    return (rgbx){x, x, x, x};
}

/* No lane below 0. */
static inline rgbx rgbx_not_negative(rgbx c)
{
    return (rgbx){c[0] > 0.0f ? c[0] : 0.0f, c[1] > 0.0f ? c[1] : 0.0f, c[2] > 0.0f ? c[2] : 0.0f, 0.0f};
}

#endif
