/* png_whole.c - see png_whole.h. */
#include "image/png_whole.h"

#include <libdeflate.h>

#include "base/memory.h"
#include "base/simd.h"
#include "image/deflate.h"
#include "image/png_chunk.h"
#include "image/png_filter.h"

enum {
    MOST_BYTES = 96 << 20, /* of an image's rows, and of a file */
    MOST_EXPANSION = 1032  /* of deflate */
};

/* ---- inflating ---- */

/* Whether the CRC of a chunk fits. */
static bool is_sound(const png_chunk *c)
{
#ifdef FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION
    if (c->type)
        return true;
#endif
    return crc32_checksum(c->type, png_chunk_size(c) + 4) == load_u32_be(c->end - 4);
}

/* The sizes of an image of the kind that is read here; false: of another kind. */
static bool read_header(const png_chunk *c, png_whole *out)
{
    static const uint32_t channels[] = {1, 0, 3, 0, 2, 0, 4}; /* by the color type; 0: palette, or none */
    const unsigned char *d = c->data;
    if (!png_chunk_is(c, "IHDR") || png_chunk_size(c) != PNG_IHDR_SIZE || !is_sound(c))
        return false;
    out->width = load_u32_be(d);
    out->height = load_u32_be(d + 4);
    if (d[8] != 8 || d[9] >= sizeof channels / sizeof *channels || d[10] || d[11] || d[12])
        return false;
    out->channel_count = channels[d[9]];
    return out->channel_count != 0;
}

/* The data of all IDAT chunks in *data and their size; the other chunks are optional. NULL: another kind of file. Of
 * several chunks the data is put together in *joined, which has space for it. */
static const unsigned char *find_data(const unsigned char *p, const unsigned char *end, unsigned char *joined,
                                      size_t *size)
{
    png_chunk c;
    const unsigned char *data = NULL;
    for (*size = 0; png_chunk_next(&p, end, &c) && !png_chunk_is(&c, "IEND");) {
        const bool is_data = png_chunk_is(&c, "IDAT");
        const bool is_optional = c.type[0] & 0x20 && !png_chunk_is(&c, "tRNS");
        if (!is_optional && !is_data && !png_chunk_is(&c, "PLTE")) /* here only a suggestion */
            return NULL;
        if (!is_data)
            continue;
        if (!is_sound(&c))
            return NULL;
        data = data ? joined : c.data;
        memcpy(joined + *size, c.data, png_chunk_size(&c));
        *size += png_chunk_size(&c);
    }
    return data;
}

/* Bytes of a row and its filter. */
static size_t stride_of(const png_whole *p)
{
    return (size_t)p->width * p->channel_count + 1;
}

/* Whether each row begins with the number of a filter. */
static bool has_filters(const png_whole *p)
{
    for (uint32_t y = 0; y < p->height; y++)
        if (p->rows[y * stride_of(p)] > PNG_PAETH)
            return false;
    return true;
}

static bool inflate_rows(const unsigned char *data, size_t size, const png_whole *p, size_t row_bytes)
{
    struct libdeflate_decompressor *d = libdeflate_alloc_decompressor();
    size_t read = 0;
    const bool is_whole = d && libdeflate_zlib_decompress_ex(d, data, size, p->rows, row_bytes, &read,
                                                             NULL) == LIBDEFLATE_SUCCESS;
    libdeflate_free_decompressor(d);
    return is_whole && read == size && has_filters(p);
}

bool png_whole_open(const unsigned char *bytes, size_t size, const facet_allocator *allocator, png_whole *out)
{
    png_whole p = {0};
    png_chunk c;
    const unsigned char *at = bytes + PNG_SIGNATURE_SIZE;
    const unsigned char *end = bytes + size;
    if (size > MOST_BYTES || !png_chunk_next(&at, end, &c) || !read_header(&c, &p))
        return false;
    if (p.width > MOST_BYTES || p.height > MOST_BYTES)
        return false;
    const size_t stride = stride_of(&p);
    const uint64_t row_bytes = (uint64_t)stride * p.height;
    if (row_bytes > MOST_BYTES || row_bytes / MOST_EXPANSION > size)
        return false;
    unsigned char *joined = mem_alloc(allocator, size, 1);
    p.memory = mem_alloc(allocator, stride + (size_t)row_bytes, 1);
    size_t data_size = 0;
    const unsigned char *data = joined && p.memory ? find_data(at, end, joined, &data_size) : NULL;
    if (data) {
        memset(p.memory, 0, stride);
        p.rows = p.memory + stride;
    }
    const bool is_read = data && inflate_rows(data, data_size, &p, (size_t)row_bytes);
    mem_free(joined);
    if (is_read)
        *out = p;
    else
        png_whole_close(&p);
    return is_read;
}

void png_whole_close(png_whole *p)
{
    mem_free(p->memory);
    p->memory = p->rows = NULL;
}

/* ---- filters ---- */

/* Adds the prediction of filter to a row in place. above is the row before, zeros at the top. channels and filter are
 * constants at each call site, so that the texel's channels are computed side by side. */
static inline __attribute__((always_inline)) void add_prediction(unsigned char *row,
                                                                 const unsigned char *above, size_t size,
                                                                 size_t channels, png_filter filter)
{
    int left[4] = {0};
    int corner[4] = {0};
    for (size_t k = 0; k < size; k += channels)
        for (size_t i = 0; i < channels; i++) {
            const int up = above[k + i];
            const int prediction = filter == PNG_LEFT      ? left[i]
                                   : filter == PNG_AVERAGE ? (left[i] + up) >> 1
                                                           : png_paeth(left[i], up, corner[i]);
            left[i] = row[k + i] = (unsigned char)(row[k + i] + prediction);
            corner[i] = up;
        }
}

static inline __attribute__((always_inline)) void unfilter(unsigned char *row, const unsigned char *above,
                                                           size_t size, size_t channels)
{
    switch (row[-1]) {
    case PNG_LEFT:
        add_prediction(row, above, size, channels, PNG_LEFT);
        break;
    case PNG_UP:
        for (size_t k = 0; k < size; k++)
            row[k] = (unsigned char)(row[k] + above[k]);
        break;
    case PNG_AVERAGE:
        add_prediction(row, above, size, channels, PNG_AVERAGE);
        break;
    case PNG_PAETH:
        add_prediction(row, above, size, channels, PNG_PAETH);
        break;
    default:
        break;
    }
}

DISPATCH_AVX2 static void png_whole_unfilter(unsigned char *row, const unsigned char *above, size_t size,
                                             size_t channels)
{
    switch (channels) {
    case 1:
        unfilter(row, above, size, 1);
        break;
    case 2:
        unfilter(row, above, size, 2);
        break;
    case 3:
        unfilter(row, above, size, 3);
        break;
    default:
        unfilter(row, above, size, 4);
    }
}

const unsigned char *png_whole_row(const png_whole *p, uint32_t y)
{
    unsigned char *row = p->rows + y * stride_of(p) + 1;
    png_whole_unfilter(row, row - stride_of(p), stride_of(p) - 1, p->channel_count);
    return row;
}
