/* surface_point.c - see surface_point.h. Only what the glTF formats of materials mean is here; every formula of
 * reflection is in shade/. */
#include "cpu/material_texels.h"
#include "cpu/shading_frame.h"
#include "cpu/surface_point.h"

/* ---- color and opacity ---- */

static void multiply_base_color(const shading_hit *h, const float texel[4], float out[4])
{
    float color[4];
    shading_hit_color(h, color);
    for (int i = 0; i < 4; i++)
        out[i] = texel[i] * (h->geometry->material->base_color[i] * color[i]);
}

void surface_base_color(const shading_scene *scene, const shading_hit *h, const material_plan *plan,
                        float out[4])
{
    material_texels texels;
    material_texels_read(scene, h, plan->textures & 1u << SCENE_BASE_COLOR_TEXTURE, 1, texels);
    multiply_base_color(h, texels[SCENE_BASE_COLOR_TEXTURE], out);
}

float surface_opacity(const scene_material *material, float alpha)
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

/* ---- normals ---- */

/* Unit shading normal on the side that is seen. */
static vec3 shading_normal(const shading_hit *h, const material_plan *plan, const float normal_texel[4],
                           bool is_front)
{
    vec3 to_eye = normalize_or(-h->direction, vec3(0.0f, 0.0f, 1.0f));
    vec3 n;
    if (!(plan->textures & 1u << SCENE_NORMAL_TEXTURE) ||
        !shading_frame_decode(normal_texel, h->geometry->material->normal_scale, &n))
        return normalize_or(shading_frame_normal(h, is_front), to_eye);
    shading_frame f = shading_frame_of_tangents(h, is_front);
    return normalize_or(f.T * n[0] + f.B * n[1] + f.N * n[2], normalize_or(f.N, to_eye));
}

/* The normal `step` footprints along their x (axis 0) or y from the hit, on the plane of the triangle. */
static vec3 normal_beside(const shading_scene *scene, const surface_point *s, int axis, float step)
{
    shading_hit h = s->hit;
    const float *change = axis ? h.dy : h.dx;
    float texel[4] = {1.0f, 1.0f, 1.0f, 1.0f};
    if (s->plan->textures & 1u << SCENE_NORMAL_TEXTURE)
        material_texel_beside(scene, &s->hit, SCENE_NORMAL_TEXTURE, axis, step, texel);
    h.weight[1] += change[0] * step;
    h.weight[2] += change[1] * step;
    h.weight[0] = 1.0f - h.weight[1] - h.weight[2];
    return shading_normal(&h, s->plan, texel, s->is_front);
}

/* How the shading normal changes from one side of the footprint to the other. */
static vec3 normal_change(const shading_scene *scene, const surface_point *s, int axis)
{
    return normal_beside(scene, s, axis, 0.5f) - normal_beside(scene, s, axis, -0.5f);
}

/* ---- the surface ---- */

static Surface make_surface(const scene_material *m, material_texels texels, vec3 N, vec3 base_color)
{
    float occlusion = occlusion_from_texel(texels[SCENE_OCCLUSION_TEXTURE][0], m->occlusion_strength);
    vec3 emissive = load3(m->emissive) * m->emissive_strength * load3(texels[SCENE_EMISSIVE_TEXTURE]);
    if (m->extensions & SCENE_SPECULAR_GLOSSINESS) {
        const float *texel = texels[SCENE_SPECULAR_GLOSSINESS_TEXTURE];
        return surface_from_specular_glossiness(N, base_color, load3(m->specular_color) * load3(texel),
                                                m->glossiness * texel[3], occlusion, emissive);
    }
    const float *rough_metal = texels[SCENE_METALLIC_ROUGHNESS_TEXTURE];
    return surface_from_gltf(
        N, base_color, m->metallic * rough_metal[2], m->perceptual_roughness * rough_metal[1], m->ior,
        m->specular * texels[SCENE_SPECULAR_TEXTURE][3],
        load3(m->specular_color) * load3(texels[SCENE_SPECULAR_COLOR_TEXTURE]), occlusion, emissive);
}

/* ---- layers; each KHR_materials_* says which channel of which texture ---- */

static void add_clearcoat(const surface_point *s, material_texels texels, Layers *m)
{
    const scene_material *material = s->hit.geometry->material;
    m->clearcoat = material->clearcoat * texels[SCENE_CLEARCOAT_TEXTURE][0];
    if (!(m->clearcoat > 0.0f))
        return;
    m->layers |= LAYER_CLEARCOAT;
    m->clearcoat_roughness =
        clamp(material->clearcoat_roughness * texels[SCENE_CLEARCOAT_ROUGHNESS_TEXTURE][1], 0.0f, 1.0f);
    const scene_texture_ref *ref = &material->textures[SCENE_CLEARCOAT_NORMAL_TEXTURE];
    vec3 N = normalize_or(shading_frame_normal(&s->hit, s->is_front), s->V);
    m->clearcoat_N = N;
    vec3 n;
    if (ref->texture == SCENE_NONE ||
        !shading_frame_decode(texels[SCENE_CLEARCOAT_NORMAL_TEXTURE], material->clearcoat_normal_scale, &n))
        return;
    /* The tangents are those of the base's normal texture. */
    const scene_texture_ref *base = &material->textures[SCENE_NORMAL_TEXTURE];
    bool has_tangents =
        s->hit.geometry->tangents && (base->texture == SCENE_NONE || base->texcoord == ref->texcoord);
    shading_frame f;
    if (has_tangents)
        f = shading_frame_of_tangents(&s->hit, s->is_front);
    else if (!shading_frame_of_texcoord(&s->hit, s->is_front, ref->texcoord, &f))
        return;
    m->clearcoat_N = normalize_or(f.T * n[0] + f.B * n[1] + f.N * n[2], N);
}

static void add_sheen(const scene_material *material, material_texels texels, Layers *m)
{
    m->sheen_color =
        clamp(load3(material->sheen_color) * load3(texels[SCENE_SHEEN_COLOR_TEXTURE]), 0.0f, 1.0f);
    if (!(max3(m->sheen_color) > 0.0f))
        return;
    m->layers |= LAYER_SHEEN;
    m->sheen_roughness =
        clamp(material->sheen_roughness * texels[SCENE_SHEEN_ROUGHNESS_TEXTURE][3], 0.0f, 1.0f);
}

static void add_iridescence(const scene_material *material, material_texels texels, Layers *m)
{
    m->iridescence = clamp(material->iridescence * texels[SCENE_IRIDESCENCE_TEXTURE][0], 0.0f, 1.0f);
    if (!(m->iridescence > 0.0f))
        return;
    m->layers |= LAYER_IRIDESCENCE;
    m->iridescence_ior = max(material->iridescence_ior, 1.0f);
    m->iridescence_thickness_nm =
        max(mix(material->iridescence_thickness_minimum, material->iridescence_thickness_maximum,
                texels[SCENE_IRIDESCENCE_THICKNESS_TEXTURE][1]),
            0.0f);
}

/* The texel's direction; (1, 0) where there is no texel, or it is that of what cannot be decoded. */
static vec2 anisotropy_texel(const scene_material *material, const float texel[4])
{
    vec2 d = vec2(2.0f * texel[0] - 1.0f, 2.0f * texel[1] - 1.0f);
    bool is_absent = !scene_material_has(material, SCENE_ANISOTROPY_TEXTURE) ||
                     (texel[0] >= 1.0f && texel[1] >= 1.0f) || !(dot(d, d) > 1e-6f);
    return is_absent ? vec2(1.0f, 0.0f) : d;
}

static void add_anisotropy(const surface_point *s, material_texels texels, Layers *m)
{
    const scene_material *material = s->hit.geometry->material;
    m->anisotropy = clamp(material->anisotropy * texels[SCENE_ANISOTROPY_TEXTURE][2], 0.0f, 1.0f);
    shading_frame f;
    if (!(m->anisotropy > 0.0f))
        return;
    if (s->hit.geometry->tangents) {
        f = shading_frame_of_tangents(&s->hit, s->is_front);
    } else {
        const scene_texture_ref *ref = &material->textures[SCENE_ANISOTROPY_TEXTURE];
        if (!shading_frame_of_texcoord(&s->hit, s->is_front, ref->texture == SCENE_NONE ? 0 : ref->texcoord,
                                       &f))
            return;
    }
    vec2 d = anisotropy_direction(anisotropy_texel(material, texels[SCENE_ANISOTROPY_TEXTURE]),
                                  material->anisotropy_rotation);
    vec3 N = m->base.N;
    vec3 T = f.T * d[0] + f.B * d[1];
    T -= N * dot(N, T);
    float T2 = dot(T, T);
    if (!(T2 > 1e-12f))
        return;
    m->layers |= LAYER_ANISOTROPY;
    m->anisotropy_T = T * inversesqrt(T2);
    m->anisotropy_B = cross(N, m->anisotropy_T);
}

/* What goes on below the interface of a dielectric. */
static void add_transmission(const surface_point *s, material_texels texels, Layers *m)
{
    const scene_material *material = s->hit.geometry->material;
    uint32_t possible = s->plan->layers;
    if (m->base.metallic >= 1.0f)
        return;
    if (possible & LAYER_TRANSMISSION) {
        m->transmission = clamp(material->transmission * texels[SCENE_TRANSMISSION_TEXTURE][0], 0.0f, 1.0f);
        m->layers |= m->transmission > 0.0f ? LAYER_TRANSMISSION : 0u;
    }
    if (possible & LAYER_DIFFUSE_TRANSMISSION) {
        m->diffuse_transmission =
            clamp(material->diffuse_transmission * texels[SCENE_DIFFUSE_TRANSMISSION_TEXTURE][3], 0.0f, 1.0f);
        m->diffuse_transmission_color = clamp(load3(material->diffuse_transmission_color) *
                                                  load3(texels[SCENE_DIFFUSE_TRANSMISSION_COLOR_TEXTURE]),
                                              0.0f, 1.0f);
        m->layers |= m->diffuse_transmission > 0.0f ? LAYER_DIFFUSE_TRANSMISSION : 0u;
    }
    if (!(m->layers & (LAYER_TRANSMISSION | LAYER_DIFFUSE_TRANSMISSION)) || !(possible & LAYER_VOLUME))
        return;
    m->layers |= LAYER_VOLUME | (possible & (LAYER_DISPERSION | LAYER_SCATTER));
    m->thickness = material->thickness * s->hit.geometry->scale * texels[SCENE_THICKNESS_TEXTURE][1];
    m->attenuation_color = load3(material->attenuation_color);
    m->attenuation_distance = material->attenuation_distance;
    m->dispersion = material->dispersion;
    m->multiscatter_color = clamp(load3(material->multiscatter_color), 0.0f, 1.0f);
    m->scatter_anisotropy = material->scatter_anisotropy;
}

static void add_layers(const surface_point *s, material_texels texels, Layers *m)
{
    const scene_material *material = s->hit.geometry->material;
    uint32_t possible = s->plan->layers;
    *m = layers_from_surface(m->base);
    m->ior = material->ior;
    m->eta = s->is_front || !s->plan->is_volume ? material->ior : 1.0f / max(material->ior, 1.0f);
    if (possible & LAYER_CLEARCOAT)
        add_clearcoat(s, texels, m);
    if (possible & LAYER_SHEEN)
        add_sheen(material, texels, m);
    if (possible & LAYER_IRIDESCENCE)
        add_iridescence(material, texels, m);
    if (possible & LAYER_ANISOTROPY)
        add_anisotropy(s, texels, m);
    if (possible & (LAYER_TRANSMISSION | LAYER_DIFFUSE_TRANSMISSION))
        add_transmission(s, texels, m);
}

/* ---- specular anti-aliasing ---- */

static float widened_roughness(const surface_point *s, float perceptual_roughness)
{
    return sqrt(alpha_specular_aa(alpha_from_roughness(perceptual_roughness), s->dN_dx, s->dN_dy));
}

/* The coat has a normal of its own; where no texture bends it, its change is that of the smooth normal, which that of
 * the base is not far from. */
static void antialias(surface_point *s)
{
    s->m.base.perceptual_roughness = widened_roughness(s, s->m.base.perceptual_roughness);
    s->m.base.alpha = alpha_from_roughness(s->m.base.perceptual_roughness);
    if (s->m.layers & LAYER_CLEARCOAT)
        s->m.clearcoat_roughness = widened_roughness(s, s->m.clearcoat_roughness);
}

/* ---- all ---- */

void surface_point_make(const shading_scene *scene, const shading_point *point, surface_point *s)
{
    s->hit = shading_hit_make(scene, point);
    const render_geometry *g = s->hit.geometry;
    s->plan = &scene->plans->items[point->hit->geometry];
    s->is_lit = g->is_lit;
    s->P = s->hit.position;
    s->V = normalize(-s->hit.direction);
    s->is_front =
        g->primitive->mode != SCENE_TRIANGLES || surface_sees_front(g, point->hit, s->hit.direction);
    s->m.layers = 0u;

    material_texels texels;
    material_texels_read(scene, &s->hit, s->plan->textures, s->plan->slot_count, texels);
    multiply_base_color(&s->hit, texels[SCENE_BASE_COLOR_TEXTURE], s->base_color);
    vec3 N = g->normals ? shading_normal(&s->hit, s->plan, texels[SCENE_NORMAL_TEXTURE], s->is_front) : s->V;
    s->m.base = make_surface(g->material, texels, N, load3(s->base_color));
    if (!s->is_lit)
        return;
    if (s->plan->layers)
        add_layers(s, texels, &s->m);
    if (scene->specular_antialiasing) {
        s->dN_dx = normal_change(scene, s, 0);
        s->dN_dy = normal_change(scene, s, 1);
        antialias(s);
    }
}
