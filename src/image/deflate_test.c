/* deflate_test.c - pieces that were deflated apart against zlib's inflate. */
#include "image/image_test.h"

#include <zlib.h>

#include "image/deflate.h"
#include "tests/support/support.h"

enum { MOST = 300000 };

static uint32_t next_random(uint32_t *random)
{
    lcg_next(random);
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

/* Pieces with history, joined, are one stream for zlib; one piece is. */
static void concatenated_pieces_are_one_stream(void **state)
{
    (void)state;
    unsigned char *bytes = malloc(MOST);
    unsigned char *out = malloc(MOST);
    for (uint32_t level = 1; level <= 9; level++)
        for (int kind = 0; kind < 5; kind++)
            for (int p = 0; p < 4; p++) {
                const size_t piece = (const size_t[]){40000, 80000, 120000, MOST}[p];
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
                free(packed);
            }
    free(out);
    free(bytes);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(concatenated_pieces_are_one_stream),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
