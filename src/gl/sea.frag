/* sea.frag - a pixel of a picture of the sea: the surface, or what is seen where it is not. Which of both, and how waves are read, is known
 * before (sea_class.frag). */
uniform highp sampler2D u_sea_seen; /* where the water rests that is seen, from the eye, m; distance, m; how fast rays close, 0: there is none */

layout(location = 0) out highp vec4 fragment;

#ifdef IS_BEFORE
vec4 sea_pixel(vec3 d, vec4 seen)
{
    return sea_shown(sea_before(sea_place(d, seen)));
}
vec4 sea_beside(vec3 d)
{
    return sea_shown(before_sky(d));
}
#else
#ifdef IS_BELOW
vec4 sea_beside(vec3 d)
{
    return sea_exposed(sea_seen_through_water(vec3(0.0, sea_eye.x, 0.0), d, 0.0, sea_ray.x * sea_ray.y * dot(d, forward.xyz)));
}
vec4 sea_pixel(vec3 d, vec4 seen)
{
    if (seen.z < sea_way_to_bed(vec3(0.0, sea_eye.x, 0.0), d))
        return sea_exposed(sea_shade_below(sea_place(d, seen)));
    return sea_beside(d);
}
#else
vec4 sea_beside(vec3 d)
{
#ifdef HAS_BED
    float land = sea_land(d);
    if (land > 0.0)
        return sea_exposed(sea_land_seen(d, land));
#endif
    return sea_exposed(sea_sky_seen(d));
}
vec4 sea_pixel(vec3 d, vec4 seen)
{
#ifdef HAS_BED
    float land = sea_land(d);
    if (land > 0.0 && land < seen.z)
        return sea_exposed(sea_land_seen(d, land));
#endif
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
#ifdef IS_BESIDE
    fragment = sea_beside(d);
#else
    fragment = sea_pixel(d, texelFetch(u_sea_seen, ivec2(gl_FragCoord.xy), 0));
#endif
}
