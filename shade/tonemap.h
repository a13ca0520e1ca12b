/* tonemap.h - tone mapping from scene-linear to display-linear color. Every operator takes linear Rec.709
 * in [0, inf), already exposed, and returns display-linear Rec.709 in [0, 1]; the sRGB transfer function
 * (color.h) comes after. Each is monotonic for grays and keeps black. */
#ifndef SHADE_TONEMAP_H
#define SHADE_TONEMAP_H

#define TONEMAP_NONE 0
#define TONEMAP_NEUTRAL 1
#define TONEMAP_ACES 2
#define TONEMAP_ACES_NARKOWICZ 3
#define TONEMAP_AGX 4
#define TONEMAP_REINHARD 5
#define TONEMAP_REINHARD_EXTENDED 6
#define TONEMAP_HABLE 7

/* c / (1 + c) per channel. Reinhard et al. 2002, equation 3. */
FN vec3 tonemap_reinhard(vec3 c)
{
    return c / (1.0f + c);
}

/* c (1 + Y / white^2) / (1 + Y) with luminance Y: preserves hue, and maps the luminance white to 1. Saturated
 * colors exceed [0, 1] and are clamped. Reinhard et al. 2002, equation 4. */
FN vec3 tonemap_reinhard_extended(vec3 c, float white)
{
    float Y = luminance(c);
    return clamp(c * ((1.0f + Y / (white * white)) / (1.0f + Y)), 0.0f, 1.0f);
}

/* The curve of Uncharted 2 before its scale. */
FN vec3 hable_curve(vec3 c)
{
    return (c * (c * 0.15f + 0.05f) + 0.004f) / (c * (c * 0.15f + 0.5f) + 0.06f) - 0.02f / 0.3f;
}

/* Hable's filmic curve with exposure bias 2 and linear white 11.2. Hable 2010, "Filmic Tonemapping
 * Operators". */
FN vec3 tonemap_hable(vec3 c)
{
    return clamp(hable_curve(c * 2.0f) / hable_curve(vec3(11.2f)), 0.0f, 1.0f);
}

/* Narkowicz's fit of ACES, per channel, without the pre-scale of 0.6, as in Khronos' renderer. Narkowicz
 * 2015, "ACES Filmic Tone Mapping Curve". */
FN vec3 tonemap_aces_narkowicz(vec3 c)
{
    return clamp(c * (c * 2.51f + 0.03f) / (c * (c * 2.43f + 0.59f) + 0.14f), 0.0f, 1.0f);
}

/* Hill's fit of the ACES reference rendering and output transforms, without the 1 / 0.6 of some
 * implementations. */
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

/* Khronos PBR Neutral: keeps base colors up to 0.8 (less the 0.04 that a dielectric reflects), compresses
 * only highlights, and desaturates these towards the compressed peak. Khronos PBR Neutral Tone Mapper
 * specification. */
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

/* AgX's contrast curve on log-encoded [0, 1]: Wrensch's sixth-degree fit of Sobotka's, base look. */
FN vec3 agx_contrast(vec3 x)
{
    vec3 x2 = x * x;
    vec3 x4 = x2 * x2;
    return x4 * x2 * 15.5f - x4 * x * 40.14f + x4 * 31.96f - x2 * x * 6.868f + x2 * 0.4298f + x * 0.1191f -
           0.00232f;
}

/* AgX: Rec.2020, inset, 16.5 stops of log2, contrast, outset, and decoding by a power of 2.2. Sobotka 2022,
 * with the matrices of Blender 4 as in three.js. */
FN vec3 tonemap_agx(vec3 color)
{
    mat3 inset =
        mat3(vec3(0.856627153f, 0.137318973f, 0.111898213f), vec3(0.0951212405f, 0.761241991f, 0.0767994186f),
             vec3(0.0482516061f, 0.101439036f, 0.811302368f));
    mat3 outset = mat3(vec3(1.127100582f, -0.141329763f, -0.141329763f),
                       vec3(-0.110606643f, 1.157823702f, -0.110606643f),
                       vec3(-0.016493939f, -0.016493939f, 1.251936407f));
    vec3 c = mul(inset, max(rec2020_from_rec709(color), 0.0f));
    c = clamp((log2(max(c, 1e-10f)) + 12.47393f) * (1.0f / 16.5f), 0.0f, 1.0f);
    c = mul(outset, agx_contrast(c));
    c = pow(max(c, 0.0f), vec3(2.2f));
    return clamp(rec709_from_rec2020(c), 0.0f, 1.0f);
}

/* The operator op, one of TONEMAP_*, for any color: negative values count as 0, and values are bounded so
 * that no operator computes inf / inf. */
FN vec3 tonemap(int op, vec3 color)
{
    vec3 c = clamp(color, 0.0f, 1e9f);
    if (op == TONEMAP_NEUTRAL)
        return tonemap_pbr_neutral(c);
    if (op == TONEMAP_ACES)
        return tonemap_aces(c);
    if (op == TONEMAP_ACES_NARKOWICZ)
        return tonemap_aces_narkowicz(c);
    if (op == TONEMAP_AGX)
        return tonemap_agx(c);
    if (op == TONEMAP_REINHARD)
        return tonemap_reinhard(c);
    if (op == TONEMAP_REINHARD_EXTENDED)
        return tonemap_reinhard_extended(c, 4.0f);
    if (op == TONEMAP_HABLE)
        return tonemap_hable(c);
    return clamp(c, 0.0f, 1.0f);
}

#endif
