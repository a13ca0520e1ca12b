/* volume.h - the interior of a closed volume (KHR_materials_volume and volume_scatter): absorption and
 * scattering. Distances in m. */
#ifndef SHADE_VOLUME_H
#define SHADE_VOLUME_H

/* Transmittance over x m, per channel in [0, 1]: color^(x / attenuation_distance), Beer-Lambert.
 * attenuation_distance: where white becomes color; infinity (or 0, which files must not contain): no
 * absorption. A channel of 0 is opaque from the first path > 0 on. KHR_materials_volume, "Attenuation". */
FN vec3 volume_transmittance(vec3 attenuation_color, float attenuation_distance, float x)
{
    float t = min(sel(attenuation_distance > 0.0f, x / max(attenuation_distance, 1e-30f), 0.0f), 1e30f);
    vec3 T = pow(max(attenuation_color, 1e-30f), vec3(t));
    vec3 opaque = vec3(sel(t > 0.0f, 0.0f, 1.0f));
    return vec3(sel(attenuation_color[0] > 0.0f, T[0], opaque[0]),
                sel(attenuation_color[1] > 0.0f, T[1], opaque[1]),
                sel(attenuation_color[2] > 0.0f, T[2], opaque[2]));
}

/* Extinction coefficient in 1/m of the same: -ln(color) / attenuation_distance; 0 for a distance of
 * infinity or
 * 0. An opaque channel counts as a color of 1e-30. */
FN vec3 volume_extinction(vec3 attenuation_color, float attenuation_distance)
{
    float per_m = sel(attenuation_distance > 0.0f, 1.0f / max(attenuation_distance, 1e-30f), 0.0f);
    return -log(clamp(attenuation_color, 1e-30f, 1.0f)) * per_m;
}

/* Single-scattering albedo from the multiple-scattering color of a deep volume, one channel in [0, 1]:
 *   1 - (4.09712 + 4.20863 c - sqrt(9.59217 + 41.6808 c + 17.7126 c^2))^2
 * The scattering coefficient is this times the extinction. Kulla and Conty 2017, inverted;
 * KHR_materials_volume_scatter. */
FN float single_scatter_albedo1(float multiscatter)
{
    float c = multiscatter;
    float s = 4.09712f + 4.20863f * c - sqrt(9.59217f + 41.6808f * c + 17.7126f * c * c);
    return clamp(1.0f - s * s, 0.0f, 1.0f);
}
FN vec3 single_scatter_albedo(vec3 multiscatter_color)
{
    return vec3(single_scatter_albedo1(multiscatter_color[0]), single_scatter_albedo1(multiscatter_color[1]),
                single_scatter_albedo1(multiscatter_color[2]));
}

/* Phase function in 1/sr: (1 - g^2) / (4 pi (1 + g^2 - 2 g cos)^(3/2)), integral 1, mean cosine g in (-1, 1).
 * cos is between the directions of propagation before and after: -dot(V, L). Henyey and Greenstein 1941. */
FN float phase_HG(float cos_angle, float g)
{
    float d = max(1.0f + g * g - 2.0f * g * cos_angle, 1e-12f);
    return (1.0f - g * g) * 0.25f * INV_PI / (d * sqrt(d));
}

/* Direction of propagation after scattering, with the density phase_HG, from that before (both unit). */
FN vec3 sample_phase_HG(vec2 u, vec3 before, float g)
{
    float t = (1.0f - g * g) / (1.0f - g + 2.0f * g * u[1]);
    float c =
        sel(abs(g) < 1e-3f, 1.0f - 2.0f * u[1], (1.0f + g * g - t * t) / (2.0f * sel(g == 0.0f, 1.0f, g)));
    c = clamp(c, -1.0f, 1.0f);
    float s = sqrt(max(1.0f - c * c, 0.0f));
    float phi = 2.0f * PI * u[0];
    return mul(basis_from_normal(before), vec3(s * cos(phi), s * sin(phi), c));
}

#endif
