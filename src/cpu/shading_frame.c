/* shading_frame.c - see shading_frame.h. */
#include "cpu/shading_frame.h"

static vec3 transform(const float rows[9], vec3 v)
{
    return vec3(dot(load3(rows), v), dot(load3(rows + 3), v), dot(load3(rows + 6), v));
}

shading_frame shading_frame_of_tangents(const shading_hit *h, bool is_front)
{
    const render_geometry *g = h->geometry;
    float side = is_front ? 1.0f : -1.0f;
    vec3 tangent = vec3(0.0f);
    float handedness = 1.0f;
    for (int i = 0; i < 3; i++) {
        const float *t =
            g->tangents + 4 * (g->has_corner_tangents ? h->first_index + (size_t)i : h->corner[i]);
        tangent += load3(t) * h->weight[i];
        handedness = t[3];
    }
    shading_frame f;
    f.N = shading_frame_normal(h, is_front);
    f.T = transform(g->tangent_matrix, tangent) * side;
    f.B = cross(f.N, f.T) * (handedness * g->bitangent_sign * side);
    return f;
}

/* dP/du of P(u, v) = p0 + e1 s + e2 t from the changes of (u, v) along the edges. B points to where v falls, which is
 * up in a picture (glTF 2.0, 3.9.3: green is +Y). */
bool shading_frame_of_texcoord(const shading_hit *h, bool is_front, uint32_t set, shading_frame *frame)
{
    const scene_primitive *p = h->geometry->primitive;
    if (set >= p->texcoord_count || p->mode != SCENE_TRIANGLES)
        return false;
    vec3 corners[3];
    const float *uv[3];
    for (int i = 0; i < 3; i++) {
        float world[3];
        render_geometry_corner(h->geometry, h->corner[i], world);
        corners[i] = load3(world);
        uv[i] = p->texcoords[set] + 2 * h->corner[i];
    }
    float du1 = uv[1][0] - uv[0][0];
    float dv1 = uv[1][1] - uv[0][1];
    float du2 = uv[2][0] - uv[0][0];
    float dv2 = uv[2][1] - uv[0][1];
    float determinant = du1 * dv2 - du2 * dv1;
    if (!(determinant < 0.0f || determinant > 0.0f))
        return false;
    float sign = determinant < 0.0f ? -1.0f : 1.0f;
    vec3 e1 = corners[1] - corners[0];
    vec3 e2 = corners[2] - corners[0];
    vec3 N = shading_frame_normal(h, is_front);
    vec3 T = (e1 * dv2 - e2 * dv1) * sign;
    vec3 B = (e1 * du2 - e2 * du1) * sign;
    T -= N * (dot(N, T) / max(dot(N, N), 1e-30f));
    float T2 = dot(T, T);
    if (!(T2 > 0.0f))
        return false;
    float side = is_front ? 1.0f : -1.0f;
    frame->N = N;
    frame->T = T * (inversesqrt(T2) * side);
    frame->B = cross(N, frame->T) * (dot(cross(N, frame->T), B) < 0.0f ? -side : side);
    return true;
}

bool shading_frame_decode(const float texel[4], float scale, vec3 *n)
{
    if (texel[0] >= 1.0f && texel[1] >= 1.0f && texel[2] >= 1.0f)
        return false;
    vec3 c = load3(texel) * 2.0f - 1.0f;
    *n = vec3(c[0] * scale, c[1] * scale, c[2]);
    return true;
}
