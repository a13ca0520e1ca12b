/* codec_dds.c - DirectDraw surfaces: BC1 to BC5 and BC7 by the decoders of block.h, and texels of 8 to 32
 * bits by bit masks. Reads the largest level of the first texture (of a cube: of its face +X). Microsoft,
 * "Programming Guide for DDS" (DDS_HEADER, DDS_PIXELFORMAT, DDS_HEADER_DXT10). */
#include "image/codec.h"

#include <math.h>
#include <string.h>

#include "base/parallel.h"
#include "base/result.h"
#include "image/block.h"
#include "image/texel_masks.h"

enum { HEADER_SIZE = 128, DX10_SIZE = 148 };
enum {
    HAS_ALPHA = 1,
    IS_ALPHA = 2,
    HAS_FOURCC = 4,
    IS_RGB = 0x40,
    IS_LUMINANCE = 0x20000,
    IS_VOLUME = 0x200000
};

typedef struct dds_format {
    uint32_t channel_count;
    uint32_t block_size;  /* bytes of 4 x 4 texels; 0: texels by masks */
    block_decode *decode; /* U8 */
    texel_masks masks;
    bool is_normal; /* two channels: x and y of a normal */
} dds_format;

typedef struct dds_header {
    uint32_t width, height;
    dds_format format;
    const unsigned char *data;
    size_t data_size;
} dds_header;

bool dds_detect(const unsigned char *bytes, size_t size)
{
    return size >= 8 && memcmp(bytes, "DDS ", 4) == 0 && load_u32_le(bytes + 4) == 124;
}

static const dds_format bc1 = {4, 8, bc1_rgba_decode, {0}, false};
static const dds_format bc2 = {4, 16, bc2_decode, {0}, false};
static const dds_format bc3 = {4, 16, bc3_decode, {0}, false};
static const dds_format bc4 = {1, 8, bc4_decode, {0}, false};
static const dds_format bc5 = {3, 16, bc5_decode, {0}, true};
static const dds_format bc7 = {4, 16, bc7_decode, {0}, false};

/* Format of a FourCC; NULL: unknown. DXT2 and DXT4 are premultiplied, which is left as it is. */
static const dds_format *find_letters(const unsigned char *letters)
{
    static const struct {
        const char *letters;
        const dds_format *format;
    } known[] = {{"DXT1", &bc1}, {"DXT2", &bc2}, {"DXT3", &bc2}, {"DXT4", &bc3}, {"DXT5", &bc3},
                 {"ATI1", &bc4}, {"BC4U", &bc4}, {"ATI2", &bc5}, {"BC5U", &bc5}};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (memcmp(letters, known[i].letters, 4) == 0)
            return known[i].format;
    return NULL;
}

/* Format of a DXGI_FORMAT; typeless, linear and sRGB variants have the same codes. */
static const dds_format *find_dxgi(uint32_t number)
{
    static const dds_format rgba8 = {4, 0, NULL, {4, {0xff, 0xff00, 0xff0000, 0xff000000}}, false};
    static const dds_format bgra8 = {4, 0, NULL, {4, {0xff0000, 0xff00, 0xff, 0xff000000}}, false};
    static const dds_format bgrx8 = {3, 0, NULL, {4, {0xff0000, 0xff00, 0xff, 0}}, false};
    static const dds_format r8 = {1, 0, NULL, {1, {0xff, 0, 0, 0}}, false};
    static const dds_format rg8 = {3, 0, NULL, {2, {0xff, 0xff00, 0, 0}}, true};
    static const dds_format bgr565 = {3, 0, NULL, {2, {0xf800, 0x7e0, 0x1f, 0}}, false};
    static const dds_format bgra5551 = {4, 0, NULL, {2, {0x7c00, 0x3e0, 0x1f, 0x8000}}, false};
    static const dds_format bgra4444 = {4, 0, NULL, {2, {0xf00, 0xf0, 0xf, 0xf000}}, false};
    static const struct {
        uint32_t first, last;
        const dds_format *format;
    } known[] = {{27, 29, &rgba8},  {48, 49, &rg8},      {60, 61, &r8},    {70, 72, &bc1},
                 {73, 75, &bc2},    {76, 78, &bc3},      {79, 80, &bc4},   {82, 83, &bc5},
                 {85, 85, &bgr565}, {86, 86, &bgra5551}, {87, 87, &bgra8}, {88, 88, &bgrx8},
                 {90, 91, &bgra8},  {92, 93, &bgrx8},    {97, 99, &bc7},   {115, 115, &bgra4444}};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (number >= known[i].first && number <= known[i].last)
            return known[i].format;
    return NULL;
}

/* Reads texels by the masks of the header. False: there are no masks. */
static bool read_masks(const unsigned char *pixel_format, uint32_t flags, dds_format *out)
{
    const uint32_t bits = load_u32_le(pixel_format + 12);
    const uint32_t color_count = flags & IS_RGB ? 3 : 1;
    if (bits < 8 || bits > 32 || bits % 8 || !(flags & (IS_RGB | IS_LUMINANCE | IS_ALPHA)))
        return false;
    *out = (dds_format){.masks.byte_count = bits / 8};
    for (uint32_t c = 0; c < color_count && (flags & (IS_RGB | IS_LUMINANCE)); c++)
        out->masks.channels[c] = load_u32_le(pixel_format + 16 + 4 * c);
    if (flags & (HAS_ALPHA | IS_ALPHA))
        out->masks.channels[3] = load_u32_le(pixel_format + 28);
    out->channel_count = color_count + (out->masks.channels[3] != 0);
    const uint32_t all = bits == 32 ? UINT32_MAX : (1u << bits) - 1;
    uint32_t used = 0;
    for (int c = 0; c < 4; c++)
        used |= out->masks.channels[c] &= all;
    return used != 0;
}

static facet_result parse_format(const unsigned char *bytes, size_t size, const char *name, dds_header *h,
                                 facet_error *error)
{
    const unsigned char *pixel_format = bytes + 76;
    const uint32_t flags = load_u32_le(pixel_format + 4);
    size_t before = HEADER_SIZE;
    if (flags & HAS_FOURCC) {
        const bool has_dx10 = memcmp(pixel_format + 8, "DX10", 4) == 0;
        if (has_dx10 && size < DX10_SIZE)
            return fail(error, FACET_ERROR_INVALID, "%s: DDS: the header is cut off", name);
        const dds_format *f =
            has_dx10 ? find_dxgi(load_u32_le(bytes + HEADER_SIZE)) : find_letters(pixel_format + 8);
        if (!f && has_dx10)
            return fail(error, FACET_ERROR_UNSUPPORTED, "%s: DDS: texels of DXGI format %u are not read",
                        name, load_u32_le(bytes + HEADER_SIZE));
        if (!f)
            return fail(error, FACET_ERROR_UNSUPPORTED,
                        "%s: DDS: texels of the kind \"%.4s\" (%#x) are not read", name,
                        (const char *)pixel_format + 8, load_u32_le(pixel_format + 8));
        h->format = *f;
        before = has_dx10 ? DX10_SIZE : HEADER_SIZE;
    } else if (!read_masks(pixel_format, flags, &h->format)) {
        return fail(error, FACET_ERROR_UNSUPPORTED, "%s: DDS: texels of %u bits with flags %#x are not read",
                    name, load_u32_le(pixel_format + 12), flags);
    }
    h->data = bytes + before;
    h->data_size = size - before;
    return FACET_OK;
}

static facet_result parse_header(const unsigned char *bytes, size_t size, const char *name, uint32_t max_size,
                                 dds_header *h, facet_error *error)
{
    *h = (dds_header){0};
    if (size < HEADER_SIZE)
        return fail(error, FACET_ERROR_INVALID, "%s: DDS: the header is cut off", name);
    if (load_u32_le(bytes + 112) & IS_VOLUME)
        return fail(error, FACET_ERROR_UNSUPPORTED, "%s: DDS: volumes are not read", name);
    TRY(parse_format(bytes, size, name, h, error));
    h->height = load_u32_le(bytes + 12);
    h->width = load_u32_le(bytes + 16);
    TRY(codec_check_size(name, h->width, h->height, max_size, error));
    const uint64_t columns = ((uint64_t)h->width + 3) / 4, rows = ((uint64_t)h->height + 3) / 4;
    const bool is_blocks = h->format.block_size != 0;
    const uint64_t row_size =
        is_blocks ? columns * h->format.block_size : (uint64_t)h->width * h->format.masks.byte_count;
    if (h->data_size / row_size < (is_blocks ? rows : h->height))
        return fail(error, FACET_ERROR_INVALID,
                    "%s: DDS: %u x %u texels need more than the %zu bytes of the file", name, h->width,
                    h->height, h->data_size);
    return FACET_OK;
}

facet_result dds_probe(const unsigned char *bytes, size_t size, const char *name, image *header,
                       facet_error *error)
{
    dds_header h;
    TRY(parse_header(bytes, size, name, UINT32_MAX, &h, error));
    *header = codec_srgb_header(h.width, h.height, h.format.channel_count, IMAGE_U8);
    return FACET_OK;
}

/* ---- texels ---- */

/* Third component of a unit vector from codes in [-1, 1]: textures of two channels are almost always normal
 * maps, and shaders reconstruct them this way. */
static void complete_normals(unsigned char *texels, size_t count)
{
    for (size_t i = 0; i < count; i++, texels += 3) {
        const float x = (float)texels[0] / 127.5f - 1.0f, y = (float)texels[1] / 127.5f - 1.0f;
        const float square = 1.0f - x * x - y * y;
        texels[2] = (unsigned char)(127.5f * (1.0f + (square > 0.0f ? sqrtf(square) : 0.0f)) + 0.5f);
    }
}

typedef struct dds_reading {
    const dds_header *header;
    const image *image;
} dds_reading;

static void decode_block_row(const dds_reading *r, uint32_t row)
{
    const dds_format *f = &r->header->format;
    const uint32_t width = r->image->width, channels = r->image->channel_count;
    const uint32_t columns = (width + 3) / 4, y = 4 * row;
    const uint32_t rows = r->image->height - y < TILE_EDGE ? r->image->height - y : TILE_EDGE;
    const unsigned char *block = r->header->data + (size_t)row * columns * f->block_size;
    for (uint32_t column = 0; column < columns; column++, block += f->block_size) {
        unsigned char tile[TILE_TEXELS * TILE_CHANNELS];
        const uint32_t x = 4 * column, count = width - x < TILE_EDGE ? width - x : TILE_EDGE;
        f->decode(block, tile);
        for (uint32_t i = 0; i < rows; i++) {
            unsigned char *to = (unsigned char *)r->image->pixels + ((size_t)(y + i) * width + x) * channels;
            for (uint32_t k = 0; k < count; k++)
                memcpy(to + k * channels, tile + 4 * (TILE_EDGE * i + k), channels);
        }
    }
}

/* Rows of blocks, or of four texels. */
static void read_rows(void *context, size_t begin, size_t end)
{
    const dds_reading *r = context;
    const dds_format *f = &r->header->format;
    const size_t width = r->image->width, row_size = image_row_size(r->image);
    for (size_t row = begin; row < end; row++) {
        const size_t y = 4 * row, rows = r->image->height - y < 4 ? r->image->height - y : 4;
        unsigned char *texels = (unsigned char *)r->image->pixels + y * row_size;
        if (f->block_size)
            decode_block_row(r, (uint32_t)row);
        else
            texel_masks_unpack(&f->masks, r->header->data + y * width * f->masks.byte_count, width * rows,
                               f->channel_count, texels);
        if (f->is_normal)
            complete_normals(texels, width * rows);
    }
}

facet_result dds_decode(const unsigned char *bytes, size_t size, const char *name,
                        const image_decode_desc *desc, image *out, facet_error *error)
{
    dds_header h;
    TRY(parse_header(bytes, size, name, desc->max_size, &h, error));
    TRY(image_create(&desc->allocator, h.width, h.height, h.format.channel_count, IMAGE_U8, out, error));
    out->is_srgb = true;
    dds_reading r = {&h, out};
    parallel_for(desc->thread_count, ((size_t)h.height + 3) / 4, 1 + 4096 / h.width, read_rows, &r);
    return codec_set_channels(out, desc, error);
}
