/* material_texels.h - the textures of a material at a hit. Holds shared shading text: include it last. */
#ifndef CPU_MATERIAL_TEXELS_H
#define CPU_MATERIAL_TEXELS_H

#include "cpu/shading_hit.h"

/* What a material's textures are for; their texels in this order. */
enum material_texture {
    BASE_COLOR,
    EMISSIVE,
    METALLIC_ROUGHNESS,
    NORMAL,
    OCCLUSION,
    SPECULAR,
    SPECULAR_COLOR,
    MATERIAL_TEXTURE_COUNT
};

enum { ALL_TEXTURES = (1 << MATERIAL_TEXTURE_COUNT) - 1 };

/* RGBA of each texture, white where there is none. */
typedef float material_texels[MATERIAL_TEXTURE_COUNT][4];

/* Reads the textures of the hit's material whose bits are set in wanted; the others are white. */
void material_texels_read(const shading_scene *scene, const shading_hit *h, uint32_t wanted,
                          material_texels texels);

#endif
