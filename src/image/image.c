/* image.c - images in memory: creation, conversion, reading as linear floats, RGBM. codec.c reads and writes
 * files. */
#include "image/image.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "image/half.h"
#include "image/srgb.h"

size_t image_type_size(image_type type)
{
    static const unsigned char sizes[] = {1, 2, 2, 4};
    return sizes[type];
}

facet_result image_create(const facet_allocator *allocator, uint32_t width, uint32_t height,
                          uint32_t channel_count, image_type type, image *out, facet_error *error)
{
    *out = (image){0};
    if (width == 0 || height == 0 || channel_count == 0 || channel_count > 4)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "image: %u x %u texels of %u channels: at least 1 x 1 of 1 to 4 channels were expected",
                    width, height, channel_count);
    image i = {.width = width, .height = height, .channel_count = channel_count, .type = type};
    i.pixels = mem_alloc(allocator, height, image_row_size(&i)); /* a row has less than 2^36 bytes */
    if (!i.pixels)
        return fail(error, FACET_ERROR_MEMORY, "out of memory: image of %u x %u texels of %zu bytes", width,
                    height, image_texel_size(&i));
    *out = i;
    return FACET_OK;
}

void image_destroy(image *i)
{
    mem_free(i->pixels);
    *i = (image){0};
}

/* ---- conversion ---- */

enum { BLOCK_TEXELS = 256 }; /* converted at a time, through floats on the stack */

/* Transfer function applied to the color channels between loading and storing. */
typedef enum transfer { TRANSFER_NONE, TRANSFER_DECODE, TRANSFER_ENCODE } transfer;

typedef struct conversion {
    const image *in;
    image *out;
    transfer transfer;
    srgb_tables tables;
} conversion;

static bool is_alpha(uint32_t channel, uint32_t channel_count)
{
    return channel_count % 2 == 0 && channel == channel_count - 1;
}

static float clamp_unit(float x) /* NaN becomes 0 */
{
    return x > 0.0f ? (x < 1.0f ? x : 1.0f) : 0.0f;
}

/* Loads one channel of count texels as floats. light: linear value of each code, required to decode 8 bits,
 * optional for 16 bits. */
static void load_channel(const image *in, const float *light, bool is_decoded, uint32_t channel, size_t first,
                         size_t count, float *to)
{
    const uint32_t stride = in->channel_count;
    const bool decode = is_decoded && !is_alpha(channel, stride);
    const size_t start = first * stride + channel;
    switch (in->type) {
    case IMAGE_U8: {
        const uint8_t *from = (const uint8_t *)in->pixels + start;
        if (decode)
            for (size_t i = 0; i < count; i++)
                to[i] = light[from[i * stride]];
        else
            for (size_t i = 0; i < count; i++)
                to[i] = (float)from[i * stride] / 255.0f;
        return;
    }
    case IMAGE_U16: {
        const uint16_t *from = (const uint16_t *)in->pixels + start;
        if (decode && light) {
            for (size_t i = 0; i < count; i++)
                to[i] = light[from[i * stride]];
            return;
        }
        for (size_t i = 0; i < count; i++)
            to[i] = (float)from[i * stride] / 65535.0f;
        break;
    }
    case IMAGE_F16: {
        const uint16_t *from = (const uint16_t *)in->pixels + start;
        for (size_t i = 0; i < count; i++)
            to[i] = half_to_float(from[i * stride]);
        break;
    }
    case IMAGE_F32: {
        const float *from = (const float *)in->pixels + start;
        for (size_t i = 0; i < count; i++)
            to[i] = from[i * stride];
        break;
    }
    }
    if (decode)
        for (size_t i = 0; i < count; i++)
            to[i] = (float)srgb_decode((double)clamp_unit(to[i]));
}

/* Stores one channel of count texels. */
static void store_channel(const conversion *c, uint32_t channel, size_t first, size_t count, float *from)
{
    const uint32_t stride = c->out->channel_count;
    const bool encode = c->transfer == TRANSFER_ENCODE && !is_alpha(channel, stride);
    const size_t start = first * stride + channel;
    if (encode && c->out->type == IMAGE_U8) {
        uint8_t *to = (uint8_t *)c->out->pixels + start;
        for (size_t i = 0; i < count; i++)
            to[i * stride] = srgb_encode_u8(&c->tables, from[i]);
        return;
    }
    if (encode)
        for (size_t i = 0; i < count; i++)
            from[i] = (float)srgb_encode((double)clamp_unit(from[i]));
    switch (c->out->type) {
    case IMAGE_U8: {
        uint8_t *to = (uint8_t *)c->out->pixels + start;
        for (size_t i = 0; i < count; i++)
            to[i * stride] = (uint8_t)(clamp_unit(from[i]) * 255.0f + 0.5f);
        break;
    }
    case IMAGE_U16: {
        uint16_t *to = (uint16_t *)c->out->pixels + start;
        for (size_t i = 0; i < count; i++)
            to[i * stride] = (uint16_t)(clamp_unit(from[i]) * 65535.0f + 0.5f);
        break;
    }
    case IMAGE_F16: {
        uint16_t *to = (uint16_t *)c->out->pixels + start;
        for (size_t i = 0; i < count; i++)
            to[i * stride] = half_from_float(from[i]);
        break;
    }
    case IMAGE_F32: {
        float *to = (float *)c->out->pixels + start;
        for (size_t i = 0; i < count; i++)
            to[i * stride] = from[i];
        break;
    }
    }
}

/* Input channel for output channel c; -1: none, the value is 1. */
static int source_channel(uint32_t c, uint32_t out_count, uint32_t in_count)
{
    if (is_alpha(c, out_count))
        return in_count % 2 == 0 ? (int)in_count - 1 : -1;
    return in_count < 3 ? 0 : (int)c;
}

static void convert_texels(const conversion *c, size_t first, size_t count)
{
    float values[BLOCK_TEXELS];
    int loaded = -2;
    for (uint32_t channel = 0; channel < c->out->channel_count; channel++) {
        int source = source_channel(channel, c->out->channel_count, c->in->channel_count);
        /* store_channel() may have encoded the values in place */
        if (source != loaded || c->transfer == TRANSFER_ENCODE) {
            if (source >= 0)
                load_channel(c->in, c->in->type == IMAGE_U8 ? c->tables.decoded : NULL,
                             c->transfer == TRANSFER_DECODE, (uint32_t)source, first, count, values);
            else
                for (size_t i = 0; i < count; i++)
                    values[i] = 1.0f;
            loaded = source;
        }
        store_channel(c, channel, first, count, values);
    }
}

/* 8 bits to 8 bits without a transfer function, the common case for textures. */
static void copy_texels_u8(const conversion *c, size_t first, size_t count)
{
    const uint32_t in_count = c->in->channel_count;
    const uint32_t out_count = c->out->channel_count;
    const uint8_t *from = (const uint8_t *)c->in->pixels + first * in_count;
    uint8_t *to = (uint8_t *)c->out->pixels + first * out_count;
    if (in_count == 3 && out_count == 4) {
        for (size_t i = 0; i < count; i++, from += 3, to += 4) {
            to[0] = from[0];
            to[1] = from[1];
            to[2] = from[2];
            to[3] = 255;
        }
        return;
    }
    for (uint32_t channel = 0; channel < out_count; channel++) {
        int source = source_channel(channel, out_count, in_count);
        for (size_t i = 0; i < count; i++)
            to[i * out_count + channel] = source >= 0 ? from[i * in_count + (uint32_t)source] : 255;
    }
}

static void convert_rows(void *context, size_t begin, size_t end)
{
    const conversion *c = context;
    size_t width = c->in->width;
    size_t first = begin * width;
    size_t last = end * width;
    bool is_plain = c->transfer == TRANSFER_NONE && c->in->type == c->out->type;
    if (is_plain && c->in->channel_count == c->out->channel_count) {
        size_t texel = image_texel_size(c->in);
        memcpy((char *)c->out->pixels + first * texel, (const char *)c->in->pixels + first * texel,
               (last - first) * texel);
    } else if (is_plain && c->in->type == IMAGE_U8) {
        copy_texels_u8(c, first, last - first);
    } else {
        for (; first < last; first += BLOCK_TEXELS)
            convert_texels(c, first, last - first < BLOCK_TEXELS ? last - first : BLOCK_TEXELS);
    }
}

facet_result image_convert(const image *in, const facet_allocator *allocator, uint32_t thread_count,
                           uint32_t channel_count, image_type type, bool to_srgb, image *out,
                           facet_error *error)
{
    *out = (image){0};
    if (in->channel_count > 2 && channel_count < 3)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "image: %u channels cannot become %u: colors are not mixed to grey", in->channel_count,
                    channel_count);
    image made;
    TRY(image_create(allocator, in->width, in->height, channel_count, type, &made, error));
    made.is_srgb = to_srgb;
    conversion c = {.in = in, .out = &made};
    if (in->is_srgb != to_srgb) {
        c.transfer = to_srgb ? TRANSFER_ENCODE : TRANSFER_DECODE;
        srgb_tables_prepare(&c.tables);
    }
    size_t rows = 32768 / in->width + 1; /* enough to amortise the start of a thread */
    parallel_for(thread_count, in->height, rows, convert_rows, &c);
    *out = made;
    return FACET_OK;
}

/* ---- reading ---- */

facet_result image_reader_create(const image *source, const facet_allocator *allocator, image_reader *out,
                                 facet_error *error)
{
    *out = (image_reader){.source = source};
    if (!source->is_srgb || source->type == IMAGE_F16 || source->type == IMAGE_F32)
        return FACET_OK;
    const size_t count = source->type == IMAGE_U8 ? 256 : 65536;
    out->light = mem_alloc(allocator, count, sizeof *out->light);
    if (!out->light)
        return fail_memory(error, "light of sRGB codes", count * sizeof *out->light);
    for (size_t code = 0; code < count; code++) /* as load_channel() and srgb_tables_prepare() decode them */
        out->light[code] = source->type == IMAGE_U8 ? (float)srgb_decode((double)code / 255.0)
                                                    : (float)srgb_decode((double)((float)code / 65535.0f));
    return FACET_OK;
}

void image_reader_destroy(image_reader *r)
{
    mem_free(r->light);
    *r = (image_reader){0};
}

void image_reader_load(const image_reader *r, size_t first, size_t count, float *rgba)
{
    float values[BLOCK_TEXELS];
    for (size_t done = 0; done < count; done += BLOCK_TEXELS) {
        const size_t n = count - done < BLOCK_TEXELS ? count - done : BLOCK_TEXELS;
        int loaded = -1;
        for (uint32_t channel = 0; channel < 4; channel++) {
            const int source = source_channel(channel, 4, r->source->channel_count);
            if (source >= 0 && source != loaded)
                load_channel(r->source, r->light, r->source->is_srgb, (uint32_t)source, first + done, n,
                             values);
            loaded = source;
            for (size_t i = 0; i < n; i++)
                rgba[4 * (done + i) + channel] = source >= 0 ? values[i] : 1.0f;
        }
    }
}

/* ---- RGBM ---- */

typedef struct packing {
    const image *in;
    image *out;
    float range;
} packing;

static void pack_texel(const float *rgb, float range, uint8_t *out)
{
    float x[3];
    float largest = 0.0f;
    for (int i = 0; i < 3; i++) {
        x[i] = rgb[i] > 0.0f ? rgb[i] / range : 0.0f;
        x[i] = x[i] < 1.0f ? x[i] : 1.0f;
        largest = x[i] > largest ? x[i] : largest;
    }
    float m = ceilf(largest * 255.0f);
    m = m < 1.0f ? 1.0f : m;
    for (int i = 0; i < 3; i++) {
        float code = x[i] * 65025.0f / m + 0.5f; /* 255^2 */
        out[i] = (uint8_t)(code < 255.0f ? code : 255.0f);
    }
    out[3] = (uint8_t)m;
}

static void pack_rows(void *context, size_t begin, size_t end)
{
    const packing *p = context;
    const uint32_t channels = p->in->channel_count;
    const size_t width = p->in->width;
    const float *from = (const float *)p->in->pixels + begin * width * channels;
    uint8_t *to = (uint8_t *)p->out->pixels + begin * width * 4;
    for (size_t i = begin * width; i < end * width; i++, from += channels, to += 4)
        pack_texel(from, p->range, to);
}

facet_result rgbm_encode(const image *in, float range, const facet_allocator *allocator,
                         uint32_t thread_count, image *out, facet_error *error)
{
    TRY(image_create(allocator, in->width, in->height, 4, IMAGE_U8, out, error));
    packing p = {in, out, range};
    parallel_for(thread_count, in->height, 16, pack_rows, &p);
    return FACET_OK;
}
