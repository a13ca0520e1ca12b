/* output.h - outputs: their names, with the placeholders {stem}, {name}, {dir}, {index}, #### and %04d; and
 * writing them to files and standard output. */
#ifndef CLI_OUTPUT_H
#define CLI_OUTPUT_H

#include "base/result.h"
#include "facet/facet.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* ---- names ---- */

/* The model of an output. */
typedef struct model_name {
    const char *path;     /* "-": standard input; NULL: the built-in scene */
    const char *folder;   /* {dir}, without slash at either end; "", NULL: none */
    size_t number, count; /* {index} is number, from 1, as wide as count; 0: 1 of 1 */
} model_name;

/* Whether pattern has a placeholder of the frame number: two or more # in a row, %d, %04d. */
bool output_name_has_frame(const char *pattern);
/* Whether pattern distinguishes models: it contains {stem}, {name}, {dir} or {index}. */
bool output_name_has_model(const char *pattern);

/* FACET_ERROR_ARGUMENT if pattern has a {word} that is not in words, a blank-separated list; place begins the
 * message. */
#define OUTPUT_NAME_WORDS "stem name dir index"
facet_result output_name_check(const char *place, const char *pattern, const char *words, facet_error *error);

/* Writes pattern with all placeholders replaced to name (size bytes): {stem} is the model's name without
 * folder and extension, {name} with its extension; the frame number is zero-padded to the width of its
 * placeholder. frame NULL: its placeholders stay. False: too long. */
bool output_name_expand(const char *pattern, const model_name *model, const uint32_t *frame, char *name,
                        size_t size);

/* Whether path ends in one of types, extensions separated by blanks ("png jpg"), in upper or lower case. */
bool output_name_has_type(const char *path, const char *types);

/* Base name of path without its extension, "model" if that is empty. False: too long. */
bool output_name_stem(const char *path, char *stem, size_t size);

/* ---- files ---- */

/* Checks before the work that path ("-": standard output) can be written; FACET_ERROR_WRITE names the
 * folder without permission. Missing folders are created by the writers. */
facet_result output_check(const char *path, facet_error *error);

/* Creates missing folders above path, for files that the library writes by itself. FACET_ERROR_WRITE. */
facet_result output_make_folders(const char *path, facet_error *error);

/* Writes image to path ("-": standard output). */
facet_result output_write(const facet_image *image, const char *path, const facet_image_save_desc *desc,
                          facet_error *error);

/* Writes bytes to path ("-": standard output). */
facet_result output_write_bytes(const void *bytes, size_t size, const char *path, facet_error *error);

/* Writes scene to path, which may be "/dev/stdout", with its own desc.progress: a signal or the time limit
 * cancels it, and ends the process as long as no file is begun (interrupt.h). */
facet_result output_write_scene(const facet_scene *scene, const char *path, facet_scene_save_desc desc,
                                facet_error *error);

/* "FOLDER/NAME" with the folder as device and inode number: equal for all paths of one file. For free();
 * NULL: no memory. */
char *output_identity(const char *path);

/* Whether path exists. */
bool output_exists(const char *path);

/* Closes standard output; FACET_ERROR_WRITE if a write failed. */
facet_result output_close_stdout(facet_error *error);

#endif
