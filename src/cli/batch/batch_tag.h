/* batch_tag.h - the tag that facet render --tag keeps in an image. */
#ifndef CLI_BATCH_TAG_H
#define CLI_BATCH_TAG_H

#include <stdbool.h>
#include <stdio.h>

enum { BATCH_TAG_SIZE = 256 };

/* Reads the tag of a PNG or OpenEXR file; only its header is read. False: there is no such file, or it has none. */
bool batch_tag_read(const char *path, char tag[BATCH_TAG_SIZE]);
/* Opens a file of a user for reading, if it is a regular one: a pipe would hang the batch. NULL: it is none. */
FILE *batch_open_regular(const char *path);

#endif
