/* shadow.glsl - the share of a light's radiance that arrives at a point: the shadow maps of gl_shadow.h. */
#ifdef HAS_SHADOWS
uniform highp sampler2DShadow u_shadows;

/* As gl_shadow_record. */
struct ShadowRecord {
    vec4 origin;  /* relative to the eye, m; w: kind */
    vec4 right;   /* w: size of a texel, m (at depth 1 m) */
    vec4 up;      /* w: first tile */
    vec4 forward; /* w: scale of s and t */
    vec2 depth;   /* a, b */
};

/* A point in the coordinates of a tile. */
struct ShadowPlace {
    vec2 at; /* [-1, 1] */
    float depth; /* along the axis, m (parallel: of the range) */
    vec3 right;  /* unit, along the rows of the tile; and along its columns */
    vec3 up;
    float tile;
};

ShadowPlace shadow_place(ShadowRecord r, vec3 d)
{
    ShadowPlace p;
    p.tile = r.up.w;
    if (r.origin.w < 1.5) {
        p.depth = dot(d, r.forward.xyz);
        p.right = normalize(r.right.xyz);
        p.up = normalize(r.up.xyz);
        p.at = vec2(dot(d, r.right.xyz), dot(d, r.up.xyz)) / (r.origin.w < 0.5 ? 1.0 : p.depth);
        return p;
    }
    vec4 face = cube_locate(d);
    int i = int(face.x);
    p.tile += 2.0 * face.x + face.y;
    p.at = face.zw * r.forward.w;
    p.depth = abs(d[i]);
    p.right = i == 0 ? vec3(0.0, 0.0, 1.0) : vec3(1.0, 0.0, 0.0);
    p.up = i == 1 ? vec3(0.0, 0.0, 1.0) : vec3(0.0, 1.0, 0.0);
    return p;
}

/* Share of the texels around a point that are not nearer to the light: a kernel of 6 by 6 texels in 9 lookups of 2
 * by 2 (Castano 2013, "Shadow mapping summary"). texel: in the texture. */
float shadow_filter(vec2 texel, float depth)
{
    vec2 base = floor(texel + 0.5);
    vec2 f = texel + 0.5 - base;
    vec3 weights_x = vec3(4.0 - 3.0 * f.x, 7.0, 1.0 + 3.0 * f.x);
    vec3 weights_y = vec3(4.0 - 3.0 * f.y, 7.0, 1.0 + 3.0 * f.y);
    vec3 x = vec3((3.0 - 2.0 * f.x) / weights_x.x - 2.0, (3.0 + f.x) / 7.0, f.x / weights_x.z + 2.0);
    vec3 y = vec3((3.0 - 2.0 * f.y) / weights_y.x - 2.0, (3.0 + f.y) / 7.0, f.y / weights_y.z + 2.0);
    float sum = 0.0;
    for (int j = 0; j < 3; j++)
        for (int i = 0; i < 3; i++) {
            vec2 at = (base - 0.5 + vec2(x[i], y[j])) * light_shadow.z;
            sum += weights_x[i] * weights_y[j] * textureLod(u_shadows, vec3(at, depth), 0.0);
        }
    return sum / 144.0;
}

/* P: relative to the eye; N: unit, normal of the face, on either side. The filter reaches three texels to each
 * side: a point is offset along its normal until the face is nowhere nearer to the light within the kernel; and
 * towards the light by a texel and a half, or the floor in front of a wall would darken the foot of the wall. */
float shadow_share(ShadowRecord r, vec3 P, vec3 N)
{
    vec3 d = P - r.origin.xyz;
    ShadowPlace p = shadow_place(r, d);
    bool is_parallel = r.origin.w < 0.5;
    float texel = r.right.w * (is_parallel ? 1.0 : p.depth);
    float reach = 3.0 * (abs(dot(N, p.right)) + abs(dot(N, p.up)));
    vec3 to_light = is_parallel ? -r.forward.xyz : -d;
    p = shadow_place(r, d + N * (sign(dot(N, to_light)) * texel * (reach + 0.1)) + normalize(to_light) * (1.5 * texel));
    float depth = is_parallel ? p.depth : r.depth.x + r.depth.y / p.depth;
    float edge = light_shadow.x;
    vec2 in_tile = clamp((p.at * 0.5 + 0.5) * edge, vec2(3.0), vec2(edge - 3.0));
    vec2 corner = vec2(mod(p.tile, light_shadow.y), floor(p.tile / light_shadow.y)) * edge;
    return shadow_filter(corner + in_tile, clamp(depth, 0.0, 1.0));
}
#endif
