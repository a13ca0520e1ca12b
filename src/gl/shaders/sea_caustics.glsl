/* sea_caustics.glsl - sunlight on the bed: caustic_map.c, bed_shadow.c and water_shade.c with textures. */
uniform highp sampler2DArray u_sea_caustics;

#ifdef HAS_MODEL
uniform highp sampler2D u_sea_touch; /* sea_touch */
#endif

/* Whether light on the bed varies from place to place. */
bool sea_has_light_on_bed()
{
    return sea_caustic_axis.z > 0.0 || sea_shadow.z > 0.0;
}

/* Transmittance of a model for light to the bed: for the beam, and for all other light. bed_shadow_at(). */
vec2 sea_shadow_at(vec2 at)
{
#ifdef HAS_MODEL
    vec2 place = (at - sea_shadow.xy) * sea_shadow.zw;
    bool is_within = all(greaterThan(place, vec2(0.0))) && all(lessThan(place, vec2(1.0)));
    vec2 open = textureLod(u_sea_touch, place, 0.0).zw;
    return is_within ? open : vec2(1.0);
#else
    return vec2(1.0);
#endif
}

/* The beam's light relative to its mean at a position from the eye; width: of the footprint, m; beyond: the value
 * outside all layers. */
float sea_caustic(vec2 place, float width, float beyond)
{
    float sum = 0.0;
    float open = 1.0;
    for (int l = 0; l < SEA_CAUSTIC_LAYERS && sea_caustic_axis.z > 0.0; l++) {
        vec2 from = place - sea_caustics[l].xy;
        vec2 uv = sea_caustics[l].z * vec2(dot(from, sea_caustic_axis.xy), sea_caustic_axis.x * from.y - sea_caustic_axis.y * from.x);
        float cover = open * caustic_cover(uv);
        if (cover > 0.0)
            sum += cover * textureLod(u_sea_caustics, vec3(0.5 * uv + 0.5, float(l)), caustic_lod(width / sea_caustics[l].w)).x;
        open -= cover;
    }
    return sum + open * beyond;
}

/* Light just below the surface where the bed is that far below, lx: water_light_over_bed(). */
vec3 sea_light_over_bed(Water w, float depth)
{
    return water_interreflected(w, sea_downwelling.xyz, water_bed_reflectance(w, sea_bed.xyz, depth));
}

/* Light on the bed over its mean, `way` m along d from a place. */
vec3 sea_bed_lit(Water w, vec3 at, vec3 d, float way, float width)
{
    vec2 place = at.xz + way * d.xz;
    float depth = max(sea_bed.w - dot(sea_bed_slope.xy, place), 0.0);
    vec3 focused = water_focused(w, sea_bed.xyz, sea_downwelling.xyz, sea_beam.xyz, sea_sunward.y, depth);
    vec2 open = sea_shadow_at(place);
    return water_bed_lit(focused, sea_caustic(place, width, open.x), open.y);
}
