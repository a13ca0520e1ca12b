/* mtl_test_support.c - see mtl_test_support.h. */
#include "io/obj/mtl_test_support.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void test_put_text(const temporary_folder *folder, const char *name, const char *string)
{
    temporary_folder_put(folder, name, string, strlen(string));
}

char *test_get(const temporary_folder *folder, const char *name)
{
    file_bytes file = {0};
    assert_int_equal(file_open(temporary_folder_file(folder, name), 0, NULL, &file, NULL), FACET_OK);
    char *copy = malloc(file.size + 1);
    assert_non_null(copy);
    memcpy(copy, file.data, file.size);
    copy[file.size] = 0;
    file_close(&file);
    return copy;
}

int test_visit_files(const char *folder, const char *extension,
                     bool (*visit)(const char *folder, const char *name, void *context), void *context)
{
    int count = 0;
    DIR *entries = opendir(folder);
    assert_non_null(entries);
    for (struct dirent *entry; (entry = readdir(entries));) {
        char path[1024];
        const char *dot = strrchr(entry->d_name, '.');
        snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
        DIR *inner = entry->d_name[0] == '.' ? NULL : opendir(path);
        if (inner) {
            closedir(inner);
            count += test_visit_files(path, extension, visit, context);
        } else if (dot && strcmp(dot, extension) == 0) {
            count += visit(folder, entry->d_name, context);
        }
    }
    closedir(entries);
    return count;
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
    temporary_folder folder;
    temporary_folder_create(&folder);
    test_put_text(&folder, "a.mtl", string);
    facet_scene *scene = mtl_load(folder.path, "a.mtl", desc);
    temporary_folder_remove(&folder);
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
