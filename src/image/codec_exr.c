/* codec_exr.c - reading OpenEXR: from the header and the table of chunks to texels. The codings of chunks
 * stand in exr_*.c, writing in exr_write.c. Layout: "OpenEXR File Layout" of the OpenEXR documentation.
 * Read are the first part of a file, its scanlines or its tiles of the finest level; deep data is refused. */
#include "image/codec.h"

#include <stdatomic.h>
#include <string.h>
#include <strings.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "image/exr.h"
#include "image/half.h"

enum {
    FLAG_TILED = 0x200,
    FLAG_LONG_NAMES = 0x400,
    FLAG_DEEP = 0x800,
    FLAG_MULTIPART = 0x1000,
    KNOWN_VERSION = 2,
    MAX_NAME = 255,
    CHANNEL_RECORD = 16 /* bytes behind a channel's name */
};

typedef struct window {
    int32_t min_x, min_y, max_x, max_y; /* both ends belong to it */
} window;

/* A part of the file. has_: attributes that must be there. */
typedef struct exr_header {
    bool has_channels, has_compression, has_data_window, has_display_window, has_tiles;
    bool is_tiled, is_deep, is_multipart;
    exr_compression compression;
    window data, display;
    const unsigned char *channel_list;
    size_t channel_list_size;
    uint32_t tile_width, tile_height; /* of a chunk */
    /* what follows from these */
    uint32_t width, height;           /* of the display window: the picture */
    uint32_t data_width, data_height; /* of the data window */
    uint32_t tiles_x, tiles_y;
    exr_channel *channels;
    uint32_t all_channel_count;
    size_t texel_size;   /* bytes of all channels' samples */
    uint32_t sources[4]; /* the channels that make R, G, B, A */
    uint32_t channel_count;
    const unsigned char *table; /* offsets of the chunks */
} exr_header;

/* A place in the file. */
typedef struct cursor {
    const unsigned char *next, *end;
    const char *name; /* the file's, for messages */
    facet_error *error;
} cursor;

static facet_result fail_at(const cursor *c, const char *what)
{
    return fail(c->error, FACET_ERROR_INVALID, "%s: OpenEXR: %s", c->name, what);
}

/* ---- attributes ---- */

/* A string of at most MAX_NAME bytes with its closing 0; NULL: there is none. */
static const char *read_string(cursor *c)
{
    size_t left = (size_t)(c->end - c->next);
    const unsigned char *zero = memchr(c->next, 0, left < MAX_NAME + 1 ? left : MAX_NAME + 1);
    const char *string = (const char *)c->next;
    if (!zero)
        return NULL;
    c->next = zero + 1;
    return string;
}

static window read_window(const unsigned char *p)
{
    return (window){(int32_t)load_u32_le(p), (int32_t)load_u32_le(p + 4), (int32_t)load_u32_le(p + 8),
                    (int32_t)load_u32_le(p + 12)};
}

/* One attribute that matters here; the others are passed over. */
static facet_result read_attribute(exr_header *h, const cursor *c, const char *name,
                                   const unsigned char *value, size_t size)
{
    if (strcmp(name, "channels") == 0) {
        h->has_channels = true;
        h->channel_list = value;
        h->channel_list_size = size;
    } else if (strcmp(name, "compression") == 0) {
        if (size != 1)
            return fail_at(c, "compression: one byte was expected");
        if (*value >= EXR_COMPRESSION_COUNT)
            return fail(c->error, FACET_ERROR_UNSUPPORTED, "%s: OpenEXR: compression %d is not known",
                        c->name, *value);
        h->has_compression = true;
        h->compression = (exr_compression)*value;
    } else if (strcmp(name, "dataWindow") == 0 || strcmp(name, "displayWindow") == 0) {
        if (size != 16)
            return fail_at(c, "dataWindow and displayWindow: 16 bytes were expected");
        if (name[1] == 'a') {
            h->has_data_window = true;
            h->data = read_window(value);
        } else {
            h->has_display_window = true;
            h->display = read_window(value);
        }
    } else if (strcmp(name, "tiles") == 0) {
        if (size != 9)
            return fail_at(c, "tiles: 9 bytes were expected");
        h->has_tiles = true;
        h->tile_width = load_u32_le(value);
        h->tile_height = load_u32_le(value + 4);
    } else if (strcmp(name, "type") == 0) {
        h->is_tiled = size == 9 && memcmp(value, "tiledimage", 9) == 0;
        h->is_tiled = h->is_tiled || (size == 10 && memcmp(value, "tiledimage", 10) == 0);
        h->is_deep = size >= 4 && memcmp(value, "deep", 4) == 0;
    }
    return FACET_OK;
}

/* Attributes up to the 0 that ends the header. *is_empty: there were none. */
static facet_result read_attributes(exr_header *h, cursor *c, bool *is_empty)
{
    for (*is_empty = true;; *is_empty = false) {
        const char *name = read_string(c);
        if (!name)
            return fail_at(c, "the header is cut off");
        if (!*name)
            return FACET_OK;
        const char *type = read_string(c);
        if (!type || c->end - c->next < 4)
            return fail_at(c, "the header is cut off");
        size_t size = load_u32_le(c->next);
        c->next += 4;
        if (size > (size_t)(c->end - c->next))
            return fail(c->error, FACET_ERROR_INVALID,
                        "%s: OpenEXR: attribute %s: %zu bytes, the file has %zu", c->name, name, size,
                        (size_t)(c->end - c->next));
        facet_result result = read_attribute(h, c, name, c->next, size);
        if (result != FACET_OK)
            return result;
        c->next += size;
    }
}

/* The first part's header; *c stands behind all headers then, where the first part's table of chunks is. */
static facet_result read_headers(exr_header *h, cursor *c)
{
    *h = (exr_header){0};
    if (c->end - c->next < 8)
        return fail_at(c, "the header is cut off");
    const uint32_t version = load_u32_le(c->next + 4);
    c->next += 8;
    if ((version & 0xff) != KNOWN_VERSION ||
        (version & ~(uint32_t)(0xff | FLAG_TILED | FLAG_LONG_NAMES | FLAG_DEEP | FLAG_MULTIPART)))
        return fail(c->error, FACET_ERROR_UNSUPPORTED, "%s: OpenEXR: version %#x of the format is not known",
                    c->name, version);
    bool is_empty;
    facet_result result = read_attributes(h, c, &is_empty);
    h->is_multipart = version & FLAG_MULTIPART;
    if (!h->is_multipart)
        h->is_tiled = version & FLAG_TILED;
    h->is_deep = h->is_deep || version & FLAG_DEEP;
    while (result == FACET_OK && h->is_multipart && !is_empty) {
        exr_header other = {0};
        result = read_attributes(&other, c, &is_empty);
    }
    if (result != FACET_OK)
        return result;
    if (h->is_deep)
        return fail(c->error, FACET_ERROR_UNSUPPORTED, "%s: OpenEXR: deep pictures are not read", c->name);
    if (!h->has_channels || !h->has_compression || !h->has_data_window || !h->has_display_window ||
        (h->is_tiled && !h->has_tiles))
        return fail_at(c, "channels, compression, dataWindow, displayWindow or tiles is missing");
    return FACET_OK;
}

/* ---- what follows from the attributes ---- */

static uint64_t edge(int32_t min, int32_t max)
{
    return max < min ? 0 : (uint64_t)((int64_t)max - min + 1);
}

static facet_result set_sizes(exr_header *h, const cursor *c, uint32_t max_size)
{
    static const unsigned char rows[EXR_COMPRESSION_COUNT] = {
        [EXR_NONE] = 1,   [EXR_RLE] = 1,  [EXR_ZIPS] = 1,  [EXR_ZIP] = 16,  [EXR_PIZ] = 32,
        [EXR_PXR24] = 16, [EXR_B44] = 32, [EXR_B44A] = 32, [EXR_DWAA] = 32, [EXR_DWAB] = 0 /* 256 */};
    const uint64_t width = edge(h->display.min_x, h->display.max_x);
    const uint64_t height = edge(h->display.min_y, h->display.max_y);
    const uint64_t data_width = edge(h->data.min_x, h->data.max_x);
    const uint64_t data_height = edge(h->data.min_y, h->data.max_y);
    facet_result result = codec_check_size(c->name, width, height, max_size, c->error);
    if (result == FACET_OK)
        result = codec_check_size(c->name, data_width, data_height, max_size, c->error);
    if (result != FACET_OK)
        return result;
    h->width = (uint32_t)width;
    h->height = (uint32_t)height;
    h->data_width = (uint32_t)data_width;
    h->data_height = (uint32_t)data_height;
    if (!h->is_tiled) {
        h->tile_width = h->data_width;
        h->tile_height = rows[h->compression] ? rows[h->compression] : 256;
    }
    if (h->tile_width == 0 || h->tile_height == 0 || h->tile_width > INT32_MAX || h->tile_height > INT32_MAX)
        return fail(c->error, FACET_ERROR_INVALID, "%s: OpenEXR: tiles of %u x %u texels", c->name,
                    h->tile_width, h->tile_height);
    h->tiles_x = (h->data_width - 1) / h->tile_width + 1;
    h->tiles_y = (h->data_height - 1) / h->tile_height + 1;
    return FACET_OK;
}

/* The channel records: name, type, linearity and three unused bytes, sampling in x and y. *count of
 * channels is filled up to capacity. */
static facet_result read_channels(const exr_header *h, const cursor *file, exr_channel *channels,
                                  uint32_t capacity, uint32_t *count)
{
    cursor c = {h->channel_list, h->channel_list + h->channel_list_size, file->name, file->error};
    for (*count = 0;; ++*count) {
        const char *name = read_string(&c);
        if (!name)
            return fail_at(&c, "the list of channels is cut off");
        if (!*name)
            return *count ? FACET_OK : fail_at(&c, "there are no channels");
        if (c.end - c.next < CHANNEL_RECORD)
            return fail_at(&c, "the list of channels is cut off");
        uint32_t type = load_u32_le(c.next);
        if (type > EXR_FLOAT)
            return fail(c.error, FACET_ERROR_INVALID, "%s: OpenEXR: channel %s: type %u, 0 to 2 was expected",
                        c.name, name, type);
        if (load_u32_le(c.next + 8) != 1 || load_u32_le(c.next + 12) != 1)
            return fail(c.error, FACET_ERROR_UNSUPPORTED,
                        "%s: OpenEXR: channel %s is not sampled at every texel", c.name, name);
        if (*count < capacity)
            channels[*count] = (exr_channel){name, (exr_type)type, c.next[4] != 0};
        c.next += CHANNEL_RECORD;
    }
}

static const uint32_t NO_CHANNEL = UINT32_MAX;

/* The channel named prefix (length bytes) and then suffix, whatever their case. */
static uint32_t find_channel(const exr_header *h, const char *prefix, size_t length, const char *suffix)
{
    for (uint32_t c = 0; c < h->all_channel_count; c++) {
        const char *name = h->channels[c].name;
        if (strncmp(name, prefix, length) == 0 && strcasecmp(name + length, suffix) == 0)
            return c;
    }
    return NO_CHANNEL;
}

/* R, G, B and perhaps A of the layer prefix. */
static bool choose_rgb(exr_header *h, const char *prefix, size_t length)
{
    static const char *const names[] = {"R", "G", "B", "A"};
    for (int c = 0; c < 4; c++)
        h->sources[c] = find_channel(h, prefix, length, names[c]);
    h->channel_count = h->sources[3] != NO_CHANNEL ? 4 : 3;
    return h->sources[0] != NO_CHANNEL && h->sources[1] != NO_CHANNEL && h->sources[2] != NO_CHANNEL;
}

static void choose_grey(exr_header *h, uint32_t channel)
{
    h->sources[0] = h->sources[1] = h->sources[2] = channel;
    h->sources[3] = find_channel(h, "", 0, "A");
    h->channel_count = h->sources[3] != NO_CHANNEL && h->sources[3] != channel ? 4 : 3;
}

/* In this order: R, G, B; Y; R, G, B of the first layer that has them; the only channel. */
static facet_result choose_channels(exr_header *h, const cursor *c)
{
    if (choose_rgb(h, "", 0))
        return FACET_OK;
    uint32_t luminance = find_channel(h, "", 0, "Y");
    if (luminance != NO_CHANNEL || h->all_channel_count == 1) {
        if (find_channel(h, "", 0, "RY") != NO_CHANNEL)
            return fail(c->error, FACET_ERROR_UNSUPPORTED,
                        "%s: OpenEXR: luminance and chroma (Y, RY, BY) are not read", c->name);
        choose_grey(h, luminance != NO_CHANNEL ? luminance : 0);
        return FACET_OK;
    }
    for (uint32_t k = 0; k < h->all_channel_count; k++) {
        const char *name = h->channels[k].name;
        const char *point = strrchr(name, '.');
        if (point && strcasecmp(point, ".R") == 0 && choose_rgb(h, name, (size_t)(point + 1 - name)))
            return FACET_OK;
    }
    return fail(c->error, FACET_ERROR_UNSUPPORTED, "%s: OpenEXR: none of %u channels is named R, G, B or Y",
                c->name, h->all_channel_count);
}

/* Reads all that stands before the chunks; h->channels is a block of mem_alloc() then. */
static facet_result read_header(const unsigned char *bytes, size_t size, const char *name, uint32_t max_size,
                                const facet_allocator *allocator, exr_header *h, facet_error *error)
{
    cursor c = {bytes, bytes + size, name, error};
    facet_result result = read_headers(h, &c);
    if (result == FACET_OK)
        result = set_sizes(h, &c, max_size);
    if (result == FACET_OK)
        result = read_channels(h, &c, NULL, 0, &h->all_channel_count);
    if (result != FACET_OK)
        return result;
    const uint64_t chunk_count = (uint64_t)h->tiles_x * h->tiles_y;
    h->table = c.next;
    if ((uint64_t)(c.end - c.next) / 8 < chunk_count)
        return fail(error, FACET_ERROR_INVALID, "%s: OpenEXR: the file ends in its table of %llu chunks",
                    name, (unsigned long long)chunk_count);
    h->channels = mem_alloc(allocator, h->all_channel_count, sizeof *h->channels);
    if (!h->channels)
        return fail_memory(error, "channels", h->all_channel_count * sizeof *h->channels);
    read_channels(h, &c, h->channels, h->all_channel_count, &h->all_channel_count);
    for (uint32_t k = 0; k < h->all_channel_count; k++)
        h->texel_size += exr_sample_size(&h->channels[k]);
    result = choose_channels(h, &c);
    if (result != FACET_OK) {
        mem_free(h->channels);
        h->channels = NULL;
    }
    return result;
}

facet_result exr_probe(const unsigned char *bytes, size_t size, const char *name, image *header,
                       facet_error *error)
{
    exr_header h;
    facet_result result = read_header(bytes, size, name, UINT32_MAX, NULL, &h, error);
    if (result != FACET_OK)
        return result;
    mem_free(h.channels);
    *header =
        (image){.width = h.width, .height = h.height, .channel_count = h.channel_count, .type = IMAGE_F32};
    return FACET_OK;
}

/* ---- chunks ---- */

typedef struct reading {
    const exr_header *header;
    const unsigned char *bytes;
    size_t size;
    const facet_allocator *allocator;
    image *image;
    _Atomic uint64_t failure; /* chunk << 8 | facet_result of the first chunk that failed; UINT64_MAX: none */
} reading;

/* A chunk as it stands in the file. */
typedef struct packed_chunk {
    exr_chunk chunk;
    uint32_t x, y; /* of its first texel in the data window */
    const unsigned char *bytes;
    size_t size;
} packed_chunk;

static size_t smaller(size_t a, size_t b)
{
    return a < b ? a : b;
}

/* Finds chunk number index; false: it is not where the table says, or not what it should be. Before its bytes
 * stand: the part (multi-part files), then y, or column, row and levels of the tile, and the size. */
static bool find_chunk(const reading *r, size_t index, packed_chunk *out)
{
    const exr_header *h = r->header;
    const uint32_t column = (uint32_t)(index % h->tiles_x);
    const uint32_t row = (uint32_t)(index / h->tiles_x);
    out->x = column * h->tile_width;
    out->y = row * h->tile_height;
    out->chunk = (exr_chunk){.channels = h->channels,
                             .channel_count = h->all_channel_count,
                             .width = (uint32_t)smaller(h->data_width - out->x, h->tile_width),
                             .height = (uint32_t)smaller(h->data_height - out->y, h->tile_height),
                             .allocator = r->allocator};
    const size_t words = (h->is_multipart ? 1u : 0u) + (h->is_tiled ? 4u : 1u);
    const unsigned char *entry = h->table + 8 * index;
    const uint64_t offset = load_u32_le(entry) | (uint64_t)load_u32_le(entry + 4) << 32;
    if (offset > r->size || r->size - offset < 4 * words + 4)
        return false;
    const unsigned char *p = r->bytes + offset;
    if (h->is_multipart && load_u32_le(p) != 0)
        return false;
    p += h->is_multipart ? 4 : 0;
    if (h->is_tiled && (load_u32_le(p) != column || load_u32_le(p + 4) != row || load_u32_le(p + 8) != 0 ||
                        load_u32_le(p + 12) != 0))
        return false;
    if (!h->is_tiled && load_u32_le(p) != (uint32_t)h->data.min_y + out->y)
        return false;
    p += h->is_tiled ? 16 : 4;
    out->size = load_u32_le(p);
    out->bytes = p + 4;
    size_t texels;
    return out->size <= r->size - offset - 4 * words - 4 &&
           checked_mul(out->chunk.width, out->chunk.height, &texels) &&
           checked_mul(texels, h->texel_size, &out->chunk.size) && out->size <= out->chunk.size;
}

/* Chunks that coding would not have made smaller stand as they are. */
static facet_result unpack(const packed_chunk *c, exr_compression compression, unsigned char *samples)
{
    static exr_unpacker *const unpackers[EXR_COMPRESSION_COUNT] = {
        [EXR_RLE] = exr_unpack_rle,     [EXR_ZIPS] = exr_unpack_zip, [EXR_ZIP] = exr_unpack_zip,
        [EXR_PIZ] = exr_unpack_piz,     [EXR_B44] = exr_unpack_b44,  [EXR_B44A] = exr_unpack_b44,
        [EXR_PXR24] = exr_unpack_pxr24, [EXR_DWAA] = exr_unpack_dwa, [EXR_DWAB] = exr_unpack_dwa};
    return unpackers[compression] ? unpackers[compression](&c->chunk, c->bytes, c->size, samples)
                                  : FACET_ERROR_INVALID;
}

/* Samples of one channel to floats, stride apart. NaN and negative infinity become 0, infinity the
 * greatest number of the channel's type: 65504 of half, so that sums of such light stay finite. */
static void convert_samples(const unsigned char *from, exr_type type, size_t count, float *to, size_t stride)
{
    switch (type) {
    case EXR_HALF:
        for (size_t x = 0; x < count; x++) {
            float value = half_to_float((uint16_t)(from[2 * x] | from[2 * x + 1] << 8));
            value = value >= -65504.0f ? value : 0.0f; /* NaN too */
            to[x * stride] = value <= 65504.0f ? value : 65504.0f;
        }
        return;
    case EXR_FLOAT:
        for (size_t x = 0; x < count; x++)
            to[x * stride] = codec_finite(float_from_bits(load_u32_le(from + 4 * x)));
        return;
    case EXR_UINT:
        for (size_t x = 0; x < count; x++)
            to[x * stride] = (float)load_u32_le(from + 4 * x);
        return;
    }
}

/* What of a chunk is inside the display window, as texels. */
static void store_chunk(const reading *r, const packed_chunk *c, const unsigned char *samples)
{
    const exr_header *h = r->header;
    const int64_t x = (int64_t)h->data.min_x - h->display.min_x + c->x; /* in the picture */
    const int64_t y = (int64_t)h->data.min_y - h->display.min_y + c->y;
    const int64_t first = x < 0 ? -x : 0; /* column of the chunk */
    const int64_t end = (int64_t)h->width - x < c->chunk.width ? (int64_t)h->width - x : c->chunk.width;
    if (first >= end)
        return;
    const size_t width = c->chunk.width;
    for (uint32_t k = 0; k < h->channel_count; k++) {
        const exr_channel *channel = &h->channels[h->sources[k]];
        size_t before = 0; /* bytes of the channels before it */
        for (uint32_t other = 0; other < h->sources[k]; other++)
            before += exr_sample_size(&h->channels[other]);
        for (uint32_t row = 0; row < c->chunk.height; row++) {
            if (y + row < 0 || y + row >= h->height)
                continue;
            const unsigned char *from = samples + width * (row * h->texel_size + before);
            float *to = (float *)r->image->pixels +
                        ((size_t)(y + row) * h->width + (size_t)(x + first)) * h->channel_count + k;
            convert_samples(from + (size_t)first * exr_sample_size(channel), channel->type,
                            (size_t)(end - first), to, h->channel_count);
        }
    }
}

static facet_result decode_chunk(const reading *r, size_t index)
{
    packed_chunk c;
    if (!find_chunk(r, index, &c))
        return FACET_ERROR_INVALID;
    if (c.size == c.chunk.size) {
        store_chunk(r, &c, c.bytes);
        return FACET_OK;
    }
    unsigned char *samples = mem_alloc(r->allocator, c.chunk.size, 1);
    if (!samples)
        return FACET_ERROR_MEMORY;
    facet_result result = unpack(&c, r->header->compression, samples);
    if (result == FACET_OK)
        store_chunk(r, &c, samples);
    mem_free(samples);
    return result;
}

static void decode_chunks(void *context, size_t begin, size_t end)
{
    reading *r = context;
    for (size_t index = begin; index < end; index++) {
        facet_result result = decode_chunk(r, index);
        if (result == FACET_OK)
            continue;
        uint64_t failure = (uint64_t)index << 8 | (uint64_t)result;
        uint64_t first = atomic_load(&r->failure);
        while (failure < first && !atomic_compare_exchange_weak(&r->failure, &first, failure))
            ;
    }
}

/* Looks at all chunks before memory is taken for the picture: each has to be there, and together they have
 * to be large enough for it. Deflate, the densest of the codings but DWA, makes at most 1032 bytes of one. */
static facet_result check_chunks(const reading *r, const char *name, facet_error *error)
{
    const exr_header *h = r->header;
    const size_t count = (size_t)h->tiles_x * h->tiles_y;
    uint64_t packed = 0;
    uint64_t unpacked = 0;
    for (size_t index = 0; index < count; index++) {
        packed_chunk c;
        if (!find_chunk(r, index, &c))
            return fail(error, FACET_ERROR_INVALID, "%s: OpenEXR: chunk %zu of %zu is not in the file", name,
                        index, count);
        packed += c.size;
        unpacked += c.chunk.size;
    }
    bool is_dwa = h->compression == EXR_DWAA || h->compression == EXR_DWAB;
    if (packed > r->size || (!is_dwa && unpacked / 1032 > packed))
        return fail(error, FACET_ERROR_INVALID, "%s: OpenEXR: %llu bytes in chunks cannot be %llu of samples",
                    name, (unsigned long long)packed, (unsigned long long)unpacked);
    return FACET_OK;
}

static facet_result decode(reading *r, const char *name, const image_decode_desc *desc, facet_error *error)
{
    const exr_header *h = r->header;
    facet_result result = check_chunks(r, name, error);
    if (result == FACET_OK)
        result =
            image_create(&desc->allocator, h->width, h->height, h->channel_count, IMAGE_F32, r->image, error);
    if (result != FACET_OK)
        return result;
    if (h->data.min_x > h->display.min_x || h->data.min_y > h->display.min_y ||
        h->data.max_x < h->display.max_x || h->data.max_y < h->display.max_y)
        memset(r->image->pixels, 0,
               image_row_size(r->image) * h->height); /* outside the data window: nothing */
    const size_t count = (size_t)h->tiles_x * h->tiles_y;
    const size_t texels = (size_t)h->tile_width * h->tile_height;
    parallel_for(desc->thread_count, count, texels < 16384 ? 16384 / texels : 1, decode_chunks, r);
    const uint64_t failure = atomic_load(&r->failure);
    if (failure == UINT64_MAX)
        return FACET_OK;
    if ((failure & 0xff) == FACET_ERROR_MEMORY)
        return fail_memory(error, "OpenEXR chunk", texels * h->texel_size);
    return fail(error, FACET_ERROR_INVALID, "%s: OpenEXR: chunk %llu of %zu is damaged", name,
                (unsigned long long)(failure >> 8), count);
}

facet_result exr_decode(const unsigned char *bytes, size_t size, const char *name,
                        const image_decode_desc *desc, image *out, facet_error *error)
{
    exr_header h;
    image made = {0};
    facet_result result = read_header(bytes, size, name, desc->max_size, &desc->allocator, &h, error);
    if (result != FACET_OK)
        return result;
    reading r = {.header = &h, .bytes = bytes, .size = size, .allocator = &desc->allocator, .image = &made};
    atomic_init(&r.failure, UINT64_MAX);
    result = decode(&r, name, desc, error);
    mem_free(h.channels);
    if (result == FACET_OK)
        *out = made;
    else
        image_destroy(&made);
    return result;
}
