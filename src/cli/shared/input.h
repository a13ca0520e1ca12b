/* input.h - loads models, images and environments from files, standard input, or built in. */
#ifndef CLI_INPUT_H
#define CLI_INPUT_H

#include "facet/facet.h"

/* Name of an input in messages: its path, "stdin" for -, "built-in scene" for NULL. */
const char *input_name(const char *path);

/* Loads a model; path - is standard input, NULL the built-in scene. Standard input needs memory of
 * desc->allocator, which must be set. Fails as facet_scene_load(), and with FACET_ERROR_ARGUMENT for an
 * empty name or an address. */
facet_result input_load(const char *path, const facet_scene_desc *desc, facet_scene **scene,
                        facet_error *error);

/* The same for a shading: FACET_SHADING_OGL1 needs legacy materials beside those of glTF. */
facet_result input_load_shaded(const char *path, const facet_scene_desc *desc, facet_shading shading,
                               facet_scene **scene, facet_error *error);

/* Loads an image; - is standard input. Memory and failures as above. */
facet_result input_load_image(const char *path, const facet_image_load_desc *desc, facet_image **image,
                              facet_error *error);

/* Loads an environment; - is standard input. Memory and failures as above. */
facet_result input_load_environment(const char *path, const facet_environment_desc *desc,
                                    facet_environment **environment, facet_error *error);

/* Whether both paths exist and are the same file. */
bool input_is_same_file(const char *a, const char *b);

#endif
