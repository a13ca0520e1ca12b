/* convert_ogl1_grid.h - the fit to OpenGL 1 at one shininess, made once on a grid for the texels of a material. */
#ifndef LEGACY_CONVERT_OGL1_GRID_H
#define LEGACY_CONVERT_OGL1_GRID_H

#include "legacy/fit.h"

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
