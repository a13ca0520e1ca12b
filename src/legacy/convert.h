/* convert.h - the materials of a whole scene from one model to another: factors, textures, lights, with errors and
 * warnings told. What facet_scene_convert_materials() and facet_scene_load() call. */
#ifndef LEGACY_CONVERT_H
#define LEGACY_CONVERT_H

#include "base/text.h"
#include "scene/legacy.h"

/* facet_scene_convert_materials(). Leaves scene->conversion; textures that it makes are PNG files in memory, appended to
 * the scene's images and textures. A scene read from OBJ or rgl's parameters comes with legacy materials and glTF
 * defaults; FACET_MATERIAL_MODEL_METALLIC_ROUGHNESS fills the latter. Fails with FACET_ERROR_MEMORY, _CANCELLED never; a
 * texture that cannot be decoded is a warning and counts as absent. */
facet_result legacy_convert(facet_scene *scene, facet_material_model to, const facet_legacy_desc *desc,
                            const facet_log *log, facet_error *error);

/* JSON of the report: an object with "materials" (reference 10), "warnings", "summary". */
void legacy_report_json(const facet_scene *scene, text *out);

/* The surface that a material has where its textures are 1; linear colors. */
struct ogl1_surface;
struct pbr_surface;
void legacy_surface_of_ogl1(const legacy_material *m, facet_legacy_colors colors, struct ogl1_surface *out);
void legacy_surface_of_pbr(const scene_material *m, struct pbr_surface *out);

#endif
