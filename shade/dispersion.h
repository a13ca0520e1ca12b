/* dispersion.h - refractive index by wavelength (KHR_materials_dispersion). */
#ifndef SHADE_DISPERSION_H
#define SHADE_DISPERSION_H

/* Index at the center of a channel (0 red, 1 green, 2 blue): ior -+ (ior - 1) 0.025 dispersion, at least 1;
 * dispersion is 20 / Abbe number. ior 0 (infinite) has no dispersion. KHR_materials_dispersion, "Real-time". */
FN float dispersed_ior(float ior, float dispersion, int channel)
{
    float spread = (ior - 1.0f) * 0.025f * dispersion;
    return sel(ior < 1.0f, ior, max(ior + spread * float(channel - 1), 1.0f));
}

/* Index at a wavelength in nm by Cauchy's equation, at least 1; ior is that of the line d, 587.56 nm:
 *   n = ior + (ior - 1) / V_d (523655 / lambda^2 - 1.5168),  V_d = 20 / dispersion
 * KHR_materials_dispersion. */
FN float dispersed_ior_at(float ior, float dispersion, float wavelength_nm)
{
    float bend = 523655.0f / (wavelength_nm * wavelength_nm) - 1.5168f;
    return sel(ior < 1.0f, ior, max(ior + (ior - 1.0f) * dispersion * 0.05f * bend, 1.0f));
}

/* ---- one wavelength at a time ---- */

/* A wavelength and the weight of its path: 3 in its channel, 0 in the others, so that the mean over
 * channels is
 * 1. */
STRUCT(WavelengthSample)
{
    float wavelength_nm;
    int channel; /* 0 red, 1 green, 2 blue */
    vec3 weight;
};

/* Centers of the channels' bands: the dominant wavelengths of Rec.709's primaries against D65. */
#define RED_NM 611.4f
#define GREEN_NM 549.1f
#define BLUE_NM 464.2f
/* Half width of a band: neighbours overlap, so that a rainbow has no gaps and no steps. */
#define BAND_NM 75.0f

/* Samples a channel and a wavelength in its band, a tent around RED_NM, GREEN_NM or BLUE_NM, from u in [0,
 * 1). No weight is negative, unlike those of color matching functions: a rainbow is less saturated than
 * the spectrum, and less noisy. */
FN WavelengthSample sample_wavelength(float u)
{
    WavelengthSample s;
    float u3 = clamp(u, 0.0f, 0.99999994f) * 3.0f;
    s.channel = int(min(u3, 2.0f));
    float v = clamp(u3 - float(s.channel), 0.0f, 1.0f);
    float tent = sel(v < 0.5f, sqrt(2.0f * v) - 1.0f, 1.0f - sqrt(2.0f * (1.0f - v)));
    float middle = sel(s.channel == 0, RED_NM, sel(s.channel == 1, GREEN_NM, BLUE_NM));
    s.wavelength_nm = middle + BAND_NM * tent;
    s.weight = vec3(sel(s.channel == 0, 3.0f, 0.0f), sel(s.channel == 1, 3.0f, 0.0f),
                    sel(s.channel == 2, 3.0f, 0.0f));
    return s;
}

#endif
