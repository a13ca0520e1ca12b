/* exr_check.h - what has to be true of an OpenEXR file before its library may see it, and before memory is taken for it. */
#ifndef IMAGE_EXR_CHECK_H
#define IMAGE_EXR_CHECK_H

#include "image/exr_shim.h"

enum { EXR_LIBRARY_MEMORY = 65536 /* that the library takes for an open file besides buffers */ };

typedef struct exr_sizes {
    uint32_t width, height;           /* of the display window: the image */
    uint32_t data_width, data_height; /* of the data window */
    uint32_t strip_rows;              /* read at once: whole chunks */
    uint64_t library_memory;          /* that an open file takes, more or less */
} exr_sizes;

/* fail() with what the library says of the file called name. */
facet_result exr_fail(facet_error *error, facet_result result, const char *name, const char *message);

/* Walks over all headers, then has the library read the first one. named: the channels that are wanted; NULL: those of the
 * image. Fails with FACET_ERROR_INVALID, _UNSUPPORTED, and _LIMIT where an edge is longer than max_size. */
facet_result exr_check(const unsigned char *bytes, size_t size, const char *name, uint32_t max_size,
                       const exr_channel *named, uint32_t named_count, exr_info *info, exr_sizes *s,
                       facet_error *error);

#endif
