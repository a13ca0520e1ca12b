/* codec_png.c - reading PNG through libspng. Writing: png_write.c. */
#include "image/codec.h"

#include <string.h>

#include <spng.h>

#include "base/memory.h"
#include "base/result.h"
#include "image/library_memory.h"

enum { SIGNATURE_SIZE = 8, CHUNK_FRAME = 12 /* length, type, CRC */, IHDR_SIZE = 13 };

/* What the chunk headers say; CRCs are not looked at. */
typedef struct png_header {
    uint32_t width, height;
    uint32_t bit_depth, color_type;
    bool has_transparency; /* tRNS */
    size_t data_size;      /* of all IDAT chunks */
} png_header;

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

/* Walks over the chunks up to IDAT, or to the end of all IDATs (to_end). */
static facet_result parse_chunks(const unsigned char *bytes, size_t size, const char *name, bool to_end,
                                 png_header *h, facet_error *error)
{
    *h = (png_header){0};
    size_t at = SIGNATURE_SIZE;
    if (size < SIGNATURE_SIZE + CHUNK_FRAME + IHDR_SIZE || load_u32_be(bytes + at) != IHDR_SIZE ||
        memcmp(bytes + at + 4, "IHDR", 4) != 0)
        return fail(error, FACET_ERROR_INVALID, "%s: an IHDR chunk of 13 bytes was expected first", name);
    const unsigned char *ihdr = bytes + at + 8;
    h->width = load_u32_be(ihdr);
    h->height = load_u32_be(ihdr + 4);
    h->bit_depth = ihdr[8];
    h->color_type = ihdr[9];
    for (at += CHUNK_FRAME + IHDR_SIZE; size - at >= CHUNK_FRAME;) {
        size_t length = load_u32_be(bytes + at);
        bool is_data = memcmp(bytes + at + 4, "IDAT", 4) == 0;
        if (length > size - at - CHUNK_FRAME)
            break; /* cut off: the decoder says so */
        if ((is_data && !to_end) || (!is_data && h->data_size))
            break;
        if (is_data)
            h->data_size += length;
        else if (memcmp(bytes + at + 4, "tRNS", 4) == 0)
            h->has_transparency = true;
        at += CHUNK_FRAME + length;
    }
    return FACET_OK;
}

facet_result png_probe(const unsigned char *bytes, size_t size, const char *name, image *header,
                       facet_error *error)
{
    png_header h;
    facet_result result = parse_chunks(bytes, size, name, false, &h, error);
    if (result == FACET_OK)
        result = codec_check_size(name, h.width, h.height, UINT32_MAX, error);
    if (result == FACET_OK)
        *header = (image){.width = h.width,
                          .height = h.height,
                          .channel_count = own_channel_count(&h),
                          .type = h.bit_depth == 16 ? IMAGE_U16 : IMAGE_U8,
                          .is_srgb = true};
    return result;
}

/* Deflate codes at most 258 bytes in 2 bits: refuses pictures that the data cannot fill, before memory is taken
 * for them. Sub-byte rows and those of interlace passes are counted a little too small, never too large. */
static facet_result check_data_size(const png_header *h, const char *name, facet_error *error)
{
    static const uint32_t samples[] = {1, 0, 3, 1, 2, 0, 4};
    uint64_t bits = h->color_type < 7 ? (uint64_t)samples[h->color_type] * h->bit_depth : 0;
    uint64_t needed = (uint64_t)h->height * ((uint64_t)h->width * bits / 8);
    if (needed / 1032 > h->data_size)
        return fail(error, FACET_ERROR_INVALID, "%s: %zu bytes of IDAT cannot hold %u x %u texels", name,
                    h->data_size, h->width, h->height);
    return FACET_OK;
}

/* The layout that libspng is to write, and whether tRNS takes part (*flags). *channel_count: what is asked for
 * (0: the file's own), then what comes: 16 bits come with the file's own channels. */
static int choose_format(const png_header *h, uint32_t *channel_count, int *flags)
{
    bool is_grey = h->color_type == SPNG_COLOR_TYPE_GRAYSCALE;
    *flags = h->has_transparency ? SPNG_DECODE_TRNS : 0;
    if (*channel_count == 0 || h->bit_depth == 16)
        *channel_count = own_channel_count(h);
    if (h->bit_depth == 16) {
        if (h->has_transparency)
            return is_grey ? SPNG_FMT_GA16 : SPNG_FMT_RGBA16;
        return SPNG_FMT_PNG;
    }
    switch (*channel_count) {
    case 1:
        return SPNG_FMT_G8;
    case 2:
        return is_grey ? SPNG_FMT_GA8 : SPNG_FMT_PNG;
    case 3:
        *flags = 0;
        return SPNG_FMT_RGB8;
    default:
        return SPNG_FMT_RGBA8;
    }
}

static facet_result fail_png(facet_error *error, const char *name, int code)
{
    if (library_memory_has_failed())
        return fail_memory(error, "PNG decoder", 0);
    return fail(error, FACET_ERROR_INVALID, "%s: PNG: %s", name, spng_strerror(code));
}

static facet_result decode(spng_ctx *context, const unsigned char *bytes, size_t size, const char *name,
                           const image_decode_desc *desc, image *out, facet_error *error)
{
    png_header h;
    facet_result result = parse_chunks(bytes, size, name, true, &h, error);
    if (result != FACET_OK)
        return result;
    struct spng_ihdr ihdr;
    int code = spng_set_crc_action(context, SPNG_CRC_ERROR, SPNG_CRC_DISCARD);
    if (code == 0)
        code = spng_set_image_limits(context, INT32_MAX, INT32_MAX); /* ours follows, with a better message */
    if (code == 0)
        code = spng_set_png_buffer(context, bytes, size);
    if (code == 0)
        code = spng_get_ihdr(context, &ihdr);
    if (code != 0)
        return fail_png(error, name, code);
    result = codec_check_size(name, h.width, h.height, desc->max_size, error);
    if (result == FACET_OK)
        result = check_data_size(&h, name, error);
    if (result != FACET_OK)
        return result;

    uint32_t channel_count = desc->channel_count;
    int flags;
    int format = choose_format(&h, &channel_count, &flags);
    size_t decoded_size;
    result = image_create(&desc->allocator, h.width, h.height, channel_count,
                          h.bit_depth == 16 ? IMAGE_U16 : IMAGE_U8, out, error);
    if (result != FACET_OK)
        return result;
    out->is_srgb = true;
    code = spng_decoded_image_size(context, format, &decoded_size);
    if (code == 0 && decoded_size != image_row_size(out) * out->height)
        return fail(error, FACET_ERROR_BUG, "%s: PNG: %zu bytes are not %u channels", name, decoded_size,
                    channel_count);
    if (code == 0)
        code = spng_decode_image(context, out->pixels, decoded_size, format, flags);
    if (code == 0)
        code = spng_decode_chunks(context); /* to the end, so that the last CRCs count */
    return code == 0 ? FACET_OK : fail_png(error, name, code);
}

facet_result png_decode(const unsigned char *bytes, size_t size, const char *name,
                        const image_decode_desc *desc, image *out, facet_error *error)
{
    struct spng_alloc hooks = {library_malloc, library_realloc, library_calloc, library_free};
    const facet_allocator *previous = library_memory_begin(&desc->allocator);
    image made = {0};
    facet_result result;
    spng_ctx *context = spng_ctx_new2(&hooks, 0);
    if (context)
        result = decode(context, bytes, size, name, desc, &made, error);
    else
        result = fail_memory(error, "PNG decoder", 0);
    spng_ctx_free(context);
    library_memory_end(previous);

    if (result == FACET_OK && desc->channel_count && made.channel_count != desc->channel_count) {
        result = image_convert(&made, &desc->allocator, desc->thread_count, desc->channel_count, made.type,
                               true, out, error);
        image_destroy(&made);
        return result;
    }
    if (result == FACET_OK)
        *out = made;
    else
        image_destroy(&made);
    return result;
}
