/* ogl1_json.h - rgl's parameters of materials, lights and fog as JSON; docs/r.md has the members. */
#ifndef IO_OGL1_JSON_H
#define IO_OGL1_JSON_H

#include "base/text.h"
#include "scene/legacy.h"

/* Whether bytes are such a file: a JSON object with "materials", "material3d" or "facet" and nothing that glTF has beside
 * them, "asset" or "meshes". */
bool ogl1_json_detect(const void *bytes, size_t size);

/* A scene of balls, one per material, in a grid that fits a picture; with its lights and fog in scene->legacy and
 * glTF materials at their defaults, for legacy_convert(). */
facet_result ogl1_json_load(const char *path, const facet_scene_desc *desc, facet_scene **scene,
                            facet_error *error);
facet_result ogl1_json_load_memory(const void *bytes, size_t size, const char *name,
                                   const facet_scene_desc *desc, facet_scene **scene, facet_error *error);

/* Lays the parameters of the file at path over a scene that was read: each entry takes the place of the legacy material
 * of its name, or becomes that of the objects that it names: nodes with what is below them, or meshes. An entry without
 * either goes to all. The more specific wins: objects before names before all; of equals the last. Entries that meet
 * nothing are warnings. Lights and fog replace the scene's legacy ones. Where a scene of glTF materials is not met, its
 * own stay (is_gltf_restored). On failure the scene is good for scene_destroy() only. */
facet_result ogl1_json_overlay(facet_scene *scene, const char *path, const facet_scene_desc *desc,
                               facet_error *error);

/* scene->legacy as text; image_names as for mtl_write(), NULL: none is written. Read again, it is equal. */
void ogl1_json_write(const facet_scene *scene, const char *generator, const char *const *image_names,
                     text *out);
facet_result ogl1_json_save(const facet_scene *scene, const char *path, const char *generator,
                            const facet_scene_save_desc *desc, facet_error *error);

/* A color as R knows it: "#rrggbb", "#rrggbbaa", "steelblue", "gray10", "transparent"; [0, 1] as displayed. */
bool ogl1_find_r_color(const char *name, float rgba[4]);

#endif
