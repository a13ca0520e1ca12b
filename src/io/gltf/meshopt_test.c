/* meshopt_test.c - streams of the reference encoder, of the specification, and broken ones. */
#include "io/gltf/meshopt.h"
#include "tests/support/support.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/* ---- testdata/meshopt.bin, by make_meshopt.mjs beside it ---- */

typedef struct record {
    meshopt_stream stream;
    const uint8_t *decoded; /* NULL: by attribute_word() */
} record;

typedef struct records {
    uint8_t *file;
    record items[256];
    size_t count;
} records;

static uint32_t load_u32(const uint8_t *p)
{
    return (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
}

static int read_records(void **state)
{
    records *all = calloc(1, sizeof *all);
    FILE *file = fopen("src/io/testdata/meshopt.bin", "rb");
    const size_t room = 1 << 18;
    if (!all || !file || !(all->file = malloc(room)))
        return -1;
    size_t size = fread(all->file, 1, room, file);
    fclose(file);
    for (size_t at = 0; at + 24 <= size; all->count++) {
        const uint8_t *p = all->file + at;
        const size_t stream_size = load_u32(p + 16);
        const size_t decoded_size = load_u32(p + 20);
        at += 24 + stream_size + decoded_size;
        if (at > size || all->count == sizeof all->items / sizeof *all->items)
            return -1;
        all->items[all->count] = (record){.stream = {.bytes = p + 24,
                                                     .size = stream_size,
                                                     .mode = (meshopt_mode)load_u32(p),
                                                     .filter = (meshopt_filter)load_u32(p + 4),
                                                     .count = load_u32(p + 8),
                                                     .stride = load_u32(p + 12)},
                                          .decoded = decoded_size ? p + 24 + stream_size : NULL};
    }
    *state = all;
    return all->count > 100 ? 0 : -1;
}

static int free_records(void **state)
{
    records *all = *state;
    free(all->file);
    free(all);
    return 0;
}

/* word() of make_meshopt.mjs */
static uint32_t attribute_word(uint32_t i, uint32_t channel)
{
    const uint32_t noise = (i * 64 + channel + 1) * UINT32_C(2654435761);
    switch (channel % 6) {
    case 0:
        return i * 257 * (channel + 1) + (noise >> 30);
    case 1:
        return (i * 37 & 0xffff) | (65535 - i * 91) << 16;
    case 2:
        return 0x3f800000 + (noise >> 20);
    case 3:
        return noise;
    case 4:
        return 0;
    default:
        return noise >> 24 < 9 ? noise : 0x01020304;
    }
}

/* Whether two decoded elements agree: exactly, or, where the specification leaves rounding open, within 1. */
static bool agree(const record *r, const uint8_t *decoded, size_t i)
{
    const meshopt_stream *s = &r->stream;
    const uint8_t *mine = decoded + i * s->stride;
    const uint8_t *theirs = r->decoded + i * s->stride;
    if (s->filter == MESHOPT_NONE || s->filter == MESHOPT_EXPONENTIAL)
        return memcmp(mine, theirs, s->stride) == 0;
    bool are_close = true;
    for (size_t k = 0; k < 4; k++) {
        int difference = mine[k] - theirs[k]; /* of bytes, whatever their sign is */
        if (s->stride == 8)
            difference = (mine[2 * k] | mine[2 * k + 1] << 8) - (theirs[2 * k] | theirs[2 * k + 1] << 8);
        const int around = s->stride == 8 ? 65535 : 255; /* -1 beside 0 */
        are_close &= abs(difference) <= 1 || abs(difference) == around;
    }
    return are_close;
}

static void check_record(const record *r, size_t number)
{
    const meshopt_stream *s = &r->stream;
    uint8_t *decoded = malloc(s->count * s->stride);
    assert_non_null(decoded);
    assert_null(meshopt_check(s));
    assert_true(meshopt_smallest_size(s) <= s->size);
    const char *problem = meshopt_decode(s, decoded);
    if (problem)
        fail_msg("record %zu: %s", number, problem);
    for (size_t i = 0; i < s->count; i++) {
        bool is_right = true;
        if (r->decoded)
            is_right = agree(r, decoded, i);
        else
            for (size_t c = 0; c < s->stride / 4; c++)
                is_right &=
                    load_u32(decoded + i * s->stride + 4 * c) == attribute_word((uint32_t)i, (uint32_t)c);
        if (!is_right)
            fail_msg("record %zu: mode %d, filter %d, %zu elements of %zu bytes: element %zu", number,
                     (int)s->mode, (int)s->filter, s->count, s->stride, i);
    }
    free(decoded);
}

static void streams_of_the_reference_encoder_are_decoded(void **state)
{
    const records *all = *state;
    bool has_version[2] = {false, false};
    unsigned modes = 0;
    unsigned filters = 0;
    for (size_t i = 0; i < all->count; i++) {
        const meshopt_stream *s = &all->items[i].stream;
        check_record(&all->items[i], i);
        modes |= 1u << s->mode;
        filters |= 1u << s->filter;
        if (s->mode == MESHOPT_ATTRIBUTES)
            has_version[s->bytes[0] & 1] = true;
    }
    assert_int_equal(modes, 7);
    assert_int_equal(filters, 31);
    assert_true(has_version[0] && has_version[1]);
}

/* ---- by hand ---- */

/* Appendix A, channel mode 0: a group of 4 bits with two values that do not fit. */
static void the_example_of_the_specification_is_decoded(void **state)
{
    (void)state;
    static const uint8_t group[10] = {0x17, 0x5f, 0xf0, 0xbc, 0x77, 0xa9, 0x21, 0x00, 0x34, 0xb5};
    static const int deltas[16] = {-1, -4, -3, 26, -91, 0, -6, 6, -4, -4, 5, -5, 1, -1, 0, 0};
    uint8_t bytes[1 + 11 + 3 + 32] = {0xa0, 2 /* 4 bits */};
    memcpy(bytes + 2, group, sizeof group); /* the other planes: a byte for 0 bits */
    bytes[sizeof bytes - 4] = 100;          /* the first byte of the element before the first */
    const meshopt_stream s = {.bytes = bytes, .size = sizeof bytes, .count = 16, .stride = 4};
    uint8_t out[64];
    assert_null(meshopt_decode(&s, out));
    int value = 100;
    for (int i = 0; i < 16; i++) {
        value += deltas[i];
        assert_int_equal(out[4 * i], value & 255);
        assert_int_equal(out[4 * i + 1] | out[4 * i + 2] | out[4 * i + 3], 0);
    }
}

/* Appendix A, mode 2: each number moves one of two positions. */
static void indices_move_two_positions(void **state)
{
    (void)state;
    /* +10 of the first, +3 of the second, -1 of the first, +255 of the second: 2 bytes */
    static const uint8_t bytes[] = {0xd1, 40, 13, 2, 0xfd, 0x07, 0, 0, 0, 0};
    const meshopt_stream s = {
        .bytes = bytes, .size = sizeof bytes, .mode = MESHOPT_INDICES, .count = 4, .stride = 2};
    uint8_t out[8];
    static const uint8_t expected[8] = {10, 0, 3, 0, 9, 0, 2, 1};
    assert_null(meshopt_decode(&s, out));
    assert_memory_equal(out, expected, sizeof out);
}

static meshopt_stream triangles(const uint8_t *bytes, size_t size, size_t count)
{
    return (meshopt_stream){
        .bytes = bytes, .size = size, .mode = MESHOPT_TRIANGLES, .count = 3 * count, .stride = 2};
}

/* Appendix A, mode 1: a separate triangle, one on its last edge, and references to edges that do not
 * exist. */
static void triangles_share_edges(void **state)
{
    (void)state;
    uint8_t bytes[1 + 2 + 16] = {0xe1, 0xf0, 0x00};
    meshopt_stream s = triangles(bytes, sizeof bytes, 2);
    uint8_t out[12];
    static const uint8_t expected[12] = {0, 0, 1, 0, 2, 0, 0, 0, 2, 0, 3, 0};
    assert_null(meshopt_decode(&s, out));
    assert_memory_equal(out, expected, sizeof out); /* edge (a, c) of 0 1 2, and the next vertex */
    bytes[2] = 0x30;                                /* three edges are there: 0, 1, 2 */
    assert_non_null(meshopt_decode(&s, out));
    bytes[2] = 0x04; /* a fourth vertex back */
    assert_non_null(meshopt_decode(&s, out));
    bytes[2] = 0x00;
    bytes[3 + 15] = 1; /* reserved */
    assert_non_null(meshopt_decode(&s, out));
    bytes[3 + 15] = 0;
    bytes[3 + 4] = 0x0f;
    assert_non_null(meshopt_decode(&s, out));
}

/* ---- filters ---- */

/* Appendix B's formulas, in double. */
static void octahedral_vectors_have_unit_length(void **state)
{
    (void)state;
    for (int bits = 4; bits <= 16; bits++) {
        const int one = (1 << (bits - 1)) - 1;
        for (int k = 0; k < 500; k++) {
            const int in_x = k * 7919 % (2 * one + 1) - one;
            const int in_y = k * 104729 % (2 * one + 1) - one;
            union { /* bytes that may be read as halves */
                int16_t halves[4];
                uint8_t bytes[8];
            } e = {.halves = {(int16_t)in_x, (int16_t)in_y, (int16_t)one, 77}};
            meshopt_apply_filter(MESHOPT_OCTAHEDRAL, e.bytes, 1, 8);
            double x = (double)in_x / one;
            double y = (double)in_y / one;
            const double z = 1 - fabs(x) - fabs(y);
            if (z < 0) {
                x -= copysign(-z, x);
                y -= copysign(-z, y);
            }
            const double scale = 32767 / sqrt(x * x + y * y + z * z);
            assert_true(fabs(e.halves[0] - x * scale) < 0.51);
            assert_true(fabs(e.halves[1] - y * scale) < 0.51);
            assert_true(fabs(e.halves[2] - z * scale) < 0.51);
            assert_int_equal(e.halves[3], 77);
        }
    }
}

static void exponential_floats_are_exact(void **state)
{
    (void)state;
    for (int e = -100; e <= 100; e += 4)
        for (int m = -8388608; m < 8388608; m += 524287) {
            union {
                uint32_t word;
                float value;
                uint8_t bytes[4];
            } u = {.word = (uint32_t)e << 24 | ((uint32_t)m & 0xffffff)};
            meshopt_apply_filter(MESHOPT_EXPONENTIAL, u.bytes, 1, 4);
            assert_true((double)u.value == ldexp(m, e));
        }
}

static void colors_of_all_precisions(void **state)
{
    (void)state;
    for (int bits = 2; bits <= 16; bits++) {
        const int all = (1 << bits) - 1;
        union {
            uint16_t halves[4];
            uint8_t bytes[8];
        } e = {.halves = {(uint16_t)all, 0, 0, (uint16_t)all}}; /* white, opaque */
        meshopt_apply_filter(MESHOPT_COLOR, e.bytes, 1, 8);
        for (int k = 0; k < 4; k++)
            assert_int_equal(e.halves[k], 65535);
        /* R = Y + Co - Cg, G = Y + Cg, B = Y - Co - Cg: all of R, none of G and B would be Y = 1/4, Co = 1/2,
         * Cg = -1/4 */
        const int quarter = (all + 1) / 4;
        e.halves[0] = (uint16_t)quarter;
        e.halves[1] = (uint16_t)(2 * quarter - 1);
        e.halves[2] = (uint16_t)-quarter;
        e.halves[3] = (uint16_t)(all / 2 + 1); /* the mark alone: alpha 0 */
        meshopt_apply_filter(MESHOPT_COLOR, e.bytes, 1, 8);
        assert_int_equal(e.halves[0], 65535);
        assert_int_equal(e.halves[1], 0);
        assert_true(abs(e.halves[2] * all - 65535) <= all); /* 1 of all */
        assert_int_equal(e.halves[3], 0);
    }
}

/* No element leads to undefined behavior in C, and unit vectors stay unit. */
static void filters_take_any_bytes(void **state)
{
    (void)state;
    static const meshopt_filter filters[] = {MESHOPT_OCTAHEDRAL, MESHOPT_QUATERNION, MESHOPT_EXPONENTIAL,
                                             MESHOPT_COLOR};
    uint8_t *bytes = malloc(8 * 4096);
    assert_non_null(bytes);
    uint32_t random = 1;
    for (int f = 0; f < 4; f++)
        for (size_t stride = 4; stride <= 8; stride += 4) {
            if (filters[f] == MESHOPT_QUATERNION && stride == 4)
                continue;
            for (size_t i = 0; i < 8 * 4096; i++) {
                lcg_next(&random);
                bytes[i] = i < 64 ? 0 : i < 128 ? 128 : (uint8_t)(random >> 24);
            }
            meshopt_apply_filter(filters[f], bytes, 4096, stride);
        }
    free(bytes);
}

/* ---- invalid streams ---- */

/* A copy without padding, so that a sanitizer detects reads behind it. */
static const char *decode_copy(const meshopt_stream *stream, size_t size, size_t changed, uint8_t value,
                               uint8_t *out)
{
    uint8_t *copy = malloc(size + !size);
    assert_non_null(copy);
    memcpy(copy, stream->bytes, size);
    if (changed < size)
        copy[changed] = value;
    meshopt_stream s = *stream;
    s.bytes = copy;
    s.size = size;
    const char *problem = meshopt_decode(&s, out);
    free(copy);
    return problem;
}

static void streams_of_another_length_are_refused(void **state)
{
    const records *all = *state;
    for (size_t i = 0; i < all->count; i += 3) {
        const meshopt_stream *s = &all->items[i].stream;
        uint8_t *out = malloc((s->count + 256) * s->stride);
        assert_non_null(out);
        for (size_t size = 0; size < s->size; size += 1 + s->size / 300)
            if (!decode_copy(s, size, SIZE_MAX, 0, out))
                fail_msg("record %zu of %zu bytes is read from %zu", i, s->size, size);
        meshopt_stream longer = *s;
        uint8_t *bytes = calloc(1, s->size + 1);
        assert_non_null(bytes);
        memcpy(bytes, s->bytes, s->size);
        longer.bytes = bytes;
        longer.size++;
        assert_non_null(meshopt_decode(&longer, out));
        longer = *s;
        longer.count += 256; /* in attributes, the rest of a block may take no bytes */
        if (s->mode != MESHOPT_TRIANGLES && !meshopt_decode(&longer, out))
            fail_msg("record %zu is read as %zu elements instead of %zu", i, longer.count, s->count);
        free(bytes);
        free(out);
    }
}

static void damaged_streams_do_no_harm(void **state)
{
    const records *all = *state;
    uint32_t random = 7;
    for (size_t i = 0; i < all->count; i++) {
        const meshopt_stream *s = &all->items[i].stream;
        uint8_t *out = malloc(s->count * s->stride);
        assert_non_null(out);
        for (int k = 0; k < 200; k++) {
            lcg_next(&random);
            size_t place = (random >> 8) % s->size;
            lcg_next(&random);
            decode_copy(s, s->size, place, (uint8_t)(random >> 24), out);
        }
        assert_non_null(decode_copy(s, s->size, 0, 0x7f, out)); /* the header */
        free(out);
    }
}

static void impossible_sizes_are_refused(void **state)
{
    (void)state;
    static const uint8_t header[2] = {0xa0, 0xa1};
    for (int version = 0; version < 2; version++)
        for (size_t stride = 4; stride <= 256; stride += 4) {
            meshopt_stream s = {.bytes = header + version, .size = 1, .count = 1000000, .stride = stride};
            assert_true(s.count * stride / meshopt_smallest_size(&s) <= 1024);
            s.count = SIZE_MAX / 256;
            assert_true(meshopt_smallest_size(&s) > SIZE_MAX / 256 / 1024);
        }
    meshopt_stream s = {.mode = MESHOPT_TRIANGLES, .count = 3000000, .stride = 4};
    assert_int_equal(meshopt_smallest_size(&s), 1 + 1000000 + 16);
    s.mode = MESHOPT_INDICES;
    assert_int_equal(meshopt_smallest_size(&s), 1 + 3000000 + 4);
    s.count = SIZE_MAX;
    assert_int_equal(meshopt_smallest_size(&s), SIZE_MAX);
}

static void modes_filters_and_strides_must_match(void **state)
{
    (void)state;
    static const struct {
        meshopt_mode mode;
        meshopt_filter filter;
        size_t count, stride;
        bool is_right;
    } cases[] = {
        {MESHOPT_ATTRIBUTES, MESHOPT_NONE, 1, 4, true},
        {MESHOPT_ATTRIBUTES, MESHOPT_NONE, 1, 256, true},
        {MESHOPT_ATTRIBUTES, MESHOPT_NONE, 1, 0, false},
        {MESHOPT_ATTRIBUTES, MESHOPT_NONE, 1, 260, false},
        {MESHOPT_ATTRIBUTES, MESHOPT_NONE, 1, 6, false},
        {MESHOPT_ATTRIBUTES, MESHOPT_OCTAHEDRAL, 1, 4, true},
        {MESHOPT_ATTRIBUTES, MESHOPT_OCTAHEDRAL, 1, 8, true},
        {MESHOPT_ATTRIBUTES, MESHOPT_OCTAHEDRAL, 1, 12, false},
        {MESHOPT_ATTRIBUTES, MESHOPT_QUATERNION, 1, 8, true},
        {MESHOPT_ATTRIBUTES, MESHOPT_QUATERNION, 1, 4, false},
        {MESHOPT_ATTRIBUTES, MESHOPT_COLOR, 1, 4, true},
        {MESHOPT_ATTRIBUTES, MESHOPT_COLOR, 1, 16, false},
        {MESHOPT_ATTRIBUTES, MESHOPT_EXPONENTIAL, 1, 12, true},
        {MESHOPT_TRIANGLES, MESHOPT_NONE, 3, 2, true},
        {MESHOPT_TRIANGLES, MESHOPT_NONE, 3, 4, true},
        {MESHOPT_TRIANGLES, MESHOPT_NONE, 4, 4, false},
        {MESHOPT_TRIANGLES, MESHOPT_NONE, 3, 1, false},
        {MESHOPT_TRIANGLES, MESHOPT_EXPONENTIAL, 3, 4, false},
        {MESHOPT_INDICES, MESHOPT_NONE, 4, 2, true},
        {MESHOPT_INDICES, MESHOPT_NONE, 4, 8, false},
        {MESHOPT_INDICES, MESHOPT_COLOR, 4, 4, false},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const meshopt_stream s = {.mode = cases[i].mode,
                                  .filter = cases[i].filter,
                                  .count = cases[i].count,
                                  .stride = cases[i].stride};
        assert_int_equal(meshopt_check(&s) == NULL, cases[i].is_right);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(streams_of_the_reference_encoder_are_decoded),
        cmocka_unit_test(the_example_of_the_specification_is_decoded),
        cmocka_unit_test(indices_move_two_positions),
        cmocka_unit_test(triangles_share_edges),
        cmocka_unit_test(octahedral_vectors_have_unit_length),
        cmocka_unit_test(exponential_floats_are_exact),
        cmocka_unit_test(colors_of_all_precisions),
        cmocka_unit_test(filters_take_any_bytes),
        cmocka_unit_test(streams_of_another_length_are_refused),
        cmocka_unit_test(damaged_streams_do_no_harm),
        cmocka_unit_test(impossible_sizes_are_refused),
        cmocka_unit_test(modes_filters_and_strides_must_match),
    };
    return cmocka_run_group_tests(tests, read_records, free_records);
}
