/* exr_b44.c - OpenEXR's B44 and B44A: blocks of 4 x 4 half samples in 14 bytes, or in 3 where all are equal;
 * other channels as they are. */
#include "image/exr.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "image/half.h"

enum { BLOCK_BYTES = 14, FLAT_BYTES = 3, FLAT_SHIFT = 13 /* and above: a flat block */ };

/* Codes order like the numbers: the bits of a positive half with the sign set, those of a negative
 * inverted. */
static uint16_t half_of_code(uint32_t code)
{
    return (uint16_t)(code & 0x8000u ? code & 0x7fffu : ~code);
}

/* 16 bits: the first sample; 6 bits: a shift; 15 times 6 bits: differences, less 32, shifted. The first
 * column goes down from the first sample, all others to the right from the column before. */
static void unpack_block(const unsigned char *packed, uint16_t out[16])
{
    uint32_t codes[16];
    codes[0] = (uint32_t)packed[0] << 8 | packed[1];
    const uint32_t shift = packed[2] >> 2;
    for (uint32_t k = 1; k < 16; k++) {
        uint32_t bit = 22 + 6 * (k - 1);
        uint32_t pair =
            (uint32_t)packed[bit / 8] << 8 | (bit / 8 + 1 < BLOCK_BYTES ? packed[bit / 8 + 1] : 0);
        uint32_t difference = pair >> (10 - bit % 8) & 0x3f;
        uint32_t index = k < 4 ? 4 * k : (k % 4) * 4 + k / 4;
        codes[index] = codes[k < 4 ? index - 4 : index - 1] + (difference << shift) - (0x20u << shift);
    }
    for (int k = 0; k < 16; k++)
        out[k] = half_of_code(codes[k]);
}

/* Undoes what is coded of linear channels: exp(x / 8) of the sample. */
static uint16_t log_of_half(uint16_t half)
{
    float x = half_to_float(half);
    if (!(x > 0.0f) || !(x < INFINITY))
        return 0;
    return half_from_float((float)(8.0 * log((double)x)));
}

/* One half channel; its rows are row_stride bytes apart. Returns behind its data, NULL: there is too
 * little. */
static const unsigned char *unpack_channel(const exr_chunk *chunk, bool is_linear, const unsigned char *p,
                                           const unsigned char *end, unsigned char *samples,
                                           size_t row_stride)
{
    uint16_t block[16];
    for (uint32_t y = 0; y < chunk->height; y += 4)
        for (uint32_t x = 0; x < chunk->width; x += 4) {
            if (end - p < FLAT_BYTES)
                return NULL;
            if (p[2] >= FLAT_SHIFT << 2) {
                for (int k = 0; k < 16; k++)
                    block[k] = half_of_code((uint32_t)p[0] << 8 | p[1]);
                p += FLAT_BYTES;
            } else {
                if (end - p < BLOCK_BYTES)
                    return NULL;
                unpack_block(p, block);
                p += BLOCK_BYTES;
            }
            for (uint32_t row = 0; row < 4 && y + row < chunk->height; row++) {
                unsigned char *to = samples + (y + row) * row_stride + 2 * (size_t)x;
                for (uint32_t column = 0; column < 4 && x + column < chunk->width; column++, to += 2) {
                    uint16_t half = block[4 * row + column];
                    half = is_linear ? log_of_half(half) : half;
                    to[0] = (unsigned char)half;
                    to[1] = (unsigned char)(half >> 8);
                }
            }
        }
    return p;
}

facet_result exr_unpack_b44(const exr_chunk *chunk, const unsigned char *packed, size_t packed_size,
                            unsigned char *samples)
{
    const unsigned char *p = packed;
    const unsigned char *end = packed + packed_size;
    const size_t row_stride = chunk->size / chunk->height;
    for (uint32_t c = 0; c < chunk->channel_count; c++) {
        const exr_channel *channel = &chunk->channels[c];
        const size_t row_size = chunk->width * exr_sample_size(channel);
        if (channel->type == EXR_HALF) {
            p = unpack_channel(chunk, channel->is_linear, p, end, samples, row_stride);
            if (!p)
                return FACET_ERROR_INVALID;
        } else {
            if ((size_t)(end - p) < row_size * chunk->height)
                return FACET_ERROR_INVALID;
            for (uint32_t y = 0; y < chunk->height; y++, p += row_size)
                memcpy(samples + y * row_stride, p, row_size);
        }
        samples += row_size;
    }
    return FACET_OK;
}
