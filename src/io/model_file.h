/* model_file.h - model files of every kind: told apart, read, written. */
#ifndef IO_MODEL_FILE_H
#define IO_MODEL_FILE_H

#include "scene/scene.h"

/* Reads a glTF, OBJ, STL, PLY or rgl parameter file, told apart by content (model_kind.h), as facet_scene_load() does but for desc->parameters and
 * the conversion of materials. */
facet_result model_file_load(const char *path, const facet_scene_desc *desc, facet_scene **scene,
                             facet_error *error);
facet_result model_file_load_memory(const void *bytes, size_t size, const char *name,
                                    const facet_scene_desc *desc, facet_scene **scene, facet_error *error);

/* facet_scene_save(): by the end of path. */
facet_result model_file_save(const facet_scene *scene, const char *path, const char *generator,
                             const facet_scene_save_desc *desc, facet_error *error);

#endif
