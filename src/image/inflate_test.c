/* inflate_test.c - our inflate against zlib's deflate in all its ways, our deflate against zlib's inflate. */
#include "image/image_test.h"

#include <zlib.h>

#include "image/deflate.h"
#include "image/inflate.h"

enum { MOST = 300000 };

static uint32_t next_random(uint32_t *random)
{
    *random = *random * 1664525u + 1013904223u;
    return *random >> 8;
}

/* Kinds of content: zeros, noise, few symbols, text-like with matches near and far, runs. */
static void fill(unsigned char *bytes, size_t size, int kind, uint32_t seed)
{
    uint32_t random = seed;
    for (size_t k = 0; k < size; k++) {
        uint32_t r = next_random(&random);
        switch (kind) {
        case 0:
            bytes[k] = 0;
            break;
        case 1:
            bytes[k] = (unsigned char)r;
            break;
        case 2:
            bytes[k] = (unsigned char)(r % 7 ? 'a' : r >> 8 & 3);
            break;
        case 3:
            if (k > 40 && r % 5 == 0) {
                size_t distance = 1 + (r >> 3) % (k < 33000 ? k : 32768);
                size_t length = 3 + (r >> 5) % 280;
                for (size_t n = 0; n < length && k < size; n++, k++)
                    bytes[k] = bytes[k - distance];
                k--;
            } else {
                bytes[k] = (unsigned char)(r >> 4);
            }
            break;
        default:
            bytes[k] = (unsigned char)(k / (1 + seed % 300));
        }
    }
}

static void check_inflate(const unsigned char *bytes, size_t size, int level, int strategy, int window)
{
    z_stream z = {0};
    assert_int_equal(deflateInit2(&z, level, Z_DEFLATED, window, 9, strategy), Z_OK);
    size_t bound = deflateBound(&z, size) + 64;
    unsigned char *packed = malloc(bound);
    z.next_in = (unsigned char *)bytes;
    z.avail_in = (unsigned)size;
    z.next_out = packed;
    z.avail_out = (unsigned)bound;
    assert_int_equal(deflate(&z, Z_FINISH), Z_STREAM_END);
    size_t packed_size = z.total_out;
    deflateEnd(&z);
    unsigned char *exact = malloc(packed_size); /* sanitizers see one byte too many */
    memcpy(exact, packed, packed_size);
    unsigned char *out = malloc(size ? size : 1);
    assert_true(zlib_inflate(exact, packed_size, out, size));
    assert_memory_equal(out, bytes, size);
    assert_false(zlib_inflate(exact, packed_size - 1, out, size));
    if (size > 0)
        assert_false(zlib_inflate(exact, packed_size, out, size - 1));
    free(exact);
    free(out);
    free(packed);
}

static void what_zlib_packs(void **state)
{
    (void)state;
    unsigned char *bytes = malloc(MOST);
    static const size_t sizes[] = {0, 1, 2, 3, 10, 258, 259, 300, 1000, 32767, 33000, 70000, MOST};
    for (int kind = 0; kind < 5; kind++)
        for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
            fill(bytes, sizes[s], kind, (uint32_t)(s + 1));
            for (int level = 0; level <= 9; level += 3)
                check_inflate(bytes, sizes[s], level, Z_DEFAULT_STRATEGY, 15);
            check_inflate(bytes, sizes[s], 6, Z_FIXED, 15);
            check_inflate(bytes, sizes[s], 6, Z_HUFFMAN_ONLY, 15);
            check_inflate(bytes, sizes[s], 6, Z_RLE, 15);
            check_inflate(bytes, sizes[s], 9, Z_DEFAULT_STRATEGY, 9);
        }
    free(bytes);
}

/* Symbols so unevenly frequent that codes are up to 15 bits long: second tables. */
static void long_codes(void **state)
{
    (void)state;
    unsigned char *bytes = malloc(MOST);
    for (uint32_t seed = 1; seed < 20; seed++) {
        uint32_t random = seed;
        for (size_t k = 0; k < MOST; k++) {
            uint32_t r = next_random(&random);
            bytes[k] =
                (unsigned char)(r ? (uint32_t)__builtin_ctz(r) * 11 + (r >> 20) % (seed < 10 ? 2 : 11) : 255);
        }
        check_inflate(bytes, MOST, 9, seed % 2 ? Z_HUFFMAN_ONLY : Z_DEFAULT_STRATEGY, 15);
    }
    free(bytes);
}

/* Whatever zlib makes of a changed stream, so do we; it may not fault either way. */
static void changed_streams(void **state)
{
    (void)state;
    unsigned char bytes[3000], packed[4000], ours[3000], theirs[3000];
    uint32_t random = 7;
    int accepted = 0;
    for (int round = 0; round < 30000; round++) {
        fill(bytes, sizeof bytes, round % 5, (uint32_t)round);
        uLongf packed_size = sizeof packed;
        compress2(packed, &packed_size, bytes, sizeof bytes, round % 10);
        for (uint32_t changes = next_random(&random) % 4; changes > 0; changes--) {
            size_t range = next_random(&random) % 3 ? (packed_size < 100 ? packed_size : 100) : packed_size;
            packed[next_random(&random) % range] ^= (unsigned char)(1 << next_random(&random) % 8);
        }
        uLongf size = sizeof theirs;
        bool expected = uncompress(theirs, &size, packed, packed_size) == Z_OK && size == sizeof theirs;
        bool got = zlib_inflate(packed, packed_size, ours, sizeof ours);
        assert_int_equal(got, expected);
        if (got)
            assert_memory_equal(ours, theirs, sizeof ours);
        accepted += got;
    }
    assert_true(accepted > 5000);
}

/* Pieces with history, joined, are one stream for zlib. */
static void pieces_join(void **state)
{
    (void)state;
    unsigned char *bytes = malloc(MOST);
    unsigned char *out = malloc(MOST);
    for (uint32_t level = 1; level <= 9; level++)
        for (int kind = 0; kind < 5; kind++)
            for (size_t piece = 40000; piece <= 120000; piece += 40000) {
                fill(bytes, MOST, kind, level);
                unsigned char *packed =
                    malloc(deflate_bound(MOST) + 5 * (MOST / piece + 1) + ZLIB_FRAME + 64);
                zlib_begin(packed);
                size_t size = 2;
                uint32_t checksum = zlib_checksum(NULL, 0);
                for (size_t at = 0; at < MOST; at += piece) {
                    size_t length = MOST - at < piece ? MOST - at : piece;
                    size_t history = at < DEFLATE_WINDOW ? at : DEFLATE_WINDOW;
                    unsigned char *part = malloc(deflate_bound(length));
                    size_t part_size =
                        deflate_piece(NULL, level, bytes + at, length, history, at + length == MOST, part);
                    assert_true(part_size > 0 && part_size <= deflate_bound(length));
                    memcpy(packed + size, part, part_size);
                    size += part_size;
                    free(part);
                    checksum = zlib_checksum_join(checksum, zlib_checksum(bytes + at, length), length);
                }
                for (int b = 0; b < 4; b++)
                    packed[size++] = (unsigned char)(checksum >> (24 - 8 * b));
                uLongf out_size = MOST;
                assert_int_equal(uncompress(out, &out_size, packed, size), Z_OK);
                assert_int_equal(out_size, MOST);
                assert_memory_equal(out, bytes, MOST);
                memset(out, 1, MOST);
                assert_true(zlib_inflate(packed, size, out, MOST));
                assert_memory_equal(out, bytes, MOST);
                free(packed);
            }
    free(out);
    free(bytes);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_zlib_packs),
        cmocka_unit_test(long_codes),
        cmocka_unit_test(changed_streams),
        cmocka_unit_test(pieces_join),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
