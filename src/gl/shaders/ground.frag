/* ground.frag - the shadow on an invisible plane under the model: black with an opacity of the share of light that
 * the model blocks, at the middle of each pixel. The plane is behind the whole model for an eye above it, and not
 * drawn for others.
 *
 * From the environment it takes the occlusion that ground_map.frag found for a uniform sky; from punctual lights
 * and the sun, where they have shadows, what those block. Lights without shadows do not count: they would weaken
 * the shadows of others. */
uniform highp sampler2D u_ground;

out vec4 fragment;

/* P: relative to the eye. The mean of 4 x 4 lookups a texel apart: the directions of neighbours interleave and
 * repeat every four texels. The map fades out at its border. */
float hidden_sky(vec3 P)
{
    vec2 at = (P.xz + eye.xz - light_ground.xy) / (2.0 * light_ground.z) + 0.5;
    vec2 texel = 1.0 / vec2(textureSize(u_ground, 0));
    vec2 from_edge = min(at, 1.0 - at);
    float inside = smoothstep(0.0, 0.15, min(from_edge.x, from_edge.y));
    float sum = 0.0;
    if (inside > 0.0)
        for (int i = 0; i < 16; i++)
            sum += textureLod(u_ground, at + texel * (vec2(i & 3, i >> 2) - 1.5), 0.0).x;
    return sum * (inside / 16.0);
}

/* Share of the light that the model blocks. */
float opacity_at(vec3 P)
{
    float hidden = hidden_sky(P);
#if defined(HAS_LIGHTS) && defined(HAS_SHADOWS)
    float open = luminance(light_irradiance_over_pi(vec3(0.0, 1.0, 0.0))) * PI;
    float lit = open * (1.0 - hidden);
    int count = light_count(P);
    light_face = vec3(0.0, 1.0, 0.0);
    for (int i = 0; i < count; i++) {
        uvec4 rest;
        Light l = light_open_at(i, rest);
        if (rest.y == 0u)
            continue;
        LightSample light = light_illuminate(l, P);
        float E = luminance(light.E) * max(light.L.y, 0.0);
        open += E;
        if (E > 0.0)
            lit += E * shadow_share(shadow_record(int(rest.y)), P, light_face);
    }
    hidden = open > 0.0 ? 1.0 - lit / open : hidden;
#endif
    return clamp(hidden, 0.0, 1.0);
}

void main()
{
    vec2 at = gl_FragCoord.xy + frame_size.zw - 0.5 * frame_size.xy;
    vec3 aside = right.xyz * at.x + up.xyz * at.y;
    bool is_orthographic = eye.w > 0.5;
    vec3 origin = is_orthographic ? aside : vec3(0.0);
    vec3 d = is_orthographic ? forward.xyz : forward.xyz + aside;
    float height = origin.y + eye.y - light_ground.w;
    if (!(height > 0.0 && d.y < 0.0))
        discard;
    float fade = ground_fade((gl_FragCoord.xy + frame_size.zw) / frame_size.xy);
    fragment = vec4(0.0, 0.0, 0.0, opacity_at(origin - d * (height / d.y)) * fade);
}
