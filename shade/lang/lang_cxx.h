/* lang_cxx.h - the dialect in C++ (C++17 and later): vectors as classes, GLSL's functions as overloads, in
 * namespace facet. float(x), int(x) and uint(x) are C++'s own conversions. A literal without f is a double
 * here, and is converted where functions have overloads for float and vectors only. */
#ifndef LANG_CXX_H
#define LANG_CXX_H

/* Behind names_begin.h, so that a program's macro min does not get into them. */
#include <math.h>
#include <stdint.h>
#include <string.h>

/* One function a line: */
/* clang-format off */

extern "C++" {
namespace facet {

typedef uint32_t uint;

struct vec2 {
    float c[2];
    vec2() = default;
    explicit constexpr vec2(float s) : c{s, s} {}
    constexpr vec2(float x, float y) : c{x, y} {}
    constexpr float operator[](int i) const { return c[i]; }
    constexpr float &operator[](int i) { return c[i]; }
};

/* As wide as in C: four lanes, of which the last is not read. */
struct alignas(16) vec3 {
    float c[4];
    vec3() = default;
    explicit constexpr vec3(float s) : c{s, s, s, s} {}
    constexpr vec3(float x, float y, float z) : c{x, y, z, 0.0f} {}
    constexpr float operator[](int i) const { return c[i]; }
    constexpr float &operator[](int i) { return c[i]; }
};

struct mat3 { /* three columns */
    vec3 c[3];
    mat3() = default;
    constexpr mat3(vec3 c0, vec3 c1, vec3 c2) : c{c0, c1, c2} {}
};

#define SHADE_OPERATOR(op)                                                                           \
    inline vec2 operator op(vec2 a, vec2 b) { return vec2(a[0] op b[0], a[1] op b[1]); }             \
    inline vec2 operator op(vec2 a, float b) { return vec2(a[0] op b, a[1] op b); }                  \
    inline vec2 operator op(float a, vec2 b) { return vec2(a op b[0], a op b[1]); }                  \
    inline vec2 &operator op##=(vec2 & a, vec2 b) { return a = a op b; }                             \
    inline vec2 &operator op##=(vec2 & a, float b) { return a = a op b; }                            \
    inline vec3 operator op(vec3 a, vec3 b) { return vec3(a[0] op b[0], a[1] op b[1], a[2] op b[2]); } \
    inline vec3 operator op(vec3 a, float b) { return vec3(a[0] op b, a[1] op b, a[2] op b); }       \
    inline vec3 operator op(float a, vec3 b) { return vec3(a op b[0], a op b[1], a op b[2]); }       \
    inline vec3 &operator op##=(vec3 & a, vec3 b) { return a = a op b; }                             \
    inline vec3 &operator op##=(vec3 & a, float b) { return a = a op b; }
SHADE_OPERATOR(+)
SHADE_OPERATOR(-)
SHADE_OPERATOR(*)
SHADE_OPERATOR(/)
#undef SHADE_OPERATOR
inline vec2 operator-(vec2 a) { return vec2(-a[0], -a[1]); }
inline vec3 operator-(vec3 a) { return vec3(-a[0], -a[1], -a[2]); }

/* ---- functions of a float, and those that take vectors lane by lane ---- */

inline float min(float a, float b) { return a < b ? a : b; }
inline float max(float a, float b) { return a > b ? a : b; }
inline float clamp(float x, float lo, float hi) { return min(max(x, lo), hi); }
inline float mix(float a, float b, float t) { return a + (b - a) * t; }
inline float abs(float x) { return ::fabsf(x); }
inline float sqrt(float x) { return ::sqrtf(x); }
inline float exp(float x) { return ::expf(x); }
inline float log(float x) { return ::logf(x); }
inline float exp2(float x) { return ::exp2f(x); }
inline float log2(float x) { return ::log2f(x); }
inline float floor(float x) { return ::floorf(x); }
inline float fract(float x) { return x - ::floorf(x); }
inline float pow(float x, float y) { return ::powf(x, y); }
inline float sin(float x) { return ::sinf(x); }
inline float cos(float x) { return ::cosf(x); }
inline float tan(float x) { return ::tanf(x); }
inline float asin(float x) { return ::asinf(x); }
inline float acos(float x) { return ::acosf(x); }
inline float atan(float y, float x) { return ::atan2f(y, x); }
inline float sign(float x) { return float((x > 0.0f) - (x < 0.0f)); }
inline float mod(float x, float y) { return x - y * ::floorf(x / y); }
inline float step(float edge, float x) { return x < edge ? 0.0f : 1.0f; }
inline float inversesqrt(float x) { return 1.0f / ::sqrtf(x); }
inline float smoothstep(float e0, float e1, float x)
{
    float t = clamp((x - e0) / (e1 - e0), 0.0f, 1.0f);
    return t * t * (3.0f - 2.0f * t);
}

#define SHADE_LANES(f)                                        \
    inline vec2 f(vec2 a) { return vec2(f(a[0]), f(a[1])); }  \
    inline vec3 f(vec3 a) { return vec3(f(a[0]), f(a[1]), f(a[2])); }
SHADE_LANES(abs)
SHADE_LANES(sqrt)
SHADE_LANES(exp)
SHADE_LANES(log)
SHADE_LANES(exp2)
SHADE_LANES(log2)
SHADE_LANES(floor)
SHADE_LANES(fract)
#undef SHADE_LANES
inline vec3 pow(vec3 a, vec3 b) { return vec3(pow(a[0], b[0]), pow(a[1], b[1]), pow(a[2], b[2])); }

inline vec2 min(vec2 a, vec2 b) { return vec2(min(a[0], b[0]), min(a[1], b[1])); }
inline vec2 max(vec2 a, vec2 b) { return vec2(max(a[0], b[0]), max(a[1], b[1])); }
inline vec2 min(vec2 a, float b) { return min(a, vec2(b)); }
inline vec2 max(vec2 a, float b) { return max(a, vec2(b)); }
inline vec2 clamp(vec2 x, vec2 lo, vec2 hi) { return min(max(x, lo), hi); }
inline vec2 clamp(vec2 x, float lo, float hi) { return clamp(x, vec2(lo), vec2(hi)); }
inline vec2 mix(vec2 a, vec2 b, vec2 t) { return a + (b - a) * t; }
inline vec2 mix(vec2 a, vec2 b, float t) { return a + (b - a) * t; }
inline vec3 min(vec3 a, vec3 b) { return vec3(min(a[0], b[0]), min(a[1], b[1]), min(a[2], b[2])); }
inline vec3 max(vec3 a, vec3 b) { return vec3(max(a[0], b[0]), max(a[1], b[1]), max(a[2], b[2])); }
inline vec3 min(vec3 a, float b) { return min(a, vec3(b)); }
inline vec3 max(vec3 a, float b) { return max(a, vec3(b)); }
inline vec3 clamp(vec3 x, vec3 lo, vec3 hi) { return min(max(x, lo), hi); }
inline vec3 clamp(vec3 x, float lo, float hi) { return clamp(x, vec3(lo), vec3(hi)); }
inline vec3 mix(vec3 a, vec3 b, vec3 t) { return a + (b - a) * t; }
inline vec3 mix(vec3 a, vec3 b, float t) { return a + (b - a) * t; }

/* ---- geometry ---- */

inline float dot(vec2 a, vec2 b) { return a[0] * b[0] + a[1] * b[1]; }
inline float dot(vec3 a, vec3 b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline float length(vec2 a) { return sqrt(dot(a, a)); }
inline float length(vec3 a) { return sqrt(dot(a, a)); }
inline vec2 normalize(vec2 a) { return a * (1.0f / length(a)); }
inline vec3 normalize(vec3 a) { return a * (1.0f / length(a)); }
inline vec3 cross(vec3 a, vec3 b)
{
    return vec3(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]);
}
inline vec3 reflect(vec3 i, vec3 n) { return i - n * (2.0f * dot(n, i)); }
inline vec3 refract(vec3 i, vec3 n, float eta)
{
    float c = dot(n, i);
    float k = 1.0f - eta * eta * (1.0f - c * c);
    return k < 0.0f ? vec3(0.0f) : i * eta - n * (eta * c + sqrt(k));
}
inline vec3 mul(const mat3 &m, vec3 v) { return m.c[0] * v[0] + m.c[1] * v[1] + m.c[2] * v[2]; }
inline mat3 transpose(const mat3 &m)
{
    return mat3(vec3(m.c[0][0], m.c[1][0], m.c[2][0]), vec3(m.c[0][1], m.c[1][1], m.c[2][1]),
                vec3(m.c[0][2], m.c[1][2], m.c[2][2]));
}
inline uint floatBitsToUint(float x) { uint u; ::memcpy(&u, &x, sizeof u); return u; }
inline float uintBitsToFloat(uint u) { float x; ::memcpy(&x, &u, sizeof x); return x; }

/* clang-format on */

/* ---- the rest of the dialect; undefined again by names_end.h ---- */

#define FN_INLINED
#define FN inline FN_INLINED __attribute__((unused))
#define STRUCT(T) struct T
#define COL(m, i) ((m).c[i])
#define CONST_ARRAY3(T, name, a, b, c) static const T name[3] = {a, b, c}
#define sel(c, a, b) ((c) ? (a) : (b))

/* The text follows, in the same namespace, until lang_cxx_end.h. */

#endif
