/* inflate.c - see inflate.h. */
#include "image/inflate.h"

#include <limits.h>

#include <zlib.h>

#include "base/memory.h"

static void *zlib_alloc(void *allocator, unsigned count, unsigned size)
{
    return mem_alloc(allocator, count, size);
}

static void zlib_free(void *allocator, void *memory)
{
    (void)allocator;
    mem_free(memory);
}

facet_result zlib_inflate(const facet_allocator *allocator, const unsigned char *packed, size_t packed_size,
                          unsigned char *out, size_t out_size)
{
    if (packed_size > UINT_MAX || out_size > UINT_MAX)
        return FACET_ERROR_INVALID;
    z_stream z = {.zalloc = zlib_alloc, .zfree = zlib_free, .opaque = (void *)allocator};
    if (inflateInit(&z) != Z_OK)
        return FACET_ERROR_MEMORY;
    z.next_in = (unsigned char *)packed;
    z.avail_in = (unsigned)packed_size;
    z.next_out = out;
    z.avail_out = (unsigned)out_size;
    int code = inflate(&z, Z_FINISH);
    bool is_whole = code == Z_STREAM_END && z.avail_out == 0;
    inflateEnd(&z);
    if (code == Z_MEM_ERROR)
        return FACET_ERROR_MEMORY;
    return is_whole ? FACET_OK : FACET_ERROR_INVALID;
}
