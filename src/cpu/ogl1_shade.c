/* ogl1_shade.c - see ogl1_shade.h. The order of OpenGL: light, texture, the highlight where it is
 * separate, fog, clamp. Every formula is in shade/phong.h. */
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

/* ---- a hit in eye space, with its legacy material and maps ---- */

typedef struct ogl1_point {
    shading_hit hit;
    const ogl1_setup *setup;
    const ogl1_material *material;
    uint32_t maps; /* bits of legacy_map_slot */
    bool is_front; /* the side with counter-clockwise vertices; lines and points have no other */
    vec3 face;     /* unit normal of the triangle on its front, eye space */
    vec3 P, V;     /* eye space: m; unit, to where the ray came from */
} ogl1_point;

static vec3 view_at(vec3 P, bool is_orthographic)
{
    vec3 axis = vec3(0.0f, 0.0f, 1.0f);
    return is_orthographic ? axis : normalize_or(-P, axis);
}

static ogl1_point ogl1_point_make(const shading_scene *scene, const shading_point *point)
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

/* The unit normal as the mesh has it (on its front), eye space: of the vertices, or of the face where the
 * material is not smooth. weight: of the corners. */
static vec3 ogl1_point_normal(const ogl1_point *p, const float weight[3])
{
    const render_geometry *g = p->hit.geometry;
    if (!g->normals || (!p->material->legacy->is_smooth && g->primitive->mode == SCENE_TRIANGLES))
        return p->face;
    shading_hit h = p->hit;
    for (int i = 0; i < 3; i++)
        h.weight[i] = weight[i];
    return normalize_or(mul(p->setup->view, shading_frame_normal(&h, true)), p->face);
}

/* ---- colors ---- */

/* Diffuse color and opacity before any map: the material's with the vertices', in the values that lighting
 * uses. */
static PhongColor ogl1_point_color(const ogl1_point *p, const float weight[3])
{
    PhongColor c = {p->material->phong.diffuse, p->material->legacy->opacity};
    const float *colors = p->hit.geometry->primitive->colors;
    if (!colors)
        return c;
    /* Each corner's color is encoded before it is interpolated, as programs passed it to OpenGL. */
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

/* Texture coordinates of the reflected view in a sphere map, v downwards. */
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

/* Texel of a map, base and gain not yet applied; white where it is not read. */
static void ogl1_point_texel(const shading_scene *scene, const ogl1_point *p, legacy_map_slot slot,
                             float texel[4])
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

/* The texel of a map of colors with its base and gain. */
static PhongColor ogl1_point_map(const shading_scene *scene, const ogl1_point *p, legacy_map_slot slot)
{
    const legacy_map *map = &p->material->legacy->maps[slot];
    float texel[4];
    ogl1_point_texel(scene, p, slot, texel);
    PhongColor c = {load3(texel), texel[3]};
    if (p->maps & 1u << slot)
        c.rgb = map->base + c.rgb * map->gain;
    return c;
}

/* The same at the hit, bent by the normal map. */
static vec3 ogl1_point_mapped_normal(const shading_scene *scene, const ogl1_point *p)
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

/* ---- light at a point ---- */

/* A punctual light of glTF as a legacy light for P only: legacy light 1 is the irradiance pi. */
static PhongLight punctual_at(const ogl1_setup *s, Light light, vec3 P_world)
{
    LightSample l = light_illuminate(light, P_world);
    vec3 color = ogl1_from_linear(s, l.E * INV_PI);
    return phong_light_directional(mul(s->view, l.L), vec3(0.0f), color, color);
}

/* P, N, V in eye space; N as it is lit. */
static PhongLit light_at(const shading_scene *scene, const PhongMaterial *m, vec3 P_world, vec3 P, vec3 N,
                         vec3 V)
{
    const ogl1_setup *s = scene->ogl1;
    PhongLit lit = phong_unlit_part(s->rules, *m);
    for (uint32_t i = 0; i < s->light_count; i++)
        lit = phong_add(lit, phong_light_part(s->rules, *m, s->lights[i], P, N, V));
    if (s->light_count)
        return lit;
    float point[3];
    store3(P_world, point);
    light_cursor lights = light_grid_at(&scene->light->grid, point);
    for (uint32_t i; light_cursor_next(&lights, &i);) {
        PhongLight l = punctual_at(s, scene->light->punctual[i], P_world);
        lit = phong_add(lit, phong_light_part(s->rules, *m, l, P, N, V));
    }
    return lit;
}

/* ---- light of a fragment ---- */

static PhongLit with_highlight(PhongLit lit)
{
    lit.color += lit.highlight;
    lit.highlight = vec3(0.0f);
    return lit;
}

/* Applies the maps of the lighting terms to their constants. */
static PhongMaterial mapped_material(const shading_scene *scene, const ogl1_point *p, vec3 diffuse)
{
    PhongMaterial m = p->material->phong;
    m.diffuse = diffuse;
    if (p->maps & 1u << LEGACY_AMBIENT_MAP)
        m.ambient *= ogl1_point_map(scene, p, LEGACY_AMBIENT_MAP).rgb;
    if (p->maps & 1u << LEGACY_SPECULAR_MAP)
        m.specular *= ogl1_point_map(scene, p, LEGACY_SPECULAR_MAP).rgb;
    if (p->maps & 1u << LEGACY_EMISSION_MAP)
        m.emission *= ogl1_point_map(scene, p, LEGACY_EMISSION_MAP).rgb;
    if (p->maps & 1u << LEGACY_SHININESS_MAP) {
        float texel[4];
        ogl1_point_texel(scene, p, LEGACY_SHININESS_MAP, texel);
        float value = ogl1_map_scalar(&p->material->legacy->maps[LEGACY_SHININESS_MAP], texel);
        m.shininess = max(m.shininess * value, 0.0f);
    }
    return m;
}

static PhongLit light_fragment(const shading_scene *scene, const ogl1_point *p, vec3 diffuse)
{
    PhongMaterial m = mapped_material(scene, p, diffuse);
    vec3 N = phong_normal(p->setup->rules, ogl1_point_mapped_normal(scene, p), p->V, p->is_front);
    return with_highlight(light_at(scene, &m, p->hit.position, p->P, N, p->V));
}

/* One corner of the triangle, clamped to the range of a color register for interpolation. */
static PhongLit light_corner(const shading_scene *scene, const ogl1_point *p, int corner, bool is_separate)
{
    const ogl1_setup *s = p->setup;
    float weight[3] = {0.0f, 0.0f, 0.0f};
    float position[3];
    weight[corner] = 1.0f;
    render_geometry_corner(p->hit.geometry, p->hit.corner[corner], position);
    vec3 P = phong_to_eye(s->view, s->translation, load3(position), 1.0f);
    vec3 V = scene->camera->is_orthographic ? vec3(0.0f, 0.0f, 1.0f) : normalize(-P);
    vec3 N = phong_normal(s->rules, ogl1_point_normal(p, weight), V, p->is_front);
    PhongMaterial m = p->material->phong;
    m.diffuse = ogl1_point_color(p, weight).rgb;
    PhongLit lit = light_at(scene, &m, load3(position), P, N, V);
    if (!is_separate)
        lit = with_highlight(lit);
    if (s->is_encoded) {
        lit.color = clamp(lit.color, 0.0f, 1.0f);
        lit.highlight = clamp(lit.highlight, 0.0f, 1.0f);
    }
    return lit;
}

/* Gouraud 1971; flat surfaces have the color of the last corner (OpenGL 2.1, 2.14.7). */
static PhongLit light_triangle(const shading_scene *scene, const ogl1_point *p)
{
    bool is_separate =
        p->setup->rules.separates_highlight && legacy_has_map(p->material->legacy, LEGACY_DIFFUSE_MAP);
    if (!p->material->legacy->is_smooth)
        return light_corner(scene, p, 2, is_separate);
    PhongLit sum = {vec3(0.0f), vec3(0.0f)};
    for (int i = 0; i < 3; i++) {
        PhongLit lit = light_corner(scene, p, i, is_separate);
        sum.color += lit.color * p->hit.weight[i];
        sum.highlight += lit.highlight * p->hit.weight[i];
    }
    return sum;
}

/* ---- color and opacity ---- */

static PhongColor with_texture(const shading_scene *scene, const ogl1_point *p, PhongColor c)
{
    const legacy_material *m = p->material->legacy;
    if (!(p->maps & 1u << LEGACY_DIFFUSE_MAP))
        return c;
    return phong_texture((int)m->texture_type, (int)m->texture_mode, c,
                         ogl1_point_map(scene, p, LEGACY_DIFFUSE_MAP));
}

/* Diffuse color and opacity with vertex colors and the opacity map, without the diffuse map. */
static PhongColor base_color(const shading_scene *scene, const ogl1_point *p)
{
    static const float last[3] = {0.0f, 0.0f, 1.0f};
    const legacy_material *m = p->material->legacy;
    bool is_flat = p->setup->rules.is_lit_at_vertices && !m->is_smooth;
    PhongColor c = ogl1_point_color(p, is_flat ? last : p->hit.weight);
    if (m->is_halo)
        c.opacity = phong_halo(c.opacity, fabsf(dot(ogl1_point_normal(p, p->hit.weight), p->V)));
    if (p->maps & 1u << LEGACY_OPACITY_MAP) {
        float texel[4];
        ogl1_point_texel(scene, p, LEGACY_OPACITY_MAP, texel);
        c.opacity *= ogl1_map_scalar(&m->maps[LEGACY_OPACITY_MAP], texel);
    }
    return c;
}

/* The lit fragment before fog. */
static PhongColor lit_color(const shading_scene *scene, const ogl1_point *p)
{
    PhongColor base = base_color(scene, p);
    bool is_over = p->material->has_texture_over_light;
    PhongColor c = is_over ? base : with_texture(scene, p, base);
    PhongLit lit = {c.rgb, vec3(0.0f)};
    if (p->hit.geometry->is_lit)
        lit = p->setup->rules.is_lit_at_vertices ? light_triangle(scene, p) : light_fragment(scene, p, c.rgb);
    c.rgb = lit.color;
    if (is_over)
        c = with_texture(scene, p, c);
    c.rgb += lit.highlight;
    return c;
}

float ogl1_opacity(const shading_scene *scene, const shading_point *point)
{
    if (!scene->geometries->items[point->hit->geometry].is_see_through)
        return 1.0f;
    ogl1_point p = ogl1_point_make(scene, point);
    return clamp(with_texture(scene, &p, base_color(scene, &p)).opacity, 0.0f, 1.0f);
}

void ogl1_shade(const shading_scene *scene, const shading_point *point, shading_result *out)
{
    ogl1_point p = ogl1_point_make(scene, point);
    const ogl1_setup *s = p.setup;
    PhongColor c = lit_color(scene, &p);
    if (s->is_encoded && s->rules.is_lit_at_vertices)
        c.rgb = clamp(c.rgb, 0.0f, 1.0f); /* the color sum, before fog */
    if (p.material->legacy->has_fog)
        c.rgb = phong_fogged(s->rules, s->fog, c.rgb, -p.P[2]);
    if (s->is_encoded)
        c.rgb = clamp(c.rgb, 0.0f, 1.0f);
    store3(c.rgb, out->radiance);
    out->opacity = p.hit.geometry->is_see_through ? clamp(c.opacity, 0.0f, 1.0f) : 1.0f;
    out->rays = 0;
}

/* ---- without light ---- */

/* Of a vector in eye space: view is a rotation. */
static vec3 to_world(const ogl1_setup *s, vec3 v)
{
    return mul(transpose(s->view), v);
}

void ogl1_describe(const shading_scene *scene, const shading_point *point, shading_description *out)
{
    ogl1_point p = ogl1_point_make(scene, point);
    vec3 N = p.hit.geometry->normals ? ogl1_point_mapped_normal(scene, &p) : p.V;
    store3(to_world(p.setup, p.is_front ? N : -N), out->normal);
    store3(ogl1_to_linear(p.setup, with_texture(scene, &p, base_color(scene, &p)).rgb), out->base_color);
    out->occlusion = 1.0f;
    shading_texcoord uv = shading_hit_texcoord(&p.hit, 0);
    out->uv[0] = uv.uv[0];
    out->uv[1] = uv.uv[1];
}

void ogl1_develop(const shading_scene *scene, float rgba[4])
{
    if (!scene->ogl1->is_encoded || !(rgba[3] > 0.0f))
        return;
    store3(ogl1_displayed(scene->ogl1, load3(rgba) / rgba[3]) * rgba[3], rgba);
}
