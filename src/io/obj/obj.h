/* obj.h - reads and writes Wavefront OBJ with its MTL files. */
#ifndef IO_OBJ_H
#define IO_OBJ_H

#include "scene/legacy.h"

/* Whether the first statement of bytes is one of OBJ. */
bool obj_detect(const void *bytes, size_t size);
/* Whether there are a vertex line and a face, line or point line, after any other lines. */
bool obj_has_faces(const void *bytes, size_t size);

/* Reads an OBJ file: geometry and, through mtl.h, scene->legacy; the glTF materials have default values
 * and the names of the legacy ones, for legacy_convert(). One node and mesh per object (o, or g in files
 * without o), with one primitive per material. Texture coordinates as in glTF (v down). */
facet_result obj_load(const char *path, const facet_scene_desc *desc, facet_scene **scene,
                      facet_error *error);
/* From bytes, which are copied where the scene needs them; other files need desc->root. */
facet_result obj_load_memory(const void *bytes, size_t size, const char *name, const facet_scene_desc *desc,
                             facet_scene **scene, facet_error *error);

/* Writes the default scene at rest as OBJ, scene->legacy as an MTL file of the same name, and the images
 * of its maps, all or nothing. Needs scene->legacy. */
facet_result obj_save(const facet_scene *scene, const char *path, const char *generator,
                      const facet_scene_save_desc *desc, facet_error *error);

#endif
