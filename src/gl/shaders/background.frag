/* background.frag - the environment behind the model, as seen through the middle of each pixel. */
out vec4 fragment;

void main()
{
    vec2 place = gl_FragCoord.xy + frame_size.zw - 0.5 * frame_size.xy;
    vec3 d = forward.xyz;
    if (eye.w == 0.0)
        d += right.xyz * place.x + up.xyz * place.y;
#ifdef IS_BLURRED
    vec3 radiance = light_specular(normalize(d), background_blur);
#else
    vec3 radiance = light_background(normalize(d));
#endif
    fragment = vec4(radiance * exposure, 1.0);
}
