/* denoise.c - see denoise.h. */
#include "film/denoise.h"

#include "base/result.h"

facet_result film_denoise(film *f, const facet_allocator *allocator, uint32_t thread_count,
                          facet_error *error)
{
    (void)f;
    (void)allocator;
    (void)thread_count;
    return fail(error, FACET_ERROR_UNSUPPORTED, "denoising is not there yet");
}
