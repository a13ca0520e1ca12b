/* sea_caustics.glsl - sunlight on the bed: caustic_map.c and water_shade.c with textures. */
uniform highp sampler2DArray u_sea_caustics;

/* The beam's light over its mean at a place from the eye; width: of the footprint, m. */
float sea_caustic(vec2 place, float width)
{
    float sum = 0.0;
    float open = 1.0;
    for (int l = 0; l < SEA_CAUSTIC_LAYERS; l++) {
        vec2 from = place - sea_caustics[l].xy;
        vec2 uv = sea_caustics[l].z * vec2(dot(from, sea_caustic_axis.xy), sea_caustic_axis.x * from.y - sea_caustic_axis.y * from.x);
        float cover = open * caustic_cover(uv);
        if (cover > 0.0)
            sum += cover * textureLod(u_sea_caustics, vec3(0.5 * uv + 0.5, float(l)), caustic_lod(width / sea_caustics[l].w)).x;
        open -= cover;
    }
    return sum + open;
}

/* Light on the bed over its mean, `way` m along d from a place. */
vec3 sea_bed_lit(Water w, vec3 at, vec3 d, float way, float width)
{
    vec2 place = at.xz + way * d.xz;
    float depth = max(sea_bed.w - dot(sea_bed_slope.xy, place), 0.0);
    vec3 focused = water_focused(w, sea_downwelling.xyz, sea_beam.xyz, sea_sunward.y, depth);
    return water_bed_lit(focused, sea_caustic(place, width));
}
