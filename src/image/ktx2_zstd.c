/* ktx2_zstd.c - see ktx2.h. A file of its own: in browsers, the decoder is a module that is fetched when a file needs it. */
#include "image/ktx2.h"

#ifdef HAVE_ZSTD
#include <zstd.h>
#endif

facet_result ktx2_inflate_zstd(const unsigned char *in, size_t in_size, unsigned char *out, size_t out_size,
                               char reason[KTX2_REASON])
{
    (void)reason;
#ifdef HAVE_ZSTD
    return ZSTD_decompress(out, out_size, in, in_size) == out_size ? FACET_OK : FACET_ERROR_INVALID;
#else
    (void)in, (void)in_size, (void)out, (void)out_size;
    return FACET_ERROR_UNSUPPORTED; /* refused by ktx2_open() */
#endif
}
