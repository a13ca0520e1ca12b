/* exr_shim.h - C interface of the OpenEXR library, which is C++; exceptions do not leave it. Functions fail
 * with FACET_ERROR_MEMORY or as documented, and fill message. */
#ifndef IMAGE_EXR_SHIM_H
#define IMAGE_EXR_SHIM_H

#include "image/image.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { EXR_NAME = 256 /* bytes of a channel's name with its closing 0 */, EXR_MESSAGE = 512 };

typedef struct exr_window {
    int32_t min_x, min_y, max_x, max_y; /* inclusive bounds */
} exr_window;

/* A channel that the image is made of. */
typedef struct exr_source {
    char name[EXR_NAME];
    bool is_half;
} exr_source;

/* A channel in memory: the sample at (x, y) is first[y * row_stride + x * texel_stride], in bytes. */
typedef struct exr_channel {
    const char *name;
    float *first; /* not modified when writing */
    size_t texel_stride, row_stride;
    bool needs_float; /* written as floats even in a file of halves */
    bool is_integer;  /* 32-bit unsigned integers */
} exr_channel;

/* Contents of the header of the first part, unchecked. */
typedef struct exr_info {
    exr_window data, display;
    bool is_tiled, is_dwa;
    uint32_t tile_width, tile_height; /* where is_tiled */
    uint32_t chunk_rows;              /* rows that are coded together */
    uint32_t texel_size;              /* bytes of the samples of all channels */
    bool has_chromaticities;          /* the attribute of that name */
    float chromaticities[8];          /* x, y of red, green, blue and white; NaN if it has another type */
    image_envmap envmap;
    uint32_t channel_count; /* of the image: 3 or 4; of those that were named */
    exr_source sources[4];  /* of an image: R, G, B, A; the same one three times if grey */
} exr_info;

/* Reads the first header of a file with valid headers (see exr_check()). named: the required channels; NULL:
 * those of the image. FACET_ERROR_INVALID, also if one of named is missing or of another type;
 * FACET_ERROR_UNSUPPORTED. */
facet_result exr_shim_info(const unsigned char *bytes, size_t size, const exr_channel *named,
                           uint32_t named_count, exr_info *out, char message[EXR_MESSAGE]);
/* Selects a layer as the sources of info, which exr_shim_info() has filled: the channels LAYER.R .G .B .A, or
 * .X .Y .Z, or .U .V, or any other suffixes, at most 4; a single one is used three times. Or the channel of
 * exactly that name; "depth" is the channel Z. FACET_ERROR_INVALID: no such layer; message names the existing
 * ones. */
facet_result exr_shim_layer(const unsigned char *bytes, size_t size, const char *layer, exr_info *info,
                            char message[EXR_MESSAGE]);
/* Reads an attribute of the type "string" of such a file. FACET_ERROR_INVALID: missing, or longer than value. */
facet_result exr_shim_text(const unsigned char *bytes, size_t size, const char *attribute, char *value,
                           size_t value_size, char message[EXR_MESSAGE]);

/* An open file, for one thread at a time. Several may share the same bytes, which must outlive them. */
typedef struct exr_reader exr_reader;
facet_result exr_shim_open(const unsigned char *bytes, size_t size, exr_reader **out,
                           char message[EXR_MESSAGE]);
void exr_shim_close(exr_reader *reader); /* NULL is allowed */
/* Reads rows [row, row_end) of the data window as floats, channels interleaved. FACET_ERROR_INVALID: damaged. */
facet_result exr_shim_read(exr_reader *reader, const exr_info *info, uint32_t row, uint32_t row_end,
                           float *texels, char message[EXR_MESSAGE]);

/* Reads all rows of named channels into their memory. FACET_ERROR_INVALID: damaged. */
facet_result exr_shim_read_named(exr_reader *reader, const exr_info *info, const exr_channel *channels,
                                 uint32_t channel_count, char message[EXR_MESSAGE]);

/* How a file is written. */
typedef struct exr_write_desc {
    uint32_t width, height;
    bool as_half;
    bool is_stored;          /* not compressed */
    uint32_t level;          /* of zlib */
    const image_text *texts; /* attributes */
    uint32_t text_count;
} exr_write_desc;

/* Writes scanlines, ZIP. *bytes: a block of mem_alloc(). Fails with FACET_ERROR_ARGUMENT. */
facet_result exr_shim_write(const exr_write_desc *desc, const exr_channel *channels, uint32_t channel_count,
                            const facet_allocator *allocator, unsigned char **bytes, size_t *size,
                            char message[EXR_MESSAGE]);

/* ---- validation of files before the library reads them and before memory is allocated (exr_check.c) ---- */

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

#ifdef __cplusplus
}
#endif
#endif
