/* folder.h - the temporary folder of a request: files that came with it in in/, files that it makes in out/. */
#ifndef CLI_SERVE_FOLDER_H
#define CLI_SERVE_FOLDER_H

#include "cli/serve/answer.h"

enum { FOLDER_PATH_SIZE = 256 };

/* The folders of a server, and one of a request. {0} initially: made when it is needed. */
typedef struct folder {
    char path[FOLDER_PATH_SIZE];
} folder;

/* Makes a folder for the server in TMPDIR, or /tmp, which only its user can read. FACET_ERROR_WRITE. */
facet_result folder_create(folder *f, facet_error *error);
/* Makes the folder number of a request in parent, with in and out, unless it is there. FACET_ERROR_WRITE. */
facet_result folder_create_below(folder *f, const folder *parent, uint64_t number, facet_error *error);
/* Removes it with all that it holds. */
void folder_remove(folder *f);

/* Writes bytes to the file in/NAME and its path to path. name is relative, with folders or without. Fails with
 * FACET_ERROR_ARGUMENT for a name that leads out or is not plain, and FACET_ERROR_WRITE. */
facet_result folder_add(const folder *f, const char *name, const void *bytes, size_t size, char *path,
                        size_t path_size, facet_error *error);
/* Whether name is relative, without "..", control characters, or a name that begins with a dash or a dot. */
bool folder_name_is_plain(const char *name);

/* Appends the files in out/ to the answer, sorted by name, at most max_bytes in all. Fails with
 * FACET_ERROR_LIMIT, FACET_ERROR_READ and FACET_ERROR_MEMORY. */
facet_result folder_collect(const folder *f, size_t max_bytes, answer *out, facet_error *error);

#endif
