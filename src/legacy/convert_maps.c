/* convert_maps.c - see convert_maps.h. */
#include "legacy/convert_maps.h"

#include <string.h>

#include "legacy/convert_surface.h"

/* -imfchan: r g b, m for matte (alpha), l for luminance; z, a depth, is read as luminance. */
static int channel_of(char letter, int fallback)
{
    switch (letter) {
    case 'r':
        return TEXTURE_RED;
    case 'g':
        return TEXTURE_GREEN;
    case 'b':
        return TEXTURE_BLUE;
    case 'm':
        return TEXTURE_ALPHA;
    case 'l':
    case 'z':
        return TEXTURE_GREY;
    default:
        return fallback;
    }
}

bool map_is_plain(const legacy_map *map)
{
    return map->base == 0.0f && map->gain == 1.0f && map->channel == 0;
}

int map_opacity_channel(const texture_baker *baker, const legacy_map *map)
{
    const texture_statistics *s = texture_baker_statistics(baker, map->ref.texture);
    return channel_of(map->channel, s && s->has_alpha ? TEXTURE_ALPHA : TEXTURE_GREY);
}

color_lut color_lut_make(const texture_baker *baker, const legacy_map *map, const float factor[3])
{
    color_lut t;
    const srgb_tables *srgb = texture_baker_srgb(baker);
    bool is_plain = map_is_plain(map);
    for (int k = 0; k < 3; k++) {
        t.channels[k] = channel_of(map->channel, k);
        for (int code = 0; code < 256; code++) {
            float value = 1.0f;
            if (map->ref.texture != SCENE_NONE)
                value = is_plain ? srgb->decoded[code]
                                 : legacy_to_linear(unit_of(map->base + map->gain * (float)code / 255.0f),
                                                    FACET_LEGACY_COLORS_SRGB);
            t.values[k][code] = factor[k] * value;
        }
    }
    return t;
}

scalar_lut scalar_lut_make(const texture_baker *baker, const legacy_map *map, float factor, int fallback)
{
    scalar_lut t;
    (void)baker;
    t.channel = channel_of(map->channel, fallback);
    for (int code = 0; code < 256; code++) {
        float value =
            map->ref.texture == SCENE_NONE ? 1.0f : unit_of(map->base + map->gain * (float)code / 255.0f);
        t.values[code] = factor * value;
    }
    return t;
}

void color_lut_mean(const color_lut *t, const texture_baker *baker, const legacy_map *map, float out[3])
{
    const texture_statistics *s = texture_baker_statistics(baker, map->ref.texture);
    for (int k = 0; k < 3; k++)
        out[k] = s ? (float)texture_mean(s, t->channels[k], t->values[k]) : t->values[k][255];
}

float scalar_lut_mean(const scalar_lut *t, const texture_baker *baker, const legacy_map *map)
{
    const texture_statistics *s = texture_baker_statistics(baker, map->ref.texture);
    return s ? (float)texture_mean(s, t->channel, t->values) : t->values[255];
}

/* The largest (sign 1) or smallest (-1) value of the codes that occur. */
static float extreme(const texture_statistics *s, int channel, const float values[256], float sign)
{
    float found = 0;
    bool is_first = true;
    if (!s)
        return values[255];
    for (int code = 0; code < 256; code++)
        if (s->histogram[channel][code] > 0 && (is_first || values[code] * sign > found * sign)) {
            found = values[code];
            is_first = false;
        }
    return found;
}

void color_lut_highest(const color_lut *t, const texture_baker *baker, const legacy_map *map, float out[3])
{
    const texture_statistics *s = texture_baker_statistics(baker, map->ref.texture);
    for (int k = 0; k < 3; k++)
        out[k] = extreme(s, t->channels[k], t->values[k], 1.0f);
}

float scalar_lut_highest(const scalar_lut *t, const texture_baker *baker, const legacy_map *map)
{
    return extreme(texture_baker_statistics(baker, map->ref.texture), t->channel, t->values, 1.0f);
}

float scalar_lut_lowest(const scalar_lut *t, const texture_baker *baker, const legacy_map *map)
{
    return extreme(texture_baker_statistics(baker, map->ref.texture), t->channel, t->values, -1.0f);
}

bool map_refs_agree(const facet_scene *scene, const scene_texture_ref *a, const scene_texture_ref *b)
{
    const scene_texture *s = &scene->textures[a->texture];
    const scene_texture *t = &scene->textures[b->texture];
    return a->texcoord == b->texcoord && a->rotation_rad == b->rotation_rad &&
           memcmp(a->offset, b->offset, sizeof a->offset) == 0 &&
           memcmp(a->scale, b->scale, sizeof a->scale) == 0 && s->wrap_u == t->wrap_u &&
           s->wrap_v == t->wrap_v;
}
