/* damage_test.c - requirements on all decoders: truncated and changed files do no harm, failing
 * allocations are errors, nothing leaks. Most useful under the address sanitizer. */
#include "image/image_test.h"
#include "tests/support/support.h"

/* Small files of every codec. */
typedef struct sample {
    char name[40];
    unsigned char *bytes;
    size_t size;
} sample;

static sample samples[40];
static size_t sample_count;

static void add_sample(const char *name, unsigned char *bytes, size_t size)
{
    assert_true(sample_count < sizeof samples / sizeof *samples);
    sample *s = &samples[sample_count++];
    snprintf(s->name, sizeof s->name, "%s", name);
    s->bytes = bytes;
    s->size = size;
}

static void add_file(const char *folder, const char *name)
{
    char path[256];
    snprintf(path, sizeof path, "%s%s", folder, name);
    file_bytes file = read_file(path);
    unsigned char *copy = mem_alloc(NULL, file.size, 1);
    memcpy(copy, file.data, file.size);
    image header;
    if (image_probe(copy, file.size, name, &header, NULL, NULL) == FACET_ERROR_UNSUPPORTED)
        mem_free(copy); /* this build has no library for it */
    else
        add_sample(name, copy, file.size);
    file_close(&file);
}

static void add_encoded(const char *name, image_codec codec, uint32_t channels, image_type type,
                        uint32_t quality)
{
    image i = make_image(37, 23, channels, type);
    unsigned char *bytes;
    size_t size;
    if (image_encode(&i, codec, &(image_encode_desc){.quality = quality}, &bytes, &size, NULL) == FACET_OK)
        add_sample(name, bytes, size);
    else
        assert_int_equal(codec, IMAGE_CODEC_WEBP);
    image_destroy(&i);
}

static int make_samples(void **state)
{
    (void)state;
    static const char *const files[] = {"none.exr",          "rle.exr",
                                        "zip.exr",           "piz.exr",
                                        "pxr24.exr",         "b44.exr",
                                        "b44a.exr",          "dwaa.exr",
                                        "dwab.exr",          "tiled_mipmap_zip.exr",
                                        "multipart_piz.exr", "window_piz.exr",
                                        "cmyk.jpg",          "progressive.jpg",
                                        "grey.jpg",          "etc1s_alpha.ktx2",
                                        "uastc_zstd.ktx2",   "uastc_modes.ktx2",
                                        "rgba_lossless.avif"};
    for (size_t k = 0; k < sizeof files / sizeof *files; k++)
        add_file(TEST_DATA, files[k]);
    static const char *const textures[] = {"runs.tga",       "mapped_runs.tga", "four_bits.bmp", "rle8.bmp",
                                           "interlaced.gif", "bc3.dds",         "bgra.dds"};
    for (size_t k = 0; k < sizeof textures / sizeof *textures; k++)
        add_file("tests/fuzz/corpus_image/", textures[k]);
    add_encoded("grey.png", IMAGE_CODEC_PNG, 1, IMAGE_U8, 0);
    add_encoded("rgba.png", IMAGE_CODEC_PNG, 4, IMAGE_U8, 0);
    add_encoded("rgb16.png", IMAGE_CODEC_PNG, 3, IMAGE_U16, 0);
    add_encoded("rgb.jpg", IMAGE_CODEC_JPEG, 3, IMAGE_U8, 0);
    add_encoded("lossy.webp", IMAGE_CODEC_WEBP, 4, IMAGE_U8, 50);
    add_encoded("lossless.webp", IMAGE_CODEC_WEBP, 4, IMAGE_U8, 100);
    add_encoded("rgb.hdr", IMAGE_CODEC_HDR, 3, IMAGE_F32, 0);
    add_encoded("rgb.pfm", IMAGE_CODEC_PFM, 3, IMAGE_F32, 0);
    return 0;
}

static int free_samples(void **state)
{
    (void)state;
    for (size_t k = 0; k < sample_count; k++)
        mem_free(samples[k].bytes);
    return 0;
}

/* Probes and decodes a copy without spare bytes behind it. In any case no memory may leak. */
static facet_result try_bytes(const unsigned char *bytes, size_t size, const char *name)
{
    unsigned char *copy = malloc(size ? size : 1);
    memcpy(copy, bytes, size);
    failing_allocator counter = {.fail_at = -1};
    image i, header;
    facet_error error = {0};
    image_decode_desc desc = {.allocator = failing_allocator_get(&counter), .max_size = 2048};
    facet_result probed = image_probe(copy, size, name, &header, NULL, &error);
    facet_result result = image_decode(copy, size, name, &desc, &i, &error);
    if (result == FACET_OK) {
        assert_int_equal(probed, FACET_OK);
        assert_int_equal(header.width, i.width);
        assert_int_equal(header.height, i.height);
        assert_int_equal(header.type, i.type);
        unsigned char *texels = malloc(image_row_size(&i) * i.height); /* all can be read */
        memcpy(texels, i.pixels, image_row_size(&i) * i.height);
        free(texels);
    } else {
        assert_null(i.pixels);
        assert_true(error.message[0] && strncmp(error.message, name, strlen(name)) == 0);
        assert_int_equal(error.result, result);
    }
    image_destroy(&i);
    assert_int_equal(counter.blocks, 0);
    free(copy);
    return result;
}

static void undamaged_files_decode(void **state)
{
    (void)state;
    for (size_t k = 0; k < sample_count; k++)
        if (try_bytes(samples[k].bytes, samples[k].size, samples[k].name) != FACET_OK)
            fail_msg("%s does not decode", samples[k].name);
}

static void truncated_files_do_no_harm(void **state)
{
    (void)state;
    for (size_t k = 0; k < sample_count; k++) {
        const sample *s = &samples[k];
        for (size_t size = 0; size < s->size; size += size < 600 || s->size - size < 20 ? 1 : 37) {
            facet_result result = try_bytes(s->bytes, size, s->name);
            /* half an image is an error; the last bytes of JPEG and PNG files hold no texels */
            if (result == FACET_OK && size < s->size / 2 && !strstr(s->name, "multipart"))
                fail_msg("%s: %zu of %zu bytes were enough", s->name, size, s->size);
        }
    }
}

static void changed_files_do_no_harm(void **state)
{
    (void)state;
    uint32_t random = 20260101;
    for (size_t k = 0; k < sample_count; k++) {
        const sample *s = &samples[k];
        unsigned char *copy = malloc(s->size);
        for (int round = 0; round < 600; round++) {
            memcpy(copy, s->bytes, s->size);
            lcg_next(&random);
            int changes = 1 + (int)(random >> 30);
            for (int c = 0; c < changes; c++) {
                lcg_next(&random);
                /* every second time in the first bytes, where sizes are */
                size_t at = (random >> 8) % (round % 2 && s->size > 400 ? 400 : s->size);
                static const unsigned char odd[] = {0, 0xff, 0x7f, 0x80, 1};
                copy[at] = round % 3 ? (unsigned char)(random >> 3) : odd[random % 5];
            }
            try_bytes(copy, s->size, s->name);
        }
        free(copy);
    }
}

/* Lets the first, second, .. allocation fail until all succeed. */
static void running_out_of_memory_while_reading_is_an_error(void **state)
{
    (void)state;
    for (size_t k = 0; k < sample_count; k++) {
        facet_result result = FACET_ERROR_MEMORY;
        for (long calls = 0; result != FACET_OK && calls < 1000; calls++) {
            failing_allocator f = {.fail_at = calls};
            image i;
            facet_error error = {0};
            image_decode_desc desc = {
                .allocator = failing_allocator_get(&f), .thread_count = 1, .channel_count = 4};
            result = image_decode(samples[k].bytes, samples[k].size, samples[k].name, &desc, &i, &error);
            if (result != FACET_OK && result != FACET_ERROR_MEMORY)
                fail_msg("%s: after %ld allocations: %s", samples[k].name, calls, error.message);
            image_destroy(&i);
            assert_int_equal(f.blocks, 0);
        }
        assert_int_equal(result, FACET_OK);
    }
}

static void running_out_of_memory_while_writing_is_an_error(void **state)
{
    (void)state;
    static const struct {
        image_codec codec;
        uint32_t channels;
        image_type type;
    } cases[] = {{IMAGE_CODEC_PNG, 4, IMAGE_U8},  {IMAGE_CODEC_JPEG, 3, IMAGE_U8},
                 {IMAGE_CODEC_WEBP, 4, IMAGE_U8}, {IMAGE_CODEC_HDR, 3, IMAGE_F32},
                 {IMAGE_CODEC_PFM, 3, IMAGE_F32}, {IMAGE_CODEC_EXR, 3, IMAGE_F32}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        image i = make_image(257, 200, cases[k].channels, cases[k].type);
        facet_result result = FACET_ERROR_MEMORY;
        for (long calls = 0; result == FACET_ERROR_MEMORY && calls < 1000; calls++) {
            failing_allocator f = {.fail_at = calls};
            image_encode_desc desc = {.allocator = failing_allocator_get(&f)};
            unsigned char *bytes;
            size_t size;
            if (cases[k].codec == IMAGE_CODEC_EXR) {
                static const char *const names[] = {"R", "G", "B"};
                image_layer layer = {.channel_names = names,
                                     .channel_count = 3,
                                     .pixels = i.pixels,
                                     .row_stride_bytes = image_row_size(&i)};
                result = image_encode_exr(i.width, i.height, &layer, 1, true, &desc, &bytes, &size, NULL);
            } else {
                result = image_encode(&i, cases[k].codec, &desc, &bytes, &size, NULL);
            }
            assert_true((result == FACET_OK) == (bytes != NULL));
            mem_free(bytes);
            assert_int_equal(f.blocks, 0);
        }
        assert_true(result == FACET_OK || cases[k].codec == IMAGE_CODEC_WEBP ||
                    (cases[k].codec == IMAGE_CODEC_EXR && result == FACET_ERROR_UNSUPPORTED));
        image_destroy(&i);
    }
}

/* A few bytes that claim a huge image are refused before memory is taken for it. */
static void small_files_take_little_memory(void **state)
{
    (void)state;
    for (size_t k = 0; k < sample_count; k++) {
        if (!strstr(samples[k].name, ".png") && !strstr(samples[k].name, "zip.exr") &&
            !strstr(samples[k].name, ".pfm") && !strstr(samples[k].name, ".hdr"))
            continue;
        facet_budget *budget;
        assert_int_equal(facet_budget_create(8 << 20, &budget, NULL), FACET_OK);
        unsigned char *copy = malloc(samples[k].size + 64);
        size_t size = samples[k].size;
        memcpy(copy, samples[k].bytes, size);
        if (strstr(samples[k].name, ".png")) {
            memcpy(copy + 16, "\0\0\x40\0\0\0\x40\0", 8); /* 16384 x 16384; the CRC is wrong, too */
        } else if (strstr(samples[k].name, ".pfm")) {
            size = (size_t)snprintf((char *)copy, 64, "PF\n16384 16384\n-1.0\n");
        } else if (strstr(samples[k].name, ".hdr")) {
            size = (size_t)snprintf((char *)copy, 64, "#?RADIANCE\n\n-Y 16384 +X 16384\n");
        } else {
            for (size_t at = 0; at + 35 < size; at++) /* both windows */
                if (memcmp(copy + at, "box2i", 6) == 0)
                    memcpy(copy + at + 18, "\xff\x3f\0\0\xff\x3f\0\0", 8);
        }
        image i;
        image_decode_desc desc = {.allocator = facet_budget_allocator(budget)};
        facet_error error;
        facet_result result = image_decode(copy, size, samples[k].name, &desc, &i, &error);
        assert_int_equal(result, FACET_ERROR_INVALID);
        free(copy);
        facet_budget_destroy(budget);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(undamaged_files_decode),
        cmocka_unit_test(truncated_files_do_no_harm),
        cmocka_unit_test(changed_files_do_no_harm),
        cmocka_unit_test(running_out_of_memory_while_reading_is_an_error),
        cmocka_unit_test(running_out_of_memory_while_writing_is_an_error),
        cmocka_unit_test(small_files_take_little_memory),
    };
    return cmocka_run_group_tests(tests, make_samples, free_samples);
}
