/* codec_tga.c - Truevision TGA: color-mapped, true-color and grey images, raw or run-length coded, in any
 * order of rows and columns. The format has no magic number, so the whole header is checked. Truevision TGA
 * File Format Specification, version 2.0, 1991. */
#include "image/codec.h"

#include <string.h>

#include "base/result.h"
#include "image/texel_masks.h"

enum { HEADER_SIZE = 18, TYPE_MAPPED = 1, TYPE_COLOR = 2, TYPE_GREY = 3, TYPE_RUNS = 8 };

typedef struct tga_header {
    uint32_t width, height, channel_count;
    uint32_t word_size; /* bytes of a texel in the file */
    bool has_runs, is_top_down, is_right_to_left;
    texel_masks masks;        /* bits of a texel or of a palette entry */
    const unsigned char *map; /* NULL: texels are colors */
    uint32_t map_first, map_count;
    const unsigned char *data;
    size_t data_size;
} tga_header;

static uint32_t load_u16(const unsigned char *p)
{
    return p[0] | (uint32_t)p[1] << 8;
}

/* False: not a valid depth. */
static bool choose_masks(uint32_t bits, uint32_t alpha_bits, tga_header *h)
{
    const texel_masks *m = bits == 15                      ? &texel_masks_555
                           : bits == 16 && alpha_bits == 0 ? &texel_masks_555
                           : bits == 16                    ? &texel_masks_1555
                           : bits == 24                    ? &texel_masks_bgr
                           : bits == 32                    ? &texel_masks_bgra
                                                           : NULL;
    if (!m)
        return false;
    h->masks = *m;
    h->channel_count = m->channels[3] ? 4 : 3;
    return true;
}

/* False: not a TGA header. All fields are checked, since there is no magic number. */
static bool parse_header(const unsigned char *bytes, size_t size, tga_header *h)
{
    *h = (tga_header){0};
    if (size < HEADER_SIZE)
        return false;
    const uint32_t type = bytes[2] & ~(uint32_t)TYPE_RUNS, bits = bytes[16], descriptor = bytes[17];
    const uint32_t alpha_bits = descriptor & 15, map_bits = bytes[7];
    const bool has_map = bytes[1] == 1;
    size_t map_size = 0;
    if (bytes[1] > 1 || type < TYPE_MAPPED || type > TYPE_GREY || (bytes[2] & ~(uint32_t)(TYPE_RUNS | 3)) ||
        descriptor >> 6 || alpha_bits > 8)
        return false;
    if (has_map) {
        h->map_first = load_u16(bytes + 3);
        h->map_count = load_u16(bytes + 5);
        map_size = (size_t)h->map_count * ((map_bits + 7) / 8);
        if ((map_bits != 15 && map_bits != 16 && map_bits != 24 && map_bits != 32) || h->map_count == 0)
            return false;
    } else if (load_u16(bytes + 3) || load_u16(bytes + 5)) {
        return false;
    }
    *h = (tga_header){.width = load_u16(bytes + 12),
                      .height = load_u16(bytes + 14),
                      .word_size = (bits + 7) / 8,
                      .has_runs = bytes[2] & TYPE_RUNS,
                      .is_top_down = descriptor & 32,
                      .is_right_to_left = descriptor & 16,
                      .map_first = h->map_first,
                      .map_count = h->map_count};
    const size_t before = HEADER_SIZE + (size_t)bytes[0];
    if (h->width == 0 || h->height == 0 || before + map_size > size)
        return false;
    h->data = bytes + before + map_size;
    h->data_size = size - before - map_size;
    if (type == TYPE_MAPPED) {
        h->map = bytes + before;
        return has_map && (bits == 8 || bits == 16) && choose_masks(map_bits, alpha_bits, h);
    }
    if (type == TYPE_COLOR)
        return choose_masks(bits, alpha_bits, h);
    h->masks = bits == 8 ? texel_masks_grey : texel_masks_grey_alpha;
    h->channel_count = bits == 8 ? 1 : 2;
    return bits == 8 || bits == 16;
}

bool tga_detect(const unsigned char *bytes, size_t size)
{
    tga_header h;
    return parse_header(bytes, size, &h);
}

/* Checks whether the bytes can hold the texels; FACET_ERROR_LIMIT if an edge is too long. */
static facet_result check(const tga_header *h, const char *name, uint32_t max_size, facet_error *error)
{
    const uint64_t texels = (uint64_t)h->width * h->height;
    const uint64_t least = h->has_runs ? (texels + 127) / 128 * (1 + h->word_size) : texels * h->word_size;
    return codec_check_texels(name, "TGA", h->width, h->height, max_size, least, h->data_size, error);
}

facet_result tga_probe(const unsigned char *bytes, size_t size, const char *name, image *header,
                       facet_error *error)
{
    tga_header h;
    if (!parse_header(bytes, size, &h))
        return fail(error, FACET_ERROR_INVALID, "%s: TGA: the header is damaged", name);
    TRY(check(&h, name, UINT32_MAX, error));
    *header = codec_srgb_header(h.width, h.height, h.channel_count, IMAGE_U8);
    return FACET_OK;
}

/* Converts count words to texels. False: an index is outside of the color map. */
static bool unpack(const tga_header *h, const unsigned char *words, size_t count, unsigned char *texels)
{
    if (!h->map) {
        texel_masks_unpack(&h->masks, words, count, h->channel_count, texels);
        return true;
    }
    for (size_t i = 0; i < count; i++, texels += h->channel_count) {
        const uint32_t index = (h->word_size == 1 ? words[i] : load_u16(words + 2 * i)) - h->map_first;
        if (index >= h->map_count) /* wraps around below the first */
            return false;
        texel_masks_unpack(&h->masks, h->map + (size_t)index * h->masks.byte_count, 1, h->channel_count,
                           texels);
    }
    return true;
}

/* Reads all texels in the order of the file. Returns NULL or what is wrong. */
static const char *read_texels(const tga_header *h, image *out)
{
    static const char no_color[] = "a texel is no color of the palette", cut_off[] = "the texels are cut off";
    const size_t count = (size_t)h->width * h->height;
    unsigned char *texels = out->pixels;
    const unsigned char *p = h->data, *end = h->data + h->data_size;
    if (!h->has_runs)
        return unpack(h, p, count, texels) ? NULL : no_color;
    for (size_t done = 0; done < count;) {
        if (p == end)
            return cut_off;
        const uint32_t code = *p++;
        size_t length = (code & 127) + 1;
        const size_t words = code & 128 ? 1 : length;
        if ((size_t)(end - p) / h->word_size < words)
            return cut_off;
        length = length < count - done ? length : count - done; /* some writers run past the end */
        unsigned char *to = texels + done * h->channel_count;
        if (!unpack(h, p, code & 128 ? 1 : length, to))
            return no_color;
        for (size_t i = 1; i < length && code & 128; i++)
            memcpy(to + i * h->channel_count, to, h->channel_count);
        p += words * h->word_size;
        done += length;
    }
    return NULL;
}

facet_result tga_decode(const unsigned char *bytes, size_t size, const char *name,
                        const image_decode_desc *desc, image *out, facet_error *error)
{
    tga_header h;
    if (!parse_header(bytes, size, &h))
        return fail(error, FACET_ERROR_INVALID, "%s: TGA: the header is damaged", name);
    TRY(check(&h, name, desc->max_size, error));
    TRY(image_create(&desc->allocator, h.width, h.height, h.channel_count, IMAGE_U8, out, error));
    out->is_srgb = true;
    const char *fault = read_texels(&h, out);
    if (fault) {
        image_destroy(out);
        return fail(error, FACET_ERROR_INVALID, "%s: TGA: %s", name, fault);
    }
    codec_flip(out, h.is_right_to_left, !h.is_top_down);
    texel_masks_fill_unused_alpha(out);
    return codec_set_channels(out, desc, error);
}
