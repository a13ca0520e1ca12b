/* support.h - shared by the tests of all modules: how many cases to run, random numbers, comparison with a
 * tolerance, failing allocations, captured messages, temporary folders, sRGB in double. Include after
 * cmocka.h. */
#ifndef TESTS_SUPPORT_H
#define TESTS_SUPPORT_H

#include <math.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdint.h>

#include "facet/facet.h"

#define COUNT_OF(a) (sizeof(a) / sizeof *(a))

/* ---- how many cases ---- */

/* Long tests run a part of their cases in builds without optimisation, under sanitizers, and where another
 * build of the same run does all of them (FACET_TRUTH is off): every third where a test steps by
 * CASE_STEP. */
#if defined(FACET_QUICK_TESTS) || !defined(__OPTIMIZE__)
enum { IS_SLOW = 1, CASE_STEP = 3 };
#else
enum { IS_SLOW = 0, CASE_STEP = 1 };
#endif

/* The allocation to fail after the nth, in tests that let one after the other fail: the next, or a later
 * one where IS_SLOW. */
static inline long next_failure(long n)
{
    return n + 1 + (IS_SLOW ? n / 8 : 0);
}

/* ---- random numbers, the same in every run ---- */

/* PCG-XSH-RR (O'Neill 2014): the generator for new tests. */
typedef struct test_rng {
    uint64_t state;
} test_rng;
static inline uint32_t rng_uint(test_rng *rng)
{
    uint64_t old = rng->state;
    rng->state = old * 6364136223846793005u + 1442695040888963407u;
    uint32_t x = (uint32_t)(((old >> 18u) ^ old) >> 27u);
    uint32_t r = (uint32_t)(old >> 59u);
    return (x >> r) | (x << ((32u - r) & 31u));
}
static inline float rng_float(test_rng *rng) /* [0, 1) */
{
    return (float)(rng_uint(rng) >> 8u) * 0x1p-24f;
}

/* Linear congruential generators (Knuth; Numerical Recipes), of which the high bits are random; both
 * return the new state. */
static inline uint32_t lcg_next(uint32_t *state)
{
    return *state = *state * 1664525u + 1013904223u;
}
static inline uint64_t lcg64_next(uint64_t *state)
{
    return *state = *state * 6364136223846793005u + 1442695040888963407u;
}
static inline float lcg_float(uint32_t *state) /* [0, 1) */
{
    return (float)(lcg_next(state) >> 8) * 0x1p-24f;
}
static inline double lcg64_double(uint64_t *state) /* [0, 1) */
{
    return (double)(lcg64_next(state) >> 11) * 0x1p-53;
}

/* ---- comparison ---- */

/* |a - b| <= tolerance in double; cmocka compares floats only. NaN fails. */
#define assert_near(a, b, tolerance)                                                                         \
    assert_near_((double)(a), (double)(b), (double)(tolerance), __FILE__, __LINE__)
void assert_near_(double a, double b, double tolerance, const char *file, int line);

/* The sRGB transfer function (IEC 61966-2-1) of a value in [0, 1], and its inverse. */
double srgb_encode(double linear);
double srgb_decode(double encoded);

/* ---- memory ---- */

/* An allocator that refuses call number fail_at (from 0; negative: none). */
typedef struct failing_allocator {
    long fail_at;
    atomic_long calls;  /* of allocate, so far */
    atomic_long blocks; /* in use */
} failing_allocator;
facet_allocator failing_allocator_get(failing_allocator *f);

/* ---- messages ---- */

/* The messages of a facet_log: their number and texts, a line each, as far as there is space. */
typedef struct captured_messages {
    int count;
    char text[8000];
} captured_messages;
facet_log capture_log(captured_messages *messages);

/* ---- progress ---- */

/* What a facet_progress receives: the number of calls, and the last stage and fraction. The test fails unless
 * fractions rise in [0, 1]. Call number stops_at (from 1; 0: none) cancels. */
typedef struct captured_progress {
    int stops_at, calls;
    const char *stage;
    double fraction;
} captured_progress;
facet_progress capture_progress(captured_progress *progress);

/* ---- test data ---- */

/* The folder that FACET_TEST_DATA names; skips the test, with a message, where it names none. */
const char *test_data(void);

/* ---- files ---- */

/* A new temporary folder; temporary_folder_remove() removes it with its contents. */
typedef struct temporary_folder {
    char path[64];
} temporary_folder;
void temporary_folder_create(temporary_folder *folder);
void temporary_folder_remove(const temporary_folder *folder);

/* The path of a file in the folder: valid until the fourth call after this one. */
const char *temporary_folder_file(const temporary_folder *folder, const char *name);
/* Writes a file, and the folder that "a/b" is in; returns its path as above. */
const char *temporary_folder_put(const temporary_folder *folder, const char *name, const void *bytes,
                                 size_t size);
/* The same: a PNG image of one white texel. */
const char *temporary_folder_put_png(const temporary_folder *folder, const char *name);

#endif
