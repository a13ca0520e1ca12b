/* material_texels.c - see material_texels.h. Textures with the same coordinates are looked up together. */
#include <string.h>

#include "cpu/material_texels.h"

_Static_assert((int)MATERIAL_TEXTURE_COUNT <= (int)TEXTURE_GROUP, "all textures of a material are one group");

static const struct {
    scene_texture_slot slot;
    bool is_color;
} MATERIAL_TEXTURES[MATERIAL_TEXTURE_COUNT] = {
    [BASE_COLOR] = {SCENE_BASE_COLOR_TEXTURE, true},
    [EMISSIVE] = {SCENE_EMISSIVE_TEXTURE, true},
    [METALLIC_ROUGHNESS] = {SCENE_METALLIC_ROUGHNESS_TEXTURE, false},
    [NORMAL] = {SCENE_NORMAL_TEXTURE, false},
    [OCCLUSION] = {SCENE_OCCLUSION_TEXTURE, false},
    [SPECULAR] = {SCENE_SPECULAR_TEXTURE, false},
    [SPECULAR_COLOR] = {SCENE_SPECULAR_COLOR_TEXTURE, true},
};

static const scene_texture_ref *texture_ref(const scene_material *material, int number)
{
    return &material->textures[MATERIAL_TEXTURES[number].slot];
}

static bool has_same_coordinates(const scene_texture_ref *a, const scene_texture_ref *b)
{
    return a->texcoord == b->texcoord && a->has_transform == b->has_transform &&
           (!a->has_transform || memcmp(a->transform, b->transform, sizeof a->transform) == 0);
}

static void transform_coordinates(const float m[6], shading_texcoord *c)
{
    shading_texcoord o = *c;
    for (int i = 0; i < 2; i++) {
        const float *row = m + 3 * i;
        c->uv[i] = row[0] * o.uv[0] + row[1] * o.uv[1] + row[2];
        c->dx[i] = row[0] * o.dx[0] + row[1] * o.dx[1];
        c->dy[i] = row[0] * o.dy[0] + row[1] * o.dy[1];
    }
}

void material_texels_read(const shading_scene *scene, const shading_hit *h, uint32_t wanted,
                          material_texels texels)
{
    const scene_material *material = h->geometry->material;
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
        shading_texcoord c = shading_hit_texcoord(h, first->texcoord);
        if (first->has_transform)
            transform_coordinates(first->transform, &c);
        texture_sample_group(scene->textures, requests, count, c.uv, c.dx, c.dy);
        for (uint32_t k = 0; k < count; k++)
            memcpy(texels[numbers[k]], requests[k].texel, sizeof texels[0]);
    }
}
