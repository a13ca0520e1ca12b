/* dispersion.h - refractive index by wavelength (KHR_materials_dispersion). */
#ifndef SHADE_DISPERSION_H
#define SHADE_DISPERSION_H

/* Index of the middle of a channel (0 red, 1 green, 2 blue): ior -+ (ior - 1) 0.025 dispersion, at least 1;
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

#endif
