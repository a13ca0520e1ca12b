/* material_plan.h - what shading a geometry needs, determined once per render from its material. */
#ifndef DRAW_MATERIAL_PLAN_H
#define DRAW_MATERIAL_PLAN_H

#include "draw/render_geometry.h"

/* Of one geometry. */
typedef struct material_plan {
    uint32_t textures;      /* bits of scene_texture_slot: what full shading reads */
    int slot_count;         /* slots that are read, with or without a texture */
    uint32_t layers;        /* LAYER_* of shade/layers.h that some of its points may have; 0: no layers */
    bool lets_rays_through; /* LAYER_TRANSMISSION */
    /* of coordinates over the footprint, for textures; of normals, for refraction */
    bool needs_derivatives;
    /* bits of legacy_map_slot: what shading of a legacy material reads; ogl1_setup.h */
    uint32_t legacy_maps;
    /* the boundary of a volume that rays pass through, not a thin wall: both sides are visible */
    bool is_volume;
    bool is_closed_volume;  /* the same, or of one that light enters diffusely */
    bool may_pass_straight; /* rays may pass through it without a change of direction */
} material_plan;

typedef struct material_plan_set {
    material_plan *items;   /* per geometry; block of mem_alloc() */
    bool lets_rays_through; /* some geometry */
    bool has_several_volumes;
    bool has_see_through; /* some geometry does not stop every ray that hits it: alpha mask or blend */
    bool has_closed_volumes;
    bool may_pass_straight; /* some geometry */
} material_plan_set;

/* Bits of the textures that shading of the geometry may read, with or without tangents. */
uint32_t material_plan_textures(const render_geometry *g);
/* LAYER_* that points of a lit geometry of that material may have. */
uint32_t material_plan_layers(const scene_material *m);
/* Needs the tangents of set. Those of geometries that are drawn with legacy materials are 0. Fails with
 * FACET_ERROR_MEMORY. */
facet_result material_plans_create(const render_geometry_set *set, const facet_allocator *allocator,
                                   material_plan_set *out, facet_error *error);
/* Whether the occlusion texture of a material is ignored: exporters name a roughness texture whose red is
 * empty, and without environment light the model would be black. lacks_red: of the texture's texels. */
bool material_plan_drops_occlusion(const scene_material *m, bool lacks_red);
/* Warns of that for material number material. */
void material_plan_warn_occlusion(const facet_scene *scene, uint32_t material, const facet_log *log);
void material_plans_destroy(material_plan_set *plans); /* {0} is allowed */

#endif
