/* exr_write.c - writing OpenEXR: scanlines in chunks of 16, ZIP, half or float, channels of several layers.
 * Layout: "OpenEXR File Layout" of the OpenEXR documentation. Chunks are made in parallel and put together in
 * order. */
#include "image/codec.h"

#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "base/text.h"
#include "image/deflate.h"
#include "image/half.h"

enum { CHUNK_ROWS = 16, MAX_NAME = 255, MAX_SHORT_NAME = 31 };
enum { PIXEL_HALF = 1, PIXEL_FLOAT = 2, COMPRESSION_ZIP = 3 };
enum { VERSION = 2, FLAG_LONG_NAMES = 0x400 };

typedef struct channel {
    const char *name;
    const image_layer *layer;
    uint32_t index; /* in the layer's texels */
} channel;

/* What follows the two numbers before each chunk. */
typedef struct chunk {
    unsigned char *data;
    size_t size;
} chunk;

typedef struct writing {
    uint32_t width, height;
    channel *channels; /* in the order of their names, as the file has them */
    uint32_t channel_count;
    bool as_half;
    uint32_t level;
    const facet_allocator *allocator;
    chunk *chunks;
    _Atomic bool has_no_memory;
} writing;

/* ---- header ---- */

static void add_u32(text *t, uint32_t x)
{
    unsigned char bytes[4];
    store_u32_le(bytes, x);
    text_add_bytes(t, bytes, 4);
}

/* Strings of the format carry their closing 0. */
static void add_string(text *t, const char *string)
{
    text_add_bytes(t, string, strlen(string) + 1);
}

static void add_attribute(text *t, const char *name, const char *type, uint32_t size)
{
    add_string(t, name);
    add_string(t, type);
    add_u32(t, size);
}

static void add_window(text *t, const char *name, const writing *w)
{
    add_attribute(t, name, "box2i", 16);
    add_u32(t, 0);
    add_u32(t, 0);
    add_u32(t, w->width - 1);
    add_u32(t, w->height - 1);
}

static void add_header(text *t, const writing *w)
{
    uint32_t channels_size = 1;
    uint32_t flags = 0;
    for (uint32_t c = 0; c < w->channel_count; c++) {
        uint32_t length = (uint32_t)strlen(w->channels[c].name);
        channels_size += length + 1 + 16;
        if (length > MAX_SHORT_NAME)
            flags = FLAG_LONG_NAMES;
    }
    text_add_bytes(t, "\x76\x2f\x31\x01", 4);
    add_u32(t, VERSION | flags);
    add_attribute(t, "channels", "chlist", channels_size);
    for (uint32_t c = 0; c < w->channel_count; c++) {
        add_string(t, w->channels[c].name);
        add_u32(t, w->as_half ? PIXEL_HALF : PIXEL_FLOAT);
        add_u32(t, 0); /* not perceptually linear; reserved */
        add_u32(t, 1); /* a sample in every column .. */
        add_u32(t, 1); /* .. and row */
    }
    add_string(t, "");
    add_attribute(t, "compression", "compression", 1);
    text_add_bytes(t, &(unsigned char){COMPRESSION_ZIP}, 1);
    add_window(t, "dataWindow", w);
    add_window(t, "displayWindow", w);
    add_attribute(t, "lineOrder", "lineOrder", 1);
    text_add_bytes(t, &(unsigned char){0}, 1); /* from the top */
    add_attribute(t, "pixelAspectRatio", "float", 4);
    add_u32(t, float_bits(1.0f));
    add_attribute(t, "screenWindowCenter", "v2f", 8);
    add_u32(t, float_bits(0.0f));
    add_u32(t, float_bits(0.0f));
    add_attribute(t, "screenWindowWidth", "float", 4);
    add_u32(t, float_bits(1.0f));
    add_string(t, ""); /* the end */
}

/* ---- chunks ---- */

static size_t sample_size(const writing *w)
{
    return w->as_half ? 2 : 4;
}

/* Rows [y, y_end) as the format has them: row by row, in it channel by channel. */
static void gather_samples(const writing *w, uint32_t y, uint32_t y_end, unsigned char *out)
{
    for (; y < y_end; y++)
        for (uint32_t c = 0; c < w->channel_count; c++) {
            const channel *from = &w->channels[c];
            const uint32_t stride = from->layer->channel_count;
            const float *texel =
                (const float *)((const char *)from->layer->pixels + y * from->layer->row_stride_bytes) +
                from->index;
            for (uint32_t x = 0; x < w->width; x++, texel += stride, out += sample_size(w)) {
                if (w->as_half) {
                    uint16_t half = half_from_float(*texel);
                    out[0] = (unsigned char)half;
                    out[1] = (unsigned char)(half >> 8);
                } else {
                    store_u32_le(out, float_bits(*texel));
                }
            }
        }
}

/* What ZIP does before deflate: even bytes, then odd ones, then differences from byte to byte, plus 128. */
static void predict(const unsigned char *in, size_t size, unsigned char *out)
{
    unsigned char *even = out;
    unsigned char *odd = out + (size + 1) / 2;
    for (size_t k = 0; k + 1 < size; k += 2) {
        *even++ = in[k];
        *odd++ = in[k + 1];
    }
    if (size % 2)
        *even = in[size - 1];
    unsigned char before = out[0];
    for (size_t k = 1; k < size; k++) {
        unsigned char now = out[k];
        out[k] = (unsigned char)(now - before + 128);
        before = now;
    }
}

/* Keeps the samples as they are where deflate would not make them smaller, as the format demands. */
static void make_chunks(void *context, size_t begin, size_t end)
{
    writing *w = context;
    const size_t row_size = (size_t)w->width * w->channel_count * sample_size(w);
    unsigned char *memory = mem_alloc(w->allocator, 2 * CHUNK_ROWS, row_size);
    if (!memory) {
        atomic_store(&w->has_no_memory, true);
        return;
    }
    unsigned char *predicted = memory + CHUNK_ROWS * row_size;
    for (size_t i = begin; i < end; i++) {
        uint32_t y = (uint32_t)i * CHUNK_ROWS;
        uint32_t y_end = w->height - y > CHUNK_ROWS ? y + CHUNK_ROWS : w->height;
        size_t size = (y_end - y) * row_size;
        unsigned char *data = mem_alloc(w->allocator, deflate_bound(size) + ZLIB_FRAME, 1);
        w->chunks[i].data = data;
        if (!data)
            break;
        gather_samples(w, y, y_end, memory);
        predict(memory, size, predicted);
        zlib_begin(data);
        size_t deflated = deflate_piece(w->allocator, w->level, predicted, size, 0, true, data + 2);
        if (deflated == 0)
            break;
        store_u32_be(data + 2 + deflated, zlib_checksum(predicted, size));
        w->chunks[i].size = deflated + ZLIB_FRAME;
        if (w->chunks[i].size >= size) {
            memcpy(data, memory, size);
            w->chunks[i].size = size;
        }
    }
    if (w->chunks[end - 1].size == 0)
        atomic_store(&w->has_no_memory, true);
    mem_free(memory);
}

/* ---- the file ---- */

static int compare_names(const void *a, const void *b)
{
    return strcmp(((const channel *)a)->name, ((const channel *)b)->name);
}

static facet_result list_channels(writing *w, const image_layer *layers, uint32_t layer_count,
                                  facet_error *error)
{
    uint32_t c = 0;
    for (uint32_t l = 0; l < layer_count; l++)
        for (uint32_t k = 0; k < layers[l].channel_count; k++)
            w->channels[c++] = (channel){.name = layers[l].channel_names[k], .layer = &layers[l], .index = k};
    qsort(w->channels, w->channel_count, sizeof *w->channels, compare_names);
    for (c = 0; c < w->channel_count; c++) {
        const char *name = w->channels[c].name;
        size_t length = strlen(name);
        if (length == 0 || length > MAX_NAME)
            return fail(error, FACET_ERROR_ARGUMENT,
                        "OpenEXR: a channel's name has %zu bytes, 1 to %d can be", length, MAX_NAME);
        if (c > 0 && strcmp(name, w->channels[c - 1].name) == 0)
            return fail(error, FACET_ERROR_ARGUMENT, "OpenEXR: two channels are named %s", name);
    }
    return FACET_OK;
}

static facet_result assemble(const writing *w, uint32_t chunk_count, unsigned char **bytes, size_t *size,
                             facet_error *error)
{
    text header = {.allocator = *w->allocator};
    add_header(&header, w);
    size_t total = header.length + (size_t)chunk_count * 8;
    size_t offset = total;
    for (uint32_t i = 0; i < chunk_count; i++)
        total += 8 + w->chunks[i].size;
    unsigned char *file = header.has_failed ? NULL : mem_alloc(w->allocator, total, 1);
    if (file) {
        memcpy(file, header.data, header.length);
        unsigned char *table = file + header.length;
        for (uint32_t i = 0; i < chunk_count; i++, table += 8) {
            store_u32_le(table, (uint32_t)offset);
            store_u32_le(table + 4, (uint32_t)((uint64_t)offset >> 32));
            store_u32_le(file + offset, i * CHUNK_ROWS);
            store_u32_le(file + offset + 4, (uint32_t)w->chunks[i].size);
            memcpy(file + offset + 8, w->chunks[i].data, w->chunks[i].size);
            offset += 8 + w->chunks[i].size;
        }
        *bytes = file;
        *size = total;
    }
    text_destroy(&header);
    return file ? FACET_OK : fail_memory(error, "OpenEXR file", total);
}

facet_result image_encode_exr(uint32_t width, uint32_t height, const image_layer *layers,
                              uint32_t layer_count, bool as_half, const image_encode_desc *desc,
                              unsigned char **bytes, size_t *size, facet_error *error)
{
    *bytes = NULL;
    *size = 0;
    const facet_allocator allocator = desc ? desc->allocator : (facet_allocator){0};
    writing w = {.width = width, .height = height, .as_half = as_half, .allocator = &allocator};
    w.level = desc && desc->compression ? desc->compression : 4;
    uint64_t channel_count = 0;
    for (uint32_t l = 0; l < layer_count; l++)
        channel_count += layers[l].channel_count;
    if (width == 0 || height == 0 || width > INT32_MAX || height > INT32_MAX || channel_count == 0 ||
        channel_count > INT16_MAX || width * channel_count > INT32_MAX / (CHUNK_ROWS * 8) || w.level > 9)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "OpenEXR: %u x %u texels of %llu channels at compression %u cannot be written", width,
                    height, (unsigned long long)channel_count, w.level);
    w.channel_count = (uint32_t)channel_count;
    const uint32_t chunk_count = (height - 1) / CHUNK_ROWS + 1;
    w.channels = mem_alloc(&allocator, w.channel_count, sizeof *w.channels);
    w.chunks = mem_zalloc(&allocator, chunk_count, sizeof *w.chunks);
    facet_result result = FACET_OK;
    if (!w.channels || !w.chunks)
        result = fail_memory(error, "OpenEXR chunks", chunk_count * sizeof *w.chunks);
    if (result == FACET_OK)
        result = list_channels(&w, layers, layer_count, error);
    if (result == FACET_OK) {
        parallel_for(desc && desc->thread_count ? desc->thread_count : 1, chunk_count, 1, make_chunks, &w);
        if (atomic_load(&w.has_no_memory))
            result =
                fail_memory(error, "OpenEXR chunk", CHUNK_ROWS * width * channel_count * sample_size(&w));
    }
    if (result == FACET_OK)
        result = assemble(&w, chunk_count, bytes, size, error);
    for (uint32_t i = 0; w.chunks && i < chunk_count; i++)
        mem_free(w.chunks[i].data);
    mem_free(w.chunks);
    mem_free(w.channels);
    return result;
}
