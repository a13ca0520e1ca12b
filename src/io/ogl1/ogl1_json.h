/* ogl1_json.h - rgl's parameters of materials, lights and fog as JSON; docs/r.md has the members. */
#ifndef IO_OGL1_JSON_H
#define IO_OGL1_JSON_H

#include "base/text.h"
#include "scene/legacy.h"

/* Whether bytes are such a file: a JSON object with "materials", "material3d" or "facet" and without
 * glTF's "asset" or "meshes". */
bool ogl1_json_detect(const void *bytes, size_t size);

/* A scene of one ball per material, in a grid with the aspect of an image; with the lights and fog in
 * scene->legacy and default glTF materials, for legacy_convert(). */
facet_result ogl1_json_load(const char *path, const facet_scene_desc *desc, facet_scene **scene,
                            facet_error *error);
facet_result ogl1_json_load_memory(const void *bytes, size_t size, const char *name,
                                   const facet_scene_desc *desc, facet_scene **scene, facet_error *error);

/* Applies the parameters of the file at path to a scene: each entry replaces the legacy material of its
 * name, or becomes that of the objects that it names: nodes with their descendants, or meshes. An entry
 * without either applies to everything. Objects take precedence over names, and names over entries for
 * everything; among equals the last is used. Unused entries are reported. Lights and fog replace the
 * scene's legacy ones. Materials of a glTF scene that no entry applies to stay (is_gltf_restored). After a
 * failure the scene can only be destroyed. */
facet_result ogl1_json_overlay(facet_scene *scene, const char *path, const facet_scene_desc *desc,
                               facet_error *error);

/* scene->legacy as text, which reads back equal; image_names as for mtl_write(), NULL: none. */
void ogl1_json_write(const facet_scene *scene, const char *generator, const char *const *image_names,
                     text *out);
facet_result ogl1_json_save(const facet_scene *scene, const char *path, const char *generator,
                            const facet_scene_save_desc *desc, facet_error *error);

/* A color in R's notation: "#rrggbb", "#rrggbbaa", "steelblue", "gray10", "transparent"; display-referred,
 * [0, 1]. */
bool ogl1_find_r_color(const char *name, float rgba[4]);

#endif
