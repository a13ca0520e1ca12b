/* file_source.c - see file_source.h. */
#include "io/file_source.h"

#include <string.h>

#include "base/hash.h"
#include "base/memory.h"
#include "base/result.h"
#include "io/file_alike.h"

/* ---- paths ---- */

char *file_source_path(const facet_allocator *allocator, const char *path, bool *leaves_top)
{
    char *out = mem_alloc(allocator, strlen(path) + 1, 1);
    size_t used = 0;
    *leaves_top = false;
    while (out && *path) {
        size_t length = strcspn(path, "/");
        if (length == 2 && memcmp(path, "..", 2) == 0) {
            if (used == 0) {
                *leaves_top = true;
                mem_free(out);
                return NULL;
            }
            while (used > 0 && out[--used] != '/')
                ;
        } else if (length > 0 && !(length == 1 && *path == '.')) {
            if (used > 0)
                out[used++] = '/';
            memcpy(out + used, path, length);
            used += length;
        }
        path += length;
        path += *path == '/';
    }
    if (out)
        out[used] = 0;
    return out;
}

const char *file_source_below(const char *path, const char *folder, const facet_allocator *allocator)
{
    bool leaves_top;
    char *top = file_source_path(allocator, folder, &leaves_top);
    size_t length = top ? strlen(top) : 0;
    bool is_below = top && (length == 0 || (strncmp(path, top, length) == 0 && path[length] == '/'));
    mem_free(top);
    return is_below ? path + length + (length > 0) : NULL;
}

/* ---- files ---- */

uint64_t file_source_number(const char *path)
{
    uint64_t number = 1;
    for (; *path; path++)
        number = mix64(number + (unsigned char)*path + MIX64_STEP);
    return number | 1;
}

facet_result file_source_open(const facet_file_source *source, const char *path, uint64_t max_bytes,
                              file_bytes *file, facet_error *error)
{
    const void *bytes = NULL;
    size_t size = 0;
    *file = (file_bytes){0};
    if (!source->open(source->user, path, &bytes, &size))
        return fail(error, FACET_ERROR_READ, "%s: there is no such file", path);
    *file = (file_bytes){.data = bytes,
                         .size = size,
                         .device = FILE_SOURCE_DEVICE,
                         .number = file_source_number(path),
                         .user = source->user,
                         .release = source->close};
    if (size <= max_bytes && (bytes || size == 0))
        return FACET_OK;
    file_close(file);
    if (!bytes)
        return fail(error, FACET_ERROR_READ, "%s: facet_file_source.open() gave no bytes, but a size of %zu",
                    path, size);
    return fail(error, FACET_ERROR_LIMIT, "%s: %zu bytes is larger than the limit of %llu", path, size,
                (unsigned long long)max_bytes);
}

/* Paths are compared folder by folder: file_alike.h knows names. */
static bool paths_are_alike(const char *a, const char *b)
{
    enum { LONGEST_NAME = 255 };
    char names[2][LONGEST_NAME + 1];
    while (*a && *b) {
        const char *paths[2] = {a, b};
        for (int i = 0; i < 2; i++) {
            size_t length = strcspn(paths[i], "/");
            if (length > LONGEST_NAME)
                return false;
            memcpy(names[i], paths[i], length);
            names[i][length] = 0;
            paths[i] += length;
        }
        if (*paths[0] != *paths[1] || !file_names_are_alike(names[0], names[1]))
            return false;
        a = paths[0] + (*paths[0] == '/');
        b = paths[1] + (*paths[1] == '/');
    }
    return !*a && !*b;
}

const char *file_source_find_alike(const facet_file_source *source, const char *path)
{
    const char *found = NULL, *name;
    for (size_t i = 0; source->list && (name = source->list(source->user, i)); i++) {
        if (!paths_are_alike(name, path))
            continue;
        if (found)
            return NULL;
        found = name;
    }
    return found;
}

facet_result model_file_open(const char *path, const facet_scene_desc *desc, file_bytes *file,
                             facet_error *error)
{
    uint64_t limit = file_limit(desc->max_file_bytes);
    if (!file_source_is_given(&desc->files))
        return file_open(path, limit, &desc->allocator, file, error);
    bool leaves_top;
    char *plain = file_source_path(&desc->allocator, path, &leaves_top);
    *file = (file_bytes){0};
    if (!plain)
        return leaves_top ? fail(error, FACET_ERROR_READ, "%s: there is no such file", path)
                          : fail_memory(error, "path", strlen(path));
    facet_result result = file_source_open(&desc->files, plain, limit, file, error);
    mem_free(plain);
    return result;
}
