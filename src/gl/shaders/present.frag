/* present.frag - radiance to the display values of a window: as film_tone_map() computes them for files meant for
 * displays, sRGB and not premultiplied. */
uniform sampler2D u_image;

/* A constant, because software rasterizers compute all operators that a variable may choose. */
const int tonemap_operator = 0
#ifdef ADDS_1
    + 1
#endif
#ifdef ADDS_2
    + 2
#endif
#ifdef ADDS_4
    + 4
#endif
    ;

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
    if (opacity > 0.0) {
        color = min(texel.xyz / opacity, vec3(65504.0)); /* half floats may have overflowed */
        color = tonemap(tonemap_operator, color);
    }
    if (background.w > 0.0) {
        color = mix(background.xyz, color, opacity);
        opacity = 1.0;
    }
    fragment = vec4(srgb_from_linear(clamp(color, 0.0, 1.0)), opacity);
}
