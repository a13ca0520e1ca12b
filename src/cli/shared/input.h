/* input.h - models from files, standard input, or built in. */
#ifndef CLI_INPUT_H
#define CLI_INPUT_H

#include "facet/facet.h"

/* How messages call an input: its path, "stdin" for -, "built-in scene" for NULL. */
const char *input_name(const char *path);

/* Loads the model path; - is standard input, NULL the built-in scene. Memory for standard input
 * comes from desc->allocator, which must be one. Fails as facet_scene_load(), and with FACET_ERROR_ARGUMENT for a name
 * that is empty. */
facet_result input_load(const char *path, const facet_scene_desc *desc, facet_scene **scene,
                        facet_error *error);

/* Loads a picture; - is standard input. Memory and failures as above. */
facet_result input_load_image(const char *path, const facet_image_load_desc *desc, facet_image **image,
                              facet_error *error);

/* Loads an environment; - is standard input. Memory and failures as above. */
facet_result input_load_environment(const char *path, const facet_environment_desc *desc,
                                    facet_environment **environment, facet_error *error);

/* Whether both paths are there and are the same file. */
bool input_is_same_file(const char *a, const char *b);

#endif
