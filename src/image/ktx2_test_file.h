/* ktx2_test_file.h - KTX2 files made in memory, for tests and benchmarks: header, levels, descriptor and
 * metadata as a spec has them, right or wrong. */
#ifndef IMAGE_KTX2_TEST_FILE_H
#define IMAGE_KTX2_TEST_FILE_H

#include <stdlib.h>
#include <string.h>

#include "image/codec.h"

enum { TEST_MAX_LEVELS = 16, TEST_DFD_SIZE = 44, TEST_KVD_SIZE = 64 };

typedef struct ktx2_test_file {
    uint32_t vk_format, width, height, depth, layers, faces, levels, scheme;
    unsigned char model, transfer, channel, flags; /* of the format descriptor */
    const char *key, *value;                       /* metadata; NULL: none */
    const unsigned char *bytes[TEST_MAX_LEVELS];   /* of each level, as they are in the file */
    size_t sizes[TEST_MAX_LEVELS];
    size_t whole_sizes[TEST_MAX_LEVELS]; /* without compression; 0: the same */
} ktx2_test_file;

static inline void store_u64_le(unsigned char *p, uint64_t x)
{
    store_u32_le(p, (uint32_t)x);
    store_u32_le(p + 4, (uint32_t)(x >> 32));
}

/* Released with free(). */
static inline unsigned char *ktx2_test_write(const ktx2_test_file *f, size_t *size)
{
    const uint32_t levels = f->levels ? f->levels : 1;
    const size_t dfd = 80 + 24 * (size_t)levels, kvd = dfd + TEST_DFD_SIZE, first = kvd + TEST_KVD_SIZE;
    *size = first;
    for (uint32_t i = 0; i < levels; i++)
        *size += f->sizes[i];
    unsigned char *b = calloc(*size, 1);
    if (!b)
        abort();
    memcpy(b, "\xabKTX 20\xbb\r\n\x1a\n", 12);
    const uint32_t words[] = {
        f->vk_format, 1,         f->width,  f->height,     f->depth,      f->layers,
        f->faces,     f->levels, f->scheme, (uint32_t)dfd, TEST_DFD_SIZE, (uint32_t)kvd};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        store_u32_le(b + 12 + 4 * i, words[i]);
    const unsigned char descriptor[16] = {TEST_DFD_SIZE, 0, 0,           0,       0, 0, 0, 0, 2, 0, 40, 0,
                                          f->model,      1, f->transfer, f->flags};
    memcpy(b + dfd, descriptor, sizeof descriptor);
    b[dfd + 31] = f->channel;
    if (f->key) {
        const size_t length = strlen(f->key) + 1 + strlen(f->value) + 1;
        store_u32_le(b + 60, (uint32_t)(4 + (length + 3) / 4 * 4));
        store_u32_le(b + kvd, (uint32_t)length);
        memcpy(b + kvd + 4, f->key, strlen(f->key) + 1);
        memcpy(b + kvd + 4 + strlen(f->key) + 1, f->value, strlen(f->value) + 1);
    }
    size_t at = first;
    for (uint32_t i = 0; i < levels; i++) {
        unsigned char *record = b + 80 + 24 * (size_t)i;
        store_u64_le(record, at);
        store_u64_le(record + 8, f->sizes[i]);
        store_u64_le(record + 16, f->whole_sizes[i] ? f->whole_sizes[i] : f->sizes[i]);
        memcpy(b + at, f->bytes[i], f->sizes[i]);
        at += f->sizes[i];
    }
    return b;
}

#endif
