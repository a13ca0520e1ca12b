/* model_files.h - the files that a model names: a picture must not replace them. */
#ifndef CLI_MODEL_FILES_H
#define CLI_MODEL_FILES_H

#include <stdbool.h>

/* Whether path, which exists, is the .gltf file model or a buffer or image that it names. Other models name no files;
 * one that cannot be read names none. */
bool model_has_file(const char *model, const char *path);

#endif
