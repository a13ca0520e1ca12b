/* shading_hit.c - see shading_hit.h. */
#include <string.h>

#include "scene/material_table.h"

#include "cpu/shading_hit.h"

/* Weights of a ray o + t d by Moeller and Trumbore 1997, with s = o - p0:
 *     w1 = A.d / C.d,  w2 = B.d / C.d,   A = e2 x s,  B = s x e1,  C = e2 x e1
 * so that with changes do of the origin and dd of the direction
 *     dw1 = (A.dd - w1 C.dd + (e2 x do).d) / C.d,  dw2 = (B.dd - w2 C.dd + (do x e1).d) / C.d */
static void weight_derivatives(const shading_ray *ray, vec3 p0, vec3 e1, vec3 e2, shading_hit *h)
{
    vec3 d = h->direction;
    vec3 C = cross(e2, e1);
    float Cd = dot(C, d);
    if (!(Cd < 0.0f || Cd > 0.0f))
        return;
    float scale = ray->footprint / Cd;
    const ray_spread *spread = ray->spread;
    float *out[2] = {h->dx, h->dy};
    if (spread->turns) {
        vec3 s = load3(ray->origin) - p0;
        vec3 A = cross(e2, s);
        vec3 B = cross(s, e1);
        for (int i = 0; i < 2; i++) {
            vec3 step = load3(i ? spread->direction_dy : spread->direction_dx);
            float C_step = dot(C, step);
            out[i][0] = (dot(A, step) - h->weight[1] * C_step) * scale;
            out[i][1] = (dot(B, step) - h->weight[2] * C_step) * scale;
        }
    }
    if (spread->moves)
        for (int i = 0; i < 2; i++) {
            vec3 step = load3(i ? spread->origin_dy : spread->origin_dx);
            out[i][0] += dot(cross(e2, step), d) * scale;
            out[i][1] += dot(cross(step, e1), d) * scale;
        }
}

static vec3 corner(const render_geometry *g, size_t vertex)
{
    float p[3];
    render_geometry_corner(g, vertex, p);
    return load3(p);
}

shading_hit shading_hit_make(const shading_scene *scene, const shading_point *point)
{
    const visibility_hit *hit = point->hit;
    shading_hit h = {.geometry = &scene->geometries->items[hit->geometry]};
    vec3 origin = load3(point->ray->origin);
    h.direction = load3(point->ray->direction);
    const uint32_t *indices = h.geometry->primitive->indices;
    switch (h.geometry->primitive->mode) {
    case SCENE_TRIANGLES: {
        h.first_index = 3 * (size_t)hit->primitive;
        indices += h.first_index;
        for (int i = 0; i < 3; i++)
            h.corner[i] = indices[i];
        h.weight[0] = 1.0f - hit->u - hit->v;
        h.weight[1] = hit->u;
        h.weight[2] = hit->v;
        vec3 p0 = corner(h.geometry, h.corner[0]);
        vec3 p1 = corner(h.geometry, h.corner[1]);
        vec3 p2 = corner(h.geometry, h.corner[2]);
        vec3 e1 = p1 - p0;
        vec3 e2 = p2 - p0;
        h.position = p0 + e1 * hit->u + e2 * hit->v;
        h.farthest = max(max(abs(p0), abs(p1)), abs(p2));
        if (scene->plans->items[hit->geometry].needs_derivatives || scene->has_specular_antialiasing)
            weight_derivatives(point->ray, p0, e1, e2, &h);
        break;
    }
    case SCENE_LINES:
        indices += 2 * (size_t)hit->primitive;
        h.corner[0] = indices[0];
        h.corner[1] = h.corner[2] = indices[1];
        h.weight[1] = clamp(hit->u, 0.0f, 1.0f);
        h.weight[0] = 1.0f - h.weight[1];
        h.position = origin + h.direction * hit->t;
        break;
    case SCENE_POINTS:
        h.corner[0] = h.corner[1] = h.corner[2] = indices[hit->primitive];
        h.weight[0] = 1.0f;
        h.position = origin + h.direction * hit->t;
        break;
    }
    return h;
}

vec3 shading_hit_vec3(const shading_hit *h, const float *attribute)
{
    return load3(attribute + 3 * h->corner[0]) * h->weight[0] +
           load3(attribute + 3 * h->corner[1]) * h->weight[1] +
           load3(attribute + 3 * h->corner[2]) * h->weight[2];
}

void shading_hit_color(const shading_hit *h, float out[4])
{
    const float *colors = h->geometry->primitive->colors;
    for (int i = 0; i < 4; i++)
        out[i] = colors ? colors[4 * h->corner[0] + (size_t)i] * h->weight[0] +
                              colors[4 * h->corner[1] + (size_t)i] * h->weight[1] +
                              colors[4 * h->corner[2] + (size_t)i] * h->weight[2]
                        : 1.0f;
}

shading_texcoord shading_hit_texcoord(const shading_hit *h, uint32_t set)
{
    shading_texcoord c = {0};
    if (set >= h->geometry->primitive->texcoord_count)
        return c;
    const float *uvs = h->geometry->primitive->texcoords[set];
    const float *a = uvs + 2 * h->corner[0];
    const float *b = uvs + 2 * h->corner[1];
    const float *d = uvs + 2 * h->corner[2];
    for (int i = 0; i < 2; i++) {
        float e1 = b[i] - a[i];
        float e2 = d[i] - a[i];
        c.uv[i] = a[i] + e1 * h->weight[1] + e2 * h->weight[2];
        c.dx[i] = e1 * h->dx[0] + e2 * h->dx[1];
        c.dy[i] = e1 * h->dy[0] + e2 * h->dy[1];
    }
    return c;
}

/* ---- normals and tangents ---- */

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

/* ---- textures: those with the same coordinates are looked up together ---- */

static bool has_same_coordinates(const scene_texture_ref *a, const scene_texture_ref *b)
{
    return a->texcoord == b->texcoord && a->has_transform == b->has_transform &&
           (!a->has_transform || memcmp(a->transform, b->transform, sizeof a->transform) == 0);
}

shading_texcoord material_texture_coordinates(const shading_hit *h, const scene_texture_ref *ref)
{
    shading_texcoord o = shading_hit_texcoord(h, ref->texcoord);
    if (!ref->has_transform)
        return o;
    shading_texcoord c;
    vec2 uv = texcoord_transform(vec2(o.uv[0], o.uv[1]), load3(ref->transform), load3(ref->transform + 3));
    for (int i = 0; i < 2; i++) {
        const float *row = ref->transform + 3 * i;
        c.uv[i] = uv[i];
        c.dx[i] = row[0] * o.dx[0] + row[1] * o.dx[1];
        c.dy[i] = row[0] * o.dy[0] + row[1] * o.dy[1];
    }
    return c;
}

ShadingFrame material_texture_frame(ShadingFrame f, const scene_texture_ref *ref)
{
    return ref->has_transform ? frame_transformed(f, load3(ref->transform), load3(ref->transform + 3)) : f;
}

void material_texels_read(const shading_scene *scene, const shading_hit *h, uint32_t wanted, int slot_count,
                          material_texels texels)
{
    const scene_texture_ref *refs = h->geometry->material->textures;
    for (int i = 0; i < slot_count; i++)
        for (int c = 0; c < 4; c++)
            texels[i][c] = 1.0f;
    while (wanted) {
        texture_request requests[TEXTURE_GROUP];
        int slots[TEXTURE_GROUP];
        uint32_t count = 0;
        const scene_texture_ref *first = &refs[__builtin_ctz(wanted)];
        for (uint32_t left = wanted; left && count < TEXTURE_GROUP; left &= left - 1) {
            int slot = __builtin_ctz(left);
            if (!has_same_coordinates(first, &refs[slot]))
                continue;
            wanted &= ~(1u << slot);
            requests[count].texture = refs[slot].texture;
            requests[count].as_color = material_textures[slot].is_color;
            slots[count++] = slot;
        }
        shading_texcoord c = material_texture_coordinates(h, first);
        texture_sample_group(scene->textures, requests, count, c.uv, c.dx, c.dy);
        for (uint32_t k = 0; k < count; k++)
            memcpy(texels[slots[k]], requests[k].texel, sizeof texels[0]);
    }
}

void material_texel_beside(const shading_scene *scene, const shading_hit *h, scene_texture_slot slot,
                           int axis, float step, float texel[4])
{
    const scene_texture_ref *ref = &h->geometry->material->textures[slot];
    shading_texcoord c = material_texture_coordinates(h, ref);
    for (int i = 0; i < 2; i++)
        c.uv[i] += (axis ? c.dy[i] : c.dx[i]) * step;
    texture_sample(scene->textures, ref->texture, material_textures[slot].is_color, c.uv, c.dx, c.dy, texel);
}
