/* sea.frag - the surface of a sea. */
layout(location = 0) out highp vec4 fragment;

void main()
{
    SeaPlace p = sea_place();
#ifdef IS_BEFORE
    fragment = sea_shown(sea_before(p));
#else
#ifdef IS_BELOW
    if (p.t >= sea_way_to_bed(vec3(0.0, sea_eye.x, 0.0), p.d))
        fragment = sea_exposed(sea_seen_through_water(vec3(0.0, sea_eye.x, 0.0), p.d));
    else
        fragment = sea_exposed(sea_shade_below(p));
#else
#ifdef HAS_BED
    float land = sea_land(p.d);
    if (land > 0.0 && land < p.t) {
        fragment = sea_exposed(sea_land_seen(p.d, land));
        return;
    }
#endif
#ifdef IS_PAINTED
    vec3 radiance = sea_painted(p);
#else
    vec3 radiance = sea_shade(p);
#endif
    fragment = sea_exposed(sea_through_air(radiance, p.d, p.t));
#endif
#endif
}
