/* convert.h - converts the materials of a whole scene between models: factors, textures, lights, with
 * errors and warnings. Used by facet_scene_convert_materials() and facet_scene_load(). */
#ifndef LEGACY_CONVERT_H
#define LEGACY_CONVERT_H

#include "base/text.h"
#include "scene/legacy.h"

/* facet_scene_convert_materials(). Sets scene->conversion; new textures are PNG files in memory, appended
 * to the images and textures of the scene. A scene read from OBJ or rgl's parameters has legacy materials
 * and default glTF materials; FACET_MATERIAL_MODEL_METALLIC_ROUGHNESS fills the latter. Fails with
 * FACET_ERROR_MEMORY; a texture that cannot be decoded is a warning and counts as absent. */
facet_result legacy_convert(facet_scene *scene, facet_material_model to, const facet_legacy_desc *desc,
                            const facet_log *log, facet_error *error);

/* The report as a JSON object with "materials", "warnings", "summary"; see report_json.c. */
void legacy_report_json(const facet_scene *scene, text *out);

#endif
