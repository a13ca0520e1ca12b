/* codec_exr_test.c - OpenEXR: every compression of files that the OpenEXR library wrote, windows, tiles,
 * parts; written files; environments against each other. */
#include "image/image_test.h"

#include <float.h>
#include <math.h>

#include "image/half.h"

/* The sample of testdata/README.md; exact in half. */
static float sample(uint32_t c, int x, int y)
{
    return (float)((x + 1) * (y + 1) * (int)(c + 1)) / 512.0f;
}

/* Compares with sample() at (x - dx, y - dy), 0 outside of 11 x 37. */
static void expect_samples(const char *name, int dx, int dy, float tolerance, float alpha_tolerance)
{
    char path[256];
    snprintf(path, sizeof path, TEST_DATA "%s.exr", name);
    image i = decode_file_as(path, &(image_decode_desc){.thread_count = 2});
    assert_int_equal(i.channel_count, 4);
    assert_int_equal(i.width, 11 + 2 * dx);
    assert_int_equal(i.height, 37 + 2 * dy);
    assert_int_equal(i.type, IMAGE_F32);
    for (int y = 0; y < (int)i.height; y++)
        for (int x = 0; x < (int)i.width; x++)
            for (uint32_t c = 0; c < 4; c++) {
                int u = x - dx;
                int v = y - dy;
                float expected = u < 0 || v < 0 || u >= 11 || v >= 37 ? 0.0f : sample(c, u, v);
                float got = ((float *)i.pixels)[4 * ((size_t)y * i.width + (size_t)x) + c];
                if (fabsf(got - expected) > (c == 3 ? alpha_tolerance : tolerance) * expected)
                    fail_msg("%s: (%d, %d, %u) is %g, %g was expected", name, x, y, c, (double)got,
                             (double)expected);
            }
    image_destroy(&i);
}

static void lossless_compressions_are_exact(void **state)
{
    (void)state;
    static const char *const names[] = {"none", "rle", "zips", "zip", "piz"};
    for (size_t k = 0; k < sizeof names / sizeof *names; k++)
        expect_samples(names[k], 0, 0, 0.0f, 0.0f);
}

/* PXR24 keeps 15 bits of a float's fraction; B44 6 of 16 bits in a block, but here halves differ by
 * little; DWA blurs dark corners beside bright ones. DWA and PXR24 keep alpha as it is. */
static void lossy_compressions_lose_little(void **state)
{
    (void)state;
    expect_samples("pxr24", 0, 0, 0x1p-15f, 0.0f);
    expect_samples("b44", 0, 0, 0.25f, 0.25f);
    expect_samples("b44a", 0, 0, 0.25f, 0.25f);
    expect_samples("dwaa", 0, 0, 0.3f, 0.0f);
    expect_samples("dwab", 0, 0, 0.3f, 0.0f);
    expect_samples("tiled_dwab", 0, 0, 0.3f, 0.0f);
}

static void windows_tiles_and_parts_are_read(void **state)
{
    (void)state;
    expect_samples("tiled_mipmap_zip", 0, 0, 0.0f, 0.0f);
    expect_samples("multipart_piz", 0, 0, 0.0f, 0.0f);
    expect_samples("window_piz", 3, 2, 0.0f, 0.0f);
    expect_samples("overscan_zip", -3, -2, 0.0f, 0.0f);
}

/* ---- writing ---- */

static void write_layers(uint32_t threads, bool as_half, const image *rgba, const image *depth,
                         unsigned char **bytes, size_t *size)
{
    static const char *const color_names[] = {"R", "G", "B", "A"};
    static const char *const depth_names[] = {"Z"};
    image_layer layers[] = {{color_names, 4, rgba->pixels, image_row_size(rgba), false, false},
                            {depth_names, 1, depth->pixels, image_row_size(depth), true, false}};
    facet_error error;
    if (image_encode_exr(rgba->width, rgba->height, layers, 2, as_half,
                         &(image_encode_desc){.thread_count = threads}, bytes, size, &error) != FACET_OK)
        fail_msg("%s", error.message);
}

static void written_layers_come_back(void **state)
{
    (void)state;
    static const uint32_t sizes[][2] = {{1, 1}, {3, 16}, {203, 117}, {64, 33}};
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++)
        for (int as_half = 0; as_half < 2; as_half++) {
            image rgba = make_image(sizes[k][0], sizes[k][1], 4, IMAGE_F32);
            image depth = make_image(sizes[k][0], sizes[k][1], 1, IMAGE_F32);
            unsigned char *bytes, *again;
            size_t size, again_size;
            write_layers(1, as_half, &rgba, &depth, &bytes, &size);
            write_layers(3, as_half, &rgba, &depth, &again, &again_size);
            assert_int_equal(size, again_size);
            assert_memory_equal(bytes, again, size);
            image back, header;
            image_codec codec;
            assert_int_equal(image_probe(bytes, size, "p", &header, &codec, NULL), FACET_OK);
            assert_int_equal(codec, IMAGE_CODEC_EXR);
            assert_int_equal(header.channel_count, 4);
            assert_int_equal(image_decode(bytes, size, "p", NULL, &back, NULL), FACET_OK);
            for (size_t t = 0; as_half && t < (size_t)rgba.width * rgba.height * 4; t++) {
                float *x = (float *)rgba.pixels + t;
                *x = half_to_float(half_from_float(*x));
            }
            assert_same_texels(&rgba, &back);
            image_destroy(&back); /* layers that need floats keep every bit beside halves */
            assert_int_equal(
                image_decode(bytes, size, "p", &(image_decode_desc){.layer = "depth"}, &back, NULL),
                FACET_OK);
            for (size_t t = 0; t < (size_t)depth.width * depth.height; t++)
                assert_memory_equal((float *)back.pixels + 3 * t, (float *)depth.pixels + t, sizeof(float));
            mem_free(bytes);
            mem_free(again);
            image_destroy(&back);
            image_destroy(&rgba);
            image_destroy(&depth);
        }
}

/* ---- chromaticities ---- */

static void put_floats(const float *values, int count, unsigned char *out)
{
    for (int i = 0; i < count; i++)
        store_u32_le(out + 4 * i, float_bits(values[i]));
}

/* A texel (1, 2, 4) in channels of these names, with the attribute chromaticities. */
static image through_chromaticities(const char *const names[3], const char *layer, const char *type,
                                    const float values[8], image_note *note)
{
    static const float texel[3] = {1, 2, 4};
    const image_layer l = {
        .channel_names = names, .channel_count = 3, .pixels = texel, .row_stride_bytes = sizeof texel};
    unsigned char *plain, value[32];
    size_t size;
    facet_error error;
    assert_int_equal(image_encode_exr(1, 1, &l, 1, false, NULL, &plain, &size, NULL), FACET_OK);
    put_floats(values, 8, value);
    unsigned char *bytes =
        exr_with_attribute(plain, size, 1, "chromaticities", type, value, sizeof value, &size);
    mem_free(plain);
    image i;
    if (image_decode(bytes, size, "c", &(image_decode_desc){.layer = layer, .note = note}, &i, &error) !=
        FACET_OK)
        fail_msg("%s", error.message);
    free(bytes);
    return i;
}

/* Rec.2020 by Recommendation ITU-R BT.2407's matrix, of R, G, B of any layer; positions are no colors. */
static void chromaticities_are_converted(void **state)
{
    (void)state;
    static const float rec2020[8] = {0.708f, 0.292f, 0.170f, 0.797f, 0.131f, 0.046f, 0.3127f, 0.3290f};
    static const float expected[3] = {1.6605f - 2 * 0.5876f - 4 * 0.0728f,
                                      -0.1246f + 2 * 1.1329f - 4 * 0.0083f,
                                      -0.0182f - 2 * 0.1006f + 4 * 1.1187f};
    static const char *const colors[3] = {"R", "G", "B"}, *const albedo[3] = {"a.R", "a.G", "a.B"},
                             *const position[3] = {"p.X", "p.Y", "p.Z"};
    image_note note;
    for (int k = 0; k < 2; k++) {
        image i =
            through_chromaticities(k ? albedo : colors, k ? "a" : NULL, "chromaticities", rec2020, &note);
        for (int c = 0; c < 3; c++)
            assert_float_equal(((float *)i.pixels)[c], expected[c], 1e-3f);
        assert_int_equal(note.level, FACET_LOG_LEVEL_DETAIL);
        assert_non_null(strstr(note.text, "Rec.2020"));
        image_destroy(&i);
    }
    image i = through_chromaticities(position, "p", "chromaticities", rec2020, &note);
    assert_memory_equal(i.pixels, ((float[]){1, 2, 4}), 12);
    assert_int_equal(note.text[0], 0);
    image_destroy(&i);
}

/* All zeros, and another type: one warning, and the numbers stay. */
static void unreadable_chromaticities_are_a_warning(void **state)
{
    (void)state;
    static const float none[8] = {0};
    static const char *const colors[3] = {"R", "G", "B"};
    for (int k = 0; k < 2; k++) {
        image_note note;
        image i = through_chromaticities(colors, NULL, k ? "blob" : "chromaticities", none, &note);
        assert_memory_equal(i.pixels, ((float[]){1, 2, 4}), 12);
        assert_int_equal(note.level, FACET_LOG_LEVEL_WARNING);
        image_destroy(&i);
    }
}

/* An image without R, G, B shows Y, a layer's colors, or its only channel. */
static void channels_are_chosen(void **state)
{
    (void)state;
    static const float texels[] = {1, 2, 3, 4, 5, 6};
    static const char *const y_and_more[] = {"depth", "Y", "a.R"};
    static const char *const layer[] = {"z.R", "b.B", "b.G", "b.R", "b.A", "other"};
    static const char *const only[] = {"height"};
    static const char *const nothing[] = {"u", "v"};
    static const struct {
        const char *const *names;
        uint32_t count, channel_count;
        float expected[4];
    } cases[] = {{y_and_more, 3, 3, {2, 2, 2, 0}},
                 {layer, 6, 4, {4, 3, 2, 5}},
                 {only, 1, 3, {1, 1, 1, 0}},
                 {nothing, 2, 0, {0}}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        image_layer l = {cases[k].names, cases[k].count, texels, sizeof texels, false, false};
        unsigned char *bytes;
        size_t size;
        image i;
        facet_error error;
        assert_int_equal(image_encode_exr(1, 1, &l, 1, false, NULL, &bytes, &size, &error), FACET_OK);
        facet_result result = image_decode(bytes, size, "p", NULL, &i, &error);
        if (cases[k].channel_count == 0) {
            assert_int_equal(result, FACET_ERROR_UNSUPPORTED);
        } else {
            assert_int_equal(result, FACET_OK);
            assert_int_equal(i.channel_count, cases[k].channel_count);
            assert_memory_equal(i.pixels, cases[k].expected, 4 * i.channel_count);
        }
        image_destroy(&i);
        mem_free(bytes);
    }
}

static void nonfinite_samples_are_replaced(void **state)
{
    (void)state;
    static const float values[] = {NAN, INFINITY, -INFINITY, -2.0f, 1e6f, 0.5f};
    static const char *const names[] = {"R", "G", "B"};
    image_layer l = {names, 3, values, sizeof values, false, false};
    for (int as_half = 0; as_half < 2; as_half++) {
        unsigned char *bytes;
        size_t size;
        image i;
        assert_int_equal(image_encode_exr(2, 1, &l, 1, as_half, NULL, &bytes, &size, NULL), FACET_OK);
        assert_int_equal(image_decode(bytes, size, "p", NULL, &i, NULL), FACET_OK);
        const float most = as_half ? 65504.0f : FLT_MAX;
        const float *p = i.pixels;
        assert_true(p[0] == 0.0f && p[1] == most && p[2] == 0.0f && p[3] == -2.0f && p[5] == 0.5f);
        assert_true(p[4] == (as_half ? 65504.0f : 1e6f));
        image_destroy(&i);
        mem_free(bytes);
    }
}

static void images_that_cannot_be_written_are_refused(void **state)
{
    (void)state;
    static const float texels[6] = {0};
    static const char *const twice[] = {"R", "R"};
    static const char *const empty[] = {"R", ""};
    unsigned char *bytes;
    size_t size;
    image_layer l = {twice, 2, texels, 8, false, false};
    assert_int_equal(image_encode_exr(1, 1, &l, 1, true, NULL, &bytes, &size, NULL), FACET_ERROR_ARGUMENT);
    l.channel_names = empty;
    assert_int_equal(image_encode_exr(1, 1, &l, 1, true, NULL, &bytes, &size, NULL), FACET_ERROR_ARGUMENT);
    assert_int_equal(image_encode_exr(1, 1, NULL, 0, true, NULL, &bytes, &size, NULL), FACET_ERROR_ARGUMENT);
    assert_int_equal(image_encode_exr(0, 1, &l, 1, true, NULL, &bytes, &size, NULL), FACET_ERROR_ARGUMENT);
    assert_null(bytes);
}

/* ---- real files ---- */

/* The sky was scaled to 512 x 256 and 256 x 128: half and float agree to half's precision, the small one with
 * the means of 2 x 2 texels where the sky is smooth. */
static void environments_agree_across_compressions(void **state)
{
    (void)state;
    char path[512];
    shared_path(path, "env/exr/qwantani_512_half_zip.exr");
    image half = decode_file_as(path, &(image_decode_desc){.thread_count = 2});
    shared_path(path, "env/exr/qwantani_512_float_piz.exr");
    image full = decode_file(path);
    shared_path(path, "env/exr/qwantani_256_half_none_tiled.exr");
    image small = decode_file(path);
    const float *a = half.pixels;
    const float *b = full.pixels;
    const float *s = small.pixels;
    for (size_t k = 0; k < 512 * 256 * 3; k++)
        assert_true(fabsf(a[k] - b[k]) <= fabsf(b[k]) * 0x1p-10f + 0x1p-24f);
    assert_int_equal(small.width, 256);
    size_t far = 0;
    for (uint32_t y = 0; y < 128; y++)
        for (uint32_t x = 0; x < 256; x++)
            for (uint32_t c = 0; c < 3; c++) {
                size_t at = 3 * ((size_t)2 * y * 512 + 2 * x) + c;
                float mean = (b[at] + b[at + 3] + b[at + 3 * 512] + b[at + 3 * 513]) / 4.0f;
                far += fabsf(mean - s[3 * (y * 256 + x) + c]) > 0.1f * mean;
            }
    assert_true(far < 128 * 256 * 3 / 50);
    image_destroy(&half);
    image_destroy(&full);
    image_destroy(&small);
}

/* Against sums of all components as OpenEXR 3.1.5 reads them. */
static void dwa_compressed_environments_are_read(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        double mean;
    } files[] = {{"env/exr/city_512_dwab.exr", 0.71405},
                 {"env/exr/studio_512_dwab.exr", 1.88382},
                 {"env/exr/sunset_512_dwab.exr", 0.43983}};
    for (size_t k = 0; k < sizeof files / sizeof *files; k++) {
        char path[512];
        shared_path(path, files[k].name);
        image i = decode_file(path);
        double sum = 0.0;
        for (size_t t = 0; t < 512 * 256 * 3; t++)
            sum += (double)((float *)i.pixels)[t];
        assert_true(fabs(sum / (512 * 256 * 3) / files[k].mean - 1.0) < 1e-4);
        image_destroy(&i);
    }
}

/* Attributes are walked over before the library takes memory for them. */
static void attributes_do_not_reach_beyond_the_file(void **state)
{
    (void)state;
    file_bytes file = read_file(TEST_DATA "zip.exr");
    unsigned char *copy = malloc(file.size);
    static const char *const names[] = {"channels", "compression", "dataWindow", "displayWindow"};
    for (size_t k = 0; k < sizeof names / sizeof *names; k++)
        for (int change = 0; change < 3; change++) {
            memcpy(copy, file.data, file.size);
            unsigned char *at = copy + 8;
            while (memcmp(at, names[k], strlen(names[k]) + 1) != 0)
                at++;
            unsigned char *size_at = at + strlen(names[k]) + 1;
            size_at += strlen((char *)size_at) + 1;
            if (change == 0)
                memcpy(size_at, "\0\0\0\x7f", 4);
            else if (change == 1)
                *size_at = (unsigned char)(*size_at + 1);
            else
                *at = '_'; /* missing */
            image i;
            facet_error error;
            assert_int_equal(image_decode(copy, file.size, "p", NULL, &i, &error), FACET_ERROR_INVALID);
            assert_int_equal(strncmp(error.message, "p: OpenEXR: ", 12), 0);
        }
    free(copy);
    file_close(&file);
}

static void damaged_files_do_no_harm(void **state)
{
    (void)state;
    static const char *const names[] = {"malformed/exr/issue-167-heap-buffer-overflow.exr",
                                        "malformed/exr/issue-63-tinyexr_signed-integer-overflow.exr",
                                        "malformed/exr/issue176-heap-buffer-overflow.exr"};
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        char path[512];
        shared_path(path, names[k]);
        file_bytes file = read_file(path);
        image i;
        facet_error error;
        if (image_decode(file.data, file.size, names[k], NULL, &i, &error) != FACET_OK)
            assert_null(i.pixels);
        else
            assert_int_equal(k, 0); /* only a chunk without a checksum is damaged */
        image_destroy(&i);
        file_close(&file);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lossless_compressions_are_exact),
        cmocka_unit_test(lossy_compressions_lose_little),
        cmocka_unit_test(windows_tiles_and_parts_are_read),
        cmocka_unit_test(written_layers_come_back),
        cmocka_unit_test(channels_are_chosen),
        cmocka_unit_test(nonfinite_samples_are_replaced),
        cmocka_unit_test(images_that_cannot_be_written_are_refused),
        cmocka_unit_test(environments_agree_across_compressions),
        cmocka_unit_test(attributes_do_not_reach_beyond_the_file),
        cmocka_unit_test(dwa_compressed_environments_are_read),
        cmocka_unit_test(damaged_files_do_no_harm),
        cmocka_unit_test(chromaticities_are_converted),
        cmocka_unit_test(unreadable_chromaticities_are_a_warning),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
