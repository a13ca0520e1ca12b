/* material_texels.c - see material_texels.h. Textures with the same coordinates are looked up together. */
#include <string.h>

#include "scene/material_table.h"

#include "cpu/material_texels.h"

static bool has_same_coordinates(const scene_texture_ref *a, const scene_texture_ref *b)
{
    return a->texcoord == b->texcoord && a->has_transform == b->has_transform &&
           (!a->has_transform || memcmp(a->transform, b->transform, sizeof a->transform) == 0);
}

shading_texcoord material_texture_coordinates(const shading_hit *h, const scene_texture_ref *ref)
{
    shading_texcoord o = shading_hit_texcoord(h, ref->texcoord);
    if (!ref->has_transform)
        return o;
    shading_texcoord c;
    vec2 uv = texcoord_transform(vec2(o.uv[0], o.uv[1]), load3(ref->transform), load3(ref->transform + 3));
    for (int i = 0; i < 2; i++) {
        const float *row = ref->transform + 3 * i;
        c.uv[i] = uv[i];
        c.dx[i] = row[0] * o.dx[0] + row[1] * o.dx[1];
        c.dy[i] = row[0] * o.dy[0] + row[1] * o.dy[1];
    }
    return c;
}

void material_texels_read(const shading_scene *scene, const shading_hit *h, uint32_t wanted, int slot_count,
                          material_texels texels)
{
    const scene_texture_ref *refs = h->geometry->material->textures;
    for (int i = 0; i < slot_count; i++)
        for (int c = 0; c < 4; c++)
            texels[i][c] = 1.0f;
    while (wanted) {
        texture_request requests[TEXTURE_GROUP];
        int slots[TEXTURE_GROUP];
        uint32_t count = 0;
        const scene_texture_ref *first = &refs[__builtin_ctz(wanted)];
        for (uint32_t left = wanted; left && count < TEXTURE_GROUP; left &= left - 1) {
            int slot = __builtin_ctz(left);
            if (!has_same_coordinates(first, &refs[slot]))
                continue;
            wanted &= ~(1u << slot);
            requests[count].texture = refs[slot].texture;
            requests[count].as_color = material_textures[slot].is_color;
            slots[count++] = slot;
        }
        shading_texcoord c = material_texture_coordinates(h, first);
        texture_sample_group(scene->textures, requests, count, c.uv, c.dx, c.dy);
        for (uint32_t k = 0; k < count; k++)
            memcpy(texels[slots[k]], requests[k].texel, sizeof texels[0]);
    }
}

void material_texel_beside(const shading_scene *scene, const shading_hit *h, scene_texture_slot slot,
                           int axis, float step, float texel[4])
{
    const scene_texture_ref *ref = &h->geometry->material->textures[slot];
    shading_texcoord c = material_texture_coordinates(h, ref);
    for (int i = 0; i < 2; i++)
        c.uv[i] += (axis ? c.dy[i] : c.dx[i]) * step;
    texture_sample(scene->textures, ref->texture, material_textures[slot].is_color, c.uv, c.dx, c.dy, texel);
}
