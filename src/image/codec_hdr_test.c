/* codec_hdr_test.c - Radiance HDR and PFM: round trips, hand-written files, orientations, damage. */
#define _GNU_SOURCE
#include "image/image_test.h"

#include <float.h>
#include <math.h>

static facet_result decode_text(const char *header, const void *data, size_t data_size, image *out,
                                facet_error *error)
{
    unsigned char bytes[4096];
    size_t length = strlen(header);
    memcpy(bytes, header, length);
    memcpy(bytes + length, data, data_size);
    return image_decode(bytes, length + data_size, "t.hdr", NULL, out, error);
}

/* Decodes a file that must decode. */
static image decoded(const char *header, const void *data, size_t data_size)
{
    image i;
    facet_error error;
    if (decode_text(header, data, data_size, &i, &error) != FACET_OK)
        fail_msg("%s", error.message);
    return i;
}

static const float *texel(const image *i, uint32_t x, uint32_t y)
{
    return (const float *)i->pixels + 3 * ((size_t)y * i->width + x);
}

/* m / 256 2^(e - 128), computed independently. */
static void uncompressed_texels_are_read(void **state)
{
    (void)state;
    const unsigned char data[] = {128, 64, 0, 129, 255, 1, 2, 0};
    image i = decoded("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n", data, sizeof data);
    const float *p = i.pixels;
    assert_true(p[0] == 1.0f && p[1] == 0.5f && p[2] == 0.0f);
    assert_true(p[3] == 0.0f && p[4] == 0.0f && p[5] == 0.0f); /* e = 0 is black */
    assert_false(i.is_srgb);
    image_destroy(&i);
}

static void exposure_is_divided_out(void **state)
{
    (void)state;
    const unsigned char data[] = {128, 64, 32, 129};
    image i = decoded("#?RGBE\n# comment\nEXPOSURE=2.0\nEXPOSURE= 4\r\nGAMMA=1\n\n-Y 1 +X 1\n", data, 4);
    assert_true(((float *)i.pixels)[0] == 1.0f / 8.0f);
    image_destroy(&i);
    i = decoded("#?RGBE\nEXPOSURE=2.0\nEXPOSURE=4e-1\n\n-Y 1 +X 1\n", data, 4);
    assert_float_equal(((float *)i.pixels)[0], 1.0f / 0.8f, 1e-6f);
    image_destroy(&i);
    facet_error error;
    assert_int_equal(decode_text("#?RGBE\nEXPOSURE=0\n\n-Y 1 +X 1\n", data, 4, &i, &error),
                     FACET_ERROR_INVALID);
    assert_int_equal(decode_text("#?RGBE\nEXPOSURE=x\n\n-Y 1 +X 1\n", data, 4, &i, &error),
                     FACET_ERROR_INVALID);
    assert_int_equal(decode_text("#?RGBE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n", data, 4, &i, &error),
                     FACET_ERROR_UNSUPPORTED);
}

/* COLORCORR divides each channel, beside EXPOSURE. */
static void color_correction_is_divided_out(void **state)
{
    (void)state;
    const unsigned char data[] = {128, 128, 128, 129};
    image i = decoded("#?RADIANCE\nCOLORCORR=2 1 0.5\nEXPOSURE=2\n\n-Y 1 +X 1\n", data, 4);
    assert_memory_equal(i.pixels, ((float[]){0.25f, 0.5f, 1.0f}), 12);
    image_destroy(&i);
    facet_error error;
    assert_int_equal(decode_text("#?RADIANCE\nCOLORCORR=2 1\n\n-Y 1 +X 1\n", data, 4, &i, &error),
                     FACET_ERROR_INVALID);
    assert_non_null(strstr(error.message, "COLORCORR=2 1: three positive numbers"));
}

/* XYZ by IEC 61966-2-1's matrix; invalid primaries are a warning, and the values are kept; zeros are none. */
static void primaries_are_converted(void **state)
{
    (void)state;
    enum { NO_NOTE = -1 };
    static const struct {
        const char *line;
        float expected[3];
        int level; /* of the note */
    } cases[] = {{"1 0 0 1 0 0 .3333 .3333",
                  {3.2406f - 0.7686f - 0.1247f, -0.9689f + 0.9379f + 0.0104f, 0.0557f - 0.1020f + 0.2643f},
                  FACET_LOG_LEVEL_DETAIL},
                 {"0 0 0 0 0 0 .3333 .3333", {1, 0.5f, 0.25f}, FACET_LOG_LEVEL_WARNING},
                 {"0.0 0 0 0 0 0 0 0", {1, 0.5f, 0.25f}, NO_NOTE},
                 {".64 .33 .3 .6", {1, 0.5f, 0.25f}, FACET_LOG_LEVEL_WARNING}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char file[128];
        const int header =
            snprintf(file, sizeof file, "#?RADIANCE\nPRIMARIES= %s\n\n-Y 1 +X 1\n", cases[k].line);
        memcpy(file + header, ((unsigned char[]){128, 64, 32, 129}), 4);
        image i;
        image_note note;
        assert_int_equal(
            image_decode(file, (size_t)header + 4, "p.hdr", &(image_decode_desc){.note = &note}, &i, NULL),
            FACET_OK);
        for (int c = 0; c < 3; c++)
            assert_float_equal(((float *)i.pixels)[c], cases[k].expected[c], 1e-3f);
        assert_int_equal(note.text[0] ? (int)note.level : NO_NOTE, cases[k].level);
        image_destroy(&i);
    }
}

/* Files of exactly four bytes per texel are uncompressed although bytes look like runs or like a coded
 * scanline; coded scanlines of that length stay coded. */
static void uncompressed_texels_are_not_taken_for_runs(void **state)
{
    (void)state;
    unsigned char data[4 * 16];
    for (int t = 0; t < 16; t++)
        memcpy(data + 4 * t, ((unsigned char[]){1, 1, 1, 128}), 4);
    memcpy(data + 4 * 8, ((unsigned char[]){2, 2, 0, 8}), 4);
    image i = decoded("#?RADIANCE\n\n-Y 2 +X 8\n", data, sizeof data);
    for (uint32_t t = 0; t < 16; t++)
        assert_true(texel(&i, t, 0)[1] == (t == 8 ? 2.0f * 0x1p-128f : 1.0f / 256.0f));
    image_destroy(&i);
    /* 4 bytes, literals of 8 twice, a run of 8, four runs of 2 */
    const unsigned char coded[] = {2, 2, 0, 8, 8, 1, 2,   3,   4,   5,   6,   7,   8,   8,   1,   2,
                                   3, 4, 5, 6, 7, 8, 136, 200, 130, 136, 130, 136, 130, 136, 130, 136};
    i = decoded("#?RADIANCE\n\n-Y 1 +X 8\n", coded, sizeof coded);
    for (uint32_t t = 0; t < 8; t++)
        assert_true(texel(&i, t, 0)[0] == (float)(t + 1) && texel(&i, t, 0)[2] == 200.0f);
    image_destroy(&i);
}

/* (1, 1, 1, n) repeats; a second one counts 256 times as much. */
static void old_run_length_encoding_is_read(void **state)
{
    (void)state;
    unsigned char data[] = {128, 128, 128, 129, 1, 1, 1, 4, 1, 1, 1, 1, 200, 0, 0, 129};
    image i = decoded("#?RADIANCE\n\n-Y 1 +X 262\n", data, sizeof data);
    for (uint32_t x = 0; x < 261; x++)
        assert_true(texel(&i, x, 0)[1] == 1.0f);
    assert_true(texel(&i, 261, 0)[0] == 200.0f / 128.0f);
    image_destroy(&i);
    facet_error error;
    assert_int_equal(decode_text("#?RADIANCE\n\n-Y 1 +X 260\n", data, sizeof data, &i, &error),
                     FACET_ERROR_INVALID);
    assert_int_equal(decode_text("#?RADIANCE\n\n-Y 1 +X 4\n", data + 4, 12, &i, &error), FACET_ERROR_INVALID);
}

/* A run and literals in each component. */
static void new_run_length_encoding_is_read(void **state)
{
    (void)state;
    const unsigned char data[] = {2, 2, 0, 8,   136, 100, 8, 1, 2, 3, 4,   5,
                                  6, 7, 8, 132, 9,   4,   1, 2, 3, 4, 136, 130};
    image i = decoded("#?RADIANCE\n\n-Y 1 +X 8\n", data, sizeof data);
    for (uint32_t x = 0; x < 8; x++) {
        assert_true(texel(&i, x, 0)[0] == 100.0f / 64.0f);
        assert_true(texel(&i, x, 0)[1] == ((float)x + 1.0f) / 64.0f);
        assert_true(texel(&i, x, 0)[2] == (x < 4 ? 9.0f : (float)x - 3.0f) / 64.0f);
    }
    image_destroy(&i);
    facet_error error;
    for (size_t size = 0; size < sizeof data; size++)
        assert_int_equal(decode_text("#?RADIANCE\n\n-Y 1 +X 8\n", data, size, &i, &error),
                         FACET_ERROR_INVALID);
}

/* The eight orientations of an image of 2 x 3 texels are one image. */
static void all_orientations_are_read(void **state)
{
    (void)state;
    static const char *const lines[] = {"-Y 3 +X 2", "-Y 3 -X 2", "+Y 3 +X 2", "+Y 3 -X 2",
                                        "+X 2 -Y 3", "-X 2 -Y 3", "+X 2 +Y 3", "-X 2 +Y 3"};
    for (int k = 0; k < 8; k++) {
        unsigned char data[24];
        const bool is_x_first = lines[k][1] == 'X';
        const bool is_x_falling = lines[k][is_x_first ? 0 : 5] == '-';
        const bool is_y_up = lines[k][is_x_first ? 5 : 0] == '+';
        for (uint32_t n = 0; n < 6; n++) {
            uint32_t x = is_x_first ? n / 3 : n % 2;
            uint32_t y = is_x_first ? n % 3 : n / 2;
            x = is_x_falling ? 1 - x : x;
            y = is_y_up ? 2 - y : y;
            memcpy(data + 4 * n, ((unsigned char[]){(unsigned char)(128 + 10 * y + x), 0, 0, 136}), 4);
        }
        char header[64];
        snprintf(header, sizeof header, "#?RADIANCE\n\n%s\n", lines[k]);
        image i = decoded(header, data, sizeof data);
        assert_int_equal(i.width, 2);
        assert_int_equal(i.height, 3);
        for (uint32_t y = 0; y < 3; y++)
            for (uint32_t x = 0; x < 2; x++)
                assert_true(texel(&i, x, y)[0] == 128.0f + 10.0f * (float)y + (float)x);
        image_destroy(&i);
    }
}

static void headers_are_checked(void **state)
{
    (void)state;
    static const char *const bad[] = {
        "#?RADIANCE\n",
        "#?RADIANCE\n\n",
        "#?RADIANCE\n\n-Y 1\n",
        "#?RADIANCE\n\n-Y 1 -Y 1\n",
        "#?RADIANCE\n\n-Y 0 +X 1\n",
        "#?RADIANCE\n\n-Y -1 +X 1\n",
        "#?RADIANCE\n\n-Y 1 +X 99999999999999\n",
        "#?RADIANCE\n\n-Y 1 +X 1x\n",
        "#?RADIANCE\n\n-Y 1 +X 1 3\n",
    };
    const unsigned char data[] = {1, 2, 3, 4};
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        image i;
        facet_error error;
        assert_int_equal(decode_text(bad[k], data, 4, &i, &error), FACET_ERROR_INVALID);
        assert_int_equal(strncmp(error.message, "t.hdr: ", 7), 0);
    }
}

static image through(const image *i, image_codec codec)
{
    unsigned char *bytes;
    size_t size;
    facet_error error;
    image back, header;
    if (image_encode(i, codec, NULL, &bytes, &size, &error) != FACET_OK)
        fail_msg("%s", error.message);
    assert_int_equal(image_probe(bytes, size, "p", &header, NULL, &error), FACET_OK);
    assert_int_equal(header.width, i->width);
    assert_int_equal(header.height, i->height);
    if (image_decode(bytes, size, "p", &(image_decode_desc){.thread_count = 3}, &back, &error) != FACET_OK)
        fail_msg("%s", error.message);
    mem_free(bytes);
    return back;
}

/* A unit of the mantissa is 2^-7 to 2^-8 of the largest component, 1 / 127.75 where that rounds up to the
 * next exponent; texels come back within half of it, without a bias, and a second time unchanged. */
static void hdr_round_trip(void **state)
{
    (void)state;
    static const uint32_t widths[] = {1, 7, 8, 127, 128, 129, 1000, 33000};
    for (size_t k = 0; k < sizeof widths / sizeof *widths; k++) {
        image i = make_image(widths[k], 5, 3, IMAGE_F32);
        image_decode_desc desc = {.max_size = 40000};
        unsigned char *bytes;
        size_t size;
        image back, again;
        double bias = 0.0; /* of components, in units of the largest of their texel */
        assert_int_equal(image_encode(&i, IMAGE_CODEC_HDR, NULL, &bytes, &size, NULL), FACET_OK);
        assert_int_equal(image_decode(bytes, size, "p", &desc, &back, NULL), FACET_OK);
        mem_free(bytes);
        for (size_t t = 0; t < (size_t)widths[k] * 5; t++) {
            const float *a = (const float *)i.pixels + 3 * t;
            const float *b = (const float *)back.pixels + 3 * t;
            float largest = fmaxf(a[0], fmaxf(a[1], a[2]));
            for (int c = 0; c < 3; c++)
                assert_true(fabsf(a[c] - b[c]) <= largest / 255.5f);
            for (int c = 0; c < 3 && largest > 0.0f; c++)
                bias += (double)((b[c] - a[c]) / largest);
        }
        if (widths[k] >= 1000)
            if (fabs(bias / (15.0 * widths[k])) > 2e-4)
                fail_msg("bias %g", bias / (15.0 * widths[k]));
        assert_int_equal(image_encode(&back, IMAGE_CODEC_HDR, NULL, &bytes, &size, NULL), FACET_OK);
        assert_int_equal(image_decode(bytes, size, "p", &desc, &again, NULL), FACET_OK);
        assert_same_texels(&back, &again);
        mem_free(bytes);
        image_destroy(&back);
        image_destroy(&again);
        image_destroy(&i);
    }
}

static void hdr_writes_extremes(void **state)
{
    (void)state;
    float values[] = {NAN,    -1.0f,  0.5f, INFINITY, 1.0f, 0.0f, FLT_MAX,  1e38f, 0.0f,
                      1e-40f, 1e-33f, 0.0f, 1e-30f,   0.0f, 0.0f, 65504.0f, 1.0f,  1e5f};
    image i = {values, 6, 1, 3, IMAGE_F32, false};
    image back = through(&i, IMAGE_CODEC_HDR);
    const float *p = back.pixels;
    assert_true(p[0] < 0.01f && p[1] < 0.01f && fabsf(p[2] - 0.5f) < 0.01f);
    assert_true(p[3] > 1e38f && isfinite(p[3]));
    assert_true(p[6] > 1e38f && isfinite(p[6]) && fabsf(p[7] - 1e38f) < 1e36f);
    assert_true(p[9] == 0.0f && p[10] == 0.0f);
    assert_float_equal(p[12] / 1e-30f, 1.0f, 0.01f);
    assert_float_equal(p[17] / 1e5f, 1.0f, 0.01f);
    image_destroy(&back);
}

static void real_environments_are_read(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        double largest; /* luminance, as README.md of the data has it */
    } files[] = {{"env/qwantani_afternoon_puresky_1k.hdr", 1.06e5},
                 {"env/leadenhall_market_1k.hdr", 242.0},
                 {"env/neutral.hdr", 74.0},
                 {"env/royal_esplanade_1k.hdr", 4.1e4},
                 {"env/studio_small_03_1k.hdr", 3.3e3}};
    for (size_t k = 0; k < sizeof files / sizeof *files; k++) {
        char path[512];
        shared_path(path, files[k].name);
        image one = decode_file(path);
        image four = decode_file_as(path, &(image_decode_desc){.thread_count = 4});
        assert_same_texels(&one, &four);
        assert_int_equal(one.width, 1024);
        assert_int_equal(one.height, 512);
        double largest = 0.0;
        for (size_t t = 0; t < 1024 * 512; t++) {
            const float *p = (const float *)one.pixels + 3 * t;
            largest = fmax(largest, 0.2126 * (double)p[0] + 0.7152 * (double)p[1] + 0.0722 * (double)p[2]);
        }
        if (fabs(largest / files[k].largest - 1.0) > 0.02)
            fail_msg("%s: %g, %g was expected", files[k].name, largest, files[k].largest);
        image_destroy(&one);
        image_destroy(&four);
    }
}

/* expect.json: one "name": "load", "refuse" or "either" per line. */
static void damaged_files_do_no_harm(void **state)
{
    (void)state;
    char path[512];
    shared_path(path, "malformed/hdr/expect.json");
    file_bytes list = read_file(path);
    int count = 0;
    char line[256];
    FILE *file = fmemopen((void *)list.data, list.size, "r");
    while (fgets(line, sizeof line, file)) {
        char name[64], what[16];
        if (sscanf(line, " \"%63[^\"]\": \"%15[^\"]\"", name, what) != 2)
            continue;
        char relative[128];
        snprintf(relative, sizeof relative, "malformed/hdr/%s", name);
        shared_path(path, relative);
        file_bytes bytes = read_file(path);
        image i;
        facet_error error;
        facet_result result = image_decode(bytes.data, bytes.size, name, NULL, &i, &error);
        if (strcmp(what, "load") == 0 && result != FACET_OK)
            fail_msg("%s", error.message);
        if (strcmp(what, "refuse") == 0 && result == FACET_OK)
            fail_msg("%s was not refused", name);
        if (result != FACET_OK)
            assert_null(i.pixels);
        image_destroy(&i);
        file_close(&bytes);
        count++;
    }
    fclose(file);
    file_close(&list);
    assert_int_equal(count, 10);
}

/* The exposure of 2 halves the same texels. */
static void exposure_lines_of_a_file_are_divided_out(void **state)
{
    (void)state;
    char path[512];
    shared_path(path, "malformed/hdr/ok_rle.hdr");
    image plain = decode_file(path);
    shared_path(path, "malformed/hdr/ok_exposure_lines.hdr");
    image exposed = decode_file(path);
    shared_path(path, "malformed/hdr/ok_flat.hdr");
    image flat = decode_file(path);
    assert_same_texels(&plain, &flat);
    for (size_t k = 0; k < (size_t)plain.width * plain.height * 3; k++)
        assert_true(((float *)plain.pixels)[k] == 2.0f * ((float *)exposed.pixels)[k]);
    image_destroy(&plain);
    image_destroy(&exposed);
    image_destroy(&flat);
}

static void pfm_round_trip(void **state)
{
    (void)state;
    image i = make_image(37, 21, 3, IMAGE_F32);
    image back = through(&i, IMAGE_CODEC_PFM);
    assert_same_texels(&i, &back);
    image_destroy(&back);
    image_destroy(&i);
}

/* Bottom row first; big-endian where the scale is positive; grey spreads; NaN and infinities as image.h
 * says. */
static void pfm_of_known_bytes(void **state)
{
    (void)state;
    static const unsigned char grey[] = "Pf\n1 2\n1.0\n\x3f\x80\x00\x00\x40\x00\x00\x00"; /* 1, 2 */
    image i;
    facet_error error;
    assert_int_equal(image_decode(grey, sizeof grey - 1, "g.pfm", NULL, &i, &error), FACET_OK);
    assert_memory_equal(i.pixels, ((float[]){2, 2, 2, 1, 1, 1}), 24);
    image_destroy(&i);
    static const unsigned char scaled[] = "Pf\n1 1\n2.5\n\x3f\x80\x00\x00"; /* in units of 2.5 */
    assert_int_equal(image_decode(scaled, sizeof scaled - 1, "s.pfm", NULL, &i, &error), FACET_OK);
    assert_memory_equal(i.pixels, ((float[]){2.5f, 2.5f, 2.5f}), 12);
    image_destroy(&i);
    static const unsigned char odd[] = "PF 1 1 -1\n\x00\x00\xc0\x7f\x00\x00\x80\x7f\x00\x00\x80\xff";
    assert_int_equal(image_decode(odd, sizeof odd - 1, "o.pfm", NULL, &i, &error), FACET_OK);
    assert_memory_equal(i.pixels, ((float[]){0.0f, FLT_MAX, 0.0f}), 12);
    image_destroy(&i);
    static const char *const bad[] = {"PF\n",
                                      "PF\n1 1\n",
                                      "PF\n0 1\n-1\n",
                                      "PF\n1 1\n0\n000000000000",
                                      "PF\n1 1\n-1\n00000000000",
                                      "PF\n-1 1\n-1\n",
                                      "PF\nx 1\n-1\n"};
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++)
        assert_int_equal(image_decode(bad[k], strlen(bad[k]), "b.pfm", NULL, &i, &error),
                         FACET_ERROR_INVALID);
    assert_int_equal(image_decode("PF\n20000 1\n-1\n", 14, "b.pfm", NULL, &i, &error), FACET_ERROR_LIMIT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(uncompressed_texels_are_read),
        cmocka_unit_test(exposure_is_divided_out),
        cmocka_unit_test(old_run_length_encoding_is_read),
        cmocka_unit_test(new_run_length_encoding_is_read),
        cmocka_unit_test(all_orientations_are_read),
        cmocka_unit_test(headers_are_checked),
        cmocka_unit_test(hdr_round_trip),
        cmocka_unit_test(hdr_writes_extremes),
        cmocka_unit_test(real_environments_are_read),
        cmocka_unit_test(damaged_files_do_no_harm),
        cmocka_unit_test(exposure_lines_of_a_file_are_divided_out),
        cmocka_unit_test(pfm_round_trip),
        cmocka_unit_test(pfm_of_known_bytes),
        cmocka_unit_test(color_correction_is_divided_out),
        cmocka_unit_test(uncompressed_texels_are_not_taken_for_runs),
        cmocka_unit_test(primaries_are_converted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
