/* ogl1_maps.h - which textures of a legacy material are read, and what they hold at a hit. */
#ifndef DRAW_OGL1_MAPS_H
#define DRAW_OGL1_MAPS_H

#include "draw/render_geometry.h"

/* Bits of legacy_map_slot that a shade of a geometry with a legacy material looks up, whether there are tangents or not.
 * Pipelines that light at vertices have textures of color and opacity only. */
uint32_t ogl1_maps(const render_geometry *g, facet_ogl1_variant variant);
/* The same of a geometry as it is: without tangents, bumps are not read. */
uint32_t ogl1_drawn_maps(const render_geometry *g, facet_ogl1_variant variant);
/* Whether a map is decoded from sRGB: colors, where light is linear. Others are the file's numbers. */
bool ogl1_map_is_color(const legacy_material *m, legacy_map_slot slot, bool is_linear);
/* Whether a map is looked up by the reflected view and not by texture coordinates. */
bool ogl1_map_is_spherical(const legacy_material *m, legacy_map_slot slot);
/* A texel's value of a map that holds one number: of the channel that -imfchan names (luminance where it names none),
 * then base + gain value. */
float ogl1_map_scalar(const legacy_map *map, const float texel[4]);

#endif
