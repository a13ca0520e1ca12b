/* ogl1_json.h - rgl's parameters of materials, lights and fog as JSON; docs/r.md has the members. */
#ifndef IO_OGL1_JSON_H
#define IO_OGL1_JSON_H

#include "base/text.h"
#include "scene/legacy.h"

/* Whether bytes are such a file: a JSON object with "materials" or "material3d" and without "asset". */
bool ogl1_json_detect(const void *bytes, size_t size);

/* A scene of balls, one per material, in a grid that fits a picture; with its lights and fog in scene->legacy and
 * glTF materials at their defaults, for legacy_convert(). */
facet_result ogl1_json_load(const char *path, const facet_scene_desc *desc, facet_scene **scene,
                            facet_error *error);
facet_result ogl1_json_load_memory(const void *bytes, size_t size, const char *name,
                                   const facet_scene_desc *desc, facet_scene **scene, facet_error *error);

/* Lays the parameters of the file at path over a scene that was read: each entry takes the place of the legacy material of
 * its name, or of those of the objects (nodes or meshes) that it names; an entry without either goes to all. Entries that
 * meet nothing are warnings. Lights and fog replace the scene's legacy ones. A scene without legacy materials gets
 * them first for the materials that are met. */
facet_result ogl1_json_overlay(facet_scene *scene, const char *path, const facet_scene_desc *desc,
                               facet_error *error);

/* scene->legacy as text; image_names as for mtl_write(). */
void ogl1_json_write(const facet_scene *scene, const char *generator, const char *const *image_names,
                     text *out);
facet_result ogl1_json_save(const facet_scene *scene, const char *path, const char *generator,
                            const facet_scene_save_desc *desc, facet_error *error);

/* A color as R knows it: "#rrggbb", "#rrggbbaa", "steelblue", "gray10", "transparent"; [0, 1] as displayed. */
bool r_color_find(const char *name, float rgba[4]);

#endif
