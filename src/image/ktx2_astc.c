/* ktx2_astc.c - see ktx2_astc.h. */
#include "image/ktx2_astc.h"

#include <stdatomic.h>

#include "base/parallel.h"
#include "base/result.h"

#ifdef HAVE_ASTC

#include "image/astc_shim.h"

enum { THREAD_TEXELS = 65536 }; /* fewer are not worth another thread */

/* What the threads share; the library shares out the blocks. */
typedef struct job {
    astc_shim *shim;
    const unsigned char *bytes;
    size_t size;
    image *out;
    atomic_int failure; /* 0: none yet */
} job;

static void run_threads(void *context, size_t begin, size_t end)
{
    job *j = context;
    for (size_t thread = begin; thread < end; thread++) {
        int failure = astc_shim_decode(j->shim, j->bytes, j->size, j->out->width, j->out->height,
                                       j->out->pixels, (unsigned)thread);
        if (failure)
            atomic_store(&j->failure, failure);
    }
}

facet_result ktx2_decode_astc(const ktx2 *k, const unsigned char *bytes, size_t size, uint32_t thread_count,
                              image *out, facet_error *error)
{
    const ktx2_format *f = k->format;
    const size_t useful = 1 + (size_t)out->width * out->height / THREAD_TEXELS;
    const uint32_t threads = thread_count == 0 ? 1 : thread_count < useful ? thread_count : (uint32_t)useful;
    job j = {.bytes = bytes, .size = size, .out = out};
    int failure = astc_shim_create(f->block_width, f->block_height, k->is_srgb, threads, &j.shim);
    if (!failure) {
        parallel_for(threads, threads, 1, run_threads, &j);
        failure = atomic_load(&j.failure);
    }
    astc_shim_destroy(j.shim);
    if (failure == ASTC_SHIM_MEMORY)
        return fail_memory(error, "ASTC decoder", 0);
    if (failure)
        return fail(error, FACET_ERROR_SYSTEM, "%s: KTX2: libastcenc does not decode %s here", k->name,
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
