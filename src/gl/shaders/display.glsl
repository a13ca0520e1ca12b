/* display.glsl - radiance to the display values of a window, as film_tone_map() computes them for files meant for
 * displays. */

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

/* Linear; not premultiplied. */
vec3 display_color(vec3 radiance)
{
    return tonemap(tonemap_operator, min(radiance, vec3(65504.0))); /* half floats may have overflowed */
}

vec3 display_encode(vec3 color)
{
    return srgb_from_linear(clamp(color, 0.0, 1.0));
}
