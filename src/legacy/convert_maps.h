/* convert_maps.h - maps of legacy materials as LUTs from 8-bit codes to values, and statistics of them. */
#ifndef LEGACY_CONVERT_MAPS_H
#define LEGACY_CONVERT_MAPS_H

#include "legacy/texture_baker.h"
#include "scene/legacy.h"

/* A color by texel: component k is values[k][code of channel channels[k]]. Without padding, since it is
 * part of the key of a bake. */
typedef struct color_lut {
    int channels[3]; /* TEXTURE_RED .. TEXTURE_GREY */
    float values[3][256];
} color_lut;

typedef struct scalar_lut {
    int channel;
    float values[256];
} scalar_lut;

/* 255 without a texel: the LUT of an absent map holds the factor everywhere. */
static inline uint8_t lut_code(const uint8_t *texel, int channel)
{
    return !texel ? 255 : channel == TEXTURE_GREY ? texture_grey(texel) : texel[channel];
}
static inline float lut_scalar(const scalar_lut *t, const uint8_t *texel)
{
    return t->values[lut_code(texel, t->channel)];
}
static inline void lut_color(const color_lut *t, const uint8_t *texel, float out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = t->values[k][lut_code(texel, t->channels[k])];
}

/* Factor (linear) times the texels of the map; images are sRGB, whatever the factors of the file are. */
color_lut color_lut_make(const texture_baker *baker, const legacy_map *map, const float factor[3]);
/* The channel is that of the map, or fallback (TEXTURE_GREY, ..). */
scalar_lut scalar_lut_make(const texture_baker *baker, const legacy_map *map, float factor, int fallback);

void color_lut_mean(const color_lut *t, const texture_baker *baker, const legacy_map *map, float out[3]);
float scalar_lut_mean(const scalar_lut *t, const texture_baker *baker, const legacy_map *map);
/* Of the codes that occur in the map: */
void color_lut_highest(const color_lut *t, const texture_baker *baker, const legacy_map *map, float out[3]);
float scalar_lut_highest(const scalar_lut *t, const texture_baker *baker, const legacy_map *map);
float scalar_lut_lowest(const scalar_lut *t, const texture_baker *baker, const legacy_map *map);

/* Whether texels are used unmodified: no -mm, no -imfchan. */
bool map_is_plain(const legacy_map *map);
/* The channel of an opacity map: the stated one, else alpha if the image has it, else grey. */
int map_opacity_channel(const texture_baker *baker, const legacy_map *map);
/* Whether two textures have the same lookup: set, transform and wrap. */
bool map_refs_agree(const facet_scene *scene, const scene_texture_ref *a, const scene_texture_ref *b);

#endif
