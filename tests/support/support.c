/* support.c - the test support that is not inline. */
#define _XOPEN_SOURCE 700 /* mkdtemp, nftw */
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <ftw.h>
#include <sys/stat.h>

#include "tests/support/support.h"

void assert_near_(double a, double b, double tolerance, const char *file, int line)
{
    if (fabs(a - b) <= tolerance)
        return;
    print_error("%.12g is not within %.3g of %.12g\n", a, tolerance, b);
    _fail(file, line);
}

/* Weak: tests of modules above image have the same functions from src/image/srgb.c. */
__attribute__((weak)) double srgb_encode(double linear)
{
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * pow(linear, 1.0 / 2.4) - 0.055;
}

__attribute__((weak)) double srgb_decode(double encoded)
{
    return encoded <= 0.04045 ? encoded / 12.92 : pow((encoded + 0.055) / 1.055, 2.4);
}

/* ---- memory ---- */

static void *failing_allocate(void *user, size_t size)
{
    failing_allocator *f = user;
    if (atomic_fetch_add(&f->calls, 1) == f->fail_at)
        return NULL;
    atomic_fetch_add(&f->blocks, 1);
    return malloc(size);
}

static void failing_release(void *user, void *memory, size_t size)
{
    (void)size;
    atomic_fetch_sub(&((failing_allocator *)user)->blocks, 1);
    free(memory);
}

facet_allocator failing_allocator_get(failing_allocator *f)
{
    return (facet_allocator){.user = f, .allocate = failing_allocate, .release = failing_release};
}

/* ---- messages ---- */

static void capture(void *user, facet_log_level level, const char *message)
{
    (void)level;
    captured_messages *messages = user;
    size_t length = strlen(messages->text);
    snprintf(messages->text + length, sizeof messages->text - length, "%s\n", message);
    messages->count++;
}

facet_log capture_log(captured_messages *messages)
{
    return (facet_log){.user = messages, .message = capture};
}

/* ---- progress ---- */

static bool watch(void *user, const char *stage, double fraction)
{
    captured_progress *progress = user;
    assert_true(fraction > progress->fraction && fraction <= 1.0);
    progress->stage = stage;
    progress->fraction = fraction;
    return ++progress->calls != progress->stops_at;
}

facet_progress capture_progress(captured_progress *progress)
{
    return (facet_progress){.user = progress, .report = watch};
}

/* ---- test data ---- */

const char *test_data(void)
{
    const char *folder = getenv("FACET_TEST_DATA");
    if (!folder) {
        print_message("skipped: FACET_TEST_DATA is not set\n");
        skip();
    }
    return folder;
}

/* ---- files ---- */

void temporary_folder_create(temporary_folder *folder)
{
    snprintf(folder->path, sizeof folder->path, "/tmp/facet_test_XXXXXX");
    assert_non_null(mkdtemp(folder->path));
}

static int remove_entry(const char *path, const struct stat *status, int type, struct FTW *place)
{
    (void)status, (void)type, (void)place;
    return remove(path);
}

void temporary_folder_remove(const temporary_folder *folder)
{
    nftw(folder->path, remove_entry, 8, FTW_DEPTH | FTW_PHYS);
}

const char *temporary_folder_file(const temporary_folder *folder, const char *name)
{
    static char paths[4][512];
    static int next;
    char *path = paths[next++ % 4];
    snprintf(path, sizeof paths[0], "%s/%s", folder->path, name);
    return path;
}

const char *temporary_folder_put(const temporary_folder *folder, const char *name, const void *bytes,
                                 size_t size)
{
    const char *path = temporary_folder_file(folder, name);
    char parent[512];
    snprintf(parent, sizeof parent, "%s", path);
    *strrchr(parent, '/') = 0;
    mkdir(parent, 0700);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
    return path;
}

const char *temporary_folder_put_png(const temporary_folder *folder, const char *name)
{
    static const unsigned char white[] = {
        0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44, 0x52, 0x00,
        0x00, 0x00, 0x01, 0x00, 0x00, 0x00, 0x01, 0x08, 0x00, 0x00, 0x00, 0x00, 0x3a, 0x7e, 0x9b, 0x55, 0x00,
        0x00, 0x00, 0x0a, 0x49, 0x44, 0x41, 0x54, 0x78, 0xda, 0x63, 0xf8, 0x0f, 0x00, 0x01, 0x01, 0x01, 0x00,
        0x1c, 0xb0, 0x8c, 0x99, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};
    return temporary_folder_put(folder, name, white, sizeof white);
}
