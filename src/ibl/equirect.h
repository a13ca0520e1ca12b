/* equirect.h - an environment picture at a working resolution, and how directions map to it.
 *
 * u = 0.5 + atan2(d.z, d.x) / 2pi from the left, v = acos(d.y) / pi from the top: facet.h, facet_environment_load().
 * Texel (x, y) has its middle at u = (x + 0.5) / width, v = (y + 0.5) / height. */
#ifndef IBL_EQUIRECT_H
#define IBL_EQUIRECT_H

#include "facet/facet.h"
#include "ibl/simd.h"
#include "image/image.h"

enum { EQUIRECT_TILE = 16 }; /* texels along an edge of a tile */

typedef struct equirect {
    uint32_t width, height;
    rgbx *texels; /* height rows of width + 1; the last texel of a row repeats its first */
    uint8_t *
        tiles; /* ceil(height / EQUIRECT_TILE) rows of ceil(width / EQUIRECT_TILE): 1 where the tile or one of
                       its neighbours has a texel that outshines its surroundings; NULL: not asked for */
} equirect;

/* Resamples picture (F32 RGB, linear) to width x height: the mean over each texel's solid angle where that is
 * coarser, linear interpolation along an axis where it is finer. FACET_ERROR_MEMORY. */
facet_result equirect_create(const image *picture, uint32_t width, uint32_t height, bool needs_tiles,
                             const facet_allocator *allocator, uint32_t thread_count, equirect *out,
                             facet_error *error);
void equirect_destroy(equirect *e); /* {0} is allowed; leaves {0} */

/* Solid angle of a texel of row y, sr: (2 pi / width) (cos(top) - cos(bottom)). All of them add up to 4 pi. */
double equirect_texel_solid_angle(uint32_t width, uint32_t height, uint32_t y);

/* The unit direction of the middle of texel (x, y); x and y may lie between texels. */
void equirect_direction(uint32_t width, uint32_t height, double x, double y, float d[3]);

/* Mean radiance over the sphere, summed in double. */
void equirect_mean(const equirect *e, float mean[3]);

/* Angle of (x, y), rad, error below 1e-7; 0 for (0, 0). Without branches, for loops that vectorise.
 * Abramowitz and Stegun 1964, equation 4.4.49. */
static inline float equirect_atan2(float y, float x)
{
    float ax = x < 0.0f ? -x : x;
    float ay = y < 0.0f ? -y : y;
    float high = ax > ay ? ax : ay;
    float low = ax > ay ? ay : ax;
    float q = low / (high > 1e-30f ? high : 1e-30f);
    float q2 = q * q;
    float p = 0.0028662257f;
    p = p * q2 - 0.0161657367f;
    p = p * q2 + 0.0429096138f;
    p = p * q2 - 0.0752896400f;
    p = p * q2 + 0.1065626393f;
    p = p * q2 - 0.1420889944f;
    p = p * q2 + 0.1999355085f;
    p = p * q2 - 0.3333314528f;
    p = (p * q2 + 1.0f) * q;
    p = ay > ax ? 1.57079633f - p : p;
    p = x < 0.0f ? 3.14159265f - p : p;
    return y < 0.0f ? -p : p;
}

/* Bilinear. x from the left in texels, in [0, width]; y from the top, in [0, height]. */
static inline rgbx equirect_fetch(const equirect *e, float x, float y)
{
    float fx = x - 0.5f;
    fx = fx < 0.0f ? fx + (float)e->width : fx;
    float fy = y - 0.5f;
    fy = fy < 0.0f ? 0.0f : fy;
    uint32_t x0 = (uint32_t)fx;
    x0 = x0 < e->width ? x0 : e->width - 1;
    uint32_t y0 = (uint32_t)fy;
    y0 = y0 < e->height ? y0 : e->height - 1;
    uint32_t y1 = y0 + 1 < e->height ? y0 + 1 : y0;
    float wx = fx - (float)x0;
    float wy = fy - (float)y0;
    size_t stride = (size_t)e->width + 1;
    const rgbx *a = e->texels + y0 * stride + x0;
    const rgbx *b = e->texels + y1 * stride + x0;
    rgbx top = a[0] + (a[1] - a[0]) * wx;
    rgbx bottom = b[0] + (b[1] - b[0]) * wx;
    return top + (bottom - top) * wy;
}

/* Radiance from the unit direction d. */
static inline rgbx equirect_lookup(const equirect *e, const float d[3])
{
    float u = 0.5f + equirect_atan2(d[2], d[0]) * 0.159154943f;
    float v = equirect_atan2(__builtin_sqrtf(d[0] * d[0] + d[2] * d[2]), d[1]) * 0.318309886f;
    return equirect_fetch(e, u * (float)e->width, v * (float)e->height);
}

#endif
