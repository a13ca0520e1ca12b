/* codec_gif.c - the first image of a GIF file, on its canvas. CompuServe, "Graphics Interchange Format,
 * Version 89a", 1990. */
#include "image/codec.h"

#include <string.h>

#include "base/memory.h"
#include "base/result.h"

enum {
    SCREEN_END = 13, /* after the logical screen descriptor */
    MAX_CODES = 4096,
    MAX_TEXELS_PER_BYTE = 2732 /* a 12-bit code encodes at most 4096 texels */
};

/* A reader over the bytes of a file. */
typedef struct cursor {
    const unsigned char *next, *end;
} cursor;

typedef struct gif_header {
    uint32_t width, height; /* of the canvas */
    uint32_t left, top, frame_width, frame_height;
    const unsigned char *colors; /* of the frame, 3 bytes each */
    uint32_t color_count;
    int transparent; /* color index; -1: none */
    bool is_interlaced;
    uint32_t code_bits;
    cursor data; /* sub-blocks of codes */
} gif_header;

static uint32_t load_u16(const unsigned char *p)
{
    return p[0] | (uint32_t)p[1] << 8;
}

/* The next count bytes; NULL: past the end. */
static const unsigned char *take(cursor *c, size_t count)
{
    if ((size_t)(c->end - c->next) < count)
        return NULL;
    const unsigned char *at = c->next;
    c->next += count;
    return at;
}

/* Skips sub-blocks up to the empty one; false: truncated. */
static bool skip_blocks(cursor *c)
{
    const unsigned char *length;
    do {
        length = take(c, 1);
        if (!length || !take(c, *length))
            return false;
    } while (*length);
    return true;
}

/* Reads a color table whose size is in packed; *count 0: none. False: truncated. */
static bool take_colors(cursor *c, unsigned packed, const unsigned char **colors, uint32_t *count)
{
    if (!(packed & 0x80))
        return true;
    *count = 2u << (packed & 7);
    *colors = take(c, (size_t)3 * *count);
    return *colors != NULL;
}

/* Reads the image descriptor up to its codes. False: truncated. */
static bool take_frame(cursor *c, gif_header *h)
{
    const unsigned char *d = take(c, 9);
    if (!d || !take_colors(c, d[8], &h->colors, &h->color_count))
        return false;
    h->left = load_u16(d);
    h->top = load_u16(d + 2);
    h->frame_width = load_u16(d + 4);
    h->frame_height = load_u16(d + 6);
    h->is_interlaced = d[8] & 0x40;
    const unsigned char *code_bits = take(c, 1);
    h->code_bits = code_bits ? *code_bits : 0;
    h->data = *c;
    return code_bits != NULL;
}

/* Finds the first frame. Returns NULL or what is wrong. */
static const char *find_frame(const unsigned char *bytes, size_t size, gif_header *h)
{
    static const char cut_off[] = "the file is cut off";
    *h = (gif_header){.transparent = -1};
    cursor c = {bytes, bytes + size};
    const unsigned char *screen = take(&c, SCREEN_END);
    if (!screen || !take_colors(&c, screen[10], &h->colors, &h->color_count))
        return cut_off;
    h->width = load_u16(screen + 6);
    h->height = load_u16(screen + 8);
    for (;;) {
        const unsigned char *kind = take(&c, 1);
        if (!kind)
            return cut_off;
        if (*kind == 0x2c)
            return take_frame(&c, h) ? NULL : cut_off;
        if (*kind == 0x3b)
            return "it holds no image";
        if (*kind != 0x21)
            return "a block is of no known kind";
        const unsigned char *label = take(&c, 1);
        if (!label)
            return cut_off;
        if (*label == 0xf9 && c.end - c.next >= 5 && c.next[0] == 4) /* graphic control */
            h->transparent = c.next[1] & 1 ? c.next[4] : -1;
        if (!skip_blocks(&c))
            return cut_off;
    }
}

static facet_result parse_header(const unsigned char *bytes, size_t size, const char *name, uint32_t max_size,
                                 gif_header *h, facet_error *error)
{
    const char *fault = find_frame(bytes, size, h);
    if (!fault && (h->frame_width == 0 || h->frame_height == 0))
        fault = "its image has no texels";
    if (!fault && h->color_count == 0)
        fault = "it has no colors";
    if (!fault && (h->code_bits < 2 || h->code_bits > 8))
        fault = "codes of a texel have 2 to 8 bits";
    if (fault)
        return fail(error, FACET_ERROR_INVALID, "%s: GIF: %s", name, fault);
    /* a canvas that is too small is enlarged, as in browsers */
    const uint32_t right = h->left + h->frame_width, bottom = h->top + h->frame_height;
    h->width = h->width > right ? h->width : right;
    h->height = h->height > bottom ? h->height : bottom;
    facet_result result = codec_check_size(name, h->width, h->height, max_size, error);
    if (result == FACET_OK && (uint64_t)h->width * h->height / MAX_TEXELS_PER_BYTE > size)
        return fail(error, FACET_ERROR_INVALID, "%s: GIF: %zu bytes cannot hold %u x %u texels", name, size,
                    h->width, h->height);
    return result;
}

static bool fills_canvas(const gif_header *h)
{
    return h->frame_width == h->width && h->frame_height == h->height;
}

static image make_header(const gif_header *h)
{
    return codec_srgb_header(h->width, h->height, h->transparent >= 0 || !fills_canvas(h) ? 4 : 3, IMAGE_U8);
}

facet_result gif_probe(const unsigned char *bytes, size_t size, const char *name, image *header,
                       facet_error *error)
{
    gif_header h;
    TRY(parse_header(bytes, size, name, UINT32_MAX, &h, error));
    *header = make_header(&h);
    return FACET_OK;
}

/* ---- LZW with codes of growing length, appendix F ---- */

typedef struct lzw {
    cursor blocks;
    uint32_t block_left; /* bytes of the sub-block that is being read */
    uint32_t bits, bit_count;
    uint32_t clear, code_size, code_count; /* codes below code_count are defined */
    uint16_t prefix[MAX_CODES];
    uint16_t length[MAX_CODES];
    unsigned char last[MAX_CODES], first[MAX_CODES];
} lzw;

static void clear_codes(lzw *z)
{
    z->code_count = z->clear + 2;
    z->code_size = 1;
    while (1u << z->code_size < z->code_count)
        z->code_size++;
}

/* The next code; UINT32_MAX: past the end. */
static uint32_t next_code(lzw *z)
{
    while (z->bit_count < z->code_size) {
        while (z->block_left == 0) {
            const unsigned char *length = take(&z->blocks, 1);
            if (!length || *length == 0)
                return UINT32_MAX;
            z->block_left = *length;
        }
        const unsigned char *byte = take(&z->blocks, 1);
        if (!byte)
            return UINT32_MAX;
        z->block_left--;
        z->bits |= (uint32_t)*byte << z->bit_count;
        z->bit_count += 8;
    }
    const uint32_t code = z->bits & ((1u << z->code_size) - 1);
    z->bits >>= z->code_size;
    z->bit_count -= z->code_size;
    return code;
}

static void add_code(lzw *z, uint32_t prefix, unsigned char last)
{
    if (z->code_count == MAX_CODES) /* codes stay at 12 bits until cleared */
        return;
    const uint32_t code = z->code_count++;
    z->prefix[code] = (uint16_t)prefix;
    z->length[code] = (uint16_t)(z->length[prefix] + 1);
    z->first[code] = z->first[prefix];
    z->last[code] = last;
    if (z->code_count == 1u << z->code_size && z->code_size < 12)
        z->code_size++;
}

/* Decodes frame_width x frame_height color indices. Returns NULL or what is wrong. */
static const char *read_indices(const gif_header *h, lzw *z, unsigned char *out)
{
    const size_t count = (size_t)h->frame_width * h->frame_height;
    const uint32_t none = UINT32_MAX;
    uint32_t before = none;
    z->blocks = h->data;
    z->clear = 1u << h->code_bits;
    for (uint32_t i = 0; i < z->clear; i++) {
        z->length[i] = 1;
        z->first[i] = z->last[i] = (unsigned char)i;
    }
    clear_codes(z);
    for (size_t done = 0; done < count;) {
        const uint32_t code = next_code(z);
        if (code == none || code == z->clear + 1)
            return "the texels are cut off";
        if (code == z->clear) {
            clear_codes(z);
            before = none;
            continue;
        }
        /* the code being defined: the previous one plus its first color */
        const bool is_new = code == z->code_count && before != none;
        if (!is_new && code >= z->code_count)
            return "a code is not known";
        if (before != none)
            add_code(z, before, z->first[is_new ? before : code]);
        const size_t length = z->length[code];
        uint32_t part = code;
        for (size_t i = length; i-- > 0; part = z->prefix[part])
            if (done + i < count)
                out[done + i] = z->last[part];
        done += length;
        before = code;
    }
    return NULL;
}

/* ---- texels ---- */

/* Row of the frame for row i of an interlaced file: every eighth from 0, every eighth from 4, every fourth
 * from 2, every second from 1. */
static uint32_t find_row(const gif_header *h, uint32_t i)
{
    static const uint32_t firsts[] = {0, 4, 2, 1}, steps[] = {8, 8, 4, 2};
    for (int pass = 0; h->is_interlaced && pass < 4; pass++) {
        const uint32_t rows =
            h->frame_height > firsts[pass] ? (h->frame_height - firsts[pass] - 1) / steps[pass] + 1 : 0;
        if (i < rows)
            return firsts[pass] + i * steps[pass];
        i -= rows;
    }
    return i;
}

/* Transparent texels keep their color. Returns NULL or what is wrong. */
static const char *put_colors(const gif_header *h, const unsigned char *indices, image *out)
{
    const size_t channels = out->channel_count;
    if (!fills_canvas(h))
        memset(out->pixels, 0, image_row_size(out) * out->height);
    for (uint32_t i = 0; i < h->frame_height; i++) {
        const size_t row = h->top + find_row(h, i);
        unsigned char *to = (unsigned char *)out->pixels + (row * h->width + h->left) * channels;
        for (uint32_t x = 0; x < h->frame_width; x++, to += channels, indices++) {
            if (*indices >= h->color_count)
                return "a texel is no color of the palette";
            memcpy(to, h->colors + 3 * (size_t)*indices, 3);
            if (channels == 4)
                to[3] = *indices == h->transparent ? 0 : 255;
        }
    }
    return NULL;
}

facet_result gif_decode(const unsigned char *bytes, size_t size, const char *name,
                        const image_decode_desc *desc, image *out, facet_error *error)
{
    gif_header h;
    TRY(parse_header(bytes, size, name, desc->max_size, &h, error));
    const image header = make_header(&h);
    lzw *z = mem_zalloc(&desc->allocator, 1, sizeof *z);
    unsigned char *indices = mem_alloc(&desc->allocator, h.frame_width, h.frame_height);
    facet_result result = z && indices
                              ? image_create(&desc->allocator, header.width, header.height,
                                             header.channel_count, IMAGE_U8, out, error)
                              : fail_memory(error, "GIF texels", (size_t)h.frame_width * h.frame_height);
    if (result == FACET_OK) {
        const char *fault = read_indices(&h, z, indices);
        fault = fault ? fault : put_colors(&h, indices, out);
        out->is_srgb = true;
        result = fault ? fail(error, FACET_ERROR_INVALID, "%s: GIF: %s", name, fault)
                       : codec_set_channels(out, desc, error);
    }
    if (result != FACET_OK)
        image_destroy(out);
    mem_free(z);
    mem_free(indices);
    return result;
}
