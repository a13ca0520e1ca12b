/* near_test.h - for tests: numbers that are close. Include after cmocka.h. */
#ifndef BASE_NEAR_TEST_H
#define BASE_NEAR_TEST_H

#include <math.h>

/* |a - b| <= tolerance, in double (cmocka compares floats only). */
#define assert_near(a, b, tolerance)                                                                         \
    assert_near_((double)(a), (double)(b), (double)(tolerance), __FILE__, __LINE__)
static inline void assert_near_(double a, double b, double tolerance, const char *file, int line)
{
    if (fabs(a - b) <= tolerance)
        return;
    print_error("%.12g is not within %.3g of %.12g\n", a, tolerance, b);
    _fail(file, line);
}

#endif
