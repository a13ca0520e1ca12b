/* test_effort.h - how much tests do. */
#ifndef BASE_TEST_EFFORT_H
#define BASE_TEST_EFFORT_H

/* Long tests do a part of their cases where nothing is optimised, a sanitizer looks on, or another build of the same run does
 * them all (FACET_TRUTH is off). */
#if defined(FACET_QUICK_TESTS) || !defined(__OPTIMIZE__)
enum { IS_SLOW = 1 };
#else
enum { IS_SLOW = 0 };
#endif

/* Which call for memory is to fail after the nth, in tests that let one after the other fail: each, or fewer the later they
 * come. */
static inline long next_failure(long n)
{
    return n + 1 + (IS_SLOW ? n / 8 : 0);
}

#endif
