/* Tests of transform.h against their definitions. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "tests/support/support.h"
#include "base/transform.h"

/* 90 degrees around +Z, scale 2 along X, then translate. */
static mat4 example(void)
{
    const float t[3] = {1, 2, 3};
    const float r[4] = {0, 0, sqrtf(0.5f), sqrtf(0.5f)};
    const float s[3] = {2, 1, 1};
    return mat4_from_trs(t, r, s);
}

static void trs_scales_then_rotates_then_translates(void **state)
{
    (void)state;
    mat4 m = example();
    float out[3];
    mat4_transform_point(&m, (float[3]){1, 0, 0}, out);
    const float expected[3] = {1, 4, 3};
    for (int k = 0; k < 3; k++)
        assert_near(out[k], expected[k], 1e-6f);
    assert_near(mat4_determinant3(m), 2.0f, 1e-6f);
}

static void normals_stay_perpendicular(void **state)
{
    (void)state;
    mat4 m = example();
    m.m[4] += 0.7f; /* a shear */
    const float tangent[3] = {1, 1, 0};
    const float normal[3] = {1, -1, 0};
    float n[9], t[3];
    mat4_normal_matrix(&m, n);
    mat4_transform_vector(&m, tangent, t);
    float dot = 0.0f;
    for (int k = 0; k < 3; k++)
        dot += t[k] * (n[3 * k] * normal[0] + n[3 * k + 1] * normal[1] + n[3 * k + 2] * normal[2]);
    assert_near(dot, 0.0f, 1e-5f);
}

static void matrices_without_shear_decompose_exactly(void **state)
{
    (void)state;
    static const float rotations[][4] = {{0, 0, 0, 1},
                                         {1, 0, 0, 0},
                                         {0, 1, 0, 0},
                                         {0, 0, 1, 0},
                                         {0.5f, -0.5f, 0.5f, 0.5f},
                                         {0.1f, 0.7f, -0.1f, 0.7f},
                                         {0.48f, 0.6f, 0.64f, 0}};
    static const float scales[][3] = {{1, 1, 1},  {2, 3, 4},          {-1, 1, 1}, {1, -2, 1},
                                      {1, 1, -3}, {-1e-9f, 1e9f, -1}, {0, 1, 2},  {1, 0, -2},
                                      {1, -2, 0}, {0, 0, -1},         {0, 0, 0}};
    const float translation[3] = {1, -2, 3};
    for (size_t i = 0; i < 7 * 11; i++) {
        mat4 m = mat4_from_trs(translation, rotations[i % 7], scales[i / 7]);
        float t[3], r[4], s[3];
        mat4_to_trs(&m, t, r, s);
        mat4 again = mat4_from_trs(t, r, s);
        double length = 0.0;
        for (int k = 0; k < 4; k++)
            length += (double)r[k] * (double)r[k];
        assert_near(length, 1.0, 1e-6);
        for (int k = 0; k < 16; k++)
            assert_near(again.m[k], m.m[k],
                        2e-6 * fmax(1.0, (double)fabsf(scales[i / 7][k < 12 ? k / 4 : 0])));
    }
}

static void sheared_matrices_keep_lengths_and_the_first_axis(void **state)
{
    (void)state;
    const mat4 m = {{0, 2, 0, 0, 1, 1, 0, 0, 0, 1, 3, 0, 0, 0, 0, 1}};
    float t[3], r[4], s[3], x[3];
    mat4_to_trs(&m, t, r, s);
    assert_near(fabsf(s[0]), 2.0, 1e-6);
    assert_near(s[1], sqrt(2.0), 1e-6);
    assert_near(s[2], sqrt(10.0), 1e-6);
    mat4 again = mat4_from_trs(t, r, s);
    mat4_transform_vector(&again, (float[3]){1, 0, 0}, x);
    assert_near(x[1], 2.0, 1e-6);
    assert_true(mat4_determinant3(again) * mat4_determinant3(m) > 0.0f);
}

static void doubles_agree_with_floats_and_keep_distant_places(void **state)
{
    (void)state;
    const float rotation[4] = {0.1f, 0.7f, -0.1f, 0.7f}; /* of length 1 */
    const float scale[3] = {2, -3, 0.5f};
    const double here[3] = {1, 2, 3}, there[3] = {1e8 + 0.125, -1e6 - 0.25, 1e7};
    mat4 a = mat4_from_trs((float[3]){1, 2, 3}, rotation, scale);
    dmat4 wide = dmat4_from_trs(here, rotation, scale);
    dmat4 product = dmat4_multiply(&wide, &wide);
    mat4 rounded = mat4_from_double(&product);
    mat4 expected = mat4_multiply(a, a);
    for (int i = 0; i < 16; i++) {
        assert_near(wide.m[i], a.m[i], 1e-6);
        assert_near(rounded.m[i], expected.m[i], 1e-5);
    }
    dmat4 out = dmat4_translation(there);
    const double back[3] = {-1e8, 1e6, -1e7};
    dmat4 home = dmat4_translation(back);
    dmat4 both = dmat4_multiply(&out, &home);
    double p[3];
    dmat4_transform_point(&both, (double[3]){1, 1, 1}, p);
    assert_near(p[0], 1.125, 0);
    assert_near(p[1], 0.75, 0);
    assert_near(p[2], 1.0, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(matrices_without_shear_decompose_exactly),
        cmocka_unit_test(doubles_agree_with_floats_and_keep_distant_places),
        cmocka_unit_test(sheared_matrices_keep_lengths_and_the_first_axis),
        cmocka_unit_test(trs_scales_then_rotates_then_translates),
        cmocka_unit_test(normals_stay_perpendicular),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
