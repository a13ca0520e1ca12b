/* path_checkpoint.h - the file in which a path traced image waits for the next run. */
#ifndef PATH_PATH_CHECKPOINT_H
#define PATH_PATH_CHECKPOINT_H

#include "path/path_film.h"

/* Writes the film into an OpenEXR file, whole or not at all, bit for bit, which other programs can view:
 * the layers "" (RGBA, means), albedo, normal, samples, and the rest of its state. key: path_key.hex.
 * Fails with FACET_ERROR_WRITE, _MEMORY, and _UNSUPPORTED in a build without OpenEXR. */
facet_result path_film_save(const path_film *f, const char *key, const char *path, uint32_t thread_count,
                            facet_error *error);
/* Whether a new checkpoint may be written to path: there is no such file. FACET_ERROR_ARGUMENT;
 * FACET_ERROR_WRITE where it is not a regular file. */
facet_result path_checkpoint_check(const char *path, facet_error *error);
/* Reads it into a film of the same size, which is unchanged on failure. FACET_ERROR_ARGUMENT: another
 * image's key or size, FACET_ERROR_INVALID: no checkpoint, damaged. *exists: false, and FACET_OK, where
 * there is no such file. */
facet_result path_film_load(path_film *f, const char *key, const char *path, bool *exists,
                            facet_error *error);

#endif
