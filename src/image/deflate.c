/* deflate.c - see deflate.h. */
#include "image/deflate.h"

#include <zlib.h>
#ifdef HAVE_LIBDEFLATE
#include <libdeflate.h>
#endif

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

size_t deflate_bound(size_t size)
{
    return size + size / 1024 + 64; /* stored blocks hold at least 16383 bytes and add 5 each */
}

#ifdef HAVE_LIBDEFLATE
/* A whole stream, in half of zlib's time; its last block is marked wherever it ends, so pieces cannot be joined. 0: out
 * of memory or of space. */
static size_t deflate_whole(const facet_allocator *allocator, uint32_t level, const unsigned char *bytes,
                            size_t size, unsigned char *out)
{
    enum { COMPRESSOR_SIZE = 1 << 20 }; /* of the library's own memory, at most */
    if (!mem_account(allocator, COMPRESSOR_SIZE))
        return 0;
    struct libdeflate_compressor *c = libdeflate_alloc_compressor((int)level);
    size_t used = c ? libdeflate_deflate_compress(c, bytes, size, out, deflate_bound(size)) : 0;
    libdeflate_free_compressor(c);
    mem_account(allocator, -(ptrdiff_t)COMPRESSOR_SIZE);
    return used;
}
#endif

/* All pieces but the last end with an empty stored block (Z_SYNC_FLUSH) for byte alignment. */
size_t deflate_piece(const facet_allocator *allocator, uint32_t level, const unsigned char *bytes,
                     size_t size, size_t history_size, bool is_last, unsigned char *out)
{
#ifdef HAVE_LIBDEFLATE
    const size_t whole = is_last && !history_size ? deflate_whole(allocator, level, bytes, size, out) : 0;
    if (whole)
        return whole;
#endif
    z_stream z = {.zalloc = zlib_alloc, .zfree = zlib_free, .opaque = (void *)allocator};
    if (deflateInit2(&z, (int)level, Z_DEFLATED, -15, 8, Z_FILTERED) != Z_OK)
        return 0;
    if (history_size)
        deflateSetDictionary(&z, bytes - history_size, (unsigned)history_size);
    z.next_in = (unsigned char *)bytes;
    z.avail_in = (unsigned)size;
    z.next_out = out;
    z.avail_out = (unsigned)deflate_bound(size);
    deflate(&z, is_last ? Z_FINISH : Z_SYNC_FLUSH);
    size_t used = z.total_out;
    deflateEnd(&z);
    return used;
}

void zlib_begin(unsigned char out[2])
{
    out[0] = 0x78; /* deflate, window of 32 KiB */
    out[1] = 0x5e; /* makes both a multiple of 31 */
}

uint32_t zlib_checksum(const unsigned char *bytes, size_t size)
{
#ifdef HAVE_LIBDEFLATE
    return libdeflate_adler32(1, bytes, size); /* 1 for NULL */
#else
    return bytes ? (uint32_t)adler32_z(1, bytes, size) : 1;
#endif
}

uint32_t zlib_checksum_join(uint32_t first, uint32_t second, size_t second_size)
{
    return (uint32_t)adler32_combine(first, second, (z_off_t)second_size);
}

uint32_t crc32_checksum(const unsigned char *bytes, size_t size)
{
#ifdef HAVE_LIBDEFLATE
    return libdeflate_crc32(0, bytes, size);
#else
    return (uint32_t)crc32_z(0, bytes, size);
#endif
}
