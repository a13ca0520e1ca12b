/* path_key.h - what identifies an image: its checkpoints and its parts bear it. */
#ifndef PATH_PATH_KEY_H
#define PATH_PATH_KEY_H

#include "facet/facet.h"

struct prepared_scene; /* cpu/prepared_scene.h */

/* Identifies an image: 64 hex digits. */
typedef struct path_key {
    char hex[65];
} path_key;

/* A hash of all that a sample depends on: the model's description and vertices, camera, size, light, and
 * desc without the number of samples, limits and what is done after sampling. Fails with
 * FACET_ERROR_MEMORY, and as the pose. */
facet_result path_key_create(struct prepared_scene *p, const facet_render_desc *desc, path_key *out,
                             facet_error *error);

#endif
