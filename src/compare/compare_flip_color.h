/* compare_flip_color.h - the color spaces of FLIP, for loops over pixels. Andersson et al. 2020, section 4.1. */
#ifndef COMPARE_COMPARE_FLIP_COLOR_H
#define COMPARE_COMPARE_FLIP_COLOR_H

#include <math.h>

#include "compare/compare_math.h"

/* YCxCz without its scale and offset, to which the filters are invariant: Y, X - Y, Y - Z, with XYZ relative
 * to white. */
typedef struct flip_opponent {
    float y, cx, cz;
} flip_opponent;

/* From linear sRGB, white D65; the rows of the matrix add up to 1. */
static inline __attribute__((always_inline)) flip_opponent flip_opponent_from_rgb(float r, float g, float b)
{
    float x = 0.433895389f * r + 0.376242373f * g + 0.189862239f * b;
    float y = 0.212636822f * r + 0.715182982f * g + 0.072180196f * b;
    float z = 0.017752423f * r + 0.109465629f * g + 0.872781948f * b;
    return (flip_opponent){y, x - y, y - z};
}

/* CIE L*a*b* with a* and b* times L* / 100: chroma counts for less in the dark (Hunt 1952). */
typedef struct flip_lab {
    float l, a, b;
} flip_lab;

static inline __attribute__((always_inline)) float flip_lab_curve(float t)
{
    float root = compare_pow(t, 1.0f / 3.0f);
    return compare_pick(t > 216.0f / 24389.0f, root, t * (841.0f / 108.0f) + 4.0f / 29.0f);
}

/* From the filtered color, clamped to the gamut of linear sRGB. */
static inline __attribute__((always_inline)) flip_lab flip_lab_from_opponent(flip_opponent o)
{
    float x = o.y + o.cx, z = o.y - o.cz;
    float r = compare_clamp(3.080341988f * x - 1.537398969f * o.y - 0.542943019f * z, 0.0f, 1.0f);
    float g = compare_clamp(-0.921178396f * x + 1.875929984f * o.y + 0.045248412f * z, 0.0f, 1.0f);
    float b = compare_clamp(0.052881293f * x - 0.204011206f * o.y + 1.151129913f * z, 0.0f, 1.0f);
    o = flip_opponent_from_rgb(r, g, b);
    float fx = flip_lab_curve(o.y + o.cx), fy = flip_lab_curve(o.y), fz = flip_lab_curve(o.y - o.cz);
    float l = 116.0f * fy - 16.0f, hunt = 0.01f * l;
    return (flip_lab){l, hunt * 500.0f * (fx - fy), hunt * 200.0f * (fy - fz)};
}

/* HyAB^0.7 of the most distant colors, green and blue: 203.30165^0.7. */
#define FLIP_LARGEST 41.2760984f

/* Color difference in [0, 1]: HyAB^0.7, of which the first 40 % map to [0, 0.95]. Equations 5 to 7. */
static inline __attribute__((always_inline)) float flip_color_difference(float dl, float da, float db)
{
    const float knee = 0.4f * FLIP_LARGEST;
    float hyab = fabsf(dl) + sqrtf(da * da + db * db);
    float power = compare_pow(hyab, 0.7f);
    float far_ = 0.95f + (power - knee) * (0.05f / (FLIP_LARGEST - knee));
    return compare_pick(power < knee, power * (0.95f / knee), far_);
}

/* The error from color and feature differences. Equations 10 to 12. */
static inline __attribute__((always_inline)) float flip_error(float color, float edges, float points)
{
    float feature = sqrtf(compare_pick(edges > points, edges, points) * 0.70710678f);
    return compare_pow(color, 1.0f - compare_clamp(feature, 0.0f, 1.0f));
}

/* Narkowicz's fit of ACES without its pre-exposure, of radiance times gain; in [0, 1]. Andersson et al. 2021,
 * section 4.1. */
static inline __attribute__((always_inline)) float flip_tonemap(float light, float gain)
{
    float x = compare_clamp(light * gain, 0.0f, 1e9f);
    float shown = (0.9036f * x + 0.018f) * x / ((0.8748f * x + 0.354f) * x + 0.14f);
    return compare_clamp(shown, 0.0f, 1.0f);
}
/* The radiance that it maps to 0.85: (0.9036 - 0.85 0.8748) x^2 + (0.018 - 0.85 0.354) x - 0.85 0.14 = 0. */
#define FLIP_BRIGHT 2.118872323987314

#endif
