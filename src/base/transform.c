/* transform.c - see transform.h. */
#include "base/transform.h"

#include <math.h>
#include <string.h>

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

typedef struct axis3 {
    double v[3];
} axis3;

static double dot3(axis3 a, axis3 b)
{
    return a.v[0] * b.v[0] + a.v[1] * b.v[1] + a.v[2] * b.v[2];
}

static axis3 cross3(axis3 a, axis3 b)
{
    return (axis3){{a.v[1] * b.v[2] - a.v[2] * b.v[1], a.v[2] * b.v[0] - a.v[0] * b.v[2],
                    a.v[0] * b.v[1] - a.v[1] * b.v[0]}};
}

static axis3 unit3(axis3 a)
{
    double length = sqrt(dot3(a, a));
    for (int i = 0; i < 3 && length > 0.0; i++)
        a.v[i] /= length;
    return a;
}

/* A unit vector perpendicular to a; +X if that is 0. */
static axis3 perpendicular(axis3 a)
{
    int smallest = 0;
    for (int i = 1; i < 3; i++)
        if (fabs(a.v[i]) < fabs(a.v[smallest]))
            smallest = i;
    axis3 b = {{smallest == 0, smallest == 1, smallest == 2}};
    return dot3(a, a) > 0.0 ? unit3(cross3(a, b)) : (axis3){{1, 0, 0}};
}

/* Replaces unit axes of length 0 to complete a basis. */
static void complete_axes(axis3 axes[3])
{
    for (int i = 0; i < 3; i++) {
        axis3 *next = &axes[(i + 1) % 3];
        axis3 *last = &axes[(i + 2) % 3];
        if (dot3(axes[i], axes[i]) > 0.0)
            continue;
        axes[i] = unit3(cross3(*next, *last));
        if (dot3(axes[i], axes[i]) == 0.0)
            axes[i] = perpendicular(dot3(*next, *next) > 0.0 ? *next : *last);
    }
}

/* Shepperd 1978: the largest of the four components first, so that nothing cancels. */
static void quaternion_from_axes(const axis3 axes[3], float rotation[4])
{
    double q[4];
    double trace = axes[0].v[0] + axes[1].v[1] + axes[2].v[2];
    int largest = 3;
    double most = trace;
    for (int i = 0; i < 3; i++)
        if (axes[i].v[i] > most) {
            largest = i;
            most = axes[i].v[i];
        }
    if (largest == 3) {
        double s = 2.0 * sqrt(1.0 + trace); /* 4 w */
        q[3] = 0.25 * s;
        for (int i = 0; i < 3; i++)
            q[i] = (axes[(i + 1) % 3].v[(i + 2) % 3] - axes[(i + 2) % 3].v[(i + 1) % 3]) / s;
    } else {
        int i = largest;
        int j = (i + 1) % 3;
        int k = (i + 2) % 3;
        double s = 2.0 * sqrt(1.0 + axes[i].v[i] - axes[j].v[j] - axes[k].v[k]);
        q[i] = 0.25 * s;
        q[j] = (axes[i].v[j] + axes[j].v[i]) / s;
        q[k] = (axes[i].v[k] + axes[k].v[i]) / s;
        q[3] = (axes[j].v[k] - axes[k].v[j]) / s;
    }
    for (int i = 0; i < 4; i++)
        rotation[i] = (float)q[i];
}

void mat4_to_trs(const mat4 *a, float translation[3], float rotation[4], float scale[3])
{
    axis3 axes[3];
    for (int column = 0; column < 3; column++) {
        for (int row = 0; row < 3; row++)
            axes[column].v[row] = (double)a->m[4 * column + row];
        scale[column] = (float)sqrt(dot3(axes[column], axes[column]));
        axes[column] = unit3(axes[column]);
    }
    complete_axes(axes);
    if (dot3(cross3(axes[0], axes[1]), axes[2]) < 0.0) {
        scale[0] = -scale[0];
        for (int row = 0; row < 3; row++)
            axes[0].v[row] = -axes[0].v[row];
    }
    double along = dot3(axes[0], axes[1]);
    for (int row = 0; row < 3; row++)
        axes[1].v[row] -= along * axes[0].v[row];
    axes[1] = dot3(axes[1], axes[1]) > 1e-12 ? unit3(axes[1]) : perpendicular(axes[0]);
    axes[2] = cross3(axes[0], axes[1]);
    quaternion_from_axes(axes, rotation);
    memcpy(translation, a->m + 12, 3 * sizeof *translation);
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

/* ---- in double ---- */

dmat4 dmat4_identity(void)
{
    return (dmat4){{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}};
}

dmat4 dmat4_multiply(const dmat4 *a, const dmat4 *b)
{
    dmat4 out;
    for (int column = 0; column < 4; column++)
        for (int row = 0; row < 4; row++) {
            double sum = 0.0;
            for (int k = 0; k < 4; k++)
                sum += a->m[4 * k + row] * b->m[4 * column + k];
            out.m[4 * column + row] = sum;
        }
    return out;
}

dmat4 dmat4_translation(const double translation[3])
{
    dmat4 out = dmat4_identity();
    memcpy(out.m + 12, translation, 3 * sizeof *translation);
    return out;
}

dmat4 dmat4_from_trs(const double translation[3], const float rotation[4], const float scale[3])
{
    double q[4] = {(double)rotation[0], (double)rotation[1], (double)rotation[2], (double)rotation[3]};
    double length = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (int i = 0; i < 4; i++)
        q[i] = length > 0.0 ? q[i] / length : i == 3;
    double x = q[0], y = q[1], z = q[2], w = q[3];
    const double axes[9] = {
        1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + z * w),       2.0 * (x * z - y * w),
        2.0 * (x * y - z * w),       1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + x * w),
        2.0 * (x * z + y * w),       2.0 * (y * z - x * w),       1.0 - 2.0 * (x * x + y * y)};
    dmat4 out = dmat4_translation(translation);
    for (int column = 0; column < 3; column++)
        for (int row = 0; row < 3; row++)
            out.m[4 * column + row] = axes[3 * column + row] * (double)scale[column];
    return out;
}

dmat4 dmat4_from_float(const mat4 *a)
{
    dmat4 out;
    for (int i = 0; i < 16; i++)
        out.m[i] = (double)a->m[i];
    return out;
}

mat4 mat4_from_double(const dmat4 *a)
{
    mat4 out;
    for (int i = 0; i < 16; i++)
        out.m[i] = (float)a->m[i];
    return out;
}

void dmat4_transform_point(const dmat4 *a, const double p[3], double out[3])
{
    double x = p[0], y = p[1], z = p[2];
    for (int row = 0; row < 3; row++)
        out[row] = a->m[row] * x + a->m[4 + row] * y + a->m[8 + row] * z + a->m[12 + row];
}
