/* lang_test.c - the dialect's C side means what GLSL means. */
#include "testing/test_support.h"

#include "lang/lang_c_begin.h"

FN vec3 conversions(float x)
{
    return vec3(float(int(x)), float(uint(x)), float(3u));
}

#include "lang/lang_c_end.h"

static void near3(vec3 v, float x, float y, float z)
{
    expect_near((double)v[0], (double)x, 1e-6, "x");
    expect_near((double)v[1], (double)y, 1e-6, "y");
    expect_near((double)v[2], (double)z, 1e-6, "z");
}

static void test_construction(void **state)
{
    (void)state;
    near3(vec3(2.0f), 2.0f, 2.0f, 2.0f);
    near3(vec3(1.0f, 2.0f, 3.0f), 1.0f, 2.0f, 3.0f);
    near3(conversions(2.75f), 2.0f, 2.0f, 3.0f);
    vec2 v = vec2(1.5f);
    assert_true(v[0] == 1.5f && v[1] == 1.5f && vec2(1.0f, 2.0f)[1] == 2.0f);
    assert_int_equal(sizeof(vec3), 16);
    assert_int_equal(sizeof(vec2), 8);
}

static void test_scalars(void **state)
{
    (void)state;
    assert_true(mod(-0.25f, 1.0f) == 0.75f); /* unlike fmodf */
    assert_true(fract(-0.25f) == 0.75f && floor(-0.25f) == -1.0f);
    assert_true(sign(-3.0f) == -1.0f && sign(0.0f) == 0.0f && sign(2.0f) == 1.0f);
    assert_true(step(0.5f, 0.5f) == 1.0f && step(0.5f, 0.4f) == 0.0f);
    assert_true(smoothstep(0.0f, 1.0f, 0.5f) == 0.5f && smoothstep(0.0f, 1.0f, 2.0f) == 1.0f);
    assert_true(inversesqrt(4.0f) == 0.5f && exp2(3.0f) == 8.0f && log2(8.0f) == 3.0f);
    assert_true(sel(1.0f > 0.0f, 2.0f, 3.0f) == 2.0f);
    assert_true(uintBitsToFloat(floatBitsToUint(-1.5f)) == -1.5f && floatBitsToUint(1.0f) == 0x3f800000u);
    expect_near((double)atan(1.0f, -1.0f), 2.35619449, 1e-6, "atan of two");
    assert_true(clamp(NAN, 0.0f, 1.0f) == 0.0f); /* not guaranteed by GLSL; films rely on it here */
}

static void test_vectors(void **state)
{
    (void)state;
    vec3 a = vec3(1.0f, -2.0f, 3.0f), b = vec3(0.5f, 4.0f, -1.0f);
    near3(min(a, b), 0.5f, -2.0f, -1.0f);
    near3(max(a, 0.0f), 1.0f, 0.0f, 3.0f);
    near3(clamp(a, 0.0f, 2.0f), 1.0f, 0.0f, 2.0f);
    near3(clamp(a, b - 9.0f, b), 0.5f, -2.0f, -1.0f);
    near3(mix(a, b, 0.5f), 0.75f, 1.0f, 1.0f);
    near3(mix(a, b, vec3(0.0f, 1.0f, 0.5f)), 1.0f, 4.0f, 1.0f);
    near3(abs(a), 1.0f, 2.0f, 3.0f);
    near3(cross(vec3(1.0f, 0.0f, 0.0f), vec3(0.0f, 1.0f, 0.0f)), 0.0f, 0.0f, 1.0f);
    near3(1.0f - a, 0.0f, 3.0f, -2.0f);
    near3(a / 2.0f * b, 0.25f, -4.0f, -1.5f);
    near3(exp2(vec3(0.0f, 1.0f, 2.0f)), 1.0f, 2.0f, 4.0f);
    near3(log2(vec3(1.0f, 2.0f, 4.0f)), 0.0f, 1.0f, 2.0f);
    near3(pow(vec3(2.0f), vec3(1.0f, 2.0f, 3.0f)), 2.0f, 4.0f, 8.0f);
    near3(sqrt(vec3(1.0f, 4.0f, 9.0f)), 1.0f, 2.0f, 3.0f);
    near3(fract(vec3(1.25f, -0.25f, 2.0f)), 0.25f, 0.75f, 0.0f);
    expect_near((double)length(normalize(a)), 1.0, 1e-6, "normalize");
    assert_true(dot(a, b) == -10.5f && length(vec2(3.0f, 4.0f)) == 5.0f &&
                normalize(vec2(0.0f, 2.0f))[1] == 1.0f);
    vec2 c = vec2(1.0f, -2.0f), d = vec2(0.5f, 4.0f);
    assert_true(min(c, d)[0] == 0.5f && max(c, 0.0f)[1] == 0.0f && clamp(c, -1.0f, 0.0f)[1] == -1.0f);
    assert_true(mix(c, d, 0.5f)[1] == 1.0f && abs(c)[1] == 2.0f && sqrt(d)[1] == 2.0f && floor(d)[0] == 0.0f);
    assert_true(dot(c, d) == -7.5f && fract(d)[0] == 0.5f && mix(c, d, vec2(0.0f, 1.0f))[1] == 4.0f);
}

static void test_optics(void **state)
{
    (void)state;
    near3(reflect(vec3(1.0f, -1.0f, 0.0f), vec3(0.0f, 1.0f, 0.0f)), 1.0f, 1.0f, 0.0f);
    /* 45 degrees from air into water, computed independently in double */
    float r = 0.70710678f;
    near3(refract(vec3(r, -r, 0.0f), vec3(0.0f, 1.0f, 0.0f), 1.0f / 1.33f), 0.5316592340f, -0.8469583573f,
          0.0f);
    near3(refract(vec3(r, -r, 0.0f), vec3(0.0f, 1.0f, 0.0f), 1.5f), 0.0f, 0.0f, 0.0f); /* total reflection */
}

static void test_matrices(void **state)
{
    (void)state;
    mat3 m = mat3(vec3(1.0f, 2.0f, 3.0f), vec3(4.0f, 5.0f, 6.0f), vec3(7.0f, 8.0f, 10.0f));
    near3(mul(m, vec3(1.0f, 0.0f, 0.0f)), 1.0f, 2.0f, 3.0f); /* columns */
    near3(COL(m, 2), 7.0f, 8.0f, 10.0f);
    near3(COL(transpose(m), 0), 1.0f, 4.0f, 7.0f);
}

/* After the shader text, the C library's functions keep the precision of double. */
static void test_type_generic(void **state)
{
    (void)state;
    double third = 1.0 / 3.0;
    assert_true(sin(third) * sin(third) + cos(third) * cos(third) > 1.0 - 1e-15);
    assert_true(fabs(sqrt(2.0) - 1.41421356237309505) < 1e-15 && fabs(exp(log(third)) - third) < 1e-15);
    assert_true(fabs(4.0 * atan(1.0) - 3.14159265358979324) < 1e-15 && abs(-3) == 3 && abs(-third) == third);
    assert_true(sizeof sqrt(2.0) == sizeof(double) && sizeof sqrt(2.0f) == sizeof(float));
    assert_true(atan(1.0f, -1.0f) > 2.35f && pow(third, 2.0) < 0.1112 && floor(vec3(1.5f))[2] == 1.0f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_construction), cmocka_unit_test(test_scalars),
        cmocka_unit_test(test_vectors),      cmocka_unit_test(test_optics),
        cmocka_unit_test(test_matrices),     cmocka_unit_test(test_type_generic)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
