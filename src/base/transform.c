/* transform.c - see transform.h. */
#include "base/transform.h"

mat4 mat4_identity(void)
{
    return (mat4){{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}};
}

mat4 mat4_multiply(mat4 a, mat4 b)
{
    mat4 out;
    for (int column = 0; column < 4; column++)
        for (int row = 0; row < 4; row++) {
            float sum = 0.0f;
            for (int k = 0; k < 4; k++)
                sum += a.m[4 * k + row] * b.m[4 * column + k];
            out.m[4 * column + row] = sum;
        }
    return out;
}

mat4 mat4_from_trs(const float translation[3], const float rotation[4], const float scale[3])
{
    float x = rotation[0], y = rotation[1], z = rotation[2], w = rotation[3];
    return (mat4){{
        (1.0f - 2.0f * (y * y + z * z)) * scale[0],
        2.0f * (x * y + z * w) * scale[0],
        2.0f * (x * z - y * w) * scale[0],
        0.0f,
        2.0f * (x * y - z * w) * scale[1],
        (1.0f - 2.0f * (x * x + z * z)) * scale[1],
        2.0f * (y * z + x * w) * scale[1],
        0.0f,
        2.0f * (x * z + y * w) * scale[2],
        2.0f * (y * z - x * w) * scale[2],
        (1.0f - 2.0f * (x * x + y * y)) * scale[2],
        0.0f,
        translation[0],
        translation[1],
        translation[2],
        1.0f,
    }};
}

float mat4_determinant3(mat4 a)
{
    const float *m = a.m;
    return m[0] * (m[5] * m[10] - m[9] * m[6]) - m[4] * (m[1] * m[10] - m[9] * m[2]) +
           m[8] * (m[1] * m[6] - m[5] * m[2]);
}

void mat4_transform_point(const mat4 *a, const float p[3], float out[3])
{
    const float *m = a->m;
    float x = p[0], y = p[1], z = p[2];
    out[0] = m[0] * x + m[4] * y + m[8] * z + m[12];
    out[1] = m[1] * x + m[5] * y + m[9] * z + m[13];
    out[2] = m[2] * x + m[6] * y + m[10] * z + m[14];
}

void mat4_transform_vector(const mat4 *a, const float v[3], float out[3])
{
    const float *m = a->m;
    float x = v[0], y = v[1], z = v[2];
    out[0] = m[0] * x + m[4] * y + m[8] * z;
    out[1] = m[1] * x + m[5] * y + m[9] * z;
    out[2] = m[2] * x + m[6] * y + m[10] * z;
}

void mat4_normal_matrix(const mat4 *a, float out[9])
{
    const float *m = a->m;
    out[0] = m[5] * m[10] - m[6] * m[9];
    out[1] = m[2] * m[9] - m[1] * m[10];
    out[2] = m[1] * m[6] - m[2] * m[5];
    out[3] = m[6] * m[8] - m[4] * m[10];
    out[4] = m[0] * m[10] - m[2] * m[8];
    out[5] = m[2] * m[4] - m[0] * m[6];
    out[6] = m[4] * m[9] - m[5] * m[8];
    out[7] = m[1] * m[8] - m[0] * m[9];
    out[8] = m[0] * m[5] - m[1] * m[4];
}
