/* codec_png_test.c - PNG: libspng reads written files back, PngSuite, refusals, independence of threads. */
#define _GNU_SOURCE
#include "image/image_test.h"
#include "tests/support/support.h"

#include <dirent.h>

#include <spng.h>

static void encode(const image *i, uint32_t threads, uint32_t compression, unsigned char **bytes,
                   size_t *size)
{
    facet_error error;
    if (image_encode(i, IMAGE_CODEC_PNG,
                     &(image_encode_desc){.thread_count = threads, .compression = compression}, bytes, size,
                     &error) != FACET_OK)
        fail_msg("%s", error.message);
}

static void comes_back(const image *i, uint32_t compression)
{
    unsigned char *bytes;
    size_t size;
    encode(i, 1, compression, &bytes, &size);
    image header, back;
    image_codec codec;
    facet_error error;
    assert_int_equal(image_probe(bytes, size, "p", &header, &codec, &error), FACET_OK);
    assert_int_equal(codec, IMAGE_CODEC_PNG);
    assert_int_equal(header.channel_count, i->channel_count);
    assert_int_equal(header.type, i->type);
    if (image_decode(bytes, size, "p", NULL, &back, &error) != FACET_OK)
        fail_msg("%s", error.message);
    assert_same_texels(i, &back);
    assert_true(back.is_srgb);
    image_destroy(&back);
    mem_free(bytes);
}

static void all_layouts_come_back(void **state)
{
    (void)state;
    static const uint32_t sizes[][2] = {{1, 1}, {7, 5}, {300, 200}, {1, 400}, {400, 1}, {257, 511}};
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++)
        for (uint32_t channels = 1; channels <= 4; channels++)
            for (int type = IMAGE_U8; type <= IMAGE_U16; type++) {
                image i = make_image(sizes[s][0], sizes[s][1], channels, (image_type)type);
                comes_back(&i, 0);
                image_destroy(&i);
            }
}

static void all_levels_come_back(void **state)
{
    (void)state;
    image i = make_image(301, 257, 4, IMAGE_U8);
    size_t sizes[10];
    for (uint32_t level = 1; level <= 9; level++) {
        comes_back(&i, level);
        unsigned char *bytes;
        encode(&i, 1, level, &bytes, &sizes[level]);
        mem_free(bytes);
    }
    assert_true(sizes[9] < sizes[1]);
    image_destroy(&i);
    i = make_image(1, 1, 3, IMAGE_F32);
    unsigned char *bytes;
    size_t size;
    assert_int_equal(image_encode(&i, IMAGE_CODEC_PNG, NULL, &bytes, &size, NULL), FACET_ERROR_ARGUMENT);
    assert_null(bytes);
    image_destroy(&i);
}

/* Noise does not compress, a flat image to almost nothing. */
static void extremes_come_back(void **state)
{
    (void)state;
    image i = make_image(640, 480, 4, IMAGE_U8);
    uint32_t noise = 7;
    for (uint32_t k = 0; k < 640 * 480 * 4; k++) {
        lcg_next(&noise);
        ((uint8_t *)i.pixels)[k] = (uint8_t)(noise >> 24);
    }
    for (uint32_t level = 1; level <= 9; level += 4)
        comes_back(&i, level);
    memset(i.pixels, 0, 640 * 480 * 4);
    for (uint32_t level = 1; level <= 9; level += 4)
        comes_back(&i, level);
    unsigned char *bytes;
    size_t size;
    encode(&i, 1, 4, &bytes, &size);
    assert_true(size < 8000);
    mem_free(bytes);
    image_destroy(&i);
}

static void bytes_do_not_depend_on_threads(void **state)
{
    (void)state;
    image i = make_image(513, 600, 4, IMAGE_U8);
    unsigned char *one, *three;
    size_t one_size, three_size;
    encode(&i, 1, 4, &one, &one_size);
    encode(&i, 3, 4, &three, &three_size);
    assert_int_equal(one_size, three_size);
    assert_memory_equal(one, three, one_size);
    mem_free(one);
    mem_free(three);
    image_destroy(&i);
}

/* 8 bits with requested channels: alpha from tRNS or 255, grey spread to RGB. */
static void requested_channel_counts_are_decoded(void **state)
{
    (void)state;
    for (uint32_t channels = 1; channels <= 4; channels++)
        for (int type = IMAGE_U8; type <= IMAGE_U16; type++)
            for (uint32_t asked = 3; asked <= 4; asked++) {
                image i = make_image(33, 9, channels, (image_type)type);
                unsigned char *bytes;
                size_t size;
                encode(&i, 1, 4, &bytes, &size);
                image got, expected;
                assert_int_equal(
                    image_decode(bytes, size, "p", &(image_decode_desc){.channel_count = asked}, &got, NULL),
                    FACET_OK);
                assert_int_equal(image_convert(&i, NULL, 1, asked, i.type, true, &expected, NULL), FACET_OK);
                assert_same_texels(&expected, &got);
                image_destroy(&expected);
                image_destroy(&got);
                image_destroy(&i);
                mem_free(bytes);
            }
}

/* Calls visit for each .png of the folder; returns how many there were. */
static int each_png(const char *folder, void (*visit)(const char *path, const char *name))
{
    char path[1024];
    shared_path(path, folder);
    DIR *directory = opendir(path);
    assert_non_null(directory);
    int count = 0;
    for (struct dirent *entry; (entry = readdir(directory));) {
        if (!strstr(entry->d_name, ".png"))
            continue;
        char file[1400];
        snprintf(file, sizeof file, "%s/%s", path, entry->d_name);
        visit(file, entry->d_name);
        count++;
    }
    closedir(directory);
    return count;
}

/* Names of PngSuite: 3 feature, i or n interlaced, then color type (0 2 3 4 6), g c p a, bit depth. */
static void check_suite_file(const char *path, const char *name)
{
    image i = decode_file(path);
    file_bytes file = read_file(path);
    image header;
    assert_int_equal(image_probe(file.data, file.size, name, &header, NULL, NULL), FACET_OK);
    assert_int_equal(header.width, i.width);
    assert_int_equal(header.height, i.height);
    assert_int_equal(header.channel_count, i.channel_count);
    assert_int_equal(header.type, i.type);
    size_t length = strlen(name);
    assert_int_equal(i.type == IMAGE_U16, strcmp(name + length - 6, "16.png") == 0);
    /* the same texels as libspng makes of it in RGBA */
    image rgba;
    assert_int_equal(image_convert(&i, NULL, 1, 4, IMAGE_U8, true, &rgba, NULL), FACET_OK);
    spng_ctx *context = spng_ctx_new(0);
    spng_set_png_buffer(context, file.data, file.size);
    size_t size = (size_t)i.width * i.height * 4;
    unsigned char *expected = malloc(size);
    assert_int_equal(spng_decode_image(context, expected, size, SPNG_FMT_RGBA8, SPNG_DECODE_TRNS), 0);
    for (size_t k = 0; k < size; k++) { /* libspng truncates 16 bits to 8, we round */
        int difference = (int)expected[k] - (int)((uint8_t *)rgba.pixels)[k];
        if (i.type == IMAGE_U8 ? difference != 0 : abs(difference) > 1)
            fail_msg("%s: byte %zu is %d, %d was expected", name, k, ((uint8_t *)rgba.pixels)[k],
                     expected[k]);
    }
    free(expected);
    spng_ctx_free(context);
    image_destroy(&rgba);

    /* basi* are basn* interlaced */
    if (strncmp(name, "basi", 4) == 0) {
        char other_path[1400];
        snprintf(other_path, sizeof other_path, "%s", path);
        other_path[strlen(path) - length + 3] = 'n';
        FILE *other_file = fopen(other_path, "rb");
        if (other_file) {
            fclose(other_file);
            image other = decode_file(other_path);
            assert_same_texels(&i, &other);
            image_destroy(&other);
        }
    }
    file_close(&file);
    image_destroy(&i);
}

static void pngsuite_is_read(void **state)
{
    (void)state;
    assert_true(each_png("images/pngsuite/primary", check_suite_file) > 50);
    assert_true(each_png("images/pngsuite/16bit", check_suite_file) > 3);
}

static void check_refused(const char *path, const char *name)
{
    file_bytes file = read_file(path);
    image i;
    facet_error error;
    assert_int_equal(image_decode(file.data, file.size, name, NULL, &i, &error), FACET_ERROR_INVALID);
    assert_null(i.pixels);
    assert_int_equal(strncmp(error.message, name, strlen(name)), 0);
    file_close(&file);
}

static void corrupt_files_are_refused(void **state)
{
    (void)state;
    assert_true(each_png("malformed/png", check_refused) > 5);
}

/* Every byte of a file is under a CRC or a signature: no change of one may go unnoticed. */
static void every_changed_byte_is_noticed(void **state)
{
    (void)state;
    image i = make_image(12, 9, 3, IMAGE_U8);
    unsigned char *bytes;
    size_t size;
    encode(&i, 1, 4, &bytes, &size);
    for (size_t k = 0; k < size; k++) {
        bytes[k] ^= 0x10;
        image back;
        facet_result result = image_decode(bytes, size, "p", NULL, &back, NULL);
        if (result == FACET_OK)
            fail_msg("byte %zu of %zu changed and nothing noticed", k, size);
        image_destroy(&back);
        bytes[k] ^= 0x10;
    }
    mem_free(bytes);
    image_destroy(&i);
}

/* Ancillary chunks are not read: a text with a wrong CRC and an invalid profile do not refuse an image. */
static void other_chunks_are_skipped(void **state)
{
    (void)state;
    static const unsigned char others[] = "\0\0\0\4tEXt\1\2\3\4wxyz\0\0\0\3iCCPabc\0\0\0\0";
    enum { BEFORE = 8 + 25 /* signature and IHDR */, OTHERS = sizeof others - 1 };
    image i = make_image(12, 9, 3, IMAGE_U8);
    unsigned char *bytes;
    size_t size;
    encode(&i, 1, 4, &bytes, &size);
    unsigned char *longer = malloc(size + OTHERS);
    memcpy(longer, bytes, BEFORE);
    memcpy(longer + BEFORE, others, OTHERS);
    memcpy(longer + BEFORE + OTHERS, bytes + BEFORE, size - BEFORE);
    image back;
    assert_int_equal(image_decode(longer, size + OTHERS, "p", NULL, &back, NULL), FACET_OK);
    assert_same_texels(&i, &back);
    image_destroy(&back);
    longer[BEFORE + 4] = 'T'; /* critical, and unknown */
    assert_int_equal(image_decode(longer, size + OTHERS, "p", NULL, &back, NULL), FACET_ERROR_INVALID);
    free(longer);
    mem_free(bytes);
    image_destroy(&i);
}

/* A text is a chunk before the data, with a checksum that libspng accepts, and changes nothing else. */
static void texts_are_written(void **state)
{
    (void)state;
    unsigned char texels[2 * 3] = {1, 2, 3, 4, 5, 6}, *plain, *bytes;
    const image i = {.width = 2, .height = 1, .channel_count = 3, .type = IMAGE_U8, .pixels = texels};
    const image_text text = {"facet-tag", "0123abcd"};
    size_t plain_size, size;
    assert_int_equal(png_encode(&i, &(image_encode_desc){.compression = 4}, &plain, &plain_size, NULL),
                     FACET_OK);
    assert_int_equal(png_encode(&i, &(image_encode_desc){.compression = 4, .texts = &text, .text_count = 1},
                                &bytes, &size, NULL),
                     FACET_OK);
    const size_t header = 8 + 12 + 13, chunk = 12 + 9 + 1 + 8;
    assert_int_equal(size, plain_size + chunk);
    assert_memory_equal(bytes, plain, header);
    assert_memory_equal(bytes + header,
                        "\0\0\0\22tEXtfacet-tag\0"
                        "0123abcd",
                        chunk - 4);
    assert_memory_equal(bytes + header + chunk, plain + header, plain_size - header);
    mem_free(plain);
    mem_free(bytes);
}

static void size_limits_hold(void **state)
{
    (void)state;
    image i = make_image(40, 20, 3, IMAGE_U8);
    unsigned char *bytes;
    size_t size;
    facet_error error;
    encode(&i, 1, 4, &bytes, &size);
    image back;
    image_decode_desc desc = {.max_size = 39};
    assert_int_equal(image_decode(bytes, size, "p", &desc, &back, &error), FACET_ERROR_LIMIT);
    desc.max_size = 40;
    assert_int_equal(image_decode(bytes, size, "p", &desc, &back, &error), FACET_OK);
    image_destroy(&back);
    desc.channel_count = 2;
    assert_int_equal(image_decode(bytes, size, "p", &desc, &back, &error), FACET_ERROR_ARGUMENT);
    mem_free(bytes);
    image_destroy(&i);
}

/* A sink that assembles its rows, and refuses row fail_at. */
typedef struct gathering {
    image made;
    uint32_t row_count, fail_at;
} gathering;

static facet_result begin_gathering(void *user, const image *header, facet_error *error)
{
    gathering *g = user;
    assert_null(header->pixels);
    assert_int_equal(image_create(NULL, header->width, header->height, header->channel_count, header->type,
                                  &g->made, error),
                     FACET_OK);
    g->made.is_srgb = header->is_srgb;
    return FACET_OK;
}

static facet_result gather_row(void *user, const void *texels, facet_error *error)
{
    gathering *g = user;
    assert_true(g->row_count < g->made.height);
    if (g->row_count == g->fail_at)
        return (void)error, FACET_ERROR_MEMORY;
    const size_t row_size = image_row_size(&g->made);
    memcpy((char *)g->made.pixels + g->row_count++ * row_size, texels, row_size);
    return FACET_OK;
}

static void rows_read_alone_equal_the_whole_image(void **state)
{
    (void)state;
    for (uint32_t channels = 1; channels <= 4; channels++)
        for (int type = IMAGE_U8; type <= IMAGE_U16; type++) {
            image i = make_image(37, 19, channels, (image_type)type);
            unsigned char *bytes;
            size_t size;
            facet_error error;
            encode(&i, 1, 4, &bytes, &size);
            gathering g = {.fail_at = UINT32_MAX};
            const image_row_sink sink = {.user = &g, .begin = begin_gathering, .add_row = gather_row};
            image back;
            assert_int_equal(
                image_decode(bytes, size, "p", &(image_decode_desc){.sink = &sink}, &back, &error), FACET_OK);
            assert_null(back.pixels);
            assert_int_equal(back.height, 19);
            assert_int_equal(g.row_count, 19);
            assert_same_texels(&i, &g.made);
            image_destroy(&g.made);
            g = (gathering){.fail_at = 18};
            assert_int_equal(
                image_decode(bytes, size, "p", &(image_decode_desc){.sink = &sink}, &back, &error),
                FACET_ERROR_MEMORY);
            image_destroy(&g.made);
            bytes[size - 20] ^= 1; /* in the data or its CRC */
            g = (gathering){.fail_at = UINT32_MAX};
            assert_int_equal(
                image_decode(bytes, size, "p", &(image_decode_desc){.sink = &sink}, &back, &error),
                FACET_ERROR_INVALID);
            image_destroy(&g.made);
            mem_free(bytes);
            image_destroy(&i);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_layouts_come_back),
        cmocka_unit_test(all_levels_come_back),
        cmocka_unit_test(extremes_come_back),
        cmocka_unit_test(bytes_do_not_depend_on_threads),
        cmocka_unit_test(requested_channel_counts_are_decoded),
        cmocka_unit_test(pngsuite_is_read),
        cmocka_unit_test(corrupt_files_are_refused),
        cmocka_unit_test(every_changed_byte_is_noticed),
        cmocka_unit_test(other_chunks_are_skipped),
        cmocka_unit_test(texts_are_written),
        cmocka_unit_test(size_limits_hold),
        cmocka_unit_test(rows_read_alone_equal_the_whole_image),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
