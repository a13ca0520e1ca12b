/* meshopt.h - the bitstreams and filters of EXT_meshopt_compression and KHR_meshopt_compression (the second adds
 * version 1 of attributes and the color filter): bytes in, bytes out, no JSON. Section names below are those of the
 * KHR specification, which has the bitstreams in its appendix A and the filters in B. */
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

/* A stream and what its view says of it. */
typedef struct meshopt_stream {
    const uint8_t *bytes;
    size_t size;
    meshopt_mode mode;
    meshopt_filter filter; /* MESHOPT_NONE unless mode is MESHOPT_ATTRIBUTES */
    size_t count;          /* elements */
    size_t stride;         /* bytes of one: see meshopt_check() */
} meshopt_stream;

/* NULL: mode, filter, count and stride go together; else what is wrong: "byteStride must be ..". */
const char *meshopt_check(const meshopt_stream *stream);

/* The least bytes that a stream of so many elements can have; SIZE_MAX where that is no size. Who takes memory for
 * what a file claims compares first. At most 1024 bytes come of one. */
size_t meshopt_smallest_size(const meshopt_stream *stream);

/* Writes count * stride bytes to out, aligned to 16. Needs what meshopt_check() asks for. NULL: done; else what is
 * wrong with the bytes, as in "ends too early", and out holds anything. */
const char *meshopt_decode(const meshopt_stream *stream, uint8_t *out);

/* The parts of meshopt_decode(): a stream in one mode; a filter over elements in place, which cannot fail. */
const char *meshopt_decode_attributes(const meshopt_stream *stream, uint8_t *out);
void meshopt_apply_filter(meshopt_filter filter, uint8_t *elements, size_t count, size_t stride);

/* What the decoders say in more than one place. */
#define MESHOPT_TOO_SHORT "ends too early"
#define MESHOPT_TOO_LONG "has bytes that belong to no element"
#define MESHOPT_NO_HEADER "does not begin as such a stream does"

#endif
