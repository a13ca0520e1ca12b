/* files.h - the files that the page has handed over, by path: what facet reads in a browser in place of a file system. */
#ifndef WEB_FILES_H
#define WEB_FILES_H

#include "facet/facet.h"

typedef struct web_file {
    char *path; /* with "/", relative to the topmost folder */
    void *bytes;
    size_t size;
    unsigned number;  /* of each file that was ever put, another one */
    unsigned uses;    /* scenes that point into it */
    bool is_replaced; /* not found any more; released with the last use */
} web_file;

/* Takes bytes, a block of malloc(), also if it fails; a file of that path is replaced. */
facet_result web_files_put(const char *path, void *bytes, size_t size, facet_error *error);
void web_files_remove(void); /* all of them */

/* The file at exactly that path, or at the only one that differs in case: *is_alike. NULL: none. */
const web_file *web_files_find(const char *path, bool *is_alike);
/* For the reader of models. */
facet_file_source web_files_source(void);

#endif
