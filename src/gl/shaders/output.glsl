/* output.glsl - the outputs of a surface fragment: radiance for one of the transparency modes (gl_transparency.h), or the AOVs that
 * gl_film.c reads. */
#if defined(AOVS)
layout(location = 0) out vec4 aov_normal_depth;    /* world; m along the camera's axis */
layout(location = 1) out vec4 aov_color_occlusion; /* linear base color; 1: unoccluded */
/* of the geometry; TEXCOORD_0; opacity, 0: there is no surface */
layout(location = 2) out vec4 aov_number_texcoord;
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
    float before = texelFetch(u_peeled, ivec2(gl_FragCoord.xy), 0).x;
    return far_depth < 0.5 ? gl_FragCoord.z < before : gl_FragCoord.z > before;
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
#else
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
