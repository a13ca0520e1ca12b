/* ktx2_test.c - KTX2 files: uncompressed texels, levels, layers, faces, metadata, supercompression,
 * refusals. Basis Universal: codec_ktx2_test.c. */
#include "image/image_test.h"

#include <math.h>
#include <zlib.h>

#include "image/half.h"
#include "image/ktx2.h"
#include "image/ktx2_test_file.h"

/* Decodes a file that must decode. */
static image decode(const ktx2_test_file *f, const image_decode_desc *desc)
{
    size_t size;
    unsigned char *bytes = ktx2_test_write(f, &size);
    image i, header;
    facet_error error;
    if (image_decode(bytes, size, "made", desc, &i, &error) != FACET_OK)
        fail_msg("%s", error.message);
    assert_int_equal(image_probe(bytes, size, "made", &header, NULL, NULL), FACET_OK);
    assert_int_equal(header.type, i.type);
    assert_int_equal(header.is_srgb, i.is_srgb);
    if (!desc || desc->channel_count == 0)
        assert_int_equal(header.channel_count, i.channel_count);
    free(bytes);
    return i;
}

static double get_channel(const image *i, size_t texel, uint32_t channel)
{
    const size_t at = texel * i->channel_count + channel;
    switch (i->type) {
    case IMAGE_U8:
        return ((const uint8_t *)i->pixels)[at] / 255.0;
    case IMAGE_U16:
        return ((const uint16_t *)i->pixels)[at] / 65535.0;
    case IMAGE_F16:
        return (double)half_to_float(((const uint16_t *)i->pixels)[at]);
    default:
        return (double)((const float *)i->pixels)[at];
    }
}

static void uncompressed_texels_are_read(void **state)
{
    (void)state;
    static const struct {
        uint32_t vk;
        size_t size;
        unsigned char bytes[16];
        image_type type;
        uint32_t channel_count;
        double rgba[4];
    } cases[] = {
        {9, 1, {51}, IMAGE_U8, 3, {0.2, 0, 0}},
        {10, 1, {0x80}, IMAGE_F32, 3, {-1, 0, 0}},
        {16, 2, {51, 102}, IMAGE_U8, 3, {0.2, 0.4, 0}},
        {23, 3, {51, 102, 255}, IMAGE_U8, 3, {0.2, 0.4, 1}},
        {30, 3, {51, 102, 255}, IMAGE_U8, 3, {1, 0.4, 0.2}},
        {37, 4, {51, 102, 255, 0}, IMAGE_U8, 4, {0.2, 0.4, 1, 0}},
        {38, 4, {127, 0x81, 0, 127}, IMAGE_F32, 4, {1, -1, 0, 1}},
        {44, 4, {51, 102, 255, 0}, IMAGE_U8, 4, {1, 0.4, 0.2, 0}},
        {58, 4, {0xff, 0x03, 0x00, 0x40}, IMAGE_U16, 4, {0, 0, 1, 1.0 / 3}},
        {64, 4, {0xff, 0x03, 0x00, 0x40}, IMAGE_U16, 4, {1, 0, 0, 1.0 / 3}},
        {70, 2, {0x33, 0x33}, IMAGE_U16, 3, {0.2, 0, 0}},
        {71, 2, {0x00, 0x80}, IMAGE_F32, 3, {-1, 0, 0}},
        {77, 4, {0x33, 0x33, 0x66, 0x66}, IMAGE_U16, 3, {0.2, 0.4, 0}},
        {91, 8, {0x33, 0x33, 0x66, 0x66, 0xff, 0xff, 0, 0}, IMAGE_U16, 4, {0.2, 0.4, 1, 0}},
        {92, 8, {1, 0x80, 0xff, 0x7f, 0, 0, 0xff, 0x7f}, IMAGE_F32, 4, {-1, 1, 0, 1}},
        /* infinity, NaN, negative infinity, -2 */
        {97, 8, {0, 0x7c, 1, 0x7e, 0, 0xfc, 0, 0xc0}, IMAGE_F16, 4, {65504, 0, 0, -2}},
        {100, 4, {0, 0, 0xc0, 0x3f}, IMAGE_F32, 3, {1.5, 0, 0}},
        {106,
         12,
         {0, 0, 0xc0, 0x3f, 0, 0, 0xc0, 0xff, 0, 0, 0x80, 0x7f},
         IMAGE_F32,
         3,
         {1.5, 0, 0x1.fffffep127}},
        {109,
         16,
         {0, 0, 0xc0, 0x3f, 0, 0, 0, 0xc0, 0, 0, 0, 0, 0, 0, 0x80, 0x3f},
         IMAGE_F32,
         4,
         {1.5, -2, 0, 1}},
        /* 11, 11 and 10 bits: 1, 1.5, 2 */
        {122, 4, {0xc0, 0x03, 0x1f, 0x80}, IMAGE_F16, 3, {1, 1.5, 2}},
        /* 9 bits of each and exponent 16: 256, 1, 511 times 2^-8 */
        {123, 4, {0x00, 0x03, 0xfc, 0x87}, IMAGE_F16, 3, {1, 1.0 / 256, 511.0 / 256}},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        unsigned char bytes[5 * 16];
        for (size_t t = 0; t < 5; t++)
            memcpy(bytes + t * cases[k].size, cases[k].bytes, cases[k].size);
        ktx2_test_file f = {
            .vk_format = cases[k].vk, .width = 5, .height = 1, .faces = 1, .levels = 1, .transfer = 1};
        f.bytes[0] = bytes;
        f.sizes[0] = 5 * cases[k].size;
        image i = decode(&f, NULL);
        assert_int_equal(i.type, cases[k].type);
        assert_int_equal(i.channel_count, cases[k].channel_count);
        assert_false(i.is_srgb);
        for (size_t t = 0; t < 5; t++)
            for (uint32_t c = 0; c < i.channel_count; c++)
                if (!(fabs(get_channel(&i, t, c) - cases[k].rgba[c]) <= 1e-7 * fabs(cases[k].rgba[c])))
                    fail_msg("format %u, texel %zu, channel %u: %.9g", cases[k].vk, t, c,
                             get_channel(&i, t, c));
        image_destroy(&i);
    }
}

/* NaN and infinity are kept on request; otherwise infinity is replaced. */
static void nonfinite_values_are_kept_on_request(void **state)
{
    (void)state;
    static const struct {
        uint32_t vk;
        size_t size;
        unsigned char bytes[16];
        float largest;
    } cases[] = {
        {97, 8, {0, 0x7c, 1, 0x7e, 0, 0xfc, 0, 0xc0}, 65504.0f},
        {109, 16, {0, 0, 0x80, 0x7f, 0, 0, 0xc0, 0x7f, 0, 0, 0x80, 0xff, 0, 0, 0, 0xc0}, 0x1.fffffep127f},
        {122, 4, {0xc0, 0x07, 0x3f, 0xf8}, 65504.0f}, /* infinity, NaN, infinity */
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        ktx2_test_file f = {
            .vk_format = cases[k].vk, .width = 1, .height = 1, .faces = 1, .levels = 1, .transfer = 1};
        f.bytes[0] = cases[k].bytes;
        f.sizes[0] = cases[k].size;
        float largest = 0.0f;
        image i = decode(&f, &(image_decode_desc){.keeps_nonfinite = true, .largest = &largest});
        assert_true(isinf(get_channel(&i, 0, 0)) && get_channel(&i, 0, 0) > 0.0);
        assert_true(isnan(get_channel(&i, 0, 1)));
        assert_true(isinf(get_channel(&i, 0, 2)));
        if (i.channel_count == 4)
            assert_true(get_channel(&i, 0, 3) == -2.0);
        assert_true(largest == cases[k].largest);
        image_destroy(&i);
    }
}

static void transfer_functions_are_reported(void **state)
{
    (void)state;
    static const unsigned char texel[4] = {1, 2, 3, 4};
    ktx2_test_file f = {.vk_format = 43, .width = 1, .height = 1, .faces = 1, .levels = 1, .transfer = 2};
    f.bytes[0] = texel;
    f.sizes[0] = 4;
    image i = decode(&f, NULL);
    assert_true(i.is_srgb);
    image_destroy(&i);
    i = decode(&f, &(image_decode_desc){.channel_count = 3});
    assert_int_equal(i.channel_count, 3);
    assert_memory_equal(i.pixels, texel, 3);
    image_destroy(&i);
}

/* Levels of single bytes, each its number times 10. */
static ktx2_test_file make_levels(uint32_t width, uint32_t height, uint32_t levels, unsigned char *memory)
{
    ktx2_test_file f = {
        .vk_format = 23, .width = width, .height = height, .faces = 1, .levels = levels, .transfer = 1};
    for (uint32_t l = 0; l < levels; l++) {
        f.sizes[l] = (size_t)3 * ktx2_level_edge(width, l) * ktx2_level_edge(height, l);
        f.bytes[l] = memory;
        memset(memory, (int)l * 10, f.sizes[l]);
        memory += f.sizes[l];
    }
    return f;
}

static void levels_are_chosen_by_reduction(void **state)
{
    (void)state;
    static const struct {
        uint32_t width, height, levels, max_reduction, level;
    } cases[] = {
        {16, 4, 5, 0, 0},  {16, 4, 5, 1, 1}, {16, 4, 5, 2, 2}, {16, 4, 5, 4, 4},
        {16, 4, 5, 31, 4}, {16, 4, 3, 9, 2}, {7, 8, 3, 2, 0}, /* 3 x 4 would not be 7 x 8 reduced, nor 1 x 2 */
        {6, 4, 3, 2, 1},                                      /* 3 x 2 is, 1 x 1 is not */
        {5, 1, 3, 1, 0},   {1, 1, 1, 40, 0},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        unsigned char memory[1024];
        ktx2_test_file f = make_levels(cases[k].width, cases[k].height, cases[k].levels, memory);
        image i = decode(&f, &(image_decode_desc){.max_reduction = cases[k].max_reduction});
        assert_int_equal(i.width, ktx2_level_edge(cases[k].width, cases[k].level));
        assert_int_equal(i.height, ktx2_level_edge(cases[k].height, cases[k].level));
        assert_int_equal(((const uint8_t *)i.pixels)[0], cases[k].level * 10);
        image_destroy(&i);
    }
}

static void layers_and_faces_are_in_order(void **state)
{
    (void)state;
    enum { LAYERS = 3, FACES = 6, EDGE = 4 };
    unsigned char memory[2][LAYERS * FACES * EDGE * EDGE];
    ktx2_test_file f = {.vk_format = 9,
                        .width = EDGE,
                        .height = EDGE,
                        .layers = LAYERS,
                        .faces = FACES,
                        .levels = 2,
                        .transfer = 1};
    for (uint32_t l = 0; l < 2; l++) {
        const size_t image_size = (size_t)(EDGE >> l) * (EDGE >> l);
        f.bytes[l] = memory[l];
        f.sizes[l] = LAYERS * FACES * image_size;
        for (size_t n = 0; n < LAYERS * FACES; n++)
            memset(memory[l] + n * image_size, (int)(l * 100 + n), image_size);
    }
    size_t size;
    unsigned char *bytes = ktx2_test_write(&f, &size);
    ktx2 k;
    facet_error error;
    assert_int_equal(ktx2_open(bytes, size, "cubes", &k, &error), FACET_OK);
    assert_true(k.is_cube && k.is_array);
    for (uint32_t n = 0; n < 2 * LAYERS * FACES; n++) {
        uint32_t level = n % 2, layer = n / 2 / FACES, face = n / 2 % FACES;
        image i;
        assert_int_equal(ktx2_read(&k, level, layer, face, &(image_decode_desc){0}, &i, &error), FACET_OK);
        assert_int_equal(i.width, EDGE >> level);
        assert_int_equal(((const uint8_t *)i.pixels)[0], level * 100 + layer * FACES + face);
        assert_int_equal(((const uint8_t *)i.pixels)[3 * i.width * i.height - 3],
                         level * 100 + layer * FACES + face);
        image_destroy(&i);
    }
    free(bytes);
}

static void orientation_and_swizzle_are_applied(void **state)
{
    (void)state;
    static const unsigned char texels[2 * 3 * 4] = {10, 11, 12, 13, 20, 21, 22, 23, 30, 31, 32, 33,
                                                    40, 41, 42, 43, 50, 51, 52, 53, 60, 61, 62, 63};
    ktx2_test_file f = {.vk_format = 37, .width = 2, .height = 3, .faces = 1, .levels = 1, .transfer = 1};
    f.bytes[0] = texels;
    f.sizes[0] = sizeof texels;
    static const struct {
        const char *key, *value;
        uint32_t channel_count;
        unsigned char first[4], last[4];
    } cases[] = {
        {"KTXorientation", "rd", 4, {10, 11, 12, 13}, {60, 61, 62, 63}},
        {"KTXorientation", "ru", 4, {50, 51, 52, 53}, {20, 21, 22, 23}},
        {"KTXorientation", "lu", 4, {60, 61, 62, 63}, {10, 11, 12, 13}},
        {"KTXswizzle", "bgra", 4, {12, 11, 10, 13}, {62, 61, 60, 63}},
        {"KTXswizzle", "rg01", 3, {10, 11, 0}, {60, 61, 0}},
        {"KTXswizzle", "gggr", 4, {11, 11, 11, 10}, {61, 61, 61, 60}},
        {"KTXswizzle", "aaa1", 1, {13}, {63}},
        {"KTXswizzle", "xyzw", 4, {10, 11, 12, 13}, {60, 61, 62, 63}}, /* means nothing */
        {"KTXwriter", "bgra", 4, {10, 11, 12, 13}, {60, 61, 62, 63}},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        f.key = cases[k].key;
        f.value = cases[k].value;
        image i = decode(&f, NULL);
        const uint8_t *pixels = i.pixels;
        assert_int_equal(i.channel_count, cases[k].channel_count);
        assert_memory_equal(pixels, cases[k].first, i.channel_count);
        assert_memory_equal(pixels + (size_t)5 * i.channel_count, cases[k].last, i.channel_count);
        image_destroy(&i);
    }
}

enum { IMAGE_SIZE = 24 * 16 * 4 };

/* A Zstandard frame (RFC 8878) of one block that is not compressed. */
static size_t write_zstd(const unsigned char *data, size_t size, unsigned char *out)
{
    static const unsigned char magic[4] = {0x28, 0xb5, 0x2f, 0xfd};
    memcpy(out, magic, 4);
    out[4] = 0xa0; /* the size follows in 4 bytes, no window */
    store_u32_le(out + 5, (uint32_t)size);
    uint32_t block = 1u | (uint32_t)size << 3; /* the last, raw */
    out[9] = (unsigned char)block;
    out[10] = (unsigned char)(block >> 8);
    out[11] = (unsigned char)(block >> 16);
    memcpy(out + 12, data, size);
    return size + 12;
}

static void supercompressed_levels_are_read(void **state)
{
    (void)state;
    image drawn = make_image(24, 16, 4, IMAGE_U8);
    for (uint32_t scheme = 2; scheme <= 3; scheme++) {
        unsigned char packed[IMAGE_SIZE + 64];
        uLongf packed_size = sizeof packed;
        if (scheme == 3)
            assert_int_equal(compress(packed, &packed_size, drawn.pixels, IMAGE_SIZE), Z_OK);
        else
            packed_size = (uLongf)write_zstd(drawn.pixels, IMAGE_SIZE, packed);
        ktx2_test_file f = {.vk_format = 43,
                            .width = 24,
                            .height = 16,
                            .faces = 1,
                            .levels = 1,
                            .scheme = scheme,
                            .transfer = 2};
        f.bytes[0] = packed;
        f.sizes[0] = packed_size;
        f.whole_sizes[0] = IMAGE_SIZE;
        size_t size;
        unsigned char *bytes = ktx2_test_write(&f, &size);
        image i;
        facet_error error;
        facet_result result = image_decode(bytes, size, "packed", NULL, &i, &error);
        if (result == FACET_ERROR_UNSUPPORTED) { /* this build has no libzstd */
            assert_int_equal(scheme, 2);
            assert_non_null(strstr(error.message, "libzstd"));
        } else {
            assert_int_equal(result, FACET_OK);
            assert_same_texels(&i, &drawn);
            image_destroy(&i);
            bytes[size - 200] ^= 0x55; /* Zstandard frames need not have a check sum */
            result = image_decode(bytes, size, "packed", NULL, &i, &error);
            assert_int_equal(result, scheme == 3 ? FACET_ERROR_INVALID : FACET_OK);
            image_destroy(&i);
            bytes[size - f.sizes[0] + 9] = 0; /* header of the block, or the first code */
            assert_int_equal(image_decode(bytes, size, "packed", NULL, &i, &error), FACET_ERROR_INVALID);
            assert_non_null(strstr(error.message, "packed: KTX2: level 0: the compressed data is damaged"));
        }
        free(bytes);
    }
    image_destroy(&drawn);
}

/* Blocks of one color (KDF, "ASTC void-extent blocks") in all sizes, clipped at the edges. */
static void astc_is_read_in_all_block_sizes(void **state)
{
    (void)state;
    static const unsigned char block[16] = {0xfc, 0xfd, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff,
                                            51,   51,   102,  102,  255,  255,  128,  128};
    static const unsigned char sizes[14][2] = {{4, 4},  {5, 4},   {5, 5},   {6, 5},  {6, 6},
                                               {8, 5},  {8, 6},   {8, 8},   {10, 5}, {10, 6},
                                               {10, 8}, {10, 10}, {12, 10}, {12, 12}};
    enum { WIDTH = 300, HEIGHT = 301 };
    unsigned char *blocks = malloc((size_t)75 * 76 * sizeof block);
    for (size_t i = 0; i < 75 * 76; i++)
        memcpy(blocks + i * sizeof block, block, sizeof block);
    for (uint32_t k = 0; k < 28; k++) {
        const unsigned width = sizes[k / 2][0], height = sizes[k / 2][1];
        ktx2_test_file f = {
            .vk_format = 157 + k, .width = WIDTH, .height = HEIGHT, .faces = 1, .levels = 1, .transfer = 1};
        f.bytes[0] = blocks;
        f.sizes[0] = (size_t)16 * ((WIDTH + width - 1) / width) * ((HEIGHT + height - 1) / height);
        size_t size;
        unsigned char *bytes = ktx2_test_write(&f, &size);
        image i;
        facet_error error;
        facet_result result =
            image_decode(bytes, size, "astc", &(image_decode_desc){.thread_count = 1 + k % 3}, &i, &error);
        free(bytes);
        if (result == FACET_ERROR_UNSUPPORTED) {
            assert_non_null(strstr(error.message, "libastcenc"));
            continue;
        }
        assert_int_equal(result, FACET_OK);
        assert_int_equal(i.is_srgb, k % 2);
        for (size_t t = 0; t < (size_t)WIDTH * HEIGHT; t++)
            assert_memory_equal((const unsigned char *)i.pixels + 4 * t, "\x33\x66\xff\x80", 4);
        image_destroy(&i);
    }
    free(blocks);
}

static void malformed_and_unsupported_files_are_refused(void **state)
{
    (void)state;
    static const unsigned char texels[64 * 4] = {0};
    static const struct {
        size_t offset; /* of a word in the file */
        uint32_t value;
        facet_result result;
        const char *message;
    } cases[] = {
        {0, 0, FACET_ERROR_INVALID, "first bytes"},
        {12, 1000066000, FACET_ERROR_UNSUPPORTED, "vkFormat 1000066000"}, /* ASTC HDR */
        {12, 0, FACET_ERROR_UNSUPPORTED,
         "ETC1S or UASTC was expected where vkFormat is 0, not color model 1"},
        {20, 0, FACET_ERROR_INVALID, "no texels"},
        {20, 0xffffffff, FACET_ERROR_INVALID,
         "level 0: RGBA8, 4294967295 x 8 texels do not fit its 256 bytes"},
        {24, 9, FACET_ERROR_INVALID, "level 0"},
        {28, 4, FACET_ERROR_UNSUPPORTED, "3D textures"},
        {32, 2, FACET_ERROR_INVALID, "level 0"},
        {32, 0xffffffff, FACET_ERROR_INVALID, "level 0"},
        {36, 0, FACET_ERROR_INVALID, "faceCount"},
        {36, 6, FACET_ERROR_INVALID, "level 0"},
        {40, 5, FACET_ERROR_INVALID, "levelCount: 8 x 8 texels do not have 5 levels"},
        {40, 0xffffffff, FACET_ERROR_INVALID, "levelCount"},
        {44, 1, FACET_ERROR_INVALID, "BasisLZ was expected with vkFormat 0"},
        {44, 4, FACET_ERROR_UNSUPPORTED,
         "supercompressionScheme: none, BasisLZ, Zstandard or zlib was expected, not 4"},
        {48, 0x7fffffff, FACET_ERROR_INVALID, "format descriptor"},
        {52, 8, FACET_ERROR_INVALID, "format descriptor"},
        {56, 0x7fffffff, FACET_ERROR_INVALID, "metadata is outside"},
        {64, 0x7fffffff, FACET_ERROR_INVALID, "global data is outside"},
        {80, 0x7fffffff, FACET_ERROR_INVALID, "level 0: bytes"},
        {84, 0xffffffff, FACET_ERROR_INVALID, "level 0: bytes"},
        {88, 255, FACET_ERROR_INVALID, "level 0"},
        {96, 255, FACET_ERROR_INVALID, "level 0"},
    };
    ktx2_test_file f = {.vk_format = 37,
                        .width = 8,
                        .height = 8,
                        .faces = 1,
                        .levels = 1,
                        .model = 1,
                        .transfer = 1,
                        .key = "KTXwriter",
                        .value = "facet"};
    f.bytes[0] = texels;
    f.sizes[0] = sizeof texels;
    size_t size;
    unsigned char *bytes = ktx2_test_write(&f, &size);
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        unsigned char saved[4];
        memcpy(saved, bytes + cases[k].offset, 4);
        store_u32_le(bytes + cases[k].offset, cases[k].value);
        failing_allocator counter = {.fail_at = 0}; /* refused before memory is allocated */
        image_decode_desc desc = {.allocator = failing_allocator_get(&counter)};
        image i;
        facet_error error = {0};
        facet_result result = image_decode(bytes, size, "bad", &desc, &i, &error);
        if (result != cases[k].result || !strstr(error.message, cases[k].message) ||
            strncmp(error.message, "bad: ", 5) != 0)
            fail_msg("case %zu: %d: %s", k, (int)result, error.message);
        memcpy(bytes + cases[k].offset, saved, 4);
    }
    free(bytes);
}

/* UASTC HDR, and claims of compressed levels beyond what their bytes could become. */
static void excessive_claims_and_uastc_hdr_are_refused(void **state)
{
    (void)state;
    static const unsigned char block[16] = {0};
    ktx2_test_file f = {.width = 4, .height = 4, .faces = 1, .levels = 1, .model = 167};
    f.bytes[0] = block;
    f.sizes[0] = sizeof block;
    for (int k = 0; k < 3; k++) {
        if (k > 0)
            f = (ktx2_test_file){.vk_format = 37,
                                 .width = 16384,
                                 .height = 16384,
                                 .faces = 1,
                                 .levels = 1,
                                 .scheme = k == 1 ? 3 : 2,
                                 .bytes = {block},
                                 .sizes = {16},
                                 .whole_sizes = {(size_t)16384 * 16384 * 4}};
        size_t size;
        unsigned char *bytes = ktx2_test_write(&f, &size);
        failing_allocator counter = {.fail_at = 0};
        image_decode_desc desc = {.allocator = failing_allocator_get(&counter)};
        image i;
        facet_error error;
        facet_result result = image_decode(bytes, size, "bad", &desc, &i, &error);
        assert_true(result == FACET_ERROR_UNSUPPORTED || (k > 0 && result == FACET_ERROR_INVALID));
        if (k == 0)
            assert_non_null(strstr(error.message, "UASTC HDR"));
        free(bytes);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(uncompressed_texels_are_read),
        cmocka_unit_test(nonfinite_values_are_kept_on_request),
        cmocka_unit_test(transfer_functions_are_reported),
        cmocka_unit_test(levels_are_chosen_by_reduction),
        cmocka_unit_test(layers_and_faces_are_in_order),
        cmocka_unit_test(orientation_and_swizzle_are_applied),
        cmocka_unit_test(supercompressed_levels_are_read),
        cmocka_unit_test(astc_is_read_in_all_block_sizes),
        cmocka_unit_test(malformed_and_unsupported_files_are_refused),
        cmocka_unit_test(excessive_claims_and_uastc_hdr_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
