/* page_files.c - see page_files.h. */
#define _GNU_SOURCE
#include "cli/view/page_files.h"

#include "base/file.h"
#include "base/result.h"
#include "cli/shared/input.h"
#include "cli/shared/output.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static facet_result fail_names(facet_error *error)
{
    return fail(error, FACET_ERROR_MEMORY, "out of memory: names");
}

/* Removes empty parts, "." and ".." of an absolute path in place. */
static void simplify(char *path)
{
    char *end = path; /* of the result */
    for (char *part = path; *part;) {
        size_t slashes = strspn(part, "/"), length = strcspn(part + slashes, "/");
        const char *name = part + slashes;
        part += slashes + length;
        if (length == 0 || (length == 1 && name[0] == '.'))
            continue;
        if (length == 2 && name[0] == '.' && name[1] == '.') {
            while (end > path && *--end != '/')
                ;
            continue;
        }
        *end++ = '/';
        memmove(end, name, length);
        end += length;
    }
    *end = 0;
}

/* path as an absolute one for free(), without looking at links. */
static char *absolute(const char *path, const char *current)
{
    size_t size = strlen(current) + strlen(path) + 2;
    char *out = malloc(size);
    if (!out)
        return NULL;
    snprintf(out, size, "%s/%s", path[0] == '/' ? "" : current, path);
    simplify(out);
    return out;
}

/* Appends a file unless it is there. Takes path. */
static bool add(page_files *files, char *path, bool is_light)
{
    bool is_there = false;
    for (size_t i = 0; path && i < files->count && !is_there; i++)
        is_there = strcmp(files->items[i].path, path) == 0;
    if (is_there || !path) {
        free(path);
        return is_there;
    }
    if (files->count == files->capacity) {
        size_t capacity = 2 * files->capacity + 8;
        page_file *grown = realloc(files->items, capacity * sizeof *grown);
        if (!grown) {
            free(path);
            return false;
        }
        files->items = grown;
        files->capacity = capacity;
    }
    files->items[files->count++] = (page_file){.path = path, .is_light = is_light};
    return true;
}

/* Length of the folder that all files are in, with its slash. */
static size_t common_folder(const page_files *files)
{
    const char *first = files->count ? files->items[0].path : "/";
    size_t length = (size_t)(strrchr(first, '/') + 1 - first);
    for (size_t i = 1; i < files->count; i++) {
        const char *path = files->items[i].path;
        size_t same = 0;
        while (same < length && path[same] == first[same])
            same++;
        for (length = same; length > 1 && first[length - 1] != '/';)
            length--;
    }
    return length;
}

static bool has_name(const page_files *files, const char *name)
{
    for (size_t i = 0; i < files->count; i++)
        if (files->items[i].name && strcmp(files->items[i].name, name) == 0)
            return true;
    return false;
}

/* Names files [begin, count): below root by their place there, others by their base name, in a folder of their own if
 * that is taken. */
static bool name_files(page_files *files, size_t begin, const char *root)
{
    for (size_t i = begin; i < files->count; i++) {
        page_file *file = &files->items[i];
        bool is_below = files->root_length && strncmp(file->path, root, files->root_length) == 0;
        const char *name = is_below ? file->path + files->root_length : path_base_name(file->path);
        size_t size = strlen(name) + 32;
        char *unique = malloc(size);
        if (!unique)
            return false;
        snprintf(unique, size, "%s", name);
        for (unsigned n = 1; has_name(files, unique); n++)
            snprintf(unique, size, "light-%u/%s", n, name);
        file->name = unique;
    }
    return true;
}

/* Lists the files that the scene was read from. */
static facet_result list_model(const facet_scene *scene, const char *current, page_files *out,
                               facet_error *error)
{
    const char *path;
    for (uint32_t i = 0; (path = facet_scene_get_file(scene, i)); i++)
        if (!add(out, absolute(path, current), false))
            return fail_names(error);
    return FACET_OK;
}

/* Writes the scene as a .glb file. */
static facet_result write_model(const facet_scene *scene, const char *stem, page_files *out,
                                facet_error *error)
{
    const char *folder = getenv("TMPDIR");
    const facet_scene_save_desc desc = {.is_glb = true};
    char name[4096];
    snprintf(name, sizeof name, "%s/facet-XXXXXX", folder && *folder ? folder : "/tmp");
    if (!mkdtemp(name))
        return fail(error, FACET_ERROR_WRITE, "%s: %s", name, strerror(errno));
    out->temporary = strdup(name);
    size_t length = strlen(name);
    if (!out->temporary ||
        (size_t)snprintf(name + length, sizeof name - length, "/%s.glb", stem) >= sizeof name - length ||
        !add(out, strdup(name), false))
        return fail_names(error);
    return output_write_scene(scene, name, desc, error);
}

/* Appends the files of the environment. */
static facet_result list_light(const environment_input *environment, const char *current, page_files *out,
                               facet_error *error)
{
    char path[ENVIRONMENT_PATH_SIZE];
    for (int i = 0; environment && environment_input_get_file(environment, i, path); i++)
        if (!add(out, absolute(path, current), true))
            return fail_names(error);
    return FACET_OK;
}

static facet_result list_files(const page_files_desc *desc, page_files *out, facet_error *error)
{
    char current[4096];
    if (!getcwd(current, sizeof current))
        return fail(error, FACET_ERROR_READ, "the current folder: %s", strerror(errno));
    if (desc->is_written)
        TRY(write_model(desc->scene, desc->stem, out, error));
    else
        TRY(list_model(desc->scene, current, out, error));
    size_t model_count = out->count;
    const char *first = model_count ? out->items[0].path : "";
    out->root_length = model_count ? common_folder(out) : 0;
    if (!name_files(out, 0, first))
        return fail_names(error);
    const char *path = desc->is_written ? first : desc->path;
    const char *model = path ? page_files_name(out, path) : NULL;
    out->model = model ? model : "";
    TRY(list_light(desc->environment, current, out, error));
    return name_files(out, model_count, first) ? FACET_OK : fail_names(error);
}

facet_result page_files_create(const page_files_desc *desc, page_files *out, facet_error *error)
{
    *out = (page_files){0};
    facet_result result = list_files(desc, out, error);
    if (result != FACET_OK)
        page_files_destroy(out);
    return result;
}

void page_files_destroy(page_files *files)
{
    if (files->temporary) {
        for (size_t i = 0; i < files->count && !files->items[i].is_light; i++)
            unlink(files->items[i].path);
        rmdir(files->temporary);
        free(files->temporary);
    }
    for (size_t i = 0; i < files->count; i++) {
        free(files->items[i].path);
        free(files->items[i].name);
    }
    free(files->items);
    *files = (page_files){0};
}

const char *page_files_name(const page_files *files, const char *path)
{
    for (size_t i = 0; i < files->count; i++)
        if (input_is_same_file(files->items[i].path, path))
            return files->items[i].name;
    return NULL;
}
