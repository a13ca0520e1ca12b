/* exr_test_file.h - OpenEXR files for tests: attributes that the writer does not write, put into its files. */
#ifndef IMAGE_EXR_TEST_FILE_H
#define IMAGE_EXR_TEST_FILE_H

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "image/codec.h"

/* Behind the header of a file of one part: where its table of chunks begins. */
static inline size_t exr_header_end(const unsigned char *bytes)
{
    size_t at = 8;
    while (bytes[at]) { /* name, type, size, value */
        at += strlen((const char *)bytes + at) + 1;
        at += strlen((const char *)bytes + at) + 1;
        at += 4 + load_u32_le(bytes + at);
    }
    return at + 1;
}

/* A file of one part with an attribute more; to be released with free(). */
static inline unsigned char *exr_with_attribute(const unsigned char *bytes, size_t size, uint32_t chunk_count,
                                                const char *name, const char *type, const void *value,
                                                uint32_t value_size, size_t *out_size)
{
    const size_t name_size = strlen(name) + 1, type_size = strlen(type) + 1;
    const size_t added = name_size + type_size + 4 + value_size;
    unsigned char *out = malloc(size + added), *p = out + 8;
    memcpy(out, bytes, 8);
    memcpy(p, name, name_size);
    memcpy(p + name_size, type, type_size);
    store_u32_le(p + name_size + type_size, value_size);
    memcpy(p + name_size + type_size + 4, value, value_size);
    memcpy(p + added, bytes + 8, size - 8);
    unsigned char *offsets = out + exr_header_end(out);
    for (uint32_t i = 0; i < chunk_count; i++) /* small files: below 4 GiB */
        store_u32_le(offsets + 8 * i, load_u32_le(offsets + 8 * i) + (uint32_t)added);
    *out_size = size + added;
    return out;
}

#endif
