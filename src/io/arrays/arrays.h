/* arrays.h - makes a scene from arrays of the caller. */
#ifndef IO_ARRAYS_H
#define IO_ARRAYS_H

#include "scene/scene.h"

/* facet_scene_create() except for the last step after every reader (io/model_file.h). */
facet_result arrays_load(const facet_arrays_desc *arrays, const facet_scene_desc *desc, facet_scene **scene,
                         facet_error *error);
/* facet_material_default() */
facet_material arrays_material_default(void);

#endif
