/* png_write.c - writes PNG in parallel: rows are filtered independently, then blocks of them are deflated
 * independently, with the preceding 32 KiB as dictionary, and concatenated. Block size and all choices depend
 * on the image alone, so the bytes do not depend on the number of threads. PNG third edition (W3C 2023); RFC
 * 1950, 1951. */
#include "image/codec.h"

#include <stdatomic.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "base/simd.h"
#include "image/deflate.h"
#include "image/png_chunk.h"
#include "image/png_filter.h"

/* ---- filters ---- */

/* Stores row minus its prediction in out. above is the previous row, zeros at the top; both are preceded by
 * texel (1 to 8) zeros. */
static inline __attribute__((always_inline)) void filter_row(png_filter filter, const unsigned char *row,
                                                             const unsigned char *above, size_t size,
                                                             size_t texel, unsigned char *restrict out)
{
    const unsigned char *left = row - texel;
    const unsigned char *corner = above - texel;
    switch (filter) {
    case PNG_NONE:
        memcpy(out, row, size);
        return;
    case PNG_LEFT:
        for (size_t k = 0; k < size; k++)
            out[k] = (unsigned char)(row[k] - left[k]);
        return;
    case PNG_UP:
        for (size_t k = 0; k < size; k++)
            out[k] = (unsigned char)(row[k] - above[k]);
        return;
    case PNG_AVERAGE:
        for (size_t k = 0; k < size; k++)
            out[k] = (unsigned char)(row[k] - ((left[k] + above[k]) >> 1));
        return;
    case PNG_PAETH:
        for (size_t k = 0; k < size; k++)
            out[k] = (unsigned char)(row[k] - png_paeth(left[k], above[k], corner[k]));
        return;
    }
}

enum { BLOCK_SIZE = 128 * 1024 }; /* filtered bytes per work item */

/* One IDAT chunk. */
typedef struct block {
    unsigned char *deflated;
    size_t size, in_size;
    uint32_t checksum; /* of the uncompressed bytes */
} block;

typedef struct writing {
    const image *image;
    const image_encode_desc *desc;
    size_t row_size;         /* without the filter byte */
    unsigned char *filtered; /* height rows of 1 + row_size bytes */
    size_t filtered_size;
    size_t block_size; /* of filtered; the last block has what is left */
    block *blocks;
    size_t block_count;
    _Atomic bool has_no_memory;
} writing;

/* ---- filters ---- */

/* Stores one row in file order: 16 bits with the high byte first. */
static void load_row(const image *i, uint32_t y, size_t row_size, unsigned char *row)
{
    if (i->type == IMAGE_U8) {
        memcpy(row, (const unsigned char *)i->pixels + y * row_size, row_size);
        return;
    }
    const uint16_t *from = (const uint16_t *)i->pixels + y * (row_size / 2);
    for (size_t k = 0; k < row_size / 2; k++) {
        row[2 * k] = (unsigned char)(from[k] >> 8);
        row[2 * k + 1] = (unsigned char)from[k];
    }
}

/* Sum of absolute filtered bytes as signed numbers, which the PNG specification (12.7) advises to minimise. */
static inline __attribute__((always_inline)) uint32_t weight(const unsigned char *filtered, size_t size)
{
    uint32_t sum = 0;
    for (size_t k = 0; k < size; k++) {
        const unsigned char negated = (unsigned char)-filtered[k];
        sum += filtered[k] < negated ? filtered[k] : negated;
    }
    return sum;
}

DISPATCH_AVX2 static void png_filter_rows(void *context, size_t begin, size_t end)
{
    writing *w = context;
    const size_t texel = image_texel_size(w->image);
    const size_t stride = texel + w->row_size;
    /* two rows with texel zeros before them, then one row per filter */
    unsigned char *memory = mem_zalloc(&w->desc->allocator, 2 * stride + PNG_FILTER_COUNT * w->row_size, 1);
    if (!memory) {
        atomic_store(&w->has_no_memory, true);
        return;
    }
    unsigned char *row = memory + texel;
    unsigned char *above = row + stride;
    unsigned char *tried = memory + 2 * stride;
    if (begin > 0)
        load_row(w->image, (uint32_t)begin - 1, w->row_size, above);
    for (size_t y = begin; y < end; y++) {
        load_row(w->image, (uint32_t)y, w->row_size, row);
        int best = 0;
        uint32_t best_weight = UINT32_MAX;
        for (int filter = 0; filter < PNG_FILTER_COUNT && best_weight > 0; filter++) {
            unsigned char *out = tried + (size_t)filter * w->row_size;
            filter_row((png_filter)filter, row, above, w->row_size, texel, out);
            uint32_t sum = weight(out, w->row_size);
            if (sum < best_weight) {
                best_weight = sum;
                best = filter;
            }
        }
        unsigned char *out = w->filtered + y * (1 + w->row_size);
        *out = (unsigned char)best;
        memcpy(out + 1, tried + (size_t)best * w->row_size, w->row_size);
        unsigned char *swap = above;
        above = row;
        row = swap;
    }
    mem_free(memory);
}

/* ---- deflate ---- */

static void deflate_blocks(void *context, size_t begin, size_t end)
{
    writing *w = context;
    for (size_t b = begin; b < end; b++) {
        block *out = &w->blocks[b];
        size_t first = b * w->block_size;
        bool is_last = b + 1 == w->block_count;
        out->in_size = is_last ? w->filtered_size - first : w->block_size;
        out->deflated = mem_alloc(&w->desc->allocator, deflate_bound(out->in_size), 1);
        if (out->deflated)
            out->size = deflate_piece(&w->desc->allocator, w->desc->compression, w->filtered + first,
                                      out->in_size, b > 0 ? DEFLATE_WINDOW : 0, is_last, out->deflated);
        if (out->size == 0)
            atomic_store(&w->has_no_memory, true);
        else
            out->checksum = zlib_checksum(w->filtered + first, out->in_size);
    }
}

/* ---- the file ---- */

/* Writes length and type of a chunk; its data must follow, then end_chunk(). */
static unsigned char *begin_chunk(unsigned char *p, const char type[4], size_t length)
{
    store_u32_be(p, (uint32_t)length);
    memcpy(p + 4, type, 4);
    return p + 8;
}

static unsigned char *end_chunk(unsigned char *data, size_t length)
{
    store_u32_be(data + length, crc32_checksum(data - 4, length + 4));
    return data + length + 4;
}

/* Bytes of a text chunk's data: keyword, 0, text. */
static size_t text_length(const image_text *t)
{
    return strlen(t->name) + 1 + strlen(t->value);
}

/* Appends the texts as tEXt chunks. */
static unsigned char *put_texts(const image_encode_desc *desc, unsigned char *p)
{
    for (uint32_t i = 0; i < desc->text_count; i++) {
        const image_text *t = &desc->texts[i];
        size_t name = strlen(t->name) + 1;
        p = begin_chunk(p, "tEXt", text_length(t));
        memcpy(p, t->name, name);
        memcpy(p + name, t->value, strlen(t->value));
        p = end_chunk(p, text_length(t));
    }
    return p;
}

static facet_result assemble(const writing *w, unsigned char **bytes, size_t *size, facet_error *error)
{
    size_t most = PNG_SIGNATURE_SIZE + PNG_CHUNK_FRAME + PNG_IHDR_SIZE + PNG_CHUNK_FRAME + 2 + 4;
    for (size_t b = 0; b < w->block_count; b++)
        most += PNG_CHUNK_FRAME + w->blocks[b].size;
    for (uint32_t i = 0; i < w->desc->text_count; i++)
        most += PNG_CHUNK_FRAME + text_length(&w->desc->texts[i]);
    unsigned char *file = mem_alloc(&w->desc->allocator, most, 1);
    if (!file)
        return fail_memory(error, "PNG file", most);
    static const unsigned char color_types[] = {0, 0, 4, 2, 6};
    memcpy(file, "\x89PNG\r\n\x1a\n", 8);
    unsigned char *p = begin_chunk(file + 8, "IHDR", 13);
    store_u32_be(p, w->image->width);
    store_u32_be(p + 4, w->image->height);
    p[8] = w->image->type == IMAGE_U8 ? 8 : 16;
    p[9] = color_types[w->image->channel_count];
    memset(p + 10, 0, 3); /* deflate, the five filters, not interlaced */
    p = put_texts(w->desc, end_chunk(p, 13));

    uint32_t checksum = zlib_checksum(NULL, 0);
    for (size_t b = 0; b < w->block_count; b++) {
        const block *from = &w->blocks[b];
        bool is_last = b + 1 == w->block_count;
        size_t length = from->size + (b == 0 ? 2 : 0) + (is_last ? 4 : 0);
        checksum = zlib_checksum_join(checksum, from->checksum, from->in_size);
        p = begin_chunk(p, "IDAT", length);
        unsigned char *data = p;
        if (b == 0) {
            zlib_begin(data);
            data += 2;
        }
        memcpy(data, from->deflated, from->size);
        if (is_last)
            store_u32_be(data + from->size, checksum);
        p = end_chunk(p, length);
    }
    p = end_chunk(begin_chunk(p, "IEND", 0), 0);
    *bytes = file;
    *size = (size_t)(p - file);
    return FACET_OK;
}

facet_result png_encode(const image *i, const image_encode_desc *desc, unsigned char **bytes, size_t *size,
                        facet_error *error)
{
    facet_result result = codec_check_input(i, "PNG", i->type == IMAGE_U8 || i->type == IMAGE_U16,
                                            "8 or 16 bits and 1 to 4", 0x1e, error);
    if (result != FACET_OK)
        return result;
    if (i->width > INT32_MAX || i->height > INT32_MAX || image_row_size(i) > UINT32_MAX / 256)
        return fail(error, FACET_ERROR_ARGUMENT, "PNG: %u x %u texels are too many", i->width, i->height);
    writing w = {.image = i, .desc = desc, .row_size = image_row_size(i)};
    w.filtered_size = (1 + w.row_size) * i->height;
    w.block_size = w.filtered_size <= DEFLATE_WHOLE ? DEFLATE_WHOLE : BLOCK_SIZE;
    w.block_count = (w.filtered_size + w.block_size - 1) / w.block_size;
    w.filtered = mem_alloc(&desc->allocator, w.filtered_size, 1);
    w.blocks = mem_zalloc(&desc->allocator, w.block_count, sizeof *w.blocks);
    if (!w.filtered || !w.blocks) {
        result = fail_memory(error, "filtered rows", w.filtered_size);
        goto done;
    }
    parallel_for(desc->thread_count, i->height, 32768 / w.row_size + 8, png_filter_rows, &w);
    if (atomic_load(&w.has_no_memory)) {
        result = fail_memory(error, "filtered rows", w.row_size);
        goto done;
    }
    parallel_for(desc->thread_count, w.block_count, 1, deflate_blocks, &w);
    if (atomic_load(&w.has_no_memory)) {
        result = fail_memory(error, "deflate", w.block_size);
        goto done;
    }
    result = assemble(&w, bytes, size, error);
done:
    for (size_t b = 0; w.blocks && b < w.block_count; b++)
        mem_free(w.blocks[b].deflated);
    mem_free(w.blocks);
    mem_free(w.filtered);
    return result;
}
