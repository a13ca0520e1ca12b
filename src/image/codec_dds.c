/* codec_dds.c - DirectDraw surfaces: BC1 to BC7 by the decoders of block.h, texels of 8 to 32 bits by bit masks, and
 * floats. Reads the largest level of the first texture (of a cube: of its face +X). Microsoft,
 * "Programming Guide for DDS" (DDS_HEADER, DDS_PIXELFORMAT, DDS_HEADER_DXT10). */
#include "image/codec.h"

#include <math.h>
#include <string.h>

#include "base/parallel.h"
#include "base/result.h"
#include "image/block.h"
#include "image/half.h"
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
    block_decode *decode; /* of `type`, or F32 where is_signed */
    texel_masks masks;
    bool is_normal;       /* two channels: x and y of a normal */
    bool is_signed;       /* blocks of F32 in [-1, 1], which become U8 */
    image_type type;      /* IMAGE_U8 is 0 */
    uint32_t float_count; /* of a texel; 0: it has none */
    uint32_t float_size;  /* 2 or 4 bytes */
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

static const dds_format bc1 = {4, 8, .decode = bc1_rgba_decode};
static const dds_format bc2 = {4, 16, .decode = bc2_decode};
static const dds_format bc3 = {4, 16, .decode = bc3_decode};
static const dds_format bc4 = {1, 8, .decode = bc4_decode};
static const dds_format bc5 = {3, 16, .decode = bc5_decode, .is_normal = true};
static const dds_format bc5_signed = {3, 16, .decode = bc5_signed_decode, .is_normal = true,
                                      .is_signed = true};
static const dds_format bc6 = {3, 16, .decode = bc6h_decode, .type = IMAGE_F16};
static const dds_format bc6_signed = {3, 16, .decode = bc6h_signed_decode, .type = IMAGE_F16};
static const dds_format rgba16f = {4, .type = IMAGE_F32, .float_count = 4, .float_size = 2};
static const dds_format rgba32f = {4, .type = IMAGE_F32, .float_count = 4, .float_size = 4};
static const dds_format rgb32f = {3, .type = IMAGE_F32, .float_count = 3, .float_size = 4};
static const dds_format bc7 = {4, 16, .decode = bc7_decode};

/* Format of a FourCC; NULL: unknown. DXT2 and DXT4 are premultiplied, which is left as it is. */
static const dds_format *find_letters(const unsigned char *letters)
{
    static const struct {
        const char *letters;
        const dds_format *format;
    } known[] = {
        {"DXT1", &bc1},       {"DXT2", &bc2},        {"DXT3", &bc2},        {"DXT4", &bc3},
        {"DXT5", &bc3},       {"ATI1", &bc4},        {"BC4U", &bc4},        {"ATI2", &bc5},
        {"BC5U", &bc5},       {"BC5S", &bc5_signed}, {"q\0\0\0", &rgba16f}, /* D3DFMT_A16B16G16R16F, 113 */
        {"t\0\0\0", &rgba32f} /* D3DFMT_A32B32G32R32F, 116 */};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (memcmp(letters, known[i].letters, 4) == 0)
            return known[i].format;
    return NULL;
}

/* Format of a DXGI_FORMAT; typeless, linear and sRGB variants have the same codes. */
static const dds_format *find_dxgi(uint32_t number)
{
    static const dds_format rgba8 = {4, .masks = {4, {0xff, 0xff00, 0xff0000, 0xff000000}}};
    static const dds_format bgra8 = {4, .masks = {4, {0xff0000, 0xff00, 0xff, 0xff000000}}};
    static const dds_format bgrx8 = {3, .masks = {4, {0xff0000, 0xff00, 0xff, 0}}};
    static const dds_format r8 = {1, .masks = {1, {0xff, 0, 0, 0}}};
    static const dds_format rg8 = {3, .masks = {2, {0xff, 0xff00, 0, 0}}, .is_normal = true};
    static const dds_format bgr565 = {3, .masks = {2, {0xf800, 0x7e0, 0x1f, 0}}};
    static const dds_format bgra5551 = {4, .masks = {2, {0x7c00, 0x3e0, 0x1f, 0x8000}}};
    static const dds_format bgra4444 = {4, .masks = {2, {0xf00, 0xf0, 0xf, 0xf000}}};
    static const struct {
        uint32_t first, last;
        const dds_format *format;
    } known[] = {{2, 2, &rgba32f}, {6, 6, &rgb32f},       {10, 10, &rgba16f}, {84, 84, &bc5_signed},
                 {94, 95, &bc6},   {96, 96, &bc6_signed}, {27, 29, &rgba8},   {48, 49, &rg8},
                 {60, 61, &r8},    {70, 72, &bc1},        {73, 75, &bc2},     {76, 78, &bc3},
                 {79, 80, &bc4},   {82, 83, &bc5},        {85, 85, &bgr565},  {86, 86, &bgra5551},
                 {87, 87, &bgra8}, {88, 88, &bgrx8},      {90, 91, &bgra8},   {92, 93, &bgrx8},
                 {97, 99, &bc7},   {115, 115, &bgra4444}};
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
    const uint64_t texel_size = h->format.float_count ? (uint64_t)h->format.float_count * h->format.float_size
                                                      : h->format.masks.byte_count;
    const uint64_t row_size = is_blocks ? columns * h->format.block_size : h->width * texel_size;
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
    *header = codec_srgb_header(h.width, h.height, h.format.channel_count, h.format.type);
    header->is_srgb = h.format.type == IMAGE_U8;
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
    bool keeps_nonfinite;
} dds_reading;

/* Codes in [-1, 1] as those of normal maps, [0, 255]. */
static void decode_signed(block_decode *decode, const unsigned char *block, unsigned char *tile)
{
    float values[TILE_TEXELS * TILE_CHANNELS];
    decode(block, values);
    for (int i = 0; i < TILE_TEXELS * TILE_CHANNELS; i++)
        tile[i] = clamp_u8((int)(127.5f * (1.0f + values[i]) + 0.5f));
}

/* Floats of the file, little-endian. */
static void read_floats(const dds_format *f, const unsigned char *in, size_t count, bool keeps_nonfinite,
                        float *out)
{
    for (size_t i = 0; i < count; i++, in += f->float_size) {
        out[i] = f->float_size == 2 ? half_to_float((uint16_t)(in[0] | in[1] << 8))
                                    : float_from_bits(load_u32_le(in));
        out[i] = keeps_nonfinite ? out[i] : codec_finite(out[i]);
    }
}

static void decode_block_row(const dds_reading *r, uint32_t row)
{
    const dds_format *f = &r->header->format;
    const uint32_t width = r->image->width, channels = r->image->channel_count;
    const size_t size = image_type_size(f->type);
    const uint32_t columns = (width + 3) / 4, y = 4 * row;
    const uint32_t rows = r->image->height - y < TILE_EDGE ? r->image->height - y : TILE_EDGE;
    const unsigned char *block = r->header->data + (size_t)row * columns * f->block_size;
    for (uint32_t column = 0; column < columns; column++, block += f->block_size) {
        unsigned char tile[TILE_TEXELS * TILE_CHANNELS * sizeof(uint16_t)]; /* U8 or F16 */
        const uint32_t x = 4 * column, count = width - x < TILE_EDGE ? width - x : TILE_EDGE;
        if (f->is_signed)
            decode_signed(f->decode, block, tile);
        else
            f->decode(block, tile);
        for (uint32_t i = 0; i < rows; i++) {
            unsigned char *to =
                (unsigned char *)r->image->pixels + ((size_t)(y + i) * width + x) * channels * size;
            for (uint32_t k = 0; k < count; k++)
                memcpy(to + k * channels * size, tile + 4 * size * (TILE_EDGE * i + k), channels * size);
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
        else if (f->float_count)
            read_floats(f, r->header->data + y * width * f->float_count * f->float_size,
                        width * rows * f->float_count, r->keeps_nonfinite, (float *)(void *)texels);
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
    TRY(image_create(&desc->allocator, h.width, h.height, h.format.channel_count, h.format.type, out, error));
    out->is_srgb = h.format.type == IMAGE_U8;
    dds_reading r = {&h, out, desc->keeps_nonfinite};
    parallel_for(desc->thread_count, ((size_t)h.height + 3) / 4, 1 + 4096 / h.width, read_rows, &r);
    return codec_set_channels(out, desc, error);
}
