/* sphere.h - radiance over the sphere in one of three representations, its texels by index, and resampling
 * between them. */
#ifndef IBL_SPHERE_H
#define IBL_SPHERE_H

#include "facet/facet.h"
#include "ibl/cube.h"
#include "ibl/equirect.h"
#include "ibl/octahedron.h"
#include "image/image.h"

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
