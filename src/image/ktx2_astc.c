/* ktx2_astc.c - see ktx2_astc.h. Bands of block rows are decoded in parallel, each as a picture of its own. */
#include "image/ktx2_astc.h"

#include <stdatomic.h>

#include "base/parallel.h"
#include "base/result.h"

#ifdef HAVE_ASTC

#include "image/astc_shim.h"

enum { BAND_TEXELS = 65536 };

typedef struct bands {
    const ktx2_format *format;
    const unsigned char *bytes;
    image *out;
    bool is_srgb;
    uint32_t rows, band_rows; /* of blocks */
    atomic_int failure;       /* 0: none yet */
} bands;

static void decode_bands(void *context, size_t begin, size_t end)
{
    bands *b = context;
    const ktx2_format *f = b->format;
    const uint32_t first = (uint32_t)begin * b->band_rows;
    const uint32_t last = end * b->band_rows < b->rows ? (uint32_t)end * b->band_rows : b->rows;
    const size_t row_size = ((size_t)b->out->width + f->block_width - 1) / f->block_width * f->block_size;
    const uint32_t y = first * f->block_height;
    const uint32_t below = last * f->block_height;
    const uint32_t height = (below < b->out->height ? below : b->out->height) - y;
    int failure = astc_shim_decode(b->bytes + first * row_size, (last - first) * row_size, f->block_width,
                                   f->block_height, b->is_srgb, b->out->width, height,
                                   (unsigned char *)b->out->pixels + (size_t)y * image_row_size(b->out));
    if (failure)
        atomic_store(&b->failure, failure);
}

facet_result ktx2_decode_astc(const ktx2 *k, const unsigned char *bytes, size_t size, uint32_t thread_count,
                              image *out, facet_error *error)
{
    (void)size; /* ktx2_open() has found it right */
    const ktx2_format *f = k->format;
    bands b = {.format = f, .bytes = bytes, .out = out, .is_srgb = k->is_srgb};
    b.rows = (out->height + f->block_height - 1) / f->block_height;
    b.band_rows = b.rows; /* preparing the library takes as long as many blocks: one band per thread */
    if (thread_count > 1 && (size_t)out->width * out->height > BAND_TEXELS)
        b.band_rows = (b.rows + thread_count - 1) / thread_count;
    parallel_for(thread_count, (b.rows + b.band_rows - 1) / b.band_rows, 1, decode_bands, &b);
    const int failure = atomic_load(&b.failure);
    if (failure == ASTC_SHIM_MEMORY)
        return fail_memory(error, "ASTC decoder", 0);
    if (failure)
        return fail(error, FACET_ERROR_ENVIRONMENT, "%s: KTX2: libastcenc does not decode %s here", k->name,
                    f->name);
    return FACET_OK;
}

#else

facet_result ktx2_decode_astc(const ktx2 *k, const unsigned char *bytes, size_t size, uint32_t thread_count,
                              image *out, facet_error *error)
{
    (void)bytes, (void)size, (void)thread_count, (void)out;
    return fail(error, FACET_ERROR_UNSUPPORTED, "%s: KTX2: this build of facet does not read %s", k->name,
                k->format->name); /* ktx2_open() has refused before */
}

#endif
