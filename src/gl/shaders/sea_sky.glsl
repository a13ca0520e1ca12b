/* sea_sky.glsl - the sky over a sea, the air in front of it, and what is beyond the water: prerendered images of
 * the sky, and filtered light. Radiance in cd/m^2. */
#define SEA_SKY_SEEN 0
#define SEA_SKY_AIR 1
#define SEA_SKY_TRANSMITTANCE 2
#define SEA_SKY_DISC 3
#define SEA_LOBE_LAYERS 17

uniform highp sampler2DArray u_sea_sky;
#ifndef HAS_IMAGE
uniform highp sampler3D u_sea_lobes; /* layers: perceptual roughness */
#endif

/* An image at a direction, up (1) or down (-1) from the horizon. */
vec4 sea_sky_at_side(int layer, vec3 d, float side)
{
    float h = (d.y - sea_sky_at.x) / (side - sea_sky_at.x);
    return textureLod(u_sea_sky, vec3(sky_turn(d.x, d.z), sky_row(h), layer), 0.0);
}

/* The sun's disc. */
vec3 sea_disc(vec3 d)
{
    vec3 off = (d - sea_sun.xyz) / max(sea_beam.w, 1e-6);
    float level = length(sea_sun.xz);
    vec3 right = level > 1e-6 ? vec3(-sea_sun.z, 0.0, sea_sun.x) / level : vec3(1.0, 0.0, 0.0);
    vec3 up = cross(right, sea_sun.xyz);
    up = up.y < 0.0 ? -up : up;
    vec2 at = vec2(dot(off, right), dot(off, up));
    if (sea_beam.w <= 0.0 || dot(off, off) >= 1.0)
        return vec3(0.0);
    return textureLod(u_sea_sky, vec3(0.5 + 0.5 * at, SEA_SKY_DISC), 0.0).xyz;
}

vec3 sea_sky_seen(vec3 d)
{
#ifdef HAS_IMAGE
    vec3 sky = light_background(normalize(vec3(d.x, max(d.y, 0.0), d.z)));
#else
    vec3 sky = sea_sky_at_side(SEA_SKY_SEEN, d, 1.0).xyz;
#endif
    return sky + sea_disc(d);
}

vec3 host_sky(SeaHost host, vec3 R, float perceptual_roughness)
{
#ifdef HAS_IMAGE
    return light_specular(vec3(R.x, abs(R.y), R.z), perceptual_roughness);
#else
    float layer = clamp(perceptual_roughness, 0.0, 1.0) * float(SEA_LOBE_LAYERS - 1) + 0.5;
    return textureLod(u_sea_lobes, vec3(sky_turn(R.x, R.z), sky_row(abs(R.y)), layer / float(SEA_LOBE_LAYERS)), 0.0).xyz;
#endif
}

/* Transmittance of the air over a distance at the height of the eye. */
vec3 sea_clearness(float distance_km)
{
    float edge = 0.5 / float(textureSize(u_sea_sky, 0).x);
    float x = distance_km / (distance_km + sea_sky_at.y);
    vec3 left = textureLod(u_sea_sky, vec3(clamp(x, edge, 1.0 - edge), 0.5, SEA_SKY_TRANSMITTANCE), 0.0).xyz;
    return x < edge ? mix(vec3(1.0), left, x / edge) : left;
}

/* Through the air between the eye and what is t m away along d. */
vec3 sea_through_air(vec3 radiance, vec3 d, float t)
{
    vec3 left = sea_clearness(t * 0.001);
    return radiance * left + sea_sky_at_side(SEA_SKY_AIR, d, -1.0).xyz * (1.0 - left);
}

/* ---- the ground ---- */

#ifdef HAS_BED
/* Distance from the eye to ground above the water, m; -1: there is none. */
float sea_land(vec3 d)
{
    float closing = dot(sea_bed_slope.xy, d.xz) - d.y;
    float above = sea_eye.x + sea_bed.w;
    float land = closing > 0.0 ? above / closing : -1.0;
    float depth = land * dot(d, forward.xyz);
    bool is_seen = dot(sea_bed_slope.xy, sea_bed_slope.xy) > 0.0 && depth > sea_clip.x && depth < sea_clip.y;
    return is_seen ? land : -1.0;
}

vec3 sea_land_seen(SeaHost host, vec3 d, float land)
{
    vec3 N = normalize(vec3(-sea_bed_slope.x, 1.0, -sea_bed_slope.y));
    return sea_through_air(water_land(host_light(host), sea_bed.xyz, N), d, land);
}
#endif

/* ---- output ---- */

vec4 sea_exposed(vec3 radiance)
{
    vec3 c = radiance * exposure;
    return vec4(sea_bed_slope.w > 0.0 ? min(c, vec3(sea_bed_slope.w)) : c, 1.0);
}
