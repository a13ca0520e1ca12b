/* batch_leftovers.c - see batch_leftovers.h. */
#define _GNU_SOURCE
#include "cli/batch/batch_leftovers.h"

#include "base/file.h"
#include "cli/shared/output.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* The folder of a path; "." where it has none. False: too long. */
static bool get_folder(const char *path, char *folder, size_t size)
{
    const char *slash = strrchr(path, '/');
    int length = slash ? snprintf(folder, size, "%.*s", slash == path ? 1 : (int)(slash - path), path)
                       : snprintf(folder, size, ".");
    return length >= 0 && (size_t)length < size;
}

/* The length of what the names of all files of an output begin with: up to its frame number, else its last dot. */
static size_t prefix_length(const char *output)
{
    const char *base = path_base_name(output), *dot = strrchr(base, '.');
    size_t length = output_name_has_frame(base) ? strcspn(base, "#%")
                    : dot                       ? (size_t)(dot - base) + 1
                                                : strlen(base);
    return (size_t)(base - output) + length;
}

/* Whether path is a temporary file of an output. */
static bool is_of(const char *path, const char *output)
{
    size_t length = prefix_length(output);
    const char *slash = strrchr(output, '/');
    if (!slash && strncmp(path, "./", 2) == 0)
        path += 2;
    if (strncmp(path, output, length) != 0 || !file_is_temporary(path))
        return false;
    /* of a.png: a.png.0123abcd, not somebody's a.0123abcd */
    return !strchr(path + length, '/') && strchr(path + length, '.');
}

/* Calls each() with the temporary files of a folder. */
static void list_temporaries(const char *folder, void *user, void (*each)(void *user, const char *path))
{
    DIR *listing = opendir(folder);
    for (const struct dirent *entry; listing && (entry = readdir(listing));) {
        char path[4096 + 300];
        if (!file_is_temporary(entry->d_name))
            continue;
        snprintf(path, sizeof path, "%s%s%s", folder, strcmp(folder, "/") == 0 ? "" : "/", entry->d_name);
        each(user, path);
    }
    if (listing)
        closedir(listing);
}

static void keep(void *user, const char *path)
{
    batch_leftovers *l = user;
    char **grown = realloc(l->paths, (l->count + 1) * sizeof *grown);
    char *copy = strdup(path);
    l->paths = grown ? grown : l->paths;
    if (grown && copy)
        l->paths[l->count++] = copy;
    else
        free(copy);
}

void batch_leftovers_remove(batch_leftovers *l, const char *output)
{
    char folder[4096];
    if (!get_folder(output, folder, sizeof folder))
        return;
    if (!batch_map_find(&l->folders, folder) && batch_map_set(&l->folders, folder, 1))
        list_temporaries(folder, l, keep);
    for (size_t i = 0; i < l->count; i++) {
        if (!is_of(l->paths[i], output))
            continue;
        unlink(l->paths[i]);
        free(l->paths[i]);
        l->paths[i--] = l->paths[--l->count];
    }
}

void batch_leftovers_destroy(batch_leftovers *l)
{
    for (size_t i = 0; i < l->count; i++)
        free(l->paths[i]);
    free(l->paths);
    batch_map_destroy(&l->folders);
    *l = (batch_leftovers){.paths = NULL};
}

static void remove_one(void *user, const char *path)
{
    if (is_of(path, user))
        unlink(path);
}

void batch_remove_temporaries(const char *output)
{
    char folder[4096];
    if (get_folder(output, folder, sizeof folder))
        list_temporaries(folder, (void *)(uintptr_t)output, remove_one);
}
