/* convert_ogl1_maps.h - textures of glTF materials as maps of legacy ones. */
#ifndef LEGACY_CONVERT_OGL1_MAPS_H
#define LEGACY_CONVERT_OGL1_MAPS_H

#include "legacy/convert_state.h"

/* Whether the statistics of a texture in that slot are needed. */
bool ogl1_reads_slot(scene_texture_slot slot);
/* The surface whose numbers a material is converted by: textures at their means. */
pbr_surface ogl1_representative(const conversion *c, const scene_material *m);
/* Whether textures do more than scale the base color of a dielectric. */
bool ogl1_needs_texels(const conversion *c, const scene_material *m);
/* Maps, and the factors that go with them. Fails with FACET_ERROR_MEMORY. */
facet_result ogl1_build_maps(conversion *c, uint32_t material, const scene_material *m,
                             const solve_item *item, legacy_material *out, facet_error *error);

#endif
