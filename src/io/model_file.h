/* model_file.h - reads and writes model files of every format. */
#ifndef IO_MODEL_FILE_H
#define IO_MODEL_FILE_H

#include "scene/scene.h"

/* facet_scene_load() except for desc->parameters and the conversion of materials: reads a glTF, OBJ, STL,
 * PLY or rgl parameter file, which is recognized by content (model_kind.h). */
facet_result model_file_load(const char *path, const facet_scene_desc *desc, facet_scene **scene,
                             facet_error *error);
facet_result model_file_load_memory(const void *bytes, size_t size, const char *name,
                                    const facet_scene_desc *desc, facet_scene **scene, facet_error *error);

/* facet_scene_create() */
facet_result model_file_create(const facet_arrays_desc *arrays, const facet_scene_desc *desc,
                               facet_scene **scene, facet_error *error);

/* facet_scene_save(): the format follows from the file extension. */
facet_result model_file_save(const facet_scene *scene, const char *path, const char *generator,
                             const facet_scene_save_desc *desc, facet_error *error);

#endif
