/* convert_surface.h - colors of legacy files in linear light and back, and materials as the surfaces of
 * fit.h. */
#ifndef LEGACY_CONVERT_SURFACE_H
#define LEGACY_CONVERT_SURFACE_H

#include "legacy/fit.h"
#include "scene/legacy.h"

/* A component of a color; the sRGB curve is extended above 1. Negative and NaN: 0. */
float legacy_to_linear(float value, facet_legacy_colors colors);
float legacy_from_linear(float value, facet_legacy_colors colors);
void legacy_color_to_linear(const float in[3], facet_legacy_colors colors, float out[3]);
void legacy_color_from_linear(const float in[3], facet_legacy_colors colors, float out[3]);

/* The surface of a material where its textures are 1; linear colors. */
void legacy_surface_of_ogl1(const legacy_material *m, facet_legacy_colors colors, ogl1_surface *out);
void legacy_surface_of_pbr(const scene_material *m, pbr_surface *out);

static inline float highest_of(const float color[3])
{
    float most = color[0] > color[1] ? color[0] : color[1];
    return most > color[2] ? most : color[2];
}
static inline bool is_black(const float color[3])
{
    return color[0] <= 0.0f && color[1] <= 0.0f && color[2] <= 0.0f;
}
static inline float unit_of(float value) /* clamped to [0, 1]; NaN: 0 */
{
    return value > 0.0f ? (value < 1.0f ? value : 1.0f) : 0.0f;
}

#endif
