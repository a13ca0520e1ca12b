/* gl_phong_block.h - uniform blocks of OpenGL 1's shading, as phong.glsl has them (std140). Holds shared shading text: include
 * it last. */
#ifndef GL_GL_PHONG_BLOCK_H
#define GL_GL_PHONG_BLOCK_H

#include "draw/ogl1_setup.h"

enum {
    GL_PHONG_LIGHTS = 64, /* OpenGL 1 promises eight */
    GL_PHONG_MAPS = 7     /* that are read; units and features have their order */
};
extern const legacy_map_slot gl_phong_slots[GL_PHONG_MAPS];

/* Of a picture. */
typedef struct gl_phong_picture {
    float view[3][4]; /* rows: world to eye space */
    int32_t variant, is_encoded, are_colors_srgb, light_count;
    float global_ambient[3], has_rgl_colors;
    float fog_color[3], fog_mode;
    float fog_near, fog_far, fog_scale, fog_w;
    float lights[GL_PHONG_LIGHTS][4][4]; /* position, 1 a point light; ambient; diffuse; specular */
} gl_phong_picture;

/* Of a material. */
typedef struct gl_phong_material {
    float ambient[3], shininess;
    float diffuse[3], opacity;
    float specular[3], texture_type;
    float emission[3], texture_mode;
    float has_texture_over_light, is_halo, has_fog, bump_multiplier;
    float maps[GL_PHONG_MAPS][3][4]; /* rows of the transform, w: the set, 1 trilinear; base, gain, channel */
} gl_phong_material;

/* variant: as the render asks for. At most GL_PHONG_LIGHTS lights. */
void gl_phong_picture_fill(const ogl1_setup *setup, facet_ogl1_variant variant, gl_phong_picture *out);
void gl_phong_material_fill(const facet_scene *scene, const ogl1_material *m, gl_phong_material *out);

#endif
