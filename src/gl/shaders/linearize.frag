/* linearize.frag - an image of OpenGL 1's display values, converted to linear light as a display shows them. */
uniform highp sampler2D u_level;

out vec4 fragment;

void main()
{
    vec4 c = texelFetch(u_level, ivec2(gl_FragCoord.xy), 0);
    vec3 encoded = c.w > 0.0 ? clamp(c.xyz / c.w, 0.0, 1.0) : vec3(0.0);
    fragment = vec4(linear_from_srgb(encoded) * (c.w * exposure), c.w);
}
