/* near_test.h - what the tests of this folder share. Include after cmocka.h. */
#ifndef IBL_NEAR_TEST_H
#define IBL_NEAR_TEST_H

#include <math.h>

/* cmocka compares floats only. */
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
