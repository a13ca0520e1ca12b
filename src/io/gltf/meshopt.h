/* meshopt.h - the bitstreams and filters of EXT_meshopt_compression and KHR_meshopt_compression (the
 * second adds version 1 of attributes and the color filter), independent of JSON. Section names below are
 * those of the KHR specification: appendix A has the bitstreams, appendix B the filters. */
#ifndef IO_MESHOPT_H
#define IO_MESHOPT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef enum meshopt_mode { MESHOPT_ATTRIBUTES, MESHOPT_TRIANGLES, MESHOPT_INDICES } meshopt_mode;

typedef enum meshopt_filter {
    MESHOPT_NONE,
    MESHOPT_OCTAHEDRAL,
    MESHOPT_QUATERNION,
    MESHOPT_EXPONENTIAL,
    MESHOPT_COLOR
} meshopt_filter;

/* A stream and its description in the buffer view. */
typedef struct meshopt_stream {
    const uint8_t *bytes;
    size_t size;
    meshopt_mode mode;
    meshopt_filter filter; /* MESHOPT_NONE unless mode is MESHOPT_ATTRIBUTES */
    size_t count;          /* elements */
    size_t stride;         /* bytes per element: see meshopt_check() */
} meshopt_stream;

/* NULL: mode, filter, count and stride are consistent; otherwise the reason: "byteStride must be ..". */
const char *meshopt_check(const meshopt_stream *stream);

/* The minimal size of a stream with that many elements; SIZE_MAX if that overflows. Callers compare it
 * with the stream before they allocate memory for the elements: a byte decodes to at most 1024. */
size_t meshopt_smallest_size(const meshopt_stream *stream);

/* Writes count * stride bytes to out, aligned to 16, after meshopt_check(). NULL: success; otherwise the
 * flaw of the bytes, as in "ends too early", and the contents of out are undefined. */
const char *meshopt_decode(const meshopt_stream *stream, uint8_t *out);

/* The parts of meshopt_decode(): a stream in one mode; a filter over elements in place, which cannot fail. */
const char *meshopt_decode_attributes(const meshopt_stream *stream, uint8_t *out);
void meshopt_apply_filter(meshopt_filter filter, uint8_t *elements, size_t count, size_t stride);

/* Messages that several decoders share. */
#define MESHOPT_TOO_SHORT "ends too early"
#define MESHOPT_TOO_LONG "has bytes that belong to no element"
#define MESHOPT_NO_HEADER "does not begin as such a stream does"

#endif
