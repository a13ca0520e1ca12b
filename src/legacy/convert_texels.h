/* convert_texels.h - what bakes do with one texel of diffuse, specular, shininess and opacity maps, and grids of fits for them. */
#ifndef LEGACY_CONVERT_TEXELS_H
#define LEGACY_CONVERT_TEXELS_H

#include "legacy/convert_maps.h"
#include "legacy/fit.h"

/* The order of a bake's inputs. */
enum { TEXEL_DIFFUSE, TEXEL_SPECULAR, TEXEL_SHININESS, TEXEL_OPACITY, TEXEL_INPUTS };

/* Specular and ior of one texel: what ogl1_to_pbr_closed() comes near to, quick. */
pbr_surface texel_surface(const ogl1_surface *in);

/* The core profile, whose search for metallic is slow: a grid of its answers for grey materials over Cd, Cs and s.
 * Nodes of Cd and Cs lie at (i / last)^2, those of s evenly in log(1 + s). */
enum { CORE_COLORS = 17, CORE_EXPONENTS = 9 };
typedef struct core_grid {
    float exponents[2];                                   /* log(1 + s) of the first and last */
    float base[CORE_EXPONENTS][CORE_COLORS][CORE_COLORS]; /* by s, Cs, Cd */
    float metallic[CORE_EXPONENTS][CORE_COLORS][CORE_COLORS];
    float perceptual_roughness[CORE_EXPONENTS][CORE_COLORS][CORE_COLORS];
} core_grid;
void core_grid_make(core_grid *grid, float least_shininess, float most_shininess, uint32_t thread_count);
/* Metallic and roughness of the mean channel, a base color for each. */
pbr_surface core_grid_look_up(const core_grid *grid, const ogl1_surface *in);

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
    const core_grid *core; /* last: of the shininess table, and so no part of the key */
} texel_parameters;
#define TEXEL_KEY_SIZE offsetof(texel_parameters, core)

texture_row texel_base_row;      /* RGB or RGBA: base color, opacity */
texture_row texel_specular_row;  /* RGBA: color of F0, its strength */
texture_row texel_roughness_row; /* RGB: 1, roughness, metallic */

/* Roughness, metallic and occlusion of scalar maps: inputs 0, 1 and 0. */
typedef struct packed_parameters {
    scalar_table roughness, metallic, occlusion;
} packed_parameters;
texture_row texel_packed_row; /* RGB: occlusion, roughness, metallic */

uint8_t texel_code(float value); /* [0, 1] to the nearest code */

/* ---- the fit to OpenGL 1 at one shininess, on a grid for the texels of a material ---- */

/* Nodes of base color lie at (i / last)^2, of roughness evenly; of the second axis evenly for metallic and at
 * (i / last)^2 for the specular color of a specular-glossiness material. */
enum { OGL1_GRID_BASE = 9, OGL1_GRID_SECOND = 7, OGL1_GRID_ROUGHNESS = 13 };

typedef struct ogl1_grid {
    pbr_surface factors; /* ior, specular and specular color of all texels */
    float shininess;
    bool is_glossy; /* the second axis is the specular color, not metallic */
    /* square roots of colors */
    float diffuse[OGL1_GRID_ROUGHNESS][OGL1_GRID_SECOND][OGL1_GRID_BASE];
    float specular[OGL1_GRID_ROUGHNESS][OGL1_GRID_SECOND][OGL1_GRID_BASE];
} ogl1_grid;

/* target: any but _AUTO. The specular color of factors is gray where it is not the second axis. Fails with
 * FACET_ERROR_MEMORY. */
facet_result ogl1_grid_make(const facet_allocator *allocator, uint32_t thread_count,
                            const pbr_surface *factors, float shininess, bool is_glossy,
                            facet_legacy_target target, ogl1_grid **out, facet_error *error);
void ogl1_grid_destroy(ogl1_grid *grid); /* NULL is allowed */

/* Colors of a surface, channel by channel; shininess is the grid's. */
void ogl1_grid_look_up(const ogl1_grid *grid, const pbr_surface *in, ogl1_surface *out);

#endif
