/* ogl1_shade.c - see ogl1_shade.h. The host of shade/compose/ogl1_*.h. */
#include "draw/ogl1_setup.h"
#include "cpu/ogl1_shade.h"
#include "cpu/surface_point.h"

_Static_assert(PHONG_RGB == (int)LEGACY_RGB && PHONG_RGBA == (int)LEGACY_RGBA &&
                   PHONG_ALPHA == (int)LEGACY_ALPHA && PHONG_LUMINANCE == (int)LEGACY_LUMINANCE &&
                   PHONG_LUMINANCE_ALPHA == (int)LEGACY_LUMINANCE_ALPHA &&
                   PHONG_MODULATE == (int)LEGACY_MODULATE && PHONG_REPLACE == (int)LEGACY_REPLACE &&
                   PHONG_DECAL == (int)LEGACY_DECAL && PHONG_BLEND == (int)LEGACY_BLEND &&
                   PHONG_ADD == (int)LEGACY_ADD,
               "the shader library numbers texture types and modes as legacy materials do");

/* ---- a point in eye space, with its legacy material ---- */

/* The primitive that was hit. */
typedef struct ogl1_hit {
    shading_hit at;
    const shading_scene *scene;
    const ogl1_setup *setup;
    const ogl1_material *material;
    const legacy_material *legacy; /* the material's */
    vec3 face;                     /* unit normal of the triangle on its front, eye space */
    uint32_t maps;                 /* bits of legacy_map_slot */
    bool is_front; /* the side with counter-clockwise vertices; lines and points have no other */
} ogl1_hit;

/* A point of it: where it was hit, or a corner. */
typedef struct ogl1_point {
    vec3 P, V;       /* eye space: m; unit, to the eye */
    float weight[3]; /* of the corners */
    vec3 position;   /* world, m */
    const ogl1_hit *hit;
} ogl1_point;

typedef const ogl1_point *Ogl1Host;

static ogl1_hit hit_make(const shading_scene *scene, const shading_point *point)
{
    ogl1_hit h = {.at = shading_hit_make(scene, point), .scene = scene, .setup = scene->ogl1};
    const render_geometry *g = h.at.geometry;
    h.material = &h.setup->materials[g->material_id];
    h.legacy = h.material->legacy;
    h.maps = scene->plans->items[point->hit->geometry].legacy_maps;
    h.is_front = g->primitive->mode != SCENE_TRIANGLES || surface_sees_front(g, point->hit, h.at.direction);
    vec3 outward = load3(point->hit->normal) * (g->is_mirrored ? -1.0f : 1.0f);
    h.face = mul(h.setup->view, normalize_or(outward, -h.at.direction));
    return h;
}

static ogl1_point point_at(const ogl1_hit *hit, const float weight[3], vec3 position)
{
    vec3 axis = vec3(0.0f, 0.0f, 1.0f);
    ogl1_point p = {.weight = {weight[0], weight[1], weight[2]}, .position = position, .hit = hit};
    p.P = phong_to_eye(hit->setup->view, hit->setup->translation, position, 1.0f);
    p.V = hit->scene->camera->is_orthographic ? axis : normalize_or(-p.P, axis);
    return p;
}

static ogl1_point point_of_hit(const ogl1_hit *hit)
{
    return point_at(hit, hit->at.weight, hit->at.position);
}

static vec3 host_P(Ogl1Host host)
{
    return host->P;
}

static vec3 host_V(Ogl1Host host)
{
    return host->V;
}

static bool host_is_front(Ogl1Host host)
{
    return host->hit->is_front;
}

static PhongFrame host_frame(Ogl1Host host)
{
    return host->hit->setup->frame;
}

static PhongSurface host_surface(Ogl1Host host)
{
    return host->hit->material->surface;
}

static vec3 corner_position(const shading_hit *hit, int corner)
{
    float position[3];
    render_geometry_corner(hit->geometry, hit->corner[corner], position);
    return load3(position);
}

/* ---- normals and colors of vertices ---- */

/* Of the vertices, or of the face where the material is not smooth. */
static vec3 host_normal(Ogl1Host host)
{
    const render_geometry *g = host->hit->at.geometry;
    if (!g->normals || (!host->hit->legacy->is_smooth && g->primitive->mode == SCENE_TRIANGLES))
        return host->hit->face;
    shading_hit h = host->hit->at;
    for (int i = 0; i < 3; i++)
        h.weight[i] = host->weight[i];
    return normalize_or(mul(host->hit->setup->view, shading_frame_normal(&h, true)), host->hit->face);
}

static bool host_has_vertex_colors(Ogl1Host host)
{
    return host->hit->at.geometry->primitive->colors != NULL;
}

/* Each corner's color is encoded before it is interpolated, as programs passed it to OpenGL. A flat surface
 * has that of its last corner. */
static PhongColor host_vertex_color(Ogl1Host host)
{
    static const float last[3] = {0.0f, 0.0f, 1.0f};
    bool is_flat = host->hit->setup->frame.rules.is_lit_at_vertices && !host->hit->legacy->is_smooth;
    const float *weight = is_flat ? last : host->weight;
    PhongColor c = {vec3(0.0f), 0.0f};
    for (int i = 0; i < 3; i++) {
        const float *corner = host->hit->at.geometry->primitive->colors + 4 * host->hit->at.corner[i];
        c.rgb += phong_from_linear(host_frame(host), load3(corner)) * weight[i];
        c.opacity += corner[3] * weight[i];
    }
    return c;
}

/* ---- light ---- */

/* Legacy lights; if there are none, punctual ones. */
typedef struct Ogl1Cursor {
    light_cursor rest;
    uint32_t light;
    bool has_light;
} Ogl1Cursor;

static Ogl1Cursor host_next_ogl1_light(Ogl1Host host, Ogl1Cursor c)
{
    if (host->hit->setup->light_count)
        c.has_light = ++c.light < host->hit->setup->light_count;
    else
        c.has_light = light_cursor_next(&c.rest, &c.light);
    return c;
}

static Ogl1Cursor host_first_ogl1_light(Ogl1Host host)
{
    Ogl1Cursor c = {.has_light = true};
    if (host->hit->setup->light_count)
        return c;
    float point[3];
    store3(host->position, point);
    c.rest = light_grid_at(&host->hit->scene->light->grid, point);
    return host_next_ogl1_light(host, c);
}

static PhongLight host_ogl1_light(Ogl1Host host, Ogl1Cursor c)
{
    if (host->hit->setup->light_count)
        return host->hit->setup->lights[c.light];
    LightSample light = light_illuminate(host->hit->scene->light->punctual[c.light], host->position);
    return phong_light_punctual(host->hit->setup->frame, light, mul(host->hit->setup->view, light.L));
}

static bool host_separates_highlight(Ogl1Host host)
{
    return host->hit->setup->frame.rules.separates_highlight &&
           legacy_has_map(host->hit->legacy, LEGACY_DIFFUSE_MAP);
}

#include "shade/compose/ogl1_light.h"

static bool host_is_lit(Ogl1Host host)
{
    return host->hit->at.geometry->is_lit;
}

static bool host_is_lit_at_vertices(Ogl1Host host)
{
    return host->hit->setup->frame.rules.is_lit_at_vertices;
}

static PhongLit light_of_corner(Ogl1Host host, int corner)
{
    float weight[3] = {0.0f, 0.0f, 0.0f};
    weight[corner] = 1.0f;
    ogl1_point p = point_at(host->hit, weight, corner_position(&host->hit->at, corner));
    return ogl1_light_at_corner(&p);
}

/* Gouraud 1971; flat surfaces have the color of the last corner (OpenGL 2.1, 2.14.7). */
static PhongLit host_light_of_vertices(Ogl1Host host)
{
    if (!host->hit->legacy->is_smooth)
        return light_of_corner(host, 2);
    PhongLit sum = {vec3(0.0f), vec3(0.0f)};
    for (int i = 0; i < 3; i++) {
        PhongLit lit = light_of_corner(host, i);
        sum.color += lit.color * host->weight[i];
        sum.highlight += lit.highlight * host->weight[i];
    }
    return sum;
}

/* ---- maps ---- */

/* Texture coordinates of the reflected view in a sphere map, v downwards. */
static vec2 sphere_map_at(Ogl1Host host, const float weight[3])
{
    vec3 position = vec3(0.0f);
    for (int i = 0; i < 3; i++)
        position += corner_position(&host->hit->at, i) * weight[i];
    ogl1_point p = point_at(host->hit, weight, position);
    vec2 uv = phong_sphere_map(
        phong_normal(host->hit->setup->frame.rules, host_normal(&p), p.V, host->hit->is_front), p.V);
    return vec2(uv[0], 1.0f - uv[1]);
}

static shading_texcoord sphere_map_coordinates(Ogl1Host host)
{
    const shading_hit *hit = &host->hit->at;
    vec2 uv = sphere_map_at(host, hit->weight);
    shading_texcoord c = {.uv = {uv[0], uv[1]}};
    float *out[2] = {c.dx, c.dy};
    for (int axis = 0; axis < 2; axis++) {
        const float *change = axis ? hit->dy : hit->dx;
        vec2 side[2];
        for (int k = 0; k < 2; k++) {
            float step = (float)k - 0.5f;
            float w1 = hit->weight[1] + change[0] * step;
            float w2 = hit->weight[2] + change[1] * step;
            const float weight[3] = {1.0f - w1 - w2, w1, w2};
            side[k] = sphere_map_at(host, weight);
        }
        out[axis][0] = side[1][0] - side[0][0];
        out[axis][1] = side[1][1] - side[0][1];
    }
    return c;
}

/* Base and gain not yet applied. */
static void map_texel(Ogl1Host host, legacy_map_slot slot, float texel[4])
{
    const scene_texture_ref *ref = &host->hit->legacy->maps[slot].ref;
    bool is_spherical = ogl1_map_is_spherical(host->hit->legacy, slot) &&
                        host->hit->at.geometry->primitive->mode == SCENE_TRIANGLES;
    shading_texcoord c =
        is_spherical ? sphere_map_coordinates(host) : material_texture_coordinates(&host->hit->at, ref);
    texture_sample(host->hit->scene->textures, ref->texture,
                   ogl1_map_is_color(host->hit->legacy, slot, !host->hit->setup->frame.is_encoded), c.uv,
                   c.dx, c.dy, texel);
}

static bool host_has_map(Ogl1Host host, int map)
{
    return host->hit->maps >> ogl1_map_slots[map] & 1u;
}

static PhongColor host_map_color(Ogl1Host host, int map)
{
    const legacy_map *m = &host->hit->legacy->maps[ogl1_map_slots[map]];
    float texel[4];
    map_texel(host, ogl1_map_slots[map], texel);
    return (PhongColor){m->base + load3(texel) * m->gain, texel[3]};
}

static float host_map_scalar(Ogl1Host host, int map)
{
    float texel[4];
    map_texel(host, ogl1_map_slots[map], texel);
    return ogl1_map_scalar(&host->hit->legacy->maps[ogl1_map_slots[map]], texel);
}

static vec3 host_mapped_normal(Ogl1Host host)
{
    vec3 N = host_normal(host);
    if (!host_has_map(host, PHONG_NORMAL_MAP))
        return N;
    float texel[4];
    map_texel(host, LEGACY_NORMAL_MAP, texel);
    const legacy_map *map = &host->hit->legacy->maps[LEGACY_NORMAL_MAP];
    vec3 n = normal_from_texel(load3(texel), map->bump_multiplier);
    ShadingFrame f = material_texture_frame(shading_frame_of_tangents(&host->hit->at, true), &map->ref);
    return normalize_or(mul(host->hit->setup->view, f.T * n[0] + f.B * n[1] + f.N * n[2]), N);
}

static bool host_is_see_through(Ogl1Host host)
{
    return host->hit->at.geometry->is_see_through;
}

#include "shade/compose/ogl1_fragment.h"

/* ---- the functions of ogl1_shade.h ---- */

float ogl1_opacity(const shading_scene *scene, const shading_point *point)
{
    if (!scene->geometries->items[point->hit->geometry].is_see_through)
        return 1.0f;
    ogl1_hit hit = hit_make(scene, point);
    const ogl1_point p = point_of_hit(&hit);
    Ogl1Host host = &p;
    return ogl1_coverage(host, ogl1_with_texture(host, ogl1_base_color(host)).opacity);
}

void ogl1_shade(const shading_scene *scene, const shading_point *point, shading_result *out)
{
    ogl1_hit hit = hit_make(scene, point);
    const ogl1_point p = point_of_hit(&hit);
    PhongColor c = ogl1_fragment(&p);
    store3(c.rgb, out->radiance);
    out->opacity = c.opacity;
    out->behind = 0.0f;
    out->rays = 0;
}

/* Of a vector in eye space: view is a rotation. */
static vec3 to_world(const ogl1_setup *s, vec3 v)
{
    return mul(transpose(s->view), v);
}

void ogl1_describe(const shading_scene *scene, const shading_point *point, shading_description *out)
{
    ogl1_hit hit = hit_make(scene, point);
    const ogl1_point p = point_of_hit(&hit);
    Ogl1Host host = &p;
    vec3 N = hit.at.geometry->normals ? host_mapped_normal(host) : host->V;
    vec3 color = ogl1_with_texture(host, ogl1_base_color(host)).rgb;
    store3(to_world(hit.setup, hit.is_front ? N : -N), out->normal);
    store3(phong_to_linear(host->hit->setup->frame, color), out->base_color);
    out->occlusion = 1.0f;
    shading_texcoord uv = shading_hit_texcoord(&hit.at, 0);
    out->uv[0] = uv.uv[0];
    out->uv[1] = uv.uv[1];
}

void ogl1_develop(const shading_scene *scene, float rgba[4])
{
    if (!scene->ogl1->frame.is_encoded || !(rgba[3] > 0.0f))
        return;
    store3(ogl1_displayed(scene->ogl1, load3(rgba) / rgba[3]) * rgba[3], rgba);
}
