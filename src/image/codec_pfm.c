/* codec_pfm.c - portable float maps: three lines of header, then floats, bottom row first. */
#include "image/codec.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "base/result.h"
#include "image/half.h"

typedef struct pfm_header {
    uint32_t width, height;
    uint32_t channel_count; /* 1 or 3 */
    bool is_big_endian;
    float scale; /* samples are multiplied by it */
    size_t data_offset;
} pfm_header;

static bool is_space(unsigned char c)
{
    return c == ' ' || c == '\n' || c == '\r' || c == '\t';
}

/* The next number after white space; NaN: none. */
static double next_number(const unsigned char **p, const unsigned char *end)
{
    while (*p < end && is_space(**p))
        ++*p;
    const char *after;
    double x = codec_parse_number((const char *)*p, (const char *)end, &after);
    *p = (const unsigned char *)after;
    return *p < end && is_space(**p) ? x : (double)NAN;
}

/* The third number is negative for little-endian data; its magnitude scales the samples. */
static facet_result parse_header(const unsigned char *bytes, size_t size, const char *name, pfm_header *h,
                                 facet_error *error)
{
    *h = (pfm_header){0};
    const unsigned char *p = bytes + 2;
    const unsigned char *end = bytes + size;
    double width = next_number(&p, end);
    double height = next_number(&p, end);
    double scale = next_number(&p, end);
    if (!(width >= 1 && width <= 1e9 && height >= 1 && height <= 1e9) ||
        !(fabs(scale) > 1e-30 && fabs(scale) < 1e30))
        return fail(error, FACET_ERROR_INVALID,
                    "%s: header: width, height and a scale that is not 0 were expected", name);
    *h = (pfm_header){.width = (uint32_t)width,
                      .height = (uint32_t)height,
                      .channel_count = bytes[1] == 'F' ? 3 : 1,
                      .is_big_endian = scale > 0,
                      .scale = (float)fabs(scale),
                      .data_offset = (size_t)(p + 1 - bytes)};
    return FACET_OK;
}

facet_result pfm_probe(const unsigned char *bytes, size_t size, const char *name, image *header,
                       facet_error *error)
{
    pfm_header h;
    TRY(parse_header(bytes, size, name, &h, error));
    *header = (image){.width = h.width, .height = h.height, .channel_count = 3, .type = IMAGE_F32};
    return FACET_OK;
}

facet_result pfm_decode(const unsigned char *bytes, size_t size, const char *name,
                        const image_decode_desc *desc, image *out, facet_error *error)
{
    pfm_header h;
    TRY(parse_header(bytes, size, name, &h, error));
    TRY(codec_check_size(name, h.width, h.height, desc->max_size, error));
    const size_t row_size = (size_t)h.width * h.channel_count * 4;
    if ((size - h.data_offset) / row_size < h.height)
        return fail(error, FACET_ERROR_INVALID, "%s: %u x %u texels need %zu bytes, the file has %zu", name,
                    h.width, h.height, row_size * h.height, size - h.data_offset);
    TRY(image_create(&desc->allocator, h.width, h.height, 3, IMAGE_F32, out, error));
    float *to = out->pixels;
    for (uint32_t y = 0; y < h.height; y++) {
        const unsigned char *from = bytes + h.data_offset + row_size * (h.height - 1 - y);
        for (size_t k = 0; k < (size_t)h.width * h.channel_count; k++, from += 4) {
            float x = h.scale * float_from_bits(h.is_big_endian ? load_u32_be(from) : load_u32_le(from));
            x = desc->keeps_nonfinite ? x : codec_finite(x);
            *to++ = x;
            if (h.channel_count == 1) {
                *to++ = x;
                *to++ = x;
            }
        }
    }
    return FACET_OK;
}

facet_result pfm_encode(const image *i, const image_encode_desc *desc, unsigned char **bytes, size_t *size,
                        facet_error *error)
{
    TRY(codec_check_input(i, "PFM", i->type == IMAGE_F32 && !i->is_srgb, "float RGB", 1u << 3, error));
    const size_t row_size = image_row_size(i);
    unsigned char *file = mem_alloc(&desc->allocator, (size_t)i->height + 1, row_size + 64);
    if (!file)
        return fail_memory(error, "PFM file", row_size * i->height);
    unsigned char *p = file + snprintf((char *)file, 64, "PF\n%u %u\n-1.0\n", i->width, i->height);
    for (uint32_t y = i->height; y-- > 0;) {
        const float *from = (const float *)i->pixels + (size_t)y * i->width * 3;
        for (size_t k = 0; k < (size_t)i->width * 3; k++, p += 4)
            store_u32_le(p, float_bits(from[k]));
    }
    *bytes = file;
    *size = (size_t)(p - file);
    return FACET_OK;
}
