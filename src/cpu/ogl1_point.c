/* ogl1_point.c - see ogl1_point.h. */
#include "cpu/material_texels.h"
#include "draw/ogl1_setup.h"
#include "cpu/shading_frame.h"
#include "cpu/surface_point.h"

#include "cpu/ogl1_point.h"

/* ---- where ---- */

static vec3 view_at(vec3 P, bool is_orthographic)
{
    vec3 axis = vec3(0.0f, 0.0f, 1.0f);
    return is_orthographic ? axis : normalize_or(-P, axis);
}

ogl1_point ogl1_point_make(const shading_scene *scene, const shading_point *point)
{
    ogl1_point p = {.hit = shading_hit_make(scene, point), .setup = scene->ogl1};
    const render_geometry *g = p.hit.geometry;
    const ogl1_setup *s = p.setup;
    p.material = &s->materials[g->material_id];
    p.maps = scene->plans->items[point->hit->geometry].legacy_maps;
    p.is_front = g->primitive->mode != SCENE_TRIANGLES || surface_sees_front(g, point->hit, p.hit.direction);
    vec3 outward = load3(point->hit->normal) * (g->is_mirrored ? -1.0f : 1.0f);
    p.face = mul(s->view, normalize_or(outward, -p.hit.direction));
    p.P = phong_to_eye(s->view, s->translation, p.hit.position, 1.0f);
    p.V = view_at(p.P, scene->camera->is_orthographic);
    return p;
}

/* ---- normals ---- */

vec3 ogl1_point_normal(const ogl1_point *p, const float weight[3])
{
    const render_geometry *g = p->hit.geometry;
    if (!g->normals || (!p->material->legacy->is_smooth && g->primitive->mode == SCENE_TRIANGLES))
        return p->face;
    shading_hit h = p->hit;
    for (int i = 0; i < 3; i++)
        h.weight[i] = weight[i];
    return normalize_or(mul(p->setup->view, shading_frame_normal(&h, true)), p->face);
}

vec3 ogl1_point_mapped_normal(const shading_scene *scene, const ogl1_point *p)
{
    vec3 N = ogl1_point_normal(p, p->hit.weight);
    float texel[4];
    if (!(p->maps & 1u << LEGACY_NORMAL_MAP))
        return N;
    ogl1_point_texel(scene, p, LEGACY_NORMAL_MAP, texel);
    vec3 n = normal_from_texel(load3(texel), p->material->legacy->maps[LEGACY_NORMAL_MAP].bump_multiplier);
    ShadingFrame f = shading_frame_of_tangents(&p->hit, true);
    return normalize_or(mul(p->setup->view, f.T * n[0] + f.B * n[1] + f.N * n[2]), N);
}

/* ---- colors ---- */

PhongColor ogl1_point_color(const ogl1_point *p, const float weight[3])
{
    PhongColor c = {p->material->phong.diffuse, p->material->legacy->opacity};
    const float *colors = p->hit.geometry->primitive->colors;
    if (!colors)
        return c;
    /* Each corner's color is encoded before it is interpolated, as a program handed it to OpenGL. */
    vec3 rgb = vec3(0.0f);
    float opacity = 0.0f;
    for (int i = 0; i < 3; i++) {
        const float *corner = colors + 4 * p->hit.corner[i];
        rgb += ogl1_from_linear(p->setup, load3(corner)) * weight[i];
        opacity += corner[3] * weight[i];
    }
    c.rgb = p->setup->has_rgl_colors ? rgb : c.rgb * rgb;
    c.opacity *= opacity;
    return c;
}

/* ---- maps ---- */

/* Where the reflected view points on the picture of a sphere map, v downwards. */
static vec2 sphere_map_at(const ogl1_point *p, const float weight[3], bool is_orthographic)
{
    vec3 world = vec3(0.0f);
    for (int i = 0; i < 3; i++) {
        float corner[3];
        render_geometry_corner(p->hit.geometry, p->hit.corner[i], corner);
        world += load3(corner) * weight[i];
    }
    const ogl1_setup *s = p->setup;
    vec3 V = view_at(phong_to_eye(s->view, s->translation, world, 1.0f), is_orthographic);
    vec3 N = phong_normal(s->rules, ogl1_point_normal(p, weight), V, p->is_front);
    vec2 uv = phong_sphere_map(N, V);
    return vec2(uv[0], 1.0f - uv[1]);
}

static shading_texcoord sphere_map_coordinates(const shading_scene *scene, const ogl1_point *p)
{
    bool is_orthographic = scene->camera->is_orthographic;
    vec2 uv = sphere_map_at(p, p->hit.weight, is_orthographic);
    shading_texcoord c = {.uv = {uv[0], uv[1]}};
    float *out[2] = {c.dx, c.dy};
    for (int axis = 0; axis < 2; axis++) {
        const float *change = axis ? p->hit.dy : p->hit.dx;
        vec2 side[2];
        for (int k = 0; k < 2; k++) {
            float step = (float)k - 0.5f;
            float w1 = p->hit.weight[1] + change[0] * step;
            float w2 = p->hit.weight[2] + change[1] * step;
            const float weight[3] = {1.0f - w1 - w2, w1, w2};
            side[k] = sphere_map_at(p, weight, is_orthographic);
        }
        out[axis][0] = side[1][0] - side[0][0];
        out[axis][1] = side[1][1] - side[0][1];
    }
    return c;
}

void ogl1_point_texel(const shading_scene *scene, const ogl1_point *p, legacy_map_slot slot, float texel[4])
{
    const legacy_material *m = p->material->legacy;
    const scene_texture_ref *ref = &m->maps[slot].ref;
    for (int i = 0; i < 4; i++)
        texel[i] = 1.0f;
    if (!(p->maps & 1u << slot))
        return;
    shading_texcoord c = ogl1_map_is_spherical(m, slot) && p->hit.geometry->primitive->mode == SCENE_TRIANGLES
                             ? sphere_map_coordinates(scene, p)
                             : material_texture_coordinates(&p->hit, ref);
    texture_sample(scene->textures, ref->texture, ogl1_map_is_color(m, slot, !p->setup->is_encoded), c.uv,
                   c.dx, c.dy, texel);
}

PhongColor ogl1_point_map(const shading_scene *scene, const ogl1_point *p, legacy_map_slot slot)
{
    const legacy_map *map = &p->material->legacy->maps[slot];
    float texel[4];
    ogl1_point_texel(scene, p, slot, texel);
    PhongColor c = {load3(texel), texel[3]};
    if (p->maps & 1u << slot)
        c.rgb = map->base + c.rgb * map->gain;
    return c;
}
