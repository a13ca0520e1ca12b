/* output.h - pictures and other results to files and standard output. */
#ifndef CLI_OUTPUT_H
#define CLI_OUTPUT_H

#include "facet/facet.h"

/* Whether path ("-": standard output) can be written, found out before the work: FACET_ERROR_WRITE names the folder that
 * is closed. Folders that are missing are made by what writes. */
facet_result output_check(const char *path, facet_error *error);

/* Makes the folders above path that are missing: for what the library writes while it works. FACET_ERROR_WRITE. */
facet_result output_make_folders(const char *path, facet_error *error);

/* Writes image to path ("-": standard output). */
facet_result output_write(const facet_image *image, const char *path, const facet_image_save_desc *desc,
                          facet_error *error);

/* Writes bytes to path ("-": standard output). */
facet_result output_write_bytes(const void *bytes, size_t size, const char *path, facet_error *error);

/* Writes scene to path ("/dev/stdout" too), desc.progress being its own: a signal or the time limit ends it, and the
 * process at once while no file is begun (interrupt.h). */
facet_result output_write_scene(const facet_scene *scene, const char *path, facet_scene_save_desc desc,
                                facet_error *error);

/* "FOLDER/NAME" with the folder by device and number: equal for all paths that mean the same file. For free(); NULL: no
 * memory. */
char *output_identity(const char *path);

/* Whether something is there already. */
bool output_exists(const char *path);

/* Ends writing to standard output; FACET_ERROR_WRITE where what was printed did not arrive. */
facet_result output_close_stdout(facet_error *error);

#endif
