/* obj.h - reads and writes Wavefront OBJ with its MTL files. */
#ifndef IO_OBJ_H
#define IO_OBJ_H

#include "scene/legacy.h"

/* Whether bytes look like an OBJ file: its first statement is one of OBJ's. */
bool obj_detect(const void *bytes, size_t size);
/* Whether there is a line of a vertex and one of a face, line or point, whatever stands before them. */
bool obj_has_faces(const void *bytes, size_t size);

/* Reads an OBJ file: geometry and, through mtl.h, scene->legacy; the glTF materials are defaults with the names of the
 * legacy ones, for legacy_convert(). One node and mesh per object (o, or g where there is no o), one primitive per
 * material in it. Texture coordinates as glTF has them (v down). */
facet_result obj_load(const char *path, const facet_scene_desc *desc, facet_scene **scene,
                      facet_error *error);
/* From bytes, which are copied where the scene needs them; other files need desc->root. */
facet_result obj_load_memory(const void *bytes, size_t size, const char *name, const facet_scene_desc *desc,
                             facet_scene **scene, facet_error *error);

/* Writes what the default scene shows at rest as OBJ, scene->legacy as an MTL file of the same name, and the images
 * that its maps use. Needs scene->legacy. Whole or nothing. */
facet_result obj_save(const facet_scene *scene, const char *path, const char *generator,
                      const facet_scene_save_desc *desc, facet_error *error);

#endif
