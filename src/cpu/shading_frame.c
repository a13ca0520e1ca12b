/* shading_frame.c - see shading_frame.h. */
#include "cpu/shading_frame.h"

static vec3 transform(const float rows[9], vec3 v)
{
    return vec3(dot(load3(rows), v), dot(load3(rows + 3), v), dot(load3(rows + 6), v));
}

ShadingFrame shading_frame_of_tangents(const shading_hit *h, bool is_front)
{
    const render_geometry *g = h->geometry;
    vec3 tangent = vec3(0.0f);
    float handedness = 1.0f;
    for (int i = 0; i < 3; i++) {
        const float *t =
            g->tangents + 4 * (g->has_corner_tangents ? h->first_index + (size_t)i : h->corner[i]);
        tangent += load3(t) * h->weight[i];
        handedness = t[3];
    }
    return frame_from_tangent(shading_frame_normal(h, is_front), transform(g->tangent_matrix, tangent),
                              handedness * g->bitangent_sign, is_front ? 1.0f : -1.0f);
}

ShadingFrame shading_frame_of_texcoord(const shading_hit *h, bool is_front, uint32_t set)
{
    const scene_primitive *p = h->geometry->primitive;
    if (set >= p->texcoord_count || p->mode != SCENE_TRIANGLES)
        return (ShadingFrame){.T = vec3(0.0f)};
    vec3 corners[3];
    vec2 uv[3];
    for (int i = 0; i < 3; i++) {
        float world[3];
        render_geometry_corner(h->geometry, h->corner[i], world);
        corners[i] = load3(world);
        const float *at = p->texcoords[set] + 2 * h->corner[i];
        uv[i] = vec2(at[0], at[1]);
    }
    return frame_from_texcoord(shading_frame_normal(h, is_front), corners[1] - corners[0],
                               corners[2] - corners[0], uv[1] - uv[0], uv[2] - uv[0],
                               is_front ? 1.0f : -1.0f);
}
