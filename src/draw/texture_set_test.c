/* Tests of texture_set_create(): what is decoded, to which level, and what happens on failure. */
#define _DEFAULT_SOURCE /* readdir() */
#include <dirent.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include <cmocka.h>

#include "tests/support/support.h"
#include "base/file.h"
#include "base/memory.h"
#include "draw/texture_set.h"

enum { MAX_ITEMS = 8 };

/* A scene that has nothing but textures; texture i shows image i unless a test says otherwise. */
typedef struct fixture {
    facet_scene scene;
    scene_image images[MAX_ITEMS];
    scene_texture textures[MAX_ITEMS];
    texture_use uses[MAX_ITEMS];
    unsigned char *bytes[MAX_ITEMS];
    char warnings[1024];
    int warning_count;
    facet_log log;
} fixture;

static void note_warning(void *user, facet_log_level level, const char *text)
{
    fixture *f = user;
    assert_int_equal(level, FACET_LOG_LEVEL_WARNING);
    snprintf(f->warnings, sizeof f->warnings, "%s", text);
    f->warning_count++;
}

static void set_up(fixture *f)
{
    *f = (fixture){.scene = {.source = "model.glb"}};
    f->scene.images = f->images;
    f->scene.textures = f->textures;
    f->log = (facet_log){.user = f, .message = note_warning};
}

static void tear_down(fixture *f)
{
    for (int i = 0; i < MAX_ITEMS; i++)
        mem_free(f->bytes[i]);
}

/* Smooth waves, a different image for each seed; without noise, so that JPEG preserves nearly all of it. */
static image draw(uint32_t width, uint32_t height, uint32_t channel_count, uint32_t seed)
{
    image i;
    assert_int_equal(image_create(NULL, width, height, channel_count, IMAGE_U8, &i, NULL), FACET_OK);
    i.is_srgb = true;
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++)
            for (uint32_t c = 0; c < channel_count; c++) {
                float value = 128.0f + 60.0f * sinf((float)(x * (1 + seed % 3) + 2 * y) * 0.04f + (float)c) +
                              50.0f * sinf((float)x * 0.013f - (float)y * 0.031f * (float)(seed + c));
                ((uint8_t *)i.pixels)[(y * width + x) * channel_count + c] = (uint8_t)value;
            }
    return i;
}

/* Adds an image, a texture of it and a use as color. */
static void add(fixture *f, image i, image_codec codec)
{
    uint32_t index = f->scene.image_count++;
    uint32_t texture = f->scene.texture_count++;
    size_t size;
    assert_int_equal(
        image_encode(&i, codec, &(image_encode_desc){.quality = 95}, &f->bytes[index], &size, NULL),
        FACET_OK);
    image_destroy(&i);
    f->images[index] = (scene_image){.name = "", .mime_type = "", .bytes = f->bytes[index], .size = size};
    f->textures[texture] = (scene_texture){.name = "", .image = index};
    f->uses[texture] = (texture_use){.is_read_as_color = true};
}

static texture_set *create(fixture *f, uint32_t thread_count)
{
    texture_set *set;
    facet_error error;
    assert_int_equal(texture_set_create(&f->scene, f->uses, NULL, &f->log, thread_count, &set, &error),
                     FACET_OK);
    assert_non_null(set);
    return set;
}

static void sample_middle(const texture_set *set, uint32_t texture, bool as_color, float out[4])
{
    const float middle[2] = {0.5f, 0.5f};
    const float zero[2] = {0.0f, 0.0f};
    texture_sample(set, texture, as_color, middle, zero, zero, out);
}

static bool is_white(const float texel[4])
{
    return texel[0] == 1.0f && texel[1] == 1.0f && texel[2] == 1.0f && texel[3] == 1.0f;
}

static void images_are_decoded_once(void **state)
{
    (void)state;
    fixture f;
    set_up(&f);
    add(&f, draw(64, 32, 4, 1), IMAGE_CODEC_PNG);
    add(&f, draw(16, 16, 3, 2), IMAGE_CODEC_PNG);
    f.textures[2] = f.textures[0]; /* shares image 0, as data, clamped */
    f.textures[2].wrap_u = SCENE_WRAP_CLAMP;
    f.uses[2] = (texture_use){.is_read_as_data = true};
    f.textures[3] = f.textures[1]; /* not read */
    f.scene.texture_count = 4;
    texture_set *set = create(&f, 2);
    assert_int_equal(texture_set_decoded_texels(set), 64 * 32 + 16 * 16);
    float color[4];
    float data[4];
    sample_middle(set, 0, true, color);
    sample_middle(set, 2, false, data);
    assert_float_equal(pow(((double)data[0] + 0.055) / 1.055, 2.4), color[0],
                       0.01); /* one interpolates encoded values */
    assert_float_equal(data[3], color[3], 1e-6f);
    sample_middle(set, 1, false, data); /* never asked for as data */
    assert_true(is_white(data));
    assert_int_equal(f.warning_count, 0);
    texture_set_destroy(set);
    tear_down(&f);
}

static void what_is_not_read_is_not_decoded(void **state)
{
    (void)state;
    fixture f;
    set_up(&f);
    add(&f, draw(8, 8, 3, 1), IMAGE_CODEC_PNG);
    f.uses[0] = (texture_use){0};
    texture_set *set = create(&f, 1);
    assert_int_equal(texture_set_decoded_texels(set), 0);
    texture_set_destroy(set);
    f.scene.texture_count = f.scene.image_count = 0; /* a scene without textures */
    set = create(&f, 1);
    float texel[4];
    sample_middle(set, 0, true, texel);
    assert_true(is_white(texel));
    texture_set_destroy(set);
    texture_set_destroy(NULL);
    tear_down(&f);
}

/* 10 log10(255^2 / mean squared difference) of level number level. */
static double compare_levels(const texture_pyramid *a, const texture_pyramid *b, uint32_t level)
{
    assert_int_equal(a->levels[level].width, b->levels[level].width);
    assert_int_equal(a->levels[level].height, b->levels[level].height);
    size_t count = (size_t)a->levels[level].width * a->levels[level].height * a->channel_count;
    double sum = 1e-9;
    for (size_t k = 0; k < count; k++) {
        double difference = a->levels[level].texels[k] - b->levels[level].texels[k];
        sum += difference * difference;
    }
    return 10.0 * log10(255.0 * 255.0 * (double)count / sum);
}

static void reduced_images_are_their_mips(void **state)
{
    (void)state;
    static const image_codec codecs[] = {IMAGE_CODEC_JPEG, IMAGE_CODEC_PNG};
    for (int c = 0; c < 2; c++) {
        fixture f;
        set_up(&f);
        add(&f, draw(256, 128, 3, 4), codecs[c]);
        f.uses[0].is_read_as_color = false;
        f.uses[0].is_read_as_data = true;
        texture_set *full = create(&f, 1);
        for (uint32_t reduction = 1; reduction < 8; reduction++) {
            f.uses[0].min_lod = (float)reduction + 0.9f;
            texture_set *reduced = create(&f, 1);
            const texture_pyramid *p = &reduced->pyramids[1];
            assert_int_equal(p->first_level, reduction);
            assert_int_equal(p->level_count, 9);
            uint32_t cheap = codecs[c] == IMAGE_CODEC_PNG ? 0 : reduction < 3 ? reduction : 3;
            assert_int_equal(texture_set_decoded_texels(reduced), (256u >> cheap) * (128u >> cheap));
            for (uint32_t level = reduction; level < 9; level++)
                assert_true(compare_levels(p, &full->pyramids[1], level) > 40.0);
            texture_set_destroy(reduced);
        }
        f.uses[0].min_lod = 1e9f; /* the last level is always there */
        texture_set *last = create(&f, 1);
        assert_int_equal(last->pyramids[1].first_level, 8);
        float texel[4];
        sample_middle(last, 0, false, texel);
        assert_float_equal(texel[0], 0.5f, 0.1f);
        texture_set_destroy(last);
        texture_set_destroy(full);
        tear_down(&f);
    }
}

/* 100 is 25 times 4: reduced by 8, texels of a JPEG would lie between those of the mips. */
static void reductions_divide_the_image(void **state)
{
    (void)state;
    fixture f;
    set_up(&f);
    add(&f, draw(200, 100, 3, 4), IMAGE_CODEC_JPEG);
    f.uses[0].min_lod = 3.0f;
    texture_set *set = create(&f, 1);
    assert_int_equal(texture_set_decoded_texels(set), 50 * 25);
    assert_int_equal(set->pyramids[0].first_level, 3);
    assert_int_equal(set->pyramids[0].levels[3].width, 25);
    assert_int_equal(set->pyramids[0].levels[3].height, 12);
    texture_set_destroy(set);
    tear_down(&f);
}

/* The finest need of all textures of an image counts, and samplers without mips read level 0. */
static void the_finest_need_decides(void **state)
{
    (void)state;
    fixture f;
    set_up(&f);
    add(&f, draw(64, 64, 3, 1), IMAGE_CODEC_JPEG);
    f.uses[0].min_lod = 3.0f;
    f.textures[1] = f.textures[0];
    f.uses[1] = (texture_use){.is_read_as_color = true, .min_lod = 1.5f};
    f.scene.texture_count = 2;
    texture_set *set = create(&f, 1);
    assert_int_equal(set->pyramids[0].first_level, 1);
    texture_set_destroy(set);
    f.textures[0].mip_filter = SCENE_MIP_NONE;
    set = create(&f, 1);
    assert_int_equal(set->pyramids[0].first_level, 0);
    texture_set_destroy(set);
    f.textures[0].mip_filter = SCENE_MIP_LINEAR;
    f.uses[0].min_lod = NAN;
    set = create(&f, 1);
    assert_int_equal(set->pyramids[0].first_level, 0);
    texture_set_destroy(set);
    tear_down(&f);
}

static void assert_equal_sets(const texture_set *a, const texture_set *b, uint32_t image_count)
{
    for (uint32_t i = 0; i < 2 * image_count; i++) {
        const texture_pyramid *p = &a->pyramids[i];
        const texture_pyramid *q = &b->pyramids[i];
        assert_int_equal(p->level_count, q->level_count);
        for (uint32_t level = 0; level < p->level_count; level++)
            assert_memory_equal(p->levels[level].texels, q->levels[level].texels,
                                (size_t)p->levels[level].width * p->levels[level].height * p->channel_count);
    }
}

static void threads_change_nothing(void **state)
{
    (void)state;
    fixture f;
    set_up(&f);
    for (uint32_t i = 0; i < MAX_ITEMS; i++) {
        bool is_jpeg = i % 2;
        add(&f, draw(33 + 40 * i, 129 - 9 * i, is_jpeg ? 3 : 4, i),
            is_jpeg ? IMAGE_CODEC_JPEG : IMAGE_CODEC_PNG);
        f.uses[i].is_read_as_data = i % 3 == 0;
    }
    texture_set *one = create(&f, 1);
    texture_set *many = create(&f, 5);
    assert_equal_sets(one, many, MAX_ITEMS);
    texture_set_destroy(one);
    texture_set_destroy(many);
    tear_down(&f);
}

static void broken_images_are_white_with_a_warning(void **state)
{
    (void)state;
    fixture f;
    set_up(&f);
    add(&f, draw(16, 16, 3, 1), IMAGE_CODEC_PNG);
    f.images[0].name = "wood";
    f.images[0].size /= 2;
    texture_set *set = create(&f, 2);
    float texel[4];
    sample_middle(set, 0, true, texel);
    assert_true(is_white(texel));
    assert_int_equal(f.warning_count, 1);
    assert_non_null(strstr(f.warnings, "model.glb: image 0 \"wood\""));
    assert_non_null(strstr(f.warnings, "white"));
    texture_set_destroy(set);

    f.warning_count = 0;
    f.images[0].bytes = (const unsigned char *)"no image at all";
    f.images[0].size = 17;
    set = create(&f, 1);
    assert_int_equal(f.warning_count, 1);
    float size[2];
    assert_false(texture_full_size(&f.scene, 0, size));
    texture_set_destroy(set);

    f.warning_count = 0;
    f.images[0].bytes = NULL; /* the reader has already warned of it */
    set = create(&f, 1);
    sample_middle(set, 0, true, texel);
    assert_true(is_white(texel));
    assert_int_equal(f.warning_count, 0);
    assert_false(texture_full_size(&f.scene, 0, size));
    texture_set_destroy(set);

    f.textures[0].image = SCENE_NONE;
    set = create(&f, 1);
    sample_middle(set, 0, true, texel);
    assert_true(is_white(texel));
    assert_false(texture_full_size(&f.scene, 0, size));
    assert_false(texture_full_size(&f.scene, SCENE_NONE, size));
    texture_set_destroy(set);
    tear_down(&f);
}

/* A float image is not a texture, even where it can be decoded. */
static void float_images_are_white_with_a_warning(void **state)
{
    (void)state;
    fixture f;
    set_up(&f);
    static const char hdr[] = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n\x80\x80\x80\x80";
    f.images[0] = (scene_image){.name = "", .bytes = (const unsigned char *)hdr, .size = sizeof hdr - 1};
    f.scene.image_count = f.scene.texture_count = 1;
    f.uses[0].is_read_as_color = true;
    texture_set *set = create(&f, 1);
    float texel[4];
    sample_middle(set, 0, true, texel);
    assert_true(is_white(texel));
    assert_int_equal(f.warning_count, 1);
    texture_set_destroy(set);
    tear_down(&f);
}

static void too_large_images_are_an_error(void **state)
{
    (void)state;
    fixture f;
    set_up(&f);
    add(&f, draw(64, 16, 3, 1), IMAGE_CODEC_PNG);
    add(&f, draw(16, 16, 3, 1), IMAGE_CODEC_PNG);
    f.scene.max_texture_size = 63;
    texture_set *set;
    facet_error error;
    assert_int_equal(texture_set_create(&f.scene, f.uses, NULL, &f.log, 2, &set, &error), FACET_ERROR_LIMIT);
    assert_null(set);
    assert_non_null(strstr(error.message, "model.glb: image 0"));
    f.scene.max_texture_size = 64;
    set = create(&f, 2);
    texture_set_destroy(set);
    tear_down(&f);
}

static void sixteen_bits_are_kept(void **state)
{
    (void)state;
    fixture f;
    set_up(&f);
    image i;
    assert_int_equal(image_create(NULL, 1, 1, 3, IMAGE_U16, &i, NULL), FACET_OK);
    memcpy(i.pixels, (uint16_t[3]){32768, 1000, 65535}, 6);
    add(&f, i, IMAGE_CODEC_PNG);
    f.uses[0].is_read_as_data = true;
    texture_set *set = create(&f, 1);
    float texel[4];
    sample_middle(set, 0, false, texel);
    assert_float_equal(texel[0], 32768.0f / 65535.0f, 1e-6f);
    assert_float_equal(texel[1], 1000.0f / 65535.0f, 1e-6f);
    sample_middle(set, 0, true, texel);
    assert_float_equal(texel[0], pow((32768.0 / 65535.0 + 0.055) / 1.055, 2.4), 1e-5f);
    assert_true(texel[2] == 1.0f);
    texture_set_destroy(set);
    tear_down(&f);
}

static void sizes_are_those_of_the_full_image(void **state)
{
    (void)state;
    fixture f;
    set_up(&f);
    add(&f, draw(48, 24, 3, 1), IMAGE_CODEC_PNG);
    float size[2];
    assert_true(texture_full_size(&f.scene, 0, size));
    assert_true(size[0] == 48.0f && size[1] == 24.0f);
    f.images[0].width = 7; /* the reader's result is trusted */
    f.images[0].height = 9;
    assert_true(texture_full_size(&f.scene, 0, size));
    assert_true(size[0] == 7.0f && size[1] == 9.0f);
    tear_down(&f);
}

/* A refused block is an error, a broken image where a codec library does not say what failed, or no loss: PNG is read
 * in rows where its whole does not fit. */
static void refused_blocks_are_errors_or_no_loss(void **state)
{
    (void)state;
    fixture f;
    set_up(&f);
    add(&f, draw(32, 32, 4, 1), IMAGE_CODEC_PNG);
    add(&f, draw(32, 32, 3, 1), IMAGE_CODEC_JPEG);
    f.uses[0].is_read_as_data = true;
    texture_set *complete = create(&f, 1);
    bool was_refused = true;
    for (int count = 0; was_refused; count++) {
        failing_allocator memory = {.fail_at = count};
        facet_allocator allocator = failing_allocator_get(&memory);
        texture_set *set;
        facet_error error;
        facet_result result = texture_set_create(&f.scene, f.uses, &allocator, &f.log, 1, &set, &error);
        was_refused = atomic_load(&memory.calls) > count;
        assert_true(result == FACET_OK || (was_refused && result == FACET_ERROR_MEMORY));
        assert_int_equal(result == FACET_OK, set != NULL);
        assert_true(f.warning_count <= (was_refused ? 1 : 0));
        assert_true(was_refused || count > 12);
        if (result == FACET_OK && f.warning_count == 0)
            assert_equal_sets(set, complete, 2);
        texture_set_destroy(set);
        assert_int_equal(memory.blocks, 0);
        f.warning_count = 0;
    }
    texture_set_destroy(complete);
    tear_down(&f);
}

/* Reads the image in all ways, reduced and not. */
static void use_as_texture(const char *path)
{
    file_bytes file;
    assert_int_equal(file_open(path, 0, NULL, &file, NULL), FACET_OK);
    fixture f;
    set_up(&f);
    f.images[0] = (scene_image){.name = path, .bytes = file.data, .size = file.size};
    f.scene.image_count = f.scene.texture_count = 1;
    for (int lod = 0; lod < 7; lod++) {
        f.uses[0] = (texture_use){.is_read_as_color = true, .is_read_as_data = true, .min_lod = (float)lod};
        texture_set *set = create(&f, 1);
        for (int as_color = 0; as_color < 2; as_color++)
            for (float size = 0.01f; size < 2.0f; size *= 3.0f) {
                float texel[4];
                texture_sample(set, 0, as_color, (float[2]){0.97f, -0.3f}, (float[2]){size, 0.0f},
                               (float[2]){0.0f, 0.3f * size}, texel);
                for (int k = 0; k < 4; k++)
                    assert_true(texel[k] >= 0.0f && texel[k] <= 1.00001f);
            }
        texture_set_destroy(set);
    }
    assert_int_equal(f.warning_count, 0);
    file_close(&file);
    tear_down(&f);
}

/* Every depth, color type, interlacing and odd size that PNG has. */
static void every_png_can_be_a_texture(void **state)
{
    (void)state;
    const char *data = getenv("FACET_TEST_DATA");
    static const char *const folders[] = {"primary", "16bit"};
    int count = 0;
    for (int i = 0; i < 2; i++) {
        char folder[1024];
        snprintf(folder, sizeof folder, "%s/images/pngsuite/%s", data ? data : "", folders[i]);
        DIR *entries = data ? opendir(folder) : NULL;
        if (!entries) {
            print_message("skipped: no PngSuite under FACET_TEST_DATA\n");
            skip();
        }
        for (struct dirent *entry; (entry = readdir(entries));) {
            char path[2048];
            snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
            if (strcasecmp(path_extension(path), "png") != 0)
                continue;
            use_as_texture(path);
            count++;
        }
        closedir(entries);
    }
    assert_true(count > 50);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(images_are_decoded_once),
        cmocka_unit_test(what_is_not_read_is_not_decoded),
        cmocka_unit_test(reduced_images_are_their_mips),
        cmocka_unit_test(reductions_divide_the_image),
        cmocka_unit_test(the_finest_need_decides),
        cmocka_unit_test(threads_change_nothing),
        cmocka_unit_test(broken_images_are_white_with_a_warning),
        cmocka_unit_test(float_images_are_white_with_a_warning),
        cmocka_unit_test(too_large_images_are_an_error),
        cmocka_unit_test(sixteen_bits_are_kept),
        cmocka_unit_test(sizes_are_those_of_the_full_image),
        cmocka_unit_test(refused_blocks_are_errors_or_no_loss),
        cmocka_unit_test(every_png_can_be_a_texture),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
