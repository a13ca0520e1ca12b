/* convert_surface.c - see convert_surface.h. */
#include "legacy/convert_surface.h"

#include <math.h>

#include "image/srgb.h"

float legacy_to_linear(float value, facet_legacy_colors colors)
{
    if (!(value > 0.0f))
        return 0.0f;
    return colors == FACET_LEGACY_COLORS_LINEAR ? value : (float)srgb_decode((double)value);
}

float legacy_from_linear(float value, facet_legacy_colors colors)
{
    if (!(value > 0.0f))
        return 0.0f;
    return colors == FACET_LEGACY_COLORS_LINEAR ? value : (float)srgb_encode((double)value);
}

void legacy_color_to_linear(const float in[3], facet_legacy_colors colors, float out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = legacy_to_linear(in[k], colors);
}

void legacy_color_from_linear(const float in[3], facet_legacy_colors colors, float out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = legacy_from_linear(in[k], colors);
}

void legacy_surface_of_ogl1(const legacy_material *m, facet_legacy_colors colors, ogl1_surface *out)
{
    legacy_color_to_linear(m->diffuse, colors, out->diffuse);
    legacy_color_to_linear(m->specular, colors, out->specular);
    out->shininess = m->shininess > 0.0f ? m->shininess : 0.0f;
}

/* Clamped to the ranges of the format, which files exceed. */
void legacy_surface_of_pbr(const scene_material *m, pbr_surface *out)
{
    bool is_glossy = (m->extensions & SCENE_SPECULAR_GLOSSINESS) != 0;
    for (int k = 0; k < 3; k++) {
        out->base_color[k] = unit_of(m->base_color[k]);
        out->specular_color[k] = is_glossy ? unit_of(m->specular_color[k]) : m->specular_color[k];
    }
    /* shade/specular_glossiness.h: ior 0 makes F0 the specular color. */
    out->metallic = is_glossy ? 0.0f : unit_of(m->metallic);
    out->perceptual_roughness = is_glossy ? 1.0f - unit_of(m->glossiness) : unit_of(m->perceptual_roughness);
    out->ior = is_glossy ? 0.0f : m->ior;
    out->specular = is_glossy ? 1.0f : unit_of(m->specular);
}
