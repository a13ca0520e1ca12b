/* transparency.glsl - where the radiance of a fragment goes: gl_transparency.h. */
#if defined(AOVS)
/* aovs.glsl */
#elif defined(IS_WEIGHTED)
layout(location = 0) out vec4 fragment;         /* light and what passes */
layout(location = 1) out float fragment_weight; /* what the light is to be divided by */
uniform vec2 u_depths;                          /* of the nearest, m; one over how far behind it the farthest is */
#else
out vec4 fragment;
#endif

#ifdef IS_PEELED
uniform highp sampler2D u_peeled; /* depth of the layer before */

bool is_behind_peeled()
{
    float before = texelFetch(u_peeled, ivec2(gl_FragCoord.xy), 0).x;
    return far_depth < 0.5 ? gl_FragCoord.z < before : gl_FragCoord.z > before;
}
#endif

#ifndef AOVS
/* Radiance that is not yet multiplied by opacity. Every fragment ends here, after all that needs its neighbors. */
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
