/* codec_bmp.c - Windows and OS/2 bitmaps of 1, 4, 8, 16, 24 and 32 bits with palettes, bit fields, RLE4 and
 * RLE8. Microsoft, "Bitmap Storage" (BITMAPFILEHEADER, BITMAPCOREHEADER, BITMAPINFOHEADER, BITMAPV5HEADER). */
#include "image/codec.h"

#include <stdlib.h>
#include <string.h>

#include "base/result.h"
#include "image/texel_masks.h"

enum { FILE_HEADER = 14, CORE_HEADER = 12, INFO_HEADER = 40 };
enum { PLAIN = 0, RLE8 = 1, RLE4 = 2, BIT_FIELDS = 3, ALPHA_BIT_FIELDS = 6 };

typedef struct bmp_header {
    uint32_t width, height, bits, compression, channel_count;
    bool is_top_down;
    texel_masks masks;            /* for texels of at least 16 bits, or for the palette */
    const unsigned char *palette; /* NULL: texels are colors */
    uint32_t palette_count;
    const unsigned char *data;
    size_t data_size, row_size;
} bmp_header;

static uint32_t load_u16(const unsigned char *p)
{
    return p[0] | (uint32_t)p[1] << 8;
}

bool bmp_detect(const unsigned char *bytes, size_t size)
{
    static const uint32_t sizes[] = {CORE_HEADER, INFO_HEADER, 52, 56, 64, 108, 124};
    if (size < FILE_HEADER + CORE_HEADER || memcmp(bytes, "BM", 2) != 0)
        return false;
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++)
        if (load_u32_le(bytes + FILE_HEADER) == sizes[i])
            return true;
    return false;
}

/* Masks of texels of 16, 24 or 32 bits, which may follow a header of 40 bytes. */
static bool choose_masks(const unsigned char *info, size_t size, uint32_t header_size, bmp_header *h)
{
    h->masks = h->bits == 16 ? texel_masks_555 : h->bits == 24 ? texel_masks_bgr : texel_masks_bgrx;
    if (h->compression != PLAIN) {
        const bool has_alpha = h->compression == ALPHA_BIT_FIELDS || header_size >= 56;
        const size_t count = has_alpha ? 4 : 3;
        if (size < INFO_HEADER + 4 * count || h->bits == 24)
            return false;
        for (size_t c = 0; c < count; c++)
            h->masks.channels[c] = load_u32_le(info + INFO_HEADER + 4 * c);
    }
    h->channel_count = h->masks.channels[3] ? 4 : 3;
    return true;
}

/* The palette after the header, with the number of colors that the header states, at most 2^bits. */
static bool find_palette(const unsigned char *info, size_t size, uint32_t header_size, bmp_header *h)
{
    const uint32_t said = header_size == CORE_HEADER ? 0 : load_u32_le(info + 32);
    const uint32_t most = 1u << h->bits;
    h->masks = header_size == CORE_HEADER ? texel_masks_bgr : texel_masks_bgrx;
    h->channel_count = 3;
    h->palette_count = said && said < most ? said : most;
    if (size <= header_size)
        return false;
    const size_t room =
        (size - header_size) / h->masks.byte_count; /* a truncated palette ends with the file */
    h->palette_count = h->palette_count < room ? h->palette_count : (uint32_t)room;
    h->palette = info + header_size;
    return h->palette_count > 0;
}

static bool parse_sizes(const unsigned char *info, uint32_t header_size, bmp_header *h)
{
    if (header_size == CORE_HEADER) {
        h->width = load_u16(info + 4);
        h->height = load_u16(info + 6);
        h->bits = load_u16(info + 10);
        return true;
    }
    const int32_t width = (int32_t)load_u32_le(info + 4), height = (int32_t)load_u32_le(info + 8);
    h->is_top_down = height < 0;
    h->width = (uint32_t)width;
    h->height = height < 0 ? 0u - (uint32_t)height : (uint32_t)height;
    h->bits = load_u16(info + 14);
    h->compression = load_u32_le(info + 16);
    return width > 0 && height != INT32_MIN;
}

static facet_result parse_header(const unsigned char *bytes, size_t size, const char *name, bmp_header *h,
                                 facet_error *error)
{
    *h = (bmp_header){0};
    const unsigned char *info = bytes + FILE_HEADER;
    const size_t info_size = size - FILE_HEADER;
    const uint32_t header_size = load_u32_le(info), offset = load_u32_le(bytes + 10);
    if (header_size > info_size || !parse_sizes(info, header_size, h) || offset >= size)
        return fail(error, FACET_ERROR_INVALID, "%s: BMP: the header is damaged", name);
    const bool is_mapped = h->bits == 1 || h->bits == 2 || h->bits == 4 || h->bits == 8;
    const bool is_color = h->bits == 16 || h->bits == 24 || h->bits == 32;
    const bool is_known = h->compression == PLAIN || (h->compression == RLE8 && h->bits == 8) ||
                          (h->compression == RLE4 && h->bits == 4) ||
                          (is_color && (h->compression == BIT_FIELDS || h->compression == ALPHA_BIT_FIELDS));
    if (!(is_mapped || is_color) || !is_known)
        return fail(error, FACET_ERROR_UNSUPPORTED, "%s: BMP: %u bits with compression %u are not read", name,
                    h->bits, h->compression);
    if (!(is_mapped ? find_palette : choose_masks)(info, info_size, header_size, h))
        return fail(error, FACET_ERROR_INVALID, "%s: BMP: the palette or the bit fields are missing", name);
    h->data = bytes + offset;
    h->data_size = size - offset;
    h->row_size = ((size_t)h->width * h->bits + 31) / 32 * 4;
    return FACET_OK;
}

/* Whether the bytes can hold the texels; two bytes of RLE encode at most 255 texels. */
static facet_result check(const bmp_header *h, const char *name, uint32_t max_size, facet_error *error)
{
    const bool has_runs = h->compression == RLE8 || h->compression == RLE4;
    const uint64_t texels = (uint64_t)h->width * h->height;
    /* the last row may lack its padding */
    const uint64_t least =
        has_runs ? (texels + 254) / 255 * 2
                 : (uint64_t)h->row_size * (h->height - 1) + ((uint64_t)h->width * h->bits + 7) / 8;
    return codec_check_texels(name, "BMP", h->width, h->height, max_size, least, h->data_size, error);
}

facet_result bmp_probe(const unsigned char *bytes, size_t size, const char *name, image *header,
                       facet_error *error)
{
    bmp_header h;
    TRY(parse_header(bytes, size, name, &h, error));
    TRY(check(&h, name, UINT32_MAX, error));
    *header = codec_srgb_header(h.width, h.height, h.channel_count, IMAGE_U8);
    return FACET_OK;
}

/* ---- texels ---- */

/* False: the palette has no such color. */
static bool put_color(const bmp_header *h, uint32_t index, unsigned char *texel)
{
    if (index >= h->palette_count)
        return false;
    texel_masks_unpack(&h->masks, h->palette + (size_t)index * h->masks.byte_count, 1, 3, texel);
    return true;
}

static bool read_mapped_row(const bmp_header *h, const unsigned char *row, unsigned char *texels)
{
    const uint32_t per_byte = 8 / h->bits, mask = (1u << h->bits) - 1;
    for (uint32_t x = 0; x < h->width; x++)
        if (!put_color(h, (uint32_t)row[x / per_byte] >> (8 - h->bits * (x % per_byte + 1)) & mask,
                       texels + 3 * (size_t)x))
            return false;
    return true;
}

/* Target of runs; texels beyond the end of a row are dropped, as in other readers. */
typedef struct run_place {
    uint32_t x, y;
} run_place;

static bool put_run(const bmp_header *h, unsigned char *texels, run_place *at, uint32_t count,
                    const unsigned char *colors, bool is_literal)
{
    for (uint32_t i = 0; i < count; i++, at->x++) {
        const uint32_t index = h->compression == RLE8 ? colors[is_literal ? i : 0]
                               : i % 2 == 0           ? colors[is_literal ? i / 2 : 0] >> 4
                                                      : colors[is_literal ? i / 2 : 0] & 15;
        if (at->x < h->width && at->y < h->height &&
            !put_color(h, index, texels + 3 * ((size_t)at->y * h->width + at->x)))
            return false;
    }
    return true;
}

static const char no_color[] = "a texel is no color of the palette", cut_off[] = "the texels are cut off";

/* Pairs of bytes: a count and a color; or 0 and an escape: 0 ends the row, 1 ends the image, 2 is followed by
 * two bytes to skip right and up, otherwise that many colors follow, padded to an even number of bytes.
 * Skipped texels have the first color. Returns NULL or what is wrong. */
static const char *read_runs(const bmp_header *h, unsigned char *texels)
{
    const unsigned char *p = h->data, *end = h->data + h->data_size;
    run_place at = {0, 0};
    for (size_t i = 0; i < (size_t)h->width * h->height; i++)
        if (!put_color(h, 0, texels + 3 * i))
            return no_color;
    while (at.y < h->height) {
        if (end - p < 2)
            return cut_off;
        const uint32_t count = p[0], code = p[1];
        p += 2;
        if (count > 0) {
            if (!put_run(h, texels, &at, count, p - 1, false))
                return no_color;
        } else if (code == 0) {
            at = (run_place){0, at.y + 1};
        } else if (code == 1) {
            return NULL;
        } else {
            const size_t bytes = code == 2 ? 2 : h->compression == RLE8 ? code : (code + 1) / 2;
            if ((size_t)(end - p) < bytes)
                return cut_off;
            if (code == 2)
                at = (run_place){at.x + p[0], at.y + p[1]};
            else if (!put_run(h, texels, &at, code, p, true))
                return no_color;
            p += bytes + bytes % 2;
            p = p < end ? p : end;
        }
    }
    return NULL;
}

static const char *read_texels(const bmp_header *h, image *out)
{
    if (h->compression == RLE8 || h->compression == RLE4)
        return read_runs(h, out->pixels);
    for (uint32_t y = 0; y < h->height; y++) {
        const unsigned char *row = h->data + y * h->row_size;
        unsigned char *texels = (unsigned char *)out->pixels + y * image_row_size(out);
        if (!h->palette)
            texel_masks_unpack(&h->masks, row, h->width, h->channel_count, texels);
        else if (!read_mapped_row(h, row, texels))
            return no_color;
    }
    return NULL;
}

facet_result bmp_decode(const unsigned char *bytes, size_t size, const char *name,
                        const image_decode_desc *desc, image *out, facet_error *error)
{
    bmp_header h;
    TRY(parse_header(bytes, size, name, &h, error));
    TRY(check(&h, name, desc->max_size, error));
    TRY(image_create(&desc->allocator, h.width, h.height, h.channel_count, IMAGE_U8, out, error));
    out->is_srgb = true;
    const char *fault = read_texels(&h, out);
    if (fault) {
        image_destroy(out);
        return fail(error, FACET_ERROR_INVALID, "%s: BMP: %s", name, fault);
    }
    codec_flip(out, false, !h.is_top_down);
    texel_masks_fill_unused_alpha(out);
    return codec_set_channels(out, desc, error);
}
