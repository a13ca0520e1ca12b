/* surface_io.glsl - what fragments of a surface receive from surface.vert, and what they put out. Inputs are evaluated
 * at the pixel's middle, on the plane of the triangle, even where the triangle covers another part of the pixel:
 * triangles that share a pixel then agree. */
#if defined(IS_TRACING) && !defined(HAS_TRANSMISSION)
#undef IS_TRACING /* there is nothing behind */
#endif
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

/* Trilinear lookups at at, at + stride, .. */
struct Probes
{
    vec2 at;
    vec2 stride;
    int count;
    float lod;
};

/* Those that cover the pixel, as the CPU takes them: drivers' anisotropic filters differ. size: texels. */
Probes probes_at(vec2 size, vec2 uv)
{
    int limit = is_draft != 0 ? 1 : FOOTPRINT_MAX_PROBES;
    Footprint f = footprint_from_derivatives(size, dFdx(uv), dFdy(uv));
    ProbeRow probes = footprint_probes_up_to(limit, f, 1.0, 1.0 / size);
    float lod = footprint_is_finite(f) ? 0.5 * log2(max(probes.width2, 1e-30)) : 64.0;
    vec2 stride = vec2(probes.step_u, probes.step_v);
    return Probes(uv - stride * (0.5 * float(probes.count - 1)), stride, probes.count, lod);
}

/* Their mean. */
vec4 probed_texel(sampler2D image, Probes p)
{
    vec4 sum = textureLod(image, p.at, p.lod);
    for (int i = 1; i < p.count; i++)
        sum += textureLod(image, p.at + p.stride * float(i), p.lod);
    return sum / float(p.count);
}

vec4 filtered_texel(sampler2D image, vec2 uv, bool is_trilinear)
{
    if (is_trilinear)
        return probed_texel(image, probes_at(vec2(textureSize(image, 0)), uv));
    return texture(image, uv);
}

/* ---- outputs: radiance for one of the transparency modes (gl_transparency.h), or the AOVs that gl_film.c reads ---- */

#if defined(AOVS)
layout(location = 0) out vec4 aov_normal_depth;    /* world; m along the camera's axis */
layout(location = 1) out vec4 aov_color_occlusion; /* linear base color; 1: unoccluded */
/* of the geometry; TEXCOORD_0; opacity, 0: there is no surface */
layout(location = 2) out vec4 aov_number_texcoord;
#elif defined(IS_TRACING)
/* What reaches the nearest boundary of glass from behind. */
layout(location = 0) out vec4 traced_radiance; /* cd/m^2; m along the camera's axis */
layout(location = 1) out vec4 traced_backdrop; /* share of the background; material, 0: there is no surface */
layout(location = 2) out vec4 traced_unseen;   /* the environment's radiance in its place */
#elif defined(IS_WEIGHTED)
layout(location = 0) out vec4 fragment;         /* light and transmittance */
layout(location = 1) out float fragment_weight; /* the divisor of the light */
uniform vec2 u_depths;                          /* of the nearest, m; 1 / distance from it to the farthest */
#else
out vec4 fragment;
#endif

#ifdef IS_PEELED
uniform highp sampler2D u_peeled; /* depth of the previous layer */

bool is_behind_peeled()
{
    float peeled = texelFetch(u_peeled, ivec2(gl_FragCoord.xy), 0).x;
    return far_depth < 0.5 ? gl_FragCoord.z < peeled : gl_FragCoord.z > peeled;
}
#endif

#ifdef AOVS
/* The nearest surface that is not fully transparent. */
void put_aovs(vec3 N, vec3 color, float occlusion, float opacity)
{
    if (opacity <= 0.0)
        discard;
    aov_normal_depth = vec4(N, dot(v_position, forward.xyz));
    aov_color_occlusion = vec4(color, occlusion);
    aov_number_texcoord = vec4(v_instance.z, texcoord_of_set(0), opacity);
}
#elif !defined(IS_TRACING)
/* radiance: not yet multiplied by opacity. Every fragment ends here, after everything that reads derivatives. */
void put_fragment(vec3 radiance, float opacity)
{
#ifdef IS_PEELED
    if (!is_behind_peeled())
        discard;
#endif
#ifdef IS_WEIGHTED
    float nearness = 1.0 - clamp((dot(v_position, forward.xyz) - u_depths.x) * u_depths.y, 0.0, 1.0);
    float weight = opacity * max(nearness * nearness * nearness, 1e-4);
    fragment = vec4(radiance * (opacity * weight), opacity);
    fragment_weight = opacity * weight;
#else
    fragment = vec4(radiance * opacity, opacity);
#endif
}
#endif
