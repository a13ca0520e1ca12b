/* surface_in.glsl - the outputs of surface.vert; and the position of the eye. All are evaluated at the pixel's
 * middle, on the plane of the triangle, even where the triangle covers another part of the pixel: triangles that
 * share a pixel then agree. */
in vec3 v_position; /* m, relative to the eye */
in vec3 v_normal;   /* in world space, not unit */
in vec4 v_color;
in vec4 v_texcoord01;
in vec4 v_texcoord23;
#ifdef HAS_TANGENTS
in vec3 v_tangent;
flat in float v_handedness;
#endif
flat in vec4 v_instance; /* scale, sign of bitangents, index of the geometry */

/* 1: the side with counter-clockwise vertices is visible, -1: the other one. */
float seen_side()
{
    return gl_FrontFacing ? 1.0 : -1.0;
}

/* Unit, from the surface to the eye. */
vec3 view_direction()
{
    return eye.w > 0.0 ? -forward.xyz : -normalize(v_position);
}

vec2 texcoord_of_set(int set)
{
    vec4 two = set < 2 ? v_texcoord01 : v_texcoord23;
    return (set & 1) == 0 ? two.xy : two.zw;
}

/* ---- textures, filtered as the CPU does (draw/texture_sample.c) ---- */

/* The mean of the probes that cover the pixel, as the CPU takes it: drivers' anisotropic filters differ. */
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
