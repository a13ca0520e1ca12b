/* meter_test.c - metering of films against values computed independently. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "film/meter.h"

/* A row of grey pixels: luminance and opacity. */
static film make_film(const float (*pixels)[2], uint32_t count)
{
    film f;
    assert_int_equal(film_create(NULL, count, 1, 0, &f, NULL), FACET_OK);
    for (uint32_t i = 0; i < count; i++)
        for (int k = 0; k < 4; k++)
            f.layers[0].pixels[4 * i + (uint32_t)k] = k < 3 ? pixels[i][0] * pixels[i][1] : pixels[i][1];
    return f;
}

static void assert_close(double a, double b)
{
    if (!(fabs(a - b) <= 1e-6 * fabs(b)))
        fail_msg("%.9g instead of %.9g", a, b);
}

static void averages_are_over_covered_pixels(void **state)
{
    (void)state;
    static const float pixels[4][2] = {{2, 1}, {8, 1}, {4, .5f}, {1000, 0}};
    film f = make_film(pixels, 4);
    assert_close(film_average(&f), 12.0 / 2.5);
    assert_close(film_log_average(&f, 0.0), exp2((1 + 3 + .5 * 2) / 2.5));
    assert_close(film_log_average(&f, 4.0), exp2((2 + 3 + .5 * 2) / 2.5));
    assert_true(film_is_covered(&f));
    film_destroy(&f);
}

static void black_counts_as_ten_stops_below_the_mean(void **state)
{
    (void)state;
    static const float pixels[2][2] = {{2, 1}, {0, 1}};
    film f = make_film(pixels, 2);
    assert_close(film_meter(&f), sqrt(2.0 / 1024.0));
    film_destroy(&f);
    static const float black[2][2] = {{0, 1}, {5, 0}};
    f = make_film(black, 2);
    assert_true(film_meter(&f) <= 0.0);
    film_destroy(&f);
    static const float nothing[2][2] = {{5, 0}, {5, 0}};
    f = make_film(nothing, 2);
    assert_true(film_meter(&f) <= 0.0 && !film_is_covered(&f) && !film_is_brighter_than(&f, 1.0f));
    film_destroy(&f);
}

static void brightness_is_judged_by_the_median(void **state)
{
    (void)state;
    static const float pixels[4][2] = {{3, 1}, {3, .1f}, {0, 1}, {9, 0}};
    film f = make_film(pixels, 4);
    assert_true(film_is_brighter_than(&f, 2.5f) && !film_is_brighter_than(&f, 3.5f));
    f.layers[0].pixels[0] = f.layers[0].pixels[1] = f.layers[0].pixels[2] = 1.0f;
    assert_false(film_is_brighter_than(&f, 2.5f));
    film_destroy(&f);
}

/* The metered exposure maps the log-average to the key; saturation at EV 15 is 1.2 * 2^15 cd/m^2. */
static void exposures_are_those_of_a_camera(void **state)
{
    (void)state;
    for (double L = 1e-3; L < 1e6; L *= 10)
        assert_close(L * exp2(meter_exposure_ev(meter_ev100(L))), METER_KEY);
    assert_close(exp2(meter_exposure_ev(15)), 1.0 / (1.2 * 32768));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(averages_are_over_covered_pixels),
        cmocka_unit_test(black_counts_as_ten_stops_below_the_mean),
        cmocka_unit_test(brightness_is_judged_by_the_median),
        cmocka_unit_test(exposures_are_those_of_a_camera),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
