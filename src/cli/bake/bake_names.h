/* bake_names.h - names of the files of facet bake: {stem}, {level}, {face}, and extensions. */
#ifndef CLI_BAKE_NAMES_H
#define CLI_BAKE_NAMES_H

#include "cli/bake/bake_options.h"

#include <stddef.h>

enum { BAKE_NAME_SIZE = 4096 };

extern const char *const bake_face_names[6]; /* px nx py ny pz nz */

/* The container by the extension of path; CONTAINER_FROM_NAME: unknown. */
bake_container bake_container_of(const char *path);
const char *bake_container_extension(bake_container container); /* "ktx2" */

/* Writes pattern with its placeholders replaced to name (BAKE_NAME_SIZE bytes). level, face -1: there is
 * only one; {level} becomes 0, {face} is an error. Several without a placeholder get _m3 or _px before the
 * extension. False: too long. */
bool bake_name_expand(const char *pattern, const char *stem, int level, bool has_levels, int face,
                      char *name);
bool bake_name_has_face(const char *pattern);

/* folder/file. False: too long. */
bool bake_name_join(const char *folder, const char *file, char *name);

/* The last component of a folder's name, "studio" of out/studio/; . and .. are resolved. "environment" if
 * there is none. */
void bake_name_of_folder(const char *folder, char *name);

/* path's base name without extension as an identifier of C. */
void bake_symbol(const char *path, char *symbol, size_t size);

#endif
