/* present.frag - radiance to the display values of a window: sRGB, not premultiplied, or premultiplied in that
 * encoding. */
uniform sampler2D u_image;

out vec4 fragment;

void main()
{
    ivec2 at = ivec2(gl_FragCoord.xy - frame_size.zw); /* the window's corner */
#ifdef IS_TOP_DOWN
    at.y = textureSize(u_image, 0).y - 1 - at.y;
#endif
    vec4 texel = texelFetch(u_image, at, 0);
    float opacity = clamp(texel.w, 0.0, 1.0);
    vec3 color = vec3(0.0);
    if (opacity > 0.0)
        color = display_color(texel.xyz / opacity);
    if (background.w > 0.0) {
        color = mix(background.xyz, color, opacity);
        opacity = 1.0;
    }
    fragment = vec4(display_encode(color), opacity);
#ifdef IS_PREMULTIPLIED
    fragment.xyz *= opacity;
#endif
}
