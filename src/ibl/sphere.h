/* sphere.h - radiance over the sphere in one of three representations (cube map, equirectangular and
 * octahedral image), its texels by index, and resampling between them. */
#ifndef IBL_SPHERE_H
#define IBL_SPHERE_H

#include "facet/facet.h"

#include <math.h>

#include "ibl/cube.h"
#include "ibl/equirect.h"
#include "image/image.h"

/* ---- octahedral images ----
 *
 * The sphere on the faces of an octahedron, unfolded into a square (Cigolle et al. 2014, "A Survey of
 * Efficient Representations for Independent Unit Vectors"). Position (u, v), both in [-1, 1], v downwards.
 * Where |u| + |v| <= 1 it is the direction of (u, 1 - |u| - |v|, v), the upper half with +X to the right and
 * +Z below, as the face +Y of a cube map has it; the lower half is folded outwards over the diagonals, -Y in
 * the corners. A small area du dv is seen under the solid angle du dv / |p|^3, p the point of the octahedron. */

/* The point of (u, v): |x| + |y| + |z| is 1. */
static inline void octahedron_direction(float u, float v, float p[3])
{
    float y = 1.0f - fabsf(u) - fabsf(v);
    float fold =
        y < 0.0f ? -y : 0.0f; /* lower half: folded inside by as much as it is outside of the diagonal */
    p[0] = u - copysignf(fold, u);
    p[1] = y;
    p[2] = v - copysignf(fold, v);
}

/* Solid angle, sr, of the square of edge step centered at (u, v), to second order in step. The folds may cut
 * it only from corner to corner, where it is split in two. */
static inline float octahedron_solid_angle(float u, float v, float step)
{
    float sum = 0.0f;
    for (int i = 0; i < 2; i++) {
        float aside = i ? step / 6.0f : step / -6.0f; /* offset of a half's centroid */
        float p[3];
        octahedron_direction(u + copysignf(aside, u * aside), v + copysignf(aside, v * aside), p);
        float q = p[0] * p[0] + p[1] * p[1] + p[2] * p[2];
        sum += 0.5f * step * step / (q * sqrtf(q));
    }
    return sum;
}

/* Position of direction d (any length but 0). */
static inline void octahedron_locate(const float d[3], float uv[2])
{
    float scale = 1.0f / (fabsf(d[0]) + fabsf(d[1]) + fabsf(d[2]));
    float u = d[0] * scale;
    float v = d[2] * scale;
    bool is_lower = d[1] < 0.0f;
    uv[0] = is_lower ? copysignf(1.0f - fabsf(v), u) : u;
    uv[1] = is_lower ? copysignf(1.0f - fabsf(u), v) : v;
}

/* Index of texel (x, y), both in [-1, n], of an image of n x n: outside of an edge lies the same edge,
 * rotated around its center. */
static inline size_t octahedron_texel(uint32_t n, int x, int y)
{
    int last = (int)n - 1;
    if (x < 0 || x > last) {
        x = x < 0 ? 0 : last;
        y = last - y;
    }
    if (y < 0 || y > last) {
        y = y < 0 ? 0 : last;
        x = last - x;
    }
    return (size_t)y * n + (size_t)x;
}

/* ---- the three representations ---- */

typedef enum sphere_kind { SPHERE_CUBE, SPHERE_EQUIRECT, SPHERE_OCTAHEDRON } sphere_kind;

/* Texels are numbered face by face, row by row. */
typedef struct sphere {
    sphere_kind kind;
    uint32_t width, height; /* of a face or the image */
    cube *cube;             /* SPHERE_CUBE; borders filled where it is a source */
    float *pixels;          /* else: channel_count (3 or 4) per texel, the fourth is ignored */
    uint32_t channel_count;
} sphere;

sphere sphere_of_cube(cube *c);
sphere sphere_of_image(sphere_kind kind, const image *panorama /* F32 */);

static inline size_t sphere_texel_count(const sphere *s)
{
    return (size_t)s->width * s->height * (s->kind == SPHERE_CUBE ? 6 : 1);
}

rgbx sphere_texel(const sphere *s, size_t texel);
/* Direction of the center of a texel, any length. */
void sphere_direction(const sphere *s, size_t texel, float d[3]);
/* Solid angle in sr, relative error below 1e-5. */
double sphere_solid_angle(const sphere *s, size_t texel);

/* Index of the texel that contains direction d (any length but 0). */
static inline size_t sphere_locate(const sphere *s, const float d[3])
{
    float x, y;
    uint32_t face = 0;
    if (s->kind == SPHERE_CUBE) {
        cube_point p = cube_locate(d[0], d[1], d[2]);
        face = p.face;
        x = 0.5f * p.s + 0.5f;
        y = 0.5f * p.t + 0.5f;
    } else if (s->kind == SPHERE_EQUIRECT) {
        equirect_point p = equirect_locate(d);
        x = p.turns + 0.5f;
        y = p.half_turns;
    } else {
        float uv[2];
        octahedron_locate(d, uv);
        x = 0.5f * uv[0] + 0.5f;
        y = 0.5f * uv[1] + 0.5f;
    }
    int column = (int)(x * (float)s->width);
    int row = (int)(y * (float)s->height);
    column = column < 0 ? 0 : column < (int)s->width ? column : (int)s->width - 1;
    row = row < 0 ? 0 : row < (int)s->height ? row : (int)s->height - 1;
    return ((size_t)face * s->height + (size_t)row) * s->width + (size_t)column;
}

/* A batch of lookups. */
enum { SPHERE_BATCH = 256 };
typedef struct sphere_batch {
    float x[SPHERE_BATCH], y[SPHERE_BATCH], z[SPHERE_BATCH]; /* directions, any length but 0 */
    float weight[SPHERE_BATCH];                              /* for the caller */
    rgbx radiance[SPHERE_BATCH];
    bool is_cut[SPHERE_BATCH]; /* a texel was clamped, or may have been */
} sphere_batch;

/* Radiance from the first count directions, bilinear and seamless, of texels clamped to limit (INFINITY: not
 * clamped). */
void sphere_look_up(const sphere *s, sphere_batch *batch, uint32_t count, float limit);

/* The texels of a bilinear lookup, with weights that add up to 1. */
typedef struct sphere_footprint {
    size_t texels[8];
    float weights[8];
    uint32_t count;
} sphere_footprint;
void sphere_find(const sphere *s, const float d[3], sphere_footprint *out);

/* ---- resampling ----
 *
 * A texel is the mean over its solid angle of bilinear, seamless lookups that are denser than the texels of
 * the source: a filter where the target is coarser, interpolation where it is finer. Constants are preserved
 * up to rounding. Texels brighter than 16 times the mean, such as a sun, would gain or lose some thousandths
 * of their energy because few lookups hit them; their excess is scaled so that the solid angles of the
 * lookups add up to that of the texel. The mean over the sphere is preserved to 5e-5. */
typedef struct sphere_turn {
    bool is_turned;
    float rows[3][3]; /* of a rotation or reflection: direction d of the target is rows d of the source */
    float scale;      /* factor of radiance */
    /* Lookups per texel of the target in each direction; 0: closer than the texels of the source */
    uint32_t parts;
} sphere_turn;

/* Fills the texels of target (of a cube: not the borders; of images: the first three channels, a fourth
 * becomes 1). FACET_ERROR_MEMORY. */
facet_result sphere_resample(const sphere *source, const sphere_turn *turn /* NULL: not rotated */,
                             const facet_allocator *allocator, uint32_t thread_count, const sphere *target,
                             facet_error *error);

#endif
