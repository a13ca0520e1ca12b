/* output.h - writes images and other results to files and standard output. */
#ifndef CLI_OUTPUT_H
#define CLI_OUTPUT_H

#include "facet/facet.h"

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
