/* model_files.h - the files that a model names: an output must not replace them. */
#ifndef CLI_MODEL_FILES_H
#define CLI_MODEL_FILES_H

#include <stdbool.h>
#include <stddef.h>

/* Whether path, which exists, is the file model or a buffer or image that it names. A model that cannot be read names
 * none. */
bool model_has_file(const char *model, const char *path);

/* Whether one of the files that facet convert writes beside out, a .gltf file, would replace one that model names; then
 * name is the first of them. */
bool model_loses_file(const char *model, const char *out, char *name, size_t size);

#endif
