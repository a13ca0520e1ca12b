/* shading.c - see shading.h. Only what the glTF formats of normals and materials mean is here; every formula of
 * reflection is in shade/. */
#include "cpu/shading.h"

#include "cpu/material_texels.h"
#include "cpu/shading_hit.h"
#include "shade/shade.h"

/* ---- normals ---- */

static vec3 transform(const float rows[9], vec3 v)
{
    return vec3(dot(load3(rows), v), dot(load3(rows + 3), v), dot(load3(rows + 6), v));
}

/* The vector that a texel of the normal texture holds, with its scale; false: nothing that is a normal (there is no
 * texture, or it could not be decoded and reads as white). glTF 2.0, 3.9.3. */
static bool normal_from_texel(const shading_hit *h, const float texel[4], vec3 *n)
{
    const scene_material *material = h->geometry->material;
    if (material->textures[SCENE_NORMAL_TEXTURE].texture == SCENE_NONE || !h->geometry->tangents)
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
static vec3 shading_normal(const shading_hit *h, const float normal_texel[4], bool is_front)
{
    const render_geometry *g = h->geometry;
    float side = is_front ? 1.0f : -1.0f;
    vec3 to_eye = normalize_or(-h->direction, vec3(0.0f, 0.0f, 1.0f));
    vec3 N = transform(g->normal_matrix, shading_hit_vec3(h, g->normals)) * side;
    vec3 n;
    if (!normal_from_texel(h, normal_texel, &n))
        return normalize_or(N, to_eye);

    vec3 tangent = vec3(0.0f);
    float handedness = 1.0f;
    for (int i = 0; i < 3; i++) {
        const float *t =
            g->tangents + 4 * (g->has_corner_tangents ? h->first_index + (size_t)i : h->corner[i]);
        tangent += load3(t) * h->weight[i];
        handedness = t[3];
    }
    vec3 T = transform(g->tangent_matrix, tangent) * side;
    vec3 B = cross(N, T) * (handedness * g->bitangent_sign * side);
    return normalize_or(T * n[0] + B * n[1] + N * n[2], normalize_or(N, to_eye));
}

/* ---- surfaces ---- */

/* Whether the ray sees the front of a triangle: its vertices counter-clockwise, unless the instance is mirrored. */
static bool sees_front(const render_geometry *g, const visibility_hit *hit, vec3 direction)
{
    float facing = dot(load3(hit->normal), direction);
    return g->is_mirrored ? facing > 0.0f : facing < 0.0f;
}

bool shading_is_visible_side(const shading_scene *scene, const visibility_hit *hit, const float direction[3])
{
    const render_geometry *g = &scene->geometries->items[hit->geometry];
    return g->is_double_sided || sees_front(g, hit, load3(direction));
}

/* Factor, texture and vertex color multiplied. */
static void multiply_base_color(const shading_hit *h, const float texel[4], float out[4])
{
    float color[4];
    shading_hit_color(h, color);
    for (int i = 0; i < 4; i++)
        out[i] = texel[i] * (h->geometry->material->base_color[i] * color[i]);
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
    shading_hit h = shading_hit_make(scene, point);
    material_texels texels;
    float base_color[4];
    material_texels_read(scene, &h, 1u << BASE_COLOR, texels);
    multiply_base_color(&h, texels[BASE_COLOR], base_color);
    return opacity_from_alpha(g->material, base_color[3]);
}

static Surface make_surface(const scene_material *m, material_texels texels, vec3 N, vec3 base_color)
{
    const float *rough_metal = texels[METALLIC_ROUGHNESS];
    return surface_from_gltf(
        N, base_color, m->metallic * rough_metal[2], m->perceptual_roughness * rough_metal[1], m->ior,
        m->specular * texels[SPECULAR][3], load3(m->specular_color) * load3(texels[SPECULAR_COLOR]),
        occlusion_from_texel(texels[OCCLUSION][0], m->occlusion_strength),
        load3(m->emissive) * m->emissive_strength * load3(texels[EMISSIVE]));
}

/* The textures that a hit on g reads. */
static uint32_t textures_read(const render_geometry *g)
{
    if (g->is_lit)
        return ALL_TEXTURES & ~(g->tangents ? 0u : 1u << NORMAL);
    return 1u << BASE_COLOR | (g->material->extensions & SCENE_UNLIT ? 0u : 1u << EMISSIVE);
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
    shading_hit h = shading_hit_make(scene, point);
    const scene_material *material = h.geometry->material;
    material_texels texels;
    float base_color[4];
    material_texels_read(scene, &h, textures_read(h.geometry), texels);
    multiply_base_color(&h, texels[BASE_COLOR], base_color);
    vec3 V = normalize(-h.direction);
    vec3 N = V;
    vec3 radiance = load3(base_color);
    out->occlusion = 1.0f;
    if (h.geometry->normals)
        N = shading_normal(&h, texels[NORMAL],
                           h.geometry->primitive->mode != SCENE_TRIANGLES ||
                               sees_front(h.geometry, point->hit, h.direction));
    if (h.geometry->is_lit) {
        Surface s = make_surface(material, texels, N, load3(base_color));
        radiance = lit_radiance(scene, s, h.position, V);
        out->occlusion = s.occlusion;
    } else if (!(material->extensions & SCENE_UNLIT)) {
        /* Points and lines without normals: glTF 2.0, 3.7.2.1. */
        radiance += load3(material->emissive) * material->emissive_strength * load3(texels[EMISSIVE]);
    }
    store3(radiance, out->radiance);
    store3(N, out->normal);
    store3(load3(base_color), out->base_color);
    out->opacity = opacity_from_alpha(material, base_color[3]);
    shading_texcoord uv = shading_hit_texcoord(&h, 0);
    out->uv[0] = uv.uv[0];
    out->uv[1] = uv.uv[1];
}
