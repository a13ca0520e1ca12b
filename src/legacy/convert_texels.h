/* convert_texels.h - what bakes do with one texel of diffuse, specular, shininess and opacity maps. */
#ifndef LEGACY_CONVERT_TEXELS_H
#define LEGACY_CONVERT_TEXELS_H

#include "legacy/convert_maps.h"
#include "legacy/fit.h"

/* The order of a bake's inputs. */
enum { TEXEL_DIFFUSE, TEXEL_SPECULAR, TEXEL_SHININESS, TEXEL_OPACITY, TEXEL_INPUTS };

/* Tables of the four maps, and what comes out is divided by. Part of a bake's key: memset() before it is filled in. */
typedef struct texel_parameters {
    color_table diffuse, specular;
    scalar_table shininess; /* s by code, for the core profile */
    scalar_table roughness; /* r(s) */
    scalar_table share;     /* F0 / Cs */
    scalar_table opacity;
    float base_scale[3], specular_scale;
    int is_core;
    int channel_count; /* of the base color: 3, or 4 with opacity */
    const srgb_tables *srgb;
} texel_parameters;

texture_row texel_base_row;      /* RGB or RGBA: base color, opacity */
texture_row texel_specular_row;  /* RGBA: color of F0, its strength */
texture_row texel_roughness_row; /* RGB: 1, roughness, metallic */

/* Roughness, metallic and occlusion of scalar maps: inputs 0, 1 and 0. */
typedef struct packed_parameters {
    scalar_table roughness, metallic, occlusion;
} packed_parameters;
texture_row texel_packed_row; /* RGB: occlusion, roughness, metallic */

uint8_t texel_code(float value); /* [0, 1] to the nearest code */

#endif
