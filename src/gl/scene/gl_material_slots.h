/* gl_material_slots.h - which textures a material's program reads, through which units: features of GL_MAIN_SURFACE
 * (gl_program.h) to samplers and texels of material.glsl. */
#ifndef GL_GL_MATERIAL_SLOTS_H
#define GL_GL_MATERIAL_SLOTS_H

#include "base/text.h"
#include "scene/scene.h"

/* Two slots that are often one texture in one file: the second one then reads the first one's texel. */
typedef struct gl_slot_pair {
    scene_texture_slot first, second;
} gl_slot_pair;

enum {
    GL_SLOT_PAIR_COUNT = 7,
    GL_MATERIAL_UNITS = 9 /* of the 16 that every OpenGL has, what is not the picture's */
};
extern const gl_slot_pair gl_slot_pairs[GL_SLOT_PAIR_COUNT];

/* Slots in the order in which they are given up where a material has more textures than there are units. */
extern const uint8_t gl_slots_by_loss[SCENE_TEXTURE_SLOT_COUNT];

/* The unit of each slot behind GL_UNIT_MATERIAL, -1: it is not read, or with the texel of another; returns how many
 * units are taken. */
int gl_material_slot_units(uint64_t features, int8_t units[SCENE_TEXTURE_SLOT_COUNT]);
/* Adds MATERIAL_LAYERS, the samplers "u_material0".., and BASE_COLOR_TEXEL and so on for every slot: a vec4, white where there is none. */
void gl_material_slot_text(uint64_t features, text *out);

#endif
