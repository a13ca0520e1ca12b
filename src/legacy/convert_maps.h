/* convert_maps.h - the maps of legacy materials as tables from 8-bit codes to numbers, and what they are on average. */
#ifndef LEGACY_CONVERT_MAPS_H
#define LEGACY_CONVERT_MAPS_H

#include "legacy/texture_bench.h"
#include "scene/legacy.h"

/* A color by texel: value k is values[k][code of channel channels[k]]. All floats and ints: no padding, so that it can be
 * part of a bake's key. */
typedef struct color_table {
    int channels[3]; /* TEXTURE_RED .. TEXTURE_GREY */
    float values[3][256];
} color_table;

typedef struct scalar_table {
    int channel;
    float values[256];
} scalar_table;

/* 255 where there is no texel: tables of maps that are absent hold the factor everywhere. */
static inline uint8_t table_code(const uint8_t *texel, int channel)
{
    return !texel ? 255 : channel == TEXTURE_GREY ? texture_grey(texel) : texel[channel];
}
static inline float table_scalar(const scalar_table *t, const uint8_t *texel)
{
    return t->values[table_code(texel, t->channel)];
}
static inline void table_color(const color_table *t, const uint8_t *texel, float out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = t->values[k][table_code(texel, t->channels[k])];
}

/* Factor times the map's texels; pictures are sRGB whatever the factors of a file are. factor linear. */
color_table color_table_make(const texture_bench *bench, const legacy_map *map, const float factor[3]);
/* The channel is the map's, or fallback (TEXTURE_GREY, ..). */
scalar_table scalar_table_make(const texture_bench *bench, const legacy_map *map, float factor, int fallback);

void color_table_mean(const color_table *t, const texture_bench *bench, const legacy_map *map, float out[3]);
float scalar_table_mean(const scalar_table *t, const texture_bench *bench, const legacy_map *map);
/* Of the codes that occur in the map. */
void color_table_highest(const color_table *t, const texture_bench *bench, const legacy_map *map,
                         float out[3]);
float scalar_table_highest(const scalar_table *t, const texture_bench *bench, const legacy_map *map);
float scalar_table_lowest(const scalar_table *t, const texture_bench *bench, const legacy_map *map);

/* Whether texels count as they are: no -mm, no -imfchan. */
bool map_is_plain(const legacy_map *map);
/* The channel that an opacity map is read from: what it says; alpha where it has some; grey. */
int map_opacity_channel(const texture_bench *bench, const legacy_map *map);
/* Whether two textures look up the same place: set, transform and wrap. */
bool map_refs_agree(const facet_scene *scene, const scene_texture_ref *a, const scene_texture_ref *b);

#endif
