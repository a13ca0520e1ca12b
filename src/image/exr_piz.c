/* exr_piz.c - OpenEXR's PIZ: 16-bit numbers, renumbered without gaps, through a Haar wavelet,
 * Huffman-coded. */
#include "image/codec.h"
#include "image/exr.h"

#include <string.h>

#include "base/memory.h"

enum { NUMBERS = 65536, BITMAP_SIZE = NUMBERS / 8 };

/* The bitmap of the numbers that occur, of which bytes first to last are stored, to a table from rank to
 * number; 0 always occurs. Returns the greatest rank. */
static uint32_t build_table(const unsigned char *bitmap, uint32_t first, uint32_t last,
                            uint16_t table[NUMBERS])
{
    uint32_t rank = 0;
    table[rank++] = 0;
    for (uint32_t byte = first; byte <= last; byte++)
        for (uint32_t bit = 0; bit < 8; bit++)
            if (bitmap[byte - first] >> bit & 1 && byte * 8 + bit > 0)
                table[rank++] = (uint16_t)(byte * 8 + bit);
    memset(table + rank, 0, (NUMBERS - rank) * sizeof *table);
    return rank - 1;
}

/* The inverse step of the wavelet, mean m and difference d to the two numbers. Fewer than 2^14 ranks: signed
 * arithmetic; else modulo 2^16. */
static inline void merge_14(uint16_t m, uint16_t d, uint16_t *a, uint16_t *b)
{
    int difference = (int16_t)d;
    int first = (int16_t)m + (difference & 1) + (difference >> 1);
    *a = (uint16_t)first;
    *b = (uint16_t)(first - difference);
}

static inline void merge_16(uint16_t m, uint16_t d, uint16_t *a, uint16_t *b)
{
    uint16_t second = (uint16_t)(m - (d >> 1));
    *a = (uint16_t)(d + second - 0x8000);
    *b = second;
}

static inline void merge(bool is_14, uint16_t m, uint16_t d, uint16_t *a, uint16_t *b)
{
    if (is_14)
        merge_14(m, d, a, b);
    else
        merge_16(m, d, a, b);
}

/* Four numbers, p texels apart, from one mean and three differences. */
static inline void merge_square(bool is_14, uint16_t *n, size_t right, size_t down)
{
    uint16_t top_left, top_right, bottom_left, bottom_right;
    merge(is_14, n[0], n[down], &top_left, &bottom_left);
    merge(is_14, n[right], n[down + right], &top_right, &bottom_right);
    merge(is_14, top_left, top_right, &n[0], &n[right]);
    merge(is_14, bottom_left, bottom_right, &n[down], &n[down + right]);
}

/* One level: numbers whose coordinates are multiples of 2 p become those that are multiples of p. An odd
 * one out at the right or bottom border has a partner in one direction only. */
static inline void merge_level(bool is_14, uint16_t *n, uint32_t width, uint32_t height, size_t x_step,
                               size_t y_step, uint32_t p)
{
    const size_t right = x_step * p;
    const size_t down = y_step * p;
    const uint32_t columns = width / (2 * p);
    const uint32_t rows = height / (2 * p);
    for (uint32_t y = 0; y < rows; y++) {
        uint16_t *row = n + 2 * down * y;
        for (uint32_t x = 0; x < columns; x++)
            merge_square(is_14, row + 2 * right * x, right, down);
        if (width & p) {
            uint16_t *odd = row + 2 * right * columns;
            merge(is_14, odd[0], odd[down], &odd[0], &odd[down]);
        }
    }
    if (height & p) {
        uint16_t *row = n + 2 * down * rows;
        for (uint32_t x = 0; x < columns; x++) {
            uint16_t *odd = row + 2 * right * x;
            merge(is_14, odd[0], odd[right], &odd[0], &odd[right]);
        }
    }
}

static void undo_wavelet(uint16_t *n, uint32_t width, uint32_t height, size_t x_step, size_t y_step,
                         uint32_t greatest)
{
    uint32_t p = 1;
    while (p <= (width < height ? width : height) / 2)
        p *= 2;
    for (p /= 2; p >= 1; p /= 2) {
        if (greatest < 1u << 14)
            merge_level(true, n, width, height, x_step, y_step, p);
        else
            merge_level(false, n, width, height, x_step, y_step, p);
    }
}

/* The channels' planes to rows of all channels, ranks to numbers. */
static void gather_rows(const exr_chunk *chunk, const uint16_t *planes, const uint16_t table[NUMBERS],
                        unsigned char *samples)
{
    size_t plane = 0;  /* of the channel, in numbers */
    size_t column = 0; /* of it in a row */
    const size_t row_size = chunk->size / 2 / chunk->height;
    for (uint32_t c = 0; c < chunk->channel_count; c++) {
        const size_t width = chunk->width * exr_sample_size(&chunk->channels[c]) / 2;
        for (uint32_t y = 0; y < chunk->height; y++) {
            const uint16_t *from = planes + plane + y * width;
            unsigned char *to = samples + 2 * (y * row_size + column);
            for (size_t x = 0; x < width; x++) {
                uint16_t number = table[from[x]];
                to[2 * x] = (unsigned char)number;
                to[2 * x + 1] = (unsigned char)(number >> 8);
            }
        }
        plane += width * chunk->height;
        column += width;
    }
}

/* Packed: first and last byte of the bitmap (16 bits each), the bytes, then size (32 bits) and Huffman
 * data. */
facet_result exr_unpack_piz(const exr_chunk *chunk, const unsigned char *packed, size_t packed_size,
                            unsigned char *samples)
{
    if (packed_size < 4)
        return FACET_ERROR_INVALID;
    const unsigned char *p = packed + 4;
    const unsigned char *end = packed + packed_size;
    const uint32_t first = packed[0] | (uint32_t)packed[1] << 8;
    const uint32_t last = packed[2] | (uint32_t)packed[3] << 8;
    const uint32_t bitmap_size = first <= last ? last - first + 1 : 0;
    if (last >= BITMAP_SIZE || (size_t)(end - p) < bitmap_size + 4)
        return FACET_ERROR_INVALID;
    const size_t count = chunk->size / 2;
    uint16_t *memory = mem_alloc(chunk->allocator, NUMBERS + count, sizeof *memory);
    if (!memory)
        return FACET_ERROR_MEMORY;
    uint16_t *table = memory;
    uint16_t *plane = memory + NUMBERS;
    uint32_t greatest = bitmap_size ? build_table(p, first, last, table) : build_table(p, 1, 0, table);
    p += bitmap_size;
    const size_t coded_size = load_u32_le(p);
    p += 4;
    facet_result result = FACET_ERROR_INVALID;
    if (coded_size <= (size_t)(end - p))
        result = exr_huffman_decode(chunk->allocator, p, coded_size, plane, count);
    for (uint32_t c = 0; c < chunk->channel_count && result == FACET_OK; c++) {
        const size_t numbers = exr_sample_size(&chunk->channels[c]) / 2; /* of a sample */
        for (size_t k = 0; k < numbers; k++)
            undo_wavelet(plane + k, chunk->width, chunk->height, numbers, numbers * chunk->width, greatest);
        plane += numbers * chunk->width * chunk->height;
    }
    if (result == FACET_OK)
        gather_rows(chunk, memory + NUMBERS, table, samples);
    mem_free(memory);
    return result;
}
