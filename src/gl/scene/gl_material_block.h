/* gl_material_block.h - the uniform block of a material. */
#ifndef GL_GL_MATERIAL_BLOCK_H
#define GL_GL_MATERIAL_BLOCK_H

#include "scene/scene.h"

/* The block Material of material.glsl (std140): factors and the transforms of texture coordinates. */
typedef struct gl_material_block {
    float base_color[4];
    float emissive[3], alpha_cutoff; /* emissive: factor times strength */
    float specular_color[3], specular;
    float metallic, perceptual_roughness, ior, glossiness;
    float normal_scale, occlusion_strength, clearcoat_normal_scale, transmission;
    float clearcoat, clearcoat_roughness, anisotropy, anisotropy_rotation;
    float iridescence, iridescence_ior, iridescence_thickness_minimum, iridescence_thickness_maximum;
    float sheen_color[3], sheen_roughness;
    float attenuation_color[3], attenuation_distance;
    float diffuse_transmission_color[3], diffuse_transmission;
    float multiscatter_color[3], scatter_anisotropy;
    float thickness, dispersion, row, diffuse_roughness; /* row: in the table of gl_rays.h */
    float texcoords[SCENE_TEXTURE_SLOT_COUNT][2]
                   /* per slot: rows of the transform; w: texture coordinate set; 1: anisotropic probes */
                   [4];
} gl_material_block;

/* Fills all but the row. */
void gl_material_block_fill(const facet_scene *scene, const scene_material *material, gl_material_block *out);

#endif
