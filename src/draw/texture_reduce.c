/* texture_reduce.c - see texture_reduce.h. Loops run over adjacent values, in 16 bits where that is exact,
 * so that every x86-64 has vector instructions for them. */
#include "draw/texture_reduce.h"

#include <string.h>

#define INLINE static inline __attribute__((always_inline))

/* Calls an inline function with the number of channels as a constant, which lets its loops unroll. */
#define WITH_CONSTANT(channel_count, CALL)                                                                   \
    switch (channel_count) {                                                                                 \
    case 1:                                                                                                  \
        CALL(1);                                                                                             \
        break;                                                                                               \
    case 2:                                                                                                  \
        CALL(2);                                                                                             \
        break;                                                                                               \
    case 3:                                                                                                  \
        CALL(3);                                                                                             \
        break;                                                                                               \
    default:                                                                                                 \
        CALL(4);                                                                                             \
    }

INLINE bool is_alpha(uint32_t channel, uint32_t channel_count)
{
    return channel_count % 2 == 0 && channel == channel_count - 1;
}

/* ---- codes of 8 bits ---- */

INLINE void colors_from_8(const texture_tables *tables, const unsigned char *codes, uint32_t width,
                          uint32_t channel_count, uint16_t *out)
{
    for (size_t i = 0; i < (size_t)width * channel_count; i += channel_count)
        for (uint32_t c = 0; c < channel_count; c++) {
            const uint16_t *table = is_alpha(c, channel_count) ? tables->data16 : tables->color16;
            out[i + c] = table[codes[i + c]];
        }
}

void texture_row_from_8(const texture_tables *tables, bool as_color, const unsigned char *codes,
                        uint32_t width, uint32_t channel_count, uint16_t *out)
{
    if (!as_color) {
        for (size_t i = 0; i < (size_t)width * channel_count; i++)
            out[i] = (uint16_t)(257 * codes[i]);
        return;
    }
#define FROM_8(N) colors_from_8(tables, codes, width, N, out)
    WITH_CONSTANT(channel_count, FROM_8)
#undef FROM_8
}

/* (v + 128) / 257, the nearest code. With q = (v + 128) / 256 it is (v + 128 - q) / 256, which does not
 * overflow. */
INLINE unsigned char data_to_8(uint16_t v)
{
    uint16_t q = (uint16_t)((v >> 8) + (v >> 7 & 1));
    return (unsigned char)((uint16_t)((uint16_t)(v - q) + 128) >> 8);
}

INLINE void colors_to_8(const texture_tables *tables, const uint16_t *values, uint32_t width,
                        uint32_t channel_count, unsigned char *out)
{
    for (size_t i = 0; i < (size_t)width * channel_count; i += channel_count)
        for (uint32_t c = 0; c < channel_count; c++)
            out[i + c] =
                is_alpha(c, channel_count) ? data_to_8(values[i + c]) : tables->color_from_16[values[i + c]];
}

void texture_row_to_8(const texture_tables *tables, bool as_color, const uint16_t *values, uint32_t width,
                      uint32_t channel_count, unsigned char *out)
{
    if (!as_color) {
        for (size_t i = 0; i < (size_t)width * channel_count; i++)
            out[i] = data_to_8(values[i]);
        return;
    }
#define TO_8(N) colors_to_8(tables, values, width, N, out)
    WITH_CONSTANT(channel_count, TO_8)
#undef TO_8
}

/* ---- means of 2 x 2 texels ---- */

/* Every second texel of means, which are of each texel and its right neighbour. */
INLINE void keep_even_texels(const uint16_t *means, uint32_t width, uint32_t channel_count, uint16_t *out)
{
    /* Three values are moved as four: the next texel overwrites the fourth. */
    size_t moved = channel_count == 3 ? 4 : channel_count;
    for (size_t x = 0; x < width; x++)
        memcpy(out + x * channel_count, means + 2 * x * channel_count, moved * sizeof *out);
}

static void keep_even(const uint16_t *means, uint32_t width, uint32_t channel_count, uint16_t *out){
#define KEEP(N) keep_even_texels(means, width, N, out)
    WITH_CONSTANT(channel_count, KEEP)
#undef KEEP
}

/* (a + b + c + d + 2) / 4 of 16-bit values: from the quarters and their remainders. */
INLINE uint16_t mean4(uint16_t a, uint16_t b, uint16_t c, uint16_t d)
{
    uint16_t quarters = (uint16_t)((a >> 2) + (b >> 2) + (c >> 2) + (d >> 2));
    uint16_t rest = (uint16_t)((a & 3) + (b & 3) + (c & 3) + (d & 3) + 2);
    return (uint16_t)(quarters + (rest >> 2));
}

static void halve_row(const uint16_t *a, const uint16_t *b, uint32_t width, uint32_t channel_count,
                      uint16_t *room, uint16_t *out)
{
    size_t count = (size_t)(2 * width - 1) * channel_count;
    for (size_t i = 0; i < count; i++)
        room[i] = mean4(a[i], a[i + channel_count], b[i], b[i + channel_count]);
    keep_even(room, width, channel_count, out);
}

/* The mean of 257 times four codes of sum s: (257 s + 2) / 4 = 64 s + (s + 2) / 4. */
static void halve_data(const unsigned char *a, const unsigned char *b, uint32_t width, uint32_t channel_count,
                       uint16_t *room, uint16_t *out)
{
    size_t count = (size_t)(2 * width - 1) * channel_count;
    for (size_t i = 0; i < count; i++) {
        uint16_t sum = (uint16_t)(a[i] + a[i + channel_count] + b[i] + b[i + channel_count]);
        room[i] = (uint16_t)(64 * sum + ((uint16_t)(sum + 2) >> 2));
    }
    keep_even(room, width, channel_count, out);
}

INLINE void halve_colors(const texture_tables *tables, const unsigned char *a, const unsigned char *b,
                         uint32_t width, uint32_t channel_count, uint16_t *out)
{
    for (uint32_t x = 0; x < width; x++)
        for (uint32_t c = 0; c < channel_count; c++) {
            const uint16_t *table = is_alpha(c, channel_count) ? tables->data16 : tables->color16;
            size_t i = (size_t)2 * x * channel_count + c;
            uint32_t sum = (uint32_t)table[a[i]] + table[a[i + channel_count]] + table[b[i]] +
                           table[b[i + channel_count]];
            out[(size_t)x * channel_count + c] = (uint16_t)((sum + 2) >> 2);
        }
}

void texture_halve_codes(const texture_tables *tables, bool as_color, const unsigned char *const rows[2],
                         uint32_t source_width, uint32_t channel_count, uint16_t *room, uint16_t *out)
{
    uint32_t width = source_width / 2;
    if (!as_color) {
        halve_data(rows[0], rows[1], width, channel_count, room, out);
        return;
    }
#define HALVE(N) halve_colors(tables, rows[0], rows[1], width, N, out)
    WITH_CONSTANT(channel_count, HALVE)
#undef HALVE
}

/* ---- sizes of any parity ---- */

/* An odd size = 2 n + 1 gives n texels, each of which covers 2 + 1 / n: (n - i) / n of the first one, all
 * of the second and (i + 1) / n of the third. */
texture_coverage texture_cover(uint32_t size, uint32_t i)
{
    if (size == 1)
        return (texture_coverage){.begin = 0, .count = 1, .weights = {1}, .total = 1};
    if (size % 2 == 0)
        return (texture_coverage){.begin = 2 * i, .count = 2, .weights = {1, 1}, .total = 2};
    uint32_t n = size / 2;
    return (texture_coverage){.begin = 2 * i, .count = 3, .weights = {n - i, n, i + 1}, .total = size};
}

/* Weighted means. Sums stay below 2^16 (2^24)^2. */
static void weigh_rows(const uint16_t *const rows[3], texture_coverage vertical, uint32_t source_width,
                       uint32_t width, uint32_t channel_count, uint16_t *out)
{
    for (uint32_t x = 0; x < width; x++) {
        texture_coverage horizontal = texture_cover(source_width, x);
        uint64_t total = (uint64_t)horizontal.total * vertical.total;
        for (uint32_t c = 0; c < channel_count; c++) {
            uint64_t sum = total / 2;
            for (uint32_t j = 0; j < vertical.count; j++) {
                uint64_t row_sum = 0;
                for (uint32_t i = 0; i < horizontal.count; i++)
                    row_sum += (uint64_t)horizontal.weights[i] *
                               rows[j][(size_t)(horizontal.begin + i) * channel_count + c];
                sum += vertical.weights[j] * row_sum;
            }
            out[(size_t)x * channel_count + c] = (uint16_t)(sum / total);
        }
    }
}

void texture_reduce_rows(const uint16_t *const rows[3], texture_coverage vertical, uint32_t source_width,
                         uint32_t width, uint32_t channel_count, uint16_t *room, uint16_t *out)
{
    if (vertical.count == 2 && source_width % 2 == 0)
        halve_row(rows[0], rows[1], width, channel_count, room, out);
    else
        weigh_rows(rows, vertical, source_width, width, channel_count, out);
}
