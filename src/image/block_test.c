/* block_test.c - decoders of blocks: interpolation against real numbers, random bits against another decoder. */
#include "image/image_test.h"

#include <math.h>

#include "image/block.h"
#include "image/half.h"
#include "tests/support/support.h"

enum { BLOCK_COUNT = 4096 };

/* Random bits, the same in every run. BC7: all modes in turn, of which random bits seldom have the last. */
static void make_block(uint32_t *random, uint32_t number, bool is_bc7, unsigned char block[16])
{
    for (int i = 0; i < 16; i++) {
        lcg_next(random);
        block[i] = (unsigned char)(*random >> 24);
    }
    if (is_bc7)
        block[0] = (unsigned char)((unsigned)block[0] << (number % 8 + 1) | 1u << number % 8);
}

/* FNV-1a of the decoded tiles. */
static uint64_t hash_blocks(block_decode *decode, bool is_bc7, size_t tile_size)
{
    uint64_t hash = 0xcbf29ce484222325u;
    uint32_t random = 1;
    for (uint32_t n = 0; n < BLOCK_COUNT; n++) {
        unsigned char block[16];
        float tile[TILE_TEXELS * TILE_CHANNELS];
        make_block(&random, n, is_bc7, block);
        decode(block, tile);
        for (size_t i = 0; i < tile_size; i++)
            hash = (hash ^ ((const unsigned char *)tile)[i]) * 0x100000001b3u;
    }
    return hash;
}

/* Each texel of these blocks equals the one that Mesa 22.3's software renderer returns (glGetTexImage). */
static void random_blocks_decode_as_in_mesa(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        block_decode *decode;
        size_t channel_size;
        uint64_t hash;
    } cases[] = {
        {"BC6H", bc6h_decode, 2, 0x3e02ec27abe166e2u},
        {"signed BC6H", bc6h_signed_decode, 2, 0x4fba6d402be3d89eu},
        {"BC7", bc7_decode, 1, 0x5a706e821d7acf3eu},
        {"ETC2", etc2_rgb_decode, 1, 0x05595593ddf62fe9u},
        {"ETC2 with 1-bit alpha", etc2_rgb_a1_decode, 1, 0x226d62c4a2eeaf57u},
        {"ETC2 with alpha", etc2_rgba_decode, 1, 0x2d0d968054eeb401u},
        {"EAC R11", eac_r11_decode, 2, 0x08ae4e6f05d7acd1u},
        {"EAC RG11", eac_rg11_decode, 2, 0x24cc580b1dc61e53u},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        uint64_t hash = hash_blocks(cases[k].decode, cases[k].decode == bc7_decode,
                                    cases[k].channel_size * TILE_TEXELS * TILE_CHANNELS);
        if (hash != cases[k].hash)
            fail_msg("%s: 0x%016llx", cases[k].name, (unsigned long long)hash);
    }
}

/* The value of BC4's index, in real numbers (KDF, "RGTC"). */
static double interpolate(int first, int second, bool is_larger, unsigned index, int lowest, int highest)
{
    if (index < 2)
        return index ? second : first;
    if (is_larger)
        return ((8.0 - index) * first + (index - 1.0) * second) / 7.0;
    if (index < 6)
        return ((6.0 - index) * first + (index - 1.0) * second) / 5.0;
    return index == 6 ? lowest : highest;
}

static void channels_are_nearest_to_the_exact_value(void **state)
{
    (void)state;
    uint32_t random = 7;
    for (uint32_t n = 0; n < BLOCK_COUNT; n++) {
        unsigned char block[16], codes[64];
        float values[64];
        make_block(&random, n, false, block);
        if (n % 64 == 0)
            block[0] = 0x81, block[1] = 0x80; /* -127 and -128, both -1 */
        bc5_decode(block, codes);
        bc5_signed_decode(block, values);
        for (unsigned c = 0; c < 2; c++) {
            const unsigned char *b = block + 8 * c;
            const int s0 = (signed char)b[0], s1 = (signed char)b[1];
            for (unsigned i = 0; i < TILE_TEXELS; i++) {
                unsigned index = (unsigned)(load_u64_le(b) >> (16 + 3 * i) & 7);
                double real = interpolate(b[0], b[1], b[0] > b[1], index, 0, 255);
                assert_true(fabs(real - codes[4 * i + c]) <= 0.5);
                double signed_real =
                    interpolate(s0 < -127 ? -127 : s0, s1 < -127 ? -127 : s1, s0 > s1, index, -127, 127) /
                    127;
                assert_true(fabs(signed_real - (double)values[4 * i + c]) < 1e-6);
            }
        }
        assert_int_equal(codes[2], 0);
        assert_int_equal(codes[3], 255);
    }
}

/* Colors of BC1 are within half a code of exact interpolation between codes widened by repetition. */
static void colors_are_nearest_to_the_exact_value(void **state)
{
    (void)state;
    uint32_t random = 3;
    for (uint32_t n = 0; n < BLOCK_COUNT; n++) {
        unsigned char block[16], rgb[64], rgba[64], bc2[64], bc3[64];
        make_block(&random, n, false, block);
        bc1_rgb_decode(block + 8, rgb);
        bc1_rgba_decode(block + 8, rgba);
        bc2_decode(block, bc2);
        bc3_decode(block, bc3);
        unsigned codes[2] = {block[8] | (unsigned)block[9] << 8, block[10] | (unsigned)block[11] << 8};
        const bool has_four = codes[0] > codes[1];
        for (unsigned i = 0; i < TILE_TEXELS; i++) {
            unsigned index = (unsigned)(load_u64_le(block + 8) >> (32 + 2 * i) & 3);
            const double four[4] = {0, 1, 1.0 / 3, 2.0 / 3}, three[3] = {0, 1, 0.5};
            static const unsigned char shifts[3] = {11, 5, 0}, bits[3] = {5, 6, 5};
            for (unsigned c = 0; c < 3; c++) {
                double ends[2];
                for (int e = 0; e < 2; e++) {
                    unsigned code = codes[e] >> shifts[c] & ((1u << bits[c]) - 1);
                    ends[e] = (double)(code << (8 - bits[c]) | code >> (2 * bits[c] - 8));
                }
                double with_four = ends[0] + four[index] * (ends[1] - ends[0]);
                double real = has_four     ? with_four
                              : index == 3 ? 0
                                           : ends[0] + three[index] * (ends[1] - ends[0]);
                assert_true(fabs(real - rgb[4 * i + c]) <= 0.5);
                assert_int_equal(rgb[4 * i + c], rgba[4 * i + c]);
                assert_true(fabs(with_four - bc2[4 * i + c]) <= 0.5);
                assert_int_equal(bc2[4 * i + c], bc3[4 * i + c]);
            }
            assert_int_equal(rgb[4 * i + 3], 255);
            assert_int_equal(rgba[4 * i + 3], has_four || index < 3 ? 255 : 0);
            assert_int_equal(bc2[4 * i + 3], 17 * (load_u64_le(block) >> 4 * i & 15));
        }
    }
}

/* EAC of 11 signed bits: base * 8 + modifier * multiplier * 8, here of hand-made blocks. */
static void signed_eac_decodes_known_blocks(void **state)
{
    (void)state;
    /* base, multiplier and table, 16 indices: all 0 */
    static const struct {
        unsigned char base, control;
        double value;
    } cases[] = {{0, 0x10, -24.0 / 1023}, {64, 0x00, 509.0 / 1023},   {0x80, 0xf0, -1.0},
                 {0x81, 0x1d, -1.0},      {127, 0x2d, 1000.0 / 1023}, {0xff, 0x0d, -9.0 / 1023}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        unsigned char block[16] = {cases[k].base, cases[k].control};
        float tile[64];
        eac_r11_signed_decode(block, tile);
        for (int i = 0; i < TILE_TEXELS; i++)
            if (!(fabs((double)tile[4 * i] - cases[k].value) < 1e-6))
                fail_msg("case %zu: %.9g is not %.9g", k, (double)tile[4 * i], cases[k].value);
    }
}

/* A sampler that decodes sRGB widens ends otherwise: results differ by one code at most, and alpha does not. */
static void uastc_for_srgb_differs_by_one_code_at_most(void **state)
{
    (void)state;
    uint32_t random = 11;
    int differing = 0;
    for (uint32_t n = 0; n < BLOCK_COUNT; n++) {
        unsigned char block[16], linear[64], srgb[64];
        make_block(&random, n, false, block);
        uastc_decode(block, linear);
        uastc_srgb_decode(block, srgb);
        for (int i = 0; i < 64; i++) {
            int difference = abs(linear[i] - srgb[i]);
            assert_true(difference <= (i % 4 < 3));
            differing += difference;
        }
    }
    assert_true(differing > 1000);
}

static void reserved_blocks_decode_to_a_defined_color(void **state)
{
    (void)state;
    unsigned char block[16] = {0x45}, tile[64]; /* UASTC's mode 19 */
    uastc_decode(block, tile);
    for (int i = 0; i < 64; i++)
        assert_int_equal(tile[i], i % 4 == 1 ? 0 : 255);
    memset(block, 0xff, sizeof block);
    block[0] = 0;
    bc7_decode(block, tile);
    for (int i = 0; i < 64; i++)
        assert_int_equal(tile[i], 0);
    for (unsigned mode = 0x13; mode < 32; mode += 4) {
        uint16_t halfs[64];
        block[0] = (unsigned char)mode;
        bc6h_decode(block, halfs);
        for (int i = 0; i < 64; i++)
            assert_int_equal(halfs[i], i % 4 < 3 ? 0 : 0x3c00);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_blocks_decode_as_in_mesa),
        cmocka_unit_test(channels_are_nearest_to_the_exact_value),
        cmocka_unit_test(colors_are_nearest_to_the_exact_value),
        cmocka_unit_test(signed_eac_decodes_known_blocks),
        cmocka_unit_test(uastc_for_srgb_differs_by_one_code_at_most),
        cmocka_unit_test(reserved_blocks_decode_to_a_defined_color),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
