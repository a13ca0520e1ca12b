/* mtl_test_support.c - see mtl_test_support.h. */
#define _XOPEN_SOURCE 700
#include "io/obj/mtl_test_support.h"

#include <ftw.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

test_folder test_folder_make(void)
{
    test_folder folder = {"/tmp/facet_mtl_XXXXXX"};
    assert_non_null(mkdtemp(folder.path));
    return folder;
}

static int remove_entry(const char *path, const struct stat *status, int kind, struct FTW *walk)
{
    (void)status;
    (void)kind;
    (void)walk;
    return remove(path);
}

void test_folder_remove(const test_folder *folder)
{
    nftw(folder->path, remove_entry, 8, FTW_DEPTH | FTW_PHYS);
}

const char *test_path(const test_folder *folder, const char *name)
{
    static char paths[4][512];
    static int next;
    char *path = paths[next++ % 4];
    snprintf(path, sizeof paths[0], "%s/%s", folder->path, name);
    return path;
}

void test_put(const test_folder *folder, const char *name, const void *bytes, size_t size)
{
    const char *path = test_path(folder, name);
    char parent[512];
    snprintf(parent, sizeof parent, "%s", path);
    *strrchr(parent, '/') = 0;
    mkdir(parent, 0700);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

void test_put_text(const test_folder *folder, const char *name, const char *string)
{
    test_put(folder, name, string, strlen(string));
}

void test_put_png(const test_folder *folder, const char *name)
{
    static const unsigned char png[] = {
        0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44, 0x52, 0x00,
        0x00, 0x00, 0x01, 0x00, 0x00, 0x00, 0x01, 0x08, 0x00, 0x00, 0x00, 0x00, 0x3a, 0x7e, 0x9b, 0x55, 0x00,
        0x00, 0x00, 0x0a, 0x49, 0x44, 0x41, 0x54, 0x78, 0xda, 0x63, 0xf8, 0x0f, 0x00, 0x01, 0x01, 0x01, 0x00,
        0x1c, 0xb0, 0x8c, 0x99, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};
    test_put(folder, name, png, sizeof png);
}

char *test_get(const test_folder *folder, const char *name)
{
    file_bytes file = {0};
    assert_int_equal(file_open(test_path(folder, name), 0, NULL, &file, NULL), FACET_OK);
    char *copy = malloc(file.size + 1);
    assert_non_null(copy);
    memcpy(copy, file.data, file.size);
    copy[file.size] = 0;
    file_close(&file);
    return copy;
}

facet_scene *mtl_load(const char *folder, const char *names, const facet_scene_desc *desc)
{
    const facet_scene_desc defaults = {0};
    desc = desc ? desc : &defaults;
    facet_scene *scene = NULL;
    mtl_reader *reader = NULL;
    assert_int_equal(scene_create(&desc->allocator, "test.obj", &scene, NULL), FACET_OK);
    assert_int_equal(mtl_reader_create(scene, desc, folder, &reader, NULL), FACET_OK);
    assert_int_equal(mtl_reader_load(reader, names, strlen(names), NULL), FACET_OK);
    assert_int_equal(mtl_reader_settle(reader, true, NULL), FACET_OK);
    assert_int_equal(mtl_reader_finish(reader, NULL), FACET_OK);
    mtl_reader_destroy(reader);
    return scene;
}

facet_scene *mtl_load_text(const char *string, const facet_scene_desc *desc)
{
    test_folder folder = test_folder_make();
    test_put_text(&folder, "a.mtl", string);
    facet_scene *scene = mtl_load(folder.path, "a.mtl", desc);
    test_folder_remove(&folder);
    return scene;
}

const legacy_material *mtl_get(const facet_scene *scene, uint32_t index)
{
    assert_true(scene->legacy && index < scene->material_count);
    return &scene->legacy->materials[index];
}

int mtl_count_warnings(const facet_scene *scene, const char *string)
{
    int count = 0;
    for (uint32_t i = 0; i < scene->warning_count; i++)
        count += strstr(scene->warnings[i], string) != NULL;
    return count;
}
