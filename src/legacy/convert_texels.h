/* convert_texels.h - conversion of single texels of diffuse, specular, shininess and opacity maps, and
 * grids of fits for them. */
#ifndef LEGACY_CONVERT_TEXELS_H
#define LEGACY_CONVERT_TEXELS_H

#include "legacy/convert_maps.h"
#include "legacy/fit.h"

/* Inputs of a bake. */
enum { TEXEL_DIFFUSE, TEXEL_SPECULAR, TEXEL_SHININESS, TEXEL_OPACITY, TEXEL_INPUTS };

/* Specular and ior of one texel: a fast approximation of ogl1_to_pbr_closed(). */
pbr_surface texel_surface(const ogl1_surface *in);

/* The core profile, whose search for metallic is slow, on a grid over Cd, Cs and s for grey materials.
 * Nodes of Cd and Cs are at (i / last)^2, those of s even in log(1 + s). */
enum { CORE_COLORS = 17, CORE_EXPONENTS = 9 };
typedef struct core_grid {
    float exponents[2];                                   /* log(1 + s) of the first and last */
    float base[CORE_EXPONENTS][CORE_COLORS][CORE_COLORS]; /* by s, Cs, Cd */
    float metallic[CORE_EXPONENTS][CORE_COLORS][CORE_COLORS];
    float perceptual_roughness[CORE_EXPONENTS][CORE_COLORS][CORE_COLORS];
} core_grid;
void core_grid_make(core_grid *grid, float least_shininess, float most_shininess, uint32_t thread_count);

/* LUTs of the four maps, and divisors of the results. Part of the key of a bake: memset() before filling. */
typedef struct texel_parameters {
    color_lut diffuse, specular;
    scalar_lut shininess; /* s by code, for the core profile */
    scalar_lut roughness; /* r(s) */
    scalar_lut share;     /* F0 / Cs */
    scalar_lut opacity;
    float base_scale[3], specular_scale;
    int is_core;
    int channel_count; /* of the base color: 3, or 4 with opacity */
    const srgb_tables *srgb;
    const core_grid *core; /* last: determined by the shininess LUT, and no part of the key */
} texel_parameters;
#define TEXEL_KEY_SIZE offsetof(texel_parameters, core)

texture_row texel_base_row;      /* RGB or RGBA: base color, opacity */
texture_row texel_specular_row;  /* RGBA: color of F0, its strength */
texture_row texel_roughness_row; /* RGB: 1, roughness, metallic */

/* LUTs of roughness, metallic and occlusion: inputs 0, 1 and 0. */
typedef struct packed_parameters {
    scalar_lut roughness, metallic, occlusion;
} packed_parameters;
texture_row texel_packed_row; /* RGB: occlusion, roughness, metallic */

uint8_t texel_code(float value); /* nearest code of a value in [0, 1] */

/* ---- the fit to OpenGL 1 at one shininess, on a grid for the texels of a material ---- */

/* Nodes of the base color are at (i / last)^2, of roughness even; those of the second axis even for
 * metallic, at (i
 * / last)^2 for the specular color of a specular-glossiness material. */
enum { OGL1_GRID_BASE = 9, OGL1_GRID_SECOND = 7, OGL1_GRID_ROUGHNESS = 13 };

typedef struct ogl1_grid {
    pbr_surface factors; /* ior, specular and specular color of all texels */
    float shininess;
    bool is_glossy; /* the second axis is the specular color, not metallic */
    /* square roots of colors */
    float diffuse[OGL1_GRID_ROUGHNESS][OGL1_GRID_SECOND][OGL1_GRID_BASE];
    float specular[OGL1_GRID_ROUGHNESS][OGL1_GRID_SECOND][OGL1_GRID_BASE];
} ogl1_grid;

/* target: not _AUTO. The specular color of factors is gray unless it is the second axis. Fails with
 * FACET_ERROR_MEMORY. */
facet_result ogl1_grid_make(const facet_allocator *allocator, uint32_t thread_count,
                            const pbr_surface *factors, float shininess, bool is_glossy,
                            facet_legacy_target target, ogl1_grid **out, facet_error *error);
void ogl1_grid_destroy(ogl1_grid *grid); /* NULL is allowed */

/* Colors of a surface, per channel; shininess is that of the grid. */
void ogl1_grid_look_up(const ogl1_grid *grid, const pbr_surface *in, ogl1_surface *out);

#endif
