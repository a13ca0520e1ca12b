/* halve.frag - an image downsampled to half its size: 13 bilinear lookups over 6 x 6 pixels, five boxes of which
 * the middle one has half of the weight, so that small bright spots do not flicker when they move (Jimenez 2014,
 * "Next generation post-processing in Call of Duty: Advanced Warfare"). The sum of light is preserved. With
 * IS_COPY each pixel is copied. Half floats hold at most 65504: larger values are clamped, and NaN is removed. */
uniform highp sampler2D u_level;
uniform vec2 u_pixel; /* 1 / size of the viewport */

out vec4 fragment;

#ifdef IS_COPY
vec4 as_half(vec4 c)
{
    return vec4(isnan(c.x) ? 0.0 : clamp(c.x, 0.0, 65000.0), isnan(c.y) ? 0.0 : clamp(c.y, 0.0, 65000.0),
                isnan(c.z) ? 0.0 : clamp(c.z, 0.0, 65000.0), isnan(c.w) ? 0.0 : clamp(c.w, 0.0, 1.0));
}

void main()
{
    fragment = as_half(texelFetch(u_level, ivec2(gl_FragCoord.xy), 0));
}
#else
vec4 fetch(vec2 texel, float x, float y)
{
    return textureLod(u_level, gl_FragCoord.xy * u_pixel + texel * vec2(x, y), 0.0);
}

void main()
{
    vec2 t = 1.0 / vec2(textureSize(u_level, 0));
    vec4 near = fetch(t, -1.0, -1.0) + fetch(t, 1.0, -1.0) + fetch(t, -1.0, 1.0) + fetch(t, 1.0, 1.0);
    vec4 sides = fetch(t, -2.0, 0.0) + fetch(t, 2.0, 0.0) + fetch(t, 0.0, -2.0) + fetch(t, 0.0, 2.0);
    vec4 corners = fetch(t, -2.0, -2.0) + fetch(t, 2.0, -2.0) + fetch(t, -2.0, 2.0) + fetch(t, 2.0, 2.0);
    fragment = (near + fetch(t, 0.0, 0.0)) * 0.125 + sides * 0.0625 + corners * 0.03125;
}
#endif
