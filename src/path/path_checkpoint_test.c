/* path_checkpoint_test.c - an interrupted image continues as one that was not; other files are refused. */
#define _POSIX_C_SOURCE 200809L
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "tests/support/support.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/hash.h"
#include "image/image.h"
#include "path/path_checkpoint.h"
#include "path/path_film_state.h"

enum { WIDTH = 23, HEIGHT = 17, COUNT = WIDTH * HEIGHT };
static const char KEY[] = "0123456789abcdef0123456789abcdef0123456789abcdef0123456789abcdef";
static const char OTHER_KEY[] = "0123456789abcdef0123456789abcdef0123456789abcdef0123456789abcdee";

static temporary_folder folder;
static char path[80], other_path[80];

static int make_folder(void **state)
{
    (void)state;
    temporary_folder_create(&folder);
    snprintf(path, sizeof path, "%s/a.exr", folder.path);
    snprintf(other_path, sizeof other_path, "%s/b.exr", folder.path);
    return 0;
}

static int remove_folder(void **state)
{
    (void)state;
    temporary_folder_remove(&folder);
    return 0;
}

static path_film *create(uint32_t width, uint32_t height, bool has_ground)
{
    path_film *f;
    assert_int_equal(path_film_create(NULL, width, height, has_ground, &f, NULL), FACET_OK);
    return f;
}

/* ---- an image ---- */

static float random_number(uint32_t pixel, uint32_t sample, uint32_t dimension)
{
    uint64_t z = mix64(((uint64_t)pixel << 40 | (uint64_t)sample << 8 | dimension) * MIX64_STEP);
    return (float)(z >> 40) / 16777216.0f;
}

static path_sample sample_of(uint32_t pixel, uint32_t index)
{
    path_sample s = {.opacity = random_number(pixel, index, 0) < 0.7f ? 1.0f : 0.0f};
    for (uint32_t c = 0; c < 3; c++) {
        float light = random_number(pixel, index, 1 + c);
        s.radiance[c] = s.opacity * (light > 0.99f ? 1e4f : light - 0.01f);
        s.albedo[c] = s.opacity * random_number(pixel, index, 4 + c);
        s.normal[c] = s.opacity * (random_number(pixel, index, 7 + c) - 0.3f);
        s.ground_open[c] = (1.0f - s.opacity) * (1.0f + random_number(pixel, index, 10 + c));
        s.ground_lit[c] = s.ground_open[c] * random_number(pixel, index, 13 + c);
    }
    if (random_number(pixel, index, 16) < 0.01f)
        s.radiance[1] = (float)INFINITY;
    return s;
}

/* Samples from each pixel's first missing one up to goal, more for some pixels. */
static void draw(path_film *f, uint32_t goal)
{
    for (uint32_t i = 0; i < COUNT; i++)
        for (uint32_t k = path_film_samples(f, i); k < goal + i % 3; k++) {
            path_sample s = sample_of(i, k);
            path_film_add(f, i, &s);
        }
}

static void expect_same(const path_film *a, const path_film *b)
{
    assert_memory_equal(a->pixels, b->pixels, COUNT * sizeof *a->pixels);
    if (a->ground)
        assert_memory_equal(a->ground, b->ground, COUNT * sizeof *a->ground);
    assert_int_equal(path_film_dropped(a), path_film_dropped(b));
    assert_int_equal(path_film_total_samples(a), path_film_total_samples(b));
}

static void save(const path_film *f, const char *to)
{
    facet_error error;
    facet_result result = path_film_save(f, KEY, to, 1, &error);
    if (result == FACET_ERROR_UNSUPPORTED) {
        print_message("SKIP: %s\n", error.message);
        skip();
    }
    if (result != FACET_OK)
        fail_msg("%s", error.message);
}

static void interrupted_renders_continue(void **state)
{
    (void)state;
    for (int has_ground = 0; has_ground < 2; has_ground++) {
        path_film *whole = create(WIDTH, HEIGHT, has_ground);
        draw(whole, 100);
        uint32_t goals[] = {0, 1, 37, 64, 100};
        for (size_t k = 0; k < sizeof goals / sizeof *goals; k++) {
            path_film *first = create(WIDTH, HEIGHT, has_ground), *second = create(WIDTH, HEIGHT, has_ground);
            if (goals[k])
                draw(first, goals[k]);
            save(first, path);
            bool exists;
            facet_error error;
            if (path_film_load(second, KEY, path, &exists, &error) != FACET_OK)
                fail_msg("%s", error.message);
            assert_true(exists);
            expect_same(first, second);
            /* judged alike, too */
            path_film_update(first, 0.5f, 1);
            path_film_update(second, 0.5f, 2);
            assert_true(path_film_share_done(first) == path_film_share_done(second));
            draw(second, 100);
            expect_same(whole, second);
            path_film_destroy(first);
            path_film_destroy(second);
        }
        assert_true(path_film_dropped(whole) > 0);
        path_film_destroy(whole);
    }
}

static void viewers_show_the_image(void **state)
{
    (void)state;
    path_film *f = create(WIDTH, HEIGHT, true);
    draw(f, 9);
    save(f, path);
    file_bytes file;
    image picture;
    assert_int_equal(file_open(path, 0, NULL, &file, NULL), FACET_OK);
    assert_int_equal(image_decode(file.data, file.size, path, NULL, &picture, NULL), FACET_OK);
    assert_true(picture.width == WIDTH && picture.height == HEIGHT && picture.channel_count == 4);
    for (size_t i = 0; i < COUNT; i++)
        for (int c = 0; c < 3; c++)
            assert_true(((float *)picture.pixels)[4 * i + (size_t)c] == path_pixel_mean(&f->pixels[i], c));
    image_destroy(&picture);
    file_close(&file);
    path_film_destroy(f);
}

/* ---- other files ---- */

/* Loads from a path that must be refused, and leaves the film as it was. */
static void expect_refusal(const char *from, const char *key, uint32_t width, bool has_ground,
                           facet_result expected, const char *sentence)
{
    path_film *f = create(width, HEIGHT, has_ground), *same = create(width, HEIGHT, has_ground);
    path_sample s = sample_of(0, 0);
    path_film_add(f, 3, &s);
    path_film_add(same, 3, &s);
    bool exists;
    facet_error error = {0};
    assert_int_equal(path_film_load(f, key, from, &exists, &error), expected);
    assert_true(exists);
    assert_memory_equal(f->pixels, same->pixels, (size_t)width * HEIGHT * sizeof *f->pixels);
    assert_int_equal(path_film_dropped(f), path_film_dropped(same));
    if (!strstr(error.message, sentence) || strncmp(error.message, from, strlen(from)) != 0)
        fail_msg("\"%s\" does not say: %s", error.message, sentence);
    path_film_destroy(f);
    path_film_destroy(same);
}

static void write_bytes(const char *to, const void *bytes, size_t size)
{
    assert_int_equal(file_write(to, bytes, size, NULL), FACET_OK);
}

static void other_files_are_refused(void **state)
{
    (void)state;
    path_film *f = create(WIDTH, HEIGHT, false);
    draw(f, 5);
    save(f, path);
    expect_refusal(path, OTHER_KEY, WIDTH, false, FACET_ERROR_ARGUMENT, "of another image");
    expect_refusal(path, KEY, WIDTH + 1, false, FACET_ERROR_ARGUMENT, "23 x 17 pixels, not 24 x 17");
    expect_refusal(path, KEY, WIDTH, true, FACET_ERROR_INVALID, "channel ground.0");

    bool exists = true;
    assert_int_equal(path_film_load(f, KEY, "/nowhere/there/is.exr", &exists, NULL), FACET_OK);
    assert_false(exists);

    write_bytes(other_path, "", 0);
    expect_refusal(other_path, KEY, WIDTH, false, FACET_ERROR_INVALID, "not a checkpoint: an OpenEXR file");
    write_bytes(other_path, "Dear diary, today", 17);
    expect_refusal(other_path, KEY, WIDTH, false, FACET_ERROR_INVALID, "not a checkpoint: an OpenEXR file");
    static const char *const names[] = {"R", "G", "B"};
    static const float texels[WIDTH * HEIGHT * 3];
    const image_layer layer = {names, 3, texels, WIDTH * 3 * sizeof(float), false, false};
    unsigned char *bytes;
    size_t size;
    assert_int_equal(image_encode_exr(WIDTH, HEIGHT, &layer, 1, false, NULL, &bytes, &size, NULL), FACET_OK);
    write_bytes(other_path, bytes, size);
    mem_free(bytes);
    expect_refusal(other_path, KEY, WIDTH, false, FACET_ERROR_INVALID,
                   "is an OpenEXR image, but not a checkpoint");
    expect_refusal(folder.path, KEY, WIDTH, false, FACET_ERROR_READ, "");
    path_film_destroy(f);
}

/* The file at `path` in memory, to be changed. */
static unsigned char *load_bytes(size_t *size)
{
    file_bytes file;
    assert_int_equal(file_open(path, 0, NULL, &file, NULL), FACET_OK);
    unsigned char *bytes = malloc(file.size);
    memcpy(bytes, file.data, file.size);
    *size = file.size;
    file_close(&file);
    return bytes;
}

/* Behind a text that is there once. */
static unsigned char *find(unsigned char *bytes, size_t size, const char *text)
{
    for (size_t i = 0; i + strlen(text) < size; i++)
        if (memcmp(bytes + i, text, strlen(text)) == 0)
            return bytes + i + strlen(text);
    fail_msg("%s is not in the file", text);
    return NULL;
}

static void other_versions_are_refused(void **state)
{
    (void)state;
    path_film *f = create(WIDTH, HEIGHT, false);
    save(f, path);
    size_t size;
    unsigned char *bytes = load_bytes(&size);
    /* name, type and size come before the value */
    *(find(bytes, size, "facetCheckpoint") + 1 + sizeof "string" + 4) = '7';
    write_bytes(other_path, bytes, size);
    expect_refusal(other_path, KEY, WIDTH, false, FACET_ERROR_INVALID,
                   "version 7; this build of facet resumes");
    free(bytes);
    path_film_destroy(f);
}

static void truncated_files_are_refused(void **state)
{
    (void)state;
    path_film *f = create(WIDTH, HEIGHT, true), *back = create(WIDTH, HEIGHT, true);
    draw(f, 5);
    save(f, path);
    size_t size;
    unsigned char *bytes = load_bytes(&size);
    for (size_t cut = 0; cut < size; cut += cut < 64 || cut > size - 16 ? 1 : 401) {
        FILE *file = fopen(other_path, "wb");
        assert_int_equal(fwrite(bytes, 1, cut, file), cut);
        fclose(file);
        bool exists;
        facet_error error;
        assert_int_equal(path_film_load(back, KEY, other_path, &exists, &error), FACET_ERROR_INVALID);
        assert_int_equal(strncmp(error.message, other_path, strlen(other_path)), 0);
    }
    assert_int_equal(path_film_total_samples(back), 0);
    free(bytes);
    path_film_destroy(f);
    path_film_destroy(back);
}

/* A changed byte is found, or changes nothing: it is in a header's remark, in the table of where rows are, or in the
 * image for viewers. */
enum { NUMBERS = 2000 };
static void damaged_files_are_refused(void **state)
{
    (void)state;
    path_film *f = create(WIDTH, HEIGHT, true);
    draw(f, 5);
    save(f, path);
    size_t size;
    unsigned char *bytes = load_bytes(&size);
    int refused = 0, changed = 0;
    for (size_t at = 0; at < size; at += at < NUMBERS ? 3 : 97, changed++) {
        unsigned char kept = bytes[at];
        bytes[at] ^= (unsigned char)(1u << at % 8);
        FILE *file = fopen(other_path, "wb");
        assert_int_equal(fwrite(bytes, 1, size, file), size);
        fclose(file);
        bytes[at] = kept;
        path_film *back = create(WIDTH, HEIGHT, true);
        bool exists;
        facet_error error;
        facet_result result = path_film_load(back, KEY, other_path, &exists, &error);
        if (result == FACET_OK)
            expect_same(f, back);
        else
            assert_true(result == FACET_ERROR_INVALID || result == FACET_ERROR_ARGUMENT ||
                        result == FACET_ERROR_LIMIT || result == FACET_ERROR_UNSUPPORTED);
        refused += result != FACET_OK;
        path_film_destroy(back);
    }
    assert_true(refused > changed * 4 / 5);
    free(bytes);
    path_film_destroy(f);
}

/* Numbers that no film has, digest and all. */
static void impossible_values_are_refused(void **state)
{
    (void)state;
    for (int k = 0; k < 8; k++) {
        path_film *f = create(WIDTH, HEIGHT, true);
        draw(f, 3);
        path_pixel *p = &f->pixels[COUNT / 2];
        if (k == 0)
            p->color[1] = ((path_fixed)p->samples + 1) << (56 + 46);
        else if (k == 1)
            p->color[2] = -(((path_fixed)p->samples + 1) << (56 + 46));
        else if (k == 2)
            p->square[0] = -1;
        else if (k == 3)
            p->samples = (1u << 24) + 1;
        else if (k == 4)
            p->opacity = INT64_MIN;
        else if (k == 5)
            f->ground[7].samples = f->pixels[7].samples + 1;
        else if (k == 6)
            p->is_saturated = 2;
        else
            f->ground[9].unused[1] = 1;
        save(f, path);
        expect_refusal(path, KEY, WIDTH, true, FACET_ERROR_INVALID, "the checkpoint is damaged");
        path_film_destroy(f);
    }
}

/* ---- failures ---- */

static void unwritable_checkpoints_are_reported(void **state)
{
    (void)state;
    path_film *f = create(WIDTH, HEIGHT, false);
    save(f, path);
    size_t size, size_after;
    unsigned char *before = load_bytes(&size);
    char inside[96];
    snprintf(inside, sizeof inside, "%s/b.exr", path); /* a file is no folder */
    facet_error error;
    assert_int_equal(path_film_save(f, KEY, inside, 1, &error), FACET_ERROR_WRITE);
    assert_non_null(strstr(error.message, inside));
    unsigned char *after = load_bytes(&size_after);
    assert_int_equal(size, size_after);
    assert_memory_equal(before, after, size);
    free(before);
    free(after);
    path_film_destroy(f);
}

static void failed_allocations_are_reported(void **state)
{
    (void)state;
    path_film *filled = create(WIDTH, HEIGHT, true);
    draw(filled, 3);
    save(filled, path);
    for (long k = 0;; k = next_failure(k)) {
        failing_allocator failing = {.fail_at = -1};
        facet_allocator allocator = failing_allocator_get(&failing);
        path_film *f;
        assert_int_equal(path_film_create(&allocator, WIDTH, HEIGHT, true, &f, NULL), FACET_OK);
        failing.fail_at = failing.calls + k;
        bool exists;
        facet_error error;
        facet_result result = path_film_load(f, KEY, path, &exists, &error);
        if (result == FACET_OK)
            result = path_film_save(f, KEY, other_path, 1, &error);
        path_film_destroy(f);
        assert_int_equal(failing.blocks, 0);
        if (result == FACET_OK) {
            assert_true(k > 4);
            break;
        }
        assert_int_equal(result, FACET_ERROR_MEMORY);
        assert_non_null(strstr(error.message, "memory"));
    }
    path_film *back = create(WIDTH, HEIGHT, true);
    bool exists;
    assert_int_equal(path_film_load(back, KEY, other_path, &exists, NULL), FACET_OK);
    expect_same(filled, back);
    path_film_destroy(back);
    path_film_destroy(filled);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(interrupted_renders_continue),
        cmocka_unit_test(viewers_show_the_image),
        cmocka_unit_test(other_files_are_refused),
        cmocka_unit_test(other_versions_are_refused),
        cmocka_unit_test(truncated_files_are_refused),
        cmocka_unit_test(damaged_files_are_refused),
        cmocka_unit_test(impossible_values_are_refused),
        cmocka_unit_test(unwritable_checkpoints_are_reported),
        cmocka_unit_test(failed_allocations_are_reported),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
