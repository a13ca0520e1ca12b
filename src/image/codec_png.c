/* codec_png.c - reading PNG through libspng, or png_whole.c where libdeflate is; png_write.c writes. Gamma, profiles and texts are ignored.
 * Portable Network Graphics, third edition (W3C). */
#include <string.h>

#include <spng.h>

#include "base/memory.h"
#include "base/result.h"
#include "image/png_chunk.h"
#include "image/png_whole.h"

enum { LIBRARY_MEMORY = 64 * 1024 /* memory of libspng and zlib besides rows: state, window, buffers */ };

/* Facts from the chunks. */
typedef struct png_header {
    uint32_t width, height;
    uint32_t bit_depth, color_type;
    bool has_transparency; /* a tRNS chunk that applies */
    size_t data_size;      /* of all IDAT chunks */
} png_header;

/* ---- chunks ---- */

/* Whether the chunk is passed to libspng: the critical ones, and palette and transparency where they apply.
 * Other chunks can then neither take memory nor be damaged. */
static bool is_wanted(const png_chunk *c, uint32_t color_type)
{
    const bool has_alpha = color_type & 4;
    if (png_chunk_is(c, "PLTE"))
        return color_type == SPNG_COLOR_TYPE_INDEXED; /* otherwise only a suggestion */
    if (png_chunk_is(c, "tRNS"))
        return !has_alpha;
    return !(c->type[0] & 0x20); /* ancillary chunks are lower case */
}

/* Finds all chunks (only those before IDAT unless to_end). Checks only the CRC of IEND, which libspng
 * ignores. */
static facet_result read_chunks(const unsigned char *bytes, size_t size, const char *name, bool to_end,
                                png_header *h, facet_error *error)
{
    *h = (png_header){0};
    const unsigned char *p = bytes + PNG_SIGNATURE_SIZE;
    const unsigned char *end = bytes + size;
    png_chunk c;
    if (!png_chunk_next(&p, end, &c))
        return fail(error, FACET_ERROR_INVALID, "%s: PNG: the file ends before IHDR", name);
    if (!png_chunk_is(&c, "IHDR") || c.end - c.start != PNG_CHUNK_FRAME + PNG_IHDR_SIZE)
        return fail(error, FACET_ERROR_INVALID, "%s: PNG: an IHDR chunk of 13 bytes was expected first",
                    name);
    h->width = load_u32_be(c.data);
    h->height = load_u32_be(c.data + 4);
    h->bit_depth = c.data[8];
    h->color_type = c.data[9];
    bool is_in_data = false; /* the last chunk was IDAT */
    for (;;) {
        if (!png_chunk_next(&p, end, &c))
            return fail(error, FACET_ERROR_INVALID, "%s: PNG: the file ends before %s", name,
                        h->data_size ? "IEND" : "IDAT");
        const bool is_data = png_chunk_is(&c, "IDAT");
        if (is_data && !to_end)
            return FACET_OK;
        if (png_chunk_is(&c, "IEND"))
            break;
        if (is_data && h->data_size && !is_in_data)
            return fail(error, FACET_ERROR_INVALID, "%s: PNG: the IDAT chunks do not follow each other",
                        name);
        if (is_data)
            h->data_size += png_chunk_size(&c);
        else if (png_chunk_is(&c, "tRNS") && h->data_size == 0)
            h->has_transparency = is_wanted(&c, h->color_type);
        is_in_data = is_data;
    }
#ifndef FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION /* otherwise changes would not be detected beyond this point */
    if (c.end - c.start != PNG_CHUNK_FRAME || memcmp(c.data, "\xae\x42\x60\x82", 4) != 0)
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
        png_chunk c;
        while (s->next == s->part_end) {
            if (!png_chunk_next(&s->rest, s->end, &c))
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
    source s = {bytes, bytes + PNG_SIGNATURE_SIZE, bytes + PNG_SIGNATURE_SIZE, bytes + size, h.color_type};
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

#ifdef HAVE_LIBDEFLATE
/* ---- libdeflate ---- */

/* Texels of 8 bits with the file's own channels, converted as libspng does: gray is repeated, opaque is 255. */
static void set_channels(const unsigned char *from, uint32_t width, uint32_t own, uint32_t channels,
                         unsigned char *to)
{
    const uint32_t green = own > 2 ? 1 : 0;
    const uint32_t blue = own > 2 ? 2 : 0;
    if (own == channels) {
        memcpy(to, from, (size_t)width * own);
        return;
    }
    for (uint32_t x = 0; x < width; x++, from += own, to += channels) {
        to[0] = from[0];
        to[1] = from[green];
        to[2] = from[blue];
        if (channels == 4)
            to[3] = own % 2 ? 255 : from[own - 1];
    }
}

/* Passes the rows to the sink if that takes the file's own channels, otherwise to an image. */
static facet_result read_whole(const png_whole *p, const image_decode_desc *desc, image *out,
                               facet_error *error)
{
    const uint32_t channels = desc->channel_count ? desc->channel_count : p->channel_count;
    const bool in_rows = desc->sink && channels == p->channel_count;
    image made = codec_srgb_header(p->width, p->height, channels, IMAGE_U8);
    if (in_rows)
        TRY(desc->sink->begin(desc->sink->user, &made, error));
    else
        TRY(image_create(&desc->allocator, p->width, p->height, channels, IMAGE_U8, &made, error));
    made.is_srgb = true;
    unsigned char *to = made.pixels;
    *out = made;
    for (uint32_t y = 0; y < p->height; y++) {
        const unsigned char *row = png_whole_row(p, y);
        if (in_rows)
            TRY(desc->sink->add_row(desc->sink->user, row, error));
        else
            set_channels(row, p->width, p->channel_count, channels, to + y * image_row_size(&made));
    }
    return FACET_OK;
}

/* False: libspng reads the file. */
static bool decode_whole(const unsigned char *bytes, size_t size, const image_decode_desc *desc, image *out,
                         facet_result *result, facet_error *error)
{
    png_whole p;
    if (!png_whole_open(bytes, size, &desc->allocator, &p))
        return false;
    *result = read_whole(&p, desc, out, error);
    png_whole_close(&p);
    return true;
}
#else
static bool decode_whole(const unsigned char *bytes, size_t size, const image_decode_desc *desc, image *out,
                         facet_result *result, facet_error *error)
{
    (void)bytes, (void)size, (void)desc, (void)out, (void)result, (void)error;
    return false;
}
#endif

/* Any file, through libspng. */
static facet_result decode_any(const unsigned char *bytes, size_t size, const png_header *h, const char *name,
                               const image_decode_desc *desc, image *out, facet_error *error)
{
    source s = {bytes, bytes + PNG_SIGNATURE_SIZE, bytes + PNG_SIGNATURE_SIZE, bytes + size, h->color_type};
    spng_ctx *context = spng_ctx_new(0);
    facet_result result = context ? decode(context, h, &s, name, desc, out, error)
                                  : fail_memory(error, "PNG decoder", LIBRARY_MEMORY);
    spng_ctx_free(context);
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
    if (!mem_account(&desc->allocator, library_memory))
        return fail_memory(error, "PNG decoder", (size_t)library_memory);
    facet_result result = FACET_OK;
    if (!decode_whole(bytes, size, desc, &made, &result, error))
        result = decode_any(bytes, size, &h, name, desc, &made, error);
    mem_account(&desc->allocator, -library_memory);
    if (result == FACET_OK)
        result = convert(desc, &made, error);
    if (result == FACET_OK)
        *out = made;
    else
        image_destroy(&made);
    return result;
}
