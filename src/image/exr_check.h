/* exr_check.h - validation of OpenEXR files before the library reads them and before memory is allocated. */
#ifndef IMAGE_EXR_CHECK_H
#define IMAGE_EXR_CHECK_H

#include "image/exr_shim.h"

enum { EXR_LIBRARY_MEMORY = 65536 /* memory of the library for an open file besides buffers */ };

typedef struct exr_sizes {
    uint32_t width, height;           /* of the display window: the image */
    uint32_t data_width, data_height; /* of the data window */
    uint32_t strip_rows;              /* rows read at once: whole chunks */
    uint64_t library_memory;          /* estimate for an open file */
} exr_sizes;

/* fail() with the library's message about the file name. */
facet_result exr_fail(facet_error *error, facet_result result, const char *name, const char *message);

/* Walks all headers, then reads the first one through the library. named: the required channels; NULL: those
 * of the image. FACET_ERROR_INVALID, _UNSUPPORTED; _LIMIT if an edge exceeds max_size. */
facet_result exr_check(const unsigned char *bytes, size_t size, const char *name, uint32_t max_size,
                       const exr_channel *named, uint32_t named_count, exr_info *info, exr_sizes *s,
                       facet_error *error);

#endif
