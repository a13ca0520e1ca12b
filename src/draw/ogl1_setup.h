/* ogl1_setup.h - what drawing with FACET_SHADING_OGL1 needs, determined once per image: modes, lights in eye
 * space, fog, materials. */
#ifndef DRAW_OGL1_SETUP_H
#define DRAW_OGL1_SETUP_H

#include "draw/light_setup.h"
#include "draw/material_plan.h"

#include "shade/shade.h"

/* A legacy material in the values of the computation. */
typedef struct ogl1_material {
    const legacy_material *legacy;
    PhongSurface surface;
} ogl1_material;

typedef struct ogl1_setup {
    PhongFrame frame;
    mat3 view; /* world to eye space: view p + translation */
    vec3 translation;
    uint32_t light_count; /* 0: those of the light_setup are used */
    PhongLight *lights;
    ogl1_material *materials; /* by render_geometry.material_id */
} ogl1_setup;

/* What is to be drawn with legacy materials. */
typedef struct ogl1_source {
    const facet_scene *scene;
    const scene_pose *pose;
    const render_geometry_set *geometries;
    const legacy_material *fallback; /* of primitives without a material */
} ogl1_source;

/* Sets legacy_maps of plans as well (NULL: not wanted). source must outlive the result. Fails with
 * FACET_ERROR_MEMORY. */
facet_result ogl1_setup_create(const ogl1_source *source, const camera_rays *camera,
                               const facet_render_desc *desc, const light_setup *light,
                               material_plan_set *plans, ogl1_setup *out, facet_error *error);
void ogl1_setup_destroy(ogl1_setup *setup); /* {0} is allowed */

/* Whether desc can be drawn with the scene's legacy materials; FACET_ERROR_ARGUMENT says why not. */
facet_result ogl1_check(const facet_scene *scene, const facet_render_desc *desc, facet_error *error);

/* From the image's values to light: encoded ones as a display shows them. */
static inline vec3 ogl1_displayed(const ogl1_setup *s, vec3 computed)
{
    return s->frame.is_encoded ? linear_from_srgb(clamp(computed, 0.0f, 1.0f)) : computed;
}

/* ---- maps: which textures of a legacy material are read, and what they contain ---- */

/* The slot of each PHONG_*_MAP. */
extern const legacy_map_slot ogl1_map_slots[PHONG_MAP_COUNT];

/* Bits of legacy_map_slot that shading of a geometry with a legacy material reads, with or without tangents.
 * Pipelines with lighting at vertices have textures of color and opacity only. */
uint32_t ogl1_maps(const render_geometry *g, facet_ogl1_variant variant);
/* The same of a geometry as it is: without tangents, bump maps are not read. */
uint32_t ogl1_drawn_maps(const render_geometry *g, facet_ogl1_variant variant);
/* Whether a map is decoded from sRGB: colors, where light is linear. Others are the file's values. */
bool ogl1_map_is_color(const legacy_material *m, legacy_map_slot slot, bool is_linear);
/* Whether a map is looked up by the reflection vector instead of texture coordinates. */
bool ogl1_map_is_spherical(const legacy_material *m, legacy_map_slot slot);
/* The value of a scalar map at a texel: the channel that -imfchan names (luminance where it names none),
 * then base + gain value. */
float ogl1_map_scalar(const legacy_map *map, const float texel[4]);

#endif
