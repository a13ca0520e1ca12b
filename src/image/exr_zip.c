/* exr_zip.c - OpenEXR's byte-wise codings: RLE, ZIP and ZIPS, and PXR24, which is ZIP of 24-bit floats. */
#include "image/codec.h"
#include "image/exr.h"

#include <string.h>

#include "base/memory.h"
#include "image/inflate.h"

/* Codes: -1 to -127: so many bytes follow; 0 to 127: one byte, once more than that. */
facet_result exr_expand_runs(const unsigned char *packed, size_t packed_size, unsigned char *out, size_t size)
{
    const unsigned char *end = packed + packed_size;
    while (packed < end) {
        size_t code = *packed++;
        size_t count = code > 127 ? 256 - code : code + 1;
        size_t bytes = code > 127 ? count : 1;
        if (count > size || (size_t)(end - packed) < bytes)
            return FACET_ERROR_INVALID;
        if (code > 127)
            memcpy(out, packed, count);
        else
            memset(out, *packed, count);
        packed += bytes;
        out += count;
        size -= count;
    }
    return size == 0 ? FACET_OK : FACET_ERROR_INVALID;
}

/* Sums up the differences, less 128 each, then deals the first half to the even bytes, the second to the
 * odd. */
void exr_unpredict(unsigned char *predicted, size_t size, unsigned char *out)
{
    for (size_t k = 1; k < size; k++)
        predicted[k] = (unsigned char)(predicted[k - 1] + predicted[k] - 128);
    const unsigned char *even = predicted;
    const unsigned char *odd = predicted + (size + 1) / 2;
    for (size_t k = 0; k < size / 2; k++) {
        out[2 * k] = even[k];
        out[2 * k + 1] = odd[k];
    }
    if (size % 2)
        out[size - 1] = even[size / 2];
}

facet_result exr_unpack_rle(const exr_chunk *chunk, const unsigned char *packed, size_t packed_size,
                            unsigned char *samples)
{
    unsigned char *predicted = mem_alloc(chunk->allocator, chunk->size, 1);
    if (!predicted)
        return FACET_ERROR_MEMORY;
    facet_result result = exr_expand_runs(packed, packed_size, predicted, chunk->size);
    if (result == FACET_OK)
        exr_unpredict(predicted, chunk->size, samples);
    mem_free(predicted);
    return result;
}

facet_result exr_unpack_zip(const exr_chunk *chunk, const unsigned char *packed, size_t packed_size,
                            unsigned char *samples)
{
    unsigned char *predicted = mem_alloc(chunk->allocator, chunk->size, 1);
    if (!predicted)
        return FACET_ERROR_MEMORY;
    bool is_whole = zlib_inflate(packed, packed_size, predicted, chunk->size);
    if (is_whole)
        exr_unpredict(predicted, chunk->size, samples);
    mem_free(predicted);
    return is_whole ? FACET_OK : FACET_ERROR_INVALID;
}

/* The bytes, high ones first, that PXR24 keeps of a sample. */
static uint32_t pxr24_bytes(const exr_channel *channel)
{
    static const unsigned char bytes[] = {[EXR_UINT] = 4, [EXR_HALF] = 2, [EXR_FLOAT] = 3};
    return bytes[channel->type];
}

/* Each row of a channel: a plane per byte, differences from sample to sample. Floats lack their last byte. */
facet_result exr_unpack_pxr24(const exr_chunk *chunk, const unsigned char *packed, size_t packed_size,
                              unsigned char *samples)
{
    size_t size = 0;
    for (uint32_t c = 0; c < chunk->channel_count; c++)
        size += (size_t)chunk->width * chunk->height * pxr24_bytes(&chunk->channels[c]);
    unsigned char *planes = mem_alloc(chunk->allocator, size, 1);
    if (!planes)
        return FACET_ERROR_MEMORY;
    bool is_whole = zlib_inflate(packed, packed_size, planes, size);
    const unsigned char *plane = planes;
    for (uint32_t y = 0; y < chunk->height && is_whole; y++)
        for (uint32_t c = 0; c < chunk->channel_count; c++) {
            const uint32_t bytes = pxr24_bytes(&chunk->channels[c]);
            const uint32_t shift = chunk->channels[c].type == EXR_FLOAT ? 8 : 0;
            uint32_t sample = 0;
            for (uint32_t x = 0; x < chunk->width; x++) {
                uint32_t difference = 0;
                for (uint32_t b = 0; b < bytes; b++)
                    difference = difference << 8 | plane[(size_t)b * chunk->width + x];
                sample += difference << shift;
                for (uint32_t b = 0; b < exr_sample_size(&chunk->channels[c]); b++)
                    *samples++ = (unsigned char)(sample >> 8 * b);
            }
            plane += (size_t)bytes * chunk->width;
        }
    mem_free(planes);
    return is_whole ? FACET_OK : FACET_ERROR_INVALID;
}
