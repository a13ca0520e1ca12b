/* image_test.h - shared by the tests of this module: files, generated images, attributes of OpenEXR files. */
#ifndef IMAGE_IMAGE_TEST_H
#define IMAGE_IMAGE_TEST_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/file.h"
#include "base/memory.h"
#include "image/codec.h"
#include "tests/support/support.h"

#define TEST_DATA "src/image/testdata/"

/* FACET_TEST_DATA/name into path; skips the test where the folder or the file is not there. */
static inline void shared_path(char path[512], const char *name)
{
    const char *folder = getenv("FACET_TEST_DATA");
    snprintf(path, 512, "%s/%s", folder ? folder : "", name);
    FILE *file = folder ? fopen(path, "rb") : NULL;
    if (!file) {
        print_message("SKIP: %s of FACET_TEST_DATA is not there\n", name);
        skip();
    }
    fclose(file);
}

static inline file_bytes read_file(const char *path)
{
    file_bytes file = {0};
    facet_error error;
    if (file_open(path, 0, NULL, &file, &error) != FACET_OK)
        fail_msg("%s", error.message);
    return file;
}

/* Decodes a file that must decode. */
static inline image decode_file_as(const char *path, const image_decode_desc *desc)
{
    file_bytes file = read_file(path);
    image i;
    facet_error error;
    if (image_decode(file.data, file.size, path, desc, &i, &error) != FACET_OK)
        fail_msg("%s", error.message);
    file_close(&file);
    return i;
}

static inline image decode_file(const char *path)
{
    return decode_file_as(path, NULL);
}

/* An image with smooth and noisy parts, the same in every run. */
static inline image make_image(uint32_t width, uint32_t height, uint32_t channel_count, image_type type)
{
    image i;
    assert_int_equal(image_create(NULL, width, height, channel_count, type, &i, NULL), FACET_OK);
    i.is_srgb = type == IMAGE_U8 || type == IMAGE_U16;
    uint32_t noise = 1;
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++)
            for (uint32_t c = 0; c < channel_count; c++) {
                size_t at = ((size_t)y * width + x) * channel_count + c;
                lcg_next(&noise);
                uint32_t smooth = (x * 3 + y * (c + 1) * 2) % 256;
                uint32_t value = y % 16 < 8 ? smooth : (smooth + (noise >> 28)) % 256;
                if (x < width / 4)
                    value = 40; /* flat */
                if (type == IMAGE_U8)
                    ((uint8_t *)i.pixels)[at] = (uint8_t)value;
                else if (type == IMAGE_U16)
                    ((uint16_t *)i.pixels)[at] = (uint16_t)(value * 257 ^ (noise >> 20 & 0xff));
                else if (type == IMAGE_F32)
                    ((float *)i.pixels)[at] = (float)value / 32.0f + (float)(noise >> 24) * 0.001f;
            }
    return i;
}

static inline void assert_same_texels(const image *a, const image *b)
{
    assert_int_equal(a->width, b->width);
    assert_int_equal(a->height, b->height);
    assert_int_equal(a->channel_count, b->channel_count);
    assert_int_equal(a->type, b->type);
    assert_memory_equal(a->pixels, b->pixels, image_row_size(a) * a->height);
}

/* ---- OpenEXR files with attributes that facet's writer does not write ---- */

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
