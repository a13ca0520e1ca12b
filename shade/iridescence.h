/* iridescence.h - Fresnel reflectance of a surface under a thin film (KHR_materials_iridescence): soap
 * bubbles, oil, beetles. Light reflected at the film's two sides interferes; for each of Rec.709's
 * primaries the series of interreflections is integrated over the spectrum in closed form.
 *
 * Belcour and Barla 2017, "A Practical Extension to Microfacet Theory for the Modeling of Varying
 * Iridescence", with the simplifications of the extension's text: Schlick's Fresnel, no polarisation, two
 * terms of the series. */
#ifndef SHADE_IRIDESCENCE_H
#define SHADE_IRIDESCENCE_H

/* One Gaussian of the eye's sensitivity in the Fourier domain of the optical path: amplitude sqrt(2 pi
 * variance) cos(position phase + shift) exp(-variance phase^2); phase in 1/m, normalised by 1.0685e-7. */
FN float film_gaussian(float amplitude, float position, float variance, float phase, float shift)
{
    return amplitude * (1.0f / 1.0685e-7f) * sqrt(2.0f * PI * variance) * cos(position * phase + shift) *
           exp(-variance * phase * phase);
}

/* Sensitivity to interference at an optical path difference in nm and a phase shift per channel in rad,
 * linear Rec.709. Belcour and Barla 2017, equation 12; x has a second lobe in the blue. */
FN vec3 film_sensitivity(float path_nm, vec3 shift)
{
    float phase = 2.0f * PI * path_nm * 1e-9f;
    float x = film_gaussian(5.4856e-13f, 1.6810e6f, 4.3278e9f, phase, shift[0]) +
              film_gaussian(9.7470e-14f, 2.2399e6f, 4.5282e9f, phase, shift[0]);
    float y = film_gaussian(4.4201e-13f, 1.7953e6f, 9.3046e9f, phase, shift[1]);
    float z = film_gaussian(5.2481e-13f, 2.2084e6f, 6.6121e9f, phase, shift[2]);
    return rec709_from_xyz(vec3(x, y, z));
}

/* Refractive index with the reflectance F0 against air; F0 of 1 is clamped to 0.9999, as no index has it. */
FN vec3 film_base_ior(vec3 F0)
{
    vec3 root = sqrt(clamp(F0, 0.0f, 0.9999f));
    return (1.0f + root) / (1.0f - root);
}

/* Reflectance of the far side of the film, from its index and that of the base: Schlick per channel. */
FN vec3 film_base_reflectance(float film_ior, vec3 base_ior, float cos_film)
{
    vec3 r = (base_ior - film_ior) / (base_ior + film_ior);
    return F_Schlick(r * r, vec3(1.0f), cos_film);
}

/* The sum over interreflections: R12 is the reflectance of the film's near side (T121 = 1 - R12, passed
 * twice), R23 that of its far side. */
FN vec3 film_series(float R12, vec3 R23, float path_nm, vec3 shift)
{
    float T121 = 1.0f - R12;
    vec3 R123 = min(R23 * R12, 0.9999f);
    vec3 r123 = sqrt(R123);
    vec3 Rs = R23 * (T121 * T121) / (1.0f - R123);
    vec3 Cm = (Rs - T121) * r123;
    vec3 I = Rs + R12 + Cm * film_sensitivity(path_nm, shift) * 2.0f;
    Cm *= r123;
    I += Cm * film_sensitivity(2.0f * path_nm, shift * 2.0f) * 2.0f;
    return clamp(I, 0.0f, 1.0f);
}

/* Fades the film in from 0 to 0.03 nm, a tenth of an atom. KHR_materials_iridescence. */
FN float film_fade(float thickness_nm)
{
    return smoothstep(0.0f, 0.03f, thickness_nm);
}

/* Reflectance in [0, 1] of a film of the given index and thickness (nm) over a base of reflectance F0, in
 * air, for light at cos_air to the normal. Below 0.03 nm the film fades into F_Schlick(F0, 1, cos_air); at
 * normal incidence, so does a film with the index of air or of the base. (At other angles Schlick's curve
 * reflects without an interface.)
 *
 * This differs from the extension's text for vanishing films: the text fades the index only and keeps the
 * product of both reflectances above 1e-5, with which a thickness of 0 would still add 0.006 and more. Its
 * sum also exceeds 1 by 3e-5 in places; this one does not. */
FN vec3 F_iridescent(float film_ior, float thickness_nm, vec3 F0, float cos_air)
{
    float fade = film_fade(thickness_nm);
    float ior = mix(1.0f, film_ior, fade);
    float cos2 = 1.0f - (1.0f - cos_air * cos_air) / (ior * ior);
    if (cos2 < 0.0f)
        return vec3(1.0f); /* a film thinner than air: total reflection */
    float cos_film = sqrt(cos2);

    float R12 = F_Schlick1(F0_from_ior(ior), 1.0f, cos_air);
    vec3 base_ior = film_base_ior(F0);
    vec3 R23 = film_base_reflectance(ior, base_ior, cos_film);

    /* phase pi where the medium beyond is rarer; the near side is seen from within the film */
    float near = sel(ior < 1.0f, 0.0f, PI);
    vec3 shift = vec3(near) + vec3(sel(base_ior[0] < ior, PI, 0.0f), sel(base_ior[1] < ior, PI, 0.0f),
                                   sel(base_ior[2] < ior, PI, 0.0f));
    vec3 F = film_series(R12, R23, 2.0f * ior * thickness_nm * cos_film, shift);
    return mix(F_Schlick(F0, vec3(1.0f), cos_air), F, fade);
}

#endif
