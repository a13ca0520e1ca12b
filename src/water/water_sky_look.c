/* water_sky_look.c - light from a direction: looks up what water_sky.c has made. */
#include "ibl/equirect.h"

#include "water/water_sky.h"

static const float LIMB_DARKENING = 0.6f; /* in green; Cox 2000 */

/* ---- the sky ---- */

vec3 water_sky_view(const water_sky *s, const sky_view *v, vec3 d, float least_angle, float most_angle)
{
    float angle = equirect_atan2(sqrt(d[0] * d[0] + d[2] * d[2]), d[1]);
    sky_azimuth azimuth = sky_view_azimuth((double)equirect_atan2(d[2], d[0]) - s->sun_longitude);
    return sky_view_at(v, clamp(angle, least_angle, most_angle), &azimuth, clamp(dot(d, s->L), -1.0f, 1.0f)) *
           s->scale;
}

static vec3 rotated(const water_sky *s, vec3 d)
{
    return vec3(d[0] * s->rotation_cos - d[2] * s->rotation_sin, d[1],
                d[0] * s->rotation_sin + d[2] * s->rotation_cos);
}

vec3 water_sky_picture(const water_sky *s, vec3 d, float perceptual_roughness)
{
    vec3 r = rotated(s, d);
    const float R[3] = {r[0], r[1], r[2]};
    float out[3];
    ibl_specular(s->reflected, R, perceptual_roughness, out);
    return vec3(out[0], out[1], out[2]) * s->scale;
}

/* Limb darkening: 1 - u (1 - sqrt(1 - r^2)), over its mean 1 - u / 3; and the color that the air leaves at this height. */
static vec3 disc_through_air(const water_sky *s, vec3 d, float r2)
{
    float elevation = asin(clamp(d[1], -1.0f, 1.0f));
    float x = (elevation - s->disc.elevation_rad) / SUN_RADIUS * 0.5f + 0.5f;
    x = clamp(x, 0.0f, 1.0f) * (float)(SKY_SUN_NODES - 1);
    int node = (int)x < SKY_SUN_NODES - 2 ? (int)x : SKY_SUN_NODES - 2;
    vec3 light = max(mix(s->disc.nodes[node], s->disc.nodes[node + 1], x - (float)node), 0.0f);
    float limb =
        (1.0f - LIMB_DARKENING * (1.0f - sqrt(max(1.0f - r2, 0.0f)))) / (1.0f - LIMB_DARKENING / 3.0f);
    return elevation < s->disc.horizon_rad ? vec3(0.0f) : light * (limb * s->scale / SUN_SOLID_ANGLE);
}

vec3 water_sky_disc(const water_sky *s, vec3 d)
{
    vec3 off = d - s->L;
    float r2 = dot(off, off) / max(s->disc_radius * s->disc_radius, 1e-12f);
    if (s->disc_radius <= 0.0f || r2 >= 1.0f)
        return vec3(0.0f);
    return s->has_views ? disc_through_air(s, d, r2) : s->disc_radiance;
}

vec3 water_sky_seen(const water_sky *s, vec3 d)
{
    vec3 disc = water_sky_disc(s, d);
    if (s->has_views)
        return water_sky_view(s, &s->eye, d, 0.0f, s->horizon_rad) + disc;
    vec3 r = rotated(s, normalize(vec3(d[0], max(d[1], 0.0f), d[2])));
    const float direction[3] = {r[0], r[1], r[2]};
    float out[3];
    ibl_background(s->background, direction, 0.0f, out);
    return vec3(out[0], out[1], out[2]) * s->scale + disc;
}

vec3 water_sky_reflected(const water_sky *s, vec3 R, float perceptual_roughness)
{
    /* Lobes narrower than 0.02 in alpha are as good as mirrors under a sky without a disc; a picture's texels would show. */
    const float as_mirror = 0.14f;
    vec3 up = vec3(R[0], abs(R[1]), R[2]);
    float share = s->has_views ? clamp(perceptual_roughness / as_mirror, 0.0f, 1.0f) : 1.0f;
    vec3 sum = vec3(0.0f);
    if (share < 1.0f)
        sum = water_sky_view(s, water_sky_low(s), up, 0.0f, 0.5f * PI) * (1.0f - share);
    if (share > 0.0f)
        sum = sum + water_sky_picture(s, up, perceptual_roughness) * share;
    return sum;
}
