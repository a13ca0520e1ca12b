/* path_key.h - which picture a checkpoint is of. */
#ifndef PATH_KEY_H
#define PATH_KEY_H

#include "cpu/prepared_scene.h"

typedef struct path_key {
    char hex[65];
} path_key;

/* A hash of all that a sample depends on: the model's description and vertices, camera, size, light, and what of desc is
 * neither the number of samples nor a limit nor done after sampling. Fails with FACET_ERROR_MEMORY, and as the pose. */
facet_result path_key_create(prepared_scene *p, const facet_render_desc *desc, path_key *out,
                             facet_error *error);

#endif
