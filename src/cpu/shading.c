/* shading.c - see shading.h. Only what the glTF formats of attributes and textures mean is here; every formula of
 * reflection is in shade/. */
#include "cpu/shading.h"

#include <stddef.h>
#include <string.h>

#include "shade/shade.h"

/* ---- interpolation ---- */

/* Corners of the triangle, weights at the hit, and how the weights change from pixel to pixel. */
typedef struct hit_frame {
    const render_geometry *geometry;
    size_t first_index;
    size_t corner[3]; /* vertex numbers */
    float weight[3];
    float dx[2], dy[2]; /* of weight[1], weight[2] */
    vec3 origin, direction;
    vec3 position; /* world, m */
} hit_frame;

static vec3 load3(const float *v)
{
    return vec3(v[0], v[1], v[2]);
}

static void store3(vec3 v, float out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = v[i];
}

/* Weights of a ray o + t d by Moeller and Trumbore 1997, with s = o - p0:
 *     w1 = A.d / C.d,  w2 = B.d / C.d,   A = e2 x s,  B = s x e1,  C = e2 x e1
 * which are ratios of linear functions of the picture position, so the derivatives are exact:
 * perspective (d changes): dw1 = (A.dd - w1 C.dd) / C.d; orthographic (o changes): dw1 = (e2 x do).d / C.d. */
static void weight_derivatives(const camera_rays *camera, vec3 p0, vec3 e1, vec3 e2, float footprint,
                               hit_frame *f)
{
    vec3 d = f->direction;
    vec3 s = f->origin - p0;
    vec3 C = cross(e2, e1);
    float Cd = dot(C, d);
    if (!(Cd < 0.0f || Cd > 0.0f))
        return;
    float scale = footprint / Cd;
    vec3 steps[2];
    float *out[2] = {f->dx, f->dy};
    if (camera->is_orthographic) {
        steps[0] = load3(camera->origin_dx);
        steps[1] = load3(camera->origin_dy);
        for (int i = 0; i < 2; i++) {
            out[i][0] = dot(cross(e2, steps[i]), d) * scale;
            out[i][1] = dot(cross(steps[i], e1), d) * scale;
        }
        return;
    }
    vec3 A = cross(e2, s);
    vec3 B = cross(s, e1);
    steps[0] = load3(camera->direction_dx);
    steps[1] = load3(camera->direction_dy);
    for (int i = 0; i < 2; i++) {
        float C_step = dot(C, steps[i]);
        out[i][0] = (dot(A, steps[i]) - f->weight[1] * C_step) * scale;
        out[i][1] = (dot(B, steps[i]) - f->weight[2] * C_step) * scale;
    }
}

static hit_frame make_frame(const shading_scene *scene, const shading_point *point)
{
    const visibility_hit *hit = point->hit;
    hit_frame f = {.geometry = &scene->geometries->items[hit->geometry]};
    float origin[3];
    float direction[3];
    camera_rays_at(scene->camera, point->x, point->y, origin, direction);
    f.origin = load3(origin);
    f.direction = load3(direction);
    const uint32_t *indices = f.geometry->primitive->indices;
    switch (f.geometry->primitive->mode) {
    case SCENE_TRIANGLES: {
        f.first_index = 3 * (size_t)hit->primitive;
        indices += f.first_index;
        for (int i = 0; i < 3; i++)
            f.corner[i] = indices[i];
        f.weight[0] = 1.0f - hit->u - hit->v;
        f.weight[1] = hit->u;
        f.weight[2] = hit->v;
        vec3 p0 = load3(f.geometry->vertices + 3 * f.corner[0]);
        vec3 e1 = load3(f.geometry->vertices + 3 * f.corner[1]) - p0;
        vec3 e2 = load3(f.geometry->vertices + 3 * f.corner[2]) - p0;
        f.position = p0 + e1 * hit->u + e2 * hit->v;
        weight_derivatives(scene->camera, p0, e1, e2, point->footprint, &f);
        break;
    }
    case SCENE_LINES:
        indices += 2 * (size_t)hit->primitive;
        f.corner[0] = indices[0];
        f.corner[1] = f.corner[2] = indices[1];
        f.weight[1] = clamp(hit->u, 0.0f, 1.0f);
        f.weight[0] = 1.0f - f.weight[1];
        f.position = f.origin + f.direction * hit->t;
        break;
    case SCENE_POINTS:
        f.corner[0] = f.corner[1] = f.corner[2] = indices[hit->primitive];
        f.weight[0] = 1.0f;
        f.position = f.origin + f.direction * hit->t;
        break;
    }
    return f;
}

static vec3 interpolate3(const hit_frame *f, const float *attribute)
{
    return load3(attribute + 3 * f->corner[0]) * f->weight[0] +
           load3(attribute + 3 * f->corner[1]) * f->weight[1] +
           load3(attribute + 3 * f->corner[2]) * f->weight[2];
}

/* COLOR_0, linear. */
static void interpolate_color(const hit_frame *f, float out[4])
{
    const float *colors = f->geometry->primitive->colors;
    for (int i = 0; i < 4; i++)
        out[i] = colors ? colors[4 * f->corner[0] + (size_t)i] * f->weight[0] +
                              colors[4 * f->corner[1] + (size_t)i] * f->weight[1] +
                              colors[4 * f->corner[2] + (size_t)i] * f->weight[2]
                        : 1.0f;
}

/* ---- textures ---- */

typedef struct texture_coordinates {
    float uv[2], dx[2], dy[2];
} texture_coordinates;

static texture_coordinates coordinates_of_set(const hit_frame *f, uint32_t set)
{
    texture_coordinates c = {0};
    if (set >= f->geometry->primitive->texcoord_count)
        return c;
    const float *uvs = f->geometry->primitive->texcoords[set];
    const float *a = uvs + 2 * f->corner[0];
    const float *b = uvs + 2 * f->corner[1];
    const float *d = uvs + 2 * f->corner[2];
    for (int i = 0; i < 2; i++) {
        float e1 = b[i] - a[i];
        float e2 = d[i] - a[i];
        c.uv[i] = a[i] + e1 * f->weight[1] + e2 * f->weight[2];
        c.dx[i] = e1 * f->dx[0] + e2 * f->dx[1];
        c.dy[i] = e1 * f->dy[0] + e2 * f->dy[1];
    }
    return c;
}

static void transform_coordinates(const float m[6], texture_coordinates *c)
{
    texture_coordinates o = *c;
    for (int i = 0; i < 2; i++) {
        const float *row = m + 3 * i;
        c->uv[i] = row[0] * o.uv[0] + row[1] * o.uv[1] + row[2];
        c->dx[i] = row[0] * o.dx[0] + row[1] * o.dx[1];
        c->dy[i] = row[0] * o.dy[0] + row[1] * o.dy[1];
    }
}

/* What a material's textures are for; their texels in this order. */
enum material_texture {
    BASE_COLOR,
    EMISSIVE,
    METALLIC_ROUGHNESS,
    NORMAL,
    OCCLUSION,
    SPECULAR,
    SPECULAR_COLOR,
    MATERIAL_TEXTURE_COUNT
};
_Static_assert((int)MATERIAL_TEXTURE_COUNT <= (int)TEXTURE_GROUP, "all textures of a material are one group");

enum { ALL_TEXTURES = (1 << MATERIAL_TEXTURE_COUNT) - 1 };

static const struct {
    size_t ref; /* offset in scene_material */
    bool is_color;
} MATERIAL_TEXTURES[MATERIAL_TEXTURE_COUNT] = {
    [BASE_COLOR] = {offsetof(scene_material, base_color_texture), true},
    [EMISSIVE] = {offsetof(scene_material, emissive_texture), true},
    [METALLIC_ROUGHNESS] = {offsetof(scene_material, metallic_roughness_texture), false},
    [NORMAL] = {offsetof(scene_material, normal_texture), false},
    [OCCLUSION] = {offsetof(scene_material, occlusion_texture), false},
    [SPECULAR] = {offsetof(scene_material, specular_texture), false},
    [SPECULAR_COLOR] = {offsetof(scene_material, specular_color_texture), true},
};

/* RGBA of each texture, white where there is none. */
typedef float material_texels[MATERIAL_TEXTURE_COUNT][4];

static const scene_texture_ref *texture_ref(const scene_material *material, int number)
{
    return (const scene_texture_ref *)(const void *)((const char *)material + MATERIAL_TEXTURES[number].ref);
}

static bool has_same_coordinates(const scene_texture_ref *a, const scene_texture_ref *b)
{
    return a->texcoord == b->texcoord && a->has_transform == b->has_transform &&
           (!a->has_transform || memcmp(a->transform, b->transform, sizeof a->transform) == 0);
}

/* Reads the textures of the material whose bits are set in wanted; those with the same coordinates together. */
static void read_textures(const shading_scene *scene, const hit_frame *f, uint32_t wanted,
                          material_texels texels)
{
    const scene_material *material = f->geometry->material;
    for (int i = 0; i < MATERIAL_TEXTURE_COUNT; i++) {
        for (int c = 0; c < 4; c++)
            texels[i][c] = 1.0f;
        if (texture_ref(material, i)->texture == SCENE_NONE)
            wanted &= ~(1u << i);
    }
    while (wanted) {
        texture_request requests[MATERIAL_TEXTURE_COUNT];
        int numbers[MATERIAL_TEXTURE_COUNT];
        uint32_t count = 0;
        const scene_texture_ref *first = texture_ref(material, __builtin_ctz(wanted));
        for (int i = 0; i < MATERIAL_TEXTURE_COUNT; i++) {
            const scene_texture_ref *ref = texture_ref(material, i);
            if (!(wanted >> i & 1) || !has_same_coordinates(first, ref))
                continue;
            wanted &= ~(1u << i);
            requests[count].texture = ref->texture;
            requests[count].as_color = MATERIAL_TEXTURES[i].is_color;
            numbers[count++] = i;
        }
        texture_coordinates c = coordinates_of_set(f, first->texcoord);
        if (first->has_transform)
            transform_coordinates(first->transform, &c);
        texture_sample_group(scene->textures, requests, count, c.uv, c.dx, c.dy);
        for (uint32_t k = 0; k < count; k++)
            memcpy(texels[numbers[k]], requests[k].texel, sizeof texels[0]);
    }
}

/* ---- normals ---- */

static vec3 transform(const float rows[9], vec3 v)
{
    return vec3(dot(load3(rows), v), dot(load3(rows + 3), v), dot(load3(rows + 6), v));
}

/* The vector that a texel of the normal texture holds, with its scale; false: nothing that is a normal (there is no
 * texture, or it could not be decoded and reads as white). glTF 2.0, 3.9.3. */
static bool normal_from_texel(const hit_frame *f, const float texel[4], vec3 *n)
{
    const scene_material *material = f->geometry->material;
    if (material->normal_texture.texture == SCENE_NONE || !f->geometry->tangents)
        return false;
    if (texel[0] >= 1.0f && texel[1] >= 1.0f && texel[2] >= 1.0f)
        return false;
    vec3 c = load3(texel) * 2.0f - 1.0f;
    *n = vec3(c[0] * material->normal_scale, c[1] * material->normal_scale, c[2]);
    return true;
}

static vec3 normalize_or(vec3 v, vec3 otherwise)
{
    float length2 = dot(v, v);
    return length2 > 1e-30f ? v * inversesqrt(length2) : otherwise;
}

/* Unit shading normal on the side that is seen. T, B and N are used as they are interpolated, not normalised, which
 * is what MikkTSpace (2008) and the tools that bake for it do. */
static vec3 shading_normal(const hit_frame *f, const float normal_texel[4], bool is_front)
{
    const render_geometry *g = f->geometry;
    float side = is_front ? 1.0f : -1.0f;
    vec3 to_eye = normalize_or(-f->direction, vec3(0.0f, 0.0f, 1.0f));
    vec3 N = transform(g->normal_matrix, interpolate3(f, g->primitive->normals)) * side;
    vec3 n;
    if (!normal_from_texel(f, normal_texel, &n))
        return normalize_or(N, to_eye);

    vec3 tangent = vec3(0.0f);
    float handedness = 1.0f;
    for (int i = 0; i < 3; i++) {
        const float *t =
            g->tangents + 4 * (g->has_corner_tangents ? f->first_index + (size_t)i : f->corner[i]);
        tangent += load3(t) * f->weight[i];
        handedness = t[3];
    }
    vec3 T = transform(g->tangent_matrix, tangent) * side;
    vec3 B = cross(N, T) * (handedness * g->bitangent_sign * side);
    return normalize_or(T * n[0] + B * n[1] + N * n[2], normalize_or(N, to_eye));
}

/* ---- surfaces ---- */

bool shading_is_visible_side(const shading_scene *scene, const visibility_hit *hit, const float direction[3])
{
    const render_geometry *g = &scene->geometries->items[hit->geometry];
    if (g->is_double_sided)
        return true;
    float facing = dot(load3(hit->normal), load3(direction));
    return g->is_mirrored ? facing > 0.0f : facing < 0.0f;
}

static bool is_front(const hit_frame *f, const visibility_hit *hit)
{
    if (f->geometry->primitive->mode != SCENE_TRIANGLES)
        return true;
    float facing = dot(load3(hit->normal), f->direction);
    return f->geometry->is_mirrored ? facing > 0.0f : facing < 0.0f;
}

/* Factor, texture and vertex color multiplied. */
static void multiply_base_color(const hit_frame *f, const float texel[4], float out[4])
{
    float color[4];
    interpolate_color(f, color);
    for (int i = 0; i < 4; i++)
        out[i] = texel[i] * (f->geometry->material->base_color[i] * color[i]);
}

static float opacity_from_alpha(const scene_material *material, float alpha)
{
    switch (material->alpha_mode) {
    case SCENE_ALPHA_MASK:
        return alpha >= material->alpha_cutoff ? 1.0f : 0.0f;
    case SCENE_ALPHA_BLEND:
        return clamp(alpha, 0.0f, 1.0f);
    case SCENE_ALPHA_OPAQUE:
        break;
    }
    return 1.0f;
}

float shading_opacity(const shading_scene *scene, const shading_point *point)
{
    const render_geometry *g = &scene->geometries->items[point->hit->geometry];
    if (!g->is_see_through)
        return 1.0f;
    hit_frame f = make_frame(scene, point);
    material_texels texels;
    float base_color[4];
    read_textures(scene, &f, 1u << BASE_COLOR, texels);
    multiply_base_color(&f, texels[BASE_COLOR], base_color);
    return opacity_from_alpha(g->material, base_color[3]);
}

static Surface make_surface(const scene_material *m, material_texels texels, vec3 N, vec3 base_color)
{
    const float *rough_metal = texels[METALLIC_ROUGHNESS];
    return surface_from_gltf(
        N, base_color, m->metallic * rough_metal[2], m->perceptual_roughness * rough_metal[1], m->ior,
        m->specular * texels[SPECULAR][3], load3(m->specular_color) * load3(texels[SPECULAR_COLOR]),
        occlusion_from_texel(texels[OCCLUSION][0], m->occlusion_strength),
        load3(m->emissive) * load3(texels[EMISSIVE]));
}

/* The textures that a hit on g reads. */
static uint32_t textures_read(const render_geometry *g)
{
    if (g->is_lit)
        return ALL_TEXTURES & ~(g->tangents ? 0u : 1u << NORMAL);
    return 1u << BASE_COLOR | (g->material->is_unlit ? 0u : 1u << EMISSIVE);
}

/* Radiance of a lit surface: emission, prefiltered environment and every light. */
static vec3 lit_radiance(const shading_scene *scene, Surface s, vec3 P, vec3 V)
{
    int energy = scene->energy == FACET_ENERGY_CONSERVING ? ENERGY_CONSERVING : ENERGY_GLTF;
    float NdotV = surface_NdotV(s, V);
    float dfg_terms[2];
    ibl_dfg(NdotV, s.perceptual_roughness, dfg_terms);
    vec2 dfg = vec2(dfg_terms[0], dfg_terms[1]);

    vec3 radiance = s.emissive;
    if (scene->light->ibl) {
        float N[3];
        float R[3];
        float specular[3];
        float irradiance_over_pi[3];
        store3(s.N, N);
        store3(normalize(reflect(-V, s.N)), R);
        light_specular(scene->light, R, s.perceptual_roughness, specular);
        light_irradiance_over_pi(scene->light, N, irradiance_over_pi);
        radiance += surface_ibl(s, NdotV, dfg, load3(specular), load3(irradiance_over_pi), energy);
    }
    for (uint32_t i = 0; i < scene->light->punctual_count; i++)
        radiance += shade_punctual(s, P, V, scene->light->punctual[i], energy, dfg);
    return radiance;
}

void shading_shade(const shading_scene *scene, const shading_point *point, shading_result *out)
{
    hit_frame f = make_frame(scene, point);
    const scene_material *material = f.geometry->material;
    material_texels texels;
    float base_color[4];
    read_textures(scene, &f, textures_read(f.geometry), texels);
    multiply_base_color(&f, texels[BASE_COLOR], base_color);
    vec3 V = normalize(-f.direction);
    vec3 N = V;
    vec3 radiance = load3(base_color);
    out->occlusion = 1.0f;
    if (f.geometry->primitive->normals)
        N = shading_normal(&f, texels[NORMAL], is_front(&f, point->hit));
    if (f.geometry->is_lit) {
        Surface s = make_surface(material, texels, N, load3(base_color));
        radiance = lit_radiance(scene, s, f.position, V);
        out->occlusion = s.occlusion;
    } else if (!material->is_unlit) {
        /* Points and lines without normals: glTF 2.0, 3.7.2.1. */
        radiance += load3(material->emissive) * load3(texels[EMISSIVE]);
    }
    store3(radiance, out->radiance);
    store3(N, out->normal);
    store3(load3(base_color), out->base_color);
    out->opacity = opacity_from_alpha(material, base_color[3]);
    texture_coordinates uv = coordinates_of_set(&f, 0);
    out->uv[0] = uv.uv[0];
    out->uv[1] = uv.uv[1];
}
