/* ktx1_write_test.c - KTX 1 files of cube maps: every byte, invalid sizes, failing allocations. */
#include "image/image_test.h"

#include <math.h>

#include "base/memory.h"
#include "image/codec.h"
#include "image/ktx_write.h"

enum { EDGE = 4, LEVELS = 3, FACES = 6 };

/* Faces of one number each, 2^(face - 3) at level 0, twice that at level 1 ..: exact in 10 and 11 bits. */
typedef struct cube_image {
    float texels[LEVELS][FACES][EDGE * EDGE * 3];
    facet_image_view views[LEVELS * FACES];
} cube_image;

static float value_of(int level, int face)
{
    return ldexpf(1.0f, face - 3 + level);
}

static void make(cube_image *p)
{
    for (int level = 0; level < LEVELS; level++)
        for (int face = 0; face < FACES; face++) {
            const uint32_t edge = EDGE >> level;
            for (uint32_t i = 0; i < 3 * edge * edge; i++)
                p->texels[level][face][i] = value_of(level, face);
            p->texels[level][face][0] = 0.0f; /* the first texel has no red */
            p->views[level * FACES + face] = (facet_image_view){.width = edge,
                                                                .height = edge,
                                                                .channel_count = 3,
                                                                .pixels = p->texels[level][face],
                                                                .row_stride_bytes = edge * 3 * sizeof(float)};
        }
}

static float small_float(uint32_t code, int digits)
{
    return ldexpf(1.0f + (float)(code & ((1u << digits) - 1)) / (float)(1u << digits),
                  (int)(code >> digits) - 15);
}

static void bytes_follow_the_specification(void **state)
{
    (void)state;
    static cube_image p;
    static const uint32_t words[] = {0x04030201, 0x8C3A, 4, 0x1907, 0x8C3A, 0x1907,
                                     EDGE,       EDGE,   0, 0,      FACES,  LEVELS};
    const char value[] = "1 2 3\n";
    unsigned char *bytes;
    size_t size, at = 64;
    facet_error error;
    make(&p);
    const ktx1_write_desc desc = {.level_count = LEVELS, .images = p.views, .key = "sh", .value = value};
    assert_int_equal(ktx1_write_cube(&desc, &bytes, &size, &error), FACET_OK);
    assert_memory_equal(bytes, "\xABKTX 11\xBB\r\n\x1A\n", 12);
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        assert_int_equal(load_u32_le(bytes + 12 + 4 * i), words[i]);
    /* 3 bytes of key, 6 of value, 3 to fill four */
    assert_int_equal(load_u32_le(bytes + 60), 16);
    assert_int_equal(load_u32_le(bytes + at), 9);
    assert_memory_equal(bytes + at + 4, "sh\0001 2 3\n\0\0\0", 12);
    at += 16;
    for (int level = 0; level < LEVELS; level++) {
        const uint32_t edge = EDGE >> level;
        assert_int_equal(load_u32_le(bytes + at), edge * edge * 4);
        at += 4;
        for (int face = 0; face < FACES; face++, at += (size_t)edge * edge * 4) {
            const uint32_t first = load_u32_le(bytes + at),
                           last = load_u32_le(bytes + at + (edge * edge - 1) * 4);
            assert_int_equal(first & 0x7FF, 0);
            if (edge > 1)
                assert_float_equal(small_float(last & 0x7FF, 6), value_of(level, face), 0.0);
            assert_float_equal(small_float(last >> 11 & 0x7FF, 6), value_of(level, face), 0.0);
            assert_float_equal(small_float(last >> 22, 5), value_of(level, face), 0.0);
        }
    }
    assert_int_equal(at, size);
    mem_free(bytes);
}

static void bytes_do_not_depend_on_threads(void **state)
{
    (void)state;
    static cube_image p;
    unsigned char *one, *three;
    size_t one_size, three_size;
    facet_error error;
    make(&p);
    ktx1_write_desc desc = {.level_count = LEVELS, .images = p.views, .thread_count = 1};
    assert_int_equal(ktx1_write_cube(&desc, &one, &one_size, &error), FACET_OK);
    desc.thread_count = 3;
    assert_int_equal(ktx1_write_cube(&desc, &three, &three_size, &error), FACET_OK);
    assert_int_equal(one_size, 64 + 3 * 4 + FACES * 4 * (16 + 4 + 1)); /* and no metadata */
    assert_int_equal(one_size, three_size);
    assert_memory_equal(one, three, one_size);
    mem_free(one);
    mem_free(three);
}

static void images_that_are_no_cube_map_are_refused(void **state)
{
    (void)state;
    static cube_image p;
    unsigned char *bytes;
    size_t size;
    facet_error error;
    make(&p);
    ktx1_write_desc desc = {.level_count = LEVELS + 1, .images = p.views};
    assert_int_equal(ktx1_write_cube(&desc, &bytes, &size, &error), FACET_ERROR_ARGUMENT);
    desc.level_count = 0;
    assert_int_equal(ktx1_write_cube(&desc, &bytes, &size, &error), FACET_ERROR_ARGUMENT);
    desc.level_count = LEVELS;
    p.views[8].width = 1;
    assert_int_equal(ktx1_write_cube(&desc, &bytes, &size, &error), FACET_ERROR_ARGUMENT);
    assert_non_null(strstr(error.message, "level 1, face 2"));
    assert_null(bytes);
    assert_int_equal(size, 0);
}

static void running_out_of_memory_leaks_nothing(void **state)
{
    (void)state;
    static cube_image p;
    unsigned char *bytes;
    size_t size;
    facet_error error;
    failing_allocator none = {.fail_at = 0};
    make(&p);
    const ktx1_write_desc desc = {
        .level_count = LEVELS, .images = p.views, .allocator = failing_allocator_get(&none)};
    assert_int_equal(ktx1_write_cube(&desc, &bytes, &size, &error), FACET_ERROR_MEMORY);
    assert_null(bytes);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bytes_follow_the_specification),
        cmocka_unit_test(bytes_do_not_depend_on_threads),
        cmocka_unit_test(images_that_are_no_cube_map_are_refused),
        cmocka_unit_test(running_out_of_memory_leaks_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
