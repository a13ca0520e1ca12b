/* present.frag - radiance to the numbers of a display. */
uniform sampler2D u_picture;

in vec2 v_place;

out vec4 fragment;

void main()
{
    vec4 c = texture(u_picture, v_place);
    fragment = vec4(srgb_from_linear(clamp(c.xyz, 0.0, 1.0)), 1.0);
}
