/* sea.h - what a facet_sea holds; its presets; what other renderers take of it: maps of its tiles and a mesh. */
#ifndef OCEAN_SEA_H
#define OCEAN_SEA_H

#include "facet/facet.h"
#include "ocean/water_optics.h"
#include "ocean/waves.h"

struct facet_sea {
    facet_sea_desc desc;
    waves waves;
    slope_filter slopes;
    foam_rule foam;
    water_optics optics;
    uint64_t serial; /* unique in the process, from 1: caches recognize the sea by it */
};

/* Legacy styles, and the first steps from there: what they shade is for a display as it is, whatever the exposure. */
static inline bool sea_shading_is_legacy(const facet_sea_shading *s)
{
    return s->style != FACET_SEA_STYLE_PHYSICAL || s->stage == 1 || s->stage == 2;
}
/* All steps: with foam, glints and caustics. */
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
/* FACET_ERROR_ARGUMENT: no such name; the sentence lists those there are. */
facet_result sea_preset(const char *name, facet_sea_desc *desc, facet_error *error);

/* Of one texel; see facet_sea_create_maps(). */
typedef struct sea_texel {
    float displacement[3]; /* m: along the tile's x, upwards, along its z */
    float normal[3];
    float slope[2];
    float jacobian;
    float foam; /* [0, 1] */
} sea_texel;

/* Variance of the convergence that the other tiles have. */
float sea_others_variance(const facet_sea *sea, uint32_t tile);
/* Texel number (column, row) of a tile that is there, by its waves alone; foam by what the others, with that variance, may add. */
sea_texel sea_texel_of(const facet_sea *sea, uint32_t tile, float others_variance, uint32_t column,
                       uint32_t row);

/* See facet_sea_create_mesh(). */
facet_result sea_mesh_create(const facet_sea *sea, const facet_sea_mesh_desc *desc, facet_scene **out,
                             facet_error *error);

#endif
