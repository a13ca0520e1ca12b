/* convert_texels.c - see convert_texels.h. Reference 7.2, texel by texel:
 *   sf = min(1, max(Cs) g(s)),  color of F0 = Cs / max(Cs),  base = min(1, Cd / (1 - sf)),  r(s) */
#include "legacy/convert_texels.h"

#include <string.h>

#include "legacy/convert_surface.h"

uint8_t texel_code(float value)
{
    return (uint8_t)(unit_of(value) * 255.0f + 0.5f);
}

/* The base is weighted with 1 - F, and F is the same at all angles. */
static float under_highlight(float diffuse, float strength)
{
    float rest = 1.0f - strength;
    return diffuse < rest ? diffuse / rest : diffuse > 0.0f ? 1.0f : 0.0f;
}

static const uint8_t *texel_of(const uint8_t *const *in, int input, uint32_t x)
{
    return in[input] ? in[input] + (size_t)x * 4 : NULL;
}

pbr_surface texel_surface(const ogl1_surface *in)
{
    pbr_surface s = pbr_surface_default();
    float most = highest_of(in->specular);
    s.perceptual_roughness = perceptual_roughness_from_shininess(in->shininess);
    s.ior = 0.0f;
    s.specular = unit_of(most * reflectance_share_from_shininess(in->shininess));
    for (int k = 0; k < 3; k++) {
        s.specular_color[k] = most > 0.0f ? in->specular[k] / most : 1.0f;
        s.base_color[k] = under_highlight(in->diffuse[k], s.specular);
    }
    return s;
}

static float strength_of(const texel_parameters *p, const float specular[3], const uint8_t *shininess)
{
    return unit_of(highest_of(specular) * table_scalar(&p->share, shininess));
}

static pbr_surface core_of(const texel_parameters *p, const uint8_t *const *in, uint32_t x)
{
    ogl1_surface s;
    table_color(&p->diffuse, texel_of(in, TEXEL_DIFFUSE, x), s.diffuse);
    table_color(&p->specular, texel_of(in, TEXEL_SPECULAR, x), s.specular);
    s.shininess = table_scalar(&p->shininess, texel_of(in, TEXEL_SHININESS, x));
    return core_grid_look_up(p->core, &s);
}

static void base_of(const texel_parameters *p, const uint8_t *const *in, uint32_t x, float base[3])
{
    if (p->is_core) {
        pbr_surface core = core_of(p, in, x);
        memcpy(base, core.base_color, sizeof core.base_color);
        return;
    }
    float specular[3];
    table_color(&p->specular, texel_of(in, TEXEL_SPECULAR, x), specular);
    table_color(&p->diffuse, texel_of(in, TEXEL_DIFFUSE, x), base);
    float strength = strength_of(p, specular, texel_of(in, TEXEL_SHININESS, x));
    for (int k = 0; k < 3; k++)
        base[k] = under_highlight(base[k], strength);
}

void texel_base_row(const void *parameters, uint32_t width, const uint8_t *const *in, uint8_t *out)
{
    const texel_parameters *p = parameters;
    for (uint32_t x = 0; x < width; x++, out += p->channel_count) {
        float base[3];
        base_of(p, in, x, base);
        for (int k = 0; k < 3; k++)
            out[k] = srgb_encode_u8(p->srgb, base[k] / p->base_scale[k]);
        if (p->channel_count == 4)
            out[3] = texel_code(table_scalar(&p->opacity, texel_of(in, TEXEL_OPACITY, x)));
    }
}

void texel_specular_row(const void *parameters, uint32_t width, const uint8_t *const *in, uint8_t *out)
{
    const texel_parameters *p = parameters;
    for (uint32_t x = 0; x < width; x++, out += 4) {
        float specular[3];
        table_color(&p->specular, texel_of(in, TEXEL_SPECULAR, x), specular);
        float most = highest_of(specular);
        for (int k = 0; k < 3; k++)
            out[k] = most > 0.0f ? srgb_encode_u8(p->srgb, specular[k] / most) : 255;
        out[3] = texel_code(strength_of(p, specular, texel_of(in, TEXEL_SHININESS, x)) / p->specular_scale);
    }
}

void texel_roughness_row(const void *parameters, uint32_t width, const uint8_t *const *in, uint8_t *out)
{
    const texel_parameters *p = parameters;
    for (uint32_t x = 0; x < width; x++, out += 3) {
        out[0] = 255;
        out[1] = texel_code(table_scalar(&p->roughness, texel_of(in, TEXEL_SHININESS, x)));
        out[2] = 0;
        if (p->is_core) {
            pbr_surface core = core_of(p, in, x);
            out[1] = texel_code(core.perceptual_roughness);
            out[2] = texel_code(core.metallic);
        }
    }
}

void texel_packed_row(const void *parameters, uint32_t width, const uint8_t *const *in, uint8_t *out)
{
    const packed_parameters *p = parameters;
    for (uint32_t x = 0; x < width; x++, out += 3) {
        out[0] = texel_code(table_scalar(&p->occlusion, texel_of(in, 0, x)));
        out[1] = texel_code(table_scalar(&p->roughness, texel_of(in, 0, x)));
        out[2] = texel_code(table_scalar(&p->metallic, texel_of(in, 1, x)));
    }
}
