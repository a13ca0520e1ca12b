/* lang_c_types.h - the vectors of the shader library in C and GLSL's functions on them, under names that
 * start with shade_ or SHADE_ (C11 + GNU vector extensions; gcc >= 12, clang >= 14). lang_c.h gives them
 * GLSL's names while shader text is read.
 *
 * A vec3 is four lanes wide; lane 3 is undefined and never read. A vec3 and a four-component vector would be
 * the same C type, so there is no vec4. Every selection on the first argument lists float and the vectors and
 * nothing else: a double (a literal without f) is a compile error. */
#ifndef LANG_C_TYPES_H
#define LANG_C_TYPES_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* One function or one selection a line: */
/* clang-format off */

typedef float shade_vec2 __attribute__((vector_size(8)));
typedef float shade_vec3 __attribute__((vector_size(16)));
typedef struct shade_mat3 { shade_vec3 c[3]; } shade_mat3; /* three columns */

#define SHADE_FN static inline __attribute__((unused))

/* ---- one function per type; f_ scalar, v2_, v3_ ---- */
SHADE_FN float shade_f_min(float a, float b) { return a < b ? a : b; }
SHADE_FN float shade_f_max(float a, float b) { return a > b ? a : b; }
SHADE_FN float shade_f_clamp(float x, float lo, float hi) { return shade_f_min(shade_f_max(x, lo), hi); }
SHADE_FN float shade_f_mix(float a, float b, float t) { return a + (b - a) * t; }
SHADE_FN float shade_f_fract(float x) { return x - floorf(x); }
SHADE_FN float shade_f_sign(float x) { return (float)((x > 0.0f) - (x < 0.0f)); }
SHADE_FN float shade_f_inversesqrt(float x) { return 1.0f / sqrtf(x); }
SHADE_FN float shade_f_step(float edge, float x) { return x < edge ? 0.0f : 1.0f; }
SHADE_FN float shade_f_smoothstep(float e0, float e1, float x)
{
    float t = shade_f_clamp((x - e0) / (e1 - e0), 0.0f, 1.0f);
    return t * t * (3.0f - 2.0f * t);
}
SHADE_FN float shade_f_mod(float x, float y) { return x - y * floorf(x / y); } /* not fmodf: sign of y */

SHADE_FN shade_vec2 shade_v2_new(float x, float y) { return (shade_vec2){x, y}; }
SHADE_FN shade_vec2 shade_v2_splat(float s) { return (shade_vec2){s, s}; }
SHADE_FN float shade_v2_dot(shade_vec2 a, shade_vec2 b) { shade_vec2 m = a * b; return m[0] + m[1]; }
SHADE_FN float shade_v2_length(shade_vec2 a) { return sqrtf(shade_v2_dot(a, a)); }
SHADE_FN shade_vec2 shade_v2_normalize(shade_vec2 a) { return a * (1.0f / shade_v2_length(a)); }
#define SHADE_V2_EACH(f, v) shade_v2_new(f((v)[0]), f((v)[1]))
#define SHADE_V2_EACH2(f, a, b) shade_v2_new(f((a)[0], (b)[0]), f((a)[1], (b)[1]))
SHADE_FN shade_vec2 shade_v2_abs(shade_vec2 a) { return SHADE_V2_EACH(fabsf, a); }
SHADE_FN shade_vec2 shade_v2_sqrt(shade_vec2 a) { return SHADE_V2_EACH(sqrtf, a); }
SHADE_FN shade_vec2 shade_v2_floor(shade_vec2 a) { return SHADE_V2_EACH(floorf, a); }
SHADE_FN shade_vec2 shade_v2_fract(shade_vec2 a) { return SHADE_V2_EACH(shade_f_fract, a); }
SHADE_FN shade_vec2 shade_v2_min(shade_vec2 a, shade_vec2 b) { return SHADE_V2_EACH2(shade_f_min, a, b); }
SHADE_FN shade_vec2 shade_v2_max(shade_vec2 a, shade_vec2 b) { return SHADE_V2_EACH2(shade_f_max, a, b); }
SHADE_FN shade_vec2 shade_v2_min_s(shade_vec2 a, float b) { return shade_v2_min(a, shade_v2_splat(b)); }
SHADE_FN shade_vec2 shade_v2_max_s(shade_vec2 a, float b) { return shade_v2_max(a, shade_v2_splat(b)); }
SHADE_FN shade_vec2 shade_v2_clamp(shade_vec2 x, shade_vec2 lo, shade_vec2 hi) { return shade_v2_min(shade_v2_max(x, lo), hi); }
SHADE_FN shade_vec2 shade_v2_clamp_s(shade_vec2 x, float lo, float hi) { return shade_v2_clamp(x, shade_v2_splat(lo), shade_v2_splat(hi)); }
SHADE_FN shade_vec2 shade_v2_mix(shade_vec2 a, shade_vec2 b, shade_vec2 t) { return a + (b - a) * t; }
SHADE_FN shade_vec2 shade_v2_mix_s(shade_vec2 a, shade_vec2 b, float t) { return a + (b - a) * t; }

SHADE_FN shade_vec3 shade_v3_new(float x, float y, float z) { return (shade_vec3){x, y, z, 0.0f}; }
SHADE_FN shade_vec3 shade_v3_splat(float s) { return (shade_vec3){s, s, s, s}; }
SHADE_FN float shade_v3_dot(shade_vec3 a, shade_vec3 b) { shade_vec3 m = a * b; return m[0] + m[1] + m[2]; }
SHADE_FN float shade_v3_length(shade_vec3 a) { return sqrtf(shade_v3_dot(a, a)); }
SHADE_FN shade_vec3 shade_v3_normalize(shade_vec3 a) { return a * (1.0f / shade_v3_length(a)); }
SHADE_FN shade_vec3 shade_v3_cross(shade_vec3 a, shade_vec3 b)
{
    return shade_v3_new(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]);
}
SHADE_FN shade_vec3 shade_v3_reflect(shade_vec3 i, shade_vec3 n) { return i - n * (2.0f * shade_v3_dot(n, i)); }
SHADE_FN shade_vec3 shade_v3_refract(shade_vec3 i, shade_vec3 n, float eta) /* eta: ior before / ior behind; 0
                                                                             * for total internal reflection */
{
    float c = shade_v3_dot(n, i);
    float k = 1.0f - eta * eta * (1.0f - c * c);
    return k < 0.0f ? shade_v3_splat(0.0f) : i * eta - n * (eta * c + sqrtf(k));
}
#define SHADE_V3_EACH(f, v) shade_v3_new(f((v)[0]), f((v)[1]), f((v)[2]))
#define SHADE_V3_EACH2(f, a, b) shade_v3_new(f((a)[0], (b)[0]), f((a)[1], (b)[1]), f((a)[2], (b)[2]))
SHADE_FN shade_vec3 shade_v3_abs(shade_vec3 a) { return SHADE_V3_EACH(fabsf, a); }
SHADE_FN shade_vec3 shade_v3_sqrt(shade_vec3 a) { return SHADE_V3_EACH(sqrtf, a); }
SHADE_FN shade_vec3 shade_v3_exp(shade_vec3 a) { return SHADE_V3_EACH(expf, a); }
SHADE_FN shade_vec3 shade_v3_log(shade_vec3 a) { return SHADE_V3_EACH(logf, a); }
SHADE_FN shade_vec3 shade_v3_exp2(shade_vec3 a) { return SHADE_V3_EACH(exp2f, a); }
SHADE_FN shade_vec3 shade_v3_log2(shade_vec3 a) { return SHADE_V3_EACH(log2f, a); }
SHADE_FN shade_vec3 shade_v3_fract(shade_vec3 a) { return SHADE_V3_EACH(shade_f_fract, a); }
SHADE_FN shade_vec3 shade_v3_floor(shade_vec3 a) { return SHADE_V3_EACH(floorf, a); }
SHADE_FN shade_vec3 shade_v3_pow(shade_vec3 a, shade_vec3 b) { return SHADE_V3_EACH2(powf, a, b); }
SHADE_FN shade_vec3 shade_v3_min(shade_vec3 a, shade_vec3 b) { return SHADE_V3_EACH2(shade_f_min, a, b); }
SHADE_FN shade_vec3 shade_v3_max(shade_vec3 a, shade_vec3 b) { return SHADE_V3_EACH2(shade_f_max, a, b); }
SHADE_FN shade_vec3 shade_v3_min_s(shade_vec3 a, float b) { return shade_v3_min(a, shade_v3_splat(b)); }
SHADE_FN shade_vec3 shade_v3_max_s(shade_vec3 a, float b) { return shade_v3_max(a, shade_v3_splat(b)); }
SHADE_FN shade_vec3 shade_v3_clamp(shade_vec3 x, shade_vec3 lo, shade_vec3 hi) { return shade_v3_min(shade_v3_max(x, lo), hi); }
SHADE_FN shade_vec3 shade_v3_clamp_s(shade_vec3 x, float lo, float hi) { return shade_v3_clamp(x, shade_v3_splat(lo), shade_v3_splat(hi)); }
SHADE_FN shade_vec3 shade_v3_mix(shade_vec3 a, shade_vec3 b, shade_vec3 t) { return a + (b - a) * t; }
SHADE_FN shade_vec3 shade_v3_mix_s(shade_vec3 a, shade_vec3 b, float t) { return a + (b - a) * t; }
SHADE_FN shade_vec3 shade_mul(shade_mat3 m, shade_vec3 v) { return m.c[0] * v[0] + m.c[1] * v[1] + m.c[2] * v[2]; }
SHADE_FN shade_mat3 shade_transpose(shade_mat3 m)
{
    return (shade_mat3){{shade_v3_new(m.c[0][0], m.c[1][0], m.c[2][0]), shade_v3_new(m.c[0][1], m.c[1][1], m.c[2][1]),
                   shade_v3_new(m.c[0][2], m.c[1][2], m.c[2][2])}};
}
SHADE_FN uint32_t shade_f_bits(float x) { uint32_t u; memcpy(&u, &x, sizeof u); return u; }
SHADE_FN float shade_u_float(uint32_t u) { float x; memcpy(&x, &u, sizeof x); return x; }

/* ---- one name for all types ---- */
#define SHADE_PICK_(_1, _2, _3, name, ...) name
#define shade_vec2(...) SHADE_PICK_(__VA_ARGS__, shade_v2_none, shade_v2_new, shade_v2_splat, 0)(__VA_ARGS__)
#define shade_vec3(...) SHADE_PICK_(__VA_ARGS__, shade_v3_new, shade_v3_none, shade_v3_splat, 0)(__VA_ARGS__)
#define shade_mat3(c0, c1, c2) ((shade_mat3){{(c0), (c1), (c2)}})

#define shade_dot(a, b) _Generic((a), shade_vec2: shade_v2_dot, shade_vec3: shade_v3_dot)(a, b)
#define shade_length(a) _Generic((a), shade_vec2: shade_v2_length, shade_vec3: shade_v3_length)(a)
#define shade_normalize(a) _Generic((a), shade_vec2: shade_v2_normalize, shade_vec3: shade_v3_normalize)(a)
#define shade_cross(a, b) shade_v3_cross(a, b)
#define shade_reflect(i, n) shade_v3_reflect(i, n)
#define shade_refract(i, n, eta) shade_v3_refract(i, n, eta)
#define shade_min(a, b) \
    _Generic((a), float: shade_f_min, shade_vec2: _Generic((b), float: shade_v2_min_s, default: shade_v2_min), \
        shade_vec3: _Generic((b), float: shade_v3_min_s, default: shade_v3_min))(a, b)
#define shade_max(a, b) \
    _Generic((a), float: shade_f_max, shade_vec2: _Generic((b), float: shade_v2_max_s, default: shade_v2_max), \
        shade_vec3: _Generic((b), float: shade_v3_max_s, default: shade_v3_max))(a, b)
#define shade_clamp(x, a, b) \
    _Generic((x), float: shade_f_clamp, shade_vec2: _Generic((a), float: shade_v2_clamp_s, default: shade_v2_clamp), \
        shade_vec3: _Generic((a), float: shade_v3_clamp_s, default: shade_v3_clamp))(x, a, b)
#define shade_mix(a, b, t) \
    _Generic((a), float: shade_f_mix, shade_vec2: _Generic((t), float: shade_v2_mix_s, default: shade_v2_mix), \
        shade_vec3: _Generic((t), float: shade_v3_mix_s, default: shade_v3_mix))(a, b, t)
#define shade_abs(x) _Generic((x), float: fabsf, shade_vec2: shade_v2_abs, shade_vec3: shade_v3_abs)(x)
#define shade_sqrt(x) _Generic((x), float: sqrtf, shade_vec2: shade_v2_sqrt, shade_vec3: shade_v3_sqrt)(x)
#define shade_exp(x) _Generic((x), float: expf, shade_vec3: shade_v3_exp)(x)
#define shade_log(x) _Generic((x), float: logf, shade_vec3: shade_v3_log)(x)
#define shade_exp2(x) _Generic((x), float: exp2f, shade_vec3: shade_v3_exp2)(x)
#define shade_log2(x) _Generic((x), float: log2f, shade_vec3: shade_v3_log2)(x)
#define shade_floor(x) _Generic((x), float: floorf, shade_vec2: shade_v2_floor, shade_vec3: shade_v3_floor)(x)
#define shade_fract(x) _Generic((x), float: shade_f_fract, shade_vec2: shade_v2_fract, shade_vec3: shade_v3_fract)(x)
#define shade_pow(x, y) _Generic((x), float: powf, shade_vec3: shade_v3_pow)(x, y)
#define shade_sin(x) _Generic((x), float: sinf)(x)
#define shade_cos(x) _Generic((x), float: cosf)(x)
#define shade_tan(x) _Generic((x), float: tanf)(x)
#define shade_asin(x) _Generic((x), float: asinf)(x)
#define shade_acos(x) _Generic((x), float: acosf)(x)
#define shade_atan(y, x) _Generic((y), float: atan2f)(y, x) /* two arguments only */
#define shade_sign(x) _Generic((x), float: shade_f_sign)(x)
#define shade_mod(x, y) _Generic((x), float: shade_f_mod)(x, y)
#define shade_step(e, x) _Generic((x), float: shade_f_step)(e, x)
#define shade_smoothstep(a, b, x) _Generic((x), float: shade_f_smoothstep)(a, b, x)
#define shade_inversesqrt(x) _Generic((x), float: shade_f_inversesqrt)(x)
#define shade_floatBitsToUint(x) shade_f_bits(x)
#define shade_uintBitsToFloat(u) shade_u_float(u)

/* clang-format on */

#endif
