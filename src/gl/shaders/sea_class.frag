/* sea_class.frag - sorts pixels by the work they need, as a depth that the following passes test against: a
 * software rasterizer skips what fails the depth test, but executes both branches of an if. gl_sea.c has the
 * numbers. */
uniform highp sampler2D u_sea_seen;

/* Bounds the error of the footprint: as far as sea_corrected() moves the place. */
const float SEA_MARGIN = 1.12;

float sea_class(vec3 d, vec4 seen)
{
    if (seen.w == 0.0)
        return 0.0;
    float t = seen.z;
    float rise = d.y + 2.0 * t * (1.0 - d.y * d.y) * sea_eye.y;
    float footprint = water_footprint(sea_ray.x * sea_ray.y * t * dot(d, forward.xyz), rise, sea_eye.z);
    float least = footprint / SEA_MARGIN;
    float most = footprint * SEA_MARGIN * inversesqrt(clamp(abs(rise), 1e-3, 1.0));
    int cubic_end = 0;
    int linear_begin = 0;
    int linear_end = 0;
    for (int tile = 0; tile < sea_counts.x; tile++) {
        float texels = least * sea_axes[tile].z;
        if (texels < 1.0)
            cubic_end = tile + 1;
        if (most * sea_axes[tile].z <= 0.5)
            linear_begin = tile + 1;
        if (texels < exp2(float(sea_counts.y - 1)))
            linear_end = tile + 1;
    }
    if (cubic_end > 0)
        linear_end = sea_counts.x;
    if (linear_begin < cubic_end - 1)
        linear_begin = 0;
    return float(1 + linear_end + SEA_CLASS_STEP * (linear_begin + SEA_CLASS_STEP * cubic_end)) / float(SEA_CLASSES);
}

void main()
{
    vec2 place = gl_FragCoord.xy + frame_size.zw - 0.5 * frame_size.xy;
    vec3 d = normalize(forward.xyz + right.xyz * place.x + up.xyz * place.y);
    gl_FragDepth = sea_class(d, texelFetch(u_sea_seen, ivec2(gl_FragCoord.xy), 0));
}
