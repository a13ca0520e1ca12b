/* unit.h - normalization of directions. */
#ifndef SCENE_UNIT_H
#define SCENE_UNIT_H

#include <math.h>
#include <stdbool.h>

/* v over its length, in double, so that tiny and huge vectors keep their direction. False: length 0, out is
 * unchanged. */
static inline bool unit_from_double(const double v[3], float out[3])
{
    double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    if (!(length > 0.0 && length <= 1e300))
        return false;
    for (int i = 0; i < 3; i++)
        out[i] = (float)(v[i] / length);
    return true;
}

/* v over its length; `otherwise` for length 0. */
static inline void unit_or(const float v[3], const float otherwise[3], float out[3])
{
    float length2 = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    if (length2 > 1e-30f && length2 < 1e30f) {
        float scale = 1.0f / sqrtf(length2);
        for (int i = 0; i < 3; i++)
            out[i] = v[i] * scale;
        return;
    }
    const double wide[3] = {(double)v[0], (double)v[1], (double)v[2]};
    const float fallback[3] = {otherwise[0], otherwise[1], otherwise[2]};
    if (!unit_from_double(wide, out))
        for (int i = 0; i < 3; i++)
            out[i] = fallback[i];
}

#endif
