/* equirect.h - equirectangular images: mapping of directions, lookup, resampling.
 *
 * u = 0.5 + atan2(d.z, d.x) / 2pi from the left, v = acos(d.y) / pi from the top; see
 * facet_environment_load(). Texel (x, y) has its center at u = (x + 0.5) / width, v = (y + 0.5) / height.
 * Images are F32 RGB, linear. */
#ifndef IBL_EQUIRECT_H
#define IBL_EQUIRECT_H

#include <math.h>

#include "facet/facet.h"
#include "ibl/rgbx.h"
#include "image/image.h"

/* Solid angle of a texel of row y, sr: (2 pi / width) (cos(top) - cos(bottom)). All of them add up to 4 pi. */
double equirect_texel_solid_angle(uint32_t width, uint32_t height, uint32_t y);

/* Unit direction of the center of texel (x, y); x and y may be fractional. */
void equirect_direction(uint32_t width, uint32_t height, double x, double y, float d[3]);

/* atan2(y, x) in rad, error below 3e-7; 0 for (0, 0). Branch-free, so that loops vectorise. Abramowitz and
 * Stegun 1964, equation 4.4.49. */
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

/* Position in an image of any size: turns from the middle column, half turns from the top. */
typedef struct equirect_point {
    float turns, half_turns;
} equirect_point;

/* Position of the unit direction d. */
static inline equirect_point equirect_locate(const float d[3])
{
    return (equirect_point){equirect_atan2(d[2], d[0]) * 0.159154943f,
                            equirect_atan2(sqrtf(d[0] * d[0] + d[2] * d[2]), d[1]) * 0.318309886f};
}

static inline rgbx equirect_texel(const float *p)
{
    return (rgbx){p[0], p[1], p[2], 0.0f};
}

/* Bilinear. */
static inline rgbx equirect_fetch(const image *panorama, equirect_point p)
{
    float width = (float)panorama->width;
    float height = (float)panorama->height;
    float x = p.turns * width + (0.5f * width - 0.5f);
    float y = p.half_turns * height - 0.5f;
    x = x < 0.0f ? x + width : x;
    y = y < 0.0f ? 0.0f : y > height - 1.0f ? height - 1.0f : y;
    uint32_t x0 = (uint32_t)x;
    uint32_t y0 = (uint32_t)y;
    float wx = x - (float)x0;
    float wy = y - (float)y0;
    x0 = x0 < panorama->width ? x0 : panorama->width - 1; /* rounded up */
    uint32_t x1 = x0 + 1 < panorama->width ? x0 + 1 : 0;
    uint32_t y1 = y0 + 1 < panorama->height ? y0 + 1 : y0;
    const float *row0 = (const float *)panorama->pixels + 3 * (size_t)panorama->width * y0;
    const float *row1 = (const float *)panorama->pixels + 3 * (size_t)panorama->width * y1;
    rgbx a = equirect_texel(row0 + 3 * (size_t)x0);
    rgbx b = equirect_texel(row1 + 3 * (size_t)x0);
    a += (equirect_texel(row0 + 3 * (size_t)x1) - a) * wx;
    b += (equirect_texel(row1 + 3 * (size_t)x1) - b) * wx;
    return a + (b - a) * wy;
}

/* Radiance from the unit direction d, bilinear. */
void equirect_lookup(const image *panorama, const float d[3], float out[3]);

/* Mean radiance over the sphere. Does not depend on thread_count. FACET_ERROR_MEMORY. */
facet_result equirect_mean(const image *panorama, const facet_allocator *allocator, uint32_t thread_count,
                           double mean[3], facet_error *error);

/* ---- resampling ---- */

/* Resampling of one axis. */
typedef struct equirect_axis {
    struct equirect_span *spans;
    float *weights;
} equirect_axis;

/* A resampled view of an image: area-weighted means where it is coarser; where it is finer, linear
 * interpolation along the axis (smooth) or repeated texels. */
typedef struct equirect_view {
    const image *panorama;
    uint32_t width, height;
    bool is_smooth;
    equirect_axis columns, rows;
} equirect_view;

/* False: out of memory. */
bool equirect_view_create(const image *panorama, uint32_t width, uint32_t height, bool is_smooth,
                          const facet_allocator *allocator, equirect_view *view);
void equirect_view_destroy(equirect_view *view); /* {0} is allowed */
/* Texels x0 .. x0 + count - 1 of row y. */
void equirect_view_texels(const equirect_view *view, uint32_t y, uint32_t x0, uint32_t count, rgbx *out);

/* The smooth view as an image. FACET_ERROR_MEMORY. */
facet_result equirect_resize(const image *panorama, uint32_t width, uint32_t height,
                             const facet_allocator *allocator, uint32_t thread_count, image *out,
                             facet_error *error);

#endif
