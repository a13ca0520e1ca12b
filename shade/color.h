/* color.h - transfer functions and tone mapping. Linear values are Rec.709 primaries. */
#ifndef SHADE_COLOR_H
#define SHADE_COLOR_H

/* sRGB transfer function, one channel, [0, 1] to [0, 1]. IEC 61966-2-1. */
FN float srgb_from_linear1(float c)
{
    return sel(c <= 0.0031308f, 12.92f * c, 1.055f * pow(c, 1.0f / 2.4f) - 0.055f);
}
FN float linear_from_srgb1(float c)
{
    return sel(c <= 0.04045f, c / 12.92f, pow((c + 0.055f) / 1.055f, 2.4f));
}
FN vec3 srgb_from_linear(vec3 c)
{
    return vec3(srgb_from_linear1(c[0]), srgb_from_linear1(c[1]), srgb_from_linear1(c[2]));
}
FN vec3 linear_from_srgb(vec3 c)
{
    return vec3(linear_from_srgb1(c[0]), linear_from_srgb1(c[1]), linear_from_srgb1(c[2]));
}

CONST_ARRAY3(float, luminance_rec709, 0.2126f, 0.7152f, 0.0722f);

/* Relative luminance Y of a linear color, in the unit of the color. ITU-R BT.709. */
FN float luminance(vec3 c)
{
    return luminance_rec709[0] * c[0] + luminance_rec709[1] * c[1] + luminance_rec709[2] * c[2];
}

/* ACES filmic curve as fitted by Hill: linear scene-referred [0, inf) to display-linear [0, 1]. */
FN vec3 tonemap_aces(vec3 color)
{
    mat3 into_rrt = mat3(vec3(0.59719f, 0.07600f, 0.02840f), vec3(0.35458f, 0.90834f, 0.13383f),
                         vec3(0.04823f, 0.01566f, 0.83777f));
    mat3 out_of_odt = mat3(vec3(1.60475f, -0.10208f, -0.00327f), vec3(-0.53108f, 1.10813f, -0.07276f),
                           vec3(-0.07367f, -0.00605f, 1.07602f));
    vec3 c = mul(into_rrt, color);
    c = (c * (c + 0.0245786f) - 0.000090537f) / (c * (c * 0.983729f + 0.4329510f) + 0.238081f);
    return clamp(mul(out_of_odt, c), 0.0f, 1.0f);
}

/* Khronos PBR Neutral: keeps base colors up to 0.8, compresses only highlights.
 * [0, inf) to [0, 1]. Khronos PBR Neutral Tone Mapper specification. */
FN vec3 tonemap_pbr_neutral(vec3 color)
{
    float darkest = min(color[0], min(color[1], color[2]));
    float toe = sel(darkest < 0.08f, darkest - 6.25f * darkest * darkest, 0.04f);
    vec3 c = color - toe;
    float peak = max(c[0], max(c[1], c[2]));
    float start = 0.8f - 0.04f;
    if (peak < start)
        return c;
    float d = 1.0f - start;
    float new_peak = 1.0f - d * d / (peak + d - start);
    float desaturation = 1.0f - 1.0f / (0.15f * (peak - new_peak) + 1.0f);
    return mix(c * (new_peak / peak), vec3(new_peak), desaturation);
}

#endif
