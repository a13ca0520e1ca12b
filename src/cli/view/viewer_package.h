/* viewer_package.h - the viewer for browsers, which web/build.sh builds: where its files are. */
#ifndef CLI_VIEWER_PACKAGE_H
#define CLI_VIEWER_PACKAGE_H

#include "base/file.h"

typedef struct viewer_package {
    char folder[4096];
} viewer_package;

/* Finds the folder: $FACET_WEB, else where facet is installed, else the build tree of the command. Fails with
 * FACET_ERROR_SYSTEM, and says what builds it. */
facet_result viewer_package_find(viewer_package *out, facet_error *error);

/* Opens a file of the folder by its relative name. */
facet_result viewer_package_open(const viewer_package *p, const char *name, const facet_allocator *allocator,
                                 file_bytes *file, facet_error *error);

#endif
