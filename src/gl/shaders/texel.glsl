/* texel.glsl - a texture of a material, filtered as the CPU filters it (draw/texture_sample.c). */

/* The mean of the probes that cover the pixel, as the CPU takes it: anisotropic filters of drivers are all different. */
vec4 probed_texel(sampler2D image, vec2 uv)
{
    vec2 size = vec2(textureSize(image, 0));
    Footprint f = footprint_from_derivatives(size, dFdx(uv), dFdy(uv));
    ProbeRow probes = footprint_probes(f, 1.0, 1.0 / size);
    float lod = footprint_is_finite(f) ? 0.5 * log2(max(probes.width2, 1e-30)) : 64.0;
    vec2 way = vec2(probes.step_u, probes.step_v);
    vec2 at = uv - way * (0.5 * float(probes.count - 1));
    vec4 sum = textureLod(image, at, lod);
    for (int i = 1; i < probes.count; i++)
        sum += textureLod(image, at + way * float(i), lod);
    return sum / float(probes.count);
}

vec4 filtered_texel(sampler2D image, vec2 uv, bool is_trilinear)
{
    if (is_trilinear)
        return probed_texel(image, uv);
    return texture(image, uv);
}
