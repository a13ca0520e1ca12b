/* ktx2_write_test.c - KTX2 files of floats: rounding, descriptors, the places of things, and that ktx2.h
 * reads them back. */
#include "tests/support/support.h"
#include "image/image_test.h"

#include <math.h>

#include "image/codec.h"
#include "image/half.h"
#include "image/ktx2.h"
#include "image/ktx_write.h"

enum { FORMAT_COUNT = 8, MAX_IMAGES = 6 * 16 };
static const char *const format_names[FORMAT_COUNT] = {"RGBA16F", "RGBA32F", "RGB9E5", "B10G11R11",
                                                       "RG16F",   "RG32F",   "R16F",   "R32F"};

static uint32_t random_state;

static uint32_t next_random(void)
{
    lcg_next(&random_state);
    return random_state >> 8 ^ random_state << 13;
}

/* ---- rounding ---- */

static double value_of_small(uint32_t code, int digits)
{
    const int exponent = (int)(code >> digits);
    const double fraction = (double)(code & ((1u << digits) - 1)) / (double)(1u << digits);
    return exponent ? ldexp(1.0 + fraction, exponent - 15) : ldexp(fraction, -14);
}

/* The code of the nearest of count increasing values, even codes at ties. */
static uint32_t nearest_code(double x, const double *values, uint32_t count)
{
    uint32_t low = 0, high = count - 1;
    if (!(x > 0.0))
        return 0;
    if (x >= values[high])
        return high;
    while (high - low > 1) {
        uint32_t middle = (low + high) / 2;
        if (values[middle] <= x)
            low = middle;
        else
            high = middle;
    }
    const double below = x - values[low], above = values[high] - x;
    return below < above || (below == above && low % 2 == 0) ? low : high;
}

/* All finite codes, the midpoints between them, and random numbers around them. */
static void small_floats_are_rounded_to_nearest(void **state)
{
    (void)state;
    for (int digits = 5; digits <= 6; digits++) {
        static double values[31 << 6];
        const uint32_t count = 31u << digits;
        for (uint32_t i = 0; i < count; i++)
            values[i] = value_of_small(i, digits);
        for (uint32_t i = 0; i < 20 * count; i++) {
            const uint32_t code = i % count;
            const double next = code + 1 < count ? values[code + 1] : 2.0 * values[code];
            const double share = i < count ? 0.0 : i < 2 * count ? 0.5 : next_random() / 4294967296.0;
            const float x = (float)(values[code] + share * (next - values[code]));
            const float rgb[3] = {digits == 6 ? x : 0.0f, digits == 6 ? x : 0.0f, digits == 5 ? x : 0.0f};
            unsigned char packed[4];
            ktx2_pack(FACET_TEXEL_FORMAT_B10G11R11, rgb, 3, 1, false, packed);
            const uint32_t word = load_u32_le(packed), wanted = nearest_code((double)x, values, count);
            if (word != (digits == 6 ? wanted | wanted << 11 : wanted << 22))
                fail_msg("%.9g with %d digits: %08x instead of code %u", (double)x, digits, word, wanted);
        }
    }
}

/* The best that the format can do: over all exponents that hold the largest channel, the smallest is the
 * finest. */
static uint32_t pack_shared_slowly(const float rgb[3])
{
    for (int exponent = 0;; exponent++) {
        uint32_t word = (uint32_t)exponent << 27;
        bool is_held = true;
        for (int c = 0; c < 3; c++) {
            double x = fmin(fmax((double)rgb[c], 0.0), 65408.0);
            double n = nearbyint(ldexp(x, 24 - exponent));
            is_held &= n <= 511.0;
            word |= is_held ? (uint32_t)n << (9 * c) : 0;
        }
        if (is_held)
            return word;
    }
}

static void shared_exponents_are_the_smallest(void **state)
{
    (void)state;
    static const float special[] = {0.0f,        -0.0f,    -1.0f,      65408.0f, 65407.9f, 65280.0f,    1e30f,
                                    0x1p-24f,    0x1p-25f, 0x1.8p-24f, 511.5f,   511.49f,  0x1.ffcp-1f, 1.0f,
                                    0x1.ffap-1f, 510.5f,   1e-30f,     256.0f,   0x1p-16f, 0x1.fep-16f};
    enum { SPECIAL = sizeof special / sizeof *special };
    for (uint32_t i = 0; i < 300000; i++) {
        float rgb[3];
        for (uint32_t c = 0; c < 3; c++) {
            uint32_t r = next_random();
            rgb[c] = i < SPECIAL * SPECIAL * SPECIAL ? special[i /
                                                               (c == 0   ? 1
                                                                : c == 1 ? SPECIAL
                                                                         : SPECIAL * SPECIAL) %
                                                               SPECIAL]
                                                     : ldexpf((float)(r & 4095), (int)(r >> 20) % 40 - 34);
        }
        unsigned char packed[4];
        ktx2_pack(FACET_TEXEL_FORMAT_RGB9E5, rgb, 3, 1, false, packed);
        if (load_u32_le(packed) != pack_shared_slowly(rgb))
            fail_msg("%.9g %.9g %.9g: %08x instead of %08x", (double)rgb[0], (double)rgb[1], (double)rgb[2],
                     load_u32_le(packed), pack_shared_slowly(rgb));
    }
}

static void values_beyond_a_format_are_clamped(void **state)
{
    (void)state;
    const float in[4] = {INFINITY, -INFINITY, NAN, -2.0f};
    unsigned char out[16];
    ktx2_pack(FACET_TEXEL_FORMAT_RGBA16F, in, 4, 1, false, out);
    assert_memory_equal(out, "\xff\x7b\xff\xfb\x00\x00\x00\xc0", 8); /* 65504, -65504, 0, -2 */
    ktx2_pack(FACET_TEXEL_FORMAT_RGBA16F, in, 4, 1, true, out);
    assert_memory_equal(out + 6, "\x00\x3c", 2); /* 1 */
    ktx2_pack(FACET_TEXEL_FORMAT_RGBA32F, in, 4, 1, false, out);
    assert_memory_equal(out, "\xff\xff\x7f\x7f\xff\xff\x7f\xff\0\0\0\0\0\0\0\xc0", 16);
    ktx2_pack(FACET_TEXEL_FORMAT_B10G11R11, in, 3, 1, false, out);
    assert_int_equal(load_u32_le(out), 0x7bf); /* 65024 */
    ktx2_pack(FACET_TEXEL_FORMAT_B10G11R11, (const float[3]){-0.0f, 1e9f, 1e9f}, 3, 1, false, out);
    assert_int_equal(load_u32_le(out), 0x7bfu << 11 | 0x3dfu << 22); /* 64512 */
    ktx2_pack(FACET_TEXEL_FORMAT_RGB9E5, in, 3, 1, false, out);
    assert_int_equal(load_u32_le(out), 31u << 27 | 511u);
    ktx2_pack(FACET_TEXEL_FORMAT_R16F, (const float[1]){65519.99f}, 1, 1, false, out);
    assert_memory_equal(out, "\xff\x7b", 2);
    /* channels that are not there */
    ktx2_pack(FACET_TEXEL_FORMAT_RGBA16F, (const float[1]){1.0f}, 1, 1, false, out);
    assert_memory_equal(out, "\x00\x3c\x00\x00\x00\x00\x00\x3c", 8);
}

/* ---- files ---- */

typedef struct texture {
    facet_image_view images[MAX_IMAGES];
    float *texels;
    ktx2_write_desc desc;
} texture;

/* Values that every format can hold are read back exactly. */
static texture make_texture(facet_texel_format format, uint32_t width, uint32_t height, uint32_t faces,
                            uint32_t levels, uint32_t channels)
{
    texture t = {.desc = {.format = format,
                          .level_count = levels,
                          .face_count = faces,
                          .thread_count = 2,
                          .writer = "facet 1.2.3"}};
    size_t count = 0;
    for (uint32_t l = 0; l < levels; l++)
        count += (size_t)faces * ktx2_level_edge(width, l) * ktx2_level_edge(height, l) * channels;
    t.texels = malloc(count * sizeof(float));
    for (size_t i = 0; i < count; i++) {
        const uint32_t r = next_random();
        t.texels[i] = ldexpf((float)(r & 31), (int)(i / channels % 23) - 12); /* one exponent a texel */
    }
    float *at = t.texels;
    for (uint32_t i = 0; i < levels * faces; i++) {
        const uint32_t w = ktx2_level_edge(width, i / faces), h = ktx2_level_edge(height, i / faces);
        t.images[i] = (facet_image_view){"", w, h, channels, at, w * channels * sizeof(float)};
        at += (size_t)w * h * channels;
    }
    return t;
}

static unsigned char *write_texture(texture *t, size_t *size)
{
    unsigned char *bytes = NULL;
    facet_error error;
    t->desc.images = t->images;
    if (ktx2_write(&t->desc, &bytes, size, &error) != FACET_OK)
        fail_msg("%s", error.message);
    return bytes;
}

static float get_float(const image *i, size_t at)
{
    return i->type == IMAGE_F16 ? half_to_float(((const uint16_t *)i->pixels)[at])
                                : ((const float *)i->pixels)[at];
}

static void check_image(const texture *t, const ktx2 *k, uint32_t level, uint32_t face)
{
    static const uint32_t kept[FORMAT_COUNT] = {4, 4, 3, 3, 2, 2, 1, 1};
    const facet_image_view *v = &t->images[level * t->desc.face_count + face];
    image i;
    facet_error error;
    if (ktx2_read(k, level, 0, face, &(image_decode_desc){0}, &i, &error) != FACET_OK)
        fail_msg("%s", error.message);
    assert_int_equal(i.width, v->width);
    assert_int_equal(i.height, v->height);
    for (size_t n = 0; n < (size_t)v->width * v->height; n++)
        for (uint32_t c = 0; c < i.channel_count; c++) {
            const bool is_there = c < v->channel_count && c < kept[t->desc.format];
            const float wanted = is_there ? v->pixels[n * v->channel_count + c] : c == 3 ? 1.0f : 0.0f;
            const float got = get_float(&i, n * i.channel_count + c);
            if (memcmp(&got, &wanted, sizeof got) != 0)
                fail_msg("%s, level %u, face %u, texel %zu, channel %u: %.9g, not %.9g",
                         format_names[t->desc.format], level, face, n, c, (double)got, (double)wanted);
        }
    image_destroy(&i);
}

static const struct {
    uint32_t width, height, faces, levels, channels;
} shapes[] = {{1, 1, 1, 1, 1}, {5, 3, 1, 3, 4}, {16, 16, 6, 5, 4}, {16, 16, 6, 1, 3},
              {7, 7, 6, 3, 2}, {1, 9, 1, 4, 3}, {64, 32, 1, 7, 4}, {300, 2, 1, 1, 4}};
enum { SHAPE_COUNT = sizeof shapes / sizeof *shapes };

static texture make_shape(uint32_t format, uint32_t shape)
{
    return make_texture((facet_texel_format)format, shapes[shape].width, shapes[shape].height,
                        shapes[shape].faces, shapes[shape].levels, shapes[shape].channels);
}

static void written_files_are_read_back(void **state)
{
    (void)state;
    for (uint32_t n = 0; n < FORMAT_COUNT * SHAPE_COUNT * 2; n++) {
        texture t = make_shape(n % FORMAT_COUNT, n / FORMAT_COUNT % SHAPE_COUNT);
        t.desc.zstd_level = n / FORMAT_COUNT / SHAPE_COUNT ? 1 + n % 19 : 0;
        t.desc.images = t.images;
        unsigned char *bytes;
        size_t size;
        facet_error error;
        facet_result result = ktx2_write(&t.desc, &bytes, &size, &error);
        if (t.desc.zstd_level && result == FACET_ERROR_UNSUPPORTED) {
            assert_non_null(strstr(error.message, "libzstd"));
            free(t.texels);
            continue;
        }
        ktx2 k;
        if (result != FACET_OK || ktx2_open(bytes, size, "written", &k, &error) != FACET_OK)
            fail_msg("%s", error.message);
        assert_int_equal(k.is_cube, t.desc.face_count == 6);
        assert_int_equal(k.level_count, t.desc.level_count);
        assert_false(k.is_array || k.has_all_mips || k.is_srgb || k.is_premultiplied || k.is_bottom_up);
        assert_int_equal(k.scheme, t.desc.zstd_level ? KTX2_ZSTD : KTX2_NONE);
        for (uint32_t i = 0; i < t.desc.level_count * t.desc.face_count; i++)
            check_image(&t, &k, i / t.desc.face_count, i % t.desc.face_count);
        mem_free(bytes);
        free(t.texels);
    }
}

/* ---- the rules of the file format, as Khronos' validator has them ---- */

/* Expected samples: bit offset, length - 1, channel and qualifiers, lower, upper. KDF 1.3, sections 5.6
 * and 10. */
typedef struct sample {
    uint32_t first_bit, last_bit, channel, lower, upper;
} sample;

static const struct {
    uint32_t vk_format, type_size, texel_size, sample_count;
    sample samples[6];
} expected[FORMAT_COUNT] = {
    {97,
     2,
     8,
     4,
     {{0, 15, 0xc0, 0xbf800000, 0x3f800000},
      {16, 15, 0xc1, 0xbf800000, 0x3f800000},
      {32, 15, 0xc2, 0xbf800000, 0x3f800000},
      {48, 15, 0xcf, 0xbf800000, 0x3f800000}}},
    {109,
     4,
     16,
     4,
     {{0, 31, 0xc0, 0xbf800000, 0x3f800000},
      {32, 31, 0xc1, 0xbf800000, 0x3f800000},
      {64, 31, 0xc2, 0xbf800000, 0x3f800000},
      {96, 31, 0xcf, 0xbf800000, 0x3f800000}}},
    {123,
     4,
     4,
     6,
     {{0, 8, 0x00, 0, 8448},
      {27, 4, 0x20, 15, 31},
      {9, 8, 0x01, 0, 8448},
      {27, 4, 0x21, 15, 31},
      {18, 8, 0x02, 0, 8448},
      {27, 4, 0x22, 15, 31}}},
    {122,
     4,
     4,
     3,
     {{0, 10, 0x80, 0, 0x3f800000}, {11, 10, 0x81, 0, 0x3f800000}, {22, 9, 0x82, 0, 0x3f800000}}},
    {83, 2, 4, 2, {{0, 15, 0xc0, 0xbf800000, 0x3f800000}, {16, 15, 0xc1, 0xbf800000, 0x3f800000}}},
    {103, 4, 8, 2, {{0, 31, 0xc0, 0xbf800000, 0x3f800000}, {32, 31, 0xc1, 0xbf800000, 0x3f800000}}},
    {76, 2, 2, 1, {{0, 15, 0xc0, 0xbf800000, 0x3f800000}}},
    {100, 4, 4, 1, {{0, 31, 0xc0, 0xbf800000, 0x3f800000}}},
};

static uint64_t load_u64(const unsigned char *p)
{
    return load_u32_le(p) | (uint64_t)load_u32_le(p + 4) << 32;
}

static void check_descriptor(const unsigned char *dfd, size_t size, uint32_t format)
{
    const uint32_t count = expected[format].sample_count;
    assert_int_equal(size, 28 + 16 * count);
    assert_int_equal(load_u32_le(dfd), size);
    assert_int_equal(load_u32_le(dfd + 4), 0);
    assert_int_equal(load_u32_le(dfd + 8), 2 | (size - 4) << 16);
    assert_int_equal(load_u32_le(dfd + 12),
                     1 | 1 << 8 | 1 << 16); /* RGBSDA, BT.709, linear, alpha straight */
    assert_int_equal(load_u32_le(dfd + 16), 0);
    assert_int_equal(load_u32_le(dfd + 20), expected[format].texel_size);
    assert_int_equal(load_u32_le(dfd + 24), 0);
    for (uint32_t i = 0; i < count; i++) {
        const unsigned char *s = dfd + 28 + 16 * (size_t)i;
        const sample *e = &expected[format].samples[i];
        assert_int_equal(s[0] | s[1] << 8, e->first_bit);
        assert_int_equal(s[2], e->last_bit);
        assert_int_equal(s[3], e->channel);
        assert_int_equal(load_u32_le(s + 4), 0);
        assert_int_equal(load_u32_le(s + 8), e->lower);
        assert_int_equal(load_u32_le(s + 12), e->upper);
    }
}

static size_t check_metadata(const unsigned char *kvd, size_t size)
{
    static const unsigned char wanted[] = "\x12\0\0\0KTXorientation\0rd\0\0\0"
                                          "\x16\0\0\0KTXwriter\0facet 1.2.3\0\0";
    assert_int_equal(size, sizeof wanted);
    assert_memory_equal(kvd, wanted, size);
    return size;
}

static void check_file(const texture *t, const unsigned char *b, size_t size)
{
    const uint32_t format = t->desc.format, levels = t->desc.level_count;
    const uint32_t width = t->images[0].width, height = t->images[0].height;
    const uint32_t words[] = {expected[format].vk_format,
                              expected[format].type_size,
                              width,
                              height,
                              0,
                              0,
                              t->desc.face_count,
                              levels,
                              t->desc.zstd_level ? 2 : 0};
    assert_memory_equal(b, "\xabKTX 20\xbb\r\n\x1a\n", 12);
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        assert_int_equal(load_u32_le(b + 12 + 4 * i), words[i]);
    size_t at = 80 + 24 * (size_t)levels;
    assert_int_equal(load_u32_le(b + 48), at);
    check_descriptor(b + at, load_u32_le(b + 52), format);
    at += load_u32_le(b + 52);
    assert_int_equal(load_u32_le(b + 56), at);
    at += check_metadata(b + at, load_u32_le(b + 60));
    for (size_t i = 64; i < 80; i++)
        assert_int_equal(b[i], 0);
    const size_t texel = expected[format].texel_size;
    const size_t alignment = t->desc.zstd_level ? 1 : texel % 4 ? 2 * texel : texel;
    for (uint32_t l = levels;
         l-- > 0;) { /* the smallest first, without gaps but for alignment, which is zero */
        const unsigned char *record = b + 80 + 24 * (size_t)l;
        const size_t whole =
            texel * t->desc.face_count * ktx2_level_edge(width, l) * ktx2_level_edge(height, l);
        for (; at % alignment; at++)
            assert_int_equal(b[at], 0);
        assert_int_equal(load_u64(record), at);
        assert_int_equal(load_u64(record + 16), whole);
        if (!t->desc.zstd_level)
            assert_int_equal(load_u64(record + 8), whole);
        at += load_u64(record + 8);
    }
    assert_int_equal(at, size);
}

static void files_follow_the_specification(void **state)
{
    (void)state;
    for (uint32_t n = 0; n < FORMAT_COUNT * SHAPE_COUNT * 2; n++) {
        texture t = make_shape(n % FORMAT_COUNT, n / FORMAT_COUNT % SHAPE_COUNT);
        t.desc.zstd_level = n / FORMAT_COUNT / SHAPE_COUNT ? 3 : 0;
        t.desc.images = t.images;
        unsigned char *bytes;
        size_t size;
        if (ktx2_write(&t.desc, &bytes, &size, NULL) == FACET_OK)
            check_file(&t, bytes, size);
        else
            assert_true(t.desc.zstd_level);
        mem_free(bytes);
        free(t.texels);
    }
}

static void bytes_do_not_depend_on_threads(void **state)
{
    (void)state;
    for (uint32_t zstd = 0; zstd <= 3; zstd += 3) {
        texture t = make_texture(FACET_TEXEL_FORMAT_RGB9E5, 256, 256, 6, 9, 4);
        t.desc.zstd_level = zstd;
        t.desc.images = t.images;
        unsigned char *first = NULL;
        size_t first_size = 0;
        for (uint32_t threads = 1; threads <= 5; threads += 2) {
            unsigned char *bytes;
            size_t size;
            t.desc.thread_count = threads;
            facet_result result = ktx2_write(&t.desc, &bytes, &size, NULL);
            if (result == FACET_ERROR_UNSUPPORTED)
                break;
            assert_int_equal(result, FACET_OK);
            if (first) {
                assert_int_equal(size, first_size);
                assert_memory_equal(bytes, first, size);
                mem_free(bytes);
            } else {
                first = bytes;
                first_size = size;
            }
        }
        if (zstd && first)
            assert_true(first_size < 6 * 4 * 256 * 256 * 4 / 3);
        mem_free(first);
        free(t.texels);
    }
}

static void invalid_textures_are_refused(void **state)
{
    (void)state;
    for (int k = 0; k < 9; k++) {
        texture t = make_texture(FACET_TEXEL_FORMAT_RGBA16F, 8, 8, 6, 2, 4);
        t.desc.images = t.images;
        switch (k) {
        case 0:
            t.desc.face_count = 5;
            break;
        case 1:
            t.desc.face_count = 0;
            break;
        case 2:
            t.desc.level_count = 0;
            break;
        case 3:
            t.desc.level_count = 5;
            break;
        case 4:
            t.desc.level_count = 0xffffffff;
            break;
        case 5:
            t.images[7].width = 5;
            break;
        case 6:
            t.images[3].channel_count = 5;
            break;
        case 7:
            t.images[0].height = 4;
            break;
        case 8:
            t.desc.zstd_level = 20;
            break;
        }
        unsigned char *bytes = (unsigned char *)8;
        size_t size;
        facet_error error = {0};
        assert_int_equal(ktx2_write(&t.desc, &bytes, &size, &error), FACET_ERROR_ARGUMENT);
        assert_null(bytes);
        assert_int_equal(strncmp(error.message, "KTX2: ", 6), 0);
        free(t.texels);
    }
}

static void running_out_of_memory_leaks_nothing(void **state)
{
    (void)state;
    for (uint32_t zstd = 0; zstd <= 1; zstd++)
        for (long calls = 0;; calls = next_failure(calls)) {
            texture t = make_texture(FACET_TEXEL_FORMAT_RGBA16F, 8, 8, 6, 4, 4);
            failing_allocator counter = {.fail_at = calls};
            t.desc.allocator = failing_allocator_get(&counter);
            t.desc.thread_count = 1;
            t.desc.zstd_level = zstd;
            t.desc.images = t.images;
            unsigned char *bytes;
            size_t size;
            facet_result result = ktx2_write(&t.desc, &bytes, &size, NULL);
            free(t.texels);
            if (result == FACET_OK)
                mem_free(bytes);
            assert_int_equal(counter.blocks, 0);
            if (result != FACET_ERROR_MEMORY)
                break;
            assert_null(bytes);
            assert_true(calls < 20);
        }
}

/* Memory of Zstandard counts against a budget. */
static void zstandard_stays_within_a_budget(void **state)
{
    (void)state;
    texture t = make_texture(FACET_TEXEL_FORMAT_RGBA32F, 256, 256, 1, 1, 4);
    t.desc.zstd_level = 19;
    t.desc.images = t.images;
    facet_budget *budget;
    assert_int_equal(facet_budget_create(16u << 20, &budget, NULL), FACET_OK);
    t.desc.allocator = facet_budget_allocator(budget);
    unsigned char *bytes;
    size_t size;
    facet_result result = ktx2_write(&t.desc, &bytes, &size, NULL);
    assert_true(result == FACET_ERROR_MEMORY || result == FACET_ERROR_UNSUPPORTED);
    if (result == FACET_ERROR_MEMORY) {
        t.desc.zstd_level = 3;
        assert_int_equal(ktx2_write(&t.desc, &bytes, &size, NULL), FACET_OK);
        mem_free(bytes);
    }
    assert_int_equal(facet_budget_used_bytes(budget), 0);
    facet_budget_destroy(budget);
    free(t.texels);
}

/* A stride longer than the rows. */
static void rows_may_have_any_stride(void **state)
{
    (void)state;
    static const float texels[] = {1, 2, 99, 3, 4, 99};
    texture t = {
        .images = {{"", 2, 2, 1, texels, 3 * sizeof(float)}},
        .desc = {.format = FACET_TEXEL_FORMAT_R32F, .level_count = 1, .face_count = 1, .writer = "x"}};
    size_t size;
    unsigned char *bytes = write_texture(&t, &size);
    static const float wanted[] = {1, 2, 3, 4};
    assert_memory_equal(bytes + size - sizeof wanted, wanted, sizeof wanted);
    mem_free(bytes);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(small_floats_are_rounded_to_nearest),
        cmocka_unit_test(shared_exponents_are_the_smallest),
        cmocka_unit_test(values_beyond_a_format_are_clamped),
        cmocka_unit_test(written_files_are_read_back),
        cmocka_unit_test(files_follow_the_specification),
        cmocka_unit_test(bytes_do_not_depend_on_threads),
        cmocka_unit_test(invalid_textures_are_refused),
        cmocka_unit_test(running_out_of_memory_leaks_nothing),
        cmocka_unit_test(zstandard_stays_within_a_budget),
        cmocka_unit_test(rows_may_have_any_stride),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
