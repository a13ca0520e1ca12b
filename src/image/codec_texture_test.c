/* codec_texture_test.c - TGA, BMP, GIF and DDS: files that are made here, with every order, depth and kind
 * of runs; files cut off anywhere. */
#include "image/image_test.h"

#include <math.h>

#include "image/block.h"
#include "image/codec.h"
#include "image/half.h"
#include "tests/support/support.h"

enum { WIDTH = 7, HEIGHT = 5, MAX_FILE = 65536 };

/* A file that is being made. */
typedef struct made {
    unsigned char bytes[MAX_FILE];
    size_t size;
} made;

static void put(made *m, const void *bytes, size_t size)
{
    assert_true(m->size + size <= MAX_FILE);
    if (size)
        memcpy(m->bytes + m->size, bytes, size);
    m->size += size;
}

static void put_u8(made *m, uint32_t x)
{
    put(m, &(unsigned char){(unsigned char)x}, 1);
}

static void put_u16(made *m, uint32_t x)
{
    put_u8(m, x & 255);
    put_u8(m, x >> 8);
}

static void put_u32(made *m, uint32_t x)
{
    put_u16(m, x & 0xffff);
    put_u16(m, x >> 16);
}

/* The image that files show: color c of texel (x, y). Rows have equal neighbours, for runs. */
static uint32_t color(uint32_t x, uint32_t y, uint32_t c)
{
    return (x / 2 * 50 + y * 30 + c * 85) & 255;
}

/* Decodes, as its own channels; the file has to be whole: anything shorter fails and leaves nothing. */
static image decode_made(const made *m, image_codec codec)
{
    image i, header;
    image_codec found;
    facet_error error;
    if (image_probe(m->bytes, m->size, "made", &header, &found, &error) != FACET_OK ||
        image_decode(m->bytes, m->size, "made", NULL, &i, &error) != FACET_OK)
        fail_msg("%s", error.message);
    assert_int_equal(found, codec);
    assert_int_equal(header.width, i.width);
    assert_int_equal(header.height, i.height);
    assert_int_equal(header.channel_count, i.channel_count);
    assert_true(i.type == IMAGE_U8 && i.is_srgb);
    for (size_t size = 0; size < m->size; size++) {
        unsigned char *part = malloc(size + !size); /* so that a sanitizer detects reads behind it */
        image none;
        memcpy(part, m->bytes, size);
        if (image_decode(part, size, "part", NULL, &none, &error) == FACET_OK) {
            assert_int_equal(none.width, i.width); /* only bytes that no texel needs were missing */
            assert_memory_equal(none.pixels, i.pixels, image_row_size(&i) * i.height);
        } else {
            assert_null(none.pixels);
        }
        image_destroy(&none);
        free(part);
    }
    image wide;
    assert_int_equal(
        image_decode(m->bytes, m->size, "made", &(image_decode_desc){.channel_count = 4}, &wide, NULL),
        FACET_OK);
    assert_int_equal(wide.channel_count, 4);
    image_destroy(&wide);
    assert_int_equal(
        image_decode(m->bytes, m->size, "made", &(image_decode_desc){.max_size = 3}, &wide, NULL),
        FACET_ERROR_LIMIT);
    return i;
}

/* Color within tolerance codes; alpha as it is given, -1: there is none. */
static void expect_colors(const image *i, uint32_t channel_count, uint32_t tolerance, int alpha)
{
    assert_int_equal(i->width, WIDTH);
    assert_int_equal(i->height, HEIGHT);
    assert_int_equal(i->channel_count, channel_count);
    const uint8_t *texel = i->pixels;
    for (uint32_t y = 0; y < HEIGHT; y++)
        for (uint32_t x = 0; x < WIDTH; x++, texel += channel_count) {
            for (uint32_t c = 0; c < channel_count - (alpha >= 0); c++)
                if (abs((int)texel[c] - (int)color(x, y, c)) > (int)tolerance)
                    fail_msg("(%u, %u, %u): %u, %u was expected", x, y, c, texel[c], color(x, y, c));
            if (alpha >= 0)
                assert_int_equal(texel[channel_count - 1], alpha);
        }
}

/* ---- TGA ---- */

typedef struct tga_kind {
    uint32_t type, bits, alpha_bits, map_bits;
    uint32_t channel_count, tolerance;
    int alpha;
} tga_kind;

/* A color in as many bits. */
static size_t make_word(uint32_t bits, uint32_t x, uint32_t y, uint32_t alpha, unsigned char word[4])
{
    const uint32_t r = color(x, y, 0), g = color(x, y, 1), b = color(x, y, 2);
    uint32_t value = b | g << 8 | r << 16 | alpha << 24;
    if (bits == 8)
        value = r;
    else if (bits == 15 || bits == 16)
        value = (b * 31 + 127) / 255 | ((g * 31 + 127) / 255) << 5 | ((r * 31 + 127) / 255) << 10 |
                (alpha >> 7) << 15;
    store_u32_le(word, value);
    return (bits + 7) / 8;
}

static void make_tga(const tga_kind *k, bool has_runs, bool is_top_down, bool is_right_to_left, made *m)
{
    m->size = 0;
    const uint32_t map_count = k->map_bits ? WIDTH * HEIGHT : 0;
    put_u8(m, 3); /* bytes of a text behind the header */
    put_u8(m, k->map_bits != 0);
    put_u8(m, k->type | (has_runs ? 8 : 0));
    put_u16(m, k->map_bits ? 2 : 0); /* the first color's number */
    put_u16(m, map_count);
    put_u8(m, k->map_bits);
    put_u32(m, 0);
    put_u16(m, WIDTH);
    put_u16(m, HEIGHT);
    put_u8(m, k->bits);
    put_u8(m, k->alpha_bits | (is_top_down ? 32 : 0) | (is_right_to_left ? 16 : 0));
    put(m, "abc", 3);
    unsigned char word[4];
    for (uint32_t i = 0; i < map_count; i++) {
        const size_t size = make_word(k->map_bits, i % WIDTH, i / WIDTH, 200, word);
        put(m, word, size);
    }
    for (uint32_t i = 0; i < WIDTH * HEIGHT; i++) {
        const uint32_t column = i % WIDTH, row = i / WIDTH;
        const uint32_t x = is_right_to_left ? WIDTH - 1 - column : column,
                       y = is_top_down ? row : HEIGHT - 1 - row;
        size_t size = 1;
        if (k->map_bits)
            word[0] = (unsigned char)(2 + y * WIDTH + x);
        else
            size = make_word(k->bits, x, y, 200, word);
        if (has_runs)
            put_u8(m, i % 3 == 0 ? 0x80 : 0); /* a run of one, and literals of one */
        put(m, word, size);
    }
}

static void tga_is_read_in_every_row_and_column_order(void **state)
{
    (void)state;
    static const tga_kind kinds[] = {
        {2, 24, 0, 0, 3, 0, -1},  {2, 32, 8, 0, 4, 0, 200}, {2, 32, 0, 0, 4, 0, 200}, {2, 16, 0, 0, 3, 4, -1},
        {2, 16, 1, 0, 4, 4, 255}, {2, 15, 0, 0, 3, 4, -1},  {3, 8, 0, 0, 1, 0, -1},   {1, 8, 0, 24, 3, 0, -1},
        {1, 8, 8, 32, 4, 0, 200}, {1, 8, 0, 16, 3, 4, -1}};
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++)
        for (int order = 0; order < 8; order++) {
            made m;
            make_tga(&kinds[k], order & 4, order & 2, order & 1, &m);
            image i = decode_made(&m, IMAGE_CODEC_TGA);
            expect_colors(&i, kinds[k].channel_count, kinds[k].tolerance, kinds[k].alpha);
            image_destroy(&i);
        }
}

/* A run of five, then two literals; alpha that is 0 throughout is not used. */
static void tga_runs_and_unused_alpha(void **state)
{
    (void)state;
    made m = {{0}, 0};
    put(&m, "\0\0\x0a\0\0\0\0\0\0\0\0\0\x07\0\x01\0\x20\x28", 18);
    put(&m, "\x84\x01\x02\x03\x00\x01\x04\x05\x06\x00\x07\x08\x09\x00", 14);
    image i = decode_made(&m, IMAGE_CODEC_TGA);
    assert_int_equal(i.channel_count, 4);
    assert_memory_equal(i.pixels, "\3\2\1\xff\3\2\1\xff\3\2\1\xff\3\2\1\xff\3\2\1\xff\6\5\4\xff\x9\x8\x7\xff",
                        28);
    image_destroy(&i);
}

/* ---- BMP ---- */

static void put_bmp_header(made *m, int32_t height, uint32_t bits, uint32_t compression, uint32_t color_count,
                           uint32_t mask_size)
{
    m->size = 0;
    put(m, "BM", 2);
    put_u32(m, 0);
    put_u32(m, 0);
    put_u32(m, 54 + mask_size + 4 * color_count);
    put_u32(m, 40);
    put_u32(m, WIDTH);
    put_u32(m, (uint32_t)height);
    put_u16(m, 1);
    put_u16(m, bits);
    put_u32(m, compression);
    for (int i = 0; i < 3; i++)
        put_u32(m, 0);
    put_u32(m, color_count);
    put_u32(m, 0);
}

static void bmp_with_direct_colors(void **state)
{
    (void)state;
    static const struct {
        uint32_t bits, compression;
        uint32_t masks[4], mask_count;
        uint32_t channel_count, tolerance;
        int alpha;
    } kinds[] = {{24, 0, {0}, 0, 3, 0, -1},
                 {32, 0, {0}, 0, 3, 0, -1},
                 {16, 0, {0}, 0, 3, 4, -1},
                 {16, 3, {0x7c00, 0x3e0, 0x1f}, 3, 3, 4, -1},
                 {32, 3, {0xff0000, 0xff00, 0xff}, 3, 3, 0, -1},
                 {32, 6, {0xff0000, 0xff00, 0xff, 0xff000000}, 4, 4, 0, 200}};
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++)
        for (int is_top_down = 0; is_top_down < 2; is_top_down++) {
            made m;
            put_bmp_header(&m, is_top_down ? -HEIGHT : HEIGHT, kinds[k].bits, kinds[k].compression, 0,
                           4 * kinds[k].mask_count);
            for (uint32_t c = 0; c < kinds[k].mask_count; c++)
                put_u32(&m, kinds[k].masks[c]);
            for (uint32_t row = 0; row < HEIGHT; row++) {
                for (uint32_t x = 0; x < WIDTH; x++) {
                    unsigned char word[4];
                    const size_t size =
                        make_word(kinds[k].bits, x, is_top_down ? row : HEIGHT - 1 - row, 200, word);
                    put(&m, word, size);
                }
                put(&m, "\0\0\0", (4 - WIDTH * kinds[k].bits / 8 % 4) % 4);
            }
            image i = decode_made(&m, IMAGE_CODEC_BMP);
            expect_colors(&i, kinds[k].channel_count, kinds[k].tolerance, kinds[k].alpha);
            image_destroy(&i);
        }
}

/* Colors i, 2 i, 3 i; texel (x, y) has number (x + y) % count. */
static void bmp_with_palettes(void **state)
{
    (void)state;
    for (uint32_t bits = 1; bits <= 8; bits *= 2) {
        const uint32_t count = bits == 8 ? 11 : 1u << bits;
        made m;
        put_bmp_header(&m, HEIGHT, bits, 0, count, 0);
        for (uint32_t i = 0; i < count; i++)
            put(&m, (unsigned char[]){(unsigned char)(3 * i), (unsigned char)(2 * i), (unsigned char)i, 0},
                4);
        for (uint32_t row = 0; row < HEIGHT; row++) {
            unsigned char packed[8] = {0};
            for (uint32_t x = 0; x < WIDTH; x++)
                packed[x * bits / 8] |=
                    (unsigned char)((x + HEIGHT - 1 - row) % count << (8 - bits - x * bits % 8));
            put(&m, packed, (WIDTH * bits + 31) / 32 * 4);
        }
        image i = decode_made(&m, IMAGE_CODEC_BMP);
        assert_int_equal(i.channel_count, 3);
        for (uint32_t t = 0; t < WIDTH * HEIGHT; t++) {
            const uint32_t index = (t % WIDTH + t / WIDTH) % count;
            const uint8_t expected[3] = {(uint8_t)index, (uint8_t)(2 * index), (uint8_t)(3 * index)};
            assert_memory_equal((const uint8_t *)i.pixels + 3 * (size_t)t, expected, 3);
        }
        image_destroy(&i);
        m.bytes[m.size - 4] = 0xff; /* the last row's first texels */
        facet_error error;
        if (bits == 8) {
            assert_int_equal(image_decode(m.bytes, m.size, "p", NULL, &i, &error), FACET_ERROR_INVALID);
            assert_non_null(strstr(error.message, "no color of the palette"));
        }
    }
}

/* Runs, literals, a jump, ends of rows: numbers of the 7 x 5 texels from the top, as digits; files begin
 * at the bottom. */
static void bmp_runs(void **state)
{
    (void)state;
    static const struct {
        uint32_t compression, size;
        const char *runs, *expected;
    } cases[] = {
        {1, 30,
         "\x07\x01\0\0\0\x05\x01\x02\x03\x04\x05\0\x02\x01\0\0\x01\x03\0\x02\x02\x02\x02\x04\0\0\0\x01\0\0",
         "0004400"
         "0000000"
         "3000000"
         "1234511"
         "1111111"},
        {2, 24, "\x07\x12\0\0\0\x05\x12\x34\x50\0\x02\x67\0\0\x01\x30\0\x02\x02\x02\x02\x40\0\x01",
         "0004000"
         "0000000"
         "3000000"
         "1234567"
         "1212121"}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        made m;
        put_bmp_header(&m, HEIGHT, cases[k].compression == 1 ? 8 : 4, cases[k].compression, 8, 0);
        for (uint32_t i = 0; i < 8; i++)
            put_u32(&m, i * 0x10101);
        put(&m, cases[k].runs, cases[k].size);
        image i;
        facet_error error;
        if (image_decode(m.bytes, m.size, "runs", NULL, &i, &error) != FACET_OK)
            fail_msg("%s", error.message);
        char got[WIDTH * HEIGHT + 1] = {0};
        for (uint32_t t = 0; t < WIDTH * HEIGHT; t++)
            got[t] = (char)('0' + ((const uint8_t *)i.pixels)[3 * (size_t)t]);
        assert_string_equal(got, cases[k].expected);
        image_destroy(&i);
    }
}

/* ---- GIF ---- */

/* The file that "What's In A GIF" by M. Flickinger explains byte by byte: 10 x 10 texels of white, red and
 * blue. */
static void gif_of_a_known_example(void **state)
{
    (void)state;
    static const char file[] =
        "GIF89a\x0a\0\x0a\0\x91\0\0\xff\xff\xff\xff\0\0\0\0\xff\0\0\0\x21\xf9\x04\0\0\0\0\0\x2c\0\0\0\0\x0a\0"
        "\x0a\0\0\x02\x16"
        "\x8c\x2d\x99\x87\x2a\x1c\xdc\x33\xa0\x02\x75\xec\x95\xfa\xa8\xde\x60\x8c\x04\x91\x4c\x01\0\x3b";
    static const char *const rows[] = {"1111122222", "1110000222", "2220000111", "2222211111"};
    static const int row_of[10] = {0, 0, 0, 1, 1, 2, 2, 3, 3, 3};
    made m = {{0}, 0};
    put(&m, file, sizeof file - 1);
    image i = decode_made(&m, IMAGE_CODEC_GIF);
    assert_int_equal(i.channel_count, 3);
    for (uint32_t t = 0; t < 100; t++) {
        static const char *const colors[] = {"\xff\xff\xff", "\xff\0\0", "\0\0\xff"};
        assert_memory_equal((const uint8_t *)i.pixels + 3 * (size_t)t,
                            colors[rows[row_of[t / 10]][t % 10] - '0'], 3);
    }
    image_destroy(&i);
}

/* An LZW encoder as plain as can be: strings are prefixes and last numbers. */
static size_t encode_lzw(const unsigned char *indices, size_t count, uint32_t bits, unsigned char *out)
{
    static uint32_t prefix[4096], last[4096];
    const uint32_t clear = 1u << bits;
    uint32_t code_count = clear + 2, size = bits + 1, current = clear;
    uint64_t held = 0;
    uint32_t held_bits = 0;
    size_t written = 0, next = 0;
    for (bool is_done = false; !is_done;) {
        uint32_t code = current;
        const bool is_start = code == clear;
        if (!is_start) { /* the longest string that is known */
            for (bool is_longer = true; is_longer && next < count;) {
                uint32_t found = clear + 2;
                while (found < code_count && (prefix[found] != code || last[found] != indices[next]))
                    found++;
                is_longer = found < code_count;
                code = is_longer ? found : code;
                next += is_longer;
            }
        }
        is_done = next == count && !is_start;
        held |= (uint64_t)code << held_bits;
        for (held_bits += size; held_bits >= 8; held_bits -= 8, held >>= 8)
            out[written++] = (unsigned char)held;
        if (!is_start && !is_done && code_count < 4096) {
            prefix[code_count] = code;
            last[code_count++] = indices[next];
            size += code_count > 1u << size && size < 12;
        }
        if (!is_done)
            current = indices[next++];
    }
    held |= (uint64_t)(clear + 1) << held_bits;
    for (held_bits += size; (int)held_bits > 0; held_bits -= held_bits < 8 ? held_bits : 8, held >>= 8)
        out[written++] = (unsigned char)held;
    return written;
}

/* Numbers of a frame, rows as they stand in the file. */
static void put_gif(made *m, uint32_t width, uint32_t height, const uint32_t frame[4], bool is_interlaced,
                    int transparent, const unsigned char *indices)
{
    static unsigned char packed[MAX_FILE];
    m->size = 0;
    put(m, "GIF89a", 6);
    put_u16(m, width);
    put_u16(m, height);
    put(m, "\xf7\0\0", 3); /* 256 colors */
    for (uint32_t i = 0; i < 256; i++)
        put(m, (unsigned char[]){(unsigned char)i, (unsigned char)(255 - i), 7}, 3);
    if (transparent >= 0) {
        put(m, "\x21\xf9\x04\x01\0\0", 6);
        put_u8(m, (uint32_t)transparent);
        put_u8(m, 0);
    }
    put_u8(m, 0x2c);
    for (int i = 0; i < 4; i++)
        put_u16(m, frame[i]);
    put_u8(m, is_interlaced ? 0x40 : 0);
    put_u8(m, 8);
    const size_t size = encode_lzw(indices, (size_t)frame[2] * frame[3], 8, packed);
    for (size_t at = 0; at < size; at += 255) {
        const uint32_t part = size - at < 255 ? (uint32_t)(size - at) : 255;
        put_u8(m, part);
        put(m, packed + at, part);
    }
    put(m, "\0\x3b", 2);
}

/* 200 x 150 texels: codes grow to 12 bits, and stay so where all 4096 are taken. */
static void gif_with_long_codes(void **state)
{
    (void)state;
    static unsigned char indices[200 * 150];
    uint32_t noise = 1;
    for (size_t i = 0; i < sizeof indices; i++) {
        lcg_next(&noise);
        indices[i] = (unsigned char)(i % 7 < 3 ? noise >> 24 : i / 200);
    }
    static made m;
    put_gif(&m, 200, 150, (const uint32_t[]){0, 0, 200, 150}, false, -1, indices);
    image i;
    facet_error error;
    if (image_decode(m.bytes, m.size, "long", NULL, &i, &error) != FACET_OK)
        fail_msg("%s", error.message);
    for (size_t t = 0; t < sizeof indices; t++)
        assert_int_equal(((const uint8_t *)i.pixels)[3 * t], indices[t]);
    image_destroy(&i);
}

/* A frame of 3 x 11 at (2, 1) of 6 x 13, interlaced, with a transparent color. */
static void gif_frames_are_placed_on_the_canvas(void **state)
{
    (void)state;
    static const int order[11] = {0, 8, 4, 2, 6, 10, 1, 3, 5, 7, 9};
    unsigned char indices[33];
    for (int row = 0; row < 11; row++)
        for (int x = 0; x < 3; x++)
            indices[3 * row + x] = (unsigned char)(10 * order[row] + x);
    static made m;
    put_gif(&m, 6, 13, (const uint32_t[]){2, 1, 3, 11}, true, 51, indices);
    image i = decode_made(&m, IMAGE_CODEC_GIF);
    assert_int_equal(i.width, 6);
    assert_int_equal(i.height, 13);
    assert_int_equal(i.channel_count, 4);
    for (int y = 0; y < 13; y++)
        for (int x = 0; x < 6; x++) {
            const uint8_t *texel = (const uint8_t *)i.pixels + 4 * (6 * y + x);
            const bool is_inside = x >= 2 && x < 5 && y >= 1 && y < 12;
            const int index = 10 * (y - 1) + x - 2;
            assert_int_equal(texel[3], is_inside && index != 51 ? 255 : 0);
            if (is_inside)
                assert_int_equal(texel[0], index);
        }
    image_destroy(&i);
}

static void gif_sizes_are_checked(void **state)
{
    (void)state;
    static made m;
    put_gif(&m, 16000, 16000, (const uint32_t[]){0, 0, 1, 1}, false, -1, (const unsigned char[]){1});
    image i;
    facet_error error;
    assert_int_equal(image_decode(m.bytes, m.size, "large", NULL, &i, &error), FACET_ERROR_INVALID);
    assert_non_null(strstr(error.message, "cannot hold 16000 x 16000 texels"));
}

/* ---- DDS ---- */

static void put_dds_header(made *m, uint32_t flags, const char *letters, uint32_t bits,
                           const uint32_t masks[4], uint32_t dxgi)
{
    m->size = 0;
    put(m, "DDS ", 4);
    put_u32(m, 124);
    put_u32(m, 0x1007);
    put_u32(m, HEIGHT);
    put_u32(m, WIDTH);
    for (int i = 0; i < 14; i++)
        put_u32(m, 0);
    put_u32(m, 32);
    put_u32(m, flags);
    put(m, letters, 4);
    put_u32(m, bits);
    for (int i = 0; i < 4; i++)
        put_u32(m, masks ? masks[i] : 0);
    put_u32(m, 0x1000);
    for (int i = 0; i < 4; i++)
        put_u32(m, 0);
    for (int i = 0; i < 5 && dxgi; i++)
        put_u32(m, i == 0 ? dxgi : i == 1 ? 3 : i == 3 ? 1 : 0);
}

/* 2 x 2 blocks, cropped to 7 x 5 texels, equal the output of their decoder. */
static void dds_with_blocks(void **state)
{
    (void)state;
    static const struct {
        const char *letters;
        uint32_t dxgi, block_size, channel_count;
        block_decode *decode;
    } kinds[] = {{"DXT1", 0, 8, 4, bc1_rgba_decode}, {"DXT3", 0, 16, 4, bc2_decode},
                 {"DXT5", 0, 16, 4, bc3_decode},     {"ATI1", 0, 8, 1, bc4_decode},
                 {"ATI2", 0, 16, 3, bc5_decode},     {"DX10", 71, 8, 4, bc1_rgba_decode},
                 {"DX10", 83, 16, 3, bc5_decode},    {"DX10", 98, 16, 4, bc7_decode}};
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        made m;
        unsigned char blocks[64];
        put_dds_header(&m, 4, kinds[k].letters, 0, NULL, kinds[k].dxgi);
        for (uint32_t i = 0; i < sizeof blocks; i++)
            blocks[i] = (unsigned char)(i * 37 + 11 + k);
        put(&m, blocks, (size_t)4 * kinds[k].block_size);
        image i = decode_made(&m, IMAGE_CODEC_DDS);
        assert_int_equal(i.channel_count, kinds[k].channel_count);
        for (uint32_t y = 0; y < HEIGHT; y++)
            for (uint32_t x = 0; x < WIDTH; x++) {
                unsigned char tile[64];
                kinds[k].decode(blocks + (y / 4 * 2 + x / 4) * kinds[k].block_size, tile);
                const unsigned char *expected = tile + 4 * (y % 4 * 4 + x % 4);
                const uint8_t *texel = (const uint8_t *)i.pixels + kinds[k].channel_count * (y * WIDTH + x);
                assert_memory_equal(texel, expected,
                                    kinds[k].decode == bc5_decode ? 2 : kinds[k].channel_count);
                if (kinds[k].decode != bc5_decode)
                    continue;
                /* a direction of length 1, where x and y leave room for z */
                const double nx = texel[0] / 127.5 - 1.0, ny = texel[1] / 127.5 - 1.0,
                             nz = texel[2] / 127.5 - 1.0;
                const double square = fmax(1.0 - nx * nx - ny * ny, 0.0);
                assert_true(fabs(nz - sqrt(square)) < 0.005);
            }
        image_destroy(&i);
    }
}

static void dds_with_uncompressed_texels(void **state)
{
    (void)state;
    static const struct {
        uint32_t flags, bits, masks[4], dxgi, channel_count, tolerance;
        int alpha;
    } kinds[] = {{0x41, 32, {0xff0000, 0xff00, 0xff, 0xff000000}, 0, 4, 0, 200},
                 {0x40, 32, {0xff0000, 0xff00, 0xff, 0}, 0, 3, 0, -1},
                 {0x40, 24, {0xff0000, 0xff00, 0xff, 0}, 0, 3, 0, -1},
                 {0x40, 16, {0x7c00, 0x3e0, 0x1f, 0}, 0, 3, 4, -1},
                 {0x20000, 8, {0xff, 0, 0, 0}, 0, 1, 0, -1},
                 {4, 32, {0}, 87, 4, 0, 200}};
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        made m;
        put_dds_header(&m, kinds[k].flags, kinds[k].dxgi ? "DX10" : "\0\0\0\0", kinds[k].bits, kinds[k].masks,
                       kinds[k].dxgi);
        for (uint32_t t = 0; t < WIDTH * HEIGHT; t++) {
            unsigned char word[4];
            const size_t size = make_word(kinds[k].bits, t % WIDTH, t / WIDTH, 200, word);
            put(&m, word, size);
        }
        image i = decode_made(&m, IMAGE_CODEC_DDS);
        expect_colors(&i, kinds[k].channel_count, kinds[k].tolerance, kinds[k].alpha);
        image_destroy(&i);
    }
}

/* 2 x 2 blocks of halves, cropped to 7 x 5 texels. */
static void dds_with_blocks_of_halves(void **state)
{
    (void)state;
    static const struct {
        uint32_t dxgi;
        block_decode *decode;
    } kinds[] = {{95, bc6h_decode}, {96, bc6h_signed_decode}};
    for (size_t k = 0; k < 2; k++) {
        made m;
        unsigned char blocks[64];
        put_dds_header(&m, 4, "DX10", 0, NULL, kinds[k].dxgi);
        for (uint32_t i = 0; i < sizeof blocks; i++)
            blocks[i] = (unsigned char)(i * 37 + 11);
        put(&m, blocks, sizeof blocks);
        image i;
        assert_int_equal(image_decode(m.bytes, m.size, "a", NULL, &i, NULL), FACET_OK);
        assert_int_equal(i.type, IMAGE_F16);
        assert_int_equal(i.channel_count, 3);
        assert_false(i.is_srgb);
        for (uint32_t y = 0; y < HEIGHT; y++)
            for (uint32_t x = 0; x < WIDTH; x++) {
                uint16_t tile[64];
                kinds[k].decode(blocks + (y / 4 * 2 + x / 4) * 16, tile);
                assert_memory_equal((const uint16_t *)i.pixels + 3 * (y * WIDTH + x),
                                    tile + 4 * (y % 4 * 4 + x % 4), 3 * sizeof *tile);
            }
        image_destroy(&i);
    }
}

/* Signed directions have the codes of unsigned ones. */
static void dds_with_signed_normals(void **state)
{
    (void)state;
    made m;
    put_dds_header(&m, 4, "BC5S", 0, NULL, 0);
    for (int i = 0; i < 4; i++) /* x = 1, y = -127/127 in all texels */
        put(&m, (unsigned char[16]){0x7f, 0x7f, 0, 0, 0, 0, 0, 0, 0x81, 0x81}, 16);
    image i = decode_made(&m, IMAGE_CODEC_DDS);
    assert_int_equal(i.channel_count, 3);
    for (uint32_t t = 0; t < WIDTH * HEIGHT; t++)
        assert_memory_equal((const uint8_t *)i.pixels + 3 * t, ((uint8_t[3]){255, 0, 128}), 3);
    image_destroy(&i);
}

static void dds_with_floats(void **state)
{
    (void)state;
    static const struct {
        const char *letters;
        uint32_t dxgi, size, channel_count;
    } kinds[] = {
        {"DX10", 2, 4, 4}, {"DX10", 6, 4, 3}, {"DX10", 10, 2, 4}, {"q\0\0\0", 0, 2, 4}, {"t\0\0\0", 0, 4, 4}};
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        made m;
        put_dds_header(&m, 4, kinds[k].letters, 0, NULL, kinds[k].dxgi);
        for (uint32_t c = 0; c < WIDTH * HEIGHT * kinds[k].channel_count; c++) {
            const float value = c == 5 ? INFINITY : 0.25f * (float)c - 1.0f;
            uint32_t bits;
            memcpy(&bits, &value, sizeof bits);
            /* quarters up to 64 are exact in halves */
            const unsigned half = half_from_float(value);
            put(&m,
                kinds[k].size == 4 ? (unsigned char[4]){bits & 255, bits >> 8 & 255, bits >> 16 & 255,
                                                        (unsigned char)(bits >> 24)}
                                   : (unsigned char[4]){half & 255, (unsigned char)(half >> 8)},
                kinds[k].size);
        }
        image i;
        assert_int_equal(image_decode(m.bytes, m.size, "a", NULL, &i, NULL), FACET_OK);
        assert_int_equal(i.type, IMAGE_F32);
        assert_int_equal(i.channel_count, kinds[k].channel_count);
        assert_false(i.is_srgb);
        for (uint32_t c = 0; c < WIDTH * HEIGHT * kinds[k].channel_count; c++) {
            const float value = ((const float *)i.pixels)[c];
            assert_true(c == 5 ? isfinite(value) : value == 0.25f * (float)c - 1.0f);
        }
        image_destroy(&i);
        m.size -= kinds[k].size; /* a component is missing */
        facet_error error;
        assert_int_equal(image_decode(m.bytes, m.size, "a", NULL, &i, &error), FACET_ERROR_INVALID);
    }
}

static void unsupported_dds_kinds_are_named(void **state)
{
    (void)state;
    made m;
    image i;
    facet_error error;
    put_dds_header(&m, 4, "DX10", 0, NULL, 26);
    put(&m, (unsigned char[64]){0}, 64);
    assert_int_equal(image_decode(m.bytes, m.size, "a", NULL, &i, &error), FACET_ERROR_UNSUPPORTED);
    assert_non_null(strstr(error.message, "a: DDS: texels of DXGI format 26 are not read"));
    put_dds_header(&m, 4, "UYVY", 0, NULL, 0);
    assert_int_equal(image_decode(m.bytes, m.size, "a", NULL, &i, &error), FACET_ERROR_UNSUPPORTED);
    assert_non_null(strstr(error.message, "\"UYVY\""));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tga_is_read_in_every_row_and_column_order),
        cmocka_unit_test(tga_runs_and_unused_alpha),
        cmocka_unit_test(bmp_with_direct_colors),
        cmocka_unit_test(bmp_with_palettes),
        cmocka_unit_test(bmp_runs),
        cmocka_unit_test(gif_of_a_known_example),
        cmocka_unit_test(gif_with_long_codes),
        cmocka_unit_test(gif_frames_are_placed_on_the_canvas),
        cmocka_unit_test(gif_sizes_are_checked),
        cmocka_unit_test(dds_with_blocks),
        cmocka_unit_test(dds_with_uncompressed_texels),
        cmocka_unit_test(dds_with_blocks_of_halves),
        cmocka_unit_test(dds_with_signed_normals),
        cmocka_unit_test(dds_with_floats),
        cmocka_unit_test(unsupported_dds_kinds_are_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
