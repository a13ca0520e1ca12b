/* ogl1_setup.h - what drawing with FACET_SHADING_OGL1 takes, found once per picture: rules, lights in eye space, fog,
 * materials. */
#ifndef DRAW_OGL1_SETUP_H
#define DRAW_OGL1_SETUP_H

#include "draw/light_setup.h"
#include "draw/material_plan.h"

#include "shade/shade.h"

/* A legacy material as it is computed with. */
typedef struct ogl1_material {
    const legacy_material *legacy;
    PhongMaterial phong;
    /* The diffuse map is laid over all of the light, as glTexEnv has it; false: it multiplies the diffuse color, as
     * MTL and glTF have it. */
    bool has_texture_over_light;
} ogl1_material;

typedef struct ogl1_setup {
    PhongRules rules;
    bool is_encoded;      /* computed with the display's numbers; false: with linear light */
    bool are_colors_srgb; /* how colors of legacy materials become linear light; false: they are */
    bool has_rgl_colors;  /* scene_legacy.is_rgl */
    mat3 view;            /* world to eye space: view p + translation */
    vec3 translation;
    uint32_t light_count; /* 0: those of the light_setup shine */
    PhongLight *lights;
    PhongFog fog;
    ogl1_material *materials; /* by render_geometry.material_id */
} ogl1_setup;

/* What a picture is of, prepared to be drawn with legacy materials. */
typedef struct ogl1_source {
    const facet_scene *scene;
    const scene_pose *pose;
    const render_geometry_set *geometries;
    const legacy_material *fallback; /* of primitives without a material */
} ogl1_source;

/* Sets legacy_maps of plans as well (NULL: not wanted). source: lives as long as what comes out. Fails with FACET_ERROR_MEMORY. */
facet_result ogl1_setup_create(const ogl1_source *source, const camera_rays *camera,
                               const facet_render_desc *desc, const light_setup *light,
                               material_plan_set *plans, ogl1_setup *out, facet_error *error);
void ogl1_setup_destroy(ogl1_setup *setup); /* {0} is allowed */

/* Whether desc can be drawn with the scene's legacy materials; FACET_ERROR_ARGUMENT says why not. */
facet_result ogl1_check(const facet_scene *scene, const facet_render_desc *desc, facet_error *error);

/* Linear light (vertex colors, lamps) as numbers that are computed with, and back. */
static inline vec3 ogl1_from_linear(const ogl1_setup *s, vec3 linear)
{
    return s->is_encoded && s->are_colors_srgb ? srgb_from_linear(linear) : linear;
}
static inline vec3 ogl1_to_linear(const ogl1_setup *s, vec3 computed)
{
    return s->is_encoded && s->are_colors_srgb ? linear_from_srgb(computed) : computed;
}
/* The picture's numbers as light: what a display makes of encoded ones. */
static inline vec3 ogl1_displayed(const ogl1_setup *s, vec3 computed)
{
    return s->is_encoded ? linear_from_srgb(clamp(computed, 0.0f, 1.0f)) : computed;
}

/* ---- maps: which textures of a legacy material are read, and what they hold ---- */

/* Bits of legacy_map_slot that a shade of a geometry with a legacy material looks up, whether there are tangents or not.
 * Pipelines that light at vertices have textures of color and opacity only. */
uint32_t ogl1_maps(const render_geometry *g, facet_ogl1_variant variant);
/* The same of a geometry as it is: without tangents, bumps are not read. */
uint32_t ogl1_drawn_maps(const render_geometry *g, facet_ogl1_variant variant);
/* Whether a map is decoded from sRGB: colors, where light is linear. Others are the file's numbers. */
bool ogl1_map_is_color(const legacy_material *m, legacy_map_slot slot, bool is_linear);
/* Whether a map is looked up by the reflected view and not by texture coordinates. */
bool ogl1_map_is_spherical(const legacy_material *m, legacy_map_slot slot);
/* A texel's value of a map that holds one number: of the channel that -imfchan names (luminance where it names none),
 * then base + gain value. */
float ogl1_map_scalar(const legacy_map *map, const float texel[4]);

#endif
