/* root.h - the folder that requests may read and write in. It is the current folder of the process, so that
 * paths stay relative to it. */
#ifndef CLI_SERVE_ROOT_H
#define CLI_SERVE_ROOT_H

#include "cli/serve/answer.h"

enum { ROOT_PATH_SIZE = 4096 };

typedef struct root {
    char path[ROOT_PATH_SIZE]; /* without links, without slash at the end unless it is "/" */
} root;

/* Makes folder the current folder. Fails with FACET_ERROR_READ. */
facet_result root_enter(const char *folder, root *out, facet_error *error);

/* Writes the path of an existing file or folder, relative to the root, with links resolved, to below. It
 * does not begin with a dash. False, with a failure in *refusal: it is outside, or missing. */
bool root_find(const root *r, const char *path, char below[ROOT_PATH_SIZE], answer *refusal);
/* The same for a path to write, of which only a part need exist. */
bool root_place(const root *r, const char *path, char below[ROOT_PATH_SIZE], answer *refusal);

#endif
