/* environment_invalid_test.c - environments from files that are no environments, are damaged, hold values that
 * are no radiance, or need more memory than there is. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "ibl/environment_load_fixture.h"
#include "image/codec.h"

static void ktx2_textures_that_are_no_environment_are_refused(void **state)
{
    (void)state;
    static const unsigned char texels[12 * 4 * 4 * 4] = {0};
    static const struct {
        uint32_t width, height, layers, faces, levels;
        facet_result result;
        const char *words;
    } cases[] = {
        {4, 4, 2, 6, 1, FACET_ERROR_UNSUPPORTED, "KTX2: an array of 2 textures"},
        {4, 2, 3, 1, 1, FACET_ERROR_UNSUPPORTED, "KTX2: an array of 3 textures"},
        {4, 3, 0, 6, 1, FACET_ERROR_INVALID,
         "faceCount: 1, or 6 of a square image, was expected, not 6 of 4 x 3"},
        {4, 4, 0, 5, 1, FACET_ERROR_INVALID,
         "faceCount: 1, or 6 of a square image, was expected, not 5 of 4 x 4"},
        {4, 4, 0, 6, 9, FACET_ERROR_INVALID, "levelCount: 4 x 4 texels do not have 9 levels"},
        {4, 4, 0, 1, 1, FACET_ERROR_INVALID,
         "4 x 4 texels: an environment is 2:1 (equirectangular), 4:3 or 3:4"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        ktx2_test_file f = {.vk_format = 37,
                            .width = cases[k].width,
                            .height = cases[k].height,
                            .layers = cases[k].layers,
                            .faces = cases[k].faces,
                            .levels = cases[k].levels,
                            .model = 1,
                            .transfer = 1};
        f.bytes[0] = texels;
        f.sizes[0] = (size_t)4 * f.width * f.height * f.faces * (f.layers ? f.layers : 1);
        for (uint32_t i = 1; i < f.levels; i++)
            f.bytes[i] = texels;
        bytes b;
        b.data = ktx2_test_write(&f, &b.size);
        check_refused(b, NULL, cases[k].result, cases[k].words);
        free(b.data);
    }
    /* levels that are to be made of level 0: it is there */
    ktx2_test_file f = {.vk_format = 37, .width = 4, .height = 4, .faces = 6, .model = 1, .transfer = 1};
    f.bytes[0] = texels;
    f.sizes[0] = 6 * 64;
    bytes b;
    b.data = ktx2_test_write(&f, &b.size);
    facet_environment *e = load(b, FACET_LAYOUT_AUTO, NULL);
    assert_int_equal(get_info(e).width, 4);
    facet_environment_destroy(e);
    check_refused(b, &(facet_environment_desc){.max_size = 3}, FACET_ERROR_LIMIT,
                  "more than 3 along an edge");
    free(b.data);
}

/* Any end of a file is an error or an image, never a crash. */
static void truncated_files_fail_or_load(void **state)
{
    (void)state;
    cube c = make_cube(4);
    for (int k = 0; k < 3; k++) {
        bytes b = k == 0 ? encode_layout(&c, FACET_LAYOUT_CROSS_HORIZONTAL)
                         : encode_ktx2(&c, FACET_TEXEL_FORMAT_B10G11R11, k == 1 ? 0 : 3);
        for (size_t cut = 0; cut < b.size; cut++) {
            facet_environment *e = NULL;
            if (facet_environment_load_memory(b.data, cut, "cut", NULL, &e, NULL) == FACET_OK)
                facet_environment_destroy(e);
            else
                assert_null(e);
        }
        mem_free(b.data);
    }
    cube_destroy(&c);
}

/* Invalid texels are counted, reported once, and replaced. */
static void invalid_texels_are_replaced_and_reported_once(void **state)
{
    (void)state;
    image i = uniform_image(64, 32, 1.0f);
    set_texel(&i, 40, 20, INFINITY, -INFINITY, NAN); /* one texel, three times */
    set_texel(&i, 13, 9, 0.5f, -1e-20f, 2.0f);
    set_texel(&i, 14, 9, -0.0f, 0.0f, 2.0f); /* nothing wrong */
    set_texel(&i, 3, 31, 1e30f, 1.0f, 1.0f); /* finite */
    for (int k = 0; k < 2; k++) {
        bytes b;
        const char *const names[] = {"R", "G", "B"};
        const image_layer layer = {names, 3, i.pixels, image_row_size(&i), false, false};
        b = encode_pfm(&i);
        if (k == 1) {
            mem_free(b.data);
            if (image_encode_exr(64, 32, &layer, 1, true, NULL, &b.data, &b.size, NULL) != FACET_OK)
                break; /* without OpenEXR */
        }
        captured_messages m = {0};
        facet_environment *e = load(b, FACET_LAYOUT_AUTO, &m);
        const float *p = e->panorama.pixels;
        assert_int_equal(get_info(e).repaired_texels, 2); /* as half, 1e30 is infinity as well */
        assert_int_equal(m.count, 1);
        assert_non_null(strstr(m.text, "made: 2 texels are NaN, infinity or less than 0"));
        if (k == 0)
            assert_non_null(strstr(m.text, "the first at (13, 9)"));
        else /* as half, -1e-20 is -0 */
            assert_non_null(strstr(m.text, "the first at (40, 20)"));
        const float *bad = p + 3 * (20 * 64 + 40);
        assert_true(bad[0] == (k ? 65504.0f : ENVIRONMENT_MAX_RADIANCE) && bad[1] == 0.0f && bad[2] == 0.0f);
        assert_true(p[3 * (9 * 64 + 13) + 1] == 0.0f);
        assert_true(p[3 * 31 * 64 + 9] == (k ? 65504.0f : ENVIRONMENT_MAX_RADIANCE));
        facet_environment_destroy(e);
        mem_free(b.data);
    }
    image_destroy(&i);
}

/* Texels of a KTX2 file are checked before its reader repairs them. */
static void invalid_texels_of_ktx2_are_found_before_its_reader_repairs_them(void **state)
{
    (void)state;
    static unsigned char texels[6 * 4 * 8];
    ktx2_test_file f = {
        .vk_format = 97, .width = 2, .height = 2, .faces = 6, .levels = 1, .model = 1, .transfer = 1};
    f.bytes[0] = texels;
    f.sizes[0] = sizeof texels;
    texels[4 * 8 * 2 + 2 * 8 + 1] = 0x7c; /* face +Y, texel (0, 1): red is infinite */
    texels[4 * 8 * 5 + 3 * 8 + 2] = 1;    /* face -Z, texel (1, 1): green is NaN */
    texels[4 * 8 * 5 + 3 * 8 + 3] = 0x7c;
    bytes b;
    b.data = ktx2_test_write(&f, &b.size);
    captured_messages m = {0};
    facet_environment *e = load(b, FACET_LAYOUT_AUTO, &m);
    assert_int_equal(get_info(e).repaired_texels, 2);
    assert_int_equal(m.count, 1);
    assert_non_null(
        strstr(m.text, "made: 2 texels are NaN, infinity or less than 0, the first at (0, 1) of face +Y"));
    assert_true((*cube_texel(&e->faces, 2, 0, 1))[0] == 65504.0f);
    assert_true((*cube_texel(&e->faces, 5, 1, 1))[1] == 0.0f);
    facet_environment_destroy(e);
    free(b.data);
}

static void other_aspect_ratios_are_refused_or_stretched(void **state)
{
    (void)state;
    static const struct {
        uint32_t width, height;
        facet_layout layout;
        facet_result result;
        int warnings;
        const char *words;
    } cases[] = {
        {7, 5, FACET_LAYOUT_AUTO, FACET_ERROR_INVALID, 0,
         "7 x 5 texels: an environment is 2:1 (equirectangular), 4:3 or 3:4 (cross), 6:1 or 1:6 (strip of "
         "faces)"},
        {1, 1, FACET_LAYOUT_AUTO, FACET_ERROR_INVALID, 0, "NAME{face}.EXT; for any other shape"},
        {19, 9, FACET_LAYOUT_AUTO, FACET_ERROR_INVALID, 0, "19 x 9"},
        {41, 20, FACET_LAYOUT_AUTO, FACET_OK, 1, "41 x 20 texels: an equirectangular image is twice as wide"},
        {7, 5, FACET_LAYOUT_EQUIRECTANGULAR, FACET_OK, 1, "stretched over the sphere"},
        {1, 1, FACET_LAYOUT_EQUIRECTANGULAR, FACET_OK, 1, "stretched over the sphere"},
        {1, 1, FACET_LAYOUT_OCTAHEDRAL, FACET_OK, 0, ""},
        {2, 1, FACET_LAYOUT_AUTO, FACET_OK, 0, ""},
        {4, 3, FACET_LAYOUT_AUTO, FACET_OK, 0, ""},
        {4, 3, FACET_LAYOUT_EQUIRECTANGULAR, FACET_OK, 1, "stretched over the sphere"},
        {4, 4, FACET_LAYOUT_CROSS_VERTICAL, FACET_ERROR_INVALID, 0,
         "4 x 4 texels are not a vertical cross (3:4)"},
        {4, 3, FACET_LAYOUT_FACES, FACET_ERROR_ARGUMENT, 0,
         "the layout of six faces needs six images; this is one"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        image i = uniform_image(cases[k].width, cases[k].height, 2.0f);
        bytes b = encode_pfm(&i);
        captured_messages m = {0};
        facet_environment_desc desc = {.layout = cases[k].layout, .log = capture_log(&m)};
        if (cases[k].result != FACET_OK) {
            check_refused(b, &desc, cases[k].result, cases[k].words);
        } else {
            facet_environment *e = load(b, cases[k].layout, &m);
            facet_environment_info info = get_info(e);
            for (int c = 0; c < 3; c++)
                assert_true(fabs(info.mean[c] - 2.0) < 1e-5);
            assert_true(fabsf(info.max_radiance - 2.0f) < 1e-5f);
            facet_environment_destroy(e);
            if (cases[k].warnings)
                assert_non_null(strstr(m.text, cases[k].words));
        }
        assert_int_equal(m.count, cases[k].warnings);
        mem_free(b.data);
        image_destroy(&i);
    }
}

/* Headers that claim large sizes are refused for their edges, or by the budget, before memory is taken. */
static void large_claims_are_refused_before_memory_is_taken(void **state)
{
    (void)state;
    static const char *const heads[] = {"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 16384 +X 32768\n",
                                        "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 24576 +X 32768\n",
                                        "PF\n32768 16384\n-1.0\n"};
    facet_budget *budget;
    assert_int_equal(facet_budget_create(64u << 20, &budget, NULL), FACET_OK);
    for (int k = 0; k < 3; k++) {
        bytes b = {malloc(4096), 4096};
        memset(b.data, 2, b.size);
        memcpy(b.data, heads[k], strlen(heads[k]));
        facet_environment *e = NULL;
        facet_environment_desc desc = {.allocator = facet_budget_allocator(budget)};
        facet_result result = facet_environment_load_memory(b.data, b.size, "huge", &desc, &e, NULL);
        assert_true(result == FACET_ERROR_MEMORY || result == FACET_ERROR_INVALID);
        assert_null(e);
        check_refused(b, &(facet_environment_desc){.max_size = 16384}, FACET_ERROR_LIMIT,
                      "more than 16384 along an edge");
        free(b.data);
    }
    assert_int_equal(facet_budget_used_bytes(budget), 0);
    facet_budget_destroy(budget);
}

static void running_out_of_memory_leaks_nothing(void **state)
{
    (void)state;
    cube c = make_cube(4);
    *cube_texel(&c, 1, 1, 1) = rgbx_splat(1e4f);
    for (int k = 0; k < 4; k++) {
        bytes b = k == 0   ? encode_layout(&c, FACET_LAYOUT_CROSS_HORIZONTAL)
                  : k == 1 ? encode_layout(&c, FACET_LAYOUT_OCTAHEDRAL)
                           : encode_ktx2(&c, FACET_TEXEL_FORMAT_RGBA16F, k == 2 ? 0 : 1);
        for (long fail_at = 0; b.data; fail_at = next_failure(fail_at)) {
            failing_allocator f = {.fail_at = fail_at};
            facet_environment_desc desc = {.allocator = failing_allocator_get(&f),
                                           .thread_count = 1,
                                           .layout = k == 1 ? FACET_LAYOUT_OCTAHEDRAL : FACET_LAYOUT_AUTO};
            facet_environment *e = NULL;
            facet_result result = facet_environment_load_memory(b.data, b.size, "made", &desc, &e, NULL);
            facet_environment_destroy(e);
            assert_int_equal(f.blocks, 0);
            if (result == FACET_OK)
                break;
            assert_int_equal(result, FACET_ERROR_MEMORY);
            assert_true(fail_at < 60);
        }
        mem_free(b.data);
    }
    cube_destroy(&c);
}

static void radiance_that_is_none_is_refused(void **state)
{
    (void)state;
    const float bad[] = {-1.0f, NAN, INFINITY}, good[3] = {1.0f, 0.0f, 2.0f};
    for (int i = 0; i < 9; i++) {
        float radiance[3] = {1.0f, 1.0f, 1.0f};
        radiance[i % 3] = bad[i / 3];
        const float *ends[3] = {good, good, good};
        ends[i % 3] = radiance;
        facet_environment *e = NULL;
        facet_error error = {0};
        assert_int_equal(facet_environment_create_constant(radiance, NULL, &e, &error), FACET_ERROR_ARGUMENT);
        assert_non_null(strstr(error.message, "at least 0"));
        assert_int_equal(facet_environment_create_gradient(ends[0], ends[1], ends[2], NULL, &e, &error),
                         FACET_ERROR_ARGUMENT);
        assert_null(e);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ktx2_textures_that_are_no_environment_are_refused),
        cmocka_unit_test(truncated_files_fail_or_load),
        cmocka_unit_test(invalid_texels_are_replaced_and_reported_once),
        cmocka_unit_test(invalid_texels_of_ktx2_are_found_before_its_reader_repairs_them),
        cmocka_unit_test(other_aspect_ratios_are_refused_or_stretched),
        cmocka_unit_test(large_claims_are_refused_before_memory_is_taken),
        cmocka_unit_test(running_out_of_memory_leaks_nothing),
        cmocka_unit_test(radiance_that_is_none_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
