/* material_texels.h - the textures of a material at a hit. Holds shared shading text: include it last. */
#ifndef CPU_MATERIAL_TEXELS_H
#define CPU_MATERIAL_TEXELS_H

#include "cpu/shading_hit.h"

/* RGBA by scene_texture_slot, white where there is no texture. */
typedef float material_texels[SCENE_TEXTURE_SLOT_COUNT][4];

/* Where a texture is read at a hit. */
shading_texcoord material_texture_coordinates(const shading_hit *h, const scene_texture_ref *ref);
/* Reads the textures whose bits are set in wanted, all of which the hit's material has; the
 * others of the first slot_count are white. */
void material_texels_read(const shading_scene *scene, const shading_hit *h, uint32_t wanted, int slot_count,
                          material_texels texels);
/* Reads one texture `step` footprints along their x (axis 0) or y (axis 1) away from the hit. */
void material_texel_beside(const shading_scene *scene, const shading_hit *h, scene_texture_slot slot,
                           int axis, float step, float texel[4]);

#endif
