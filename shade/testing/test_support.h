/* test_support.h - shared by the tests of shade/: comparison with a message, random vectors, golden tables of
 * the split sum. */
#ifndef SHADE_TEST_SUPPORT_H
#define SHADE_TEST_SUPPORT_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

#include "shade/shade.h"
#include "tests/support/support.h"

/* Fails unless |value - expected| <= tolerance; NaN fails. format and its arguments say what was compared. */
static inline __attribute__((unused, format(printf, 4, 5))) void
expect_near(double value, double expected, double tolerance, const char *format, ...)
{
    if (fabs(value - expected) <= tolerance)
        return;
    char what[256];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(what, sizeof what, format, arguments);
    va_end(arguments);
    fail_msg("%s: %.10g, expected %.10g within %.2g", what, value, expected, tolerance);
}

/* The same relative to expected. */
#define expect_relative(value, expected, tolerance, ...)                                                     \
    expect_near((double)(value), (double)(expected), fabs((double)(expected)) * (tolerance), __VA_ARGS__)

static inline __attribute__((unused)) vec2 rng_vec2(test_rng *rng)
{
    float x = rng_float(rng);
    return vec2(x, rng_float(rng));
}
static inline __attribute__((unused)) vec3 rng_color(test_rng *rng)
{
    float r = rng_float(rng);
    float g = rng_float(rng);
    return vec3(r, g, rng_float(rng));
}
static inline __attribute__((unused)) vec3 rng_direction(test_rng *rng) /* uniform on the sphere */
{
    float z = 2.0f * rng_float(rng) - 1.0f;
    float phi = 2.0f * PI * rng_float(rng);
    float r = sqrt(max(1.0f - z * z, 0.0f));
    return vec3(r * cos(phi), r * sin(phi), z);
}

/* V in the plane y = 0 with that cosine. */
static inline __attribute__((unused)) vec3 view_at(float NdotV)
{
    return vec3(sqrt(1.0f - NdotV * NdotV), 0.0f, NdotV);
}

static inline __attribute__((unused)) bool is_finite3(vec3 v)
{
    return isfinite(v[0]) && isfinite(v[1]) && isfinite(v[2]);
}

/* The grid of the golden tables; rows are roughness, columns N.V. Computed by nested tanh-sinh quadrature
 * in 80-bit floats over the half vector, two refinement levels agreeing to 1e-17. */
enum { GOLDEN_ROUGHNESS_COUNT = 5, GOLDEN_NDOTV_COUNT = 5 };
static const float golden_roughness[GOLDEN_ROUGHNESS_COUNT] = {0.10f, 0.25f, 0.50f, 0.75f, 1.00f};
static const float golden_NdotV[GOLDEN_NDOTV_COUNT] = {0.05f, 0.25f, 0.50f, 0.75f, 1.00f};
typedef double golden_table[GOLDEN_ROUGHNESS_COUNT][GOLDEN_NDOTV_COUNT];

/* Split sum with height-correlated Smith: A multiplies F0, B multiplies F90. */
static const __attribute__((unused))
golden_table golden_A = {{0.2425478450, 0.7629295323, 0.9683388499, 0.9988543917, 0.9998984689},
                         {0.4492578850, 0.7580312136, 0.9556866708, 0.9923089370, 0.9956851107},
                         {0.7688192045, 0.7592543514, 0.8349161393, 0.8888141616, 0.9157850593},
                         {0.8398067681, 0.7165080086, 0.6546928351, 0.6312440025, 0.6268380177},
                         {0.8156842679, 0.5867642669, 0.4477051204, 0.3638935306, 0.3068192051}};
static const __attribute__((unused))
golden_table golden_B = {{0.7336597451, 0.2361624228, 0.03140327267, 0.001003954061, 8.755134939e-08},
                         {0.4448470451, 0.2035357355, 0.03263732940, 0.001502187630, 2.950018171e-06},
                         {0.1643125381, 0.08082754775, 0.02234729629, 0.002718728294, 2.737092643e-05},
                         {0.06511868640, 0.02794833429, 0.008483010132, 0.001641360163, 4.763906469e-05},
                         {0.03208961021, 0.01087625501, 0.002988735255, 6.330741246e-04, 3.361429473e-05}};

static inline __attribute__((unused)) vec2 golden_dfg(int r, int c)
{
    return vec2((float)golden_A[r][c], (float)golden_B[r][c]);
}

#endif
