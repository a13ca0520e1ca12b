/* codec_png.c - reading PNG: chunks, filters, interlacing, palettes and transparency. Writing:
 * png_write.c. Specification: Portable Network Graphics, third edition (W3C). Gamma, profiles and texts
 * are passed over. */
#include "image/codec.h"

#include <string.h>

#include <zlib.h>

#include "base/memory.h"
#include "base/result.h"
#include "image/inflate.h"
#include "image/png_filter.h"

enum { SIGNATURE_SIZE = 8, CHUNK_FRAME = 12 /* length, type, CRC */, IHDR_SIZE = 13, PALETTE_SIZE = 256 };

typedef enum color_type {
    COLOR_GREY = 0,
    COLOR_RGB = 2,
    COLOR_PALETTE = 3,
    COLOR_GREY_ALPHA = 4,
    COLOR_RGBA = 6
} color_type;

/* What the chunks say. */
typedef struct png_header {
    uint32_t width, height;
    uint32_t bit_depth;
    color_type color_type;
    bool is_interlaced;
    bool has_transparency; /* tRNS that counts */
    uint32_t palette_count;
    unsigned char palette[PALETTE_SIZE][4]; /* RGBA; entries that the file lacks are black */
    uint16_t transparent[3];                /* the grey or RGB that tRNS makes transparent */
    const unsigned char *data;              /* of the first IDAT chunk */
    size_t data_size;                       /* of all */
    uint32_t data_count;                    /* IDAT chunks; they follow each other */
} png_header;

typedef struct chunk {
    const unsigned char *type, *data;
    size_t size;
} chunk;

/* ---- chunks ---- */

static bool is_type(const chunk *c, const char type[4])
{
    return memcmp(c->type, type, 4) == 0;
}

/* The chunk at *p, which moves behind it; false: the file ends before that. */
static bool next_chunk(const unsigned char **p, const unsigned char *end, chunk *c)
{
    if (end - *p < CHUNK_FRAME)
        return false;
    c->size = load_u32_be(*p);
    if (c->size > (size_t)(end - *p) - CHUNK_FRAME)
        return false;
    c->type = *p + 4;
    c->data = *p + 8;
    *p += CHUNK_FRAME + c->size;
    return true;
}

static bool is_intact(const chunk *c)
{
#ifdef FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION
    (void)c; /* else no change would come further than this */
    return true;
#else
    return crc32_z(0, c->type, c->size + 4) == load_u32_be(c->data + c->size);
#endif
}

static facet_result read_ihdr(const chunk *c, const char *name, png_header *h, facet_error *error)
{
    static const uint32_t depths[] = {/* a bit per depth allowed */
                                      [COLOR_GREY] = 1 << 1 | 1 << 2 | 1 << 4 | 1 << 8 | 1 << 16,
                                      [COLOR_RGB] = 1 << 8 | 1 << 16,
                                      [COLOR_PALETTE] = 1 << 1 | 1 << 2 | 1 << 4 | 1 << 8,
                                      [COLOR_GREY_ALPHA] = 1 << 8 | 1 << 16,
                                      [COLOR_RGBA] = 1 << 8 | 1 << 16};
    if (!is_type(c, "IHDR") || c->size != IHDR_SIZE)
        return fail(error, FACET_ERROR_INVALID, "%s: PNG: an IHDR chunk of 13 bytes was expected first",
                    name);
    if (!is_intact(c))
        return fail(error, FACET_ERROR_INVALID, "%s: PNG: the CRC of IHDR does not fit", name);
    h->width = load_u32_be(c->data);
    h->height = load_u32_be(c->data + 4);
    h->bit_depth = c->data[8];
    h->color_type = (color_type)c->data[9];
    h->is_interlaced = c->data[12] != 0;
    if (c->data[9] > COLOR_RGBA || c->data[8] > 16 || !(depths[c->data[9]] >> c->data[8] & 1))
        return fail(error, FACET_ERROR_INVALID, "%s: PNG: color type %d with %d bits a sample", name,
                    c->data[9], c->data[8]);
    if (c->data[10] != 0 || c->data[11] != 0 || c->data[12] > 1)
        return fail(error, FACET_ERROR_INVALID,
                    "%s: PNG: compression %d, filter %d, interlace %d are not known", name, c->data[10],
                    c->data[11], c->data[12]);
    return codec_check_size(name, h->width, h->height, INT32_MAX, error);
}

static facet_result read_palette(const chunk *c, const char *name, png_header *h, facet_error *error)
{
    if (h->color_type != COLOR_PALETTE) /* a suggestion */
        return FACET_OK;
    if (h->palette_count || c->size % 3 != 0 || c->size == 0 || c->size > 3 * PALETTE_SIZE)
        return fail(error, FACET_ERROR_INVALID, "%s: PNG: PLTE: once 1 to 256 colors were expected", name);
    h->palette_count = (uint32_t)c->size / 3;
    for (uint32_t i = 0; i < h->palette_count; i++)
        memcpy(h->palette[i], c->data + 3 * i, 3);
    return FACET_OK;
}

static facet_result read_transparency(const chunk *c, const char *name, png_header *h, facet_error *error)
{
    const size_t samples = h->color_type == COLOR_RGB ? 3 : 1;
    bool is_right = true;
    if (h->color_type == COLOR_PALETTE) {
        is_right = c->size <= h->palette_count;
        for (size_t i = 0; is_right && i < c->size; i++)
            h->palette[i][3] = c->data[i];
    } else if (h->color_type == COLOR_GREY || h->color_type == COLOR_RGB) {
        is_right = c->size == 2 * samples;
        for (size_t i = 0; is_right && i < samples; i++)
            h->transparent[i] = (uint16_t)(c->data[2 * i] << 8 | c->data[2 * i + 1]);
    } else {
        return FACET_OK; /* has alpha of its own */
    }
    if (!is_right)
        return fail(error, FACET_ERROR_INVALID, "%s: PNG: tRNS: %zu bytes do not fit color type %d", name,
                    c->size, (int)h->color_type);
    h->has_transparency = true;
    return FACET_OK;
}

/* Reads all chunks; those before IDAT only where to_end is false. */
static facet_result read_chunks(const unsigned char *bytes, size_t size, const char *name, bool to_end,
                                png_header *h, facet_error *error)
{
    *h = (png_header){0};
    for (int i = 0; i < PALETTE_SIZE; i++)
        h->palette[i][3] = 255;
    const unsigned char *p = bytes + SIGNATURE_SIZE;
    const unsigned char *end = bytes + size;
    chunk c;
    if (!next_chunk(&p, end, &c))
        return fail(error, FACET_ERROR_INVALID, "%s: PNG: the file ends before IHDR", name);
    facet_result result = read_ihdr(&c, name, h, error);
    bool is_in_data = false; /* the last chunk was IDAT */
    while (result == FACET_OK) {
        if (!next_chunk(&p, end, &c))
            return fail(error, FACET_ERROR_INVALID, "%s: PNG: the file ends before %s", name,
                        h->data ? "IEND" : "IDAT");
        const bool is_data = is_type(&c, "IDAT");
        if (is_data && !to_end)
            return FACET_OK;
        const bool is_used = !(c.type[0] & 0x20) || is_type(&c, "tRNS"); /* ancillary ones are lower case */
        if (is_used && !is_intact(&c))
            return fail(error, FACET_ERROR_INVALID, "%s: PNG: the CRC of %.4s does not fit", name,
                        (const char *)c.type);
        if (is_type(&c, "IEND"))
            break;
        if (is_data && h->data && !is_in_data)
            return fail(error, FACET_ERROR_INVALID, "%s: PNG: the IDAT chunks do not follow each other",
                        name);
        if (is_data) {
            h->data = h->data ? h->data : c.data;
            h->data_size += c.size;
            h->data_count++;
        } else if (is_type(&c, "PLTE")) {
            result = read_palette(&c, name, h, error);
        } else if (is_type(&c, "tRNS")) {
            result = h->data ? FACET_OK : read_transparency(&c, name, h, error);
        } else if (is_used) {
            return fail(error, FACET_ERROR_INVALID, "%s: PNG: chunk %.4s is not known", name,
                        (const char *)c.type);
        }
        is_in_data = is_data;
    }
    if (result == FACET_OK && (!h->data || (h->color_type == COLOR_PALETTE && h->palette_count == 0)))
        return fail(error, FACET_ERROR_INVALID, "%s: PNG: there is no %s chunk", name,
                    h->data ? "PLTE" : "IDAT");
    return result;
}

static uint32_t own_channel_count(const png_header *h)
{
    switch (h->color_type) {
    case COLOR_GREY:
        return h->has_transparency ? 2 : 1;
    case COLOR_GREY_ALPHA:
        return 2;
    case COLOR_RGBA:
        return 4;
    default:
        return h->has_transparency ? 4 : 3;
    }
}

facet_result png_probe(const unsigned char *bytes, size_t size, const char *name, image *header,
                       facet_error *error)
{
    png_header h;
    facet_result result = read_chunks(bytes, size, name, false, &h, error);
    if (result == FACET_OK)
        *header = (image){.width = h.width,
                          .height = h.height,
                          .channel_count = own_channel_count(&h),
                          .type = h.bit_depth == 16 ? IMAGE_U16 : IMAGE_U8,
                          .is_srgb = true};
    return result;
}

/* ---- rows ---- */

/* The pictures that interlacing makes of one, in their order: each texel from (x, y) on in steps. */
typedef struct pass {
    uint32_t x, y, x_step, y_step;
} pass;

static const pass whole[] = {{0, 0, 1, 1}};
static const pass adam7[] = {{0, 0, 8, 8}, {4, 0, 8, 8}, {0, 4, 4, 8}, {2, 0, 4, 4},
                             {0, 2, 2, 4}, {1, 0, 2, 2}, {0, 1, 1, 2}};

static uint32_t steps(uint32_t size, uint32_t first, uint32_t step)
{
    return size > first ? (size - first + step - 1) / step : 0;
}

static uint32_t sample_count(const png_header *h)
{
    static const uint32_t counts[] = {
        [COLOR_GREY] = 1, [COLOR_RGB] = 3, [COLOR_PALETTE] = 1, [COLOR_GREY_ALPHA] = 2, [COLOR_RGBA] = 4};
    return counts[h->color_type];
}

/* Bytes of a row of width texels, without the filter byte. */
static size_t row_size(const png_header *h, uint32_t width)
{
    return (size_t)(((uint64_t)width * sample_count(h) * h->bit_depth + 7) / 8);
}

/* Sample k of a row of 1, 2, 4, 8 or 16 bits each. */
static uint32_t get_sample(const unsigned char *row, uint32_t bit_depth, size_t k)
{
    if (bit_depth == 8)
        return row[k];
    if (bit_depth == 16)
        return (uint32_t)row[2 * k] << 8 | row[2 * k + 1];
    size_t bit = k * bit_depth;
    return row[bit / 8] >> (8 - bit_depth - bit % 8) & ((1u << bit_depth) - 1);
}

/* One texel of a row, whatever the layout, as RGBA of the picture's type: 8 bits (of less, spread) or 16. */
static void get_texel(const png_header *h, const unsigned char *row, uint32_t x, uint32_t rgba[4])
{
    const uint32_t depth = h->bit_depth;
    const uint32_t opaque = depth == 16 ? 65535 : 255;
    const uint32_t spread = depth < 8 ? 255 / ((1u << depth) - 1) : 1;
    const size_t k = (size_t)x * sample_count(h);
    uint32_t s[4];
    for (uint32_t c = 0; c < sample_count(h); c++)
        s[c] = get_sample(row, depth, k + c);
    rgba[3] = opaque;
    switch (h->color_type) {
    case COLOR_PALETTE:
        for (int c = 0; c < 4; c++)
            rgba[c] = h->palette[s[0]][c];
        return;
    case COLOR_GREY:
    case COLOR_GREY_ALPHA:
        rgba[0] = rgba[1] = rgba[2] = s[0] * spread;
        if (h->color_type == COLOR_GREY_ALPHA)
            rgba[3] = s[1];
        else if (h->has_transparency && s[0] == h->transparent[0])
            rgba[3] = 0;
        return;
    case COLOR_RGB:
    case COLOR_RGBA:
        for (int c = 0; c < 3; c++)
            rgba[c] = s[c];
        if (h->color_type == COLOR_RGBA)
            rgba[3] = s[3];
        else if (h->has_transparency && s[0] == h->transparent[0] && s[1] == h->transparent[1] &&
                 s[2] == h->transparent[2])
            rgba[3] = 0;
        return;
    }
}

/* A row of a pass to texels of the picture that are step apart. */
static void store_row(const png_header *h, const unsigned char *row, uint32_t width, image *out, size_t first,
                      size_t step)
{
    const uint32_t channels = out->channel_count;
    if (h->bit_depth == 8 && h->color_type == COLOR_RGB && channels == 4 && !h->has_transparency) {
        unsigned char *to = (unsigned char *)out->pixels + 4 * first;
        for (uint32_t x = 0; x < width; x++, row += 3, to += 4 * step) {
            to[0] = row[0];
            to[1] = row[1];
            to[2] = row[2];
            to[3] = 255;
        }
        return;
    }
    for (uint32_t x = 0; x < width; x++) {
        uint32_t rgba[4];
        get_texel(h, row, x, rgba);
        size_t at = (first + x * step) * channels;
        for (uint32_t c = 0; c < channels; c++) {
            uint32_t value = channels == 2 && c == 1 ? rgba[3] : rgba[c];
            if (out->type == IMAGE_U8)
                ((uint8_t *)out->pixels)[at + c] = (uint8_t)value;
            else
                ((uint16_t *)out->pixels)[at + c] = (uint16_t)value;
        }
    }
}

/* Whether filtered rows become the picture's as they are. */
static bool is_direct(const png_header *h, const image *out)
{
    return !h->is_interlaced && h->bit_depth == 8 && h->color_type != COLOR_PALETTE &&
           sample_count(h) == out->channel_count;
}

/* Undoes the filters of all rows and stores them; rows is clobbered. 0: done, else the filter that is
 * unknown. */
static int store_rows(const png_header *h, unsigned char *rows, const unsigned char *zeros, image *out)
{
    const pass *passes = h->is_interlaced ? adam7 : whole;
    const size_t texel = (sample_count(h) * h->bit_depth + 7) / 8;
    for (size_t p = 0; p < (h->is_interlaced ? 7 : 1); p++) {
        const uint32_t width = steps(h->width, passes[p].x, passes[p].x_step);
        const uint32_t height = steps(h->height, passes[p].y, passes[p].y_step);
        const size_t size = row_size(h, width);
        const unsigned char *above = zeros;
        for (uint32_t y = 0; y < height && width > 0; y++, rows += 1 + size) {
            const size_t first =
                ((size_t)passes[p].y + (size_t)y * passes[p].y_step) * h->width + passes[p].x;
            unsigned char *row = is_direct(h, out) ? (unsigned char *)out->pixels + first * texel : rows + 1;
            if (*rows > PNG_PAETH)
                return *rows;
            png_unfilter((png_filter)*rows, rows + 1, above, size, texel, row);
            if (row == rows + 1)
                store_row(h, row, width, out, first, passes[p].x_step);
            above = row;
        }
    }
    return 0;
}

/* ---- the picture ---- */

/* Bytes of all filtered rows. */
static uint64_t rows_size(const png_header *h)
{
    const pass *passes = h->is_interlaced ? adam7 : whole;
    uint64_t size = 0;
    for (size_t p = 0; p < (h->is_interlaced ? 7 : 1); p++) {
        const uint32_t width = steps(h->width, passes[p].x, passes[p].x_step);
        const uint32_t height = steps(h->height, passes[p].y, passes[p].y_step);
        if (width > 0)
            size += (uint64_t)height * (1 + row_size(h, width));
    }
    return size;
}

/* The zlib stream: in place where one chunk holds it, else put together in a block of mem_alloc(). */
static const unsigned char *join_data(const png_header *h, const facet_allocator *allocator,
                                      unsigned char **block)
{
    if (h->data_count == 1)
        return h->data;
    *block = mem_alloc(allocator, h->data_size, 1);
    const unsigned char *from = h->data;
    unsigned char *to = *block;
    for (uint32_t k = 0; k < h->data_count && to; k++) {
        size_t size = load_u32_be(from - 8);
        memcpy(to, from, size);
        to += size;
        from += size + CHUNK_FRAME;
    }
    return *block;
}

facet_result png_decode(const unsigned char *bytes, size_t size, const char *name,
                        const image_decode_desc *desc, image *out, facet_error *error)
{
    png_header h;
    image made = {0};
    unsigned char *joined = NULL;
    unsigned char *rows = NULL;
    facet_result result = read_chunks(bytes, size, name, true, &h, error);
    if (result == FACET_OK)
        result = codec_check_size(name, h.width, h.height, desc->max_size, error);
    if (result != FACET_OK)
        return result;
    /* deflate makes at most 1032 bytes of one: refuse before memory is taken */
    const uint64_t filtered_size = rows_size(&h);
    if (filtered_size / 1032 > h.data_size)
        return fail(error, FACET_ERROR_INVALID, "%s: PNG: %zu bytes of IDAT cannot hold %u x %u texels", name,
                    h.data_size, h.width, h.height);
    const size_t longest_row = row_size(&h, h.width);
    const uint32_t channel_count = desc->channel_count ? desc->channel_count : own_channel_count(&h);
    const unsigned char *data = join_data(&h, &desc->allocator, &joined);
    rows = mem_alloc(&desc->allocator, (size_t)filtered_size + longest_row, 1); /* and one row of zeros */
    if (!data || !rows) {
        result = fail_memory(error, "PNG rows", (size_t)filtered_size);
        goto done;
    }
    result = image_create(&desc->allocator, h.width, h.height, channel_count,
                          h.bit_depth == 16 ? IMAGE_U16 : IMAGE_U8, &made, error);
    if (result != FACET_OK)
        goto done;
    made.is_srgb = true;
    memset(rows + filtered_size, 0, longest_row);
    int unknown_filter = 0;
    if (!zlib_inflate(data, h.data_size, rows, (size_t)filtered_size))
        result = fail(error, FACET_ERROR_INVALID, "%s: PNG: the compressed data is damaged", name);
    else if ((unknown_filter = store_rows(&h, rows, rows + filtered_size, &made)) != 0)
        result =
            fail(error, FACET_ERROR_INVALID, "%s: PNG: filter %d, 0 to 4 was expected", name, unknown_filter);
done:
    mem_free(rows);
    mem_free(joined);
    if (result == FACET_OK)
        *out = made;
    else
        image_destroy(&made);
    return result;
}
