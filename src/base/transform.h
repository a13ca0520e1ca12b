/* transform.h - 4x4 matrices, column-major as in glTF: m[4 * column + row], points are columns. */
#ifndef BASE_TRANSFORM_H
#define BASE_TRANSFORM_H

typedef struct mat4 {
    float m[16];
} mat4;

mat4 mat4_identity(void);
mat4 mat4_multiply(mat4 a, mat4 b); /* a b: first b, then a */
/* Translation, then rotation (unit quaternion x y z w), then scale, as glTF: T R S. */
mat4 mat4_from_trs(const float translation[3], const float rotation[4], const float scale[3]);
/* Translation, rotation and scale whose mat4_from_trs() is a, if a has no shear (otherwise the axes keep
 * their lengths and X its direction). A reflection is in the scale of X. */
void mat4_to_trs(const mat4 *a, float translation[3], float rotation[4], float scale[3]);
/* Determinant of the upper left 3x3: negative if handedness flips. */
float mat4_determinant3(mat4 a);
void mat4_transform_point(const mat4 *a, const float p[3], float out[3]); /* w taken as 1, last row ignored */
void mat4_transform_vector(const mat4 *a, const float v[3], float out[3]); /* w taken as 0 */
/* The cofactor matrix of the upper left 3x3 (rows out[0..2], ..): transforms normals, up to a positive factor
 * times the sign of the determinant. */
void mat4_normal_matrix(const mat4 *a, float out[9]);

/* The same layout in double, for coordinates far from the origin. */
typedef struct dmat4 {
    double m[16];
} dmat4;

dmat4 dmat4_identity(void);
dmat4 dmat4_multiply(const dmat4 *a, const dmat4 *b);
dmat4 dmat4_translation(const double translation[3]);
/* The rotation need not be unit to double precision; one of length 0 counts as the identity. */
dmat4 dmat4_from_trs(const double translation[3], const float rotation[4], const float scale[3]);
dmat4 dmat4_from_float(const mat4 *a);
mat4 mat4_from_double(const dmat4 *a); /* rounded; beyond the largest float: infinite */
void dmat4_transform_point(const dmat4 *a, const double p[3], double out[3]);

#endif
