/* codec_ktx2_test.c - files of Basis Universal against the bytes of its own transcoder, files of other
 * encoders against their source images. */
#include "image/image_test.h"

#include "image/ktx2.h"

/* FNV-1a of all images of a file as RGBA, layers and faces inside levels. */
static uint64_t hash_images(const char *path, uint32_t thread_count)
{
    file_bytes file = read_file(path);
    ktx2 k;
    facet_error error;
    if (ktx2_open(file.data, file.size, path, &k, &error) != FACET_OK)
        fail_msg("%s", error.message);
    uint64_t hash = 0xcbf29ce484222325u;
    const uint32_t per_level = k.layer_count * k.face_count;
    for (uint32_t n = 0; n < k.level_count * per_level; n++) {
        image i;
        image_decode_desc desc = {.thread_count = thread_count, .channel_count = 4};
        if (ktx2_read(&k, n / per_level, n % per_level / k.face_count, n % k.face_count, &desc, &i, &error) !=
            FACET_OK)
            fail_msg("%s", error.message);
        const unsigned char *bytes = i.pixels;
        for (size_t b = 0; b < image_row_size(&i) * i.height; b++)
            hash = (hash ^ bytes[b]) * 0x100000001b3u;
        image_destroy(&i);
    }
    file_close(&file);
    return hash;
}

/* The hashes are those of the RGBA32 output of basis_transcoder.wasm (three.js 0.187). */
static void images_are_those_of_the_transcoder(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        uint64_t hash;
    } cases[] = {
        {"uastc_modes.ktx2", 0x1e0e67a2d003ed47u},
        {"etc1s_alpha.ktx2", 0x64687a82d2ef2147u},
        {"uastc_zstd.ktx2", 0xe1eeb07cb517f6edu},
        {"etc1s_cube.ktx2", 0x22ec13ddc4fab325u},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char path[256];
        snprintf(path, sizeof path, TEST_DATA "%s", cases[k].name);
        file_bytes file = read_file(path);
        image header;
        facet_error error;
        facet_result result = image_probe(file.data, file.size, path, &header, NULL, &error);
        file_close(&file);
        if (result == FACET_ERROR_UNSUPPORTED && strstr(error.message, "libzstd"))
            continue;
        for (uint32_t threads = 1; threads <= 4; threads += 3)
            if (hash_images(path, threads) != cases[k].hash)
                fail_msg("%s, %u threads: 0x%016llx", cases[k].name, threads,
                         (unsigned long long)hash_images(path, threads));
    }
}

/* The same sheet in several formats: a name on one color, which the last texel shows. */
static void files_of_other_encoders_decode(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        uint32_t channel_count;
        int rgb[3], tolerance;
    } cases[] = {
        {"2d_rgb8.ktx2", 3, {77, 175, 74}, 0},          {"2d_rgba8.ktx2", 4, {77, 175, 74}, 0},
        {"2d_rgba16_linear.ktx2", 4, {77, 175, 74}, 1}, {"2d_rgba32_linear.ktx2", 4, {77, 175, 74}, 1},
        {"2d_bc1.ktx2", 3, {255, 127, 0}, 3},           {"2d_bc7.ktx2", 4, {255, 127, 0}, 1},
        {"2d_astc4x4.ktx2", 4, {55, 126, 184}, 1},      {"2d_uastc.ktx2", 3, {184, 149, 0}, 4},
        {"2d_etc1s.ktx2", 3, {184, 149, 0}, 4},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char name[64], path[512];
        snprintf(name, sizeof name, "images/ktx2/%s", cases[k].name);
        shared_path(path, name);
        file_bytes file = read_file(path);
        for (uint32_t reduction = 0; reduction < 3; reduction++) {
            image i, srgb;
            facet_error error;
            facet_result result = image_decode(file.data, file.size, path,
                                               &(image_decode_desc){.max_reduction = reduction}, &i, &error);
            if (result == FACET_ERROR_UNSUPPORTED && strstr(error.message, "libastcenc"))
                continue;
            if (result != FACET_OK)
                fail_msg("%s", error.message);
            assert_int_equal(i.width, 40 >> reduction);
            assert_int_equal(i.channel_count, cases[k].channel_count);
            bool is_srgb = i.is_srgb || i.type != IMAGE_U8;
            assert_int_equal(image_convert(&i, NULL, 1, i.channel_count, IMAGE_U8, is_srgb, &srgb, NULL),
                             FACET_OK);
            const uint8_t *texel =
                (const uint8_t *)srgb.pixels + image_row_size(&srgb) * srgb.height - srgb.channel_count;
            for (int c = 0; c < 3; c++)
                if (abs(texel[c] - cases[k].rgb[c]) > cases[k].tolerance + (reduction ? 3 : 0)) /* filtered */
                    fail_msg("%s: channel %d is %d, not %d", path, c, texel[c], cases[k].rgb[c]);
            image_destroy(&i);
            image_destroy(&srgb);
        }
        file_close(&file);
    }
}

static void broken_files_are_refused(void **state)
{
    (void)state;
    static const char *const names[] = {"bad_identifier", "level_offset_beyond_end", "levels_huge",
                                        "truncated_data", "truncated_header",        "width_huge",
                                        "width_zero"};
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        char name[64], path[512];
        snprintf(name, sizeof name, "malformed/ktx2/%s.ktx2", names[k]);
        shared_path(path, name);
        file_bytes file = read_file(path);
        image i;
        facet_error error = {0};
        assert_int_equal(image_decode(file.data, file.size, "broken", NULL, &i, &error), FACET_ERROR_INVALID);
        assert_null(i.pixels);
        assert_int_equal(strncmp(error.message, "broken: ", 8), 0);
        file_close(&file);
    }
}

/* Red and green in two slices: the same with the swizzle that toktx writes, in which alpha is the second one. */
static void two_channel_files_of_toktx_decode(void **state)
{
    (void)state;
    image plain = decode_file("tests/cases/29-etc1s-swizzle/rg.ktx2");
    image swizzled = decode_file("tests/cases/29-etc1s-swizzle/rg_swizzle_ra01.ktx2");
    const uint8_t *texel = plain.pixels;
    uint8_t least = 255, most = 0;
    for (size_t i = 0; i < (size_t)plain.width * plain.height; i++, texel += plain.channel_count) {
        least = texel[1] < least ? texel[1] : least;
        most = texel[1] > most ? texel[1] : most;
    }
    assert_true(least < 200 && most > least); /* green shows something */
    assert_same_texels(&plain, &swizzled);
    image_destroy(&plain);
    image_destroy(&swizzled);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(images_are_those_of_the_transcoder),
        cmocka_unit_test(files_of_other_encoders_decode),
        cmocka_unit_test(broken_files_are_refused),
        cmocka_unit_test(two_channel_files_of_toktx_decode),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
