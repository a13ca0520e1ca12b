/* sea.h - a facet_sea, its presets, and its export to other renderers as maps and as a mesh. */
#ifndef OCEAN_SEA_H
#define OCEAN_SEA_H

#include "facet/facet.h"
#include "ocean/water_optics.h"
#include "ocean/waves.h"

#include "shade/shade.h"

struct facet_sea {
    facet_sea_desc desc;
    waves waves;
    slope_filter slopes;
    foam_rule foam;
    water_optics optics;
    uint64_t serial; /* unique in the process, from 1: caches recognize the sea by it */
};

/* Whether it is a legacy style or one of the first steps from there, whose result is display-referred and
 * ignores the exposure. */
static inline bool sea_shading_is_legacy(const facet_sea_shading *s)
{
    return s->style != FACET_SEA_STYLE_PHYSICAL || s->stage == 1 || s->stage == 2;
}
/* Whether all steps are taken: with foam, glints and caustics. */
static inline bool sea_shading_is_complete(const facet_sea_shading *s)
{
    return s->style == FACET_SEA_STYLE_PHYSICAL && (s->stage == 0 || s->stage == 5);
}

/* See facet_sea_create() and facet_sea_destroy(). */
facet_result sea_create(const facet_sea_desc *desc, facet_sea **sea, facet_error *error);
void sea_destroy(facet_sea *sea); /* NULL is allowed */
/* See facet_sea_camera(). */
facet_camera sea_camera(const facet_sea *sea, float height_m, float azimuth_rad);

/* See facet_sea_default(). */
facet_sea_desc sea_default(void);

uint32_t sea_preset_count(void);
const char *sea_preset_name(uint32_t index); /* NULL: there is none */
/* FACET_ERROR_ARGUMENT: no such name; the message lists the names. */
facet_result sea_preset(const char *name, facet_sea_desc *desc, facet_error *error);

/* A texel; see facet_sea_create_maps(). */
typedef struct sea_texel {
    float displacement[3]; /* m: along the tile's x, upwards, along its z */
    float normal[3];
    float slope[2];
    float jacobian;
    float foam; /* [0, 1] */
} sea_texel;

/* Variance of the convergence of all other tiles. */
float sea_others_variance(const facet_sea *sea, uint32_t tile);
/* Texel (column, row) of a tile, by its own waves; foam also by what the other tiles may add, given their
 * variance. */
sea_texel sea_texel_of(const facet_sea *sea, uint32_t tile, float others_variance, uint32_t column,
                       uint32_t row);

/* The shading style as the shader library has it. */
static inline WaterStyle sea_water_style(const facet_sea_shading *shading)
{
    float given = shading->perceptual_roughness;
    return (WaterStyle){.variant = shading->style == FACET_SEA_STYLE_LEGACY_WRITTEN ? WATER_LEGACY_WRITTEN
                                                                                    : WATER_LEGACY_INTENDED,
                        .stage = shading->style != FACET_SEA_STYLE_PHYSICAL ? WATER_LEGACY_STAGE_NONE
                                 : shading->stage == 1                      ? WATER_LEGACY_STAGE_FRESNEL
                                                       : WATER_LEGACY_STAGE_COOK_TORRANCE,
                        .perceptual_roughness = given > 0.0f ? given : WATER_LEGACY_ROUGHNESS,
                        .has_foam = !shading->omits_foam,
                        .has_sparkles = !shading->omits_glints};
}

/* See facet_sea_create_mesh(). */
facet_result sea_mesh_create(const facet_sea *sea, const facet_sea_mesh_desc *desc, facet_scene **out,
                             facet_error *error);

#endif
