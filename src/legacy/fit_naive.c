/* fit_naive.c - the conversions that most programs make: what the others are measured against. Each takes Blinn's
 * exponent and GGX of equal slope variance and leaves all colors where they are. */
#include <math.h>
#include <string.h>

#include "legacy/fit.h"

#include "shade/shade.h"

pbr_surface pbr_surface_default(void)
{
    return (pbr_surface){.base_color = {1.0f, 1.0f, 1.0f},
                         .perceptual_roughness = 1.0f,
                         .ior = 1.5f,
                         .specular = 1.0f,
                         .specular_color = {1.0f, 1.0f, 1.0f}};
}

/* Diffuse as base color, shininess to roughness, and the dielectric's usual 4 % for specular. */
uint32_t ogl1_to_pbr_naive(const ogl1_surface *in, pbr_surface *out)
{
    uint32_t remarks = 0;
    *out = pbr_surface_default();
    for (int k = 0; k < 3; k++) {
        out->base_color[k] = clamp(in->diffuse[k], 0.0f, 1.0f);
        remarks |= in->diffuse[k] > 1.0f ? (uint32_t)FIT_BASE_CLAMPED : 0u;
    }
    out->perceptual_roughness = sqrt(alpha_from_shininess(in->shininess));
    return remarks;
}

uint32_t pbr_to_ogl1_naive(const pbr_surface *in, ogl1_surface *out)
{
    vec3 color = vec3(in->specular_color[0], in->specular_color[1], in->specular_color[2]);
    vec3 F0 = dielectric_F0(in->ior, in->specular, color);
    float alpha = max(alpha_from_roughness(in->perceptual_roughness), ALPHA_MIRROR);
    float shininess = shininess_from_alpha(alpha);
    for (int k = 0; k < 3; k++) {
        out->diffuse[k] = in->base_color[k] * (1.0f - in->metallic);
        out->specular[k] = mix(F0[k], in->base_color[k], in->metallic);
    }
    out->shininess = clamp(shininess, 0.0f, 128.0f);
    return shininess > 128.0f ? (uint32_t)FIT_SHININESS_CLAMPED : 0u;
}
