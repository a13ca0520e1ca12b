/* gl_phong_block.c - see gl_phong_block.h. */
#include <string.h>

#include "gl/scene/gl_phong_block.h"

const legacy_map_slot gl_phong_slots[GL_PHONG_MAPS] = {
    LEGACY_AMBIENT_MAP,   LEGACY_DIFFUSE_MAP, LEGACY_SPECULAR_MAP, LEGACY_EMISSION_MAP,
    LEGACY_SHININESS_MAP, LEGACY_OPACITY_MAP, LEGACY_NORMAL_MAP};

static void store3(vec3 v, float out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = v[i];
}

void gl_phong_picture_fill(const ogl1_setup *s, facet_ogl1_variant variant, gl_phong_picture *b)
{
    memset(b, 0, sizeof *b);
    for (int axis = 0; axis < 3; axis++) {
        vec3 unit = vec3(axis == 0 ? 1.0f : 0.0f, axis == 1 ? 1.0f : 0.0f, axis == 2 ? 1.0f : 0.0f);
        vec3 column = mul(s->view, unit);
        for (int row = 0; row < 3; row++)
            b->view[row][axis] = column[row];
    }
    b->variant = (int32_t)variant;
    b->is_encoded = s->is_encoded;
    b->are_colors_srgb = s->are_colors_srgb;
    b->light_count = (int32_t)s->light_count;
    store3(s->rules.global_ambient, b->global_ambient);
    b->has_rgl_colors = s->has_rgl_colors ? 1.0f : 0.0f;
    store3(s->fog.color, b->fog_color);
    b->fog_mode = (float)s->fog.mode;
    b->fog_near = s->fog.near_m;
    b->fog_far = s->fog.far_m;
    b->fog_scale = s->fog.scale;
    b->fog_w = s->fog.w;
    for (uint32_t i = 0; i < s->light_count; i++) {
        store3(s->lights[i].position, b->lights[i][0]);
        b->lights[i][0][3] = s->lights[i].is_point ? 1.0f : 0.0f;
        store3(s->lights[i].ambient, b->lights[i][1]);
        store3(s->lights[i].diffuse, b->lights[i][2]);
        store3(s->lights[i].specular, b->lights[i][3]);
    }
}

/* 0 to 3; 4: luminance. ogl1_map_scalar(). */
static float channel_of(char channel)
{
    return channel == 'r'   ? 0.0f
           : channel == 'g' ? 1.0f
           : channel == 'b' ? 2.0f
           : channel == 'm' ? 3.0f
                            : 4.0f;
}

static void fill_map(const facet_scene *scene, const legacy_map *map, float out[3][4])
{
    static const float identity[6] = {1, 0, 0, 0, 1, 0};
    const float *transform = map->ref.has_transform ? map->ref.transform : identity;
    memcpy(out[0], transform, 3 * sizeof *transform);
    memcpy(out[1], transform + 3, 3 * sizeof *transform);
    if (map->ref.texture < scene->texture_count) {
        const scene_texture *t = &scene->textures[map->ref.texture];
        out[0][3] = (float)map->ref.texcoord;
        out[1][3] = t->min_filter == SCENE_FILTER_LINEAR && t->mip_filter == SCENE_MIP_LINEAR;
    }
    out[2][0] = map->base;
    out[2][1] = map->gain;
    out[2][2] = channel_of(map->channel);
}

void gl_phong_material_fill(const facet_scene *scene, const ogl1_material *m, gl_phong_material *b)
{
    const legacy_material *l = m->legacy;
    memset(b, 0, sizeof *b);
    store3(m->phong.ambient, b->ambient);
    b->shininess = m->phong.shininess;
    store3(m->phong.diffuse, b->diffuse);
    b->opacity = l->opacity;
    store3(m->phong.specular, b->specular);
    b->texture_type = (float)l->texture_type;
    store3(m->phong.emission, b->emission);
    b->texture_mode = (float)l->texture_mode;
    b->has_texture_over_light = m->has_texture_over_light ? 1.0f : 0.0f;
    b->is_halo = l->is_halo ? 1.0f : 0.0f;
    b->has_fog = l->has_fog ? 1.0f : 0.0f;
    b->bump_multiplier = l->maps[LEGACY_NORMAL_MAP].bump_multiplier;
    for (int i = 0; i < GL_PHONG_MAPS; i++)
        fill_map(scene, &l->maps[gl_phong_slots[i]], b->maps[i]);
}
