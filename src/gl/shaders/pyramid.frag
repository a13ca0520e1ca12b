/* pyramid.frag - the filters between the levels of an image (gl_pyramid.h), after Jimenez 2014, "Next generation
 * post-processing in Call of Duty: Advanced Warfare". Down and up again they are as smooth as a wide Gaussian filter. */
uniform highp sampler2D u_level;
uniform vec2 u_pixel; /* 1 / size of the viewport */

out vec4 fragment;

#if defined(IS_COPY)
/* Half floats hold at most 65504: larger values are clamped, and NaN is removed. */
vec4 as_half(vec4 c)
{
    return vec4(isnan(c.x) ? 0.0 : clamp(c.x, 0.0, 65000.0), isnan(c.y) ? 0.0 : clamp(c.y, 0.0, 65000.0),
                isnan(c.z) ? 0.0 : clamp(c.z, 0.0, 65000.0), isnan(c.w) ? 0.0 : clamp(c.w, 0.0, 1.0));
}

void main()
{
    fragment = as_half(texelFetch(u_level, ivec2(gl_FragCoord.xy), 0));
}
#elif defined(IS_DOUBLED)
/* Upsampled to twice its size: a tent filter over 3 x 3 texels. */
void main()
{
    vec2 at = gl_FragCoord.xy * u_pixel;
    vec2 t = 1.0 / vec2(textureSize(u_level, 0));
    vec4 sum = vec4(0.0);
    for (int y = -1; y <= 1; y++)
        for (int x = -1; x <= 1; x++)
            sum += textureLod(u_level, at + t * vec2(x, y), 0.0) * float((2 - abs(x)) * (2 - abs(y)));
    fragment = sum / 16.0;
}
#else
vec4 fetch(vec2 texel, float x, float y)
{
    return textureLod(u_level, gl_FragCoord.xy * u_pixel + texel * vec2(x, y), 0.0);
}

/* Downsampled to half its size: 13 bilinear lookups over 6 x 6 pixels, five boxes of which the middle one has half of
 * the weight, so that small bright spots do not flicker when they move. The sum of light is preserved. */
void main()
{
    vec2 t = 1.0 / vec2(textureSize(u_level, 0));
    vec4 near = fetch(t, -1.0, -1.0) + fetch(t, 1.0, -1.0) + fetch(t, -1.0, 1.0) + fetch(t, 1.0, 1.0);
    vec4 sides = fetch(t, -2.0, 0.0) + fetch(t, 2.0, 0.0) + fetch(t, 0.0, -2.0) + fetch(t, 0.0, 2.0);
    vec4 corners = fetch(t, -2.0, -2.0) + fetch(t, 2.0, -2.0) + fetch(t, -2.0, 2.0) + fetch(t, 2.0, 2.0);
    fragment = (near + fetch(t, 0.0, 0.0)) * 0.125 + sides * 0.0625 + corners * 0.03125;
}
#endif
