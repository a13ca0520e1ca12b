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

#endif
