/* fit_closed.c - conversions without a search: roughness and strength from tables over the exponent. */
#include <math.h>

#include "legacy/fit.h"

#include "shade/shade.h"

enum { NODES = 20 };
static const float node_s[NODES] = {2,  3,  4,  6,  8,  10,  12,  16,  20,  24,
                                    32, 40, 50, 64, 80, 100, 128, 200, 400, 1000};
static const float node_r[NODES] = {.816f, .764f, .734f, .696f, .668f, .646f, .626f, .596f, .570f, .548f,
                                    .514f, .488f, .464f, .436f, .412f, .390f, .366f, .328f, .276f, .218f};
static const float node_share[NODES] = {1.0f,  .98f,  .951f, .833f, .733f, .652f, .579f,
                                        .476f, .396f, .337f, .259f, .209f, .169f, .131f,
                                        .105f, .084f, .065f, .042f, .021f, .0082f};

/* Between nodes both axes are logarithmic; beyond the last the slope continues. */
static float interpolate(const float *x, const float *y, float at)
{
    int i = 0;
    while (i < NODES - 2 && at > x[i + 1])
        i++;
    float t = logf(at / x[i]) / logf(x[i + 1] / x[i]);
    return y[i] * powf(y[i + 1] / y[i], t);
}

float perceptual_roughness_from_shininess(float shininess)
{
    float s = max(shininess, 0.0f);
    return s < node_s[0] ? mix(1.0f, node_r[0], s / node_s[0]) : interpolate(node_s, node_r, s);
}

float shininess_from_perceptual_roughness(float perceptual_roughness)
{
    float r = clamp(perceptual_roughness, 0.0f, 1.0f);
    float low = 0.0f;
    float high = 1e5f;
    if (r <= perceptual_roughness_from_shininess(high))
        return high;
    for (int i = 0; i < 64; i++) {
        float middle = 0.5f * (low + high);
        if (perceptual_roughness_from_shininess(middle) > r)
            low = middle;
        else
            high = middle;
    }
    return 0.5f * (low + high);
}

float reflectance_share_from_shininess(float shininess)
{
    return shininess <= node_s[0] ? 1.0f : interpolate(node_s, node_share, shininess);
}

uint32_t ogl1_to_pbr_closed(const ogl1_surface *in, pbr_surface *out)
{
    float brightest = max(in->specular[0], max(in->specular[1], in->specular[2]));
    *out = pbr_surface_default();
    out->perceptual_roughness = perceptual_roughness_from_shininess(in->shininess);
    out->ior = 0.0f;
    out->specular = min(1.0f, brightest * reflectance_share_from_shininess(in->shininess));
    uint32_t remarks = 0;
    for (int k = 0; k < 3; k++) {
        out->specular_color[k] = brightest > 0.0f ? in->specular[k] / brightest : 1.0f;
        out->base_color[k] = min(1.0f, in->diffuse[k] / max(1.0f - out->specular, 1e-3f));
        remarks |= in->diffuse[k] > 1.0f - out->specular ? (uint32_t)FIT_BASE_CLAMPED : 0u;
        remarks |= in->specular[k] > 0.02f && in->shininess < 4.0f ? (uint32_t)FIT_LOW_EXPONENT : 0u;
        remarks |= in->diffuse[k] + in->specular[k] > 1.0f ? (uint32_t)FIT_ENERGY_GAIN : 0u;
    }
    return remarks;
}

uint32_t ogl1_to_pbr_core_closed(const ogl1_surface *in, pbr_surface *out)
{
    pbr_surface full;
    uint32_t remarks = ogl1_to_pbr_closed(in, &full);
    *out = pbr_surface_default();
    out->perceptual_roughness = full.perceptual_roughness;
    out->metallic = clamp((full.specular - 0.04f) / 0.96f, 0.0f, 1.0f);
    for (int k = 0; k < 3; k++)
        out->base_color[k] = clamp(in->diffuse[k] / max(0.96f * (1.0f - out->metallic), 0.1f), 0.0f, 1.0f);
    return remarks;
}

uint32_t pbr_to_ogl1_closed(const pbr_surface *in, ogl1_surface *out)
{
    uint32_t remarks = pbr_to_ogl1_naive(in, out);
    float alpha = max(alpha_from_roughness(in->perceptual_roughness), ALPHA_MIRROR);
    out->shininess = min(2.3f / (alpha * alpha), 128.0f);
    for (int k = 0; k < 3; k++)
        out->specular[k] = min(1.0f, out->specular[k] * 0.27f / alpha);
    return remarks;
}
