/* simd.h - vectors of floats for bulk loops, and functions compiled for several instruction sets, of which
 * one is chosen at program start. */
#ifndef BASE_SIMD_H
#define BASE_SIMD_H

/* Eight values of a loop over an array. */
typedef float float8 __attribute__((vector_size(32), may_alias));

/* Before a static function: compiles it twice, for AVX2 and for plain x86-64, without fused multiply-adds,
 * so that both give the same bits. Empty elsewhere, and under sanitizers, which run before the choice can be
 * made. The function's name must be unique in the library: clang's resolvers are global. */
#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer)
#define DISPATCH_AVX2
#endif
#endif
#if !defined(DISPATCH_AVX2) && (defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__))
#define DISPATCH_AVX2
#endif
#if !defined(DISPATCH_AVX2) && defined(__x86_64__) && defined(__linux__)
#define DISPATCH_AVX2 __attribute__((target_clones("avx2", "default")))
#endif
#ifndef DISPATCH_AVX2
#define DISPATCH_AVX2
#endif

#endif
