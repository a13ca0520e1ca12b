/* gl_material_block.c - see gl_material_block.h. */
#include "gl/scene/gl_material_block.h"

#include <math.h>
#include <string.h>

#include "gl/scene/gl_mesh_vertices.h"

static void copy3(const float in[3], float out[3])
{
    memcpy(out, in, 3 * sizeof *out);
}

static void fill_texcoords(const facet_scene *scene, const scene_material *m, const scene_texture_ref *ref,
                           float rows[2][4])
{
    static const float identity[6] = {1, 0, 0, 0, 1, 0};
    const float *transform = ref->has_transform ? ref->transform : identity;
    copy3(transform, rows[0]);
    copy3(transform + 3, rows[1]);
    if (ref->texture >= scene->texture_count)
        return;
    const scene_texture *t = &scene->textures[ref->texture];
    uint32_t attribute = gl_texcoord_attribute(m, ref->texcoord);
    if (attribute == GL_TEXCOORD_SETS) /* the set is not among the attributes: read at 0 */
        memset(rows, 0, 2 * sizeof *rows);
    else
        rows[0][3] = (float)attribute;
    rows[1][3] = t->min_filter == SCENE_FILTER_LINEAR && t->mip_filter == SCENE_MIP_LINEAR;
}

static void fill_layers(const scene_material *m, gl_material_block *b)
{
    b->clearcoat = m->clearcoat;
    b->clearcoat_roughness = m->clearcoat_roughness;
    b->clearcoat_normal_scale = m->clearcoat_normal_scale;
    b->anisotropy = m->anisotropy;
    b->anisotropy_rotation = m->anisotropy_rotation;
    b->iridescence = m->iridescence;
    b->iridescence_ior = m->iridescence_ior;
    b->iridescence_thickness_minimum = m->iridescence_thickness_minimum;
    b->iridescence_thickness_maximum = m->iridescence_thickness_maximum;
    copy3(m->sheen_color, b->sheen_color);
    b->sheen_roughness = m->sheen_roughness;
    b->transmission = m->transmission;
    copy3(m->diffuse_transmission_color, b->diffuse_transmission_color);
    b->diffuse_transmission = m->diffuse_transmission;
    b->thickness = m->thickness;
    copy3(m->attenuation_color, b->attenuation_color);
    b->attenuation_distance = fminf(m->attenuation_distance, 1e30f); /* not every GPU supports infinity */
    b->dispersion = m->dispersion;
    copy3(m->multiscatter_color, b->multiscatter_color);
    b->scatter_anisotropy = m->scatter_anisotropy;
    b->diffuse_roughness = m->diffuse_roughness;
}

void gl_material_block_fill(const facet_scene *scene, const scene_material *m, gl_material_block *b)
{
    memset(b, 0, sizeof *b);
    memcpy(b->base_color, m->base_color, sizeof b->base_color);
    for (int i = 0; i < 3; i++)
        b->emissive[i] = m->emissive[i] * m->emissive_strength;
    b->alpha_cutoff = m->alpha_cutoff;
    copy3(m->specular_color, b->specular_color);
    b->specular = m->specular;
    b->metallic = m->metallic;
    b->perceptual_roughness = m->perceptual_roughness;
    b->ior = m->ior;
    b->glossiness = m->glossiness;
    b->normal_scale = m->normal_scale;
    b->occlusion_strength = m->occlusion_strength;
    fill_layers(m, b);
    for (int slot = 0; slot < SCENE_TEXTURE_SLOT_COUNT; slot++)
        fill_texcoords(scene, m, &m->textures[slot], b->texcoords[slot]);
}
