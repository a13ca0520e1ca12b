/* exr_check.c - validation of OpenEXR files; see exr_shim.h. */
#include "image/exr_shim.h"

#include <string.h>

#include "base/result.h"
#include "image/codec.h"

enum {
    FLAGS = 0x200 | 0x400 | 0x800 | 0x1000, /* tiled, long names, deep, multi-part */
    FLAG_MULTIPART = 0x1000,
    KNOWN_VERSION = 2,
    FIRST_HEADER = 8, /* after the magic and the version */
    CHANNEL_RECORD = 16,
    STRIP_ROWS = 16 /* at least read at once */
};

facet_result exr_fail(facet_error *error, facet_result result, const char *name, const char *message)
{
    if (result == FACET_ERROR_MEMORY)
        return fail_memory(error, "OpenEXR library", EXR_LIBRARY_MEMORY);
    return fail(error, result, "%s: OpenEXR: %s", name, message);
}

/* ---- checks before the library reads the file ---- */

/* A position in the file. */
typedef struct cursor {
    const unsigned char *next, *end;
} cursor;

/* Reads a zero-terminated string; NULL: unterminated or too long. */
static const char *read_string(cursor *c)
{
    const size_t left = (size_t)(c->end - c->next);
    const unsigned char *zero = memchr(c->next, 0, left < EXR_NAME ? left : EXR_NAME);
    const char *string = (const char *)c->next;
    if (zero)
        c->next = zero + 1;
    return zero ? string : NULL;
}

/* Whether the channel list ends with its attribute. */
static bool is_channel_list(const unsigned char *value, size_t size)
{
    cursor c = {value, value + size};
    for (;;) {
        const char *name = read_string(&c);
        if (!name)
            return false;
        if (!*name)
            return c.next == c.end;
        if (c.end - c.next < CHANNEL_RECORD)
            return false;
        c.next += CHANNEL_RECORD;
    }
}

/* Whether a value of a type may have this size; the library does not check that for known types. */
static bool is_right_size(const char *type, const unsigned char *value, size_t size)
{
    static const struct {
        const char *type;
        size_t size;
    } fixed[] = {
        {"box2i", 16},
        {"box2f", 16},
        {"chromaticities", 32},
        {"compression", 1},
        {"deepImageState", 1},
        {"double", 8},
        {"envmap", 1},
        {"float", 4},
        {"int", 4},
        {"keycode", 28},
        {"m33d", 72},
        {"m33f", 36},
        {"m44d", 128},
        {"m44f", 64},
        {"lineOrder", 1},
        {"v2d", 16},
        {"rational", 8},
        {"tiledesc", 9},
        {"timecode", 8},
        {"v2f", 8},
        {"v2i", 8},
        {"v3d", 24},
        {"v3f", 12},
        {"v3i", 12},
    };
    for (size_t k = 0; k < sizeof fixed / sizeof *fixed; k++)
        if (strcmp(type, fixed[k].type) == 0)
            return size == fixed[k].size;
    if (strcmp(type, "chlist") == 0)
        return is_channel_list(value, size);
    return size <= INT32_MAX;
}

/* Walks one header up to its terminating 0. *is_empty: no attributes. */
static facet_result check_header(cursor *c, const char *name, bool *is_empty, facet_error *error)
{
    static const char *const needed[] = {"channels", "compression", "dataWindow", "displayWindow"};
    unsigned found = 0;
    for (*is_empty = true;; *is_empty = false) {
        const char *attribute = read_string(c);
        if (attribute && !*attribute)
            break;
        const char *type = attribute ? read_string(c) : NULL;
        if (!type || c->end - c->next < 4)
            return fail(error, FACET_ERROR_INVALID, "%s: OpenEXR: the header is cut off", name);
        const size_t size = load_u32_le(c->next);
        c->next += 4;
        if (size > (size_t)(c->end - c->next))
            return fail(error, FACET_ERROR_INVALID, "%s: OpenEXR: attribute %s: %zu bytes, the file has %zu",
                        name, attribute, size, (size_t)(c->end - c->next));
        if (!is_right_size(type, c->next, size))
            return fail(error, FACET_ERROR_INVALID, "%s: OpenEXR: attribute %s: %zu bytes are not a %s", name,
                        attribute, size, type);
        for (unsigned k = 0; k < 4; k++)
            found |= (unsigned)(strcmp(attribute, needed[k]) == 0) << k;
        c->next += size;
    }
    if (!*is_empty && found != 15)
        return fail(error, FACET_ERROR_INVALID,
                    "%s: OpenEXR: channels, compression, dataWindow or displayWindow is missing", name);
    return FACET_OK;
}

/* Walks all headers first: OpenEXR 3.1 allocates memory for attributes before it detects the end of the file. */
static facet_result check_headers(const unsigned char *bytes, size_t size, const char *name,
                                  facet_error *error)
{
    if (size < FIRST_HEADER)
        return fail(error, FACET_ERROR_INVALID, "%s: OpenEXR: the header is cut off", name);
    const uint32_t version = load_u32_le(bytes + 4);
    if ((version & 0xff) != KNOWN_VERSION || (version & ~(uint32_t)(0xff | FLAGS)))
        return fail(error, FACET_ERROR_UNSUPPORTED, "%s: OpenEXR: version %#x of the format is not known",
                    name, version);
    cursor c = {bytes + FIRST_HEADER, bytes + size};
    bool is_empty;
    TRY(check_header(&c, name, &is_empty, error));
    if (is_empty)
        return fail(error, FACET_ERROR_INVALID, "%s: OpenEXR: the header is empty", name);
    while ((version & FLAG_MULTIPART) && !is_empty)
        TRY(check_header(&c, name, &is_empty, error));
    return FACET_OK;
}

/* ---- sizes ---- */

static uint64_t edge(int32_t min, int32_t max)
{
    return max < min ? 0 : (uint64_t)((int64_t)max - min + 1);
}

/* Refuses images that are too large or cannot be in a file of size bytes, before memory is allocated.
 * Deflate, the densest coding but DWA, expands at most 1032 times, PXR24 stores 3 of 4 bytes of that. */
static facet_result check_sizes(const exr_info *info, size_t size, const char *name, uint32_t max_size,
                                exr_sizes *s, facet_error *error)
{
    const uint64_t width = edge(info->display.min_x, info->display.max_x);
    const uint64_t height = edge(info->display.min_y, info->display.max_y);
    const uint64_t data_width = edge(info->data.min_x, info->data.max_x);
    const uint64_t data_height = edge(info->data.min_y, info->data.max_y);
    TRY(codec_check_size(name, width, height, max_size, error));
    TRY(codec_check_size(name, data_width, data_height, max_size, error));
    *s = (exr_sizes){.width = (uint32_t)width,
                     .height = (uint32_t)height,
                     .data_width = (uint32_t)data_width,
                     .data_height = (uint32_t)data_height};
    if (info->is_tiled && (info->tile_width == 0 || info->tile_height == 0 || info->tile_width > INT32_MAX ||
                           info->tile_height > INT32_MAX))
        return fail(error, FACET_ERROR_INVALID, "%s: OpenEXR: tiles of %u x %u texels", name,
                    info->tile_width, info->tile_height);
    const uint64_t chunk_width = info->is_tiled ? info->tile_width : data_width;
    const uint64_t chunk_count =
        ((data_width - 1) / chunk_width + 1) * ((data_height - 1) / info->chunk_rows + 1);
    if (chunk_count > size / 8)
        return fail(error, FACET_ERROR_INVALID, "%s: OpenEXR: the file ends in its table of %llu chunks",
                    name, (unsigned long long)chunk_count);
    const uint64_t samples = data_width * data_height * info->texel_size;
    if (!info->is_dwa && samples / 1376 > size)
        return fail(error, FACET_ERROR_INVALID, "%s: OpenEXR: %zu bytes cannot hold %llu bytes of samples",
                    name, size, (unsigned long long)samples);
    if (info->is_tiled && (info->tile_width > CODEC_MAX_SIZE || info->tile_height > CODEC_MAX_SIZE))
        return fail(error, FACET_ERROR_LIMIT,
                    "%s: OpenEXR: tiles of %u x %u texels, more than %d along an edge", name,
                    info->tile_width, info->tile_height, CODEC_MAX_SIZE);
    const uint64_t strip =
        (STRIP_ROWS + info->chunk_rows - 1) / info->chunk_rows * (uint64_t)info->chunk_rows;
    s->strip_rows = (uint32_t)(strip < data_height ? strip : data_height);
    /* a chunk packed, unpacked and in between; a row of tiles as it comes out */
    s->library_memory =
        EXR_LIBRARY_MEMORY + 8 * chunk_count + 3 * chunk_width * info->chunk_rows * info->texel_size;
    if (info->is_tiled)
        s->library_memory += data_width * info->chunk_rows * info->channel_count * sizeof(float);
    return FACET_OK;
}

facet_result exr_check(const unsigned char *bytes, size_t size, const char *name, uint32_t max_size,
                       const exr_channel *named, uint32_t named_count, exr_info *info, exr_sizes *s,
                       facet_error *error)
{
    char message[EXR_MESSAGE] = "";
    TRY(check_headers(bytes, size, name, error));
    facet_result result = exr_shim_info(bytes, size, named, named_count, info, message);
    if (result != FACET_OK)
        return exr_fail(error, result, name, message);
    return check_sizes(info, size, name, max_size, s, error);
}
