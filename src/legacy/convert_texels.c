/* convert_texels.c - see convert_texels.h. Reference 7.2, texel by texel:
 *   sf = min(1, max(Cs) g(s)),  color of F0 = Cs / max(Cs),  base = min(1, Cd / (1 - sf)),  r(s) */
#include "legacy/convert_texels.h"

#include <string.h>

#include "legacy/convert_surface.h"

uint8_t texel_code(float value)
{
    return (uint8_t)(unit_of(value) * 255.0f + 0.5f);
}

static const uint8_t *texel_of(const uint8_t *const *in, int input, uint32_t x)
{
    return in[input] ? in[input] + (size_t)x * 4 : NULL;
}

static float strength_of(const texel_parameters *p, const float specular[3], const uint8_t *shininess)
{
    return unit_of(highest_of(specular) * table_scalar(&p->share, shininess));
}

/* A pixel of the core profile, whose search for metallic has no closed form per channel. Neighbours are often equal. */
typedef struct core_texel {
    ogl1_surface in;
    pbr_surface out;
    bool is_known;
} core_texel;

static const pbr_surface *core_of(const texel_parameters *p, const uint8_t *const *in, uint32_t x,
                                  core_texel *last)
{
    ogl1_surface s;
    table_color(&p->diffuse, texel_of(in, TEXEL_DIFFUSE, x), s.diffuse);
    table_color(&p->specular, texel_of(in, TEXEL_SPECULAR, x), s.specular);
    s.shininess = table_scalar(&p->shininess, texel_of(in, TEXEL_SHININESS, x));
    if (!last->is_known || memcmp(&s, &last->in, sizeof s) != 0) {
        last->in = s;
        last->is_known = true;
        ogl1_to_pbr_core_closed(&s, &last->out);
    }
    return &last->out;
}

static void base_of(const texel_parameters *p, const uint8_t *const *in, uint32_t x, core_texel *last,
                    float base[3])
{
    if (p->is_core) {
        memcpy(base, core_of(p, in, x, last)->base_color, 3 * sizeof *base);
        return;
    }
    float specular[3];
    table_color(&p->specular, texel_of(in, TEXEL_SPECULAR, x), specular);
    table_color(&p->diffuse, texel_of(in, TEXEL_DIFFUSE, x), base);
    float rest = 1.0f - strength_of(p, specular, texel_of(in, TEXEL_SHININESS, x));
    for (int k = 0; k < 3; k++)
        base[k] = base[k] < rest ? base[k] / rest : base[k] > 0.0f ? 1.0f : 0.0f;
}

void texel_base_row(const void *parameters, uint32_t width, const uint8_t *const *in, uint8_t *out)
{
    const texel_parameters *p = parameters;
    core_texel last = {.is_known = false};
    for (uint32_t x = 0; x < width; x++, out += p->channel_count) {
        float base[3];
        base_of(p, in, x, &last, base);
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
    core_texel last = {.is_known = false};
    for (uint32_t x = 0; x < width; x++, out += 3) {
        const pbr_surface *core = p->is_core ? core_of(p, in, x, &last) : NULL;
        out[0] = 255;
        out[1] = texel_code(core ? core->perceptual_roughness
                                 : table_scalar(&p->roughness, texel_of(in, TEXEL_SHININESS, x)));
        out[2] = core ? texel_code(core->metallic) : 0;
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
