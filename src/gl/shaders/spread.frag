/* spread.frag - a level of an image upsampled to twice its size: a tent filter over 3 x 3 of its texels. With
 * halve.frag on the way down the two are as smooth as a wide Gaussian filter (Jimenez 2014). */
uniform highp sampler2D u_level;
uniform vec2 u_pixel; /* 1 / size of the viewport */

out vec4 fragment;

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
