/* Tests of transform.h against their definitions. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/near_test.h"
#include "base/transform.h"

/* 90 degrees around +Z, scale 2 along X, then translate. */
static mat4 example(void)
{
    const float t[3] = {1, 2, 3};
    const float r[4] = {0, 0, sqrtf(0.5f), sqrtf(0.5f)};
    const float s[3] = {2, 1, 1};
    return mat4_from_trs(t, r, s);
}

static void trs_scales_then_rotates_then_moves(void **state)
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(trs_scales_then_rotates_then_moves),
        cmocka_unit_test(normals_stay_perpendicular),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
