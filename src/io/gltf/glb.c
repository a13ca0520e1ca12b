/* glb.c - the container: header, JSON chunk, binary chunk (glTF 2.0 section 4.4). */
#include <string.h>

#include "io/gltf/gltf_reader.h"

enum { HEADER_SIZE = 12, CHUNK_HEADER_SIZE = 8 };

static const uint32_t CHUNK_JSON = 0x4e4f534a;
static const uint32_t CHUNK_BIN = 0x004e4942;

/* Little-endian whatever the machine is. */
static uint32_t read_u32(const unsigned char *bytes)
{
    return (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
}

static bool check_header(io_reader *r, const unsigned char *bytes, size_t *size)
{
    if (*size < HEADER_SIZE)
        return io_fail(r, NULL, NULL, FACET_ERROR_INVALID,
                       "is cut off: %zu bytes are less than the 12 of a GLB header", *size);
    uint32_t version = read_u32(bytes + 4);
    if (version == 1)
        return io_fail(r, NULL, NULL, FACET_ERROR_UNSUPPORTED, "is binary glTF 1.0; only glTF 2.0 is read");
    if (version != 2)
        return io_fail(r, NULL, NULL, FACET_ERROR_UNSUPPORTED, "is GLB version %u; only version 2 is read",
                       version);
    uint32_t length = read_u32(bytes + 8);
    if (length > *size)
        return io_fail(r, NULL, NULL, FACET_ERROR_INVALID,
                       "is cut off: its header says %u bytes, but there are %zu", length, *size);
    if (length < *size) {
        io_note(r, NULL, NULL, "has %zu bytes behind the %u that its header says; they are ignored",
                *size - length, length);
        *size = length;
    }
    return true;
}

bool gltf_split_glb(io_reader *r, const unsigned char *bytes, size_t size, const char **json,
                    size_t *json_size)
{
    if (!check_header(r, bytes, &size))
        return false;
    *json = NULL;
    size_t at = HEADER_SIZE;
    for (unsigned number = 0; at < size; number++) {
        if (size - at < CHUNK_HEADER_SIZE)
            return io_fail(r, NULL, NULL, FACET_ERROR_INVALID, "is cut off in the header of chunk %u",
                           number);
        uint32_t length = read_u32(bytes + at);
        uint32_t type = read_u32(bytes + at + 4);
        at += CHUNK_HEADER_SIZE;
        if (length > size - at)
            return io_fail(r, NULL, NULL, FACET_ERROR_INVALID,
                           "is cut off: chunk %u says %u bytes, but %zu follow", number, length, size - at);
        if (length % 4)
            io_note(r, NULL, NULL, "chunk %u has %u bytes, which is not a multiple of 4", number, length);
        if (number == 0 && type != CHUNK_JSON)
            return io_fail(r, NULL, NULL, FACET_ERROR_INVALID,
                           "the first chunk must be JSON, but is of type 0x%08x", type);
        if (number == 0) {
            *json = (const char *)bytes + at;
            *json_size = length;
        } else if (type == CHUNK_BIN && !r->gltf->bin) {
            r->gltf->bin = bytes + at;
            r->gltf->bin_size = length;
        } else if (type == CHUNK_BIN || type == CHUNK_JSON) {
            io_warn(r, NULL, NULL, "chunk %u is a second one of its type and is ignored", number);
        } /* others may come with extensions and are skipped */
        at += length;
    }
    if (!*json)
        return io_fail(r, NULL, NULL, FACET_ERROR_INVALID, "has no JSON chunk");
    return true;
}
