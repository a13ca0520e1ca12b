/* environment_test.c - reading environments, the studio, and the cache of prepared lights. */
#define _DEFAULT_SOURCE
#include <dirent.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#include "base/file.h"
#include "base/memory.h"
#include "ibl/environment.h"
#include "ibl/equirect.h"
#include "ibl/ibl.h"
#include "ibl/light_fixture.h"
#include "tests/support/support.h"

/* A Radiance file of width x height without run lengths: all texels rgbe. */
static size_t make_hdr(unsigned char *bytes, int width, int height, const unsigned char rgbe[4])
{
    int head = sprintf((char *)bytes, "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n", height, width);
    for (int i = 0; i < width * height; i++)
        memcpy(bytes + head + 4 * i, rgbe, 4);
    return (size_t)head + 4 * (size_t)(width * height);
}

static void environments_are_read_from_memory(void **state)
{
    (void)state;
    unsigned char bytes[4096];
    const unsigned char white[4] = {128, 128, 128, 129}; /* 1.0, or 1.004 where half a step is added */
    size_t size = make_hdr(bytes, 6, 3, white);
    captured_messages m = {0};
    facet_environment_desc desc = {.log = capture_log(&m)};
    facet_environment *e = NULL;
    facet_error error = {0};
    assert_int_equal(facet_environment_load_memory(bytes, size, "white.hdr", &desc, &e, &error), FACET_OK);
    assert_int_equal(m.count, 0);
    const ibl_light *light = NULL;
    assert_int_equal(ibl_light_prepare(e, &all_lookups, &light, &error), FACET_OK);
    float d[3] = {0.0f, 0.0f, 1.0f};
    float out[3];
    ibl_specular(light, d, 0.5f, out);
    assert_near(out[1], 1.0, 0.005);
    ibl_light_release(light);
    facet_environment_destroy(e);

    size = make_hdr(bytes, 41, 20, white);
    assert_int_equal(facet_environment_load_memory(bytes, size, "odd.hdr", &desc, &e, &error), FACET_OK);
    assert_int_equal(m.count, 1); /* not quite twice as wide as high */
    assert_non_null(strstr(m.text, "odd.hdr: 41 x 20"));
    facet_environment_destroy(e);
}

static void invalid_files_and_arguments_are_refused(void **state)
{
    (void)state;
    facet_environment *e = (facet_environment *)8;
    facet_error error;
    assert_int_not_equal(facet_environment_load_memory("nonsense", 8, "x.hdr", NULL, &e, &error), FACET_OK);
    assert_null(e);
    assert_non_null(strstr(error.message, "x.hdr"));
    assert_int_not_equal(facet_environment_load_memory("", 0, "empty", NULL, &e, NULL), FACET_OK);
    assert_int_equal(facet_environment_load("/does/not/exist.hdr", NULL, &e, &error), FACET_ERROR_READ);
    assert_non_null(strstr(error.message, "/does/not/exist.hdr"));

    unsigned char bytes[4096];
    const unsigned char white[4] = {128, 128, 128, 129};
    size_t size = make_hdr(bytes, 16, 8, white);
    facet_environment_desc small = {.max_size = 8};
    assert_int_equal(facet_environment_load_memory(bytes, size, "x.hdr", &small, &e, &error),
                     FACET_ERROR_LIMIT);
    facet_environment_desc short_file = {.max_file_bytes = 100};
    assert_int_equal(facet_environment_load_memory(bytes, size, "x.hdr", &short_file, &e, &error),
                     FACET_ERROR_LIMIT);
    for (size_t cut = 0; cut < size; cut++) { /* any end is an error or an image, never a crash */
        if (facet_environment_load_memory(bytes, cut, "cut.hdr", NULL, &e, NULL) == FACET_OK)
            facet_environment_destroy(e);
        else
            assert_null(e);
    }
}

/* 8-bit images are decoded from sRGB. */
static void images_of_8_bits_are_decoded_from_srgb(void **state)
{
    (void)state;
    image grey;
    assert_int_equal(image_create(NULL, 8, 4, 3, IMAGE_U8, &grey, NULL), FACET_OK);
    grey.is_srgb = true;
    memset(grey.pixels, 188, 8 * 4 * 3);
    unsigned char *bytes = NULL;
    size_t size = 0;
    assert_int_equal(
        image_encode(&grey, IMAGE_CODEC_PNG, &(image_encode_desc){.thread_count = 1}, &bytes, &size, NULL),
        FACET_OK);
    facet_environment *e = NULL;
    assert_int_equal(facet_environment_load_memory(bytes, size, "grey.png", NULL, &e, NULL), FACET_OK);
    assert_near(((float *)e->panorama.pixels)[20], 0.5028864580, 1e-5); /* sRGB's 188 / 255 as linear light */
    facet_environment_destroy(e);
    mem_free(bytes);
    image_destroy(&grey);
}

/* ---- real files ---- */

static const char *data_path(const char *name, char path[1024])
{
    const char *folder = getenv("FACET_TEST_DATA");
    if (folder)
        snprintf(path, 1024, "%s/env/%s", folder, name);
    struct stat s;
    if (!folder || stat(path, &s) != 0) {
        print_message("FACET_TEST_DATA has no env/%s\n", name);
        skip();
    }
    return path;
}

static void real_environments_are_read(void **state)
{
    (void)state;
    static const char *const names[] = {"leadenhall_market_1k.hdr",
                                        "neutral.hdr",
                                        "qwantani_afternoon_puresky_1k.hdr",
                                        "royal_esplanade_1k.hdr",
                                        "studio_small_03_1k.hdr",
                                        "exr/city_512_dwab.exr",
                                        "exr/qwantani_256_half_none_tiled.exr",
                                        "exr/qwantani_512_float_piz.exr",
                                        "exr/qwantani_512_half_zip.exr",
                                        "exr/studio_512_dwab.exr",
                                        "exr/sunset_512_dwab.exr"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        char path[1024];
        facet_environment *e = NULL;
        facet_error error = {0};
        facet_result result = facet_environment_load(data_path(names[i], path), NULL, &e, &error);
        if (result != FACET_OK)
            print_error("%s\n", error.message);
        assert_int_equal(result, FACET_OK);
        const ibl_light *light = NULL;
        assert_int_equal(ibl_light_prepare(e, &all_lookups, &light, NULL), FACET_OK);
        double whole[3];
        cube_mean(&e->parts.levels[PREFILTER_GGX][prefilter_level_count(PREFILTER_GGX) - 1], whole);
        for (uint32_t level = 1; level < prefilter_level_count(PREFILTER_GGX); level++) {
            double mean[3];
            cube_mean(&e->parts.levels[PREFILTER_GGX][level], mean);
            for (int k = 0; k < 3; k++) {
                assert_near(mean[k] / (double)e->parts.harmonics.mean[k], 1.0, 0.01);
                assert_near(mean[k] / whole[k], 1.0, 0.01);
            }
        }
        ibl_light_release(light);
        facet_environment_destroy(e);
    }
}

/* data/README.md: the sun of this sky is at u 0.600, v 0.272. The light is brightest there. */
static void the_sun_is_in_its_direction(void **state)
{
    (void)state;
    char path[1024];
    facet_environment *e = NULL;
    assert_int_equal(
        facet_environment_load(data_path("qwantani_afternoon_puresky_1k.hdr", path), NULL, &e, NULL),
        FACET_OK);
    const ibl_light *light = NULL;
    assert_int_equal(ibl_light_prepare(e, &all_lookups, &light, NULL), FACET_OK);
    double azimuth = 2.0 * 3.14159265358979 * (0.600 - 0.5);
    double polar = 3.14159265358979 * 0.272;
    float sun[3] = {(float)(sin(polar) * cos(azimuth)), (float)cos(polar),
                    (float)(sin(polar) * sin(azimuth))};
    float at_sun[3], out[3];
    for (int r = 0; r <= 5; r++) {
        ibl_specular(light, sun, (float)r / 5.0f, at_sun);
        for (int i = 0; i < 512; i++) {
            float d[3];
            equirect_direction(32, 16, i % 32, i / 32, d);
            ibl_specular(light, d, (float)r / 5.0f, out);
            if (d[0] * sun[0] + d[1] * sun[1] + d[2] * sun[2] < 0.9f)
                assert_true(out[1] < at_sun[1]);
        }
    }
    ibl_light_release(light);
    facet_environment_destroy(e);
}

/* ---- the studio ---- */

static void the_studio_is_neutral_and_lit_from_above(void **state)
{
    (void)state;
    facet_environment *e = NULL;
    assert_int_equal(facet_environment_create_studio(NULL, &e, NULL), FACET_OK);
    const ibl_light *light = NULL;
    assert_int_equal(ibl_light_prepare(e, &all_lookups, &light, NULL), FACET_OK);
    for (int k = 0; k < 3; k++)
        assert_near(e->parts.harmonics.mean[k], 1.0, 0.002);
    const float front[3] = {0.0f, 0.0f, 1.0f};
    const float up[3] = {0.0f, 1.0f, 0.0f};
    const float down[3] = {0.0f, -1.0f, 0.0f};
    float f[3], u[3], d[3];
    ibl_irradiance_over_pi(light, front, f);
    ibl_irradiance_over_pi(light, up, u);
    ibl_irradiance_over_pi(light, down, d);
    assert_near(f[0], f[2], 1e-6); /* neutral */
    assert_true(u[0] > f[0] && f[0] > d[0] && d[0] > 0.2f);
    ibl_light_release(light);
    facet_environment_destroy(e);
}

/* ---- the cache ---- */

static int count_entries(const char *folder, const char *remove_all)
{
    DIR *d = opendir(folder);
    int count = 0;
    if (!d)
        return 0;
    for (struct dirent *f = readdir(d); f; f = readdir(d)) {
        if (f->d_name[0] == '.')
            continue;
        count++;
        if (remove_all) {
            char path[1024];
            snprintf(path, sizeof path, "%s/%s", folder, f->d_name);
            unlink(path);
        }
    }
    closedir(d);
    return count;
}

static facet_environment *open_cached(const char *folder, uint64_t cache_bytes, captured_messages *m)
{
    unsigned char bytes[4096];
    size_t size = make_hdr(bytes, 24, 12, (const unsigned char[4]){200, 100, 50, 130});
    memset(bytes + 400, 130, 4);
    facet_environment_desc desc = {.cache_folder = folder, .cache_bytes = cache_bytes, .log = capture_log(m)};
    facet_environment *e = NULL;
    assert_int_equal(facet_environment_load_memory(bytes, size, "x.hdr", &desc, &e, NULL), FACET_OK);
    return e;
}

static void check_equal(facet_environment *a, facet_environment *b)
{
    for (int lobe = 0; lobe < PREFILTER_LOBE_COUNT; lobe++)
        for (uint32_t level = 1; level < prefilter_level_count((prefilter_lobe)lobe); level++)
            assert_memory_equal(a->parts.levels[lobe][level].texels, b->parts.levels[lobe][level].texels,
                                mem_size(a->parts.levels[lobe][level].texels));
}

static void prepared_parts_are_cached(void **state)
{
    (void)state;
    char folder[] = "/tmp/facet-cache-XXXXXX";
    assert_non_null(mkdtemp(folder));
    int entry_count =
        (int)prefilter_level_count(PREFILTER_GGX) + (int)prefilter_level_count(PREFILTER_SHEEN) - 2;
    captured_messages m = {0};
    facet_environment *fresh = open_cached(NULL, 0, &m);
    facet_environment *first = open_cached(folder, 0, &m);
    facet_environment *second = open_cached(folder, 0, &m);
    const ibl_light *a = NULL;
    const ibl_light *b = NULL;
    const ibl_light *c = NULL;
    assert_int_equal(ibl_light_prepare(fresh, &all_lookups, &a, NULL), FACET_OK);
    assert_int_equal(ibl_light_prepare(first, &all_lookups, &b, NULL), FACET_OK);
    assert_int_equal(count_entries(folder, NULL), entry_count);
    assert_int_equal(ibl_light_prepare(second, &all_lookups, &c, NULL), FACET_OK);
    assert_null(second->parts.harmonics.coefficients); /* nothing was prepared */
    check_equal(fresh, first);
    check_equal(fresh, second);
    ibl_light_release(b);
    ibl_light_release(c);
    facet_environment_destroy(first);
    facet_environment_destroy(second);

    /* damage: every entry in another place; they are prepared again and written again */
    DIR *d = opendir(folder);
    int i = 0;
    for (struct dirent *f = readdir(d); f; f = readdir(d)) {
        if (f->d_name[0] == '.')
            continue;
        char path[1024];
        snprintf(path, sizeof path, "%s/%s", folder, f->d_name);
        FILE *file = fopen(path, "r+");
        fseek(file, i % 2 ? 3 : 60 + i, SEEK_SET);
        fputc(255, file);
        fclose(file);
        if (i++ % 3 == 2)
            assert_int_equal(truncate(path, 20), 0);
    }
    closedir(d);
    for (int k = 0; k < 2; k++) {
        facet_environment *third = open_cached(folder, 0, &m);
        assert_int_equal(ibl_light_prepare(third, &all_lookups, &c, NULL), FACET_OK);
        assert_int_equal(third->parts.harmonics.coefficients != NULL, k == 0);
        check_equal(fresh, third);
        ibl_light_release(c);
        facet_environment_destroy(third);
    }
    assert_int_equal(m.count, 0);

    /* bounded: space for the smallest levels only; files that are not facet's are kept */
    count_entries(folder, "all");
    char other[1100];
    snprintf(other, sizeof other, "%s/notes.txt", folder);
    assert_int_equal(file_write(other, "mine", 4, NULL), FACET_OK);
    facet_environment *small = open_cached(folder, 300000, &m);
    assert_int_equal(ibl_light_prepare(small, &all_lookups, &c, NULL), FACET_OK);
    check_equal(fresh, small);
    int left = count_entries(folder, NULL);
    assert_true(left >= 2 && left < entry_count);
    assert_int_equal(access(other, F_OK), 0);
    ibl_light_release(c);
    facet_environment_destroy(small);
    ibl_light_release(a);
    facet_environment_destroy(fresh);
    count_entries(folder, "all");
    rmdir(folder);
}

/* A folder that cannot be written costs a warning, not the image. */
static void an_unwritable_cache_is_a_warning(void **state)
{
    (void)state;
    captured_messages m = {0};
    facet_environment *e = open_cached("/dev/null/nowhere", 0, &m);
    const ibl_light *light = NULL;
    assert_int_equal(ibl_light_prepare(e, &(ibl_light_desc){.needs_irradiance = true}, &light, NULL),
                     FACET_OK);
    assert_int_equal(m.count, 1);
    ibl_light_release(light);
    facet_environment_destroy(e);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(environments_are_read_from_memory),
        cmocka_unit_test(invalid_files_and_arguments_are_refused),
        cmocka_unit_test(images_of_8_bits_are_decoded_from_srgb),
        cmocka_unit_test(real_environments_are_read),
        cmocka_unit_test(the_studio_is_neutral_and_lit_from_above),
        cmocka_unit_test(the_sun_is_in_its_direction),
        cmocka_unit_test(prepared_parts_are_cached),
        cmocka_unit_test(an_unwritable_cache_is_a_warning),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
