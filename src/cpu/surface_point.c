/* surface_point.c - see surface_point.h. Look-ups at a hit; shade/material.h defines their meaning. */
#include "cpu/shading_hit.h"
#include "cpu/surface_point.h"

/* ---- color and opacity ---- */

static void multiply_base_color(const shading_hit *h, const float texel[4], float out[4])
{
    const float *factor = h->geometry->material->base_color;
    float color[4];
    shading_hit_color(h, color);
    store3(material_base_color(load3(factor), load3(texel), load3(color)), out);
    out[3] = texel[3] * (factor[3] * color[3]);
}

void surface_base_color(const shading_scene *scene, const shading_hit *h, const material_plan *plan,
                        float out[4])
{
    material_texels texels;
    material_texels_read(scene, h, plan->textures & 1u << SCENE_BASE_COLOR_TEXTURE, 1, texels);
    multiply_base_color(h, texels[SCENE_BASE_COLOR_TEXTURE], out);
}

_Static_assert(ALPHA_MODE_OPAQUE == (int)SCENE_ALPHA_OPAQUE && ALPHA_MODE_MASK == (int)SCENE_ALPHA_MASK &&
                   ALPHA_MODE_BLEND == (int)SCENE_ALPHA_BLEND,
               "alpha modes are those of shade/");

float surface_opacity(const scene_material *material, float alpha)
{
    return material_coverage((int)material->alpha_mode, alpha, material->alpha_cutoff);
}

/* ---- normals ---- */

/* Unit shading normal on the visible side. */
static vec3 shading_normal(const shading_hit *h, const material_plan *plan, const float normal_texel[4],
                           bool is_front)
{
    vec3 to_eye = normalize_or(-h->direction, vec3(0.0f, 0.0f, 1.0f));
    if (!(plan->textures & 1u << SCENE_NORMAL_TEXTURE))
        return normalize_or(shading_frame_normal(h, is_front), to_eye);
    vec3 n = normal_from_texel(load3(normal_texel), h->geometry->material->normal_scale);
    ShadingFrame f = material_texture_frame(shading_frame_of_tangents(h, is_front),
                                            &h->geometry->material->textures[SCENE_NORMAL_TEXTURE]);
    return frame_normal(f, n, normalize_or(f.N, to_eye));
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

/* The change of the shading normal across the footprint. */
static vec3 normal_change(const shading_scene *scene, const surface_point *s, int axis)
{
    return normal_beside(scene, s, axis, 0.5f) - normal_beside(scene, s, axis, -0.5f);
}

/* ---- the surface ---- */

static Surface make_surface(const scene_material *m, material_texels texels, vec3 N, vec3 base_color)
{
    MaterialFactors f = {.metallic = m->metallic,
                         .perceptual_roughness = m->perceptual_roughness,
                         .ior = m->ior,
                         .specular = m->specular,
                         .specular_color = load3(m->specular_color),
                         .glossiness = m->glossiness,
                         .occlusion_strength = m->occlusion_strength,
                         .emissive = load3(m->emissive) * m->emissive_strength};
    float occlusion = texels[SCENE_OCCLUSION_TEXTURE][0];
    vec3 emissive = load3(texels[SCENE_EMISSIVE_TEXTURE]);
    if (m->extensions & SCENE_SPECULAR_GLOSSINESS) {
        const float *texel = texels[SCENE_SPECULAR_GLOSSINESS_TEXTURE];
        return material_surface_glossy(f, N, base_color, load3(texel), texel[3], occlusion, emissive);
    }
    return material_surface(f, N, base_color, load3(texels[SCENE_METALLIC_ROUGHNESS_TEXTURE]), occlusion,
                            emissive, texels[SCENE_SPECULAR_TEXTURE][3],
                            load3(texels[SCENE_SPECULAR_COLOR_TEXTURE]));
}

/* ---- layers ---- */

/* Unit, on the side of the eye. */
static vec3 clearcoat_normal(const surface_point *s, const float texel[4])
{
    const scene_material *material = s->hit.geometry->material;
    const scene_texture_ref *ref = &material->textures[SCENE_CLEARCOAT_NORMAL_TEXTURE];
    vec3 N = normalize_or(shading_frame_normal(&s->hit, s->is_front), s->V);
    if (ref->texture == SCENE_NONE)
        return N;
    vec3 n = normal_from_texel(load3(texel), material->clearcoat_normal_scale);
    ShadingFrame f;
    /* The geometry's tangents are those of the base's normal texture. */
    const scene_texture_ref *base = &material->textures[SCENE_NORMAL_TEXTURE];
    if (s->hit.geometry->tangents && (base->texture == SCENE_NONE || base->texcoord == ref->texcoord))
        f = shading_frame_of_tangents(&s->hit, s->is_front);
    else
        f = shading_frame_of_texcoord(&s->hit, s->is_front, ref->texcoord);
    return frame_has_tangent(f) ? frame_normal(material_texture_frame(f, ref), n, N) : N;
}

/* These take and return layers by value: they are inlined without copies. */

static inline Layers add_clearcoat(const surface_point *s, material_texels texels, Layers m)
{
    const scene_material *material = s->hit.geometry->material;
    m = with_clearcoat(m, material->clearcoat, material->clearcoat_roughness,
                       load3(texels[SCENE_CLEARCOAT_TEXTURE]),
                       load3(texels[SCENE_CLEARCOAT_ROUGHNESS_TEXTURE]));
    if (m.layers & LAYER_CLEARCOAT)
        m.clearcoat_N = clearcoat_normal(s, texels[SCENE_CLEARCOAT_NORMAL_TEXTURE]);
    return m;
}

static inline Layers add_anisotropy(const surface_point *s, material_texels texels, Layers m)
{
    const scene_material *material = s->hit.geometry->material;
    vec3 texel = load3(texels[SCENE_ANISOTROPY_TEXTURE]);
    float strength = anisotropy_strength(material->anisotropy, texel);
    if (!(strength > 0.0f))
        return m;
    const scene_texture_ref *ref = &material->textures[SCENE_ANISOTROPY_TEXTURE];
    ShadingFrame f;
    if (s->hit.geometry->tangents)
        f = shading_frame_of_tangents(&s->hit, s->is_front);
    else
        f = shading_frame_of_texcoord(&s->hit, s->is_front, ref->texture == SCENE_NONE ? 0 : ref->texcoord);
    f = material_texture_frame(f, ref);
    return with_anisotropy(m, strength, material->anisotropy_rotation, texel, f);
}

/* Layers below the interface of a dielectric. */
static inline Layers add_transmission(const surface_point *s, material_texels texels, Layers m)
{
    const scene_material *material = s->hit.geometry->material;
    uint32_t possible = s->plan->layers;
    if (possible & LAYER_TRANSMISSION)
        m = with_transmission(m, material->transmission, load3(texels[SCENE_TRANSMISSION_TEXTURE]));
    if (possible & LAYER_DIFFUSE_TRANSMISSION)
        m = with_diffuse_transmission(m, material->diffuse_transmission,
                                      load3(material->diffuse_transmission_color),
                                      texels[SCENE_DIFFUSE_TRANSMISSION_TEXTURE][3],
                                      load3(texels[SCENE_DIFFUSE_TRANSMISSION_COLOR_TEXTURE]));
    if (possible & LAYER_VOLUME)
        m = with_volume(m, material->thickness * s->hit.geometry->scale,
                        load3(texels[SCENE_THICKNESS_TEXTURE]), load3(material->attenuation_color),
                        material->attenuation_distance, material->dispersion);
    if (possible & LAYER_SCATTER)
        m = with_scatter(m, load3(material->multiscatter_color), material->scatter_anisotropy);
    return m;
}

static inline Layers make_layers(const surface_point *s, material_texels texels)
{
    const scene_material *material = s->hit.geometry->material;
    uint32_t possible = s->plan->layers;
    Layers m = with_ior(layers_from_surface(s->m.base), material->ior, s->plan->is_volume && !s->is_front);
    if (possible & LAYER_CLEARCOAT)
        m = add_clearcoat(s, texels, m);
    if (possible & LAYER_SHEEN)
        m = with_sheen(m, load3(material->sheen_color), material->sheen_roughness,
                       load3(texels[SCENE_SHEEN_COLOR_TEXTURE]), texels[SCENE_SHEEN_ROUGHNESS_TEXTURE][3]);
    if (possible & LAYER_IRIDESCENCE)
        m = with_iridescence(m, material->iridescence, material->iridescence_ior,
                             material->iridescence_thickness_minimum, material->iridescence_thickness_maximum,
                             load3(texels[SCENE_IRIDESCENCE_TEXTURE]),
                             load3(texels[SCENE_IRIDESCENCE_THICKNESS_TEXTURE]));
    if (possible & LAYER_ANISOTROPY)
        m = add_anisotropy(s, texels, m);
    if (possible & (LAYER_TRANSMISSION | LAYER_DIFFUSE_TRANSMISSION))
        m = add_transmission(s, texels, m);
    if (possible & LAYER_DIFFUSE_ROUGHNESS)
        m = with_diffuse_roughness(m, material->diffuse_roughness,
                                   load3(texels[SCENE_DIFFUSE_ROUGHNESS_TEXTURE]));
    return m;
}

/* ---- specular anti-aliasing ---- */

/* The coat has its own normal; without a normal texture its derivative is that of the smooth normal, which
 * is close to the base's. */
static void antialias(surface_point *s)
{
    s->m.base = surface_specular_aa(s->m.base, s->dN_dx, s->dN_dy);
    if (s->m.layers & LAYER_CLEARCOAT)
        s->m.clearcoat_roughness = roughness_specular_aa(s->m.clearcoat_roughness, s->dN_dx, s->dN_dy);
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
    s->ambient = vec3(1.0f);

    material_texels texels;
    material_texels_read(scene, &s->hit, s->plan->textures, s->plan->slot_count, texels);
    multiply_base_color(&s->hit, texels[SCENE_BASE_COLOR_TEXTURE], s->base_color);
    vec3 N = g->normals ? shading_normal(&s->hit, s->plan, texels[SCENE_NORMAL_TEXTURE], s->is_front) : s->V;
    s->m.base = make_surface(g->material, texels, N, load3(s->base_color));
    if (!s->is_lit)
        return;
    if (s->plan->layers)
        s->m = make_layers(s, texels);
    if (scene->has_specular_antialiasing) {
        s->dN_dx = normal_change(scene, s, 0);
        s->dN_dy = normal_change(scene, s, 1);
        antialias(s);
    }
}
