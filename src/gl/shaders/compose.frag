/* compose.frag - blended surfaces, accumulated separately from the image and composed over it: gl_transparency.h. */
uniform highp sampler2D u_sum;
#ifdef IS_WEIGHTED
uniform highp sampler2D u_weights;
#endif

out vec4 fragment; /* premultiplied */

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 sum = texelFetch(u_sum, pixel, 0); /* w: transmittance */
#if defined(IS_WEIGHTED)
    float weight = texelFetch(u_weights, pixel, 0).x;
    fragment = vec4(sum.xyz * ((1.0 - sum.w) / max(weight, 1e-12)), 1.0 - sum.w);
#elif defined(IS_SUM)
    fragment = vec4(sum.xyz, 1.0 - sum.w);
#else
    fragment = sum;
#endif
}
