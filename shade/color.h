/* color.h - transfer functions and color spaces. Linear values have Rec.709 primaries and a D65 white
 * unless a name says otherwise. Matrices are derived from the primaries to ten digits (ITU-R BT.709,
 * BT.2020, SMPTE RP 431, D65 = (0.3127, 0.3290)); mat3() takes columns. */
#ifndef SHADE_COLOR_H
#define SHADE_COLOR_H

/* ---- transfer ---- */

/* sRGB transfer function, one channel, linear [0, 1] to encoded [0, 1] and back; not a power of 2.2. max()
 * keeps the unselected arm of sel() from being NaN. IEC 61966-2-1. */
FN float srgb_from_linear1(float c)
{
    return sel(c <= 0.0031308f, 12.92f * c, 1.055f * pow(max(c, 0.0031308f), 1.0f / 2.4f) - 0.055f);
}
FN float linear_from_srgb1(float c)
{
    return sel(c <= 0.04045f, c / 12.92f, pow((max(c, 0.04045f) + 0.055f) / 1.055f, 2.4f));
}
FN vec3 srgb_from_linear(vec3 c)
{
    return vec3(srgb_from_linear1(c[0]), srgb_from_linear1(c[1]), srgb_from_linear1(c[2]));
}
FN vec3 linear_from_srgb(vec3 c)
{
    return vec3(linear_from_srgb1(c[0]), linear_from_srgb1(c[1]), linear_from_srgb1(c[2]));
}

/* Relative luminance Y of a linear color, in the unit of the color. ITU-R BT.709. */
FN float luminance(vec3 c)
{
    return dot(c, vec3(0.2126f, 0.7152f, 0.0722f));
}

/* ---- color spaces ---- */

FN vec3 xyz_from_rec709(vec3 c)
{
    return mul(mat3(vec3(0.4123907993f, 0.2126390059f, 0.0193308187f),
                    vec3(0.3575843394f, 0.7151686788f, 0.1191947798f),
                    vec3(0.1804807884f, 0.0721923154f, 0.9505321522f)),
               c);
}
FN vec3 rec709_from_xyz(vec3 c)
{
    return mul(mat3(vec3(3.2409699419f, -0.9692436363f, 0.0556300797f),
                    vec3(-1.5373831776f, 1.8759675015f, -0.2039769589f),
                    vec3(-0.4986107603f, 0.0415550574f, 1.0569715142f)),
               c);
}
FN vec3 rec2020_from_rec709(vec3 c)
{
    return mul(mat3(vec3(0.6274038959f, 0.0690972894f, 0.0163914389f),
                    vec3(0.3292830384f, 0.9195403951f, 0.0880133079f),
                    vec3(0.0433130657f, 0.0113623156f, 0.8955952532f)),
               c);
}
FN vec3 rec709_from_rec2020(vec3 c)
{
    return mul(mat3(vec3(1.6604910021f, -0.1245504745f, -0.0181507634f),
                    vec3(-0.5876411388f, 1.1328998971f, -0.1005788980f),
                    vec3(-0.0728498633f, -0.0083494226f, 1.1187296614f)),
               c);
}

#endif
