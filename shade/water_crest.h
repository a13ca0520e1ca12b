/* water_crest.h - sunlight that enters the sunlit sides of waves and is scattered out of the sides seen
 * against the sun. The wave at a point is unknown: it is taken as a sine with the amplitude of the sea and
 * the wavelength of its highest waves, at the phase given by the height of the point.
 *
 * Both sun and view are refracted downwards, so that light is scattered by some 50 to 90 degrees, and the sun
 * is never visible unscattered: that would require a prism with slopes over 41 degrees on either side, while
 * waves break at 30. A shaded side has unlit water in front of the light, up to the width of the wave. */
#ifndef SHADE_WATER_CREST_H
#define SHADE_WATER_CREST_H

/* Parameters of an image. */
STRUCT(WaterCrest)
{
    vec3 beam;        /* irradiance (lx) across the sun's beam in the water, 0: no sun */
    vec3 sunward;     /* unit direction to the sun in it */
    float wavenumber; /* of the sine, rad/m */
    float amplitude;  /* m */
};

/* Mean slope towards the sun of sunlit points: of Gaussian slopes of that variance, each weighted by tilt +
 * slope, tilt the tangent of the sun's elevation. s^2 Phi(z) / (tilt Phi(z) + s phi(z)), z = tilt / s; 1.25 s
 * at the horizon. */
FN float water_sunlit_slope(float tilt, float variance)
{
    float z = max(tilt, 0.0f) * inversesqrt(max(variance, SLOPE_VARIANCE_MIN));
    float above = exp(-0.5f * z * z); /* sqrt(2 pi) phi(z) */
    float share = 1.0f - 0.5f * above * erfcx(z * 0.707106781f);
    return max(variance, 0.0f) * share /
           (max(tilt, 0.0f) * share + 0.398942280f * above * sqrt(max(variance, SLOPE_VARIANCE_MIN)));
}

/* variance: of all slopes along the sun's azimuth. The beam enters through water tilted like the average
 * sunlit point, and carries the irradiance transmitted by level water: E (1 - F) L.y = beam sunward.y. */
FN WaterCrest water_crest_beam(Water w, WaterLight light, float variance, float wavenumber, float amplitude)
{
    float level = max(sqrt(light.L[0] * light.L[0] + light.L[2] * light.L[2]), 1e-4f);
    float slope = -water_sunlit_slope(light.L[1] / level, variance);
    vec3 N = normal_from_slope(vec2(light.L[0], light.L[2]) * (slope / level));
    WaterCrest c;
    c.sunward = -water_refracted(w, -light.L, N);
    c.beam = light.sun_irradiance * ((1.0f - light.sun_fresnel) * max(light.L[1], 0.0f) / c.sunward[1]);
    c.wavenumber = wavenumber;
    c.amplitude = amplitude;
    return c;
}

/* Path length (m) in water from a point of that phase (rad, [0, pi]: from the crest on, away from the sun)
 * to the sunbeam that enters at `entry` before it, along the refracted ray `down`, and back along that
 * beam. sun: unit and horizontal, towards it. 0 from a point to itself. */
FN float water_crest_path_length(WaterCrest c, vec2 sun, vec3 down, float phase, float entry)
{
    float across = max(phase - entry, 0.0f) / c.wavenumber; /* to its entry, towards the sun */
    float up = max(cos(entry) - cos(phase), 0.0f) * c.amplitude;
    float level = max(c.sunward[0] * sun[0] + c.sunward[2] * sun[1], 1e-3f);
    float along = down[0] * sun[0] + down[2] * sun[1];
    float closing = max(c.sunward[1] * along - down[1] * level, 1e-3f);
    float before = max(c.sunward[1] * across - up * level, 0.0f) / closing;
    return before + max(across - before * along, 0.0f) / level;
}

/* Fraction, per channel, of the light of water lit everywhere as at its crest, at a point `height` m above
 * the level. tilt: tangent of the sun's elevation. Behind the crest sunlight fades with the slope and ends
 * where that equals the sun's elevation. A ray that first meets light at the path length x and all of it
 * at x + d, increasing linearly between, gathers
 *   e^(-K x) (r + (1 - r) (1 - e^(-K d)) / (K d)),  K = a + b_b
 * where the point itself has the fraction r, or has x > 0. */
FN vec3 water_crest_lit(Water w, WaterCrest c, vec2 sun, float tilt, vec3 down, float height)
{
    float cosine = clamp(height / c.amplitude, -1.0f, 1.0f);
    float sine = sqrt(1.0f - cosine * cosine);
    float phase = atan(sine, cosine);
    float end = max(tilt, 0.0f) / (c.amplitude * c.wavenumber); /* sine of the phase where sunlight ends */
    float end_phase = sel(end < 1.0f, atan(end, sqrt(max(1.0f - end * end, 0.0f))), PI);
    float first = water_crest_path_length(c, sun, down, phase, min(end_phase, phase));
    float more = max(water_crest_path_length(c, sun, down, phase, 0.0f) - first, 0.0f);
    float here = sel(phase < end_phase, max(1.0f - sine / max(end, 1e-6f), 0.0f), 0.0f);
    vec3 K = max(water_diffuse(w), 1e-9f);
    vec3 growing = water_mean_transmittance(vec3(0.0f), K * more);
    return water_transmittance(K, first) * mix(growing, vec3(1.0f), here);
}

/* Radiance (1/sr) of a singly scattered beam for an irradiance of 1 on level water and cosines of sun and eye
 * in the water,
 *   b p / ((a + b_b) (mu_s + mu_v))
 * as near-forward scattering counts as unscattered (Gordon 1973). p for angles up to 90 degrees:
 * backscattered light is in the reflectance of deep water. */
FN vec3 water_forward(Water w, float cos_angle, float mu_s, float mu_v)
{
    return w.scattering * water_phase(w, max(cos_angle, 0.0f)) /
           (max(water_diffuse(w), 1e-9f) * max(mu_s + mu_v, 1e-3f));
}

/* Radiance (cd/m^2) below the surface, beside the reflectance of deep water, of forward scattered sunlight
 * in excess of that of level water. N: of the resolved waves; down: refracted from the eye; height: over
 * the mean level, m. Zero for level water and with the sun behind the eye. */
FN vec3 water_crest(Water w, WaterLight light, WaterCrest c, vec3 N, vec3 V, vec3 down, float height)
{
    float level = sqrt(light.L[0] * light.L[0] + light.L[2] * light.L[2]);
    vec2 sun = vec2(light.L[0], light.L[2]) * (1.0f / max(level, 1e-4f));
    bool is_against = sun[0] * V[0] + sun[1] * V[2] < 0.0f && N[0] * sun[0] + N[2] * sun[1] < 0.0f;
    if (!is_against || light.L[1] <= 0.0f || level < 1e-4f || c.amplitude <= 0.0f)
        return vec3(0.0f);
    vec3 up = vec3(0.0f, 1.0f, 0.0f);
    vec3 level_down = water_refracted(w, -normalize(vec3(V[0], max(V[1], 0.0f), V[2])), up);
    vec3 level_sunward = -water_refracted(w, -light.L, up);
    vec3 here = water_forward(w, dot(c.sunward, down), c.sunward[1], max(-down[1], 0.0f)) *
                water_crest_lit(w, c, sun, light.L[1] / level, down, height);
    vec3 there = water_forward(w, dot(level_sunward, level_down), level_sunward[1], -level_down[1]);
    return c.beam * c.sunward[1] * max(here - there, 0.0f);
}

#endif
