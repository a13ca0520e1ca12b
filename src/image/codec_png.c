/* codec_png.c - reading PNG through libspng; png_write.c writes. Gamma, profiles and texts are ignored.
 * Portable Network Graphics, third edition (W3C). */
#include "image/codec.h"

#include <string.h>

#include <spng.h>

#include "base/memory.h"
#include "base/result.h"

enum {
    SIGNATURE_SIZE = 8,
    CHUNK_FRAME = 12, /* length, type, CRC */
    IHDR_SIZE = 13,
    LIBRARY_MEMORY = 64 * 1024 /* memory of libspng and zlib besides rows: state, window, buffers */
};

/* Facts from the chunks. */
typedef struct png_header {
    uint32_t width, height;
    uint32_t bit_depth, color_type;
    bool has_transparency; /* a tRNS chunk that applies */
    size_t data_size;      /* of all IDAT chunks */
} png_header;

typedef struct chunk {
    const unsigned char *start; /* its length */
    const unsigned char *type, *data, *end;
} chunk;

/* ---- chunks ---- */

static bool is_type(const chunk *c, const char type[4])
{
    return memcmp(c->type, type, 4) == 0;
}

/* Reads the chunk at *p and advances *p; false: truncated. */
static bool next_chunk(const unsigned char **p, const unsigned char *end, chunk *c)
{
    if (end - *p < CHUNK_FRAME)
        return false;
    const size_t size = load_u32_be(*p);
    if (size > (size_t)(end - *p) - CHUNK_FRAME)
        return false;
    *c = (chunk){*p, *p + 4, *p + 8, *p + CHUNK_FRAME + size};
    *p = c->end;
    return true;
}

/* Whether the chunk is passed to libspng: the critical ones, and palette and transparency where they apply.
 * Other chunks can then neither take memory nor be damaged. */
static bool is_wanted(const chunk *c, uint32_t color_type)
{
    const bool has_alpha = color_type & 4;
    if (is_type(c, "PLTE"))
        return color_type == SPNG_COLOR_TYPE_INDEXED; /* otherwise only a suggestion */
    if (is_type(c, "tRNS"))
        return !has_alpha;
    return !(c->type[0] & 0x20); /* ancillary chunks are lower case */
}

/* Finds all chunks (only those before IDAT unless to_end). Checks only the CRC of IEND, which libspng
 * ignores. */
static facet_result read_chunks(const unsigned char *bytes, size_t size, const char *name, bool to_end,
                                png_header *h, facet_error *error)
{
    *h = (png_header){0};
    const unsigned char *p = bytes + SIGNATURE_SIZE;
    const unsigned char *end = bytes + size;
    chunk c;
    if (!next_chunk(&p, end, &c))
        return fail(error, FACET_ERROR_INVALID, "%s: PNG: the file ends before IHDR", name);
    if (!is_type(&c, "IHDR") || c.end - c.start != CHUNK_FRAME + IHDR_SIZE)
        return fail(error, FACET_ERROR_INVALID, "%s: PNG: an IHDR chunk of 13 bytes was expected first",
                    name);
    h->width = load_u32_be(c.data);
    h->height = load_u32_be(c.data + 4);
    h->bit_depth = c.data[8];
    h->color_type = c.data[9];
    bool is_in_data = false; /* the last chunk was IDAT */
    for (;;) {
        if (!next_chunk(&p, end, &c))
            return fail(error, FACET_ERROR_INVALID, "%s: PNG: the file ends before %s", name,
                        h->data_size ? "IEND" : "IDAT");
        const bool is_data = is_type(&c, "IDAT");
        if (is_data && !to_end)
            return FACET_OK;
        if (is_type(&c, "IEND"))
            break;
        if (is_data && h->data_size && !is_in_data)
            return fail(error, FACET_ERROR_INVALID, "%s: PNG: the IDAT chunks do not follow each other",
                        name);
        if (is_data)
            h->data_size += (size_t)(c.end - c.start) - CHUNK_FRAME;
        else if (is_type(&c, "tRNS") && h->data_size == 0)
            h->has_transparency = is_wanted(&c, h->color_type);
        is_in_data = is_data;
    }
#ifndef FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION /* otherwise changes would not be detected beyond this point */
    if (c.end - c.start != CHUNK_FRAME || memcmp(c.data, "\xae\x42\x60\x82", 4) != 0)
        return fail(error, FACET_ERROR_INVALID, "%s: PNG: the CRC of IEND does not fit", name);
#endif
    return FACET_OK;
}

static uint32_t own_channel_count(const png_header *h)
{
    switch (h->color_type) {
    case SPNG_COLOR_TYPE_GRAYSCALE:
        return h->has_transparency ? 2 : 1;
    case SPNG_COLOR_TYPE_GRAYSCALE_ALPHA:
        return 2;
    case SPNG_COLOR_TYPE_TRUECOLOR_ALPHA:
        return 4;
    default:
        return h->has_transparency ? 4 : 3;
    }
}

/* ---- libspng ---- */

/* Stream for libspng: the file without the chunks that are not passed on. */
typedef struct source {
    const unsigned char *next, *part_end; /* of the current chunk */
    const unsigned char *rest, *end;      /* remaining chunks */
    uint32_t color_type;
} source;

static int read_source(spng_ctx *context, void *user, void *out, size_t size)
{
    (void)context;
    source *s = user;
    for (unsigned char *to = out; size > 0;) {
        chunk c;
        while (s->next == s->part_end) {
            if (!next_chunk(&s->rest, s->end, &c))
                return SPNG_IO_EOF;
            if (is_wanted(&c, s->color_type)) {
                s->next = c.start;
                s->part_end = c.end;
            }
        }
        size_t count = (size_t)(s->part_end - s->next);
        count = count < size ? count : size;
        memcpy(to, s->next, count);
        s->next += count;
        to += count;
        size -= count;
    }
    return 0;
}

static facet_result fail_png(facet_error *error, const char *name, int code)
{
    if (code == SPNG_EMEM || code == SPNG_EZLIB_INIT)
        return fail_memory(error, "PNG decoder", LIBRARY_MEMORY);
    return fail(error, FACET_ERROR_INVALID, "%s: PNG: %s", name, spng_strerror(code));
}

/* A context that has read IHDR. */
static int open_png(spng_ctx *context, source *s, struct spng_ihdr *ihdr)
{
#ifdef FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION
    int code = spng_set_crc_action(context, SPNG_CRC_USE, SPNG_CRC_USE);
#else
    int code = spng_set_crc_action(context, SPNG_CRC_ERROR, SPNG_CRC_ERROR);
#endif
    if (code == 0)
        code = spng_set_image_limits(context, INT32_MAX, INT32_MAX); /* our own messages are clearer */
    if (code == 0)
        code = spng_set_png_stream(context, read_source, s);
    return code == 0 ? spng_get_ihdr(context, ihdr) : code;
}

facet_result png_probe(const unsigned char *bytes, size_t size, const char *name, image *header,
                       facet_error *error)
{
    png_header h;
    struct spng_ihdr ihdr;
    TRY(read_chunks(bytes, size, name, false, &h, error));
    TRY(codec_check_size(name, h.width, h.height, INT32_MAX, error));
    source s = {bytes, bytes + SIGNATURE_SIZE, bytes + SIGNATURE_SIZE, bytes + size, h.color_type};
    spng_ctx *context = spng_ctx_new(0);
    int code = context ? open_png(context, &s, &ihdr) : SPNG_EMEM;
    spng_ctx_free(context);
    if (code != 0)
        return fail_png(error, name, code);
    *header =
        codec_srgb_header(h.width, h.height, own_channel_count(&h), h.bit_depth == 16 ? IMAGE_U16 : IMAGE_U8);
    return FACET_OK;
}

/* Refuses images that the data cannot fill before memory is allocated: deflate expands at most 1032 times.
 * Rows are counted slightly too small, never too large. */
static facet_result check_data_size(const png_header *h, const char *name, facet_error *error)
{
    static const uint32_t samples[] = {1, 0, 3, 1, 2, 0, 4};
    const uint64_t row = (uint64_t)h->width * samples[h->color_type] * h->bit_depth / 8;
    if (h->height * row / 1032 > h->data_size)
        return fail(error, FACET_ERROR_INVALID, "%s: PNG: %zu bytes of IDAT cannot hold %u x %u texels", name,
                    h->data_size, h->width, h->height);
    return FACET_OK;
}

/* The format to request from libspng for channel_count channels; 16 bits keep the file's own channels. */
static int choose_format(const png_header *h, uint32_t channel_count)
{
    const bool is_grey = h->color_type == SPNG_COLOR_TYPE_GRAYSCALE;
    if (h->bit_depth == 16 && h->has_transparency)
        return is_grey ? SPNG_FMT_GA16 : SPNG_FMT_RGBA16;
    if (h->bit_depth == 16)
        return SPNG_FMT_PNG;
    switch (channel_count) {
    case 1:
        return SPNG_FMT_G8;
    case 2:
        return is_grey ? SPNG_FMT_GA8 : SPNG_FMT_PNG;
    case 3:
        return SPNG_FMT_RGB8;
    default:
        return SPNG_FMT_RGBA8;
    }
}

/* Passes rows to the sink one by one, so that the whole image is never in memory. */
static facet_result decode_rows(spng_ctx *context, const image *header, int format, int flags,
                                const char *name, const image_decode_desc *desc, facet_error *error)
{
    const size_t row_size = image_row_size(header);
    void *row = mem_alloc(&desc->allocator, row_size, 1);
    if (!row)
        return fail_memory(error, "row of a PNG image", row_size);
    facet_result result = desc->sink->begin(desc->sink->user, header, error);
    int code = 0;
    if (result == FACET_OK)
        code = spng_decode_image(context, NULL, 0, format, flags | SPNG_DECODE_PROGRESSIVE);
    for (uint32_t y = 0; y < header->height && result == FACET_OK && code == 0; y++) {
        code = spng_decode_row(context, row, row_size);
        if (code == SPNG_EOI && y + 1 == header->height)
            code = 0; /* returned with the last row */
        if (code == 0)
            result = desc->sink->add_row(desc->sink->user, row, error);
    }
    mem_free(row);
    return code == 0 ? result : fail_png(error, name, code);
}

static facet_result decode(spng_ctx *context, const png_header *h, source *s, const char *name,
                           const image_decode_desc *desc, image *out, facet_error *error)
{
    struct spng_ihdr ihdr;
    int code = open_png(context, s, &ihdr);
    if (code != 0)
        return fail_png(error, name, code);
    facet_result result = check_data_size(h, name, error);
    if (result != FACET_OK)
        return result;
    const bool is_deep = h->bit_depth == 16;
    const uint32_t channel_count =
        desc->channel_count && !is_deep ? desc->channel_count : own_channel_count(h);
    const int flags = h->has_transparency && (is_deep || channel_count != 3) ? SPNG_DECODE_TRNS : 0;
    const int format = choose_format(h, channel_count);
    image header = codec_srgb_header(h->width, h->height, channel_count, is_deep ? IMAGE_U16 : IMAGE_U8);
    size_t decoded_size;
    code = spng_decoded_image_size(context, format, &decoded_size);
    if (code == 0 && decoded_size != image_row_size(&header) * header.height)
        return fail(error, FACET_ERROR_BUG, "%s: PNG: %zu bytes are not %u channels", name, decoded_size,
                    channel_count);
    const bool in_rows = desc->sink && ihdr.interlace_method == SPNG_INTERLACE_NONE &&
                         (desc->channel_count == 0 || desc->channel_count == channel_count);
    if (code == 0 && in_rows)
        result = decode_rows(context, &header, format, flags, name, desc, error);
    else if (code == 0)
        result = image_create(&desc->allocator, header.width, header.height, channel_count, header.type, out,
                              error);
    if (result != FACET_OK)
        return result;
    header.pixels = out->pixels;
    *out = header;
    if (code == 0 && !in_rows)
        code = spng_decode_image(context, out->pixels, decoded_size, format, flags);
    if (code == 0)
        code = spng_decode_chunks(context); /* to the end, so that the last CRCs are checked */
    return code == 0 ? FACET_OK : fail_png(error, name, code);
}

/* Converts 16-bit channels of the file to the requested ones. */
static facet_result convert(const image_decode_desc *desc, image *i, facet_error *error)
{
    image made;
    if (desc->channel_count == 0 || i->channel_count == desc->channel_count)
        return FACET_OK;
    facet_result result = image_convert(i, &desc->allocator, desc->thread_count, desc->channel_count, i->type,
                                        true, &made, error);
    if (result == FACET_OK) {
        image_destroy(i);
        *i = made;
    }
    return result;
}

facet_result png_decode(const unsigned char *bytes, size_t size, const char *name,
                        const image_decode_desc *desc, image *out, facet_error *error)
{
    png_header h;
    image made = {0};
    TRY(read_chunks(bytes, size, name, true, &h, error));
    TRY(codec_check_size(name, h.width, h.height, desc->max_size, error));
    /* libspng allocates with malloc(): at most two filtered rows and one of 16-bit RGBA */
    const ptrdiff_t library_memory = LIBRARY_MEMORY + (ptrdiff_t)h.width * 3 * 8;
    source s = {bytes, bytes + SIGNATURE_SIZE, bytes + SIGNATURE_SIZE, bytes + size, h.color_type};
    if (!mem_account(&desc->allocator, library_memory))
        return fail_memory(error, "PNG decoder", (size_t)library_memory);
    spng_ctx *context = spng_ctx_new(0);
    facet_result result = context ? decode(context, &h, &s, name, desc, &made, error)
                                  : fail_memory(error, "PNG decoder", LIBRARY_MEMORY);
    spng_ctx_free(context);
    mem_account(&desc->allocator, -library_memory);
    if (result == FACET_OK)
        result = convert(desc, &made, error);
    if (result == FACET_OK)
        *out = made;
    else
        image_destroy(&made);
    return result;
}
