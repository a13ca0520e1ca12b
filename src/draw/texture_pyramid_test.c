/* Tests of texture_pyramid.h: means in the right space, odd sizes, omitted levels. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "tests/support/support.h"
#include "draw/texture_pyramid.h"

static texture_tables tables;

static uint32_t next_random(uint32_t *random)
{
    lcg_next(random);
    return *random >> 16;
}

static image make_image(uint32_t width, uint32_t height, uint32_t channel_count, image_type type)
{
    image i;
    assert_int_equal(image_create(NULL, width, height, channel_count, type, &i, NULL), FACET_OK);
    i.is_srgb = true;
    return i;
}

static image make_noise(uint32_t width, uint32_t height, uint32_t channel_count, image_type type)
{
    image i = make_image(width, height, channel_count, type);
    uint32_t random = 1;
    size_t count = (size_t)width * height * channel_count;
    for (size_t k = 0; k < count; k++)
        if (type == IMAGE_U8)
            ((uint8_t *)i.pixels)[k] = (uint8_t)next_random(&random);
        else
            ((uint16_t *)i.pixels)[k] = (uint16_t)next_random(&random);
    return i;
}

static texture_pyramid make_pyramid(image i, uint32_t first_level, bool as_color)
{
    texture_pyramid p;
    assert_int_equal(
        texture_pyramid_create(&i, 0, i.width, i.height, first_level, as_color, &tables, NULL, &p, NULL),
        FACET_OK);
    assert_null(i.pixels);
    return p;
}

static void tables_invert_each_other(void **state)
{
    (void)state;
    for (uint32_t code = 0; code < 256; code++) {
        assert_int_equal(tables.color_from_16[tables.color16[code]], code);
        assert_int_equal(tables.data16[code], 257 * code);
    }
}

static void sizes_are_those_of_opengl(void **state)
{
    (void)state;
    assert_int_equal(texture_level_count(1, 1), 1);
    assert_int_equal(texture_level_count(2, 1), 2);
    assert_int_equal(texture_level_count(2048, 2048), 12);
    assert_int_equal(texture_level_count(3, 1000), 10);
    texture_pyramid p = make_pyramid(make_noise(37, 9, 3, IMAGE_U8), 0, true);
    assert_int_equal(p.level_count, 6);
    static const uint32_t sizes[6][2] = {{37, 9}, {18, 4}, {9, 2}, {4, 1}, {2, 1}, {1, 1}};
    for (int i = 0; i < 6; i++) {
        assert_int_equal(p.levels[i].width, sizes[i][0]);
        assert_int_equal(p.levels[i].height, sizes[i][1]);
    }
    texture_pyramid_destroy(&p);
}

static void constants_stay(void **state)
{
    (void)state;
    static const uint32_t sizes[][2] = {{1, 1}, {16, 16}, {17, 31}, {64, 1}, {1, 33}, {3, 2}, {127, 128}};
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++)
        for (uint32_t channel_count = 1; channel_count <= 4; channel_count++)
            for (uint32_t code = 0; code < 256; code += s == 2 ? 1 : 51)
                for (int as_color = 0; as_color < 2; as_color++) {
                    image i = make_image(sizes[s][0], sizes[s][1], channel_count, IMAGE_U8);
                    memset(i.pixels, (int)code, image_row_size(&i) * i.height);
                    texture_pyramid p = make_pyramid(i, 0, as_color);
                    for (uint32_t level = 0; level < p.level_count; level++) {
                        size_t count = (size_t)p.levels[level].width * p.levels[level].height * channel_count;
                        for (size_t k = 0; k < count; k++)
                            assert_int_equal(p.levels[level].texels[k], code);
                    }
                    texture_pyramid_destroy(&p);
                }
}

static void colors_are_averaged_in_linear_light(void **state)
{
    (void)state;
    for (uint32_t channel_count = 1; channel_count <= 4; channel_count++)
        for (int as_color = 0; as_color < 2; as_color++) {
            image i = make_image(8, 8, channel_count, IMAGE_U8);
            for (uint32_t y = 0; y < 8; y++)
                for (uint32_t x = 0; x < 8; x++)
                    memset((uint8_t *)i.pixels + (y * 8 + x) * channel_count, (x + y) % 2 ? 255 : 0,
                           channel_count);
            texture_pyramid p = make_pyramid(i, 0, as_color);
            for (uint32_t level = 1; level < 4; level++)
                for (uint32_t k = 0; k < channel_count; k++) {
                    bool is_alpha = channel_count % 2 == 0 && k == channel_count - 1;
                    assert_int_equal(p.levels[level].texels[k], as_color && !is_alpha ? 188 : 128);
                }
            texture_pyramid_destroy(&p);
        }
}

/* Sixteen-bit texels are linear once decoded: the mean of black and white is half way in linear light. */
static void sixteen_bits_stay(void **state)
{
    (void)state;
    for (int as_color = 0; as_color < 2; as_color++) {
        image i = make_image(4, 1, 2, IMAGE_U16);
        const uint16_t texels[8] = {0, 100, 65535, 301, 32768, 7, 32768, 8};
        memcpy(i.pixels, texels, sizeof texels);
        texture_pyramid p = make_pyramid(i, 0, as_color);
        uint16_t middle = as_color ? 14028 : 32768; /* 65535 ((32768 / 65535 + 0.055) / 1.055)^2.4 */
        const uint16_t level_1[4] = {32768, 201, middle, 8};
        assert_int_equal(((const uint16_t *)(const void *)p.levels[0].texels)[4], middle);
        assert_memory_equal(p.levels[1].texels, level_1, sizeof level_1);
        texture_pyramid_destroy(&p);
    }
}

/* The mean of what a texel covers, by exact areas. */
static double cover(const double *texels, uint32_t width, uint32_t height, uint32_t x, uint32_t y)
{
    uint32_t small_width = width > 1 ? width / 2 : 1;
    uint32_t small_height = height > 1 ? height / 2 : 1;
    double x0 = (double)x * width / small_width;
    double x1 = (double)(x + 1) * width / small_width;
    double y0 = (double)y * height / small_height;
    double y1 = (double)(y + 1) * height / small_height;
    double sum = 0.0;
    for (uint32_t j = 0; j < height; j++)
        for (uint32_t i = 0; i < width; i++) {
            double w = fmin(x1, i + 1.0) - fmax(x0, i);
            double h = fmin(y1, j + 1.0) - fmax(y0, j);
            if (w > 0.0 && h > 0.0)
                sum += w * h * texels[j * width + i];
        }
    return sum / ((x1 - x0) * (y1 - y0));
}

static void texels_are_means_of_what_they_cover(void **state)
{
    (void)state;
    static const uint32_t sizes[][2] = {{2, 2}, {3, 3}, {5, 4}, {4, 7}, {1, 9}, {11, 1}, {15, 13}, {6, 10}};
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
        uint32_t width = sizes[s][0];
        uint32_t height = sizes[s][1];
        image i = make_noise(width, height, 3, IMAGE_U8);
        double texels[15 * 13];
        for (uint32_t t = 0; t < width * height; t++)
            texels[t] = ((uint8_t *)i.pixels)[3 * t + 1] / 255.0;
        texture_pyramid p = make_pyramid(i, 0, false);
        for (uint32_t y = 0; y < p.levels[1].height; y++)
            for (uint32_t x = 0; x < p.levels[1].width; x++)
                assert_true(fabs(p.levels[1].texels[(y * p.levels[1].width + x) * 3 + 1] -
                                 255.0 * cover(texels, width, height, x, y)) <= 0.5 + 1e-2);
        texture_pyramid_destroy(&p);
    }
}

static void means_are_preserved(void **state)
{
    (void)state;
    static const uint32_t sizes[][2] = {{37, 23}, {101, 64}, {63, 63}, {1000, 333}, {129, 1}};
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
        texture_pyramid p = make_pyramid(make_noise(sizes[s][0], sizes[s][1], 1, IMAGE_U16), 0, false);
        double first = 0.0;
        for (uint32_t level = 0; level < p.level_count; level++) {
            const uint16_t *texels = (const uint16_t *)(const void *)p.levels[level].texels;
            size_t count = (size_t)p.levels[level].width * p.levels[level].height;
            double sum = 0.0;
            for (size_t k = 0; k < count; k++)
                sum += texels[k];
            if (level == 0)
                first = sum / (double)count;
            assert_true(fabs(sum / (double)count - first) <= 0.5 * level + 1e-6);
        }
        texture_pyramid_destroy(&p);
    }
}

static image take_channel(const image *from, uint32_t channel)
{
    image i = make_image(from->width, from->height, 1, from->type);
    size_t size = image_type_size(from->type);
    for (size_t k = 0; k < (size_t)from->width * from->height; k++)
        memcpy((uint8_t *)i.pixels + k * size,
               (const uint8_t *)from->pixels + (k * from->channel_count + channel) * size, size);
    return i;
}

/* Each channel is reduced independently, alpha as data, whatever loops a format and a size use. */
static void channels_are_independent(void **state)
{
    (void)state;
    static const uint32_t sizes[][2] = {{64, 32}, {2, 16}, {48, 20}, {33, 64}, {64, 31}, {1, 8}};
    for (uint32_t n = 0; n < 6 * 3 * 2 * 2; n++) {
        const uint32_t *size = sizes[n % 6];
        uint32_t channel_count = 2 + n / 6 % 3;
        image_type type = n / 18 % 2 ? IMAGE_U16 : IMAGE_U8;
        bool as_color = n / 36 > 0;
        image all = make_noise(size[0], size[1], channel_count, type);
        texture_pyramid one[4];
        for (uint32_t c = 0; c < channel_count; c++) {
            bool is_alpha = c == 3 || (c == 1 && channel_count == 2);
            one[c] = make_pyramid(take_channel(&all, c), 0, as_color && !is_alpha);
        }
        texture_pyramid p = make_pyramid(all, 0, as_color);
        size_t value = image_type_size(type);
        for (uint32_t level = 1; level < p.level_count; level++)
            for (size_t k = 0; k < (size_t)p.levels[level].width * p.levels[level].height * channel_count;
                 k++)
                assert_memory_equal(p.levels[level].texels + k * value,
                                    one[k % channel_count].levels[level].texels + k / channel_count * value,
                                    value);
        for (uint32_t c = 0; c < channel_count; c++)
            texture_pyramid_destroy(&one[c]);
        texture_pyramid_destroy(&p);
    }
}

/* Omitting levels does not change the others. */
static void levels_do_not_depend_on_the_first(void **state)
{
    (void)state;
    for (image_type type = IMAGE_U8; type <= IMAGE_U16; type++)
        for (int as_color = 0; as_color < 2; as_color++) {
            texture_pyramid all = make_pyramid(make_noise(100, 51, 4, type), 0, as_color);
            for (uint32_t first = 0; first < all.level_count; first++) {
                texture_pyramid some = make_pyramid(make_noise(100, 51, 4, type), first, as_color);
                assert_int_equal(some.first_level, first);
                for (uint32_t level = first; level < all.level_count; level++) {
                    assert_int_equal(some.levels[level].width, all.levels[level].width);
                    assert_memory_equal(some.levels[level].texels, all.levels[level].texels,
                                        (size_t)all.levels[level].width * all.levels[level].height * 4 *
                                            image_type_size(type));
                }
                texture_pyramid_destroy(&some);
            }
            texture_pyramid_destroy(&all);
        }
}

/* A decoder may provide level 2 instead of the full image. */
static void pyramids_start_at_any_level(void **state)
{
    (void)state;
    texture_pyramid all = make_pyramid(make_noise(64, 32, 3, IMAGE_U8), 0, true);
    for (uint32_t first = 2; first < all.level_count; first++) {
        image i = make_image(16, 8, 3, IMAGE_U8);
        memcpy(i.pixels, all.levels[2].texels, 16 * 8 * 3);
        texture_pyramid p;
        assert_int_equal(texture_pyramid_create(&i, 2, 64, 32, first, true, &tables, NULL, &p, NULL),
                         FACET_OK);
        assert_int_equal(p.level_count, all.level_count);
        for (uint32_t level = first; level < p.level_count; level++)
            for (size_t k = 0; k < (size_t)p.levels[level].width * p.levels[level].height * 3; k++)
                assert_true(abs(p.levels[level].texels[k] - all.levels[level].texels[k]) <= 1);
        texture_pyramid_destroy(&p);
    }
    texture_pyramid_destroy(&all);
}

static void data_without_red_are_known(void **state)
{
    (void)state;
    for (int is_16 = 0; is_16 < 2; is_16++)
        for (uint32_t channels = 1; channels <= 4; channels++) {
            image i = make_image(5, 3, channels, is_16 ? IMAGE_U16 : IMAGE_U8);
            for (size_t k = 0; k < (size_t)15 * channels; k++) { /* 4 codes of red, all of the others */
                unsigned value = k % channels ? 255 : 4;
                if (is_16)
                    ((uint16_t *)i.pixels)[k] = (uint16_t)(257 * value);
                else
                    ((uint8_t *)i.pixels)[k] = (uint8_t)value;
            }
            image one_red = make_image(5, 3, channels, i.type);
            memcpy(one_red.pixels, i.pixels, (size_t)15 * channels * (is_16 ? 2 : 1));
            ((uint8_t *)one_red.pixels)[(size_t)14 * channels * (is_16 ? 2 : 1) + (is_16 ? 1 : 0)] = 5;
            texture_pyramid without = make_pyramid(i, 0, false);
            texture_pyramid with = make_pyramid(one_red, 0, false);
            assert_true(without.lacks_red);
            assert_false(with.lacks_red);
            texture_pyramid_destroy(&without);
            texture_pyramid_destroy(&with);
        }
    texture_pyramid color = make_pyramid(make_image(1, 1, 3, IMAGE_U8), 0, true);
    assert_false(color.lacks_red);
    texture_pyramid_destroy(&color);
}

static void every_refused_block_is_an_error(void **state)
{
    (void)state;
    for (int count = 0;; count++) {
        image i = make_noise(9, 9, 4, IMAGE_U16);
        failing_allocator memory = {.fail_at = count};
        facet_allocator allocator = failing_allocator_get(&memory);
        texture_pyramid p;
        facet_result result = texture_pyramid_create(&i, 0, 9, 9, 0, true, &tables, &allocator, &p, NULL);
        assert_null(i.pixels);
        texture_pyramid_destroy(&p);
        assert_int_equal(memory.blocks, 0);
        if (result == FACET_OK) {
            assert_int_equal(count, 3);
            break;
        }
        assert_int_equal(result, FACET_ERROR_MEMORY);
    }
}

static texture_pyramid grow_pyramid(const image *source, uint32_t first_level, bool as_color)
{
    texture_pyramid p;
    texture_growth *g;
    image header = *source;
    header.pixels = NULL;
    assert_int_equal(texture_growth_create(&header, first_level, as_color, &tables, NULL, &p, &g, NULL),
                     FACET_OK);
    for (uint32_t y = 0; y < source->height; y++)
        texture_growth_add_row(g, (const char *)source->pixels + y * image_row_size(source));
    texture_growth_destroy(g);
    return p;
}

static void assert_same_levels(const texture_pyramid *a, const texture_pyramid *b)
{
    assert_int_equal(a->first_level, b->first_level);
    assert_int_equal(a->level_count, b->level_count);
    assert_int_equal(a->lacks_red, b->lacks_red);
    for (uint32_t level = a->first_level; level < a->level_count; level++) {
        const texture_level *l = &a->levels[level];
        assert_int_equal(l->width, b->levels[level].width);
        assert_int_equal(l->height, b->levels[level].height);
        assert_memory_equal(l->texels, b->levels[level].texels,
                            (size_t)l->width * l->height * a->channel_count * image_type_size(a->type));
    }
}

/* Adding row by row gives the same as the whole image. */
static void rows_give_the_same_pyramid(void **state)
{
    (void)state;
    static const uint32_t sizes[][2] = {{64, 32}, {100, 51}, {51, 100}, {17, 17},
                                        {1, 9},   {9, 1},    {2, 2},    {3, 1}};
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++)
        for (uint32_t channels = 1; channels <= 4; channels++)
            for (image_type type = IMAGE_U8; type <= IMAGE_U16; type++)
                for (int as_color = 0; as_color < 2; as_color++) {
                    const uint32_t level_count = texture_level_count(sizes[s][0], sizes[s][1]);
                    for (uint32_t first = 1; first < level_count; first++) {
                        image i = make_noise(sizes[s][0], sizes[s][1], channels, type);
                        texture_pyramid grown = grow_pyramid(&i, first, as_color);
                        texture_pyramid whole = make_pyramid(i, first, as_color);
                        assert_same_levels(&whole, &grown);
                        texture_pyramid_destroy(&whole);
                        texture_pyramid_destroy(&grown);
                    }
                }
}

static void a_growth_reports_every_refused_block(void **state)
{
    (void)state;
    const image header = {.width = 9, .height = 9, .channel_count = 4, .type = IMAGE_U16, .is_srgb = true};
    for (int count = 0;; count++) {
        failing_allocator memory = {.fail_at = count};
        facet_allocator allocator = failing_allocator_get(&memory);
        texture_pyramid p;
        texture_growth *g;
        facet_result result = texture_growth_create(&header, 1, true, &tables, &allocator, &p, &g, NULL);
        texture_growth_destroy(g);
        texture_pyramid_destroy(&p);
        assert_int_equal(memory.blocks, 0);
        if (result == FACET_OK) {
            assert_int_equal(count, 5);
            break;
        }
        assert_int_equal(result, FACET_ERROR_MEMORY);
        assert_null(g);
    }
}

static int prepare(void **state)
{
    (void)state;
    texture_tables_fill(&tables);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tables_invert_each_other),
        cmocka_unit_test(sizes_are_those_of_opengl),
        cmocka_unit_test(constants_stay),
        cmocka_unit_test(colors_are_averaged_in_linear_light),
        cmocka_unit_test(sixteen_bits_stay),
        cmocka_unit_test(texels_are_means_of_what_they_cover),
        cmocka_unit_test(means_are_preserved),
        cmocka_unit_test(channels_are_independent),
        cmocka_unit_test(levels_do_not_depend_on_the_first),
        cmocka_unit_test(pyramids_start_at_any_level),
        cmocka_unit_test(data_without_red_are_known),
        cmocka_unit_test(every_refused_block_is_an_error),
        cmocka_unit_test(rows_give_the_same_pyramid),
        cmocka_unit_test(a_growth_reports_every_refused_block),
    };
    return cmocka_run_group_tests(tests, prepare, NULL);
}
