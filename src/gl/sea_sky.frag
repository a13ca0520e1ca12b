/* sea_sky.frag - what is seen where the surface is not. */
layout(location = 0) out highp vec4 fragment;

void main()
{
    vec3 d = sea_direction();
#ifdef IS_BEFORE
    fragment = sea_shown(before_sky(d));
#else
#ifdef IS_BELOW
    vec3 radiance = sea_seen_through_water(vec3(0.0, sea_eye.x, 0.0), d);
#else
    vec3 radiance = sea_sky_seen(d);
#ifdef HAS_BED
    float land = sea_land(d);
    if (land > 0.0)
        radiance = sea_land_seen(d, land);
#endif
#endif
    fragment = sea_exposed(radiance);
#endif
}
