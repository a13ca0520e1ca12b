/* sea.frag - a pixel of a picture of the sea: the surface, or what is seen where it is not. */
uniform highp sampler2D u_sea_seen; /* where the water rests that is seen, from the eye, m; distance, m; how fast rays close, 0: there is none */

layout(location = 0) out highp vec4 fragment;

#ifdef IS_BEFORE
vec4 sea_pixel(vec3 d, vec4 seen)
{
    return sea_shown(seen.w > 0.0 ? sea_before(sea_place(d, seen)) : before_sky(d));
}
#else
#ifdef IS_BELOW
vec4 sea_pixel(vec3 d, vec4 seen)
{
    vec3 eye_at = vec3(0.0, sea_eye.x, 0.0);
    if (seen.w > 0.0 && seen.z < sea_way_to_bed(eye_at, d))
        return sea_exposed(sea_shade_below(sea_place(d, seen)));
    return sea_exposed(sea_seen_through_water(eye_at, d));
}
#else
vec4 sea_pixel(vec3 d, vec4 seen)
{
#ifdef HAS_BED
    float land = sea_land(d);
    if (land > 0.0 && (seen.w == 0.0 || land < seen.z))
        return sea_exposed(sea_land_seen(d, land));
#endif
    if (seen.w == 0.0)
        return sea_exposed(sea_sky_seen(d));
    SeaPlace p = sea_place(d, seen);
#ifdef IS_PAINTED
    vec3 radiance = sea_painted(p);
#else
    vec3 radiance = sea_shade(p);
#endif
    return sea_exposed(sea_through_air(radiance, d, p.t));
}
#endif
#endif

void main()
{
    vec2 place = gl_FragCoord.xy + frame_size.zw - 0.5 * frame_size.xy;
    vec3 d = normalize(forward.xyz + right.xyz * place.x + up.xyz * place.y);
    fragment = sea_pixel(d, texelFetch(u_sea_seen, ivec2(gl_FragCoord.xy), 0));
}
