/* sea.frag - a pixel of an image of the sea: the surface, or what is visible where there is none. Which of both,
 * and how waves are read, is decided before (sea_class.frag). */
/* resting position of the visible water, from the eye, m; distance, m; the closing rate of rays, 0: there is no
 * water */
uniform highp sampler2D u_sea_seen;

layout(location = 0) out highp vec4 fragment;

#ifdef IS_LEGACY
vec4 sea_pixel(vec3 d, vec4 seen, ivec2 pixel)
{
    return sea_shown(sea_legacy(sea_place(d, seen)));
}
vec4 sea_beside(vec3 d, ivec2 pixel)
{
    return sea_shown(before_sky(d));
}
#else
#ifdef HAS_MODEL
/* The model where it is nearer than t m, over what is behind it; both as the eye sees them. */
vec3 sea_model_over(vec3 behind, vec3 d, float t, ivec2 pixel)
{
    SeaModel m = sea_model_at(pixel, d / dot(d, forward.xyz));
    float way = length(m.at);
    if (m.color.w <= 0.0 || way > t)
        return behind;
    vec3 L = m.color.xyz / m.color.w;
#ifdef IS_BELOW
    L *= water_transmittance(water_K_d(sea_water()), max(-(sea_eye.x + m.at.y), 0.0));
    L = water_through(sea_water(), sea_downwelling.xyz, sea_beam.xyz, sea_sunward.xyz, L, max(-sea_eye.x, 0.0), d, way);
#else
    L = sea_through_air(L, d, way);
#endif
    return mix(behind, L, m.color.w);
}
#else
vec3 sea_model_over(vec3 behind, vec3 d, float t, ivec2 pixel)
{
    return behind;
}
#endif

#ifdef IS_BELOW
vec4 sea_beside(vec3 d, ivec2 pixel)
{
    return sea_exposed(sea_model_over(sea_seen_through_water(vec3(0.0, sea_eye.x, 0.0), d, 0.0, sea_ray.x * sea_ray.y * dot(d, forward.xyz)), d, 1e9, pixel));
}
vec4 sea_pixel(vec3 d, vec4 seen, ivec2 pixel)
{
    if (seen.z < sea_distance_to_bed(vec3(0.0, sea_eye.x, 0.0), d))
        return sea_exposed(sea_model_over(sea_shade_below(sea_place(d, seen)), d, seen.z, pixel));
    return sea_beside(d, pixel);
}
#else
vec4 sea_beside(vec3 d, ivec2 pixel)
{
    float t = 1e9;
    vec3 radiance = sea_sky_seen(d);
#ifdef HAS_BED
    float land = sea_land(d);
    if (land > 0.0) {
        t = land;
        radiance = sea_land_seen(d, land);
    }
#endif
    return sea_exposed(sea_model_over(radiance, d, t, pixel));
}
vec4 sea_pixel(vec3 d, vec4 seen, ivec2 pixel)
{
#ifdef HAS_BED
    float land = sea_land(d);
    if (land > 0.0 && land < seen.z)
        return sea_beside(d, pixel);
#endif
    SeaPlace p = sea_place(d, seen);
#ifdef IS_PAINTED
    vec3 radiance = sea_painted(p);
#else
    vec3 radiance = sea_shade(p);
#endif
    float t = p.t;
#ifdef HAS_MODEL
    if (sea_touched(p.at.xz).x > 0.5) /* a hull displaces it */
        t = 1e9;
#endif
    return sea_exposed(sea_model_over(sea_through_air(radiance, d, p.t), d, t, pixel));
}
#endif
#endif

void main()
{
    vec2 place = gl_FragCoord.xy + frame_size.zw - 0.5 * frame_size.xy;
    vec3 d = normalize(forward.xyz + right.xyz * place.x + up.xyz * place.y);
    ivec2 pixel = ivec2(gl_FragCoord.xy);
#ifdef IS_BESIDE
    fragment = sea_beside(d, pixel);
#else
    fragment = sea_pixel(d, texelFetch(u_sea_seen, pixel, 0), pixel);
#endif
}
