/* exr_channels_test.c - values and texts written into OpenEXR files come back bit for bit, or not at all. */
#include "image/image_test.h"
#include "tests/support/support.h"

#include <math.h>

enum { WIDTH = 37, HEIGHT = 21, CHANNELS = 5, COUNT = WIDTH * HEIGHT * CHANNELS };

static const char *const names[CHANNELS] = {"R", "G", "B", "A", "state.low"};
static float values[COUNT];

/* Every kind of float. */
static int make_values(void **state)
{
    (void)state;
    static const float odd[] = {0.0f,      -0.0f, 1e-45f,        -1e-39f,    INFINITY,
                                -INFINITY, NAN,   3.4028235e38f, 16777216.0f};
    uint32_t bits = 1;
    for (size_t i = 0; i < COUNT; i++) {
        lcg_next(&bits);
        uint32_t finite = (bits & 0x7f800000u) == 0x7f800000u ? bits & 0xbfffffffu : bits;
        memcpy(&values[i], &finite, sizeof finite);
        if (i % CHANNELS == 3)
            values[i] = 0.5f; /* compressible */
        else if (i % 11 == 0)
            values[i] = odd[i / 11 % (sizeof odd / sizeof *odd)];
    }
    return 0;
}

static unsigned char *encode(bool is_stored, bool as_half, size_t *size)
{
    const image_text texts[] = {{"first", "one"}, {"second", ""}};
    image_layer layer = {names, CHANNELS, values, WIDTH * CHANNELS * sizeof(float), false, false};
    unsigned char *bytes;
    facet_error error;
    if (image_encode_exr(WIDTH, HEIGHT, &layer, 1, as_half,
                         &(image_encode_desc){.is_stored = is_stored, .texts = texts, .text_count = 2},
                         &bytes, size, &error) != FACET_OK)
        fail_msg("%s", error.message);
    return bytes;
}

/* Reads the channels into texels of one float more, in another order. */
enum { ROOM = CHANNELS + 1 };
static facet_result read(const void *bytes, size_t size, const facet_allocator *allocator, float *to,
                         facet_error *error)
{
    image_channel channels[CHANNELS];
    for (size_t c = 0; c < CHANNELS; c++)
        channels[CHANNELS - 1 - c] = (image_channel){.name = names[c],
                                                     .first = to + c,
                                                     .texel_stride_bytes = ROOM * sizeof(float),
                                                     .row_stride_bytes = WIDTH * ROOM * sizeof(float)};
    return image_read_exr_channels(bytes, size, "p", allocator, WIDTH, HEIGHT, channels, CHANNELS, error);
}

static bool is_same(const float *read_back)
{
    for (size_t t = 0; t < WIDTH * HEIGHT; t++)
        if (memcmp(read_back + t * ROOM, values + t * CHANNELS, CHANNELS * sizeof(float)) != 0 ||
            read_back[t * ROOM + CHANNELS] != 7.0f) /* the bytes in between are unchanged */
            return false;
    return true;
}

static float *make_room(void)
{
    float *room = malloc(WIDTH * HEIGHT * ROOM * sizeof *room);
    for (size_t i = 0; i < WIDTH * HEIGHT * ROOM; i++)
        room[i] = 7.0f;
    return room;
}

static void channels_come_back_bit_for_bit(void **state)
{
    (void)state;
    for (int is_stored = 0; is_stored < 2; is_stored++) {
        size_t size;
        unsigned char *bytes = encode(is_stored, false, &size);
        assert_int_equal(size > COUNT * sizeof(float), is_stored);
        float *back = make_room();
        facet_error error;
        if (read(bytes, size, NULL, back, &error) != FACET_OK)
            fail_msg("%s", error.message);
        assert_true(is_same(back));
        char text[4];
        assert_int_equal(image_read_exr_text(bytes, size, "p", "first", text, sizeof text, NULL), FACET_OK);
        assert_string_equal(text, "one");
        assert_int_equal(image_read_exr_text(bytes, size, "p", "second", text, sizeof text, NULL), FACET_OK);
        assert_string_equal(text, "");
        /* and it is an image */
        image header;
        assert_int_equal(image_probe(bytes, size, "p", &header, NULL, NULL), FACET_OK);
        assert_true(header.width == WIDTH && header.height == HEIGHT && header.channel_count == 4);
        mem_free(bytes);
        free(back);
    }
}

static void expect_refusal(facet_result result, const facet_error *error, const char *sentence)
{
    assert_int_equal(result, FACET_ERROR_INVALID);
    assert_string_equal(error->message, sentence);
}

static void missing_channels_and_texts_are_errors(void **state)
{
    (void)state;
    size_t size;
    unsigned char *bytes = encode(true, false, &size);
    static float to[WIDTH * HEIGHT];
    image_channel channel = {"state.high", to, false, sizeof(float), WIDTH * sizeof(float)};
    facet_error error;
    facet_result result = image_read_exr_channels(bytes, size, "p", NULL, WIDTH, HEIGHT, &channel, 1, &error);
    expect_refusal(result, &error, "p: OpenEXR: channel state.high is missing");
    channel.name = "A";
    result = image_read_exr_channels(bytes, size, "p", NULL, WIDTH, HEIGHT + 1, &channel, 1, &error);
    expect_refusal(result, &error, "p: OpenEXR: the image has 37 x 21 texels, not 37 x 22");
    char text[3];
    result = image_read_exr_text(bytes, size, "p", "third", text, sizeof text, &error);
    expect_refusal(result, &error, "p: OpenEXR: the text third is missing");
    result = image_read_exr_text(bytes, size, "p", "first", text, sizeof text, &error);
    expect_refusal(result, &error, "p: OpenEXR: the text first is too long");
    result = image_read_exr_text(bytes, size, "p", "compression", text, sizeof text, &error);
    expect_refusal(result, &error, "p: OpenEXR: the text compression is missing"); /* no text */
    mem_free(bytes);
    bytes = encode(true, true, &size);
    result = image_read_exr_channels(bytes, size, "p", NULL, WIDTH, HEIGHT, &channel, 1, &error);
    expect_refusal(result, &error, "p: OpenEXR: channel A does not hold floats");
    mem_free(bytes);
    result = image_read_exr_channels("GIF89a, and more", 16, "p", NULL, WIDTH, HEIGHT, &channel, 1, &error);
    expect_refusal(result, &error, "p: an OpenEXR file was expected");
    result = image_read_exr_text("", 0, "p", "first", text, sizeof text, &error);
    expect_refusal(result, &error, "p: an OpenEXR file was expected");
}

/* Truncated files are refused; changed bytes do no harm. */
static void damaged_files_do_no_harm(void **state)
{
    (void)state;
    for (int is_stored = 0; is_stored < 2; is_stored++) {
        size_t size;
        unsigned char *bytes = encode(is_stored, false, &size);
        float *back = make_room();
        char text[16];
        facet_error error;
        for (size_t cut = 0; cut < size; cut += cut < 700 || cut > size - 100 ? 1 : 61) {
            unsigned char *copy = malloc(cut + 1); /* to its exact end, for the sanitizer */
            memcpy(copy, bytes, cut);
            copy[cut] = 0;
            assert_int_equal(read(copy, cut, NULL, back, &error), FACET_ERROR_INVALID);
            assert_int_equal(strncmp(error.message, "p: ", 3), 0);
            image_read_exr_text(copy, cut, "p", "first", text, sizeof text, &error);
            free(copy);
        }
        uint32_t random = 9;
        for (int k = 0; k < 3000; k++) {
            lcg_next(&random);
            size_t at = k < 1200 ? (size_t)k % 600 : (random >> 4) % size;
            unsigned char kept = bytes[at];
            bytes[at] = (unsigned char)(k < 600 ? 0xff : random >> 24);
            if (read(bytes, size, NULL, back, &error) != FACET_OK)
                assert_true(error.message[0] == 'p');
            image_read_exr_text(bytes, size, "p", "second", text, sizeof text, &error);
            bytes[at] = kept;
        }
        mem_free(bytes);
        free(back);
    }
}

static void running_out_of_memory_leaks_nothing(void **state)
{
    (void)state;
    size_t size;
    unsigned char *bytes = encode(true, false, &size);
    float *back = make_room();
    failing_allocator how = {.fail_at = 0};
    facet_allocator allocator = failing_allocator_get(&how);
    assert_int_equal(read(bytes, size, &allocator, back, NULL), FACET_ERROR_MEMORY);
    how.fail_at = -1;
    assert_int_equal(read(bytes, size, &allocator, back, NULL), FACET_OK);
    assert_int_equal(how.blocks, 0);
    assert_true(is_same(back));
    mem_free(bytes);
    free(back);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(channels_come_back_bit_for_bit),
        cmocka_unit_test(missing_channels_and_texts_are_errors),
        cmocka_unit_test(damaged_files_do_no_harm),
        cmocka_unit_test(running_out_of_memory_leaks_nothing),
    };
    return cmocka_run_group_tests(tests, make_values, NULL);
}
