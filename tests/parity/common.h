/* common.h - what the parity cases share. A case is a function "FN vec3 case_NAME(vec2 u)" of u in (0,
 * 1)^2 that returns results of shader functions; the section heading names the header that it is about.
 * parity_test.c runs every case in C and on the GPU. */

/* Two directions above the horizon, in tangent space, away from the poles of the functions. */
FN vec3 parity_V(vec2 u)
{
    return normalize(vec3(0.6f - 0.4f * u[1], -0.2f, 0.2f + 0.5f * u[0]));
}

FN vec3 parity_L(vec2 u)
{
    return normalize(vec3(2.0f * u[0] - 1.0f, 2.0f * u[1] - 1.0f, 0.4f));
}

FN Surface parity_surface(vec2 u)
{
    return surface_from_gltf(normalize(vec3(0.1f, 0.05f, 1.0f)), vec3(0.9f, 0.5f, 0.1f), u[0],
                             0.25f + 0.75f * u[1], 1.3f + u[0], 0.8f, vec3(1.0f, 0.7f, 2.0f),
                             occlusion_from_texel(u[0], 0.5f), vec3(u[1]));
}
