/* codec_avif_test.c - AVIF images whose texels are known. */
#include "image/image_test.h"

static void eight_bits_with_alpha(void **state)
{
    (void)state;
    image i = decode_file(TEST_DATA "rgba_lossless.avif");
    assert_int_equal(i.width, 24);
    assert_int_equal(i.height, 17);
    assert_int_equal(i.channel_count, 4);
    assert_int_equal(i.type, IMAGE_U8);
    assert_true(i.is_srgb);
    const uint8_t *texel = i.pixels;
    for (uint32_t y = 0; y < 17; y++)
        for (uint32_t x = 0; x < 24; x++, texel += 4) {
            assert_int_equal(texel[0], 10 * x);
            assert_int_equal(texel[1], 15 * y);
            assert_int_equal(texel[2], 255 - 5 * x - 7 * y);
            assert_int_equal(texel[3], 128 + 5 * x);
        }
    image_destroy(&i);
    i = decode_file_as(TEST_DATA "rgba_lossless.avif",
                       &(image_decode_desc){.channel_count = 3, .thread_count = 2});
    assert_int_equal(i.channel_count, 3);
    assert_int_equal(((const uint8_t *)i.pixels)[3 * 25 + 1], 15);
    image_destroy(&i);
}

static void ten_bits_become_sixteen(void **state)
{
    (void)state;
    image i = decode_file(TEST_DATA "rgb10_lossless.avif");
    assert_int_equal(i.channel_count, 3);
    assert_int_equal(i.type, IMAGE_U16);
    const uint16_t *texel = i.pixels;
    for (uint32_t y = 0; y < 17; y++)
        for (uint32_t x = 0; x < 24; x++, texel += 3) {
            const double codes[3] = {40.0 * x, 60.0 * y, 1023.0 - 20 * x - 30 * y};
            for (int c = 0; c < 3; c++)
                assert_true(abs((int)texel[c] - (int)(codes[c] * 65535 / 1023 + 0.5)) <= 1);
        }
    image_destroy(&i);
}

static void sizes_are_limited(void **state)
{
    (void)state;
    file_bytes file = read_file(TEST_DATA "rgba_lossless.avif");
    image i;
    facet_error error;
    assert_int_equal(
        image_decode(file.data, file.size, "a", &(image_decode_desc){.max_size = 23}, &i, &error),
        FACET_ERROR_LIMIT);
    assert_null(i.pixels);
    assert_int_equal(image_decode(file.data, 40, "a", NULL, &i, &error), FACET_ERROR_INVALID);
    assert_non_null(strstr(error.message, "a: AVIF: "));
    file_close(&file);
}

/* ---- clean aperture, rotation, mirroring ---- */

/* 64 x 32 texels, lossless, its last property: irot, 1. */
static const char *const turned = "tests/cases/23-avif-transforms/irot1.avif";
static const char *const stored = "tests/cases/23-avif-transforms/plain.png";

static unsigned char *find_box(unsigned char *bytes, size_t size, const char *type)
{
    for (size_t i = 4; i + 4 <= size; i++)
        if (memcmp(bytes + i, type, 4) == 0)
            return bytes + i - 4;
    fail_msg("there is no box %s", type);
    return NULL;
}

static void add_to_size(unsigned char *at, uint32_t added)
{
    const uint32_t n = ((uint32_t)at[0] << 24 | (uint32_t)at[1] << 16 | (uint32_t)at[2] << 8 | at[3]) + added;
    for (int i = 0; i < 4; i++)
        at[i] = (unsigned char)(n >> (24 - 8 * i));
}

/* The file with its property irot replaced by one of type with size bytes in it. *out_size: bytes of the
 * result, which is to be freed. */
static unsigned char *with_property(const char *type, const unsigned char *property, uint32_t size,
                                    size_t *out_size)
{
    file_bytes file = read_file(turned);
    unsigned char *bytes = malloc(file.size + size);
    memcpy(bytes, file.data, file.size);
    unsigned char *box = find_box(bytes, file.size, "irot");
    const size_t behind = (size_t)(box - bytes) + 9;
    memcpy(box + 4, type, 4);
    memcpy(box + 8, property, size);
    memcpy(box + 8 + size, file.data + behind, file.size - behind);
    const uint32_t added = size - 1;
    add_to_size(box, added);
    static const char *const parents[] = {"meta", "iprp", "ipco"};
    for (int i = 0; i < 3; i++)
        add_to_size(find_box(bytes, file.size, parents[i]), added);
    add_to_size(find_box(bytes, file.size, "iloc") + 22, added); /* where the texels begin in the file */
    *out_size = file.size + added;
    file_close(&file);
    return bytes;
}

/* Decodes; the texel (x, y) has to be texel (columns[0] + columns[1] x + columns[2] y, rows[..] ..) of the
 * stored image. */
static void expect_places(const unsigned char *bytes, size_t size, uint32_t width, uint32_t height,
                          const int columns[3], const int rows[3], image_note *note)
{
    image i, header, reference = decode_file(stored);
    facet_error error;
    if (image_probe(bytes, size, "a", &header, NULL, &error) != FACET_OK ||
        image_decode(bytes, size, "a", &(image_decode_desc){.note = note}, &i, &error) != FACET_OK)
        fail_msg("%s", error.message);
    assert_int_equal(header.width, width);
    assert_int_equal(header.height, height);
    assert_int_equal(i.width, width);
    assert_int_equal(i.height, height);
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++) {
            const int column = columns[0] + columns[1] * (int)x + columns[2] * (int)y;
            const int row = rows[0] + rows[1] * (int)x + rows[2] * (int)y;
            const uint8_t *expected =
                (const uint8_t *)reference.pixels +
                reference.channel_count * ((uint32_t)row * reference.width + (uint32_t)column);
            assert_memory_equal((const uint8_t *)i.pixels + 3 * ((size_t)y * width + x), expected, 3);
        }
    image_destroy(&i);
    image_destroy(&reference);
}

static void rotations_and_mirrors_are_applied(void **state)
{
    (void)state;
    static const struct {
        const char *type;
        unsigned char value;
        int columns[3], rows[3];
    } cases[] = {{"irot", 0, {0, 1, 0}, {0, 0, 1}},     {"irot", 1, {63, 0, -1}, {0, 1, 0}},
                 {"irot", 2, {63, -1, 0}, {31, 0, -1}}, {"irot", 3, {0, 0, 1}, {31, -1, 0}},
                 {"imir", 0, {0, 1, 0}, {31, 0, -1}},   {"imir", 1, {63, -1, 0}, {0, 0, 1}}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        size_t size;
        unsigned char *bytes = with_property(cases[k].type, &cases[k].value, 1, &size);
        const bool is_lying = cases[k].columns[1] == 0;
        image_note note;
        expect_places(bytes, size, is_lying ? 32 : 64, is_lying ? 64 : 32, cases[k].columns, cases[k].rows,
                      &note);
        assert_int_equal(note.text[0], 0);
        free(bytes);
    }
}

static void put_u32(unsigned char *at, uint32_t value)
{
    for (int i = 0; i < 4; i++)
        at[i] = (unsigned char)(value >> (24 - 8 * i));
}

/* An aperture of 40 x 20 with its centre 4 texels right of and 3 above the middle; one that leaves the
 * image is reported. */
static void clean_apertures_are_cut_out(void **state)
{
    (void)state;
    unsigned char clap[32];
    const uint32_t fractions[8] = {80, 2, 20, 1, 4, 1, (uint32_t)-3, 1};
    for (int i = 0; i < 8; i++)
        put_u32(clap + 4 * i, fractions[i]);
    size_t size;
    image_note note;
    unsigned char *bytes = with_property("clap", clap, sizeof clap, &size);
    expect_places(bytes, size, 40, 20, (const int[]){16, 1, 0}, (const int[]){3, 0, 1}, &note);
    assert_int_equal(note.text[0], 0);
    free(bytes);
    for (uint32_t denominator = 0; denominator < 2; denominator++) { /* 200 texels wide; divided by 0 */
        put_u32(clap, 200);
        put_u32(clap + 4, denominator);
        bytes = with_property("clap", clap, sizeof clap, &size);
        expect_places(bytes, size, 64, 32, (const int[]){0, 1, 0}, (const int[]){0, 0, 1}, &note);
        assert_int_equal(note.level, FACET_LOG_LEVEL_WARNING);
        assert_non_null(strstr(note.text, "clean aperture"));
        free(bytes);
    }
}

/* BT.2020 with constant luminance, which libavif does not convert. */
static void unsupported_matrices_are_named(void **state)
{
    (void)state;
    size_t size;
    unsigned char *bytes = with_property("irot", (const unsigned char[]){0}, 1, &size);
    find_box(bytes, size, "nclx")[13] = 10;
    image i;
    facet_error error;
    assert_int_equal(image_decode(bytes, size, "a", NULL, &i, &error), FACET_ERROR_UNSUPPORTED);
    assert_non_null(strstr(error.message, "matrix coefficients 10 (BT.2020 with constant luminance)"));
    free(bytes);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(eight_bits_with_alpha),       cmocka_unit_test(ten_bits_become_sixteen),
        cmocka_unit_test(sizes_are_limited),           cmocka_unit_test(rotations_and_mirrors_are_applied),
        cmocka_unit_test(clean_apertures_are_cut_out), cmocka_unit_test(unsupported_matrices_are_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
